"""Commands that run many methods and report: compare, report, learn."""

from __future__ import annotations

import os
import shlex
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

import click

from drystone.cli import terminal
from drystone.cli.junit import tests_of_comparison, write_junit
from drystone.cli.options import (
    OUTPUT,
    as_loaded,
    both_signs_flag,
    cases_argument,
    cases_option,
    catching,
    fresh_flag,
    jobs_option,
    json_flag,
    junit_option,
    known_suites,
    live_option,
    load_case_option,
    memory_option,
    methods_option,
    print_json,
    report_option,
    say,
    seconds_option,
    store_option,
    warn,
)
from drystone.cli.printing import PrintError, print_pdf
from drystone.cli.settings import method_settings
from drystone.cli.studies import curve_of_shipped
from drystone.comparing import compare as make_comparison
from drystone.comparing import compared, recalled
from drystone.walls import Wall
from harness.engine.executors import LocalExecutor
from harness.engine.isolate import preload_methods
from harness.engine.plan import check_methods, find_cases, plan_case
from harness.engine.run import Limits
from harness.engine.store import open_store
from harness.engine.verdict import violations
from harness.model.comparison import ComparisonRun
from harness.model.errors import InputError
from harness.model.library import library
from harness.model.live_load import is_horizontal, reversed_live
from harness.model.load_cases import load_cases_of
from harness.model.method_registry import method_names


@click.command()
@cases_argument
@click.option("--suite", shell_complete=known_suites, help='A suite of cases, or "all".  [default: small]')
@methods_option(f"{','.join(library().methods.compare)} and those that checked references name")
@click.option(
    "--study",
    "studied",
    metavar="NAME[:AMOUNT]",
    help="Also run a study of Drystone and draw its curve in the report; AMOUNT is a number of seeds "
    "(12) or a time that takes as many as fit (60s).",
)
@click.option(
    "--set", "settings", multiple=True, metavar="METHOD.NAME=VALUE", help="A setting of a method; may be repeated."
)
@load_case_option
@live_option
@both_signs_flag
@click.option("--no-report", is_flag=True, help="Print and store only.")
@seconds_option
@memory_option
@jobs_option
@report_option
@store_option
@fresh_flag
@junit_option
@json_flag
@cases_option
@catching
def compare(
    cases: tuple[str, ...],
    suite: str | None,
    methods: list[str] | None,
    studied: str | None,
    settings: tuple[str, ...],
    load_case: str | None,
    live: tuple[float, float] | None,
    both_signs: bool,
    no_report: bool,
    seconds: float,
    memory: int,
    jobs: int,
    report: Path,
    store: Path,
    fresh: bool,
    junit: Path | None,
    as_json: bool,
    folders: tuple[Path, ...],
) -> None:
    """Run methods on CASES (ids, case folders, WALL.json files) or a suite, judge, store and report."""
    _check_no_methods(cases, methods)
    named = find_cases(cases, suite, folders)
    chosen = [each for case in named for each in as_loaded(case, load_case, live, both_signs=both_signs)]
    if methods is not None:
        check_methods(methods)
    limits = Limits(seconds, memory * 2**20)
    for case in chosen:
        warn(case)
    title = ", ".join(case.id for case in named) if cases else f"suite {suite or 'small'}"
    asked = method_settings(settings)
    written = None if no_report else report
    planned = [run for case in chosen for run in plan_case(case, methods, limits, settings=asked)]
    preload_methods(run.method for run in planned)
    study = [] if studied is None else [curve_of_shipped(studied, jobs, store, fresh=fresh, quiet=as_json)]
    with terminal.progress_bar(len(planned), quiet=as_json) as progress:
        made = make_comparison(
            [Wall(case) for case in chosen],
            methods,
            jobs=jobs,
            seconds=limits.seconds,
            memory_bytes=limits.memory_bytes,
            store=store,
            settings=asked,
            fresh=fresh,
            progress=progress,
            title=title,
            command=_command_line(),
            studies=study,
        ).run
    if written is not None:
        _write_report(made, written)
    if junit is not None:
        write_junit(f"drystone compare, {title}", tests_of_comparison(made), junit)
    if as_json:
        print_json(terminal.comparison_json(made, written))
    else:
        terminal.print_comparison(made, written)
    sys.exit(1 if violations(made) else 0)


