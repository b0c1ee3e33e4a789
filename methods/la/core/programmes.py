"""The two linear programmes of the search, kept in HiGHS so that a change of the active set starts from the last basis.

Static, with the slacks of J held at zero; kinematic, with the rates of the contacts K only:

    min or max lambda   s.t.  C' r + f0 + lambda fL = 0,   y = S r + s0 >= 0,   y_J = 0
    min c.g             s.t.  C u = E g,   fL.u = const,   g >= 0,   g_k = 0 outside K

The vertices of the kinematic programme are extreme mechanisms.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import BoolArray, FloatArray
from harness.model.joint_law import block_diagonal
from methods.la.core.problem import Problem
from methods.numerics.linear_programme import INFINITY, Programme

_SIMPLEX_UP_TO = 800
"""Interfaces up to which the simplex method is the quicker way to a vertex; above, its interior point with
crossover."""
_DEVEX_ABOVE = 200
"""Interfaces above which Devex pricing finds the vertex sooner than steepest edge."""


@dataclass(frozen=True)
class StaticSolution:
    """Forces (m, 3) and multiplier, both scaled, and the simplex or interior iterations spent."""

    forces: FloatArray
    multiplier: float
    iterations: int


@dataclass(frozen=True)
class KinematicSolution:
    """Velocities (3n,) and rates (m, 4), scaled to the live work of the problem."""

    velocities: FloatArray
    rates: FloatArray


class StaticProgramme:
    """min lambda >= 0, or max lambda, s.t. C' r + f0 + lambda fL = 0, y = S r + s0 >= 0, y_k = 0 for tight k.

    Columns are the slacks (y1, y2, y3) of an interface, from which r and y4 follow, and lambda.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        m, rows, constant = problem.n_interfaces, problem.law.rows, problem.law.constant
        inverse = 2.0 * np.eye(3) - rows[:, :3]  # of a matrix whose diagonal is one, with entries in the last row only
        forces, last = block_diagonal(inverse), rows[:, 3:] @ inverse
        equilibrium = sp.hstack([problem.statics @ forces, sp.csr_matrix(problem.live[:, None])])
        backward = sp.hstack([block_diagonal(last), sp.csr_matrix((m, 1))])
        self._forces, self._constant = forces, constant[:, :3]
        self._least_last = 0.0 - (constant[:, 3] - (last[:, 0] * constant[:, :3]).sum(axis=1))
        dead = problem.dead - problem.statics @ np.asarray(forces @ constant[:, :3].ravel())
        # Weights that differ let one vertex alone have the least sum; by so little that it is that of least forces.
        self._weights = np.random.default_rng(0).uniform(1.0, 1.1, size=3 * m)
        self._free = (np.zeros(3 * m), np.full(3 * m, INFINITY))
        cost = np.zeros(3 * m + 1)
        self._programme = Programme(
            sp.csc_matrix(sp.vstack([equilibrium, backward])),
            cost,
            (np.append(self._free[0], -INFINITY), np.append(self._free[1], INFINITY)),
            (np.append(-dead, self._least_last), np.append(-dead, np.full(m, INFINITY))),
        )
        self._programme.highs.setOptionValue("solver", "simplex" if m <= _SIMPLEX_UP_TO else "ipm")
        if m > _DEVEX_ABOVE:
            self._programme.highs.setOptionValue("simplex_dual_edge_weight_strategy", 1)

    def solve(
        self, tight: BoolArray | None = None, greatest: bool = False, below: float = INFINITY
    ) -> StaticSolution | str:
        """The solution, or "infeasible", "unbounded", "above", "unknown".

        Joints that are redundant let many forces go with the least multiplier, and which of them a solver comes upon
        differs from release to release, while a search goes on from them. So of all these, a second programme takes
        those of least weighted sum.

        Args:
            tight: (m, 4) slacks held at zero.
            greatest: maximise the multiplier instead of minimising it.
            below: a least multiplier that is not below this is of no use, and ends as "above".
        """
        m = self.problem.n_interfaces
        tight = np.zeros((m, 4), dtype=bool) if tight is None else tight
        upper = np.where(tight[:, :3].ravel(), 0.0, INFINITY)
        self._programme.set_columns(0, self._free[0], upper)
        most = np.where(tight[:, 3], self._least_last, INFINITY)
        self._programme.set_rows(self.problem.n_velocities, self._least_last, most)
        self._programme.set_columns(3 * m, np.array([-INFINITY if greatest else 0.0]), np.array([INFINITY]))
        self._programme.set_costs(3 * m, np.array([-1.0 if greatest else 1.0]))
        status, value, _ = self._programme.run(below)
        if status != "optimal":
            return status
        if value[-1] >= below:
            return "above"
        multiplier, iterations = float(value[-1]), self._programme.iterations()
        if not greatest:
            self._programme.set_columns(3 * m, value[-1:], value[-1:])
            least = self._least(self._weights)
            value = value if least is None else least
            iterations += self._programme.iterations()
        return StaticSolution(self._to_forces(value), multiplier, iterations)

    def lightest(self, weights: FloatArray) -> FloatArray | None:
        """Forces (m, 3) that carry the dead load with the least sum of weights (m, 2) times n1, n2; None if not found.

        Such forces have little self-stress: what one joint does not need, it does not bear.
        """
        m = self.problem.n_interfaces
        self._hold(0.0)
        value = self._least(np.column_stack([weights, np.zeros(m)]).ravel())
        return None if value is None else self._to_forces(value)

    def _least(self, weights: FloatArray) -> FloatArray | None:
        """The columns of least weighted sum, the multiplier without cost."""
        m = self.problem.n_interfaces
        self._programme.set_costs(0, np.append(weights, 0.0))
        status, value, _ = self._programme.run()
        self._programme.set_costs(0, np.zeros(3 * m))
        return value if status == "optimal" else None

    def _hold(self, multiplier: float) -> None:
        """Let no slack be held, but the multiplier."""
        m = self.problem.n_interfaces
        self._programme.set_columns(0, *self._free)
        self._programme.set_rows(self.problem.n_velocities, self._least_last, np.full(m, INFINITY))
        self._programme.set_columns(3 * m, np.array([multiplier]), np.array([multiplier]))

    def _to_forces(self, value: FloatArray) -> FloatArray:
        """Forces (m, 3) of the columns."""
        slack = np.maximum(value[:-1], 0.0) - self._constant.ravel()
        return np.asarray(self._forces @ slack).reshape(-1, 3)


