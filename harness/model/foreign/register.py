"""The programs of `methods.toml`: methods in any language, by name.

The file is that of the working folder, or the one that the environment variable `DRYSTONE_METHODS` names. A program
that it lists is started only where its method is asked for, or described.
"""

from __future__ import annotations

import functools
import hashlib
import json
import os
import re
import shutil
import tomllib
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationInfo, field_validator, model_validator

from harness.model.errors import InputError
from harness.model.foreign.description import NAME, About
from harness.model.json_text import read_text, read_toml
from harness.model.method import method_points
from harness.model.reading import validate
from harness.model.writing import write_whole

_METHODS_FILE = "methods.toml"
VARIABLE = "DRYSTONE_METHODS"
"""Environment variable with the path of a file of methods, in place of that of the working folder."""
_MOST_BYTES = 1_000_000
_PLACES = ("{wall}", "{result}", "{arrays}", "{settings}", "{seconds}")
"""What stands in a command for the files and the time limit of a run."""


class Program(BaseModel):
    """A program as `methods.toml` lists it.

    Attributes:
        name: of the method.
        command: program and arguments, passed as they are and never through a shell; `_PLACES` are filled in.
        lines: one process answers many walls, a line of JSON each.
        arrays: with `lines`: requests name a file with the arrays of the wall.
        describe: the program prints what it is (`describe/1`) when it is given `--describe`.
        about: what is said of a program that does not describe itself.
        sources: further files whose change makes stored results old.
    """

    model_config = ConfigDict(defer_build=True, extra="forbid", frozen=True)
    name: str
    command: Annotated[tuple[str, ...], Field(min_length=1)]
    lines: bool = False
    arrays: bool = False
    describe: bool = False
    about: About = Field(default_factory=About)
    sources: tuple[str, ...] = ()

    @field_validator("command")
    @classmethod
    def _words_without_nul(cls, words: tuple[str, ...], info: ValidationInfo) -> tuple[str, ...]:
        if not words[0] or any("\0" in word for word in words):
            raise ValueError("the first word is the program, and no word has a NUL character")
        return words

    @model_validator(mode="after")
    def _places_that_fit(self) -> Program:
        used = {place for place in _PLACES for word in self.command if place in word}
        if self.lines and used:
            raise ValueError(f"a program that answers by lines is given no {', '.join(sorted(used))}")
        if not self.lines and not {"{wall}", "{result}"} <= used:
            raise ValueError('the command needs "{wall}" and "{result}", the files to read and to write')
        if self.describe and self.about != About():
            raise ValueError("a program that describes itself is not described here: leave `about` out")
        return self

    @property
    def bare(self) -> list[str]:
        """The command without the words that hold places: what `--describe` is added to."""
        return [word for word in self.command if not any(place in word for place in _PLACES)]

    @property
    def version(self) -> str:
        """Hash of the entry and of the files that it names: a program that was changed answers anew."""
        digest = hashlib.sha256(json.dumps(self.model_dump(mode="json"), sort_keys=True).encode())
        found = Path(shutil.which(self.command[0]) or self.command[0])
        if found.is_file():
            status = found.stat()
            digest.update(f"{found} {status.st_size} {status.st_mtime_ns}".encode())
        for word in (*self.command[1:], *self.sources):
            if Path(word).is_file():
                digest.update(Path(word).read_bytes())
        return digest.hexdigest()[:16]


class _File(BaseModel):
    model_config = ConfigDict(defer_build=True, extra="forbid")
    methods: dict[str, dict[str, Any]] = Field(default_factory=dict)


def methods_file() -> Path:
    """The file of methods: that of `DRYSTONE_METHODS`, else `methods.toml` in the working folder."""
    return Path(os.environ.get(VARIABLE) or _METHODS_FILE).absolute()


