"""What a report needs more than once, in its page and in its files, made once while it is written."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")
_made: ContextVar[dict[Any, tuple[Any, Any]] | None] = ContextVar("made", default=None)


@contextmanager
def each_once() -> Iterator[None]:
    """Whatever `memo` marks is made once inside for the same objects, which nobody may change meanwhile."""
    token = _made.set({})
    try:
        yield
    finally:
        _made.reset(token)


def memo(function: Callable[P, T]) -> Callable[P, T]:
    """A function whose value for the same objects is kept inside `each_once`; it may not be changed by who gets it."""

    @wraps(function)
    def kept(*args: P.args, **kwargs: P.kwargs) -> T:
        made = _made.get()
        if made is None:
            return function(*args, **kwargs)
        key = (function, *map(id, args), *((name, id(value)) for name, value in sorted(kwargs.items())))
        if key not in made:
            made[key] = function(*args, **kwargs), (args, kwargs)  # the arguments too: their ids stay theirs
        value: T = made[key][0]
        return value

    return kept
