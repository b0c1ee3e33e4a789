"""Contacts that no mechanism of a window moves, and contacts that every mechanism moves: by virtual work alone."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import FloatArray
from methods.bound.equations import Equations
from methods.bound.slack_bounds import Case, SlackBounds
from methods.bound.tuning import ROUNDING
from methods.numerics.linear_programme import INFINITY, Programme


class RateProgramme:
    """The linear programme over mechanisms of live work n, kept so that each window starts from the last basis.

    A mechanism of a multiplier of at most `high` loses no more in friction, at the least normal forces, than dead loads
    and `high` times the live load give (the lift of `methods.bound.relaxation`).
    """

    def __init__(self, equations: Equations) -> None:
        m, n = equations.n_interfaces, len(equations.dead)
        self._equations, self._m, self._n = equations, m, n
        strains = sp.hstack([equations.kinematic, -sp.csc_matrix(equations.flow)])
        work = sp.csc_matrix(np.append(equations.live, np.zeros(4 * m))[None, :])
        lift = sp.csc_matrix(np.ones(n + 4 * m)[None, :])
        lower = np.concatenate([np.full(n, -INFINITY), np.zeros(4 * m)])
        right = np.append(np.zeros(3 * m), equations.n_blocks)
        self._lift = np.zeros(n + 4 * m)
        self._programme = Programme(
            sp.csc_matrix(sp.vstack([strains, work, lift])),
            np.zeros(n + 4 * m),
            (lower, np.full(n + 4 * m, INFINITY)),
            (np.append(right, 0.0), np.append(right, INFINITY)),
        )

    def multiplier(self) -> float:
        """The least multiplier that virtual work leaves to mechanisms of the last window and case; inf without any."""
        cost = -self._lift[self._n :] / self._equations.n_blocks
        self._programme.set_costs(0, np.append(-self._equations.dead / self._equations.n_blocks, cost))
        status, value, _ = self._programme.run()
        self._programme.set_costs(0, np.zeros(self._n))
        if status != "optimal":
            return np.inf if status == "infeasible" else 0.0
        return float(cost @ value[self._n :] - self._equations.dead @ value[: self._n] / self._equations.n_blocks)

    def decided(self, high: float, bounds: SlackBounds, case: Case) -> Case | None:
        """The case with the contacts that mechanisms of the window never move or always move; None without mechanisms.

        Args:
            high: upper end of the window.
            bounds: slacks of the window and the case.
            case: what is decided already.
        """
        m, n = self._m, self._n
        still = bounds.least > ROUNDING.margin
        still[list(case.still)] = True
        upper = np.where(still, 0.0, INFINITY)
        self._programme.set_columns(n, np.zeros(4 * m), upper)
        strength = np.repeat(self._equations.friction * bounds.normal_least, 4).reshape(m, 4)
        strength[:, :2] = 0.0
        self._lift = np.append(high * self._equations.live + self._equations.dead, -strength)
        self._programme.set_row(3 * m + 1, self._lift)
        tight, held = set(case.tight), set(case.still)
        for contact in np.flatnonzero(~still):
            if contact in tight:
                continue
            cost = np.zeros(4 * m)
            cost[contact] = 1.0
            if contact % 4 >= 2:
                cost[contact ^ 1] = -1.0
            status, least = self._least(cost)
            if status == "infeasible":
                return None
            if status == "optimal" and least > ROUNDING.margin:
                tight.add(int(contact))
                continue
            status, greatest = self._least(-cost)
            if status == "optimal" and -greatest < ROUNDING.no_row:
                held.add(int(contact))
        return Case(frozenset(tight), frozenset(held))

    def _least(self, cost: FloatArray) -> tuple[str, float]:
        self._programme.set_costs(self._n, cost)
        status, value, _ = self._programme.run()
        return status, float(cost @ value[self._n :]) if status == "optimal" else -np.inf
