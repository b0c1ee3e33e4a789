"""What numpy does on short vectors in several passes, in one."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray
from methods.numerics.compiled import compiled

_UNSIGNED = 0x7FFFFFFFFFFFFFFF
"""All bits of a float but its sign."""


@compiled
def largest(values: FloatArray) -> float:
    """The largest absolute value of (n,), 0 where there is none; NaN if any value is.

    The bits of floats without their sign are in the order of the floats, and maxima of integers are found side by side.
    """
    bits = values.view(np.int64)
    top = np.zeros(1, dtype=np.int64)
    for i in range(len(bits)):
        top[0] = max(top[0], bits[i] & _UNSIGNED)
    size: float = top.view(np.float64)[0]
    return size


@compiled
def combine(x: FloatArray, a: float, b: float, y: FloatArray) -> None:
    """x = a x + b y, both (n,), in place."""
    for i in range(len(x)):
        x[i] = a * x[i] + b * y[i]
