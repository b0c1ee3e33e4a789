"""Compiled loops: functions marked `@compiled` run as machine code, which numba makes at their first call and keeps.

`@compiled` keeps the order of every sum; `@compiled_loosely` lets the compiler choose it, for products of matrices.

Numba takes kept code for current while the file of a function is as it was, and names it by the function's qualified
name. What it is compiled from in other files, functions and numbers that its module imports, is therefore part of that
name.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba.core import types
from numba.extending import is_jitted, lower_builtin, type_callable

AnyFunction = TypeVar("AnyFunction", bound=Callable[..., Any])

_LOOSELY = {"reassoc", "contract", "nsz"}
"""What `compiled_loosely` allows of LLVM."""


def compiled(function: AnyFunction) -> AnyFunction:
    """Compile a function of arrays on its first call, and keep its code on disk if a folder takes it.

    Numba keeps its code beside the source or, where that is read-only, in the user's cache folder. Where neither can
    be written the function is compiled afresh in each process.
    """
    return _compile(function, fastmath=False)


def compiled_loosely(function: AnyFunction) -> AnyFunction:
    """As `compiled`, with sums in whatever order is fastest; zeros keep no sign, infinities and NaN stay what they are.

    The order is fixed when the code is compiled, so runs on one machine repeat bit by bit.
    """
    return _compile(function, fastmath=_LOOSELY)


def _compile(function: AnyFunction, fastmath: Any) -> AnyFunction:
    parts = "\n".join([_content(__file__), *_imported(function)])
    function.__qualname__ += "_" + hashlib.sha256(parts.encode()).hexdigest()[:16]
    try:
        kernel: AnyFunction = numba.njit(cache=True, fastmath=fastmath)(function)
    except RuntimeError:  # numba's word for "no folder takes the cache"
        kernel = numba.njit(fastmath=fastmath)(function)
    return kernel


def _imported(function: AnyFunction) -> Iterator[str]:
    """What a function may be compiled from besides its own file: other compiled functions, and numbers, by name.

    The name of a compiled function holds what that is compiled from.
    """
    for name, value in sorted(function.__globals__.items()):
        if is_jitted(value) and value.py_func.__module__ != function.__module__:
            yield f"{name} {value.py_func.__qualname__} {_content(value.py_func.__code__.co_filename)}"
        elif isinstance(value, int | float):
            yield f"{name} {value!r}"


@cache
def _content(file: str) -> str:
    """Digest of a source file."""
    return hashlib.sha256(Path(file).read_bytes()).hexdigest()


def fused(a: float, b: float, c: float) -> float:
    """A product of floats and a sum, a b + c, rounded once (IEEE 754-2008); compiled, one instruction."""
    return float(Fraction(a) * Fraction(b) + Fraction(c))


@type_callable(fused)  # type: ignore[untyped-decorator]
def _type_of_fused(_context: Any) -> Callable[..., Any]:
    return lambda a, b, c: types.float64


@lower_builtin(fused, types.float64, types.float64, types.float64)  # type: ignore[untyped-decorator]
def _code_of_fused(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
    return builder.fma(*arguments)
