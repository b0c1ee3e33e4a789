"""A method that is a program: started with a wall, or asked by lines, and its result read as any answer is.

What the program does wrong (another exit code, no result, a result that is none) is said of the method; limits of time
and memory are those of the run, whose process group the program belongs to.
"""

from __future__ import annotations

import functools
import json
import os
import signal
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import IO, Any

from harness.model.answer_check import AnswerFault
from harness.model.assembly import Assembly
from harness.model.deadline import Deadline
from harness.model.errors import InputError, visible
from harness.model.foreign.conversation import conversation_with
from harness.model.foreign.description import About, Description, settings_class
from harness.model.foreign.explicit import explicit_document, write_arrays
from harness.model.foreign.register import Program
from harness.model.foreign.result_document import answer_of
from harness.model.foreign.spawning import output_of, whole_address_space
from harness.model.json_text import json_of, read_json, text_of
from harness.model.method import Answer, Method, Settings
from harness.model.reading import validate

_DESCRIBE_SECONDS = 30.0
"""In which a program must have described itself: the slowest of interpreters start within a few."""
_MOST_WORDS = 1_000_000
"""Bytes of a description, and of what is printed beside it."""
_FAREST = 1e9
"""Seconds that a program without a limit is given: `{seconds}` is always a number."""
_run_folder: ContextVar[str | None] = ContextVar("run_folder", default=None)
"""The folder of the run under way, emptied after it whatever happens; None where a run has none of its own."""


class ProgramMethod(Method):
    """The method of a program.

    Args:
        program: as `methods.toml` lists it.

    Raises:
        InputError: the program cannot be started to describe itself, or its description is none.
    """

    def __init__(self, program: Program) -> None:
        about, schemas = program.about, {}
        if program.describe:
            described = description_of(program)
            about, schemas = described, described.settings
        self.program = program
        self.name = program.name
        self.family = about.family or program.name
        self.title = about.title or f"the program {Path(program.command[0]).name}"
        self.tolerance = about.tolerance
        self.traits = about.all_traits
        self.Settings = settings_class(program.name, schemas)
        self.fresh_process = not program.lines  # so that the memory of a program is that of its own run
        self.version = about.version
        self.about: About = about

    def prepare(self) -> None:
        """Start a program that answers by lines; one that is started for each wall must be there."""
        if self.program.lines:
            conversation_with(self.program).start()

    def processes_kept(self) -> list[int]:
        """The process that answers by lines, if it runs."""
        return conversation_with(self.program).processes() if self.program.lines else []

    def solve(self, assembly: Assembly, settings: Settings) -> Answer:
        """The answer of the program.

        Raises:
            InputError: the wall is larger than the program takes.
            AnswerFault: the program failed, or its result is none.
        """
        most = self.about.most_blocks
        if most is not None and assembly.n_free > most:
            raise InputError(
                f"{self.name} takes walls of up to {most:,} free blocks; this has {assembly.n_free:,}",
                "Take another method",
            )
        chosen = settings.model_dump(mode="json")
        with tempfile.TemporaryDirectory(prefix="program-", dir=_run_folder.get(), ignore_cleanup_errors=True) as name:
            folder = Path(name)
            data = self._asked(assembly, chosen, folder) if self.program.lines else self._ran(assembly, chosen, folder)
            try:
                return answer_of(data, assembly, "its result")
            except InputError as error:
                raise AnswerFault(str(error).replace("\n  ", ": ", 1).replace("\n  ", "; ")) from None

    def _asked(self, assembly: Assembly, settings: dict[str, Any], folder: Path) -> Any:
        """The result that a program which answers by lines gives."""
        request: dict[str, Any] = {"format": "request/1", "settings": settings, "seconds": _seconds()}
        if self.program.arrays:
            write_arrays(folder / "wall.npz", assembly)
            request["arrays"] = str(folder / "wall.npz")
        return conversation_with(self.program).ask(request | {"wall": explicit_document(assembly)})

    def _ran(self, assembly: Assembly, settings: dict[str, Any], folder: Path) -> Any:
        """The result that a program writes to its file."""
        places = {place: folder / f"{place}.json" for place in ("wall", "result", "settings")}
        places["arrays"] = folder / "wall.npz"
        asked = " ".join(self.program.command)
        places["wall"].write_text(json.dumps(explicit_document(assembly)), encoding="utf-8")
        places["settings"].write_text(json.dumps(settings), encoding="utf-8")
        if "{arrays}" in asked:
            write_arrays(places["arrays"], assembly)
        filled = {f"{{{name}}}": str(path) for name, path in places.items()} | {"{seconds}": f"{_seconds():.6g}"}
        words = [
            functools.reduce(lambda text, item: text.replace(*item), filled.items(), w) for w in self.program.command
        ]
        with open(folder / "output.txt", "w+b") as output:
            code = _run(words, folder, output)
            said = _last_line(output)
        if code:
            how = f"was ended by {_signal_name(-code)}" if code < 0 else f"ended with exit code {code}"
            raise AnswerFault(f"The program {how}{said}")
        if not places["result"].exists():
            raise AnswerFault(f"The program ended well and wrote no result{said}")
        try:
            return read_json(places["result"])
        except InputError as error:
            raise AnswerFault(f"Its result cannot be used: {error.problem}. {error.remedy}") from None


