"""Why a store cannot be used, in words of a person: from those of the database and a look at the file."""

from __future__ import annotations

import errno
import os
import sqlite3
from pathlib import Path

WAIT_SECONDS = 60.0
"""How long another program that writes the store is waited for."""
OTHER_FILE = "Name a result store, as runs with --store write it"


def cause(error: sqlite3.Error, path: Path) -> tuple[str, str]:
    """What went wrong and what to do, from the words of the database and a look at the file."""
    words = str(error)
    if "unable to open" in words or "disk I/O error" in words or "readonly" in words:
        reason = _of_the_system(path)
        if reason == errno.EMFILE:
            return "no more files can be opened by this process", "Raise the limit (ulimit -n)"
        if reason:
            return f"it cannot be opened for writing ({os.strerror(reason)})", OTHER_FILE
    if "disk is full" in words or "disk I/O error" in words:
        return f"the disk is full ({words})", "Free room and run again: finished runs are kept"
    if "readonly" in words:
        return "it cannot be written: its disk or folder is read-only", OTHER_FILE
    if "locked" in words:
        return f"another program has been writing it for {WAIT_SECONDS:.0f} s", f"Wait for it, or: {OTHER_FILE}"
    if "not a database" in words:
        return f"it is not a result store ({words})", OTHER_FILE
    if "malformed" in words or isinstance(error, sqlite3.DataError | sqlite3.IntegrityError):
        return f"it is damaged ({words})", f"`sqlite3 FILE .recover` saves what is whole. {OTHER_FILE}"
    return f"it cannot be used ({words})", OTHER_FILE


def _of_the_system(path: Path) -> int:
    """The error number the operating system gives for opening the store and files beside it; 0 if it opens them."""
    opened: list[int] = []
    try:
        opened += [os.open(os.devnull, os.O_RDONLY) for _ in range(4)]  # a store has a log and an index beside it
        opened.append(os.open(path if path.exists() else path.parent, os.O_RDWR if path.is_file() else os.O_RDONLY))
    except OSError as error:
        return error.errno or 0
    finally:
        for number in opened:
            os.close(number)
    return 0
