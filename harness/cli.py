"""The command `drystone`. Exit codes: 0 done, 1 a gated reference or the judge says no, 2 the input is wrong."""

from __future__ import annotations

import json
import os
import shlex
import sys
from collections.abc import Callable
from datetime import UTC, datetime
from functools import wraps
from importlib.metadata import version
from pathlib import Path
from typing import Any

import click

from harness import terminal
from harness.engine import compare as comparing
from harness.engine import baseline as recording
from harness.engine import regression
from harness.engine.judge import judge as judge_result
from harness.engine.plan import Limits, Run, check_methods, find_cases, gated_runs, plan_case
from harness.engine.store import open_store
from harness.model.case import Case, case_folders, read_case, shipped_cases
from harness.model.comparison import ComparisonRun
from harness.model.errors import InputError
from harness.model.method import Finding, Status, load_method, method_names
from harness.model.reading import read_json, read_wall, wall_json
from harness.model.result import Result, result_of
from harness.model.wall import Wall

STORE = Path("out/drystone.sqlite")
REPORT = Path("out/report.html")

INPUT_ERROR = 2


def _catching(command: Callable[..., Any]) -> Callable[..., Any]:
    """Turn an input error into one clear line on standard error and exit code 2."""

    @wraps(command)
    def wrapped(*args: Any, **kwargs: Any) -> Any:
        try:
            return command(*args, **kwargs)
        except InputError as error:
            click.echo(f"drystone: {error}", err=True)
            sys.exit(INPUT_ERROR)
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            sys.exit(0)
        except OSError as error:
            where = f"{error.filename}: " if error.filename else ""
            click.echo(f"drystone: {where}{error.strerror or error}", err=True)
            sys.exit(INPUT_ERROR)

    return wrapped


def _json(value: Any) -> None:
    click.echo(json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False))


_json_flag = click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
_store_option = click.option("--store", type=click.Path(path_type=Path), default=STORE, show_default=True)
_cases_option = click.option(
    "--cases",
    "folders",
    multiple=True,
    type=click.Path(path_type=Path),
    help="A further folder of case folders; may be repeated.",
)
_jobs_option = click.option(
    "--jobs",
    type=click.IntRange(1),
    default=os.cpu_count() or 1,
    show_default="number of cores",
    help="Runs at a time.",
)
_seconds_option = click.option(
    "--seconds", type=click.FloatRange(min=0.0, min_open=True), default=Limits().seconds, show_default=True,
    help="Wall-clock limit of one run.",
)  # fmt: skip
_memory_option = click.option(
    "--memory", type=click.IntRange(16), default=Limits().memory_bytes // 2**20, show_default=True,
    help="Memory limit of one run [MiB].",
)  # fmt: skip
_report_option = click.option(
    "--report", type=click.Path(path_type=Path), default=REPORT, show_default=True, help="Where the report is written."
)
_fresh_flag = click.option("--fresh", is_flag=True, help="Run again what is in the store.")


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
@_json_flag
@_cases_option
@_seconds_option
@_memory_option
@_catching
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
    check_methods([method])
    (found,) = find_cases([case], None, folders)
    chosen = _settings(method, settings)
    limits = Limits(seconds, memory * 2**20)
    references = tuple(item for item in found.file.references if method in item.applies_to and item.settings == chosen)
    _warn(found)
    (result,) = comparing.execute([Run(found, method, chosen, limits, references)], None, 1)
    if as_json:
        _json(result.model_dump(mode="json") if fields else result.summary())
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
            raise InputError(
                f'"{pair}" is no setting of {method}',
                f"Give NAME=VALUE with a name of: {', '.join(known) or '(it has none)'}",
                "--set",
            )
        try:
            values[name] = json.loads(text)
        except json.JSONDecodeError:
            values[name] = text
    from harness.model.reading import validate

    validate(load_method(method).Settings, values, f"--set of {method}")
    return values


def _warn(case: Case) -> None:
    for sentence in case.built.warnings:
        click.echo(f"drystone: {case.id}: {sentence}", err=True)


