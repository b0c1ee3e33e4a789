"""One typed door to numba: functions marked `@compiled` run as cached machine code.

`@compiled` keeps the order of every sum; `@compiled_loosely` lets the compiler choose it, for products of matrices.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

AnyFunction = TypeVar("AnyFunction", bound=Callable[..., Any])


def compiled(function: AnyFunction) -> AnyFunction:
    """Compile a function of arrays on its first call and keep the code on disk, where any folder can be written.

    Numba keeps its code beside the source or, where that is read-only, in the user's cache folder. Where neither can
    be written the function is compiled afresh in each process.
    """
    return _compile(function, False)


def compiled_loosely(function: AnyFunction) -> AnyFunction:
    """As `compiled`, with sums in whatever order is fastest; zeros keep no sign, infinities and NaN stay what they are.

    The order is fixed when the code is compiled, so runs on one machine repeat bit by bit.
    """
    return _compile(function, {"reassoc", "contract", "nsz"})


def _compile(function: AnyFunction, fastmath: bool | set[str]) -> AnyFunction:
    try:
        return cast(AnyFunction, numba.njit(cache=True, fastmath=fastmath)(function))
    except RuntimeError:
        return cast(AnyFunction, numba.njit(fastmath=fastmath)(function))
