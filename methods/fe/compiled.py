"""One typed door to numba: functions marked `@compiled` run as cached machine code, without fast-math reordering."""

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
    try:
        return cast(AnyFunction, numba.njit(cache=True)(function))
    except RuntimeError:
        return cast(AnyFunction, numba.njit(function))