def programs() -> dict[str, Program]:
    """The programs of the file of methods, by name; none where there is no such file.

    Raises:
        InputError: the file that `DRYSTONE_METHODS` names is missing, an entry is wrong, or has an installed method's
            name.
    """
    path = methods_file()
    if os.environ.get(VARIABLE):
        os.environ[VARIABLE] = str(path)  # whole, since runs have folders of their own
    try:
        status = path.stat()
    except OSError:
        if os.environ.get(VARIABLE):
            raise InputError(
                "there is no such file", "Check the path of the file of methods", VARIABLE, str(path)
            ) from None
        return {}
    return _read(path, status.st_mtime_ns, status.st_size)


@functools.lru_cache(maxsize=8)
def _read(path: Path, _changed: int, _size: int) -> dict[str, Program]:
    """The programs of a file in one state of it."""
    entries = validate(_File, read_toml(path, _MOST_BYTES), str(path)).methods
    for name in sorted({point.name for point in method_points()} & set(entries)):
        raise InputError("an installed method has this name", "Take another name", f"methods.{name}", str(path))
    return {name: program_of(name, entry, path.parent, str(path)) for name, entry in entries.items()}


def program_named(name: str) -> Program | None:
    """The program that is the method of this name; None where that is installed, or there is none."""
    return programs().get(name)


def program_of(name: str, entry: dict[str, Any], folder: Path, source: str) -> Program:
    """A program from the fields of its entry; files beside `methods.toml` get their whole path.

    Args:
        name: of the method.
        entry: the fields of `Program` but its name.
        folder: where relative paths of the command and of sources begin.
        source: what errors call the file.

    Raises:
        InputError: a name or an entry that cannot be.
    """
    element = f"methods.{name}"
    if re.fullmatch(NAME, name) is None:
        remedy = "Give small letters, digits, dots, hyphens and underscores"
        raise InputError(f'"{name}" is no name of a method', remedy, element, source)
    try:
        made = validate(Program, {"name": name} | entry, source)
    except InputError as error:
        for fault in error.faults:
            fault.element = f"{element}.{fault.element}" if fault.element else element
        raise
    words = [_placed(word, folder, first=not k) for k, word in enumerate(made.command)]
    sources = [_placed(word, folder, first=False) for word in made.sources]
    return made.model_copy(update={"command": tuple(words), "sources": tuple(sources)})


def _placed(word: str, folder: Path, *, first: bool) -> str:
    """A word of a command, whole if it is a file beside the file of methods; a bare first word is looked up in PATH."""
    if first and "/" not in word:
        return word
    try:
        found = (folder / word).is_file()
    except (OSError, ValueError):
        return word
    return str((folder / word).absolute()) if found else word


def add_entry(path: Path, name: str, entry: dict[str, Any]) -> Program:
    """Write the entry of a program at the end of a file of methods, which is made if there is none.

    Args:
        path: the file of methods.
        name: of the method.
        entry: the fields of `Program` but its name, as they are to stand in the file.

    Raises:
        InputError: the file has a method of this name, or cannot be read, or the entry cannot be.
    """
    program = program_of(name, entry, path.parent, str(path))
    if any(point.name == name for point in method_points()):
        raise InputError("an installed method has this name", "Take another name", name)
    text = read_text(path, _MOST_BYTES) if path.exists() else ""
    if text and name in _read(path, path.stat().st_mtime_ns, path.stat().st_size):
        raise InputError("the file has a method of this name", "Take another name, or edit the file", name, str(path))
    head = f'[methods."{name}"]' if "." in name else f"[methods.{name}]"
    lines = [f"{key} = {_toml(value)}" for key, value in entry.items()]
    whole = "\n".join([*([text.rstrip("\n"), ""] if text else []), head, *lines, ""])
    if tomllib.loads(whole)["methods"][name] != json.loads(json.dumps(entry)):
        raise InputError("its words cannot be written as TOML", "Leave control characters out", name, str(path))
    write_whole(path, whole)
    return program


def _toml(value: Any) -> str:
    """JSON values as TOML: texts, numbers and lists are written alike."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_toml(item)}" for key, item in value.items()) + " }"
    return json.dumps(value, ensure_ascii=False)
