"""Commands that hold methods to what is known: check, baseline."""

from __future__ import annotations

import sys
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

import click

from drystone.checking import Tier, held, planned
from drystone.cli import terminal
from drystone.cli.groups import OneOf
from drystone.cli.junit import tests_of_check, write_junit
from drystone.cli.options import (
    OUTPUT,
    cases_argument,
    cases_option,
    catching,
    fresh_flag,
    jobs_option,
    json_flag,
    junit_option,
    print_json,
    store_option,
    suite_option,
    warn,
)
from harness.engine import baseline as recording
from harness.engine import pipeline
from harness.engine.plan import find_cases, plan_case
from harness.engine.run import Limits
from harness.engine.store import open_store
from harness.model.case import shipped_cases
from harness.model.errors import InputError
from harness.model.json_text import near


@click.command()
@cases_argument
@suite_option
@click.option("--tier", type=OneOf(["quick", "full"]), default="quick", show_default=True)
@jobs_option
@store_option
@fresh_flag
@junit_option
@json_flag
@cases_option
@catching
def check(
    cases: tuple[str, ...],
    suite: str | None,
    tier: Tier,
    jobs: int,
    store: Path,
    fresh: bool,
    junit: Path | None,
    as_json: bool,
    folders: tuple[Path, ...],
) -> None:
    """Compare the methods with their checked references: one line each; exit code 1 on a violation.

    The full tier also checks the certificates beside the cases, in fractions and against the wall.
    """
    chosen = find_cases(cases, suite, folders, otherwise="all")
    for case in chosen:
        warn(case)
    plan = planned(chosen, tier)
    with open_store(store) as opened, terminal.progress_bar(len(plan.runs), quiet=as_json) as progress:
        checked = held(plan, opened, jobs, fresh=fresh, progress=progress)
    lines = checked.lines
    if junit is not None:
        write_junit(f"drystone check, {tier} tier", tests_of_check(lines), junit)
    if as_json:
        print_json(
            {
                "tier": tier,
                "references": lines,
                "warnings": {case.id: list(case.warnings) for case in chosen if case.warnings},
                "passed": checked.passed,
            }
        )
    else:
        unchecked = sum(not reference.gate for case in chosen for reference in case.file.references)
        terminal.print_check(lines, unchecked)
    sys.exit(0 if checked.passed else 1)


@click.command()
@click.argument("action", type=OneOf(["show", "update"]), default="show")
@cases_argument
@suite_option
@click.option("--reason", default="", help="The reason for an update; required.")
@click.option("--file", "path", type=OUTPUT, help="The baseline.  [default: the one shipped]")
@jobs_option
@store_option
@json_flag
@cases_option
@catching
def baseline(
    action: str,
    cases: tuple[str, ...],
    suite: str | None,
    reason: str,
    path: Path | None,
    jobs: int,
    store: Path,
    as_json: bool,
    folders: tuple[Path, ...],
) -> None:
    """Show how today's values stand to the recorded ones (exit code 1 if one is worse), or record them."""
    if action == "update" and not reason.strip():
        raise InputError("an update of the baseline needs a reason", 'Give --reason "..."', "baseline")
    chosen = find_cases(cases, suite, folders, otherwise="all")
    recorded_in = path or shipped_cases() / "baseline.json"
    if action == "show" and not recorded_in.exists():
        raise InputError(
            "there is no such file", near(recorded_in) or "Write it with `update`", source=str(recorded_in)
        )
    recorded = recording.read_baseline(recorded_in)
    runs = [run for case in chosen for run in plan_case(case, None, Limits())]
    with open_store(store) as opened, terminal.progress_bar(len(runs), quiet=as_json) as progress:
        results = pipeline.execute(runs, opened, jobs, progress=progress)
    rows = recording.compare_with(recorded, runs, results)
    if as_json:
        print_json({"action": action, "rows": rows})
    else:
        terminal.print_changes(rows)
    if action == "update":
        entry = recording.Entry(
            date=datetime.now(UTC).date().isoformat(), release=version("drystone"), reason=reason.strip()
        )
        recording.write_baseline(recorded_in, recording.updated(recorded, runs, results, entry))
    elif any(row["change"] == "worse" for row in rows):
        sys.exit(1)
