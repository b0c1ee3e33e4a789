"""Equilibrium at a given multiplier by full Newton steps: C' r(C u; h) + f0 + lambda fL = 0 with the law of `gap_law`.

    K(u) du = f0 + lambda fL + C' r(C u; h)

The law is piecewise linear, so Newton ends exactly when the resulting states are those it started from. From the
unloaded state it may cycle, which a repeated set of states shows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.springs.model.factor import Factor, SingularTangent, refactor_any
from methods.springs.model.gap_law import same_forces
from methods.springs.model.wall_model import WallModel, load_scale

_STEPS = 40
"""Of Newton, at most."""
_RUNAWAY = 1e9
"""Step, in dimensionless displacements over the load scale, after which none is to be expected."""


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A state of equilibrium, or the best that was reached.

    Attributes:
        found: whether equilibrium holds.
        multiplier: of the live load; u: (N,) displacements; history: (P,) frozen-in shears h; state: (P,) states.
        residual: largest out-of-balance force, relative to the loads.
        rate: (N,) displacement of the last increment of pseudo-transient relaxation when the wall moves steadily; zeros
            when it is in equilibrium, or neither was seen.
        iterations: linear solves.
    """

    found: bool
    multiplier: float
    u: FloatArray
    history: FloatArray
    state: IntArray
    residual: float
    rate: FloatArray
    iterations: int


def newton(
    model: WallModel, factor: Factor, u: FloatArray, multiplier: float, history: FloatArray, limit: int | None = None
) -> Equilibrium:
    """Full Newton steps until the states repeat: found when they are those of the step itself, else a cycle.

    Args:
        model: the wall; factor: its tangent.
        u: (N,) where the steps begin; multiplier: of the live load; history: (P,) frozen-in shears h.
        limit: on the steps; None for that of the options.
    """
    options = model.options.newton
    limit = _STEPS if limit is None else limit
    virgin = not np.any(u)
    state = model.states(u, history, virgin)
    seen: set[bytes] = set()
    scale = load_scale(model, multiplier)
    iterations = 0
    while iterations < limit and state.tobytes() not in seen:
        model.deadline.ask()
        seen.add(state.tobytes())
        try:
            refactor_any(factor, state)
            step = factor.solve(model.residual(u, multiplier, history, state))
        except SingularTangent:
            break
        if not np.isfinite(step).all() or np.abs(step).max() > _RUNAWAY * scale:
            break
        u = u + step
        iterations += 1
        landed = model.states(u, history)
        if settled(model, u, history, state, landed, scale):
            residual = float(np.abs(model.residual(u, multiplier, history, state)).max() / scale)
            found = residual < options.balanced
            return Equilibrium(found, multiplier, u, history, state, residual, np.zeros_like(u), iterations)
        state = landed
    return Equilibrium(False, multiplier, u, history, state, np.inf, np.zeros_like(u), iterations)


def settled(
    model: WallModel, u: FloatArray, history: FloatArray, state: IntArray, landed: IntArray, scale: float
) -> bool:
    """Whether the two sets of states give the same forces at u."""
    opening, slip = model.strains(u)
    trial, near = model.kt * slip + history, model.options.breakpoints.force * scale
    return same_forces(opening, trial, model.kn, model.mu, model.lift, state, landed, near)
