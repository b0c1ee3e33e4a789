"""Commands about many runs: sweep, study, store."""

from __future__ import annotations

import shlex
import sys
from collections import Counter
from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import Any

import click

from drystone.cli.options import (
    STORE,
    cases_option,
    catching,
    fresh_flag,
    jobs_option,
    json_flag,
    memory_option,
    methods_option,
    print_json,
    say,
    seconds_option,
    store_option,
    tell,
)
from drystone.cli.settings import method_settings
from drystone.cli.studies import duration, progress_bar
from drystone.cli.terminal import print_rows
from drystone.studies import Sweep, changed, rows_of, shipped_studies, shipped_study, study_file
from harness.engine.executors import Executor, LocalExecutor
from harness.engine.run import Limits
from harness.engine.store import open_store
from harness.engine.sweep.expand import SweepRun, expand, sources_of, warnings_of
from harness.engine.sweep.quick import quick_study
from harness.engine.sweep.study import Study, read_study
from harness.model.errors import InputError, did_you_mean
from harness.model.json_text import near
from harness.model.library import library
from harness.model.method import Status
from harness.model.writing import check_output

OUT = Path("out")


@click.command(name="sweep")
@click.argument("what", metavar="STUDY")
@click.option(
    "--vary", multiple=True, metavar="NAME=VALUES", help="FROM:TO:COUNT or A,B,C, vectors in brackets; may be repeated."
)
@click.option(
    "--imperfection",
    metavar="FROM:TO[:COUNT]",
    help=f"Size of defects over the block height ({library().settings['imperfection']}).",
)
@click.option("--seeds", type=click.IntRange(1), help="So many seeds of the defects.")
@methods_option(f"{','.join(library().methods.sweep)}, or the study's")
@click.option("--set", "settings", multiple=True, metavar="METHOD.NAME=VALUE", help="A setting; may be repeated.")
@click.option(
    "--at", "multipliers", type=float, multiple=True, help="Report the probability of failure at a multiplier."
)
@click.option(
    "--neighbours/--alone",
    default=None,
    help="Use the mechanisms found on walls with the same joints.  [default: as the study says; alone]",
)
@click.option("--dry-run", is_flag=True, help="Report the number of runs and their estimated time; run nothing.")
@click.option("--scheduler", metavar="tcp://HOST:PORT", help="A Dask scheduler for the runs.")
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Folder of the tables.  [default: out/NAME]")
@click.option("--no-report", is_flag=True, help="Tables only, no page.")
@seconds_option
@memory_option
@jobs_option
@store_option
@fresh_flag
@json_flag
@cases_option
@catching
def sweep_(what: str, dry_run: bool, scheduler: str | None, jobs: int, store: Path, fresh: bool, **rest: Any) -> None:
    """Make every run of STUDY: a study file (.toml), a study that comes with Drystone, or a case with --vary.

    \b
    drystone sweep friction
    drystone sweep my-study.toml --dry-run
    drystone sweep wall.json --vary friction=0.3:1.0:15 --methods la,fe,de
    drystone sweep wall-21 --imperfection 0.02:0.12 --seeds 50

    Exit code 1: the judge rejects a run, or none has an answer.
    """
    asked, place = _study(what, rest)
    sources = sources_of(asked, rest["folders"], place)
    runs = expand(asked, sources)
    warnings = warnings_of(sources, runs)
    tell(warnings)
    if dry_run:
        _tell_plan(asked, runs, store, jobs, warnings, as_json=rest["as_json"])
        return
    folder = rest["output"] or OUT / asked.name
    check_output(folder / "runs.csv")
    if not rest["no_report"]:
        check_output(folder.with_suffix(".html"))
    with open_store(store) as opened:
        executor = _executor(scheduler, jobs)
        counting = partial(progress_bar, quiet=rest["as_json"])
        rows = rows_of(asked, runs, opened, executor, fresh=fresh, counting=counting)
    _leave(Sweep(asked, rows, warnings), folder, rest)


def _study(what: str, rest: dict[str, Any]) -> tuple[Study, Path | None]:
    quick = {name: rest[name] for name in ("vary", "imperfection", "seeds") if rest[name]}
    file = study_file(what)
    methods = rest["methods"]
    settings = method_settings(rest["settings"])
    if file is not None and file.suffix == ".toml" and not quick:
        return changed(read_study(file), methods, settings, rest["multipliers"], rest["neighbours"]), file.parent
    if not quick:
        if Path(what).suffix == ".toml" and file is None:
            raise InputError("there is no such file", near(Path(what)) or "Check the path", source=what)
        known = shipped_studies()
        there = f"Give a study file, one of {', '.join(known)}, or a case with --vary or --imperfection"
        raise InputError(
            f'"{what}" is no study, and nothing varies', f"{did_you_mean(what, known)} {there}".strip(), "sweep"
        )
    limits = Limits(rest["seconds"], rest["memory"] * 2**20)
    study = quick_study(what, methods, settings, limits, list(rest["multipliers"]), **quick)
    return changed(study, neighbours=rest["neighbours"]), None


