"""The command that runs the conformance suite on methods."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import click

from drystone.cli import terminal
from drystone.cli.methods import words_of
from drystone.cli.options import catching, json_flag, known_methods, print_json, say
from harness.conformance import ConformanceCheck, conforms, suite
from harness.engine.plan import check_methods
from harness.engine.threads import pin
from harness.model.errors import InputError
from harness.model.foreign.program_method import method_of
from harness.model.foreign.register import program_of
from harness.model.method import Method
from harness.model.method_registry import load_method, prepared


@click.command()
@click.argument("methods", nargs=-1, shell_complete=known_methods)
@click.option("--command", help='A program instead, as "prog {wall} {result}"; it is started without a shell.')
@click.option("--lines", is_flag=True, help="With --command: it answers by lines on its standard streams.")
@click.option("--describe", is_flag=True, help="With --command: it prints what it is when given --describe.")
@json_flag
@catching
def conformance(methods: tuple[str, ...], command: str | None, lines: bool, describe: bool, as_json: bool) -> None:
    """Run the conformance suite on METHODS: closed forms, views of one wall, refusals, endings, limits, manners.

    A method conforms if nothing fails and it answers at least one wall of which the value is known; what it refuses by
    name is no fault. Exit code 0: all conform; 1: one does not; 2: wrong input.
    """
    asked = _of_command(command, lines=lines, describe=describe) if command is not None else []
    if not methods and not asked:
        raise InputError("no method is named", "Give names of methods, or --command", "conformance")
    check_methods(list(methods), "methods")
    pin()
    documents = []
    for method in (*map(load_method, methods), *asked):
        rows = [check.row(prepared(method)) for check in _shown(method.name, list(suite()), quiet=as_json)]
        document = {"method": method.name, "conforms": conforms(rows), "checks": [row.as_json() for row in rows]}
        documents.append(document)
        if not as_json:
            _print(method, document)
    if as_json:
        print_json(documents)
    sys.exit(0 if all(document["conforms"] for document in documents) else 1)


def _shown(title: str, checks: list[ConformanceCheck], *, quiet: bool) -> Iterator[ConformanceCheck]:
    """The checks one by one, with a bar on a terminal."""
    hidden = quiet or not sys.stderr.isatty()
    with click.progressbar(checks, label=title, file=sys.stderr, hidden=hidden) as bar:
        yield from bar


def _of_command(command: str, *, lines: bool, describe: bool) -> list[Method]:
    entry = {"command": words_of(command), "lines": lines, "describe": describe}
    return [method_of(program_of("program", entry, Path.cwd(), "--command"))]


def _print(method: Method, document: dict[str, object]) -> None:
    rows = document["checks"]
    assert isinstance(rows, list)
    names = ("group", "check", "outcome", "cpu_seconds", "sentence")
    shown = [{name: row[name] for name in names} | {"cpu_seconds": f"{row['cpu_seconds']:.3f}"} for row in rows]
    terminal.print_rows(shown)
    met, refused, failed = (sum(row["outcome"] == end for row in rows) for end in ("conforms", "refused", "fails"))
    seconds = sum(row["cpu_seconds"] for row in rows)
    verdict = "conforms" if document["conforms"] else "does not conform"
    say(f"{method.name} {verdict}. Checks: {met} passed, {refused} refused, {failed} failed; {seconds:.2f} s of CPU.")
