"""The optimal vertex of a linear programme computed to rounding from its basis.

A simplex code stops where bounds are violated by 1e-9 of the unit in which the programme is written, so what is
smaller than that beside it is not seen. A basis says which columns and rows are at a bound, and from it the vertex
follows by two linear systems, each refined with residuals in extended precision, so that every row holds to rounding
of its own terms. Where a bound is violated by more than rounding of what stands beside it, the programme is shifted to
the vertex, its violations are magnified to one, and it goes on from the basis (Gleixner, Steffy and Wolter 2016,
"Iterative refinement for linear programming", INFORMS Journal on Computing 28).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import highspy
import numpy as np
import scipy.sparse as sp

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.failures import NumericalFailure, SingularMatrix, sparse_lu
from methods.numerics.silent_highs import SilentHighs

_ACCURATE = 1e-12
"""Violation of a bound, relative to the terms beside it, that is rounding."""
_ROUNDS = 6
"""Refinements of a linear system at most, and magnifications of a programme."""
_LEAST_TERM = 1e-3
"""Terms below this share of the largest bound count as this share."""
_LEAST_SPEED = 1e-5
"""Terms below this share of the largest terms of a reduced cost count as this share."""
_MAGNIFIED = 1e14
"""Largest factor by which violations are magnified."""
_CUT_OFF = 1e7
"""Magnified reduced costs beyond this are cut off: they are far from zero either way."""


LOWER, BASIC, UPPER, ZERO = (
    int(status)
    for status in (
        highspy.HighsBasisStatus.kLower,
        highspy.HighsBasisStatus.kBasic,
        highspy.HighsBasisStatus.kUpper,
        highspy.HighsBasisStatus.kZero,
    )
)


@dataclass(frozen=True, eq=False)
class Vertex:
    """A basic solution to rounding. c columns, r rows.

    Attributes:
        value: (c,) columns; dual: (r,) multipliers of the rows; reduced: (c,) reduced costs.
        primal: largest violation of a bound; dual_violation: of the sign of a multiplier or reduced cost; both
            relative to the terms beside it.
        feasible: whether it keeps all bounds to rounding; optimal: whether it is optimal too.
    """

    value: FloatArray
    dual: FloatArray
    reduced: FloatArray
    primal: float
    dual_violation: float
    feasible: bool
    optimal: bool


@dataclass(frozen=True, eq=False)
class _Solution:
    """All columns (c + r,) of the standard form, multipliers (r,) and reduced costs (c + r,), and how wrong each is."""

    status: IntArray
    value: FloatArray
    dual: FloatArray
    reduced: FloatArray
    outside: FloatArray
    wrong: FloatArray
    primal: float
    dual_violation: float


class StandardForm:
    """min c.x s.t. A x - s = 0, with bounds on x (c,) and s (r,).

    Args:
        matrix: (r, c) A.
        cost: (c,); column: lower and upper bounds (c,); row: lower and upper bounds (r,).
        groups: (r,) rows of the same number measure violations by the largest terms of any of them.
    """

    def __init__(
        self,
        matrix: sp.csc_matrix,
        cost: FloatArray,
        column: tuple[FloatArray, FloatArray],
        row: tuple[FloatArray, FloatArray],
        groups: IntArray | None = None,
    ) -> None:
        self._rows, self._columns = matrix.shape
        own = np.arange(self._rows, dtype=matrix.indices.dtype)
        parts = (
            np.append(matrix.data, np.full(self._rows, -1.0)),
            np.append(matrix.indices, own),
            np.append(matrix.indptr, matrix.indptr[-1] + 1 + own),
        )
        self._matrix = sp.csc_matrix(parts, shape=(self._rows, self._columns + self._rows))
        self._transposed: sp.csr_matrix = self._matrix.T
        self._by_row = self._matrix.tocsr()
        self._column_of = np.repeat(np.arange(self._columns + self._rows), np.diff(self._matrix.indptr))
        self._cost = np.append(cost, np.zeros(self._rows))
        self._lower, self._upper = (np.concatenate(pair) for pair in zip(column, row, strict=True))
        bounds = abs(np.concatenate([self._lower, self._upper]))
        self._largest_bound = float(bounds[np.isfinite(bounds)].max(initial=0.0))
        self._groups = np.arange(self._rows) if groups is None else groups

    def vertex(self, status: IntArray) -> Vertex | None:
        """The optimal vertex that a basis (c + r,) leads to; None if it is singular or leads nowhere."""
        best = solution = self._solution(status)
        for _ in range(_ROUNDS):
            if solution is None or _worst(solution) <= _ACCURATE:
                break
            solution = self._magnified(solution)
            if solution is not None and best is not None and _worst(solution) < _worst(best):
                best = solution
        if best is None:
            return None
        own = slice(0, self._columns)
        return Vertex(
            best.value[own],
            best.dual,
            best.reduced[own],
            best.primal,
            best.dual_violation,
            best.primal <= _ACCURATE,
            _worst(best) <= _ACCURATE,
        )

    def _solution(self, status: IntArray) -> _Solution | None:
        basic = status == BASIC
        at = np.where(status == UPPER, self._upper, np.where(status == ZERO, 0.0, self._lower))
        at = np.where(np.isfinite(at), at, np.where(np.isfinite(self._upper), self._upper, 0.0))
        value = np.where(basic, 0.0, at)
        if int(basic.sum()) != self._rows:
            return None
        try:
            basis = _Basis(self._matrix[:, basic], _ROUNDS)
            value[basic] = basis.solved(-_extended_product(self._by_row, value))
            dual = basis.multipliers(self._cost[basic])
        except NumericalFailure:
            return None
        reduced = (self._cost - _extended_product(self._transposed, dual)).astype(float)
        reduced[basic] = 0.0
        outside = np.where(basic, np.maximum(self._lower - value, value - self._upper), 0.0).clip(min=0.0)
        fixed = self._lower == self._upper
        wrong = np.where(status == LOWER, -reduced, np.where(status == UPPER, reduced, abs(reduced))).clip(min=0.0)
        wrong[basic | fixed] = 0.0
        speeds = self._speeds_beside(dual)
        return _Solution(
            status,
            value,
            dual,
            reduced,
            outside,
            wrong,
            _relative(outside, self._terms_beside(value), _LEAST_TERM * self._largest_bound),
            _relative(wrong, speeds, _LEAST_SPEED * float(speeds.max(initial=0.0))),
        )

    def _terms_beside(self, value: FloatArray) -> FloatArray:
        """(c + r,) for every column the size of the terms in the row of least terms it stands in."""
        row_of, sizes = self._matrix.indices, abs(self._matrix.data)
        by_row = np.bincount(row_of, sizes * abs(value)[self._column_of], self._rows)
        largest = np.zeros(int(self._groups.max(initial=-1)) + 1)
        np.maximum.at(largest, self._groups, by_row)
        least = np.full(len(value), np.inf)
        np.minimum.at(least, self._column_of, largest[self._groups][row_of])
        return least

    def _speeds_beside(self, dual: FloatArray) -> FloatArray:
        """(c + r,) for every column the size of the terms of its reduced cost; of a row, of the columns beside it."""
        row_of, sizes = self._matrix.indices, abs(self._matrix.data)
        own = np.bincount(self._column_of, sizes * abs(dual)[row_of], len(self._cost)) + abs(self._cost)
        entries = slice(0, self._matrix.indptr[self._columns])  # of the columns that are no rows
        np.maximum.at(own, self._columns + row_of[entries], own[self._column_of[entries]])
        return np.asarray(own)

    def _magnified(self, at: _Solution) -> _Solution | None:
        """Where the programme leads once it is shifted to a solution and its violations are magnified to one."""
        primal = _factor(at.outside, _MAGNIFIED) if at.primal > _ACCURATE else 1.0
        dual = _factor(at.wrong, _MAGNIFIED) if at.dual_violation > _ACCURATE else 1.0
        basic = at.status == BASIC
        highs: Any = SilentHighs(
            threads=1,
            presolve="off",
            solver="simplex",
            primal_feasibility_tolerance=1e-9,
            dual_feasibility_tolerance=1e-9,
            small_matrix_value=1e-12,
        )
        shifted = highspy.HighsLp()
        shifted.num_row_, shifted.num_col_ = self._matrix.shape
        shifted.col_cost_ = np.where(basic, 0.0, np.clip(dual * at.reduced, -_CUT_OFF, _CUT_OFF))
        shifted.col_lower_ = primal * (self._lower - at.value)
        shifted.col_upper_ = primal * (self._upper - at.value)
        shifted.row_lower_ = shifted.row_upper_ = np.zeros(self._rows)
        shifted.a_matrix_.format_ = highspy.MatrixFormat.kColwise
        shifted.a_matrix_.start_ = self._matrix.indptr
        shifted.a_matrix_.index_ = self._matrix.indices
        shifted.a_matrix_.value_ = self._matrix.data
        highs.passModel(shifted)
        basis = highs.getBasis()
        basis.col_status = [_STATUS[k] for k in at.status.tolist()]
        basis.row_status = [highspy.HighsBasisStatus.kLower] * self._rows
        highs.setBasis(basis)
        highs.run()
        if highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
            return None
        return self._solution(np.array([int(status) for status in highs.getBasis().col_status], dtype=np.int64))


_STATUS = {int(status): status for status in highspy.HighsBasisStatus.__members__.values()}


class _Basis:
    """The factors of a square sparse matrix, once, and what they solve: every row to rounding of its own terms.

    Rows and columns are scaled by powers of two, which rounds nothing.

    Args:
        matrix: (k, k) B; rounds: refinements of a solution at most.

    Raises:
        SingularMatrix: the matrix is singular.
    """

    def __init__(self, matrix: sp.csc_matrix, rounds: int) -> None:
        size, self._rounds = matrix.shape[0], rounds
        column_of = np.repeat(np.arange(size), np.diff(matrix.indptr))
        self._by_column: sp.csr_matrix = matrix.T
        self._by_row = matrix.tocsr()
        self._rows = _powers(_largest(matrix.indices, abs(matrix.data), size))
        scaled = matrix.data * self._rows[matrix.indices]
        self._columns = _powers(_largest(column_of, abs(scaled), size))
        parts = (scaled * self._columns[column_of], matrix.indices, matrix.indptr)
        self._factor: Any = sparse_lu(sp.csc_matrix(parts, shape=matrix.shape))

    def solved(self, right: Any) -> FloatArray:
        """x (k,) with B x = right.

        Raises:
            SingularMatrix: the matrix is singular to rounding.
        """
        return self._refined(self._by_row, right, lambda left: self._columns * self._factor.solve(self._rows * left))

    def multipliers(self, right: Any) -> FloatArray:
        """y (k,) with B' y = right; raises as `solved`."""
        return self._refined(
            self._by_column, right, lambda left: self._rows * self._factor.solve(self._columns * left, trans="T")
        )

    def _refined(
        self, by_row: sp.csr_matrix, right: Any, approximate: Callable[[FloatArray], FloatArray]
    ) -> FloatArray:
        right = np.asarray(right, dtype=np.longdouble)
        solution = np.zeros(len(right), dtype=np.longdouble)
        for _ in range(self._rounds):
            residual = right - _extended_product(by_row, solution)
            change = approximate(residual.astype(float))
            if not np.isfinite(change).all():
                raise SingularMatrix("the basis is singular to rounding")
            solution = solution + change
            if np.all(abs(change) <= 1e-17 * abs(solution)):
                break
        return solution.astype(float)


