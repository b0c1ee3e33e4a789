"""The command that makes a page for teaching: learn."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

import click

from drystone.cli import terminal
from drystone.cli.options import OUTPUT, catching, jobs_option, say, store_option
from harness.engine import compare as comparing
from harness.engine.isolate import preload_methods
from harness.engine.plan import Limits, find_cases, plan_case
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
    from reports.learn import write_learn

    chosen = find_cases(("single-block", *WALLS), None, ())
    runs = [planned for case in chosen for planned in plan_case(case, list(library().methods.compare), Limits())]
    preload_methods(planned.method for planned in runs)
    with open_store(store) as opened, terminal.progress(len(runs), quiet=False) as told:
        results = comparing.execute(runs, opened, jobs, told=told)
    command = shlex.join(["drystone", *sys.argv[1:]])
    write_learn(comparing.comparison_run("Why three methods differ", command, chosen, runs, results), output)
    say(f"Page: {output}")
