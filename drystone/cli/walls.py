"""Commands about walls and answers that run no comparison: list, expand, judge, schema, figure, animate."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click
from pydantic import BaseModel

from drystone.analysis import judge as judge_answer
from drystone.cli import terminal
from drystone.cli.groups import OneOf
from drystone.cli.options import (
    OUTPUT,
    case_argument,
    cases_option,
    catching,
    json_flag,
    known_methods,
    load_case_option,
    methods_option,
    print_json,
    say,
    say_json,
    store_option,
    warn,
)
from drystone.walls import read_wall as wall_of_file
from harness.engine import pipeline
from harness.engine.plan import check_methods, check_taken, find_cases
from harness.engine.run import Limits, Run
from harness.engine.store import open_store
from harness.formats.registry import FORMATS
from harness.model.case import Case, case_folders, case_of_wall, read_case, shipped_cases
from harness.model.errors import InputError
from harness.model.foreign.description import Description
from harness.model.foreign.result_document import ResultDocument, answer_from_file
from harness.model.json_text import read_json
from harness.model.library import library
from harness.model.load_cases import load_cases_of
from harness.model.method import Finding, Status
from harness.model.method_registry import listed_methods, load_method
from harness.model.reading import read_wall, wall_json
from harness.model.result import Result
from harness.model.wall import Wall
from harness.model.writing import write_whole


@click.command(name="list")
@click.argument("what", type=OneOf(["cases", "methods", "suites", "formats"]))
@json_flag
@cases_option
@catching
def list_(what: str, as_json: bool, folders: tuple[Path, ...]) -> None:
    """List the cases, the methods, the suites or the file formats there are."""
    if what == "methods":
        rows = [_method_row(name) for name in listed_methods()]
    elif what == "formats":
        rows = [item.row() for item in FORMATS]
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
        print_json(rows)
    else:
        terminal.print_rows([{name: value for name, value in row.items() if name != "settings"} for row in rows])


def _method_row(name: str) -> dict[str, Any]:
    """A method as a row; one that cannot be loaded says why in place of its title."""
    try:
        method = load_method(name)
    except InputError as error:
        return {"name": name, "family": "", "title": str(error), "settings": {}}
    settings = method.Settings().model_dump(mode="json")
    return {"name": name, "family": method.family, "title": method.title, "settings": settings}


@click.command()
@click.argument("wall", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=OUTPUT, help="A file instead of standard output.")
@load_case_option
@catching
def expand(wall: Path, output: Path | None, load_case: str | None) -> None:
    """Print WALL.json in explicit form: every block with its weight, every interface with its friction.

    With --load-case it is the wall under that load case, which all commands take.
    """
    if load_case is None:
        built = read_wall(wall)
        explicit = built.wall
    else:
        (chosen,) = load_cases_of(case_of_wall(wall), load_case)
        built = chosen.built
        explicit = built.wall.model_copy(update={"title": chosen.file.title})
    for sentence in built.warnings:
        say(f"drystone: {sentence}", err=True)
    text = wall_json(explicit)
    if output is None:
        say_json(text)
    else:
        write_whole(output, text)


@click.command()
@click.argument("wall", type=click.Path(path_type=Path))
@click.argument("result", type=click.Path(path_type=Path))
@click.option("--tolerance", type=click.FloatRange(min=0.0, min_open=True), default=1e-9, show_default=True)
@json_flag
@catching
def judge(wall: Path, result: Path, tolerance: float, as_json: bool) -> None:
    """Judge RESULT.json, an answer for WALL.json that came from anywhere.

    RESULT.json holds "multiplier", "forces" (n1, n2, s of every interface in the order of `drystone expand`) and,
    for a collapse, "mechanism" (ux, uy, omega of every block) and "flow". An "unbounded" answer holds "live_forces"
    besides, which balance the live load alone. Exit code 0: accepted; 1: rejected; 3: not judged, because the answer
    shows nothing that proves its claim.
    """
    described = wall_of_file(wall)
    for sentence in described.warnings:
        say(f"drystone: {sentence}", err=True)
    answer = answer_from_file(read_json(result), described.assembly, str(result))
    judgement = judge_answer(described, answer, tolerance)
    if as_json:
        print_json(
            judgement.model_dump(mode="json") | {"multiplier": answer.multiplier, "finding": str(answer.finding)}
        )
    else:
        terminal.print_judgement(judgement)
    sys.exit(terminal.JUDGED[judgement.accepted])


@click.command()
@click.argument("what", type=OneOf(["wall", "result", "describe"]), default="wall")
@catching
def schema(what: str) -> None:
    """Print the JSON Schema of a format: wall/1, result/1 or describe/1."""
    models: dict[str, type[BaseModel]] = {"wall": Wall, "result": ResultDocument, "describe": Description}
    print_json(models[what].model_json_schema(by_alias=True))


@click.command()
@case_argument
@methods_option(library().methods.one)
@click.option(
    "--kind", type=OneOf(["mechanism", "forces", "thrust", "comparison"]), default="mechanism", show_default=True
)
@click.option("--format", "suffix", type=OneOf(["pdf", "svg", "png"]), default="pdf", show_default=True)
@click.option("-o", "--output", type=OUTPUT, help="File to write.  [default: CASE-KIND.FORMAT]")
@store_option
@cases_option
@catching
def figure(
    case: str,
    methods: list[str] | None,
    kind: str,
    suffix: str,
    output: Path | None,
    store: Path,
    folders: tuple[Path, ...],
) -> None:
    """Draw the answers of methods on CASE as a figure for a paper; needs drystone[figures]."""
    from reports.figures.figures import check_ending
    from reports.figures.figures import figure as draw

    if output is not None:
        check_ending(output)
    found, results = _answers(case, methods or [library().methods.one], store, folders)
    path = output or Path(f"{found.id}-{kind}.{suffix}")
    draw(found, results, kind, path)
    say(str(path))


@click.command()
@case_argument
@click.option("--method", shell_complete=known_methods, default=library().methods.one, show_default=True)
@click.option("-o", "--output", type=OUTPUT, help="A .gif, .png or .webp.  [default: CASE.gif]")
@store_option
@cases_option
@catching
def animate(case: str, method: str, output: Path | None, store: Path, folders: tuple[Path, ...]) -> None:
    """Animate the mechanism a method finds on CASE; needs drystone[figures]."""
    from reports.figures.animate import animate as draw
    from reports.figures.animate import check_ending

    if output is not None:
        check_ending(output)
    found, results = _answers(case, [method], store, folders)
    path = output or Path(f"{found.id}.gif")
    draw(found, results[0], path)
    say(str(path))


def _answers(case: str, methods: list[str], store: Path, folders: tuple[Path, ...]) -> tuple[Case, list[Result]]:
    check_methods(methods)
    (found,) = find_cases([case], None, folders)
    warn(found)
    for name in methods:
        check_taken(load_method(name), found, "--methods")
    with open_store(store) as opened, terminal.progress_bar(len(methods), quiet=True) as progress:
        results = pipeline.execute([Run(found, name, {}, Limits()) for name in methods], opened, 1, progress=progress)
    for result in results:
        if result.status is not Status.OK or result.finding in (Finding.NONE,):
            raise InputError(f"{result.method} has no answer to draw: {result.sentence}", element=found.id)
    return found, results
