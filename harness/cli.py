"""The command `drystone`. Exit codes: 0 done, 1 a gated reference or the judge says no, 2 the input is wrong."""

from __future__ import annotations

import json
import shlex
import sys
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

import click

from harness import terminal
from harness.engine import baseline as recording
from harness.engine import compare as comparing
from harness.engine import regression
from harness.engine.imperfection import SEEDS, imperfection_runs, imperfection_study
from harness.engine.plan import Limits, Run, check_methods, find_cases, gated_runs, plan_case
from harness.engine.store import open_store
from harness.model.case import Case, shipped_cases
from harness.model.comparison import ComparisonRun
from harness.model.errors import InputError, did_you_mean
from harness.model.method import Status, load_method
from harness.options import (
    REPORT,
    cases_option,
    catching,
    fresh_flag,
    jobs_option,
    json_flag,
    memory_option,
    print_json,
    report_option,
    say,
    seconds_option,
    store_option,
    warn,
)
from harness.wall_commands import animate, expand, figure, judge, list_, schema, show

IMPERFECTION = "imperfection"


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(package_name="drystone")
def main() -> None:
    """Collapse multipliers of dry-jointed masonry by three families of methods, judged and compared.

    \b
    drystone show WALL.json -o wall.svg   draw a wall before anything is run
    drystone run la WALL.json             one method on one wall
    drystone compare WALL.json            all methods side by side, with a report
    drystone list cases                   the walls that come with Drystone
    """


@main.command()
@click.argument("method")
@click.argument("case")
@click.option(
    "--set", "settings", multiple=True, metavar="NAME=VALUE", help="A setting of the method; may be repeated."
)
@click.option("--fields", is_flag=True, help="With --json: contact forces, mechanism, states and path too.")
@json_flag
@cases_option
@seconds_option
@memory_option
@catching
def run(
    method: str,
    case: str,
    settings: tuple[str, ...],
    fields: bool,
    as_json: bool,
    folders: tuple[Path, ...],
    seconds: float,
    memory: int,
) -> None:
    """Run METHOD on CASE (an id, a case folder or a WALL.json) and print what it finds."""
    check_methods([method], "method")
    (found,) = find_cases([case], None, folders)
    chosen = _settings(method, settings)
    limits = Limits(seconds, memory * 2**20)
    references = tuple(item for item in found.file.references if method in item.applies_to and item.settings == chosen)
    warn(found)
    (result,) = comparing.execute([Run(found, method, chosen, limits, references)], None, 1)
    if as_json:
        print_json(result.model_dump(mode="json") if fields else result.summary())
    else:
        terminal.print_result(result, found)
    sys.exit(0 if result.status is Status.OK and result.judge.accepted is not False else 1)


def _settings(method: str, pairs: tuple[str, ...]) -> dict[str, Any]:
    if not pairs:
        return {}
    values: dict[str, Any] = {}
    known = load_method(method).Settings.model_fields
    for pair in pairs:
        name, equals, text = pair.partition("=")
        if not equals or name not in known:
            names = f"Give NAME=VALUE with a name of: {', '.join(known) or '(it has none)'}"
            raise InputError(
                f'"{pair}" is no setting of {method}', f"{did_you_mean(name, known)} {names}".strip(), "--set"
            )
        try:
            values[name] = json.loads(text)
        except json.JSONDecodeError:
            values[name] = text
    from harness.model.reading import validate

    validate(load_method(method).Settings, values, f"--set of {method}")
    return values


