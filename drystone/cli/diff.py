"""The command that compares two sets of answers: diff."""

from __future__ import annotations

import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from drystone.cli import terminal
from drystone.cli.junit import tests_of_difference, write_junit
from drystone.cli.options import OUTPUT, catching, json_flag, junit_option, print_json, say
from harness.engine.diff import difference, read_answers
from harness.model.case import shipped_cases
from harness.model.difference import DIFFERENCE, Difference, Slower
from harness.model.table import values
from harness.model.writing import write_whole
from reports.page.diff_page import render


@click.command()
@click.argument("sets", nargs=-1, required=True, metavar="[OLD] NEW", type=click.Path(path_type=Path))
@click.option(
    "--slower",
    "share",
    type=click.FloatRange(min=0.0),
    default=Slower().share,
    show_default=True,
    help="Share of the old CPU time by which a slower run exceeds it.",
)
@click.option("--html", type=OUTPUT, help="Also write the comparison as a page.")
@junit_option
@json_flag
@catching
def diff(sets: tuple[Path, ...], share: float, html: Path | None, junit: Path | None, as_json: bool) -> None:
    """Compare the answers of OLD and NEW: result stores (their last comparison) or baselines.

    Without OLD, NEW is compared with the baseline that comes with Drystone. Exit code 1 if an answer is worse, slower
    by more than the share, or gone.
    """
    if len(sets) > 2:
        raise click.UsageError("give one or two stores or baselines")
    old = sets[0] if len(sets) == 2 else shipped_cases() / "baseline.json"
    found = difference(read_answers(old), read_answers(sets[-1]), Slower(share=share))
    if html is not None:
        _write_diff(found, html)
    if junit is not None:
        write_junit(f"drystone diff {found.old} {found.new}", tests_of_difference(found), junit)
    if as_json:
        print_json(_json(found))
    else:
        terminal.print_difference(found)
        if html is not None:
            say(f"Page: {html}")
    sys.exit(0 if found.passed else 1)


def _json(found: Difference) -> dict[str, Any]:
    return {
        "old": found.old,
        "new": found.new,
        "passed": found.passed,
        "counts": {str(kind): number for kind, number in found.counts.items()},
        "not_run": found.not_run,
        "slower": asdict(found.slower),
        "remarks": found.remarks,
        "rows": [values(DIFFERENCE, row) for row in found.rows],
        "pairs": [asdict(pair) for pair in found.pairs],
    }


def _write_diff(found: Difference, path: Path) -> None:
    """Write the page of a comparison of two sets as one HTML file that works offline."""
    write_whole(path, render(found))
