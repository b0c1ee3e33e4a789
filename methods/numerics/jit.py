"""Numba's part in compiled loops, imported where one must be compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
from numba.core import types
from numba.extending import lower_builtin, type_callable

from methods.numerics.compiled import fused

LOOSELY = {"reassoc", "contract", "nsz"}
"""What `compiled_loosely` allows of LLVM."""

KERNELS: list[Any] = []
"""All that numba compiles in this process, for `harness.kernels`."""


def dispatcher(function: Callable[..., Any], loosely: bool) -> Any:
    """The function compiled on its first call; its code is kept on disk where a folder takes it."""
    fastmath = LOOSELY if loosely else False
    try:
        kernel = numba.njit(cache=True, fastmath=fastmath)(function)
    except RuntimeError:
        kernel = numba.njit(fastmath=fastmath)(function)
    KERNELS.append(kernel)
    return kernel


@type_callable(fused)  # type: ignore[untyped-decorator]
def _type_of_fused(_context: Any) -> Callable[..., Any]:
    return lambda a, b, c: types.float64


@lower_builtin(fused, types.float64, types.float64, types.float64)  # type: ignore[untyped-decorator]
def _code_of_fused(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
    return builder.fma(*arguments)
