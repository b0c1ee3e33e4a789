"""What a run may ask of where it is made: the processes it may use, a folder for its files."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

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
