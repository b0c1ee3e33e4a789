"""Limit analysis without dilatancy as one programme in all of its unknowns, for solvers of other people.

With forces r of slacks y = S r >= 0, rates g >= 0 and velocities u (`harness.model.joint_law`) it is

    min lambda   s.t.   C' r + f0 + lambda fL = 0,   y = S r >= 0,   C u = E g,   fL.u = n,   y_k g_k = 0,

with g, lambda >= 0, for n free blocks (Baggio and Trovalusci 1995; Ferris and Tin-Loi 2001 as a mathematical programme
with complementarity).

By virtual work lambda n + f0.u is the work of friction, at least the sum of mu N |slip| at the least normal forces N
that statics allows. That follows from the programme, but no relaxation that takes forces and rates apart knows it, and
its bound stays at zero without. So it is one more row (`virtual_work`) for peers that bound the multiplier.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import Assembly, FloatArray
from harness.model.joint_law import block_diagonal
from methods.numerics.linear_programme import INFINITY, Programme
from methods.numerics.statics import greatest_multiplier

_ROUNDING = 1e-6
"""By which extreme values of linear programmes are moved outwards: more than the 1e-9 to which they hold."""


@dataclass(frozen=True, eq=False)
class CollapseProgramme:
    """The programme of a wall, scaled so that mean dead load, block size and total live load are of order one.

    Attributes:
        assembly: the wall, of dry joints without dilatancy; n = number of free blocks, m = number of interfaces.
        kinematic: (3m, 3n) matrix C, strains from velocities (ux, uy, omega * length scale).
        dead, live: (3n,) loads.
        unit_force: mean dead load of a free block [force].
        greatest: multiplier that no forces pass, in units of `assembly.load_unit`; infinite where there is none.
    """

    assembly: Assembly
    kinematic: sp.csr_matrix
    dead: FloatArray
    live: FloatArray
    unit_force: float
    greatest: float

    @property
    def unknowns(self) -> int:
        """The multiplier, forces, velocities and rates."""
        return 1 + 7 * self.assembly.n_interfaces + 3 * self.assembly.n_free

    @cached_property
    def yield_rows(self) -> sp.csr_matrix:
        """(4m, 3m) matrix S, slacks from forces."""
        return block_diagonal(self.assembly.law.rows)

    @cached_property
    def flow(self) -> sp.csr_matrix:
        """(3m, 4m) matrix E, strains from rates."""
        return block_diagonal(self.assembly.law.flow)

    @cached_property
    def statics(self) -> sp.csr_matrix:
        """(3n, 3m + 1) equilibrium: C' and the live load, which balance minus the dead load."""
        return sp.csr_matrix(sp.hstack([self.kinematic.T, sp.csr_matrix(self.live[:, None])]))

    @cached_property
    def _slack_rows(self) -> sp.csr_matrix:
        """(4m, 3m + 1) matrix S beside the multiplier, which is in no slack."""
        return sp.csr_matrix(sp.hstack([self.yield_rows, sp.csr_matrix((self.yield_rows.shape[0], 1))]))

    def forces_programme(self, cost: FloatArray) -> Programme:
        """Linear programme of forces and multiplier (3m + 1,) within yield and in equilibrium, with costs (3m + 1,).

        Its rows are those of equilibrium, then the 4m slacks.
        """
        matrix = sp.csc_matrix(sp.vstack([self.statics, self._slack_rows]))
        free, none = np.full(len(cost), INFINITY), np.zeros(self.yield_rows.shape[0])
        highest = min(self.greatest * (1.0 + _ROUNDING) + _ROUNDING, INFINITY)
        lower, upper = np.append(-free[:-1], 0.0), np.append(free[:-1], highest)
        rows = (np.append(-self.dead, none), np.append(-self.dead, np.full(len(none), INFINITY)))
        return Programme(matrix, cost, (lower, upper), rows)

    def motion_programme(self, greatest: FloatArray) -> Programme:
        """Linear programme of velocities and rates (3n + 4m,) of live work n with the least sum of rates.

        Args:
            greatest: (4m,) bounds on the rates.
        """
        n, m = self.assembly.n_free, self.assembly.n_interfaces
        work = sp.hstack([sp.csr_matrix(self.live[None, :]), sp.csr_matrix((1, 4 * m))])
        matrix = sp.csc_matrix(sp.vstack([sp.hstack([self.kinematic, -self.flow]), work]))
        free = np.full(3 * n, INFINITY)
        columns = (np.append(-free, np.zeros(4 * m)), np.append(free, greatest))
        rows = np.append(np.zeros(3 * m), float(n))
        return Programme(matrix, np.append(np.zeros(3 * n), np.ones(4 * m)), columns, (rows, rows))

    @cached_property
    def least_normal(self) -> FloatArray:
        """(m,) normal forces that statics leaves every interface at least, at any multiplier; zero where not known."""
        m = self.assembly.n_interfaces
        found = np.array([self._extreme(self._normal(p)) for p in range(m)])
        return np.where(np.isfinite(found), np.maximum(found - _ROUNDING, 0.0), 0.0)

    @cached_property
    def greatest_slack(self) -> FloatArray:
        """(4m,) greatest slacks that statics allows; infinite where self-stress has no end."""
        found = np.array([-self._extreme(-row) for row in self._slack_rows.toarray()])
        return np.asarray(found + _ROUNDING * (1.0 + abs(found)))

    def greatest_speed(self, greatest_rate: float) -> FloatArray:
        """(3n,) greatest velocities, either way, of motions with rates within a bound; infinite where not known."""
        columns = 3 * self.assembly.n_free
        programme = self.motion_programme(np.full(4 * self.assembly.n_interfaces, greatest_rate))
        programme.set_costs(columns, np.zeros(4 * self.assembly.n_interfaces))
        found = np.zeros(columns)
        for k in range(columns):
            for sign in (1.0, -1.0):
                programme.set_costs(k, np.array([sign]))
                status, values, _ = programme.run()
                found[k] = max(found[k], -sign * values[k] if status == "optimal" else np.inf)
            programme.set_costs(k, np.zeros(1))
        return found * (1.0 + _ROUNDING) + _ROUNDING

    def _normal(self, interface: int) -> FloatArray:
        cost = np.zeros(3 * self.assembly.n_interfaces + 1)
        cost[3 * interface : 3 * interface + 2] = 1.0
        return cost

    @cached_property
    def _of_extremes(self) -> Programme:
        return self.forces_programme(np.zeros(3 * self.assembly.n_interfaces + 1))

    def _extreme(self, cost: FloatArray) -> float:
        """The least value of a cost over all forces in equilibrium; minus infinity where it has none."""
        self._of_extremes.set_costs(0, cost)
        status, values, _ = self._of_extremes.run()
        return float(cost @ values) if status == "optimal" else -np.inf

    @property
    def virtual_work(self) -> tuple[float, FloatArray, FloatArray]:
        """Coefficients of lambda, of velocities (3n,) and of rates (4m,) in the row of virtual work, at least zero."""
        rates = np.zeros((self.assembly.n_interfaces, 4))
        rates[:, 2:] = -self.assembly.law.by_friction(self.least_normal)[:, None]
        return float(self.assembly.n_free), self.dead, rates.ravel()


def collapse_programme(assembly: Assembly) -> CollapseProgramme:
    """The programme of a wall that stands under its dead load and has a live load."""
    column = np.tile([1.0, 1.0, 1.0 / assembly.length_scale], assembly.n_free)
    unit = assembly.force_scale / assembly.n_free
    dead, live = assembly.free_loads()
    bears = greatest_multiplier(assembly)
    return CollapseProgramme(
        assembly,
        sp.csr_matrix(assembly.kinematic_matrix @ sp.diags(column)),
        dead * column / unit,
        live * column * assembly.load_unit / unit,
        unit,
        np.inf if bears is None else bears[0] / assembly.load_unit,
    )
