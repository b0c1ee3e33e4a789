"""Commands about certificates that nothing lies below a multiplier: bound, verify-bound."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from harness.model.errors import InputError
from harness.model.reading import read_json, read_wall
from harness.options import catching, json_flag, print_json, say
from methods.bound.same_wall import require_same_wall
from methods.bound.verify import CertificateError, verify


@click.command()
@click.argument("wall", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, help="The certificate to write.")
@click.option("--nodes", type=click.IntRange(min=1), default=1500, show_default=True, help="Of the tree at most.")
@catching
def bound(wall: Path, output: Path, nodes: int) -> None:
    """Write a certificate in fractions that no collapse state of WALL lies below the one found.

    Small walls, columns and rings have one. Exit code 1: none was found, and nothing is written.
    """
    from methods.la.certify import certificate

    built = read_wall(wall)
    for sentence in built.warnings:
        say(f"drystone: {sentence}", err=True)
    if not built.assembly.has_live_load:
        raise InputError("the wall has no live load", 'Give "loads": {"live": ...}', str(wall))
    document = certificate(built.assembly, nodes)
    if document is None:
        say("No certificate was found: the tree did not end, or the wall's numbers are not short fractions.", err=True)
        sys.exit(1)
    output.write_text(json.dumps(document, indent=1), encoding="utf-8")
    say(_sentence(*(str(document[name]) for name in ("bound", "multiplier"))))


@click.command(name="verify-bound")
@click.argument("certificate", type=click.Path(path_type=Path))
@click.option("--wall", type=click.Path(path_type=Path), help="The wall it must be of: WALL.json.")
@json_flag
@catching
def verify_bound(certificate: Path, wall: Path | None, as_json: bool) -> None:
    """Check CERTIFICATE in fractions, independently of what found it. Exit code 0: it holds; 1: it is refused.

    With --wall, a certificate of another wall is refused too.
    """
    document = read_json(certificate)
    try:
        if wall is not None:
            require_same_wall(document, read_wall(wall).assembly)
        lower, upper = verify(document)
    except CertificateError as error:
        if as_json:
            print_json({"holds": False, "reason": str(error)})
        else:
            say(f"Refused: {error}.")
        sys.exit(1)
    if as_json:
        print_json({"holds": True, "bound": str(lower), "multiplier": str(upper), "value": float(upper)})
    else:
        say(_sentence(str(lower), str(upper)))
        if wall is not None:
            say(f"It is of the wall in {wall}.")


def _sentence(lower: str, upper: str) -> str:
    return f"There is a collapse state at {upper}, and none below {lower}: proved in fractions."
