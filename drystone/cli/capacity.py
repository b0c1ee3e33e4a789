"""The command that follows a collapse on updated geometry."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from drystone.capacity_curve import capacity as curve_of
from drystone.cli.options import (
    OUTPUT,
    case_argument,
    cases_option,
    catching,
    check_table_or_figure,
    json_flag,
    print_json,
    runs_options,
    say,
    warn,
    write_output,
)
from drystone.walls import Wall
from harness.engine.pipeline import Runs
from harness.engine.plan import find_cases
from reports.labels.numbers import labelled


@click.command()
@case_argument
@click.option("--block", help="Id of the block whose centroid is the control point.  [default: the live load's mean]")
@click.option(
    "-o",
    "--output",
    type=OUTPUT,
    help="Also draw or list the curve: .csv, or .pdf, .svg or .png with drystone[figures].",
)
@json_flag
@cases_option
@runs_options
@catching
def capacity(
    case: str, block: str | None, output: Path | None, as_json: bool, folders: tuple[Path, ...], runs: Runs
) -> None:
    """Find the capacity curve of CASE (an id, a case folder or a WALL.json): multiplier against displacement.

    The wall follows its mechanism by finite rotations, and the multiplier of associated flow, an upper bound, is found
    again on the way, until it is zero at the ultimate displacement. All states are judged. Exit code 1: it was followed
    less far, or one is rejected.
    """
    check_table_or_figure(output)
    (found,) = find_cases([case], None, folders)
    told = warn(found)
    wall = Wall(found)
    answer = curve_of(wall, block, runs=runs)
    if isinstance(answer, str):
        if as_json:
            print_json({"ultimate": None, "reason": answer} | told)
        else:
            say(answer)
        sys.exit(1)
    write_output(output, answer.as_csv, answer.plot)
    if as_json:
        print_json(answer.as_json() | told)
    else:
        say(answer.sentence)
        say(f"{labelled('displacement', answer.unit):>18} {'upper bound':>14}")
        for x, y in zip(answer.displacement.tolist(), answer.multiplier.tolist(), strict=True):
            say(f"{x:18.7g} {y:14.7g}")
    sys.exit(0 if answer.accepted else 1)
