"""The command that asks for the reactions of supports that move."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import NoReturn

import click

from drystone.cli.groups import OneOf
from drystone.cli.options import (
    OUTPUT,
    case_argument,
    cases_option,
    catching,
    check_table_or_figure,
    json_flag,
    left_out_of,
    print_json,
    runs_options,
    say,
    warn,
    write_output,
)
from drystone.reactions import least_known_reactions, reaction_unit, reactions, with_unit
from drystone.support_paths import FOLLOWS, paths_as_csv, paths_figure, reaction_paths
from drystone.walls import Wall
from harness.engine.pipeline import Runs
from harness.engine.plan import find_cases
from harness.model.errors import InputError, first_few
from harness.model.input_checks import plastic_strength
from reports.labels.numbers import labelled

Besides = dict[str, list[str]] | None
"""What a JSON document says besides its answer; None where text is printed."""

SAID = {
    "least": "least reaction",
    "greatest": "greatest reaction",
    "giving_way": "greatest known reaction of a support that gives way, without dilatancy,",
    "pushing": "least known reaction of a support that pushes, without dilatancy,",
}


@click.command()
@case_argument
@click.option(
    "--without-dilatancy",
    is_flag=True,
    help="The reactions at which the wall collapses without dilatancy, as far as `la` knows, in place of the extremes.",
)
@click.option(
    "--held",
    is_flag=True,
    help="The reactions between which `de` holds the support from rest on, each as a bracket between held and moving.",
)
@click.option(
    "--path", "as_path", is_flag=True, help="The reaction against the imposed displacement, by the gap springs of `fe`."
)
@click.option(
    "--by",
    type=OneOf(list(FOLLOWS)),
    help="With --path: by `fe`, or by distinct elements with deformable joints.",
)
@click.option(
    "--until-collapse", is_flag=True, help="How far the supports can move before the wall falls, on updated geometry."
)
@click.option(
    "-o",
    "--output",
    type=OUTPUT,
    help="Also draw or list the path or the way to collapse: .csv, or .pdf, .svg or .png with drystone[figures].",
)
@json_flag
@cases_option
@runs_options
@catching
def reaction(
    case: str,
    without_dilatancy: bool,
    held: bool,
    as_path: bool,
    by: str | None,
    until_collapse: bool,
    output: Path | None,
    as_json: bool,
    folders: tuple[Path, ...],
    runs: Runs,
) -> None:
    """Print the least and the greatest reaction of supports of CASE (an id, a case folder or a WALL.json) that move.

    The wall gives "settlements". The reaction is along them, under the dead load, with associated flow: the least where
    a support gives way, the greatest where it pushes back. With --without-dilatancy the wall may collapse before: given
    are the greatest reaction known at which a support gives way, and the least known at which one pushes back. Exit
    code 1: there is none, or the judge rejects one.
    """
    if without_dilatancy + held + as_path + until_collapse > 1:
        raise InputError(
            "they are different questions", "Give one of --without-dilatancy, --held, --path, --until-collapse"
        )
    if by is not None and not as_path:
        raise InputError("only paths are followed by a method of choice", "Give --path with it", "--by")
    if output is not None and not (as_path or until_collapse):
        raise InputError("two numbers are no curve", "Give --path or --until-collapse with it", "--output")
    check_table_or_figure(output)
    (found,) = find_cases([case], None, folders)
    told = warn(found, also=(*left_out_of(found), *plastic_strength(found.assembly)))
    wall, besides = Wall(found), told if as_json else None
    if as_path:
        _print_paths(wall, by, runs, output, besides)
    elif until_collapse:
        _print_collapse(wall, runs, output, besides)
    elif held:
        _print_held(wall, runs, besides)
    else:
        _print_reactions(wall, runs, without_dilatancy, besides)


def _print_reactions(wall: Wall, runs: Runs, without_dilatancy: bool, besides: Besides) -> None:
    """Two reactions, each with the blocks that move."""
    answer = least_known_reactions(wall, runs=runs) if without_dilatancy else reactions(wall, runs=runs)
    names = ("giving_way", "pushing") if without_dilatancy else ("least", "greatest")
    if isinstance(answer, str):
        _print_none(answer, names, besides)
    if besides is not None:
        print_json({name: each.as_json() for name, each in zip(names, answer, strict=True)} | besides)
    else:
        unit = reaction_unit(wall)
        for name, each in zip(names, answer, strict=True):
            value = with_unit(f"{each.value:.7g}", unit)
            moving = first_few(each.moving, 8) if each.moving else "no free block"
            say(f"The {SAID[name]} is {value}; in its mechanism move: {moving}. {each.judgement.sentence}")
    sys.exit(0 if all(each.judgement.accepted for each in answer) else 1)


def _print_held(wall: Wall, runs: Runs, besides: Besides) -> None:
    """The brackets of a support that gives way and of one that pushes."""
    from drystone.held_reactions import held_reactions

    answer = held_reactions(wall, runs=runs)
    names = ("giving_way", "pushing")
    if isinstance(answer, str):
        _print_none(answer, names, besides)
    if besides is not None:
        print_json({name: each.as_json() for name, each in zip(names, answer, strict=True)} | besides)
    else:
        unit = reaction_unit(wall)
        if unit:
            say(f"Reactions in {unit}.")
        for each in answer:
            moving = first_few(each.moving_blocks, 8) if each.moving_blocks else "no free block"
            say(f"{each.sentence} In its mechanism move: {moving}.")
    sys.exit(0 if all(each.judgement.accepted for each in answer) else 1)


def _print_paths(wall: Wall, by: str | None, runs: Runs, output: Path | None, besides: Besides) -> None:
    """The paths of a support that gives way and of one that pushes."""
    answer = reaction_paths(wall, by or "fe", runs=runs)
    names = ("giving_way", "pushing")
    if isinstance(answer, str):
        _print_none(answer, names, besides)
    write_output(output, lambda: paths_as_csv(answer), lambda: paths_figure(answer, wall.title))
    if besides is not None:
        print_json({name: each.as_json() for name, each in zip(names, answer, strict=True)} | besides)
    else:
        for each in answer:
            heads = [labelled(name, unit) for name, unit in zip(("displacement", "reaction"), each.units, strict=True)]
            say(each.sentence)
            say(f"{heads[0]:>18} {heads[1]:>18}")
            for x, y in zip(each.displacement.tolist(), each.reaction.tolist(), strict=True):
                say(f"{x:18.7g} {y:18.7g}")
    sys.exit(0 if all(each.accepted for each in answer) else 1)


def _print_collapse(wall: Wall, runs: Runs, output: Path | None, besides: Besides) -> None:
    """The displacement at collapse."""
    from drystone.settling import settled_until_collapse

    answer = settled_until_collapse(wall, runs=runs)
    if isinstance(answer, str):
        _print_none(answer, ("stands", "falls"), besides)
    write_output(output, answer.as_csv, answer.plot)
    if besides is not None:
        print_json(answer.as_json() | besides)
    else:
        say(answer.sentence)
    sys.exit(0 if answer.accepted else 1)


def _print_none(reason: str, names: tuple[str, ...], besides: Besides) -> NoReturn:
    """Say why there is no answer, and end."""
    if besides is not None:
        print_json(dict.fromkeys(names) | {"reason": reason} | besides)
    else:
        say(reason)
    sys.exit(1)
