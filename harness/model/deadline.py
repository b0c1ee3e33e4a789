"""The time at which a run has to answer: iterations ask for it at their natural steps; an alarm is the last resort."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import TypeVar

T = TypeVar("T")

STOPPED = "stopped by the time limit"
"""What every sentence says of a search that did not come to its end in time."""


class OutOfTime(Exception):
    """The time of a run is over, but for what its answer takes.

    A method that catches it can still say how far it came, with status `not_converged`; the engine waits for that
    answer until the limit. A method that lets it pass is listed as `timeout`.
    """


@dataclass(eq=False)
class Deadline:
    """When a run has to begin its answer. It is raised once: what then makes the answer is not interrupted again.

    Attributes:
        at: that moment, of `time.perf_counter` [s]; infinite where there is no limit.
        raised: whether the run has been stopped.
    """

    at: float = math.inf
    raised: bool = False

    @staticmethod
    def of_run() -> Deadline:
        """That of the run under way; without a limit where there is none."""
        return _of_run.get() or Deadline()

    @property
    def left(self) -> float:
        """Seconds until then, at least zero; infinite without a limit, and where the run has been stopped."""
        return math.inf if self.raised else max(self.at - time.perf_counter(), 0.0)

    @property
    def passed(self) -> bool:
        """Whether the time is over and the run has not been stopped yet."""
        return not self.left > 0.0

    def ask(self) -> None:
        """Stop the run where its time is over.

        Raises:
            OutOfTime: it is.
        """
        if self.passed:
            self.stop()

    def stop(self) -> None:
        """Stop the run, unless it has been.

        Raises:
            OutOfTime: it has not been stopped yet.
        """
        if not self.raised:
            self.raised = True
            raise OutOfTime


_of_run: ContextVar[Deadline | None] = ContextVar("deadline", default=None)


@contextmanager
def answering_by(deadline: Deadline) -> Iterator[None]:
    """Make the runs inside answer by a deadline."""
    token = _of_run.set(deadline)
    try:
        yield
    finally:
        _of_run.reset(token)


def best_so_far(search: Callable[[], T], known: Callable[[], T]) -> T:
    """What a search gives; where the time is over before its end, what is known by then.

    Args:
        search: to its end.
        known: from what the search left behind; may raise `OutOfTime` again where that is nothing.
    """
    try:
        return search()
    except OutOfTime:
        return known()