@main.command()
@click.argument("cases", nargs=-1)
@click.option("--suite", help='A suite of cases, or "all".  [default: small]')
@click.option(
    "--methods", help="Names of methods, separated by commas.  [default: fe,la,la-associated,de and those gated]"
)
@click.option("--seconds", type=float, default=Limits().seconds, show_default=True, help="Wall-clock limit of one run.")
@_memory_option
@_jobs_option
@_report_option
@_store_option
@_fresh_flag
@_json_flag
@_cases_option
@_catching
def compare(
    cases: tuple[str, ...],
    suite: str | None,
    methods: str | None,
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
        check_methods(names)
    limits = Limits(seconds, memory * 2**20)
    for case in chosen:
        _warn(case)
    runs = [planned for case in chosen for planned in plan_case(case, names, limits)]
    title = ", ".join(cases) if cases else f"suite {suite or 'small'}"
    with open_store(store) as opened:
        with terminal.progress(len(runs), quiet=as_json) as told:
            results = comparing.execute(runs, opened, jobs, fresh=fresh, told=told)
        compared = comparing.comparison_run(title, _command_line(), chosen, runs, results)
        comparing.remember(opened, compared, runs)
    _write_report(compared, report)
    if as_json:
        _json(terminal.comparison_json(compared, report))
    else:
        terminal.print_comparison(compared, report)
    sys.exit(1 if regression.violations(compared) else 0)


def _command_line() -> str:
    return shlex.join(["drystone", *sys.argv[1:]])


def _write_report(compared: ComparisonRun, path: Path) -> None:
    from reports.build import write_report

    path.parent.mkdir(parents=True, exist_ok=True)
    write_report(compared, path)


@main.command()
@_report_option
@_store_option
@_catching
def report(report: Path, store: Path) -> None:
    """Build the report of the last comparison again, from the store, without running anything."""
    if not store.is_file():
        raise InputError("there is no such store", "Run `drystone compare` first", source=str(store))
    with open_store(store) as opened:
        compared = comparing.recall(opened)
    if compared is None:
        raise InputError("no comparison is in the store", "Run `drystone compare` first", source=str(store))
    _write_report(compared, report)
    click.echo(f"Report: {report}")


@main.command()
@click.argument("cases", nargs=-1)
@click.option("--suite", help="A suite of cases.  [default: all cases]")
@click.option("--tier", type=click.Choice(["quick", "full"]), default="quick", show_default=True)
@_jobs_option
@_store_option
@_fresh_flag
@_json_flag
@_cases_option
@_catching
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
    check_methods(sorted({planned.method for planned in runs}))
    with open_store(store) as opened, terminal.progress(len(runs), quiet=as_json) as told:
        results = comparing.execute(runs, opened, jobs, fresh=fresh, told=told)
    lines = regression.lines(runs, results)
    if as_json:
        _json({"tier": tier, "references": lines, "passed": all(line["verdict"] == "agrees" for line in lines)})
    else:
        terminal.print_check(lines)
    sys.exit(0 if all(line["verdict"] == "agrees" for line in lines) else 1)


@main.command()
@click.argument("action", type=click.Choice(["show", "update"]), default="show")
@click.argument("cases", nargs=-1)
@click.option("--suite", help="A suite of cases.  [default: all cases]")
@click.option("--reason", default="", help="Why the recorded values change; an update needs it.")
@click.option("--file", "path", type=click.Path(path_type=Path), help="The baseline.  [default: the one shipped]")
@_jobs_option
@_store_option
@_json_flag
@_cases_option
@_catching
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
        _json({"action": action, "rows": rows})
    else:
        terminal.print_changes(rows)
    if action == "update":
        entry = recording.Entry(
            date=datetime.now(UTC).date().isoformat(), release=version("drystone"), reason=reason.strip()
        )
        recording.write_baseline(recorded_in, recording.updated(recorded, runs, results, entry))
    elif any(row["change"] == "worse" for row in rows):
        sys.exit(1)


@main.command(name="list")
@click.argument("what", type=click.Choice(["cases", "methods", "suites"]))
@_json_flag
@_cases_option
@_catching
def list_(what: str, as_json: bool, folders: tuple[Path, ...]) -> None:
    """List the cases, the methods or the suites there are."""
    if what == "methods":
        rows: list[dict[str, Any]] = []
        for name in method_names():
            method = load_method(name)
            rows.append(
                {
                    "name": name,
                    "family": method.family,
                    "title": method.title,
                    "settings": method.Settings().model_dump(mode="json"),
                }
            )
    else:
        cases = [read_case(folder) for folder in case_folders([shipped_cases(), *folders]).values()]
        if what == "cases":
            rows = [
                {
                    "id": case.id,
                    "title": case.file.title,
                    "kind": case.file.kind,
                    "suites": case.file.suites,
                    "references": len(case.file.references),
                }
                for case in cases
            ]
        else:
            names = sorted({suite for case in cases for suite in case.file.suites})
            rows = [
                {"name": suite, "cases": [case.id for case in cases if suite in case.file.suites]} for suite in names
            ]
            rows.append({"name": "all", "cases": [case.id for case in cases]})
    if as_json:
        _json(rows)
    else:
        terminal.print_rows(rows)


@main.command()
@click.argument("wall", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), help="A file instead of standard output.")
@_catching
def expand(wall: Path, output: Path | None) -> None:
    """Print WALL.json in explicit form: every block with its weight, every interface with its friction."""
    built = read_wall(wall)
    for sentence in built.warnings:
        click.echo(f"drystone: {sentence}", err=True)
    text = wall_json(built.wall)
    if output is None:
        click.echo(text, nl=False)
    else:
        output.write_text(text, encoding="utf-8")


