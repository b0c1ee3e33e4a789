"""Equilibrium at a given multiplier: Newton, then pseudo-transient steps when Newton cycles.

The law is piecewise linear, so Newton ends exactly when the states it lands in are those it started from. From the
virgin state it may cycle; a repeated set of states is recognised and handed to implicit pseudo-transient steps
(u' inertia = out-of-balance force, with the step grown as the motion settles).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.springs.factor import Factor, SingularTangent
from methods.springs.gap_law import TIED, same_forces
from methods.springs.wall_model import WallModel, load_scale

SETTLED = 1e-11
"""Out-of-balance force (share of the load scale) at which pseudo-transient steps have come to rest.

Newton then need not confirm it: in a statically determinate state the tangent is singular, and its step is noise.
"""
START = 1e-3
"""First Newton step off the kinks on which gravity leaves many gap points, as a multiplier."""
SHORTER = 0.1
"""How much shorter each further first step is, where the wall does not stand that one."""
MOST_SHORTER = 5
"""First steps tried after the longest one: a wall may collapse at a multiplier below it."""
MOST_STEPS = 400
"""Pseudo-transient steps from one equilibrium to another."""
MOST_STEPS_AT_FIRST = 3000
"""The same to the one under the dead load, which takes some 1,500 on walls of 900 irregular blocks."""
SLOWEST, FAR_OFF = 1e-12, 1e8
"""Share of the inertia, and displacement for each unknown, at which a wall that still moves falls."""
SPEEDS_UP = 0.25
"""Share of all work of the loads above which the step on which they did most shows a wall that falls, too.

