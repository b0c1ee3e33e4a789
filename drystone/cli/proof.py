"""Commands about certificates that nothing lies below a multiplier: bound, verify-bound."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Literal

import click

from drystone.certificates import nearest, proved, read_certificate, write_certificate
from drystone.cli.groups import OneOf
from drystone.cli.options import OUTPUT, case_argument, cases_option, catching, finite, json_flag, print_json, say, warn
from harness.engine.plan import find_cases
from harness.engine.run import LONGEST
from harness.model.errors import InputError
from methods.proof.same_wall import require_same_wall
from methods.proof.verify.checker import verify
from methods.proof.verify.exact_wall import CertificateError


@click.command()
@case_argument
@click.option("-o", "--output", type=OUTPUT, required=True, help="The certificate to write.")
@click.option(
    "--nodes", type=click.IntRange(min=1), help="Limit for the tree; the default depends on the size of CASE."
)
@click.option(
    "--seconds",
    type=click.FloatRange(min=0.0, max=LONGEST),
    default=120.0,
    callback=finite,
    show_default=True,
    help="Limit for the multiplier intervals: CPU time, with several processes elapsed time.",
)
@click.option(
    "--jobs",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    help="Processes that work on divided states side by side.",
)
@click.option("--effort", type=OneOf(["quick", "normal", "deep"]), default="normal", help="Of the search.")
@cases_option
@catching
def bound(
    case: str,
    output: Path,
    nodes: int | None,
    seconds: float,
    jobs: int,
    effort: Literal["quick", "normal", "deep"],
    folders: tuple[Path, ...],
) -> None:
    """Write a certificate in fractions of the multiplier below which CASE (an id, a case folder or a WALL.json) has no
    collapse state.

    Columns, rings and small walls have one of a tree, bonded walls one of windows. An output whose name ends in .gz is
    compressed. Where the certificate does not meet the least state known, or there is none, a sentence says how far the
    bound came and why it ended there. Exit code 1: nothing is proved in fractions, and nothing is written.
    """
    from methods.la.find_certificate import find_certificate
    from methods.la.settings import SearchSettings

    (found,) = find_cases([case], None, folders)
    warn(found)
    if not found.assembly.has_live_load:
        raise InputError("the wall has no live load", 'Give "loads": {"live": ...}', case)
    if found.assembly.dilates:
        raise InputError("some joints have dilatancy", "Leave dilatancy out: certificates assume none", case)
    if found.assembly.strong:
        remedy = "Leave cohesion and tensile strength out: certificates are of dry joints"
        raise InputError("some joints have cohesion or tensile strength", remedy, case)
    if len(found.assembly.bars):
        raise InputError("the wall has ties or props", "Leave them out: certificates are of blocks and joints", case)
    if found.assembly.crushes:
        remedy = "Leave compressive strength out: certificates are of joints that do not crush"
        raise InputError("some joints have compressive strength", remedy, case)
    if found.assembly.support_motion.any():
        raise InputError("some supports move", "Leave settlements out: certificates are of supports at rest", case)
    search = SearchSettings(effort=effort)
    attempt = find_certificate(found.assembly, seconds, search, nodes, lambda sentence: say(sentence, err=True), jobs)
    if attempt.document is None:
        say(f"No certificate. {attempt.sentence}", err=True)
        sys.exit(1)
    write_certificate(output, attempt.document)
    say(f"{proved(attempt.document).capitalize()}.")
    if attempt.sentence:
        say(attempt.sentence)


@click.command(name="verify-bound")
@click.argument("certificate", type=click.Path(path_type=Path))
@click.option("--wall", help="The wall of the certificate: an id, a case folder or a WALL.json.")
@json_flag
@cases_option
@catching
def verify_bound(certificate: Path, wall: str | None, as_json: bool, folders: tuple[Path, ...]) -> None:
    """Check CERTIFICATE in fractions, independently of what found it. Exit code 0: it holds; 1: it is refused; 2: the
    file is no certificate.

    With --wall, a certificate of another wall is refused too.
    """
    document = read_certificate(certificate)
    try:
        if wall is not None:
            (found,) = find_cases([wall], None, folders)
            require_same_wall(document, found.assembly)
        lower, upper = verify(document)
    except CertificateError as error:
        if as_json:
            print_json({"holds": False, "reason": str(error)})
        else:
            say(f"Refused: {error}.")
        sys.exit(1)
    if as_json:
        at = {} if upper is None else {"multiplier": str(upper), "value": nearest(upper)}
        print_json({"holds": True, "bound": str(lower)} | at)
    else:
        say(f"{proved(document).capitalize()}.")
        if wall is not None:
            say(f"It is for the wall in {wall}.")