@main.command()
@click.argument("cases", nargs=-1)
@click.option("--suite", help='A suite of cases, or "all".  [default: small]')
@click.option(
    "--methods", help="Names of methods, separated by commas.  [default: fe,la,la-associated,de and those gated]"
)
@click.option(
    "--imperfection",
    "seeds",
    type=click.IntRange(1, 100),
    metavar="SEEDS",
    help="Also load the paper's wall of uneven blocks, so many of them for each size of defect.",
)
@seconds_option
@memory_option
@jobs_option
@report_option
@store_option
@fresh_flag
@json_flag
@cases_option
@catching
def compare(
    cases: tuple[str, ...],
    suite: str | None,
    methods: str | None,
    seeds: int | None,
    seconds: float,
    memory: int,
    jobs: int,
    report: Path,
    store: Path,
    fresh: bool,
    as_json: bool,
    folders: tuple[Path, ...],
) -> None:
    """Run methods on CASES (ids, case folders, WALL.json files) or a suite, judge, store and report."""
    chosen = find_cases(cases, suite, folders)
    names = [name.strip() for name in methods.split(",") if name.strip()] if methods is not None else None
    if names is not None:
        if not names:
            raise InputError("it names no method", "`drystone list methods` shows them", "--methods")
        check_methods(names)
    limits = Limits(seconds, memory * 2**20)
    for case in chosen:
        warn(case)
    title = ", ".join(cases) if cases else f"suite {suite or 'small'}"
    study = None if seeds is None else _imperfection(limits, seeds, jobs, store, fresh, quiet=as_json)[1]
    compared = _compare(title, chosen, names, limits, jobs, report, store, fresh, quiet=as_json, study=study)
    if as_json:
        print_json(terminal.comparison_json(compared, report))
    else:
        terminal.print_comparison(compared, report)
    sys.exit(1 if regression.violations(compared) else 0)


def _compare(
    title: str,
    chosen: list[Case],
    methods: list[str] | None,
    limits: Limits,
    jobs: int,
    report: Path,
    store: Path,
    fresh: bool,
    *,
    quiet: bool,
    study: dict[str, Any] | None = None,
) -> ComparisonRun:
    """Run, judge, store and report; what is printed afterwards is the command's own affair."""
    runs = [planned for case in chosen for planned in plan_case(case, methods, limits)]
    with open_store(store) as opened:
        with terminal.progress(len(runs), quiet=quiet) as told:
            results = comparing.execute(runs, opened, jobs, fresh=fresh, told=told)
        compared = comparing.comparison_run(title, _command_line(), chosen, runs, results)
        if study is not None:
            compared.provenance["studies"] = [study]
        comparing.remember(opened, compared, runs)
    _write_report(compared, report)
    return compared


@main.command()
@click.argument("name", required=False)
@jobs_option
@click.option("--report", type=click.Path(path_type=Path), help="Where it is written.  [default: out/NAME.html]")
@store_option
@fresh_flag
@catching
def study(name: str | None, jobs: int, report: Path | None, store: Path, fresh: bool) -> None:
    """Run the study NAME (without a name: list them) and report what many walls say together."""
    from cases.studies import STUDIES

    if name is None:
        for known, members in STUDIES.items():
            click.echo(f"{known:16s} {sum(1 for _ in members())} walls: {members.__doc__}")
        click.echo(f"{IMPERFECTION:16s} the paper's wall of uneven blocks: how far the multiplier falls, with scatter.")
        return
    if name not in (*STUDIES, IMPERFECTION):
        raise InputError(f'no study is called "{name}"', f"There are: {', '.join([*STUDIES, IMPERFECTION])}", "study")
    path = report or REPORT.with_name(f"{name}.html")
    if name == IMPERFECTION:
        case, found = _imperfection(Limits(), None, jobs, store, fresh, quiet=False)
        compared = _compare(f"study {name}", [case], None, Limits(), jobs, path, store, fresh, quiet=False, study=found)
        say(found["sentence"])
    else:
        chosen = list(STUDIES[name]())
        compared = _compare(f"study {name}", chosen, None, Limits(), jobs, path, store, fresh, quiet=False)
        terminal.print_agreement(compared)
    say(f"Report: {path}")


def _imperfection(
    limits: Limits, seeds: int | None, jobs: int, store: Path, fresh: bool, *, quiet: bool
) -> tuple[Case, dict[str, Any]]:
    """The paper's wall, and the study of it made of uneven blocks: `seeds` walls a size; None: all the study has."""
    (case,) = find_cases(["wall-21"], None, ())
    runs = imperfection_runs(case, limits, seeds=SEEDS if seeds is None else range(seeds))
    with open_store(store) as opened, terminal.progress(len(runs), quiet=quiet) as told:
        return case, imperfection_study(runs, comparing.execute(runs, opened, jobs, fresh=fresh, told=told))


def _command_line() -> str:
    return shlex.join(["drystone", *sys.argv[1:]])


