"""Work in a child process, so that its cost in processor time and memory is known."""

from __future__ import annotations

import contextlib
import os
import sys
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Cost:
    """What a child said and used.

    Attributes:
        code: its exit code; said: on standard output and standard error, a traceback among it.
        seconds: of processor time, its own children's among them; mebibytes: greatest memory.
    """

    code: int
    said: str
    seconds: float
    mebibytes: float


def forked(work: Callable[[], Any], folder: Path, said: Path) -> Cost:
    """The cost of work in a child whose working folder is `folder` and whose words go to the file `said`."""
    sys.stdout.flush()
    sys.stderr.flush()
    child = os.fork()
    if child == 0:
        code = 70
        try:
            os.chdir(folder)
            out = os.open(said, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
            os.dup2(out, 1)
            os.dup2(out, 2)
            sys.stdout, sys.stderr = os.fdopen(1, "w"), os.fdopen(2, "w")
            work()
            code = 0
        except SystemExit as left:
            code = left.code if isinstance(left.code, int) else 70
        except BaseException:
            traceback.print_exc()
        with contextlib.suppress(OSError, ValueError):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(code)
    _, status, used = os.wait4(child, 0)
    return Cost(
        os.waitstatus_to_exitcode(status),
        said.read_text(errors="replace"),
        used.ru_utime + used.ru_stime,
        used.ru_maxrss / 1024.0,
    )


def drystone(words: Sequence[str], folder: Path, said: Path) -> Cost:
    """The cost of a command."""
    from drystone.cli.main import main

    return forked(lambda: main(list(words), prog_name="drystone"), folder, said)