@main.command()
@click.argument("wall", type=click.Path(path_type=Path))
@click.argument("result", type=click.Path(path_type=Path))
@click.option("--tolerance", type=click.FloatRange(min=0.0, min_open=True), default=1e-9, show_default=True)
@_json_flag
@_catching
def judge(wall: Path, result: Path, tolerance: float, as_json: bool) -> None:
    """Judge RESULT.json, an answer for WALL.json that came from anywhere.

    RESULT.json holds "multiplier", "forces" (n1, n2, s of every interface in the order of `drystone expand`) and,
    for a collapse, "mechanism" (ux, uy, omega of every block) and "flow".
    """
    built = read_wall(wall)
    answer = terminal.foreign_answer(read_json(result), built.assembly, str(result))
    judged = result_of(answer, built.assembly, case=wall.stem, method="foreign", family="foreign")
    judgement = judge_result(built.assembly, judged, tolerance)
    if as_json:
        _json(judgement.model_dump(mode="json") | {"multiplier": judged.multiplier, "finding": str(judged.finding)})
    else:
        terminal.print_judgement(judgement)
    sys.exit(0 if judgement.accepted else 1)


@main.command()
@_catching
def schema() -> None:
    """Print the JSON Schema of the wall format."""
    _json(Wall.model_json_schema(by_alias=True))


@main.command()
@click.argument("case")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=Path("wall.svg"), show_default=True)
@_cases_option
@_catching
def show(case: str, output: Path, folders: tuple[Path, ...]) -> None:
    """Draw CASE (an id or a WALL.json) to a file (.svg, .pdf, .png), before anything is run."""
    from reports.figures import show_wall

    (found,) = find_cases([case], None, folders)
    _warn(found)
    show_wall(found.built, output)
    click.echo(str(output))


@main.command()
@click.argument("case")
@click.option("--method", "methods", multiple=True, default=("la",), show_default=True, help="May be repeated.")
@click.option(
    "--kind", type=click.Choice(["mechanism", "forces", "thrust", "comparison"]), default="mechanism", show_default=True
)
@click.option("--format", "suffix", type=click.Choice(["pdf", "svg", "png"]), default="pdf", show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="File to write.  [default: CASE-KIND.FORMAT]")
@_store_option
@_cases_option
@_catching
def figure(
    case: str,
    methods: tuple[str, ...],
    kind: str,
    suffix: str,
    output: Path | None,
    store: Path,
    folders: tuple[Path, ...],
) -> None:
    """Draw the answers of methods on CASE as a figure for a paper."""
    from reports.figures import figure as draw

    found, results = _answers(case, methods, store, folders)
    path = output or Path(f"{found.id}-{kind}.{suffix}")
    draw(found, results, kind, path)
    click.echo(str(path))


@main.command()
@click.argument("case")
@click.option("--method", default="la", show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="A .gif, .png or .webp.  [default: CASE.gif]")
@_store_option
@_cases_option
@_catching
def animate(case: str, method: str, output: Path | None, store: Path, folders: tuple[Path, ...]) -> None:
    """Animate the mechanism a method finds on CASE."""
    from reports.animate import animate as draw

    found, results = _answers(case, (method,), store, folders)
    path = output or Path(f"{found.id}.gif")
    draw(found, results[0], path)
    click.echo(str(path))


def _answers(case: str, methods: tuple[str, ...], store: Path, folders: tuple[Path, ...]) -> tuple[Case, list[Result]]:
    check_methods(methods)
    (found,) = find_cases([case], None, folders)
    with open_store(store) as opened, terminal.progress(len(methods), quiet=True) as told:
        results = comparing.execute([Run(found, name, {}, Limits()) for name in methods], opened, 1, told=told)
    for result in results:
        if result.status is not Status.OK or result.finding in (Finding.NONE,):
            raise InputError(f"{result.method} has no answer to draw: {result.sentence}", element=found.id)
    return found, results


if __name__ == "__main__":
    main()
