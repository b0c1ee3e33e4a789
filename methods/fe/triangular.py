"""Solves with the two triangles of a sparse LU, quick where the right-hand side has few entries.

A change of state loads the two blocks of one interface. The forward pass then touches only the columns on their way
up the elimination tree, which leaves the backward pass as the cost of a solve.
"""

from __future__ import annotations

from typing import cast

from scipy.sparse.linalg import SuperLU

from harness.model.assembly import FloatArray, IntArray
from methods.fe.compiled import compiled

Columns = tuple[IntArray, IntArray, FloatArray]
"""Start of each column, rows and values of its entries."""


class Triangles:
    """L and U of a factorised matrix, A = Pr' L U Pc', as compressed columns."""

    def __init__(self, lu: SuperLU) -> None:
        lower, upper = lu.L, lu.U
        self.lower: Columns = cast(Columns, (lower.indptr, lower.indices, lower.data))
        self.upper: Columns = cast(Columns, (upper.indptr, upper.indices, upper.data))
        self.rows, self.columns = lu.perm_r, lu.perm_c

    def solve(self, right: FloatArray, work: FloatArray, out: FloatArray) -> None:
        """A^-1 right (N,) into `out`; `work` (N,) is scratch."""
        work[self.rows] = right
        _substitute(*self.lower, *self.upper, self.columns, 0, work, out)

    def solve_sparse(self, index: IntArray, value: FloatArray, work: FloatArray, out: FloatArray) -> None:
        """A^-1 times the vector with `value` (6,) at `index` (6,), into `out` (N,)."""
        place_entries(self.rows, index, value, work)
        _substitute(*self.lower, *self.upper, self.columns, int(self.rows[index].min()), work, out)


@compiled
def place_entries(rows: IntArray, index: IntArray, value: FloatArray, work: FloatArray) -> None:
    """`value` added at rows[index] of a zeroed `work`."""
    for i in range(len(work)):
        work[i] = 0.0
    for j in range(len(index)):
        work[rows[index[j]]] += value[j]


@compiled
def _substitute(
    lower_start: IntArray,
    lower_row: IntArray,
    lower: FloatArray,
    upper_start: IntArray,
    upper_row: IntArray,
    upper: FloatArray,
    columns: IntArray,
    first: int,
    work: FloatArray,
    out: FloatArray,
) -> None:
    """Forward pass from column `first` (the unit diagonal comes first), backward pass (the diagonal comes last)."""
    n = len(work)
    for j in range(first, n):
        value = work[j]
        if value != 0.0:
            for q in range(lower_start[j] + 1, lower_start[j + 1]):
                work[lower_row[q]] -= lower[q] * value
    for j in range(n - 1, -1, -1):
        last = upper_start[j + 1] - 1
        value = work[j]
        if value != 0.0:
            value /= upper[last]
            work[j] = value
            for q in range(upper_start[j], last):
                work[upper_row[q]] -= upper[q] * value
    for j in range(n):
        out[j] = work[columns[j]]