Of one that falls each step does 1.4 to 4 times the work of the one before, while Newton converges.
"""
FURTHEST = 1e6
"""Multiplier beyond which nothing is doubled."""


@dataclass(frozen=True)
class Equilibrium:
    """A state of equilibrium, or the best that was reached.

    Attributes:
        found: whether equilibrium holds.
        u: (N,) displacements; state: (P,) states; residual: largest out-of-balance force, relative to the loads.
        rate: (N,) displacement of the pseudo-transient step on which the loads did most work when the wall moves
            without end; zeros when it is in equilibrium, or neither was seen.
        iterations: linear solves.
    """

    found: bool
    u: FloatArray
    state: IntArray
    residual: float
    rate: FloatArray
    iterations: int


def newton(
    model: WallModel, factor: Factor, u: FloatArray, multiplier: float, history: FloatArray, limit: int = 40
) -> Equilibrium:
    """Full Newton steps until the states repeat: found when they are those of the step itself, else a cycle."""
    virgin = not np.any(u)
    state = model.states(u, history, virgin)
    seen: set[bytes] = set()
    scale = load_scale(model, multiplier)
    iterations = 0
    while iterations < limit and state.tobytes() not in seen:
        seen.add(state.tobytes())
        try:
            factor.refactor(state)
            step = factor.solve(model.residual(u, multiplier, history, state))
        except SingularTangent:
            break
        if not np.isfinite(step).all() or np.abs(step).max() > 1e9 * scale:
            break
        u = u + step
        iterations += 1
        landed = model.states(u, history)
        if settled(model, u, history, state, landed, scale):
            residual = np.abs(model.residual(u, multiplier, history, state)).max() / scale
            return Equilibrium(bool(residual < 1e-8), u, state, float(residual), np.zeros_like(u), iterations)
        state = landed
    return Equilibrium(False, u, state, np.inf, np.zeros_like(u), iterations)


def settled(
    model: WallModel, u: FloatArray, history: FloatArray, state: IntArray, landed: IntArray, scale: float
) -> bool:
    """Whether the two sets of states give the same forces at u."""
    opening, slip = model.strains(u)
    return same_forces(opening, model.kt * slip + history, model.kn, model.mu, state, landed, TIED * scale)


def pseudo_transient(
    model: WallModel, factor: Factor, u: FloatArray, multiplier: float, history: FloatArray, limit: int
) -> Equilibrium:
    """Implicit steps sigma M (u - u_n) = loads - F(u), with sigma lowered as they converge, then plain Newton.

    A wall without equilibrium keeps moving, faster and faster: the step on which the loads do most work is then its
    velocity field. The last ones may be rounding. One that neither rests nor goes far off nor speeds up is undecided.
    """
    scale = load_scale(model, multiplier)
    furthest = FAR_OFF * scale * len(u)
    sigma, steps, iterations = 1.0, 0, 0
    loads = model.dead + multiplier * model.live
    rate, fall = np.zeros_like(u), np.zeros_like(u)
    state = model.states(u, history, not np.any(u))
    while steps < limit and sigma > SLOWEST and np.abs(u).max() <= furthest:
        trial, previous = u.copy(), state
        converged = False
        inner = 0
        while inner < 12:
            right = model.residual(trial, multiplier, history, previous) - sigma * model.inertia * (trial - u)
            try:
                factor.refactor(previous, sigma)
                trial = trial + factor.solve(right)
            except SingularTangent:
                break
            iterations += 1
            inner += 1
            landed = model.states(trial, history)
            if settled(model, trial, history, previous, landed, scale):
                converged = bool(np.isfinite(trial).all())
                break
            previous = landed
        if not converged:
            sigma *= 5.0
            if sigma > 1e8:
                break
            steps += 1
            continue
        rate, u, state = trial - u, trial, previous
        fall = max(fall, rate, key=loads.dot)
        steps += 1
        if np.abs(sigma * model.inertia * rate).max() < 1e-3 * scale or steps % 10 == 0:
            final = newton(model, factor, u, multiplier, history, 12)
            if final.found:
                return final
            residual = float(np.abs(model.residual(u, multiplier, history, state)).max()) / scale
            if residual < SETTLED:
                return Equilibrium(True, u, state, residual, np.zeros_like(u), iterations)
        sigma *= 0.25 if inner <= 4 else 0.7
    far_off = sigma <= SLOWEST or np.abs(u).max() > furthest
    falls = far_off or float(loads @ fall) > SPEEDS_UP * float(loads @ u)
    return Equilibrium(False, u, state, np.inf, fall if falls else np.zeros_like(u), iterations)


def equilibrium(
    model: WallModel, factor: Factor, u: FloatArray, multiplier: float, history: FloatArray, limit: int = MOST_STEPS
) -> Equilibrium:
    """Newton, then at most `limit` pseudo-transient steps from where Newton started."""
    answer = newton(model, factor, u, multiplier, history)
    if answer.found:
        return answer
    return pseudo_transient(model, factor, u, multiplier, history, limit)


def gravity_state(model: WallModel, factor: Factor) -> Equilibrium:
    """Equilibrium under the dead load from the virgin state."""
    return equilibrium(model, factor, np.zeros(model.n_unknowns), 0.0, model.history, MOST_STEPS_AT_FIRST)


def first_step(
    model: WallModel, factor: Factor, u: FloatArray, history: FloatArray, scale: float
) -> tuple[Equilibrium, float]:
    """Equilibrium a small step off the dead load, and its multiplier: the longest of a few that has one.

    Args:
        model: the wall; factor: its tangent; u: (N,) displacements under the dead load; history: (P,) h.
        scale: a multiplier of the order of collapse.
    """
    multiplier = START * min(1.0, scale)
    first = equilibrium(model, factor, u, multiplier, history)
    for _ in range(MOST_SHORTER):
        if first.found:
            break
        multiplier *= SHORTER
        first = equilibrium(model, factor, u, multiplier, history)
    return first, multiplier


def doubled(
    model: WallModel, factor: Factor, first: Equilibrium, multiplier: float, history: FloatArray
) -> Iterator[tuple[Equilibrium, float]]:
    """Equilibria at 2, 4, 8, ... times the multiplier of a first one, as far as Newton converges.

    Without commits the law has no history, so they lie on the path from the first.
    """
    while multiplier < FURTHEST:
        multiplier *= 2.0
        first = newton(model, factor, first.u, multiplier, history, 25)
        if not first.found:
            return
        yield first, multiplier