def _command_line() -> str:
    return shlex.join(["drystone", *sys.argv[1:]])


def _write_report(compared: ComparisonRun, path: Path, *, drawn: bool = False) -> None:
    from reports.page.build import write_report

    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        write_report(compared, path, drawn=drawn)
    except OSError as error:  # an error while writing to an open file does not say which
        error.filename = error.filename or str(path)
        raise


@click.command()
@report_option
@click.option("--figures", is_flag=True, help="Also draw each case as a PDF beside the report, with drystone[figures].")
@click.option("--appendix", metavar="WALL", help="Run WALL and write an engineer's appendix on it, as HTML and PDF.")
@store_option
@catching
def report(report: Path, figures: bool, appendix: str | None, store: Path) -> None:
    """Build the report of the last comparison again, from the store, without running anything.

    With --appendix, which needs drystone[figures], write two to four sheets on one wall beside the report: result,
    assumptions, loads, drawing, reactions, mechanism, forces. What the store does not have is run.
    """
    if figures:
        import_module("reports.figures")  # refused before anything is written where matplotlib is missing
    if appendix is not None:
        _appendix(appendix, report.parent, store)
        return
    _write_report(recalled(store), report, drawn=figures)
    say(f"Report: {report}")


def _appendix(wall: str, folder: Path, store: Path) -> None:
    """Run the methods on one wall and write its appendix; the PDF where a browser is installed.

    All load cases of the file are analysed. Without them a horizontal live load is analysed both ways, because an
    earthquake comes from either side.
    """
    from reports.appendix import write_appendix

    (named,) = find_cases([wall], None, ())
    title, chosen = named.id, load_cases_of(named)
    for case in chosen:
        warn(case)
    if not chosen[0].load_case and is_horizontal(named):
        chosen = [named, reversed_live(named)]
    runs = [planned for case in chosen for planned in plan_case(case, None, Limits())]
    executor = LocalExecutor(os.cpu_count() or 1)
    with open_store(store) as opened, terminal.progress_bar(len(runs), quiet=False) as progress:
        made = compared(title, _command_line(), chosen, runs, opened, executor, progress=progress)
    page = folder / f"{title}-appendix.html"
    write_appendix(made, page)
    say(f"Appendix: {page}")
    try:
        print_pdf(page, page.with_suffix(".pdf"))
    except PrintError as error:
        say(f"drystone: {error}", err=True)
    else:
        say(f"Appendix: {page.with_suffix('.pdf')}")


_TAUGHT = ("wall-21-friction-030", "wall-21-friction-050", "wall-21", "wall-21-friction-075", "wall-21-friction-100")
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

    chosen = find_cases(("single-block", *_TAUGHT), None, ())
    runs = [planned for case in chosen for planned in plan_case(case, list(library().methods.compare), Limits())]
    command, title = shlex.join(["drystone", *sys.argv[1:]]), "Why three methods differ"
    with open_store(store) as opened, terminal.progress_bar(len(runs), quiet=False) as progress:
        made = compared(title, command, chosen, runs, opened, LocalExecutor(jobs), progress=progress, certified=False)
    write_learn(made, output)
    say(f"Page: {output}")


def _check_no_methods(words: Sequence[str], methods: Sequence[str] | None) -> None:
    """Refuse words in the place of cases that are names of methods, as of a list without commas.

    Raises:
        InputError: one is a method, and there is no such file.
    """
    found = [word for word in words if word in method_names() and not Path(word).exists()]
    if found:
        asked = ",".join(dict.fromkeys([*(methods or ()), *found]))
        raise InputError(
            f'"{found[0]}" is a method and no case', f"Separate methods by commas: --methods {asked}", "cases"
        )