def _largest(place: Any, values: FloatArray, count: int) -> FloatArray:
    """(count,) the largest of the values at each place; zero where there are none."""
    found = np.zeros(count)
    np.maximum.at(found, place, values)
    return found


def _extended_product(matrix: sp.csr_matrix, vector: Any) -> Any:
    """The product of a sparse matrix with a vector in extended precision."""
    product = np.zeros(matrix.shape[0], dtype=np.longdouble)
    terms = matrix.data.astype(np.longdouble) * np.asarray(vector, dtype=np.longdouble)[matrix.indices]
    filled = np.flatnonzero(np.diff(matrix.indptr))
    if len(filled):
        product[filled] = np.add.reduceat(terms, matrix.indptr[filled])
    return product


def _worst(solution: _Solution) -> float:
    return max(solution.primal, solution.dual_violation)


def _relative(violation: FloatArray, beside: FloatArray, least: float) -> float:
    """The largest violation relative to what stands beside it, which counts from `least` on."""
    return float((violation / np.maximum(beside, least or 1.0)).max(initial=0.0))


def _factor(violation: FloatArray, most: float) -> float:
    """A power of two up to `most` that brings the largest violation near one."""
    worst = float(violation.max(initial=0.0))
    return 1.0 if worst == 0.0 else float(np.clip(2.0 ** np.round(-np.log2(worst)), 1.0, most))


def _powers(size: FloatArray) -> FloatArray:
    """Inverses of sizes, rounded to powers of two; one where a size is zero."""
    return np.where(size > 0.0, 2.0 ** -np.round(np.log2(np.where(size > 0.0, size, 1.0))), 1.0)
