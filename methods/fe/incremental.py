"""Ordinary incremental Newton, as users of general finite-element codes know it: `fe-newton`.

Load control with step cutting until Newton no longer converges; then displacement control, where the displacement c'u
of the block that has moved farthest is prescribed and the multiplier is an unknown:
    [K  -live; c'  0] (du, dlambda) = (residual, prescribed - c'u).
Where the states of the gaps come round in a cycle, shorter steps are taken. It is the contrast to the exact
continuation. "Newton did not converge" is not collapse, so a multiplier is reported only when displacement control
arrives at a mechanism whose state passes the check of an exact collapse state.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.springs.model.factor import Factor, SingularTangent
from methods.springs.model.wall_model import WallModel, load_scale
from methods.springs.path.path_record import PathRecord, PathSnapshot
from methods.springs.path.plateau import PlateauState, finish
from methods.springs.rest.newton import Equilibrium, newton, settled

_LOAD_ITERATIONS = 25
"""Newton iterations of a step of the multiplier, at most."""
_LOAD_LONGER = 1.5
"""Factor on that step after one that converged, before the first that did not."""
_LOAD_SHORTER = 0.5
"""Factor on it after each that did not converge."""
_FURTHEST = 1e6
"""First steps after which the load is taken to go on to any multiplier."""
_FIRST = 0.02
"""Step of a prescribed displacement, as a share of the way under load control."""
_LEAST = 1e-6
"""Of these steps, as a share of that."""
_LONGER = 1.5
"""Factor on the step after one that converged."""
_SHORTER = 0.25
"""Factor on it after one that did not."""
_BLOCKS = 6
"""Whose displacement is controlled, one after the other, where no step however short converges."""
_ITERATIONS = 60
"""Newton iterations of such a step, at most."""
_DAMPED = 0.05
"""Least share of a Newton step that is taken where states come round in a cycle; each repetition halves the share."""
_FLAT = 1e-8
"""Change of the multiplier in a step, relative to it, up to which the wall moves at a constant one."""


@dataclass(frozen=True)
class IncrementalResult:
    """Where ordinary Newton got to.

    Attributes:
        load_control: largest multiplier at which load control converged; record: all converged points.
        state: the collapse state, or None; sentence: why it stopped; iterations: Newton iterations.
        unbounded: whether load control continued to any multiplier.
    """

    load_control: float
    record: PathRecord
    state: PlateauState | None
    sentence: str
    iterations: int
    unbounded: bool = False


@dataclass(frozen=True)
class _StepPoint:
    """Displacements u (N,), the multiplier and the states (P,) of the gaps in equilibrium."""

    u: FloatArray
    multiplier: float
    state: IntArray


def march(
    model: WallModel,
    factor: Factor,
    gravity: Equilibrium,
    first_step: float,
    cuts: int,
    displacement_steps: int,
) -> IncrementalResult:
    """Load control from gravity, then displacement control.

    Args:
        first_step: first step of the multiplier; cuts: how many times a step is halved before load control stops;
        displacement_steps: steps of displacement control, each 1.5 times the last that converged.
    """
    record = PathRecord()
    point, step, iterations, cut = _StepPoint(gravity.u, 0.0, gravity.state), first_step, 0, 0
    while cut <= cuts and point.multiplier < _FURTHEST * first_step:
        answer = newton(model, factor, point.u, point.multiplier + step, model.history, _LOAD_ITERATIONS)
        iterations += answer.iterations
        if not answer.found:
            step *= _LOAD_SHORTER
            cut += 1
            continue
        point = _StepPoint(answer.u, point.multiplier + step, answer.state)
        _note(record, model, point)
        if cut == 0:
            step *= _LOAD_LONGER
    reached = point.multiplier
    record.peak = reached
    if cut <= cuts:
        return IncrementalResult(reached, record, None, "load control continued to any multiplier", iterations, True)
    travel = point.u - gravity.u
    if not np.any(travel):
        with suppress(SingularTangent):
            factor.refactor(point.state, regularised=True)
            travel = step * factor.solve(model.live)
    state, end, spent = _displacement_control(model, factor, point, travel, displacement_steps, record)
    sentence = f"displacement control reached a plateau, where load control stopped at {reached:.6g}"
    if state is None:
        sentence = (
            f"load control stopped at {reached:.6g} and displacement control at {end:.6g}; "
            "failure of Newton's method to converge is no proof of collapse"
        )
    return IncrementalResult(reached, record, state, sentence, iterations + spent)


def _displacement_control(
    model: WallModel,
    factor: Factor,
    point: _StepPoint,
    travel: FloatArray,
    steps: int,
    record: PathRecord,
) -> tuple[PlateauState | None, float, int]:
    """The collapse state that displacement control leads to, or None; the last multiplier; Newton iterations.

    Args:
        point: where load control stopped; travel: (N,) how far the wall has moved under the live load.
        steps: at most; record: gets the points that converge.
    """
    origin, iterations, controls = point.u - travel, 0, _BLOCKS
    direction = travel
    control = _farthest(direction)
    push = first = _FIRST * float(control @ direction)
    for _ in range(steps if first > 0.0 else 0):
        moved, spent = _controlled(model, factor, point, control, float(control @ point.u) + push)
        iterations += spent
        if moved is None:
            push *= _SHORTER
            if push < _LEAST * first:
                other = _farthest(direction)
                controls -= 1
                if controls == 0 or np.array_equal(other, control):
                    break
                control = other
                push = first = _FIRST * abs(float(control @ (point.u - origin)))
            continue
        flat = abs(moved.multiplier - point.multiplier) <= _FLAT * max(1.0, abs(point.multiplier))
        direction, point = moved.u - point.u, moved
        _note(record, model, point)
        record.peak = max(record.peak, point.multiplier)
        push *= _LONGER
        collapse = _collapse(model, point, direction) if flat else None
        if collapse is not None:
            return collapse, point.multiplier, iterations
    return None, point.multiplier, iterations


def _note(record: PathRecord, model: WallModel, point: _StepPoint) -> None:
    """Add a point in equilibrium to the record."""
    trial = model.kt * model.strains(point.u)[1] + model.history
    record.add(point.multiplier, float(model.live @ point.u), 0, 0, model.bar_tensions(trial))


def _farthest(motion: FloatArray) -> FloatArray:
    """Unit vector (N,) along the displacement of the block that moves farthest in a motion (N,)."""
    places = motion.reshape(-1, 3)[:, :2]
    block = int(np.argmax(np.hypot(places[:, 0], places[:, 1])))
    control = np.zeros_like(motion)
    control[3 * block : 3 * block + 2] = places[block] / (np.hypot(*places[block]) or 1.0)
    return control


def _controlled(
    model: WallModel, factor: Factor, point: _StepPoint, control: FloatArray, goal: float
) -> tuple[_StepPoint | None, int]:
    """Equilibrium at a prescribed displacement control'u = goal, None where Newton finds none; and its iterations."""
    u, multiplier, state = point.u, point.multiplier, point.state
    scale, share = load_scale(model, multiplier), 1.0
    seen: set[bytes] = set()
    for count in range(_ITERATIONS):
        model.deadline.ask()
        if state.tobytes() in seen:
            share = max(0.5 * share, _DAMPED)
        seen.add(state.tobytes())
        try:
            factor.refactor(state, regularised=True)
            right = factor.solve(model.residual(u, multiplier, model.history, state))
            drive = factor.solve(model.live)
        except SingularTangent:
            return None, count
        rise = (goal - float(control @ (u + right))) / (float(control @ drive) or np.inf)
        step = right + rise * drive
        if not np.isfinite(step).all():
            return None, count
        landed = model.states(u + step, model.history)
        if settled(model, u + step, model.history, state, landed, scale):
            u, multiplier = u + step, multiplier + rise
            if (
                np.abs(model.residual(u, multiplier, model.history, state)).max()
                < model.options.newton.balanced * scale
            ):
                return _StepPoint(u, multiplier, state), count + 1
            continue
        u, multiplier = u + share * step, multiplier + share * rise
        state = landed if share == 1.0 else model.states(u, model.history)
    return None, _ITERATIONS


def _collapse(model: WallModel, point: _StepPoint, direction: FloatArray) -> PlateauState | None:
    """The collapse state of a wall that moves at constant multiplier, or None when it fails its check."""
    opening, slip = model.strains(point.u)
    velocity = direction / np.abs(direction).max()
    return finish(
        model, PathSnapshot(point.multiplier, opening, model.kt * slip + model.history, point.state, velocity)
    )
