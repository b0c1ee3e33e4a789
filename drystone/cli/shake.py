"""The command that shakes a wall."""

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
    finite,
    json_flag,
    left_out_of,
    print_json,
    runs_options,
    say,
    warn,
    write_output,
)
from drystone.shaking import shake as shaken
from drystone.toppling import least_shaking
from drystone.walls import Wall
from harness.engine.pipeline import Runs
from harness.engine.plan import find_cases
from harness.model.errors import InputError
from harness.model.ground_motion import GRAVITY


@click.command()
@case_argument
@click.option("--pulse", metavar="G:S[,...]", help="Acceleration of the ground [g] and its duration [s], one or more.")
@click.option("--motion", type=click.Path(path_type=Path), help="A CSV record instead, with time and acceleration.")
@click.option("--multiple", type=float, default=1.0, show_default=True, callback=finite, help="Of the motion.")
@click.option("--least", is_flag=True, help="Find the least multiple of the motion that topples the wall.")
@click.option("--accuracy", type=float, default=1e-3, show_default=True, help="Relative width of its bracket.")
@click.option(
    "--gravity", type=float, default=GRAVITY, show_default=True, callback=finite, help="Acceleration g [m/s2]."
)
@click.option(
    "-o",
    "--output",
    type=OUTPUT,
    help="Also draw or list the motion: .csv, or .pdf, .svg or .png with drystone[figures].",
)
@json_flag
@cases_option
@runs_options
@catching
def shake(
    case: str,
    pulse: str | None,
    motion: Path | None,
    multiple: float,
    least: bool,
    accuracy: float,
    gravity: float,
    output: Path | None,
    as_json: bool,
    folders: tuple[Path, ...],
    runs: Runs,
) -> None:
    """Shake CASE (an id, a case folder or a WALL.json): does it stand or fall when the ground moves?

    The blocks are followed in time by distinct elements, until one has fallen or all motion has died. Exit code 1: it
    is undecided, or the judge rejects it.
    """
    check_table_or_figure(output)
    if (pulse is None) == (motion is None):
        raise InputError("one motion of the ground is asked for", "Give either --pulse 0.5:0.3 or --motion FILE.csv")
    if least and multiple != 1.0:
        raise InputError("--least finds the multiple", "Leave --multiple out", "--multiple")
    (found,) = find_cases([case], None, folders)
    told = warn(found, also=left_out_of(found))
    wall, asked = Wall(found), motion if pulse is None else pulse
    assert asked is not None
    if least:
        bracket = least_shaking(wall, asked, accuracy, gravity=gravity, runs=runs)
        answer = bracket.falls or bracket.stands
        document, accepted, sentence = bracket.as_json(), bracket.accepted, bracket.sentence
    else:
        answer = shaken(wall, asked, multiple, gravity=gravity, runs=runs)
        document, accepted, sentence = answer.as_json(), answer.accepted, answer.sentence
    if answer is not None and not answer.reason:
        write_output(output, answer.as_csv, answer.plot)
    if as_json:
        print_json(document | told)
    else:
        say(sentence)
        if answer is not None and not answer.reason:
            say(f"Engine: {answer.engine}; a rocking block keeps {answer.impact:.4f} of its speed at an impact.")
    sys.exit(0 if accepted else 1)
