"""Commands about certificates that nothing lies below a multiplier: bound, verify-bound."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Literal

import click

from harness.certificates import proved, read_certificate, write_certificate
from harness.model.errors import InputError
from harness.model.reading import read_wall
from harness.options import catching, json_flag, print_json, say
from methods.bound.exact_wall import CertificateError
from methods.bound.same_wall import require_same_wall
from methods.bound.verify import verify


@click.command()
@click.argument("wall", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, help="The certificate to write.")
@click.option("--nodes", type=click.IntRange(min=1), default=1500, show_default=True, help="Of the tree at most.")
@click.option("--seconds", type=click.FloatRange(min=0.0), default=120.0, show_default=True, help="For the windows.")
@click.option("--effort", type=click.Choice(["quick", "normal", "deep"]), default="normal", help="Of the search.")
@catching
def bound(wall: Path, output: Path, nodes: int, seconds: float, effort: Literal["quick", "normal", "deep"]) -> None:
    """Write a certificate in fractions of the multiplier below which WALL has no collapse state.

    Columns, rings and small walls have one of a tree, bonded walls one of windows. An output whose name ends in .gz is
    compressed. Exit code 1: none was found, and nothing is written.
    """
    from methods.la.bound_adapter import find_certificate
    from methods.la.core.search_settings import SearchSettings

    built = read_wall(wall)
    for sentence in built.warnings:
        say(f"drystone: {sentence}", err=True)
    if not built.assembly.has_live_load:
        raise InputError("the wall has no live load", 'Give "loads": {"live": ...}', str(wall))
    if built.assembly.dilates:
        raise InputError("some joints lift as they slide", "Leave dilatancy out: certificates are without", str(wall))
    document = find_certificate(built.assembly, nodes, seconds, SearchSettings(effort=effort))
    if document is None:
        say("No certificate: nothing was proved in time, or the wall's numbers are not short fractions.", err=True)
        sys.exit(1)
    write_certificate(output, document)
    say(f"{proved(document).capitalize()}.")


@click.command(name="verify-bound")
@click.argument("certificate", type=click.Path(path_type=Path))
@click.option("--wall", type=click.Path(path_type=Path), help="The wall it must be of: WALL.json.")
@json_flag
@catching
def verify_bound(certificate: Path, wall: Path | None, as_json: bool) -> None:
    """Check CERTIFICATE in fractions, independently of what found it. Exit code 0: it holds; 1: it is refused.

    With --wall, a certificate of another wall is refused too.
    """
    document = read_certificate(certificate)
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
        say(f"{proved(document).capitalize()}.")
        if wall is not None:
            say(f"It is of the wall in {wall}.")