class KinematicProgramme:
    """min c.g s.t. C u = E g, fL.u = live work, g >= 0, g_k = 0 outside the allowed contacts."""

    def __init__(self, problem: Problem, associated: bool = False) -> None:
        self.problem = problem
        m, n = problem.n_interfaces, problem.n_velocities
        flow = block_diagonal(problem.flow_law(associated).flow)
        rates = flow.shape[1]
        live = sp.hstack([sp.csr_matrix(problem.live[None, :]), sp.csr_matrix((1, rates))])
        right = np.append(np.zeros(3 * m), problem.live_work)
        self._n = n
        self._programme = Programme(
            sp.csc_matrix(sp.vstack([sp.hstack([problem.kinematic, -flow]), live])),
            np.zeros(n + rates),
            (np.append(np.full(n, -INFINITY), np.zeros(rates)), np.full(n + rates, INFINITY)),
            (right, right),
        )

    def solve(self, allowed: BoolArray, cost: FloatArray) -> KinematicSolution | None:
        """The mechanism of least cost (m, k) in the allowed contacts (m, k), k rows a joint; None without any."""
        upper = np.where(allowed.ravel(), INFINITY, 0.0)
        self._programme.set_columns(self._n, np.zeros(len(upper)), upper)
        self._programme.set_costs(self._n, cost.ravel())
        status, value, _ = self._programme.run()
        if status != "optimal":
            return None
        return KinematicSolution(value[: self._n], value[self._n :].reshape(allowed.shape))
