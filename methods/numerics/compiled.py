"""One typed door to numba: functions marked `@compiled` run as cached machine code.

`@compiled` keeps the order of every sum; `@compiled_loosely` lets the compiler choose it, for products of matrices.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
from numba.core import types
from numba.extending import intrinsic

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


@intrinsic  # type: ignore[untyped-decorator]
def fused(_context: Any, _a: Any, _b: Any, _c: Any) -> Any:
    """A product of floats and a sum, a b + c, rounded once (IEEE 754-2008), inside compiled functions."""
    signature = types.float64(types.float64, types.float64, types.float64)

    def generate(_target: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    return signature, generate
