"""What the commands share: options, exit codes, the files they also write, and how an input error is printed."""

from __future__ import annotations

import errno
import io
import json
import math
import os
import sys
import tomllib
from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.shell_completion import CompletionItem

from harness.engine.run import LONGEST, MOST_MEMORY, Analysed, Limits
from harness.model.case import Case, case_folders, shipped_cases
from harness.model.errors import InputError, visible
from harness.model.fields import LARGEST
from harness.model.json_text import MOST_SHOWN
from harness.model.live_load import both_signs as signs_of
from harness.model.live_load import is_horizontal, with_live_load
from harness.model.load_cases import load_cases_of
from harness.model.method_registry import listed_methods
from harness.model.writing import check_output, replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console


STORE = Path("out/drystone.sqlite")
_REPORT = Path("out/report.html")

_REMEDIES = {
    errno.EMFILE: "Raise the limit on open files of this process (ulimit -n) to 64 or more",
    errno.ENFILE: "End other programs: the machine has reached its limit of open files",
    errno.ENOSPC: "Free room on the disk and repeat the command",
    errno.EDQUOT: "Free room in your quota and repeat the command",
    errno.EFBIG: "Raise the limit on file sizes (ulimit -f) and repeat the command",
    errno.ENOMEM: "Give fewer --jobs, or end other programs",
    errno.EAGAIN: "Give fewer --jobs: the machine allows no more processes (ulimit -u)",
}
"""What can be done about errors of the operating system."""

INPUT_ERROR = 2
_INTERRUPTED = 130


def known_cases(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[CompletionItem]:
    """What a shell offers for CASE: ids of the library that begin so, else files."""
    ids = [name for name in case_folders([shipped_cases()]) if name.startswith(begun)]
    return [CompletionItem(name) for name in ids] or [CompletionItem(begun, type="file")]


def known_methods(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[CompletionItem]:
    """What a shell offers for METHOD or the last of A,B: names of methods that begin so."""
    before, comma, last = begun.rpartition(",")
    return [CompletionItem(f"{before}{comma}{name}") for name in listed_methods() if name.startswith(last)]


def known_suites(_context: click.Context, _parameter: click.Parameter, begun: str) -> list[CompletionItem]:
    """What a shell offers for a suite: those of the library that begin so."""
    files = [(folder / "case.toml").read_text(encoding="utf-8") for folder in case_folders([shipped_cases()]).values()]
    names = {"all", *(name for text in files for name in tomllib.loads(text).get("suites", []))}
    return [CompletionItem(name) for name in sorted(names) if name.startswith(begun)]


suite_option = click.option(
    "--suite", shell_complete=known_suites, help="A suite of cases.  [default: all cases, or those of --cases]"
)
case_argument = click.argument("case", shell_complete=known_cases)
cases_argument = click.argument("cases", nargs=-1, shell_complete=known_cases)


def catching(command: Callable[..., Any]) -> Callable[..., Any]:
    """Turn an input error into one clear line on standard error and exit code 2."""

    @wraps(command)
    def wrapped(*args: Any, **kwargs: Any) -> Any:
        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, io.TextIOWrapper):  # a terminal that has no sign for a letter gets its number
                stream.reconfigure(errors="backslashreplace")
        try:
            return command(*args, **kwargs)
        except InputError as error:
            say(f"drystone: {error}", err=True)
            sys.exit(INPUT_ERROR)
        except KeyboardInterrupt:
            say(f"drystone: interrupted{_kept()}", err=True)
            sys.exit(_INTERRUPTED)
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            sys.exit(0)
        except OSError as error:
            say(f"drystone: {_of_the_system(error)}{_kept()}", err=True)
            sys.exit(INPUT_ERROR)

    return wrapped


def _kept() -> str:
    """What a command that did not come to its end leaves behind, as the end of a sentence; empty without a store."""
    store = click.get_current_context().params.get("store")
    return "" if store is None else f"; finished runs are kept in {store}"


def console_of(width: int) -> Console:
    """Standard output, so wide where it is no terminal; its reader may go before the end, as `head` does.

    That is for `catching` to take: rich ends with exit code 1, which says that something failed.
    """
    from rich.console import Console

    class Left(Console):
        def on_broken_pipe(self) -> None:
            raise BrokenPipeError

    console = Left()
    return console if console.is_terminal else Left(width=width)


def say(text: str, *, err: bool = False) -> None:
    """Text on standard output or standard error, with what files may have put into it shown and not obeyed."""
    click.echo("\n".join(visible(line) for line in text.split("\n")), err=err)


def _of_the_system(error: OSError) -> str:
    """An error of the operating system as a sentence that names the file, and what can be done where that is known."""
    where = f"{error.filename}: " if error.filename else ""
    remedy = _REMEDIES.get(error.errno or 0, "")
    return f"{where}{error.strerror or error}" + (f". {remedy}" if remedy else "")


def finite(_context: click.Context, _option: click.Parameter, value: float) -> float:
    """A number that is one; raises click.BadParameter."""
    if not math.isfinite(value):
        raise click.BadParameter(f"{value} is not a finite number.")
    return value


def pair(text: str) -> tuple[float, float]:
    """Two numbers with a comma between them; raises click.BadParameter."""
    try:
        x, y = (float(part) for part in text.split(","))
    except ValueError:
        x = y = math.nan
    if not (abs(x) <= LARGEST and abs(y) <= LARGEST):
        problem = f"not two numbers up to {LARGEST:g} with a comma between them, as 1,0"
        raise click.BadParameter(f'"{text[:MOST_SHOWN]}" is {problem}.')
    return x, y


def as_loaded(case: Case, load_case: str | None, live: tuple[float, float] | None, *, both_signs: bool) -> list[Case]:
    """The load cases of a case, or the one that is chosen, under the live load that is asked for and both ways if so.

    Of several load cases those with a horizontal live load are answered both ways.

    Raises:
        InputError: no such load case, a live load of zero, or both signs of one that is not horizontal.
    """
    found = []
    for each in load_cases_of(case, load_case):
        loaded = each if live is None else with_live_load(each, *live)
        found += signs_of(loaded) if both_signs and (is_horizontal(loaded) or not each.load_case) else [loaded]
    return found


def print_json(value: Any) -> None:
    """One JSON document on standard output."""
    say_json(json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False))


