"""The command that finds the interaction domain of two live loads."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from drystone.cli.options import (
    OUTPUT,
    case_argument,
    cases_option,
    catching,
    check_table_or_figure,
    json_flag,
    known_methods,
    pair,
    print_json,
    runs_options,
    say,
    settings_option,
    warn,
    write_output,
)
from drystone.cli.settings import settings_of
from drystone.interaction import LoadPair, domain_by
from harness.engine.pipeline import Runs
from harness.engine.plan import find_cases
from harness.model.input_checks import plastic_strength


@click.command()
@case_argument
@click.option(
    "--method",
    shell_complete=known_methods,
    default="la-associated",
    show_default=True,
    help="An associated maximum gives the polygon.",
)
@settings_option
@click.option("--load-cases", metavar="A,B", help="Two load cases of the wall.  [default: those it has]")
@click.option(
    "--live",
    "live",
    multiple=True,
    metavar="X,Y",
    callback=lambda _context, _option, given: tuple(pair(text) for text in given),
    help="A multiple of every weight; given twice.  [default: 1,0 and 0,-1 without load cases]",
)
@click.option("--accuracy", type=float, help="Relative.  [default: 1e-6 for a polygon, 0.01 for points]")
@click.option("--most", type=click.IntRange(4), default=200, show_default=True, help="Runs after which it stops.")
@click.option(
    "-o", "--output", type=OUTPUT, help="Also draw or list it: .csv, or .pdf, .svg or .png with drystone[figures]."
)
@json_flag
@cases_option
@runs_options
@catching
def domain(
    case: str,
    method: str,
    settings: tuple[str, ...],
    load_cases: str | None,
    live: tuple[tuple[float, float], ...],
    accuracy: float | None,
    most: int,
    output: Path | None,
    as_json: bool,
    folders: tuple[Path, ...],
    runs: Runs,
) -> None:
    """Find all pairs of multipliers of two live loads under which CASE stands (an id, a case folder or a WALL.json).

    A method of the associated maximum gives the whole convex polygon, others points of its boundary. Exit code 1: it is
    incomplete.
    """
    check_table_or_figure(output)
    (found,) = find_cases([case], None, folders)
    loads = LoadPair.of(found, load_cases=() if load_cases is None else load_cases.split(","), live=live)
    told = warn(*loads.cases, also=plastic_strength(loads.cases[0].assembly))
    answer = domain_by(
        loads,
        method,
        settings_of(method, settings),
        accuracy=accuracy,
        most=most,
        runs=runs,
    )
    write_output(output, answer.as_csv, answer.plot)
    if as_json:
        print_json(answer.as_json() | told)
    else:
        say(answer.sentence)
        if answer.points:
            say(f"{'x':>14} {'y':>14}")
        for point in answer.points:
            where = (
                "{:14.7g} {:14.7g}".format(*point.at)
                if point.bounded
                else "     unbounded: {:g},{:g}".format(*point.at)
            )
            say(where)
    sys.exit(1 if answer.reason else 0)
