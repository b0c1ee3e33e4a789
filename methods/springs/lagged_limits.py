"""Equilibrium at a given multiplier by slow motion under friction limits that lag behind, for walls of long paths.

On walls of many irregular blocks the exact path goes to and fro over tens of thousands of kinks on its way up. Here the
load is raised in finite steps instead, each until the wall has come to rest again. In one increment du of the motion
the friction limits c of the gap points are fixed (Tresca), so that du is the minimum of a convex function,

    sum kn min(g, 0)^2 / 2 + sum h(tau) + sigma du' M du / 2 - loads' du,   h' = min(max(kt s + T0, -c), c),

which Newton with a line search finds. After it the shears are frozen in, as a friction history is committed, and the
limits go half of their way to mu N. The wall is at rest where neither moves any more: there the law of the gap
points holds exactly, and the path goes on from there kink by kink.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import FloatArray
from methods.numerics.vectors import largest
from methods.springs.equilibrium import FURTHEST
from methods.springs.factor import SingularTangent, make_factor
from methods.springs.gap_law import STICK
from methods.springs.wall_model import WallModel, load_scale, point_strains

AT_REST = 1e-9
"""Forces of inertia, and changes of the friction limits (shares of the load scale), below which a wall is at rest."""
BALANCED = 1e-12
"""Out-of-balance force (share of the load scale) at the end of an increment."""
FOLLOW = 0.5
"""Share of their way to mu N that the limits go after an increment."""
FIRST, LEAST, MOST = 1.0, 1e-4, 1e8
"""sigma at first, at least, and at which the motion is given up."""
FASTER, SLOWER, EASY = 0.5, 4.0, 8
"""Factors on sigma after an increment of at most EASY Newton steps, and after one that was not found."""
NEWTON_STEPS, AT_ONCE, HALVINGS = 2000, 60, 12
"""Newton steps from one rest to the next, those of one increment, and steps of one line search, at most."""
FLAT = 0.5
"""Share of the slope at the start of a line search that is small enough at its end."""
FIRST_RISE, WIDTH = 1.0 / 64.0, 0.1
"""First rise of the multiplier as a share of its scale; width, over the upper end, of a bracket narrow enough."""
LOWEST = 1e-3
"""Share of the scale below which a multiplier without rest is not halved again."""


@dataclass(frozen=True, eq=False)
class Rest:
    """A wall at rest.

    Attributes:
        multiplier: of the live load; u: (N,) displacements.
        opening, shear: (P,) openings g and shears T of the gap points; limit: (P,) friction limits mu N.
    """

    multiplier: float
    u: FloatArray
    opening: FloatArray
    shear: FloatArray
    limit: FloatArray


class SlowMotion:
    """The motion of a wall from one rest to the next.

    Attributes:
        rest: the last rest.
    """

    def __init__(self, model: WallModel, u: FloatArray, multiplier: float, history: FloatArray) -> None:
        opening, slip = model.strains(u)
        limit = _limits(model, opening)
        shear = np.clip(model.kt * slip + history, -limit, limit)
        self.model = model
        self.rest = Rest(multiplier, u, opening, shear, limit)
        self._resisting = replace(model, kn=model.kn.copy(), kt=model.kt.copy())
        self._factor = make_factor(self._resisting)
        self._stick = np.full(model.n_points, STICK)

    def history(self) -> FloatArray:
        """The history h = T - kt s (P,) frozen in at the last rest."""
        return self.rest.shear - self.model.kt * self.model.strains(self.rest.u)[1]

    def raise_load(self, scale: float) -> Iterator[Rest]:
        """Raise the multiplier from rest to rest until the least at which none was found is hardly above the last.

        Args:
            scale: a multiplier of the order of collapse.
        """
        rise, highest = FIRST_RISE * scale, np.inf
        while highest - self.rest.multiplier >= WIDTH * highest and LOWEST * scale < highest:
            goal = self.rest.multiplier + rise
            if goal >= highest:
                goal = 0.5 * (self.rest.multiplier + highest)
            if goal > FURTHEST * scale:
                return
            if self.move(goal):
                rise *= 2.0
                yield self.rest
            else:
                highest = goal

    def move(self, multiplier: float) -> bool:
        """Move to rest at another multiplier; False, and still at the old rest, where none is found."""
        model = self.model
        sigma, scale, now = FIRST, load_scale(model, multiplier), replace(self.rest, multiplier=multiplier)
        spent = 0
        while spent < NEWTON_STEPS:
            after, steps = self._increment(now, sigma, scale)
            spent += steps
            if after is None:
                sigma *= SLOWER
                if sigma > MOST:
                    return False
                continue
            inertia = sigma * largest(model.inertia * (after.u - now.u))
            lag = _limits(model, after.opening) - now.limit
            if max(inertia, largest(lag)) < AT_REST * scale:
                self.rest = replace(after, limit=now.limit + lag)
                return True
            limit = now.limit + FOLLOW * lag
            now = replace(after, limit=limit, shear=np.clip(after.shear, -limit, limit))
            if steps <= EASY:
                sigma = max(FASTER * sigma, LEAST)
        return False

    def _increment(self, now: Rest, sigma: float, scale: float) -> tuple[Rest | None, int]:
        """The motion of one increment under the limits of its beginning, None where Newton fails; Newton steps."""
        model, resisting = self.model, self._resisting
        opening, trial, moved = now.opening, now.shear, np.zeros_like(now.u)
        opening_rate, slip_rate = np.empty_like(opening), np.empty_like(trial)
        residual = self._out_of_balance(now, opening, trial)
        for count in range(1, AT_ONCE + 1):
            np.multiply(model.kn, opening < 0.0, out=resisting.kn)
            np.multiply(model.kt, np.abs(trial) < now.limit, out=resisting.kt)
            try:
                self._factor.refactor(self._stick, sigma)
                step = self._factor.solve(residual)
            except SingularTangent:
                return None, count
            point_strains(model.unknown, model.rows, model.interface, model.position, step, opening_rate, slip_rate)
            slip_rate *= model.kt
            slope, share, low, high = float(step @ residual), 1.0, 0.0, 1.0
            for _ in range(HALVINGS):
                further = opening + share * opening_rate, trial + share * slip_rate, moved + share * step
                residual = self._out_of_balance(now, *further[:2]) - sigma * model.inertia * further[2]
                left = float(step @ residual)
                if abs(left) <= FLAT * abs(slope) or (share == 1.0 and left >= 0.0):
                    break
                low, high = (share, high) if left > 0.0 else (low, share)
                share = 0.5 * (low + high)
            opening, trial, moved = further
            if largest(residual) < BALANCED * scale:
                shear = np.clip(trial, -now.limit, now.limit)
                return replace(now, u=now.u + moved, opening=opening, shear=shear), count
        return None, AT_ONCE

    def _out_of_balance(self, now: Rest, opening: FloatArray, trial: FloatArray) -> FloatArray:
        """Loads minus internal forces (N,) at openings g and trial shears tau (P,) under the limits of now."""
        shear = np.clip(trial, -now.limit, now.limit)
        return self.model.out_of_balance(np.minimum(opening, 0.0), shear, self._stick, now.multiplier)


def _limits(model: WallModel, opening: FloatArray) -> FloatArray:
    """Friction limits mu N (P,) at openings g (P,)."""
    return model.mu * np.maximum(-model.kn * opening, 0.0)
