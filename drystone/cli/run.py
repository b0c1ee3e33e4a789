"""The command that runs one method on one wall. It loads no more than that needs: studies and reports are elsewhere."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from drystone.analysis import analyse_by
from drystone.cli import terminal
from drystone.cli.options import (
    INPUT_ERROR,
    as_loaded,
    both_signs_flag,
    case_argument,
    cases_option,
    catching,
    fresh_flag,
    json_flag,
    known_methods,
    live_option,
    load_case_option,
    memory_option,
    own_store_option,
    print_json,
    say,
    seconds_option,
    settings_option,
    warn,
)
from drystone.cli.settings import settings_of
from drystone.walls import Wall
from harness.engine.plan import check_methods, check_taken, find_cases
from harness.engine.run import Limits
from harness.model.envelope import envelope
from harness.model.errors import MOST_NAMED, InputError, first_few
from harness.model.load_cases import named_loads_of
from harness.model.method import Status
from harness.model.method_registry import load_method, method_names
from harness.model.result import Result

_SEVERITY = (INPUT_ERROR, 1, 3, 0)
"""Exit codes, the gravest first: of several load cases the gravest is that of the command."""


@click.command()
@click.argument("method", shell_complete=known_methods)
@case_argument
@settings_option
@load_case_option
@live_option
@both_signs_flag
@click.option(
    "--jobs",
    type=click.IntRange(1),
    default=1,
    show_default=True,
    help="Processes for this run, if its method supports several; other methods refuse.",
)
@own_store_option
@fresh_flag
@click.option("--fields", is_flag=True, help="With --json: contact forces, mechanism, states and path too.")
@click.option("--joints", is_flag=True, help="The margins of every joint too, the most critical first.")
@json_flag
@cases_option
@seconds_option
@memory_option
@catching
def run(
    method: str,
    case: str,
    settings: tuple[str, ...],
    load_case: str | None,
    live: tuple[float, float] | None,
    both_signs: bool,
    jobs: int,
    store: Path | None,
    fresh: bool,
    fields: bool,
    joints: bool,
    as_json: bool,
    folders: tuple[Path, ...],
    seconds: float,
    memory: int,
) -> None:
    """Run METHOD on CASE (an id, a case folder or a WALL.json) and print what it finds."""
    _check_order(method, case)
    check_methods([method], "method")
    (found,) = find_cases([case], None, folders)
    chosen = settings_of(method, settings)
    if found.wall.load_case_fields and load_case is None:
        raise InputError(
            f"it has the load cases {first_few(list(named_loads_of(found)), MOST_NAMED)}",
            "Choose one: --load-case NAME; `drystone compare` answers all of them",
            found.wall.load_cases_place,
            found.origin,
        )
    cases = as_loaded(found, load_case, live, both_signs=both_signs)
    warn(cases[0])
    for each in cases:
        check_taken(load_method(method), each)
    limits = Limits(seconds, memory * 2**20)
    results = [
        analyse_by(Wall(case), method, chosen, isolated=True, limits=limits, processes=jobs, store=store, fresh=fresh)
        for case in cases
    ]
    documents = [
        terminal.result_json(loaded, result, result.proof, fields=fields, joints=joints)
        for loaded, result in zip(cases, results, strict=True)
    ]
    if as_json and len(cases) == 1:
        print_json(documents[0])
    elif as_json:
        print_json({"results": documents} | envelope(cases, results).as_json())
    else:
        for loaded, result in zip(cases, results, strict=True):
            terminal.print_result(result, loaded, result.proof)
            if joints:
                terminal.print_joints(loaded, result)
            if len(cases) > 1:
                print()
        if len(cases) > 1:
            say(envelope(cases, results).sentence)
    codes = [_code(result) for result in results]
    sys.exit(min(codes, key=_SEVERITY.index))


def _code(result: Result) -> int:
    """The exit code of one answer; a wall that the method asked for refuses is wrong input."""
    if result.status is Status.REFUSED:
        return INPUT_ERROR
    return 1 if result.status is not Status.OK else terminal.JUDGED[result.judge.accepted]


def _check_order(method: str, case: str) -> None:
    """Refuse a method and a case that are given in the wrong order.

    Raises:
        InputError: that is so.
    """
    known = method_names()
    if method not in known and case in known:
        remedy = f"The method comes first: {case} {method}"
        raise InputError(f'"{case}" is a method and "{method}" is not: their order is swapped', remedy, "method")
