"""Windows of several parts of a divided search at a time, each in a fork of this process."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator
from functools import partial
from io import BytesIO
from typing import Any

from methods.numerics.forks import in_forks
from methods.proof.search.equations import Equations
from methods.proof.search.rate_bounds import RateProgramme
from methods.proof.search.slack_bounds import SlackProgramme
from methods.proof.search.window_search import WindowSearch
from methods.proof.verify.exact_wall import ExactWall

_SHARED = (Equations, SlackProgramme, RateProgramme, ExactWall)
"""What all parts hold and none changes for the others: it stays where it is, by its address, which forks keep."""


def windows_of(parts: Iterator[WindowSearch], jobs: int) -> Iterator[tuple[WindowSearch, bool]]:
    """Parts as their windows end, and whether another window of the part may gain more.

    Args:
        parts: asked for the next one when a process is free.
        jobs: windows at a time; one is worked on in this process.

    Raises:
        ForkLost: a process ended without a result.
    """
    if jobs == 1:
        yield from ((part, part.window()) for part in parts)
        return
    begun: list[tuple[WindowSearch, dict[int, Any]]] = []

    def calls() -> Iterator[Callable[[], bytes]]:
        for part in parts:
            begun.append((part, _written(part)[1]))
            yield partial(_window, part)

    for number, written in in_forks(calls(), jobs):
        part, shared = begun[number]
        after, more = _Reader(written, shared).load()
        part.become(after)
        yield part, more


def _window(part: WindowSearch) -> bytes:
    more = part.window()
    return _written((part, more))[0]


def _written(value: Any) -> tuple[bytes, dict[int, Any]]:
    """A value as bytes, and what they leave out, by address."""
    stream = BytesIO()
    writer = _Writer(stream)
    writer.dump(value)
    return stream.getvalue(), writer.shared


class _Writer(pickle.Pickler):
    def __init__(self, stream: BytesIO) -> None:
        super().__init__(stream, pickle.HIGHEST_PROTOCOL)
        self.shared: dict[int, Any] = {}

    def persistent_id(self, value: Any) -> int | None:
        if not isinstance(value, _SHARED):
            return None
        self.shared[id(value)] = value
        return id(value)


class _Reader(pickle.Unpickler):
    def __init__(self, written: bytes, shared: dict[int, Any]) -> None:
        super().__init__(BytesIO(written))
        self._shared = shared

    def persistent_load(self, address: int) -> Any:
        return self._shared[address]