def _executor(scheduler: str | None, jobs: int) -> Executor:
    if scheduler is None:
        return LocalExecutor(jobs)
    from harness.engine.cluster import ClusterExecutor

    return ClusterExecutor(scheduler)


def _leave(done: Sweep, folder: Path, rest: dict[str, Any]) -> None:
    """Tables, page and a few lines for the terminal; exit code 1 if the judge rejects a run, or none has an answer."""
    files = done.save(folder)
    page = folder.with_suffix(".html")
    if not rest["no_report"]:
        names = [f"{folder.name}/{path.name}" for path in files if path.suffix == ".csv"]
        done.report(page, shlex.join(["drystone", *sys.argv[1:]]), names)
    rejected = done.rejected
    statuses = Counter(str(row["status"]) for row in done.rows)
    answer = {
        "study": done.study.name,
        "runs": len(done.rows),
        "statuses": dict(statuses),
        "rejected": rejected,
        "warnings": list(done.warnings),
        "remarks": list(done.summary.remarks),
        "files": [str(path) for path in files],
        "report": None if rest["no_report"] else str(page),
    }
    if rest["as_json"]:
        print_json(answer)
    else:
        say(f"{len(done.rows):,} runs: " + ", ".join(f"{count:,} {name}" for name, count in statuses.items())
            + (f"; the judge rejects {rejected:,}" if rejected else ""))  # fmt: skip
        _print_multipliers(done, folder)
        for sentence in done.summary.remarks:
            say(sentence)
        say(f"Tables: {folder}/" + ("" if rest["no_report"] else f"\nReport: {page}"))
    sys.exit(1 if rejected or not statuses[str(Status.OK)] else 0)


def _print_multipliers(done: Sweep, folder: Path, most: int = 40) -> None:
    """The table of multipliers, as many rows as a screen shows; all are in the files."""
    rows = done.summary.by_method()
    if not rows:
        return
    print_rows(rows[:most])
    if len(rows) > most:
        say(f"and {len(rows) - most:,} rows more in {folder}/quantiles.csv")


def _tell_plan(
    asked: Study, runs: list[SweepRun], store: Path, jobs: int, warnings: Iterable[str], *, as_json: bool
) -> None:
    """How many runs there are, how many the store has, and what the rest may take by what like runs took."""
    stored: set[str] = set()
    costs: dict[str, list[float]] = {}
    if store.exists():
        with open_store(store, read_only=True) as opened:
            for key, _, method, _, _, _, _, seconds in opened.table():
                stored.add(key)
                costs.setdefault(method, []).append(seconds or 0.0)
    wanted = Counter(run.method for run in runs)
    left = Counter(run.method for run in runs if run.key not in stored)
    mean = {method: sum(costs[method]) / len(costs[method]) for method in wanted if costs.get(method)}
    unknown = [method for method in left if method not in mean]
    seconds = sum(left[method] * mean.get(method, 0.0) for method in left) / jobs
    if as_json:
        print_json({"study": asked.name, "runs": len(runs), "by_method": dict(wanted), "to_run": dict(left),
                    "estimated_seconds": None if unknown else seconds, "warnings": list(warnings)})  # fmt: skip
        return
    say(f"{asked.title}: {len(runs):,} runs, {sum(left.values()):,} of them not in {store}")
    for method, count in wanted.items():
        cost = f"{mean[method]:.3g} s a run, the mean of {len(costs[method]):,} in the store" if method in mean else (
            "no stored run gives its cost")  # fmt: skip
        say(f"  {method}: {count:,} runs, {left[method]:,} to make; {cost}")
    if not unknown:
        say(f"About {duration(seconds)} with {jobs} at a time, walls alike.")
    if asked.neighbours:
        say("Then runs use the mechanisms of their neighbours, which takes little time.")


@click.command(name="study")
@click.argument("name", required=False)
@catching
def study(name: str | None) -> None:
    """List the studies that come with Drystone, or print the file of one, to be changed and swept."""
    if name is None:
        for known, path in shipped_studies().items():
            read = read_study(path)
            count = len(expand(read, sources_of(read, (), path.parent)))
            say(f"{known:16s} {count:5d} runs: {read.question or read.title}")
        return
    say(shipped_study(name, "study").read_text(encoding="utf-8").rstrip("\n"))


@click.group(name="store")
def store_() -> None:
    """Work on result stores."""


@store_.command(name="merge")
@click.argument("into", type=click.Path(path_type=Path))
@click.argument("others", nargs=-1, required=True, type=click.Path(path_type=Path))
@catching
def merge(into: Path, others: tuple[Path, ...]) -> None:
    """Take the runs of OTHERS over INTO that it does not have; OTHERS stay as they are.

    Nothing is written where one of OTHERS is no store.
    """
    for other in others:
        if other.exists() and into.exists() and other.samefile(into):
            raise InputError("it is the store itself", "Name another store", source=str(other))
        with open_store(other, read_only=True):
            pass
    with open_store(into) as opened:
        for other in others:
            taken, there = opened.merge(other)
            say(f"{other}: {taken:,} runs copied, {there:,} were there already")


__all__ = ["STORE", "store_", "study", "sweep_"]
