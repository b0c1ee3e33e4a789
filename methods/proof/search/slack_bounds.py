"""Least and greatest yield slacks of all states of forces in equilibrium on a multiplier interval.

min or max w.y   s.t.  C' r + f0 + lambda fL = 0,   y = S r + s0 >= 0,   low <= lambda <= high
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import FloatArray
from methods.numerics.linear_programme import INFINITY, Programme
from methods.proof.search.equations import Equations
from methods.proof.search.subproblem import Subproblem


@dataclass(frozen=True, eq=False)
class SlackBounds:
    """Bounds of slacks and normal forces within a window, in mean block weights, widened by `Rounding.margin`.

    Attributes:
        least: (4m,) least slacks; zero where not known.
        normal_least, normal_greatest: (m,) normal forces of interfaces; zero and inf where not known.
        greatest: (4m,) greatest slacks, from the greatest normal forces.
        still_velocities, least_velocities, greatest_velocities: (4m, 3n), (m, 3n), (m, 3n) virtual velocities that
            prove the bounds, not widened.
    """

    least: FloatArray
    normal_least: FloatArray
    normal_greatest: FloatArray
    greatest: FloatArray
    still_velocities: FloatArray
    least_velocities: FloatArray
    greatest_velocities: FloatArray


class SlackProgramme:
    """The linear programme over forces and multiplier, kept between windows so that each starts from the last basis.

    Attributes:
        margin: by which its bounds are widened, in mean block weights.
    """

    def __init__(self, equations: Equations) -> None:
        m, n = equations.n_interfaces, len(equations.dead)
        self._m, self._n, self._friction = m, n, equations.friction
        self.margin = equations.options.rounding.margin
        statics = sp.hstack([equations.kinematic.T, sp.csc_matrix((n, 4 * m)), sp.csc_matrix(equations.live[:, None])])
        yields = sp.hstack([sp.csc_matrix(equations.slack), -sp.eye(4 * m), sp.csc_matrix((4 * m, 1))])
        ends = np.repeat(np.eye(m), 4, axis=1) * np.tile([1.0, 1.0, 0.0, 0.0], m)
        normals = sp.csc_matrix(np.pad(ends, [(0, 0), (3 * m, 1)]))
        values = sp.vstack([sp.csc_matrix((n + 4 * m, m)), -sp.eye(m)])
        matrix = sp.hstack([sp.vstack([statics, yields, normals]), values])
        right = np.append(-equations.dead, np.zeros(5 * m))
        lower = np.concatenate([np.full(3 * m, -INFINITY), np.zeros(5 * m + 1)])
        upper = np.full(8 * m + 1, INFINITY)
        self._programme = Programme(sp.csc_matrix(matrix), np.zeros(8 * m + 1), (lower, upper), (right, right))

    def window(self, low: float, high: float, case: Subproblem = Subproblem()) -> None:
        """Keep multipliers within a window, and slacks and normal forces within a case, from now on."""
        greatest = np.full(4 * self._m, INFINITY)
        greatest[list(case.tight)] = 0.0
        self._programme.set_columns(3 * self._m, np.zeros(4 * self._m), greatest)
        self._programme.set_columns(7 * self._m, np.array([low]), np.array([high]))
        normal = np.tile([0.0, INFINITY], (self._m, 1))
        for p, side, limit in case.limits():
            normal[p, 0 if side > 0 else 1] = limit
        self._programme.set_columns(7 * self._m + 1, normal[:, 0].copy(), normal[:, 1].copy())

    def least(self, slacks: FloatArray) -> tuple[str, float, FloatArray]:
        """(status, least weighted sum of slacks (4m,), virtual velocities (3n,) that prove it)."""
        self._programme.set_costs(3 * self._m, slacks)
        status, value, dual = self._programme.run()
        return status, float(slacks @ value[3 * self._m : 7 * self._m]), dual[: self._n]

    def multiplier(self) -> tuple[float, FloatArray]:
        """The least multiplier of the window and the case, inf if there is none, with velocities that prove it."""
        self._programme.set_costs(0, np.append(np.zeros(7 * self._m), 1.0))
        status, value, dual = self._programme.run()
        self._programme.set_costs(7 * self._m, np.zeros(1))
        if status == "infeasible":
            return np.inf, self.excluding()
        return (float(value[7 * self._m]), dual[: self._n]) if status == "optimal" else (0.0, np.zeros(self._n))

    def excluding(self) -> FloatArray:
        """(3n,) virtual velocities, of either sign, that exclude all forces, where there were none."""
        ray = self._programme.ray()
        return np.zeros(self._n) if ray is None else ray[: self._n]

    def bounds(self, low: float, high: float, case: Subproblem = Subproblem()) -> SlackBounds | None:
        """Bounds of all slacks for multipliers from `low` to `high`; None if no forces within yield exist there."""
        m = self._m
        self.window(low, high, case)
        slacks = np.eye(4 * m)
        normals = slacks.reshape(m, 4, 4 * m)[:, :2].sum(axis=1)
        found = [self._all(weights) for weights in (slacks, normals, -normals)]
        if any(values is None for values in found):
            return None
        (least, still), (normal_least, lower), (normal_greatest, upper) = (part for part in found if part is not None)
        by_normal = np.maximum(-normal_greatest, 0.0) + self.margin
        by_slip = np.zeros(m)
        np.multiply(2.0 * self._friction, by_normal, out=by_slip, where=self._friction > 0.0)
        greatest = np.column_stack([by_normal, by_normal, by_slip, by_slip]).ravel()
        greatest[list(case.tight)] = 0.0
        return SlackBounds(
            np.maximum(least - self.margin, 0.0),
            np.maximum(normal_least - self.margin, 0.0),
            by_normal,
            greatest,
            still,
            lower,
            upper,
        )

    def _all(self, weights: FloatArray) -> tuple[FloatArray, FloatArray] | None:
        """Least values (k,) of weighted sums of slacks (k, 4m), -inf where not known, with the velocities (k, 3n)."""
        values, velocities = np.full(len(weights), -np.inf), np.zeros((len(weights), self._n))
        for k, slacks in enumerate(weights):
            status, value, dual = self.least(slacks)
            if status == "infeasible":
                return None
            if status == "optimal":
                values[k], velocities[k] = value, dual
        return values, velocities
