"""The door to compiled loops: functions marked `@compiled` run as machine code, built at install time or by numba.

`@compiled` keeps the order of every sum; `@compiled_loosely` lets the compiler choose it, for products of matrices.
Where `python -m harness.kernels` has built the library of kernels, no run imports numba.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cached_property, update_wrapper
from typing import Any, TypeVar, cast

from methods.numerics import built

AnyFunction = TypeVar("AnyFunction", bound=Callable[..., Any])


def compiled(function: AnyFunction) -> AnyFunction:
    """Compile a function of arrays, unless the library has it: on its first call, kept on disk if a folder takes it.

    Numba keeps its code beside the source or, where that is read-only, in the user's cache folder. Where neither can
    be written the function is compiled afresh in each process.
    """
    return _compile(function, loosely=False)


def compiled_loosely(function: AnyFunction) -> AnyFunction:
    """As `compiled`, with sums in whatever order is fastest; zeros keep no sign, infinities and NaN stay what they are.

    The order is fixed when the code is compiled, so runs on one machine repeat bit by bit.
    """
    return _compile(function, loosely=True)


def _compile(function: AnyFunction, *, loosely: bool) -> AnyFunction:
    if built.holds(function):
        return cast(AnyFunction, Kernel(function, loosely))
    from methods.numerics.jit import dispatcher

    return cast(AnyFunction, dispatcher(function, loosely))


class Kernel:
    """A function of the library. Numba compiles it only for arguments that it was not built for."""

    def __init__(self, function: Callable[..., Any], loosely: bool) -> None:
        update_wrapper(self, function)
        self._function, self._loosely = function, loosely
        self._built = built.entry(function)

    def __call__(self, *arguments: Any) -> Any:
        """The function itself; its entry in the library refuses whatever differs in kind before it begins."""
        if self._built is not None:
            try:
                return self._built(arguments)
            except TypeError:
                pass
        return self._dispatcher(*arguments)

    @cached_property
    def _dispatcher(self) -> Any:
        from methods.numerics.jit import dispatcher

        return dispatcher(self._function, self._loosely)

    @property
    def _numba_type_(self) -> Any:
        """What numba asks of a function that another one calls."""
        return self._dispatcher._numba_type_


def fused(a: float, b: float, c: float) -> float:
    """A product of floats and a sum, a b + c, rounded once (IEEE 754-2008); compiled, one instruction."""
    return float(Fraction(a) * Fraction(b) + Fraction(c))
