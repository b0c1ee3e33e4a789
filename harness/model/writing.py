"""Files that are either written whole or left as they were, and that replace nothing but a file; texts for tables."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from harness.model.errors import InputError

_FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""Beginnings of a cell that spreadsheets take for a formula."""


def check_output(path: Path) -> Path:
    """The path that an output is written to, links followed.

    Raises:
        InputError: something stands there that is no regular file: a folder, a device, a pipe; the folder can be
            neither made nor written to; or no file can have such a name.
    """
    try:
        target = path.resolve()
        there = target.exists()
        folder = next(each for each in target.parents if each.exists())
    except (OSError, RuntimeError) as error:  # too long, or links in a ring
        raise InputError(
            f"nothing can be written there ({getattr(error, 'strerror', None) or 'links in a ring'})",
            "Give another name",
            source=str(path),
        ) from None
    if there and not target.is_file():
        raise InputError(
            "it is not a regular file, and only regular files are replaced",
            "Give the name of a new file",
            source=str(path),
        )
    if not folder.is_dir():
        raise InputError(f'"{folder}" is no folder', "Give a name in a folder", source=str(path))
    if not os.access(folder, os.W_OK):
        raise InputError(f'nothing can be written in the folder "{folder}"', "Name another one", source=str(path))
    return target


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A file beside `path`, of the same ending, to be written within the context; it then takes the place of `path`.

    The folder is made if there is none. Where writing fails the earlier file stays as it was.

    Raises:
        InputError: something other than a regular file stands at `path`.
    """
    target = check_output(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.stem}-", suffix=target.suffix)
    os.close(handle)
    draft = Path(name)
    try:
        yield draft
        draft.chmod(0o644)
        draft.replace(target)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise


def write_whole(path: Path, content: str | bytes) -> None:
    """Write a file as `replacing` does.

    Args:
        path: the file.
        content: its text, written as UTF-8, or its bytes.

    Raises:
        OSError: it does not fit, or as `replacing`; with the name of the file.
    """
    try:
        with replacing(path) as draft:
            draft.write_bytes(content.encode() if isinstance(content, str) else content)
    except OSError as error:  # of a write it has no name, and of the draft one that nobody knows
        raise OSError(error.errno, error.strerror, str(path)) from error


def cell(value: Any) -> Any:
    """A value as a cell of a CSV file: a text that a spreadsheet would run as a formula gets an apostrophe before it.

    Texts that are numbers stay as they are, as numbers do.
    """
    if not isinstance(value, str) or not value.startswith(_FORMULA):
        return value
    try:
        float(value)
    except ValueError:
        return f"'{value}"
    return value


def uncelled(text: str) -> str:
    """The text that `cell` made a cell of."""
    return text[1:] if text.startswith("'") and cell(text[1:]) == text else text
