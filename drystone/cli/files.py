"""Commands between Drystone and other programs: import, export, and new walls of a few numbers."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args, get_type_hints

import click

from drystone.cli import terminal
from drystone.cli.groups import AskingGroup, OneOf
from drystone.cli.options import (
    INPUT_ERROR,
    OUTPUT,
    case_argument,
    cases_option,
    catching,
    known_methods,
    say,
    say_json,
    settings_option,
    store_option,
    warn,
)
from drystone.cli.settings import settings_of
from drystone.walls import started
from harness.engine import pipeline
from harness.engine.plan import check_methods, check_taken, find_cases
from harness.engine.run import Limits, Run
from harness.engine.sensitivity import advised
from harness.engine.store import open_store
from harness.formats.registry import FORMATS, format_written
from harness.model import inspection
from harness.model.errors import InputError
from harness.model.load_steps import NAME as LOAD_STEPS
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from harness.model.reading import wall_json
from harness.model.units import LengthUnit
from harness.model.wall import Wall
from harness.model.writing import write_whole

KEPT = 50
"""Load steps of a series, unless a setting says otherwise: two seconds of a film."""


def _endings(use: str, meaning: str) -> str:
    """The formats that are read or written, for a help text: a row each."""
    rows = [f"{' '.join(item.suffixes):<10s}{getattr(item, meaning)}" for item in FORMATS if getattr(item, use)]
    return "\n".join(["\b", *rows])


@click.command("import", epilog=_endings("reader", "stones"))
@click.argument("drawing", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=OUTPUT, help="A file instead of standard output.")
@click.option(
    "--mapping", type=click.Path(path_type=Path), help="Data that the drawing lacks.  [default: DRAWING.toml]"
)
@click.option("--units", type=OneOf(get_args(LengthUnit)), help="Of the drawing, whatever it declares.")
@click.option("--scale", metavar="1:N", help="Lengths of the wall in lengths of the drawing, as 1:50 or 50.")
@click.option("--supports", help='lowest-course, "ground-line Y" or "layer NAME".')
@click.option("--tolerance", type=click.FloatRange(0.0, min_open=True), help="Greatest gap of a joint, of the wall.")
@click.option("--friction", type=click.FloatRange(0.0), help="Coefficient of friction of every joint.")
@click.option("--unit-weight", type=click.FloatRange(0.0), help="[kN/m3]")
@click.option("--thickness", type=click.FloatRange(0.0, min_open=True), help="Out of plane, of the wall.")
@click.option("--accuracy", type=click.FloatRange(0.0, min_open=True), help="Of curves [m].  [default: 0.001]")
@click.option(
    "--plane",
    type=OneOf(["xz", "yz", "xy"]),
    help="Of solids [default: xz], of a DXF [default: xy].",
)
@click.option("--at", type=float, help="Where the plane lies on the third axis.  [default: the middle]")
@catching
def import_(drawing: Path, output: Path | None, mapping: Path | None, **said: Any) -> None:
    """Make a WALL.json of DRAWING.

    What was read, what was left out and why, and what is taken because the drawing does not say it stands on standard
    error, in the wall's metadata, and, where it is left out or guessed, in its doubts, which every command repeats. A
    wall with faults is written too, to be looked at; exit code 2 then.
    """
    from harness.formats.importing import Mapping, import_drawing, mapping_beside, read_mapping
    from harness.model.reading import validate

    base = mapping_beside(drawing) if mapping is None else read_mapping(mapping)
    given = {name: value for name, value in said.items() if value is not None}
    chosen = validate(Mapping, base.model_dump(exclude_none=True) | given, "the options")
    imported = import_drawing(drawing, chosen)
    for sentence in imported.account:
        say(f"drystone: {drawing.name}: {sentence}", err=True)
    looked = inspection.inspect(imported.wall, drawing.stem)
    for sentence in looked.sentences(advised(looked)):
        if sentence.partition(": ")[2] not in imported.account:
            say(f"drystone: {drawing.name}: {sentence}", err=True)
    _write(wall_json(imported.wall), output)
    sys.exit(INPUT_ERROR if looked.faults else 0)


def _write(text: str, output: Path | None) -> None:
    if output is None:
        say_json(text)
    else:
        write_whole(output, text)
        say(str(output))


@click.command(epilog=_endings("writer", "holds"))
@case_argument
@click.option(
    "--method", shell_complete=known_methods, help="Method whose answer is written too; the wall alone if absent."
)
@click.option("-o", "--output", type=OUTPUT, required=True, help="Its ending determines the format.")
@settings_option
@store_option
@cases_option
@catching
def export(
    case: str, method: str | None, output: Path, settings: tuple[str, ...], store: Path, folders: tuple[Path, ...]
) -> None:
    """Write CASE (an id, a WALL.json or a drawing) for other programs, with the answer of a method."""
    written = format_written(output)
    chosen = {} if method is None else _settings(method, settings, output)
    (found,) = find_cases([case], None, folders)
    warn(found)
    result = None
    if method is not None:
        check_taken(load_method(method), found, "--method")
        with open_store(store) as opened, terminal.progress_bar(1, quiet=True) as progress:
            (result,) = pipeline.execute([Run(found, method, chosen, Limits())], opened, 1, progress=progress)
        if result.status is not Status.OK or result.finding is Finding.NONE:
            raise InputError(f"{result.method} has no answer to write: {result.sentence}", element=found.id)
        say(f"drystone: {found.id}: {result.sentence}", err=True)
    written.write(found.built, result, output)
    say(str(output))


def _settings(method: str, given: tuple[str, ...], output: Path) -> dict[str, Any]:
    """Settings of the method that answers; for a series with those that make it keep one, if it can."""
    check_methods((method,), "--method")
    chosen = settings_of(method, given)
    if output.suffix.lower() == ".pvd" and LOAD_STEPS in load_method(method).Settings.model_fields:
        return {LOAD_STEPS: KEPT} | chosen
    return chosen


class Kinds(AskingGroup):
    """A group with a command for every kind of wall, its options those of the maker, and one for a method."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all kinds."""
        from cases.start import STARTS

        return [*STARTS, "method"]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command that makes a wall of this kind; None if there is none."""
        from cases.start import STARTS

        if cmd_name == "method":
            from drystone.cli.methods import new_method

            return new_method
        return _kind(cmd_name, STARTS[cmd_name]) if cmd_name in STARTS else None


@click.group(cls=Kinds)
def new() -> None:
    """Make a wall of a kind from a few numbers, asked for on a terminal when none is given; or begin a method."""


def _kind(name: str, maker: Callable[..., Wall]) -> click.Command:
    hints = get_type_hints(maker)
    numbers = {parameter.name: parameter for parameter in inspect.signature(maker).parameters.values()}

    @catching
    def command(output: Path | None, **said: Any) -> None:
        given = {key: value for key, value in said.items() if value is not None}
        if not given and numbers and sys.stdin.isatty():
            given = {
                key: click.prompt(key.replace("_", " "), default=item.default, type=hints[key])
                for key, item in numbers.items()
            }
        _write(wall_json(started(maker, name, given)), output)

    options: list[click.Parameter] = [
        click.Option([f"--{key.replace('_', '-')}", key], type=hints[key], help=f"[default: {item.default}]")
        for key, item in numbers.items()
    ]
    options.append(click.Option(["-o", "--output"], type=OUTPUT, help="A file instead of standard output."))
    return click.Command(name, params=options, callback=command, help=inspect.getdoc(maker))