def _seconds() -> float:
    return min(Deadline.of_run().left, _FAREST)


def _run(words: list[str], folder: Path, output: IO[bytes]) -> int:
    """Run a program to its end, or end it where an exception asks for that; its exit code, negative for a signal.

    Raises:
        AnswerFault: it cannot be started.
    """
    try:
        with whole_address_space():
            process = subprocess.Popen(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=output, stderr=output)
    except OSError as error:
        raise AnswerFault(f"The program {words[0]} cannot be started: {error.strerror or error}") from None
    try:
        return process.wait()
    except BaseException:
        process.kill()
        process.wait()
        raise


def _last_line(output: IO[bytes], most: int = 4096) -> str:
    """What a program printed last, as the end of a sentence."""
    output.seek(max(0, os.fstat(output.fileno()).st_size - most))
    lines = output.read(most).decode("utf-8", "replace").strip().splitlines()
    return f". It last printed: {visible(lines[-1])[:200]}" if lines else ""


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


@functools.cache
def description_of(program: Program) -> Description:
    """What a program prints of itself when it is given `--describe`; asked once in a process.

    Raises:
        InputError: it cannot be started, fails, or prints no description.
    """
    words = [*program.bare, "--describe"]
    source = " ".join(words)
    remedy = "`--describe` prints one JSON object of format describe/1: docs/method-in-another-language.md"
    try:
        code, said, errors = output_of(words, _DESCRIBE_SECONDS, _MOST_WORDS)
    except OSError as error:
        raise InputError(
            f"it cannot be started ({error.strerror or error})", "Check the command", source=source
        ) from None
    except subprocess.TimeoutExpired:
        raise InputError(f"it does not end within {_DESCRIBE_SECONDS:g} s", remedy, source=source) from None
    except OverflowError:
        raise InputError("it prints more than a description", remedy, source=source) from None
    if code:
        lines = errors.decode("utf-8", "replace").strip().splitlines()
        last = f" ({visible(lines[-1])[:200]})" if lines else ""
        raise InputError(f"it ends with exit code {code}{last}", remedy, source=source)
    return validate(Description, json_of(text_of(said, source), source), source)


@functools.cache
def method_of(program: Program) -> ProgramMethod:
    """The method of a program, made once in a process."""
    return ProgramMethod(program)


@contextmanager
def running_in(folder: str) -> Iterator[None]:
    """Give the runs made inside a folder for their files."""
    token = _run_folder.set(folder)
    try:
        yield
    finally:
        _run_folder.reset(token)
