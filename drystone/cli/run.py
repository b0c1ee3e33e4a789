"""The command that runs one method on one wall. It loads no more than that needs: studies and reports are elsewhere."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from drystone.analysis import analyse_by
from drystone.cli import terminal
from drystone.cli.options import (
    cases_option,
    catching,
    fresh_flag,
    json_flag,
    memory_option,
    print_json,
    seconds_option,
    settings_option,
    warn,
)
from drystone.cli.settings import settings_of
from drystone.walls import Wall
from harness.engine.plan import check_methods, find_cases
from harness.engine.run import Limits
from harness.model.method import Status


@click.command()
@click.argument("method")
@click.argument("case")
@settings_option
@click.option(
    "--jobs",
    type=click.IntRange(1),
    default=1,
    show_default=True,
    help="Processes for the parts of this one run, where its method can make them side by side; others refuse.",
)
@click.option(
    "--store",
    type=click.Path(path_type=Path),
    help="Where the result is kept, and looked for first.  [default: nowhere]",
)
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
    check_methods([method], "method")
    (found,) = find_cases([case], None, folders)
    chosen = settings_of(method, settings)
    warn(found)
    limits = Limits(seconds, memory * 2**20)
    result = analyse_by(
        Wall(found), method, chosen, isolated=True, limits=limits, processes=jobs, store=store, fresh=fresh
    )
    if as_json:
        print_json(terminal.result_json(found, result, result.proof, fields=fields, joints=joints))
    else:
        terminal.print_result(result, found, result.proof)
        if joints:
            terminal.print_joints(found, result)
    sys.exit(1 if result.status is not Status.OK else terminal.JUDGED[result.judge.accepted])
