"""What a run may ask of where it is made: the time it has left, the processes it may use, a folder for its files."""

from __future__ import annotations

import math
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar


class OutOfTime(Exception):
    """Raised inside `solve` shortly before the time limit of a run.

    A method that catches it can still say how far it came, with status `not_converged`; the engine waits for that
    answer until the limit. A method that lets it pass is listed as `timeout`.
    """


def seconds_left() -> float:
    """Seconds until `OutOfTime` is raised in this process, for libraries that hear of it only when they return [s].

    Infinite where no limit was set.
    """
    return signal.getitimer(signal.ITIMER_REAL)[0] or math.inf


_processes: ContextVar[int] = ContextVar("processes", default=1)


def processes_allowed() -> int:
    """Processes that a run may use side by side, one unless the user allows more; its answer is the same with any."""
    return _processes.get()


@contextmanager
def allowing(processes: int) -> Iterator[None]:
    """Allow the runs made inside so many processes each."""
    token = _processes.set(processes)
    try:
        yield
    finally:
        _processes.reset(token)


_run_folder: ContextVar[str | None] = ContextVar("run_folder", default=None)


def run_folder() -> str | None:
    """The folder of the run under way, emptied after it whatever happens; None where a run has none of its own."""
    return _run_folder.get()


@contextmanager
def running_in(folder: str) -> Iterator[None]:
    """Give the runs made inside a folder for their files."""
    token = _run_folder.set(folder)
    try:
        yield
    finally:
        _run_folder.reset(token)
