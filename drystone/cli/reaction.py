"""The command that asks for the reactions of supports that move."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from drystone.cli.options import cases_option, catching, json_flag, print_json, say, warn
from drystone.reactions import reactions
from drystone.walls import Wall
from harness.engine.plan import find_cases
from harness.model.errors import first_few


@click.command()
@click.argument("case")
@json_flag
@cases_option
@catching
def reaction(case: str, as_json: bool, folders: tuple[Path, ...]) -> None:
    """Print the least and the greatest reaction of supports of CASE (an id, a case folder or a WALL.json) that move.

    The wall gives "settlements". The reaction is along them, under the dead load, with associated flow: the least where
    a support gives way, the greatest where it pushes back. Exit code 1: there is none, or the judge rejects one.
    """
    (found,) = find_cases([case], None, folders)
    warn(found)
    answer = reactions(Wall(found))
    if isinstance(answer, str):
        if as_json:
            print_json({"least": None, "greatest": None, "reason": answer})
        else:
            say(answer)
        sys.exit(1)
    if as_json:
        print_json({"least": answer[0].as_json(), "greatest": answer[1].as_json()})
    else:
        for name, each in zip(("least", "greatest"), answer, strict=True):
            moving = first_few(each.moving, 8) if each.moving else "no free block"
            say(f"The {name} reaction is {each.value:.7g}; in its mechanism move: {moving}. {each.judgement.sentence}")
    sys.exit(0 if all(each.judgement.accepted for each in answer) else 1)
