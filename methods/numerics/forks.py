"""Calls made side by side in forks of this process, for the parts of a run that do not wait for each other."""

from __future__ import annotations

import contextlib
import os
import pickle
import select
import signal
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any, Generic, NoReturn, TypeVar

from harness.model.deadline import Deadline
from harness.model.orphans import end_with_parent

T = TypeVar("T")


class ForkLost(ChildProcessError):
    """A fork ended without a result, as one that was killed does."""


class _Fork(Generic[T]):
    """One call under way in a process of its own."""

    def __init__(self, call: Callable[[], T], seconds: float) -> None:
        self.place, theirs = os.pipe()
        parent = os.getpid()
        self.pid = os.fork()
        if self.pid == 0:
            end_with_parent()
            if os.getppid() != parent:  # which ended before the kernel was told
                os._exit(1)
            os.close(self.place)
            _answer(call, theirs, seconds)
        os.close(theirs)
        self._parts: list[bytes] = []

    def read(self) -> bool:
        """Read what has come; False at the end of it."""
        part = os.read(self.place, 1 << 16)
        self._parts.append(part)
        return bool(part)

    def result(self) -> T:
        """What the call gave, after the end of its process.

        Raises:
            ForkLost: it left nothing; or whatever the call raised.
        """
        _, status = os.waitpid(self.pid, 0)
        self.pid = 0
        if status != 0:
            raise ForkLost(f"a part of the run ended with status {status} and left no answer")
        given, raised = pickle.loads(b"".join(self._parts))
        if raised is not None:
            raise raised
        result: T = given
        return result

    def end(self) -> None:
        """End the process if it still runs."""
        os.close(self.place)
        if self.pid:
            with contextlib.suppress(ProcessLookupError):
                os.kill(self.pid, signal.SIGKILL)
            with contextlib.suppress(ChildProcessError):
                os.waitpid(self.pid, 0)


def _answer(call: Callable[[], Any], place: int, seconds: float) -> NoReturn:
    """In the fork: make the call, with the alarm of the time limit, and write what it gives or raises."""
    code = 1
    try:
        if seconds < float("inf"):
            signal.setitimer(signal.ITIMER_REAL, max(seconds, 1e-6))
        try:
            outcome: tuple[Any, Exception | None] = (call(), None)
        except Exception as error:
            outcome = (None, error)
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        with os.fdopen(place, "wb") as stream:
            pickle.dump(outcome, stream)
        code = 0
    finally:
        os._exit(code)


def in_forks(calls: Iterable[Callable[[], T]], processes: int) -> Iterator[tuple[int, T]]:
    """Numbers and results of calls as they end, each made in a fork of this process, at most so many at a time.

    Calls are asked for one by one, each when a process is free.

    A deadline is asked for in the forks, whose calls may say how far they came, and here when all that were begun have
    ended; none is begun after it. The alarm behind it rings in the forks too.

    Raises:
        OutOfTime: the time was over; what had been found was given before.
        ForkLost: a fork ended without a result; or whatever a call raises.
    """
    deadline, alarm = Deadline.of_run(), signal.setitimer(signal.ITIMER_REAL, 0.0)[0]
    rings = time.monotonic() + (alarm or float("inf"))
    coming = iter(enumerate(calls))
    under_way: dict[int, tuple[int, _Fork[T]]] = {}
    try:
        while True:
            while len(under_way) < processes and not deadline.passed:
                number, call = next(coming, (-1, None))
                if call is None:
                    break
                fork = _Fork(call, rings - time.monotonic())
                under_way[fork.place] = number, fork
            if not under_way:
                deadline.ask()
                break
            for place in select.select(list(under_way), [], [])[0]:
                number, fork = under_way[place]
                if not fork.read():
                    result = fork.result()
                    del under_way[place]
                    fork.end()
                    yield number, result
    finally:
        for _, fork in under_way.values():
            fork.end()
        if rings < float("inf"):
            signal.setitimer(signal.ITIMER_REAL, max(rings - time.monotonic(), 1e-6))
