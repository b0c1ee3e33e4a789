"""Contacts that no mechanism of a window moves, and contacts that every mechanism moves: by virtual work alone."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import FloatArray
from methods.numerics.linear_programme import INFINITY, Programme
from methods.proof.search.equations import Equations
from methods.proof.search.slack_bounds import SlackBounds
from methods.proof.search.subproblem import Subproblem


@dataclass(frozen=True, eq=False)
class RateProof:
    """Virtual forces that show something of all mechanisms.

    Attributes:
        shows: that a contact has a rate, that it has next to none, or that there is no mechanism.
        strains: (3m,) forces on strains; lift, work: multiples of the lift, and of the live work, in addition.
        contact: of which something is shown.
    """

    shows: Literal["tight", "slow", "no mechanism"]
    strains: FloatArray
    lift: float
    work: float
    contact: int = -1


class RateProgramme:
    """The linear programme over mechanisms of live work n, kept so that each window starts from the last basis.

    A mechanism of a multiplier of at most `high` loses no more in friction, at the least normal forces, than dead loads
    and `high` times the live load give (the lift of `methods.proof.search.relaxation`).
    """

    def __init__(self, equations: Equations) -> None:
        m, n = equations.n_interfaces, len(equations.dead)
        self._equations, self._m, self._n = equations, m, n
        strains = sp.hstack([equations.kinematic, -sp.csc_matrix(equations.flow)])
        work = sp.csc_matrix(np.append(equations.live, np.zeros(4 * m))[None, :])
        lift = sp.csc_matrix(np.ones(n + 4 * m)[None, :])
        lower = np.concatenate([np.full(n, -INFINITY), np.zeros(4 * m)])
        right = np.append(np.zeros(3 * m), equations.n_blocks)
        self._programme = Programme(
            sp.csc_matrix(sp.vstack([strains, work, lift])),
            np.zeros(n + 4 * m),
            (lower, np.full(n + 4 * m, INFINITY)),
            (np.append(right, 0.0), np.append(right, INFINITY)),
        )

    def _proof(self, shows: Literal["tight", "slow", "no mechanism"], dual: FloatArray, contact: int = -1) -> RateProof:
        m = self._m
        strains = -dual[: 3 * m]
        if contact >= 0:
            p, k = divmod(contact, 4)
            strains[3 * p + min(k, 2)] += (1.0 if shows == "slow" else -1.0) * (-1.0 if k == 3 else 1.0)
        return RateProof(shows, strains, max(float(dual[3 * m + 1]), 0.0), -float(dual[3 * m]), contact)

    def _no_mechanism(self) -> RateProof:
        ray = self._programme.ray()
        if ray is None:
            ray = np.zeros(3 * self._m + 2)
        return self._proof("no mechanism", ray if ray[3 * self._m] > 0.0 else -ray)

    def decided(self, high: float, bounds: SlackBounds, case: Subproblem) -> tuple[Subproblem | None, list[RateProof]]:
        """The case with the contacts that mechanisms of the window never move or always move, and what proves it.

        The case is None where there are no mechanisms.

        Args:
            high: upper end of the window.
            bounds: slacks of the window and the case.
            case: what is decided already.
        """
        m, n = self._m, self._n
        rounding = self._equations.options.rounding
        still = bounds.least > rounding.margin
        still[list(case.still)] = True
        upper = np.where(still, 0.0, INFINITY)
        self._programme.set_columns(n, np.zeros(4 * m), upper)
        strength = np.repeat(self._equations.law.by_friction(bounds.normal_least), 4).reshape(m, 4)
        strength[:, :2] = 0.0
        lift = np.append(high * self._equations.live + self._equations.dead, -strength)
        self._programme.set_row(3 * m + 1, lift)
        if self._least(np.zeros(4 * m))[0] == "infeasible":
            return None, [self._no_mechanism()]
        tight, held, proofs = set(case.tight), set(case.still), list[RateProof]()
        for contact in np.flatnonzero(~still):
            if contact in tight:
                continue
            cost = np.zeros(4 * m)
            cost[contact] = 1.0
            if contact % 4 >= 2:
                cost[contact ^ 1] = -1.0
            status, least, dual = self._least(cost)
            if status == "infeasible":
                return None, [self._no_mechanism()]
            if status == "optimal" and least > rounding.margin:
                tight.add(int(contact))
                proofs.append(self._proof("tight", dual, int(contact)))
                continue
            status, greatest, dual = self._least(-cost)
            if status == "optimal" and -greatest < rounding.tolerance:
                held.add(int(contact))
                proofs.append(self._proof("slow", dual, int(contact)))
        return replace(case, tight=frozenset(tight), still=frozenset(held)), proofs

    def _least(self, cost: FloatArray) -> tuple[str, float, FloatArray]:
        self._programme.set_costs(self._n, cost)
        status, value, dual = self._programme.run()
        return status, float(cost @ value[self._n :]) if status == "optimal" else -np.inf, dual
