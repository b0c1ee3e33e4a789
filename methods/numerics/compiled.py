"""Compiled loops: functions marked `@compiled` run as machine code, which numba makes at their first call and keeps.

`@compiled` keeps the order of every sum; `@compiled_loosely` lets the compiler choose it, for products of matrices.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any, TypeVar

import numba
from numba.core import types
from numba.extending import lower_builtin, type_callable

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
    try:
        kernel: AnyFunction = numba.njit(cache=True, fastmath=fastmath)(function)
    except RuntimeError:  # numba's word for "no folder takes the cache"
        kernel = numba.njit(fastmath=fastmath)(function)
    return kernel


def fused(a: float, b: float, c: float) -> float:
    """A product of floats and a sum, a b + c, rounded once (IEEE 754-2008); compiled, one instruction."""
    return float(Fraction(a) * Fraction(b) + Fraction(c))


@type_callable(fused)  # type: ignore[untyped-decorator]
def _type_of_fused(_context: Any) -> Callable[..., Any]:
    return lambda a, b, c: types.float64


@lower_builtin(fused, types.float64, types.float64, types.float64)  # type: ignore[untyped-decorator]
def _code_of_fused(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
    return builder.fma(*arguments)
