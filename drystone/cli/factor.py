"""The command that finds the factor of safety on friction."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from drystone.cli.options import (
    case_argument,
    cases_option,
    catching,
    json_flag,
    known_methods,
    left_out_of,
    print_json,
    runs_options,
    say,
    settings_option,
    warn,
)
from drystone.cli.settings import settings_of
from drystone.safety import ReducedWall, factor_by
from drystone.walls import Wall
from harness.engine.pipeline import Runs
from harness.engine.plan import check_methods, find_cases


@click.command()
@case_argument
@click.option(
    "--method",
    shell_complete=known_methods,
    default="la",
    show_default=True,
    help="The method whose finding is taken: la, fe, de, ...",
)
@settings_option
@click.option("--share", type=float, default=0.0, show_default=True, help="Multiple of the live load that acts too.")
@click.option(
    "--accuracy", type=float, help="Relative width of the bracket.  [default: 1e-4, or that of a method that measures]"
)
@json_flag
@cases_option
@runs_options
@catching
def factor(
    case: str,
    method: str,
    settings: tuple[str, ...],
    share: float,
    accuracy: float | None,
    as_json: bool,
    folders: tuple[Path, ...],
    runs: Runs,
) -> None:
    """Find the factor of safety on friction of CASE (an id, a case folder or a WALL.json).

    It is the largest factor by which friction and cohesion of all joints can be divided before the wall falls under its
    dead load. Both ends of its bracket are judged. Exit code 1: it was not found, or to less than the accuracy.
    """
    check_methods([method], "--method")
    (found,) = find_cases([case], None, folders)
    besides = () if share else left_out_of(found, "(--share 1 adds all of it)")
    told = warn(ReducedWall(found, 1.0, share), also=besides)
    answer = factor_by(
        Wall(found),
        method,
        settings_of(method, settings),
        share=share,
        accuracy=accuracy,
        runs=runs,
    )
    if as_json:
        print_json(answer.as_json() | told)
    else:
        say(answer.sentence)
    sys.exit(0 if answer.value is not None and not answer.reason else 1)
