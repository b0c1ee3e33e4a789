"""The command that asks for the reactions of supports that move."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from drystone.cli.options import cases_option, catching, json_flag, print_json, say, warn
from drystone.reactions import least_known_reactions, reactions
from drystone.walls import Wall
from harness.engine.plan import find_cases
from harness.model.errors import first_few

SAID = {
    "least": "least reaction",
    "greatest": "greatest reaction",
    "giving_way": "greatest known reaction of a support that gives way, without dilatancy,",
    "pushing": "least known reaction of a support that pushes, without dilatancy,",
}


@click.command()
@click.argument("case")
@click.option(
    "--without-dilatancy",
    is_flag=True,
    help="The reactions at which the wall collapses without dilatancy, as far as `la` knows, in place of the extremes.",
)
@json_flag
@cases_option
@catching
def reaction(case: str, without_dilatancy: bool, as_json: bool, folders: tuple[Path, ...]) -> None:
    """Print the least and the greatest reaction of supports of CASE (an id, a case folder or a WALL.json) that move.

    The wall gives "settlements". The reaction is along them, under the dead load, with associated flow: the least where
    a support gives way, the greatest where it pushes back. With --without-dilatancy the wall may collapse before: given
    are the greatest reaction known at which a support gives way, and the least known at which one pushes back. Exit
    code 1: there is none, or the judge rejects one.
    """
    (found,) = find_cases([case], None, folders)
    warn(found)
    answer = least_known_reactions(Wall(found)) if without_dilatancy else reactions(Wall(found))
    names = ("giving_way", "pushing") if without_dilatancy else ("least", "greatest")
    if isinstance(answer, str):
        if as_json:
            print_json(dict.fromkeys(names) | {"reason": answer})
        else:
            say(answer)
        sys.exit(1)
    if as_json:
        print_json({name: each.as_json() for name, each in zip(names, answer, strict=True)})
    else:
        for name, each in zip(names, answer, strict=True):
            moving = first_few(each.moving, 8) if each.moving else "no free block"
            say(f"The {SAID[name]} is {each.value:.7g}; in its mechanism move: {moving}. {each.judgement.sentence}")
    sys.exit(0 if all(each.judgement.accepted for each in answer) else 1)