def say_json(text: str) -> None:
    """JSON text on standard output; what a terminal might obey is written as the escape that JSON has for it."""
    lines = text.removesuffix("\n").split("\n")
    click.echo(
        "\n".join(
            "".join(letter if letter.isprintable() else json.dumps(letter)[1:-1] for letter in line) for line in lines
        )
    )


def _names(_context: click.Context, _option: click.Parameter, given: tuple[str, ...] | None) -> list[str] | None:
    """Names out of words with commas, each once; None where the option is not given."""
    if not given:
        return None
    names = list(dict.fromkeys(name.strip() for words in given for name in words.split(",") if name.strip()))
    if not names:
        raise click.BadParameter("it names no method; `drystone list methods` shows them.")
    return names


def methods_option(default: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """The option `--methods A,B`, with `--method` for the same.

    Args:
        default: what the help says is taken without it.
    """
    return click.option(
        "--methods",
        "--method",
        "methods",
        multiple=True,
        callback=_names,
        shell_complete=known_methods,
        metavar="A,B,...",
        help=f"Names of methods, separated by commas.  [default: {default}]",
    )


class OutputFile(click.Path):
    """The path of a file to write. What stands there is looked at before the work begins, not after it."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The path."""
        given = os.fsdecode(value)
        if not os.path.basename(given):
            self.fail(f'"{given}" names no file. Give the name of a file', param, ctx)
        path = super().convert(value, param, ctx)
        try:
            check_output(Path(os.fsdecode(path)))
        except InputError as error:
            self.fail(str(error), param, ctx)
        return path


OUTPUT = OutputFile(path_type=Path)

settings_option = click.option(
    "--set", "settings", multiple=True, metavar="NAME=VALUE", help="A setting of the method; may be repeated."
)
json_flag = click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
store_option = click.option("--store", type=click.Path(path_type=Path), default=STORE, show_default=True)
cases_option = click.option(
    "--cases",
    "folders",
    multiple=True,
    type=click.Path(path_type=Path),
    help="A further folder of case folders; may be repeated.",
)
jobs_option = click.option(
    "--jobs",
    type=click.IntRange(1),
    default=os.cpu_count() or 1,
    show_default="number of cores",
    help="Runs at a time.",
)
seconds_option = click.option(
    "--seconds", type=click.FloatRange(min=0.0, min_open=True, max=LONGEST), default=Limits().seconds,
    show_default=True, callback=finite, help="Wall-clock limit of one run.",
)  # fmt: skip
memory_option = click.option(
    "--memory", type=click.IntRange(16, MOST_MEMORY), default=Limits().memory_bytes // 2**20, show_default=True,
    help="Memory limit of one run [MiB].",
)  # fmt: skip
report_option = click.option(
    "--report", type=OUTPUT, default=_REPORT, show_default=True, help="Where the report is written."
)
junit_option = click.option("--junit", type=OUTPUT, help="Also write the outcomes as JUnit XML to this file.")
live_option = click.option(
    "--live",
    metavar="X,Y",
    callback=lambda _context, _option, value: None if value is None else pair(value),
    help="Live load as a multiple of every weight, in place of that of the file: 1,0 is to the right.",
)
load_case_option = click.option("--load-case", metavar="NAME", help="One of the named load cases of the wall.")
both_signs_flag = click.option(
    "--both-signs", is_flag=True, help="A horizontal live load both ways; the lower multiplier governs."
)
fresh_flag = click.option("--fresh", is_flag=True, help="Repeat runs that are in the store.")
own_store_option = click.option(
    "--store", type=click.Path(path_type=Path), help="Where runs are kept, and looked for first.  [default: nowhere]"
)


def runs_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The options of a command whose runs follow from each other: store and limits, which it gets as `runs`."""

    @own_store_option
    @fresh_flag
    @seconds_option
    @memory_option
    @wraps(command)
    def with_runs(*args: Any, store: Path | None, fresh: bool, seconds: float, memory: int, **kwargs: Any) -> Any:
        from harness.engine.pipeline import Runs

        return command(*args, runs=Runs(Limits(seconds, memory * 2**20), store, fresh), **kwargs)

    return with_runs


def warn(*cases: Analysed, also: Iterable[str] = ()) -> dict[str, list[str]]:
    """Tell what a person should hear about walls, on standard error, each sentence once.

    Args:
        cases: one wall, or one under several loads.
        also: what is to be said besides.

    Returns:
        The same as `warnings` of a JSON document.
    """
    told: dict[str, str] = {}
    for case in cases:
        for sentence in (*case.warnings, *also):
            told.setdefault(sentence, case.id)
    return tell(told)


def tell(told: Mapping[str, str]) -> dict[str, list[str]]:
    """Tell sentences, each with the name of its wall, as `warn` does."""
    for sentence, name in told.items():
        say(f"drystone: {name}: {sentence}", err=True)
    return {"warnings": list(told)}


def left_out_of(case: Case, remedy: str = "") -> tuple[str, ...]:
    """What a question about the dead load alone says where a wall has a live load, and how that acts."""
    if not case.assembly.has_live_load:
        return ()
    return (f"the live load of the wall does not act: this question is of its dead load alone {remedy}".rstrip(),)


TABLE = ".csv"


def check_table_or_figure(path: Path | None) -> None:
    """Refuse an ending that neither a table nor a figure has; asked before the work begins.

    Raises:
        InputError: naming the endings of figures.
    """
    if path is not None and path.suffix.lower() != TABLE:
        from reports.figures.figures import check_ending

        check_ending(path)


def write_output(path: Path | None, table: Callable[[], str], figure: Callable[[], Figure]) -> None:
    """Write the table, as CSV, or draw the figure; nothing without a path.

    Raises:
        InputError: as `check_table_or_figure`, or the path of something that is no regular file.
    """
    if path is None:
        return
    if path.suffix.lower() == TABLE:
        with replacing(path) as draft:
            draft.write_text(table(), encoding="utf-8")
        return
    from reports.figures.figures import save

    save(figure, path)
