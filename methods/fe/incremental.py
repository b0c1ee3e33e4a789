"""Ordinary incremental Newton, as users of general finite-element codes know it: `fe-newton`.

Load control with step cutting until Newton no longer converges; then displacement control, where the mean
displacement along the live load is prescribed and the multiplier is an unknown:
    [K  -live; live'  0] (du, dlambda) = (residual, prescribed - live'u).
It is the contrast to the exact continuation. "Newton did not converge" is not collapse, so a multiplier is reported
only when displacement control arrives at a mechanism whose state passes the check of an exact collapse state.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.springs.equilibrium import START, Equilibrium, newton
from methods.springs.factor import Factor, SingularTangent, make_factor
from methods.springs.path_record import PathRecord, Snapshot
from methods.springs.plateau import CollapseState, finish
from methods.springs.wall_model import WallModel, load_scale


@dataclass(frozen=True)
class IncrementalResult:
    """Where ordinary Newton got to.

    Attributes:
        load_control: largest multiplier at which load control converged; record: all converged points.
        state: the collapse state, or None; sentence: why it stopped; iterations: Newton iterations.
        unbounded: whether load control went on to any multiplier.
    """

    load_control: float
    record: PathRecord
    state: CollapseState | None
    sentence: str
    iterations: int
    unbounded: bool = False


def march(
    model: WallModel, factor: Factor, gravity: Equilibrium, first_step: float, cuts: int, displacement_steps: int
) -> IncrementalResult:
    """Load control from gravity, then displacement control.

    Args:
        first_step: first step of the multiplier; cuts: how many times a step is halved before load control stops;
        displacement_steps: steps of displacement control, each 1.3 times the one before.
    """
    record = PathRecord()
    u, multiplier, step, iterations, cut = gravity.u, 0.0, first_step, 0, 0
    state = gravity.state
    while cut <= cuts and multiplier < 1e6 * first_step:
        answer = newton(model, factor, u, multiplier + step, model.history, 25)
        iterations += answer.iterations
        if not answer.found:
            step *= 0.5
            cut += 1
            continue
        u, state, multiplier = answer.u, answer.state, multiplier + step
        record.add(multiplier, float(model.live @ u), 0, 0)
        if cut == 0:
            step *= 1.5
    reached = multiplier
    record.peak = reached
    if cut <= cuts:
        return IncrementalResult(reached, record, None, "load control went on to any multiplier", iterations, True)
    travelled = float(model.live @ (u - gravity.u))
    push = max(0.02 * abs(travelled), START)
    failures = 0
    for _ in range(displacement_steps):
        goal = float(model.live @ u) + push
        found, new_u, new_multiplier, new_state, count = _controlled(model, u, multiplier, state, goal)
        iterations += count
        if not found:
            push *= 0.25
            failures += 1
            if failures > 8:
                break
            continue
        flat = abs(new_multiplier - multiplier) <= 1e-8 * max(1.0, abs(multiplier))
        direction = new_u - u
        u, multiplier, state = new_u, new_multiplier, new_state
        record.add(multiplier, float(model.live @ u), 0, 0)
        record.peak = max(record.peak, multiplier)
        push *= 1.3
        if flat:
            collapse = _collapse(model, u, multiplier, state, direction)
            if collapse is not None:
                return IncrementalResult(
                    reached, record, collapse, "displacement control reached a plateau", iterations
                )
    sentence = (
        f"load control stopped at {reached:.6g} and displacement control at {multiplier:.6g}; "
        "that Newton did not converge there is no proof of collapse"
    )
    return IncrementalResult(reached, record, None, sentence, iterations)


def _controlled(
    model: WallModel, u: FloatArray, multiplier: float, state: IntArray, goal: float
) -> tuple[bool, FloatArray, float, IntArray, int]:
    """Newton at a prescribed work displacement live'u = goal; (found, u, multiplier, state, iterations)."""
    factor = make_factor(model)
    seen: set[bytes] = set()
    count = 0
    for _ in range(30):
        if state.tobytes() in seen:
            break
        seen.add(state.tobytes())
        try:
            factor.refactor(state, 1e-9)
            right = factor.solve(model.residual(u, multiplier, model.history, state))
            drive = factor.solve(model.live)
        except SingularTangent:
            break
        change = (goal - float(model.live @ (u + right))) / float(model.live @ drive)
        u = u + right + change * drive
        multiplier += change
        count += 1
        if not np.isfinite(u).all():
            break
        landed = model.states(u, model.history)
        residual = float(np.abs(model.residual(u, multiplier, model.history, landed)).max())
        if residual < 1e-9 * load_scale(model, multiplier):
            return True, u, multiplier, landed, count
        state = landed
    return False, u, multiplier, state, count


def _collapse(
    model: WallModel, u: FloatArray, multiplier: float, state: IntArray, direction: FloatArray
) -> CollapseState | None:
    """The collapse state of a wall that moves at constant multiplier, or None when it fails its check."""
    opening, slip = model.strains(u)
    velocity = direction / np.abs(direction).max()
    return finish(model, Snapshot(multiplier, opening, model.kt * slip + model.history, state, velocity))
