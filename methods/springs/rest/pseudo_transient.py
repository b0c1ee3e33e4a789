"""Pseudo-transient relaxation of a wall to rest, under friction limits that lag behind.

Where Newton cycles the wall moves in implicit steps against forces of inertia, sigma M du, with sigma lowered as it
settles. In one increment du of the motion the shear c = (mu - psi) N that slip dissipates at the gap points is fixed
(Tresca), so that du is the minimum of a convex function,

    sum min over e of [kn min(g - psi |e|, 0)^2 / 2 + (tau - kt e)^2 / (2 kt) + c |e|] + sigma du' M du / 2 - loads' du

with tau = kt s + h, which Newton with a line search finds. After it the limits c go half of their way to (mu - psi) N;
a motion that commits its friction history also freezes the shears in, where slips do not lift. Near rest plain Newton
finds the equilibrium; where its tangent is singular, as in a statically determinate wall, the wall is at rest when
neither forces of inertia nor limits move any more. There the law of the gap points holds as it does on the exact path.
A wall that falls comes to a steady motion.

On walls of many irregular blocks the exact path goes to and fro over tens of thousands of breakpoints on its way up.
There the load is raised in finite steps instead, each until the wall has come to rest again.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.vectors import largest
from methods.springs.model.factor import Factor, SingularTangent, make_factor, refactor_any
from methods.springs.model.gap_law import STICK, frozen_forces
from methods.springs.model.point_loops import point_strains
from methods.springs.model.wall_model import WallModel, load_scale
from methods.springs.rest.newton import Equilibrium, newton

_SIGMA = 1.0
"""Sigma, the inverse square of the pseudo-time step, at first."""
_LEAST_SIGMA = 1e-4
"""Sigma at least."""
_MOST_SIGMA = 1e8
"""Sigma at which the motion is given up."""
_FASTER = 0.5
"""Factor on sigma after an increment of at most `_EASY` Newton steps."""
_SLOWER = 4.0
"""Factor on sigma after an increment that was not found."""
_EASY = 8
"""Newton steps of an increment up to which sigma falls."""
_RELAXATION = 0.5
"""Share of their way to mu N that the limits go after an increment."""
_BALANCED = 1e-12
"""Out-of-balance force at the end of an increment, as a share of the load scale."""
_ROUNDING = 1e-14
"""The same as a share of kn times the displacements."""
_STEPS = 60
"""Newton steps of an increment, at most."""
_HALVINGS = 12
"""Of one line search, at most."""
_SLOPE = 0.5
"""Share of the slope at the start of a line search that is small enough at its end."""
_STILL = 1e-9
"""Forces of inertia, and changes of the friction limits (shares of the load scale), below which a wall is at rest."""
_NEWTON_EVERY = 5
"""Increments after which plain Newton is tried."""
_NEWTON_STEPS = 12
"""Of plain Newton."""
_STEADY = 25
"""Increments over which the forces of inertia of a wall that falls keep up."""
_KEPT = 0.99
"""Share of them left at the end."""
_STEPS_TO_REST = 2000
"""Newton steps from one rest to the next, at most."""
_RISE = 1.0 / 64.0
"""Of the multiplier, as a share of its scale."""
_LONGER = 2.0
"""Factor on the rise after a rest."""
_WIDTH = 0.1
"""Of a bracket, over its upper end, that is narrow enough."""
_LOWEST = 1e-3
"""Share of the scale below which a multiplier without rest is not halved again."""


@dataclass(frozen=True, eq=False)
class _Moment:
    """A moment of the motion: displacements u (N,), and openings g, shears tau and friction limits c (P,)."""

    u: FloatArray
    opening: FloatArray
    trial: FloatArray
    limit: FloatArray


class PseudoTransient:
    """The motion of a wall from one rest to the next."""

    def __init__(self, model: WallModel, factor: Factor, start: Equilibrium, commits: bool) -> None:
        """Begin a motion.

        Args:
            model: the wall; factor: its tangent.
            start: where the wall is, in equilibrium or not; the virgin state where nothing is displaced.
            commits: whether the shears are frozen in after every increment, as a friction history is committed.
        """
        self.model, self.factor, self.commits = model, factor, commits and not model.dilates
        self._resisting = replace(model, kn=model.kn.copy(), mu=model.psi)
        self._factor = make_factor(self._resisting)
        self._stick = np.full(model.n_points, STICK)
        self._rest = start
        self._now = self._moment(start.u, start.history) if np.any(start.u) else self._virgin()

    def raise_load(self, scale: float) -> Iterator[Equilibrium]:
        """Raise the multiplier from rest to rest until the least at which none was found is hardly above the last.

        Args:
            scale: a multiplier of the order of collapse.
        """
        rise, highest = _RISE * scale, np.inf
        while highest - self._rest.multiplier >= _WIDTH * highest and _LOWEST * scale < highest:
            goal = self._rest.multiplier + rise
            if goal >= highest:
                goal = 0.5 * (self._rest.multiplier + highest)
            if goal > self.model.options.furthest * scale:
                return
            rest = self.move(goal)
            if rest.found:
                rise *= _LONGER
                yield rest
            else:
                highest = goal

    def move(self, multiplier: float, limit: int | None = None) -> Equilibrium:
        """Move to rest at another multiplier, in at most `limit` Newton steps (None: as the options say).

        Where none is found the wall stays where it was, and the answer says whether it falls: the motion of a wall
        that does becomes steady. One that neither rests nor moves steadily is undecided.
        """
        model, now = self.model, self._now
        limit = _STEPS_TO_REST if limit is None else limit
        scale, loads = load_scale(model, multiplier), model.dead + multiplier * model.live
        still = np.zeros_like(now.u)
        fall = ahead = still
        sigma, increments, spent, before = _SIGMA, 0, 0, np.inf
        while spent < limit and sigma < _MOST_SIGMA:
            after, steps = self._increment(now, multiplier, sigma, ahead)
            spent += steps
            if after is None:
                sigma, ahead = _SLOWER * sigma, still
                continue
            increments += 1
            rate = after.u - now.u
            lag = self._dissipated(after) - now.limit
            inertia, change = sigma * largest(model.inertia * rate), largest(lag)
            history = self._history(after, now.limit + lag)
            if max(inertia, change) < _STILL * scale:
                return self._at_rest(after.u, multiplier, history, spent)
            if increments % _NEWTON_EVERY == 0:
                near = newton(model, self.factor, after.u, multiplier, history, _NEWTON_STEPS)
                spent += near.iterations
                if near.found:
                    return self._at_rest(near.u, multiplier, history, spent)
            ahead = rate if change < inertia else still
            if increments % _STEADY == 0:
                if change < inertia and inertia > _KEPT * before and float(loads @ rate) > 0.0:
                    fall = rate
                    break
                before = inertia
            now = self._committed(after, now.limit + _RELAXATION * lag)
            if steps <= _EASY and sigma > _LEAST_SIGMA:
                sigma *= _FASTER
        history = self._history(now, now.limit)
        return Equilibrium(False, multiplier, now.u, history, model.states(now.u, history), np.inf, fall, spent)

    def _at_rest(self, u: FloatArray, multiplier: float, history: FloatArray, spent: int) -> Equilibrium:
        """The equilibrium at displacements u (N,) under a history h (P,), which the wall goes on from."""
        model = self.model
        state = model.states(u, history)
        residual = largest(model.residual(u, multiplier, history, state)) / load_scale(model, multiplier)
        self._rest = Equilibrium(True, multiplier, u, history, state, residual, np.zeros_like(u), spent)
        self._now = self._moment(u, history)
        return self._rest

    def _moment(self, u: FloatArray, history: FloatArray) -> _Moment:
        """The moment at displacements u (N,) under a history h (P,)."""
        model = self.model
        opening, slip = model.strains(u)
        normal, _ = model.forces(u, history, model.states(u, history))
        limit = model.law.dissipated(normal)
        return self._committed(_Moment(u, opening, model.kt * slip + history, limit), limit)

    def _committed(self, moment: _Moment, limit: FloatArray) -> _Moment:
        """The moment under new friction limits c (P,), with its shears frozen in if the motion commits them."""
        trial = moment.trial
        if self.commits:
            trial = self.model.updated(np.clip(trial, -limit, limit), trial)
        return replace(moment, trial=trial, limit=limit)

    def _history(self, moment: _Moment, limit: FloatArray) -> FloatArray:
        """The history h (P,) that holds at a moment under friction limits c (P,)."""
        if not self.commits:
            return self._rest.history
        return self._committed(moment, limit).trial - self.model.kt * self.model.strains(moment.u)[1]

    def _virgin(self) -> _Moment:
        """The moment before any displacement, with the friction limits of the loads on closed joints that stick."""
        model, start = self.model, self._rest
        moment = self._moment(start.u, start.history)
        state = model.states(start.u, start.history, True)
        try:
            refactor_any(self.factor, state)
            u = self.factor.solve(model.residual(start.u, start.multiplier, start.history, state))
        except SingularTangent:
            return moment
        pressed = np.minimum(model.strains(u)[0], 0.0)
        return self._committed(moment, model.law.dissipated(-model.kn * pressed))

    def _increment(
        self, now: _Moment, multiplier: float, sigma: float, ahead: FloatArray
    ) -> tuple[_Moment | None, int]:
        """The motion of one increment under the limits of its beginning, None where Newton fails; Newton steps.

        Args:
            ahead: (N,) displacements of the increment that Newton starts from.
        """
        model, resisting = self.model, self._resisting
        opening_rate, slip_rate = self._strain_rates(ahead)
        opening, trial, moved = now.opening + opening_rate, now.trial + slip_rate, ahead
        residual = self._out_of_balance(now, multiplier, opening, trial) - sigma * model.inertia * moved
        rounding = _ROUNDING * largest(model.kn) * largest(now.u)
        balanced = _BALANCED * load_scale(model, multiplier) + rounding
        for count in range(1, _STEPS + 1):
            model.deadline.ask()
            state, pressed, _ = self._frozen(opening, trial, now.limit)
            np.multiply(model.kn, pressed < 0.0, out=resisting.kn)
            try:
                self._factor.refactor(state, sigma)
                step = self._factor.solve(residual)
            except SingularTangent:
                return None, count
            opening_rate, slip_rate = self._strain_rates(step)
            slope, share, low, high = float(step @ residual), 1.0, 0.0, 1.0
            for _ in range(_HALVINGS):
                further = opening + share * opening_rate, trial + share * slip_rate, moved + share * step
                residual = self._out_of_balance(now, multiplier, *further[:2]) - sigma * model.inertia * further[2]
                left = float(step @ residual)
                if abs(left) <= _SLOPE * abs(slope) or (share == 1.0 and left >= 0.0):
                    break
                low, high = (share, high) if left > 0.0 else (low, share)
                share = 0.5 * (low + high)
            opening, trial, moved = further
            if largest(residual) < balanced:
                return replace(now, u=now.u + moved, opening=opening, trial=trial), count
        return None, _STEPS

    def _strain_rates(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rates of the openings g and of the trial shears tau (P,) along displacements u (N,)."""
        model = self.model
        opening_rate, slip_rate = np.empty(model.n_points), np.empty(model.n_points)
        point_strains(model.unknown, model.rows, model.interface, model.position, u, opening_rate, slip_rate)
        slip_rate *= model.kt
        return opening_rate, slip_rate

    def _out_of_balance(self, now: _Moment, multiplier: float, opening: FloatArray, trial: FloatArray) -> FloatArray:
        """Loads minus internal forces (N,) at openings g and trial shears tau (P,) under the limits of now."""
        _, pressed, shear = self._frozen(opening, trial, now.limit)
        return self.model.out_of_balance(pressed, shear, self._stick, multiplier)

    def _frozen(
        self, opening: FloatArray, trial: FloatArray, limit: FloatArray
    ) -> tuple[IntArray, FloatArray, FloatArray]:
        """States, openings of the normal springs and shears (P,) at gaps g, tau under limits c (P,)."""
        model = self.model
        state = np.empty(model.n_points, dtype=np.int64)
        pressed, shear = np.empty_like(opening), np.empty_like(opening)
        frozen_forces(opening, trial, limit, model.kn, model.kt, model.psi, state, pressed, shear)
        return state, pressed, shear

    def _dissipated(self, moment: _Moment) -> FloatArray:
        """The limits c = (mu - psi) N (P,) that the compressions at a moment lead to."""
        _, pressed, _ = self._frozen(moment.opening, moment.trial, moment.limit)
        return self.model.law.dissipated(-self.model.kn * pressed)
