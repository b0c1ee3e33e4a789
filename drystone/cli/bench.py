"""The command that runs methods on a frozen set of walls."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from drystone.bench import bench, set_names, wall_set
from drystone.bench_tables import check_table
from drystone.cli import terminal
from drystone.cli.options import (
    OUTPUT,
    catching,
    check_table_or_figure,
    fresh_flag,
    jobs_option,
    json_flag,
    known_methods,
    memory_option,
    print_json,
    say,
    seconds_option,
    store_option,
    write_output,
)
from harness.engine.isolate import preload_methods
from harness.engine.plan import check_methods
from harness.engine.run import Limits, Run
from harness.model.errors import InputError
from harness.model.library import library
from harness.model.method import Status
from harness.model.result import Result

if TYPE_CHECKING:
    import pandas as pd


@click.command("bench")
@click.option(
    "--set",
    "name",
    shell_complete=lambda _context, _parameter, begun: [each for each in set_names() if each.startswith(begun)],
    default="core",
    show_default=True,
    help=f"One of {', '.join(set_names())}.",
)
@click.option(
    "--methods",
    shell_complete=known_methods,
    help=f"Separated by commas.  [default: {','.join(library().methods.compare)}]",
)
@click.option(
    "--join",
    "others",
    multiple=True,
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Also count the rows of this table; may be repeated.",
)
@click.option(
    "-o",
    "--output",
    multiple=True,
    type=OUTPUT,
    help="The table as .csv, its figure as .pdf, .svg or .png with drystone[figures]; may be repeated.",
)
@seconds_option
@memory_option
@jobs_option
@store_option
@fresh_flag
@json_flag
@catching
def bench_(
    name: str,
    methods: str | None,
    others: tuple[Path, ...],
    output: tuple[Path, ...],
    seconds: float,
    memory: int,
    jobs: int,
    store: Path,
    fresh: bool,
    as_json: bool,
) -> None:
    """Run methods on a frozen set of walls: shares answered and correct, error, CPU time.

    Exit code 0 whatever the methods answer: `drystone check` holds methods to references.
    """
    for path in output:
        check_table_or_figure(path)
    chosen = wall_set(name)
    names = (
        list(library().methods.compare) if methods is None else [part.strip() for part in methods.split(",") if part]
    )
    check_methods(names)
    tables = [_read(path) for path in others]
    walls = {wall.name for wall in chosen.walls}
    for number, (path, table) in enumerate(zip(others, tables, strict=True)):  # before all runs, not after them
        check_table(table, str(path), {chosen.name}, {chosen.version}, walls, names, tables[:number])
    preload_methods(names)
    unanswered: dict[tuple[str, Status], list[Result]] = {}
    with terminal.progress_bar(len(chosen.walls) * len(names), quiet=as_json) as progress:

        def noted(run: Run, result: Result, stored: bool) -> None:
            progress(run, result, stored)
            if result.status is not Status.OK:
                unanswered.setdefault((result.method, result.status), []).append(result)

        made = bench(
            name, names, jobs=jobs, limits=Limits(seconds, memory * 2**20), store=store, fresh=fresh, progress=noted
        )
    for path, table in zip(others, tables, strict=True):
        made = made.joined(table, str(path))
    for path in output:
        write_output(path, lambda: str(made.table.to_csv(index=False)), made.plot)
    if as_json:
        print_json({"set": name, "version": chosen.version, "methods": made.summary().to_dict("records")})
        return
    say(f'Set "{name}", version {chosen.version}: {chosen.title}. Every share is of all its walls.')
    say(made.summary().to_string(index=False, float_format="{:.4g}".format, na_rep="-"))
    for (method, status), results in sorted(unanswered.items()):
        first = min(results, key=lambda result: result.case)  # not the one that happened to end first
        say(f"{method}: {status} {len(results)} times, on {first.case}: {first.sentence}")


def _read(path: Path) -> pd.DataFrame:
    import pandas as pd

    try:
        return pd.read_csv(path)
    except ValueError as error:
        said = f"it is no table of `drystone bench` ({error})"
        raise InputError(said, "Give its CSV file", source=str(path)) from None
