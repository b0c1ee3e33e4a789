"""Least and greatest yield slacks of all states of forces in equilibrium whose multiplier lies in a window."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import FloatArray
from methods.bound.equations import Equations
from methods.bound.tuning import ROUNDING
from methods.numerics.linear_programme import INFINITY, Programme


@dataclass(frozen=True, eq=False)
class SlackBounds:
    """Bounds of the slacks within a window.

    Attributes:
        least, greatest: (4m,) slacks in mean block weights, widened by `Rounding.margin`; zero and inf where not known.
    """

    least: FloatArray
    greatest: FloatArray

    def normal(self, friction: FloatArray) -> FloatArray:
        """(m,) least normal force of each interface, by its ends or by its friction."""
        ends, slip = self.least.reshape(-1, 4)[:, :2].sum(axis=1), self.least.reshape(-1, 4)[:, 2:].sum(axis=1)
        by_friction = np.divide(slip, 2.0 * friction, out=np.zeros_like(slip), where=friction > 0.0)
        return np.asarray(np.maximum(ends, by_friction))


class SlackProgramme:
    """The linear programme over forces and multiplier, kept between windows so that each starts from the last basis."""

    def __init__(self, equations: Equations) -> None:
        m, n = equations.n_interfaces, len(equations.dead)
        self._m = m
        statics = sp.hstack([equations.kinematic.T, sp.csc_matrix((n, 4 * m)), sp.csc_matrix(equations.live[:, None])])
        yields = sp.hstack([sp.csc_matrix(equations.slack), -sp.eye(4 * m), sp.csc_matrix((4 * m, 1))])
        right = np.append(-equations.dead, np.zeros(4 * m))
        lower = np.concatenate([np.full(3 * m, -INFINITY), np.zeros(4 * m + 1)])
        upper = np.full(7 * m + 1, INFINITY)
        self._programme = Programme(
            sp.csc_matrix(sp.vstack([statics, yields])), np.zeros(7 * m + 1), (lower, upper), (right, right)
        )

    def bounds(self, low: float, high: float) -> SlackBounds | None:
        """Bounds of all slacks for multipliers from `low` to `high`; None if no forces within yield exist there."""
        m = self._m
        self._programme.set_columns(7 * m, np.array([low]), np.array([high]))
        least, greatest = np.zeros(4 * m), np.full(4 * m, np.inf)
        for k in range(4 * m):
            for sign, values in ((1.0, least), (-1.0, greatest)):
                cost = np.zeros(4 * m)
                cost[k] = sign
                self._programme.set_costs(3 * m, cost)
                status, value, _ = self._programme.run()
                if status == "infeasible":
                    return None
                if status == "optimal":
                    values[k] = max(value[3 * m + k] - sign * ROUNDING.margin, 0.0)
        return SlackBounds(least, greatest)
