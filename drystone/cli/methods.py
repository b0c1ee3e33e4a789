"""Commands about methods in any language: methods add, new method."""

from __future__ import annotations

import re
import shlex
from importlib.resources import files
from pathlib import Path
from typing import Any, get_args

import click

from drystone.cli.groups import AskingGroup, OneOf
from drystone.cli.options import catching, say
from harness.model.errors import InputError
from harness.model.foreign.description import NAME, Feature
from harness.model.foreign.program_method import description_of, method_of
from harness.model.foreign.register import add_entry, methods_file, program_of
from harness.model.writing import write_whole

_LANGUAGES = ("python", "c", "javascript")


def words_of(command: str) -> list[str]:
    """The words of a command line, split as a shell splits them; no shell ever runs them.

    Raises:
        InputError: a quote that is not closed.
    """
    try:
        return shlex.split(command)
    except ValueError as error:
        raise InputError(f"it cannot be split into words ({error})", "Close every quote", "--command") from None


@click.group(cls=AskingGroup)
def methods() -> None:
    """Register programs in any language as methods, by entries of methods.toml."""


@methods.command()
@click.argument("name")
@click.option("--command", required=True, help='The program and its arguments, as "prog {wall} {result}".')
@click.option("--lines", is_flag=True, help="It answers many walls, a line of JSON each, on its standard streams.")
@click.option("--arrays", is_flag=True, help="With --lines: requests name a file with the arrays of the wall.")
@click.option("--title", help="A few words for the head of a column, of a program that does not describe itself.")
@click.option("--family", help="Groups methods in the report.  [default: NAME]")
@click.option("--tolerance", type=float, help="Largest residual that the judge may find.  [default: 1e-7]")
@click.option("--takes", multiple=True, type=OneOf(get_args(Feature)), help="Features of walls; may be repeated.")
@catching
def add(name: str, command: str, lines: bool, arrays: bool, takes: tuple[str, ...], **said: Any) -> None:
    """Add a program to methods.toml as the method NAME.

    In the command {wall}, {result}, {arrays}, {settings} and {seconds} are filled in for every run. It is started
    without a shell. A program that prints JSON of format describe/1 when given --describe describes itself.
    """
    path = methods_file()
    about = {key: value for key, value in said.items() if value is not None} | ({"takes": takes} if takes else {})
    entry: dict[str, Any] = {"command": words_of(command)}
    entry |= {key: True for key, given in (("lines", lines), ("arrays", arrays)) if given}
    if about:
        entry["about"] = about
    elif _describes_itself(name, entry, path):
        entry["describe"] = True
    method = method_of(add_entry(path, name, entry))
    how = "described by itself" if method.program.describe else "described by its entry"
    say(f"{path}: {name}, {method.title} ({how})")
    say(f"Try it: drystone run {name} slide; drystone conformance {name}")


def _describes_itself(name: str, entry: dict[str, Any], path: Path) -> bool:
    """Whether a program prints a description; one that is wrong is reported, and the program taken as it is.

    Raises:
        InputError: the program cannot be started, or an entry cannot be.
    """
    try:
        description_of(program_of(name, entry, path.parent, str(path)))
    except InputError as error:
        if "cannot be started" in error.problem or error.source == str(path):
            raise
        say(f"drystone: {name} does not describe itself: {error}", err=True)
        return False
    return True


@click.command()
@click.argument("name")
@click.option("--language", type=OneOf(_LANGUAGES), default="python", show_default=True)
@catching
def new_method(name: str, language: str) -> None:
    """Write a method that works, with its tests, into a new folder NAME: the place to begin one of your own.

    python: the associated maximum by SciPy, a package with an entry point. c: walls in which one joint carries each
    block. javascript: the associated maximum by a simplex method, asked by lines.
    """
    if re.fullmatch(NAME, name) is None or not re.sub(r"\W", "", name)[:1].isalpha():
        raise InputError(f'"{name}" is no name of a method', "Give small letters, digits and hyphens, as my-method")
    folder = Path(name)
    if folder.exists():
        raise InputError("it exists already", "Take another name, or remove it", source=str(folder))
    module = re.sub(r"\W", "_", name)
    places = {"NAME": name, "MODULE": module, "CLASS": "".join(part.title() for part in module.split("_"))}
    skeleton = files("drystone") / "skeletons" / language
    for file in sorted((item for item in skeleton.iterdir() if item.is_file()), key=lambda item: item.name):
        text = file.read_text(encoding="utf-8")
        for place, word in places.items():
            text = re.sub(rf"\b{place}\b", word, text)
        path = folder / file.name.replace("MODULE", module)
        write_whole(path, text)
        say(str(path))
    say(f"Next: see {folder / 'README.md'}")
