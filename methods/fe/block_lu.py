"""LU of the tangent in blocks of 3 x 3, one for each block of the wall, in a pattern that is found once.

The pattern of the tangent is that of the contact graph whatever the states are, so the fill of its factors is known
from the wall alone (George and Liu, 1981). Pivots are the 3 x 3 diagonal blocks. They cannot fail while the tangent
is symmetric; sliding makes it unsymmetric, and where the multipliers of L then grow, `factorise` says so.
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.fe.compiled import compiled

GROWTH = 1e5
"""Entries of L above this cost too many digits; a factorisation with row exchanges is called for."""


class BlockPattern:
    """Where the blocks of L, U and the diagonal lie; n blocks of unknowns, e blocks in L and as many in U.

    Values are kept as (n + 2 e, 3, 3): the diagonal, L by columns, U by columns.

    Attributes:
        low_start, low_row: rows below the diagonal of each column of L, ascending.
        up_start, up_row: rows above the diagonal of each column of U, ascending.
    """

    def __init__(self, first: IntArray, second: IntArray, n: int) -> None:
        """Find the fill of n blocks of unknowns that are in contact in the pairs (first, second), each (m,)."""
        below: list[set[int]] = [set() for _ in range(n)]
        for i, j in zip(np.minimum(first, second).tolist(), np.maximum(first, second).tolist(), strict=True):
            if i != j:
                below[i].add(j)
        for rows in below:
            if rows:
                parent = min(rows)
                below[parent] |= rows - {parent}
        self.n = n
        self.low_start = np.cumsum([0, *map(len, below)])
        self.low_row = np.array([i for rows in below for i in sorted(rows)], dtype=np.int64)
        column = np.repeat(np.arange(n), np.diff(self.low_start))
        by_row = np.argsort(self.low_row, kind="stable")
        self.up_row = column[by_row]
        self.up_start = np.concatenate([[0], np.cumsum(np.bincount(self.low_row, minlength=n))])
        e = len(self.low_row)
        self.n_values = n + 2 * e
        self._keys = np.concatenate([np.arange(n) * (n + 1), column * n + self.low_row, self.low_row * n + column])
        order = np.concatenate([np.arange(n), n + np.arange(e), n + e + np.argsort(by_row)])
        sort = np.argsort(self._keys)
        self._keys, self._place = self._keys[sort], order[sort]

    def slot(self, unknown: IntArray) -> IntArray:
        """(m, 36) places in the flat values of the products of two rows of each interface with unknowns (m, 6)."""
        row, column = np.repeat(unknown, 6, axis=1), np.tile(unknown, (1, 6))
        key = column // 3 * self.n + row // 3
        place = self._place[np.searchsorted(self._keys, key)]
        out: IntArray = 9 * place + 3 * (row % 3) + column % 3
        return out

    def factorise(self, values: FloatArray) -> int:
        """Factorise in place; the diagonal becomes its inverse.

        Returns:
            The sign of the determinant, or 0 when the pivots are not to be trusted.
        """
        return _factorise(self.low_start, self.low_row, self.up_start, self.up_row, values, GROWTH)

    def solve(self, values: FloatArray, first: int, x: FloatArray) -> None:
        """Solve in place; entries of x (n, 3) before block `first` are zero."""
        _substitute(self.low_start, self.low_row, self.up_start, self.up_row, values, first, x)


@compiled
def _invert(d: FloatArray) -> int:
    """Invert a 3 x 3 matrix in place by Gauss-Jordan elimination; the sign of its determinant, 0 if singular."""
    swapped = np.zeros(3, dtype=np.int64)
    sign = 1
    for k in range(3):
        best = k
        for i in range(k + 1, 3):
            if abs(d[i, k]) > abs(d[best, k]):
                best = i
        if not abs(d[best, k]) > 0.0:
            return 0
        if (d[best, k] < 0.0) != (best != k):
            sign = -sign
        swapped[k] = best
        for j in range(3):
            d[k, j], d[best, j] = d[best, j], d[k, j]
        pivot = 1.0 / d[k, k]
        d[k, k] = 1.0
        for j in range(3):
            d[k, j] *= pivot
        for i in range(3):
            if i != k:
                share = d[i, k]
                d[i, k] = 0.0
                for j in range(3):
                    d[i, j] -= share * d[k, j]
    for k in range(2, -1, -1):
        for i in range(3):
            d[i, k], d[i, swapped[k]] = d[i, swapped[k]], d[i, k]
    return sign


@compiled
def _factorise(
    low_start: IntArray, low_row: IntArray, up_start: IntArray, up_row: IntArray, values: FloatArray, growth: float
) -> int:
    """Column by column: subtract what the columns before it reach, invert its pivot, divide what lies below."""
    n, e = len(low_start) - 1, len(low_row)
    work = np.zeros((n, 3, 3))
    greatest = 0.0
    sign = 1
    for j in range(n):
        work[j] = values[j]
        for p in range(low_start[j], low_start[j + 1]):
            work[low_row[p]] = values[n + p]
        for q in range(up_start[j], up_start[j + 1]):
            work[up_row[q]] = values[n + e + q]
        for q in range(up_start[j], up_start[j + 1]):
            k = up_row[q]
            u = work[k]
            u00, u01, u02 = u[0, 0], u[0, 1], u[0, 2]
            u10, u11, u12 = u[1, 0], u[1, 1], u[1, 2]
            u20, u21, u22 = u[2, 0], u[2, 1], u[2, 2]
            values[n + e + q] = u
            for p in range(low_start[k], low_start[k + 1]):
                left, out = values[n + p], work[low_row[p]]
                for r in range(3):
                    l0, l1, l2 = left[r, 0], left[r, 1], left[r, 2]
                    out[r, 0] -= l0 * u00 + l1 * u10 + l2 * u20
                    out[r, 1] -= l0 * u01 + l1 * u11 + l2 * u21
                    out[r, 2] -= l0 * u02 + l1 * u12 + l2 * u22
        inverse = values[j]
        inverse[:] = work[j]
        sign *= _invert(inverse)
        if sign == 0:
            return 0
        for p in range(low_start[j], low_start[j + 1]):
            column, out = work[low_row[p]], values[n + p]
            for r in range(3):
                for c in range(3):
                    entry = column[r, 0] * inverse[0, c] + column[r, 1] * inverse[1, c] + column[r, 2] * inverse[2, c]
                    out[r, c] = entry
                    greatest = max(greatest, abs(entry))
    return sign if greatest < growth else 0


@compiled
def _substitute(
    low_start: IntArray,
    low_row: IntArray,
    up_start: IntArray,
    up_row: IntArray,
    values: FloatArray,
    first: int,
    x: FloatArray,
) -> None:
    """Forward pass from block `first`, then the backward pass with the inverted pivots."""
    n, e = len(low_start) - 1, len(low_row)
    for k in range(first, n):
        x0, x1, x2 = x[k, 0], x[k, 1], x[k, 2]
        if x0 != 0.0 or x1 != 0.0 or x2 != 0.0:
            for p in range(low_start[k], low_start[k + 1]):
                left, i = values[n + p], low_row[p]
                x[i, 0] -= left[0, 0] * x0 + left[0, 1] * x1 + left[0, 2] * x2
                x[i, 1] -= left[1, 0] * x0 + left[1, 1] * x1 + left[1, 2] * x2
                x[i, 2] -= left[2, 0] * x0 + left[2, 1] * x1 + left[2, 2] * x2
    for j in range(n - 1, -1, -1):
        r0, r1, r2 = x[j, 0], x[j, 1], x[j, 2]
        inverse = values[j]
        x0 = inverse[0, 0] * r0 + inverse[0, 1] * r1 + inverse[0, 2] * r2
        x1 = inverse[1, 0] * r0 + inverse[1, 1] * r1 + inverse[1, 2] * r2
        x2 = inverse[2, 0] * r0 + inverse[2, 1] * r1 + inverse[2, 2] * r2
        x[j, 0], x[j, 1], x[j, 2] = x0, x1, x2
        for q in range(up_start[j], up_start[j + 1]):
            right, k = values[n + e + q], up_row[q]
            x[k, 0] -= right[0, 0] * x0 + right[0, 1] * x1 + right[0, 2] * x2
            x[k, 1] -= right[1, 0] * x0 + right[1, 1] * x1 + right[1, 2] * x2
            x[k, 2] -= right[2, 0] * x0 + right[2, 1] * x1 + right[2, 2] * x2
