"""A linear programme held in HiGHS, so that a change of bounds or costs starts from the last basis."""

from __future__ import annotations

from typing import Any

import highspy
import numpy as np
import scipy.sparse as sp

from harness.model.assembly import FloatArray, IntArray
from harness.model.deadline import Deadline
from methods.numerics.silent_highs import SilentHighs
from methods.numerics.vertex import StandardForm, Vertex

INFINITY = highspy.kHighsInf


class Programme:
    """A linear programme held in HiGHS: columns with bounds, rows with bounds, one matrix.

    Attributes:
        deadline: of the run in which it is made.
    """

    def __init__(
        self,
        matrix: sp.csc_matrix,
        cost: FloatArray,
        column: tuple[FloatArray, FloatArray],
        row: tuple[FloatArray, FloatArray],
    ) -> None:
        self.deadline = Deadline.of_run()
        self.highs: Any = SilentHighs(
            threads=1, random_seed=0, primal_feasibility_tolerance=1e-9, dual_feasibility_tolerance=1e-9
        )
        self._matrix: sp.csc_matrix = sp.csc_matrix(matrix)
        self._cost = np.array(cost, dtype=float)
        self._column = (np.array(column[0], dtype=float), np.array(column[1], dtype=float))
        self._row = (np.array(row[0], dtype=float), np.array(row[1], dtype=float))
        programme = highspy.HighsLp()
        programme.num_row_, programme.num_col_ = matrix.shape
        programme.col_cost_ = cost
        programme.col_lower_, programme.col_upper_ = column
        programme.row_lower_, programme.row_upper_ = row
        programme.a_matrix_.format_ = highspy.MatrixFormat.kColwise
        programme.a_matrix_.start_ = matrix.indptr
        programme.a_matrix_.index_ = matrix.indices
        programme.a_matrix_.value_ = matrix.data
        self.highs.passModel(programme)
        self.n_columns = matrix.shape[1]

    def set_columns(self, first: int, lower: FloatArray, upper: FloatArray) -> None:
        """New bounds of consecutive columns from `first`."""
        index = np.arange(first, first + len(lower), dtype=np.int32)
        self._column[0][index], self._column[1][index] = lower, upper
        self.highs.changeColsBounds(len(index), index, lower, upper)

    def set_rows(self, first: int, lower: FloatArray, upper: FloatArray) -> None:
        """New bounds of consecutive rows from `first`."""
        index = np.arange(first, first + len(lower), dtype=np.int32)
        self._row[0][index], self._row[1][index] = lower, upper
        self.highs.changeRowsBounds(len(index), index, lower, upper)

    def set_row(self, row: int, weights: FloatArray) -> None:
        """New coefficients (columns,) of one row."""
        rows = self._matrix.tolil()
        rows[row] = weights
        self._matrix = rows.tocsc()
        for column, weight in enumerate(weights.tolist()):
            self.highs.changeCoeff(row, column, weight)

    def set_costs(self, first: int, cost: FloatArray) -> None:
        """New costs of consecutive columns from `first`."""
        index = np.arange(first, first + len(cost), dtype=np.int32)
        self._cost[index] = cost
        self.highs.changeColsCost(len(index), index, cost)

    def run(self, most: float = INFINITY) -> tuple[str, FloatArray, FloatArray]:
        """("optimal" | "infeasible" | "unbounded" | "above" | "unknown", column values, row duals).

        It ends as "above" once the minimum is known to be above `most`. The dual simplex method comes to know it long
        before a programme is proved to have no solution, which may take it thousands of steps at a degenerate vertex.

        Raises:
            OutOfTime: the time given is over; the library would hear of it only at its end.
        """
        self.highs.setOptionValue("objective_bound", most)
        status = self._run()
        if status == highspy.HighsModelStatus.kUnboundedOrInfeasible:
            self.highs.setOptionValue("presolve", "off")
            status = self._run()
            self.highs.setOptionValue("presolve", "choose")
        names = {
            highspy.HighsModelStatus.kOptimal: "optimal",
            highspy.HighsModelStatus.kInfeasible: "infeasible",
            highspy.HighsModelStatus.kUnbounded: "unbounded",
            highspy.HighsModelStatus.kObjectiveBound: "above",
        }
        if status not in names:
            self.highs.clearSolver()
            status = self._run()
        solution = self.highs.getSolution()
        return names.get(status, "unknown"), np.array(solution.col_value), np.array(solution.row_dual)

    def _run(self) -> Any:
        self.deadline.ask()
        self.highs.setOptionValue("time_limit", self.highs.getRunTime() + self.deadline.left)
        self.highs.run()
        status = self.highs.getModelStatus()
        if status == highspy.HighsModelStatus.kTimeLimit:
            self.deadline.stop()
        return status

    def ray(self) -> FloatArray | None:
        """Row multipliers that show that the last run, which was infeasible, has no solution; None if none are known.

        Their sign is for the caller to find.
        """
        _, known, values = self.highs.getDualRay()
        if not known:
            self.highs.setOptionValue("presolve", "off")
            self._run()
            self.highs.setOptionValue("presolve", "choose")
            _, known, values = self.highs.getDualRay()
        return np.array(values) if known else None

    def iterations(self) -> int:
        """Iterations of the last run."""
        info = self.highs.getInfo()
        return int(max(info.simplex_iteration_count, 0) + max(info.ipm_iteration_count, 0))

    def vertex(self, groups: IntArray | None = None) -> Vertex | None:
        """The optimal vertex to rounding, after `run` found one; None if the basis is singular or leads nowhere.

        Args:
            groups: (r,) rows of the same number measure violations by the largest terms of any of them.
        """
        basis = self.highs.getBasis()
        status = np.array([int(s) for s in (*basis.col_status, *basis.row_status)], dtype=np.int64)
        form = StandardForm(self._matrix, self._cost, self._column, self._row, groups)
        return form.vertex(status)
