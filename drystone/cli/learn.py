"""The command that makes a page for teaching: learn."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

import click

from drystone.cli import terminal
from drystone.cli.options import OUTPUT, catching, jobs_option, say, store_option
from drystone.comparing import compared
from harness.engine.executors import LocalExecutor
from harness.engine.plan import find_cases, plan_case
from harness.engine.run import Limits
from harness.engine.store import open_store
from harness.model.library import library

WALLS = ("wall-21-friction-030", "wall-21-friction-050", "wall-21", "wall-21-friction-075", "wall-21-friction-100")
"""Walls that differ in friction alone, from sliding to overturning in steps."""


@click.command()
@click.option("-o", "--output", type=OUTPUT, default=Path("out/learn.html"), show_default=True)
@jobs_option
@store_option
@catching
def learn(output: Path, jobs: int, store: Path) -> None:
    """Make a page for teaching: the paper's block with sliders, and the 21-brick wall over friction.

    Runs that the store does not have are made first; the page works offline.
    """
    from reports.page.learn import write_learn

    chosen = find_cases(("single-block", *WALLS), None, ())
    runs = [planned for case in chosen for planned in plan_case(case, list(library().methods.compare), Limits())]
    command, title = shlex.join(["drystone", *sys.argv[1:]]), "Why three methods differ"
    with open_store(store) as opened, terminal.progress_bar(len(runs), quiet=False) as progress:
        made = compared(title, command, chosen, runs, opened, LocalExecutor(jobs), progress=progress, certified=False)
    write_learn(made, output)
    say(f"Page: {output}")