def _write_report(compared: ComparisonRun, path: Path) -> None:
    from reports.build import write_report

    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        write_report(compared, path)
    except OSError as error:  # an error while writing to an open file does not say which
        error.filename = error.filename or str(path)
        raise


@main.command()
@report_option
@store_option
@catching
def report(report: Path, store: Path) -> None:
    """Build the report of the last comparison again, from the store, without running anything."""
    if not store.exists():
        raise InputError("there is no such store", "Run `drystone compare` first", source=str(store))
    with open_store(store, read_only=True) as opened:
        compared = comparing.recall(opened)
    if compared is None:
        raise InputError("no comparison is in the store", "Run `drystone compare` first", source=str(store))
    _write_report(compared, report)
    say(f"Report: {report}")


@main.command()
@click.argument("cases", nargs=-1)
@click.option("--suite", help="A suite of cases.  [default: all cases]")
@click.option("--tier", type=click.Choice(["quick", "full"]), default="quick", show_default=True)
@jobs_option
@store_option
@fresh_flag
@json_flag
@cases_option
@catching
def check(
    cases: tuple[str, ...],
    suite: str | None,
    tier: str,
    jobs: int,
    store: Path,
    fresh: bool,
    as_json: bool,
    folders: tuple[Path, ...],
) -> None:
    """Hold the methods to their gated references: one line each; exit code 1 on a violation."""
    chosen = find_cases(cases, suite if cases or suite else "all", folders)
    limits = Limits(seconds=120.0 if tier == "quick" else 3600.0)
    runs = [planned for case in chosen for planned in gated_runs(case, limits, tier)]
    check_methods(sorted({planned.method for planned in runs}), "applies_to of a gated reference")
    with open_store(store) as opened, terminal.progress(len(runs), quiet=as_json) as told:
        results = comparing.execute(runs, opened, jobs, fresh=fresh, told=told)
    lines = regression.lines(runs, results)
    if as_json:
        print_json({"tier": tier, "references": lines, "passed": all(line["verdict"] == "agrees" for line in lines)})
    else:
        terminal.print_check(lines)
    sys.exit(0 if all(line["verdict"] == "agrees" for line in lines) else 1)


@main.command()
@click.argument("action", type=click.Choice(["show", "update"]), default="show")
@click.argument("cases", nargs=-1)
@click.option("--suite", help="A suite of cases.  [default: all cases]")
@click.option("--reason", default="", help="Why the recorded values change; an update needs it.")
@click.option("--file", "path", type=click.Path(path_type=Path), help="The baseline.  [default: the one shipped]")
@jobs_option
@store_option
@json_flag
@cases_option
@catching
def baseline(
    action: str,
    cases: tuple[str, ...],
    suite: str | None,
    reason: str,
    path: Path | None,
    jobs: int,
    store: Path,
    as_json: bool,
    folders: tuple[Path, ...],
) -> None:
    """Show how today's values stand to the recorded ones (exit code 1 if one is worse), or record them."""
    if action == "update" and not reason.strip():
        raise InputError("an update of the baseline needs a reason", 'Give --reason "..."', "baseline")
    chosen = find_cases(cases, suite if cases or suite else "all", folders)
    recorded_in = path or shipped_cases() / "baseline.json"
    recorded = recording.read_baseline(recorded_in)
    runs = [planned for case in chosen for planned in plan_case(case, None, Limits())]
    with open_store(store) as opened, terminal.progress(len(runs), quiet=as_json) as told:
        results = comparing.execute(runs, opened, jobs, told=told)
    rows = recording.compare_with(recorded, runs, results)
    if as_json:
        print_json({"action": action, "rows": rows})
    else:
        terminal.print_changes(rows)
    if action == "update":
        entry = recording.Entry(
            date=datetime.now(UTC).date().isoformat(), release=version("drystone"), reason=reason.strip()
        )
        recording.write_baseline(recorded_in, recording.updated(recorded, runs, results, entry))
    elif any(row["change"] == "worse" for row in rows):
        sys.exit(1)


for command in (list_, expand, judge, schema, show, figure, animate):
    main.add_command(command)

if __name__ == "__main__":
    main()
