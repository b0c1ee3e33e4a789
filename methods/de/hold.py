"""One damped hold: keep the load, let the wall settle, and judge whether it is held, moves, or cannot be told."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from harness.model.assembly import FloatArray
from methods.de.engine import Engine
from methods.de.settings import HoldSettings

RUNAWAY = 1e4
"""Out-of-balance acceleration, as a part of gravity, that no hold comes back from (masses are scaled: hence large)."""

STEADY = 0.003
"""Largest relative change of the velocity field from one check to the next that counts as steady."""

STEADY_CHECKS = 4
"""Checks in a row that must find a steady velocity field, or a residual small enough to hold (two of them)."""

ALIKE, UNSLOWED = 0.9, 0.9
"""Least cosine between the mean velocity fields of two quarters of a hold, and least ratio of the speeds along the
first, of an unsteady motion that goes on."""


class State(StrEnum):
    """What a hold showed."""

    HELD = "held"
    MOVING = "moving"
    UNDECIDED = "undecided"


@dataclass(frozen=True, eq=False)
class Hold:
    """The end of a hold.

    Attributes:
        state: held, moving or undecided.
        residual: largest out-of-balance force at the end, as a part of the mean dead load of a block.
        steps: time steps made.
        velocity: (n, 3) velocity field at the end, its mean if unsteady, scaled as `Engine.velocity`.
    """

    state: State
    residual: float
    steps: int
    velocity: FloatArray


def hold(engine: Engine, settings: HoldSettings, limit: int | None = None) -> Hold:
    """Let the engine settle under its present load.

    Held: the residual stays below `held_residual` at two checks in a row. Moving: the velocity field is steady over
    four checks above `moving_residual`; at the end of the hold an unsteady motion that goes on counts too (`lasting`).
    Undecided: anything else when `hold_steps` relaxation times are over.

    Args:
        engine: the wall with its load.
        settings: tolerances.
        limit: most time steps, or None for `hold_limit`.
    """
    check = max(10, round(engine.relaxation / 3.0))
    limit = hold_limit(engine, settings) if limit is None else limit
    start = engine.steps
    velocity = engine.velocity()
    velocities: list[FloatArray] = []
    residuals: list[float] = []
    surpluses: list[float] = []
    low = steady = 0
    while engine.steps - start < limit:
        engine.advance(check)
        before, velocity = velocity, engine.velocity()
        residual = engine.unbalance(velocity)
        velocities.append(velocity)
        residuals.append(residual)
        surpluses.append(engine.surplus(velocity))
        low = low + 1 if residual < settings.held_residual else 0
        if low == 2:
            return Hold(State.HELD, residual, engine.steps - start, velocity)
        change = float(np.abs(velocity - before).max(initial=0.0)) / max(
            float(np.abs(velocity).max(initial=0.0)), 1e-300
        )
        still = residual > settings.moving_residual and change <= STEADY
        steady = steady + 1 if still else 0
        if steady == STEADY_CHECKS or residual > RUNAWAY or not np.isfinite(residual):
            return Hold(State.MOVING, residual, engine.steps - start, velocity)
    motion = lasting(velocities, residuals, surpluses, settings)
    state, velocity = (State.UNDECIDED, velocity) if motion is None else (State.MOVING, motion)
    return Hold(state, residuals[-1] if residuals else float("inf"), engine.steps - start, velocity)


def hold_limit(engine: Engine, settings: HoldSettings) -> int:
    """Most time steps of one hold."""
    return int(settings.hold_steps * max(engine.relaxation, 3.0 * engine.courses, 100.0))


def lasting(
    velocities: list[FloatArray], residuals: list[float], surpluses: list[float], settings: HoldSettings
) -> FloatArray | None:
    """The mean velocity field (n, 3) of an unsteady motion that goes on, None where there is none.

    Such a motion is large, and in the last quarter of the hold it is that of the third. Contacts that chatter make
    every single velocity field another one; their means over a quarter of the hold tell a wall that moves along one
    mechanism at one speed from one that shakes where it stands. What drives it are the loads (`Engine.surplus`).
    """
    half, n = len(residuals) // 2, len(residuals)
    if n < 16 or min(residuals[half:]) <= 50.0 * settings.moving_residual or np.mean(surpluses[half:]) < 0.0:
        return None
    third = np.mean(velocities[half : 3 * n // 4], axis=0)
    last: FloatArray = np.mean(velocities[3 * n // 4 :], axis=0)
    return last if goes_on(third, last) else None


def goes_on(third: FloatArray, last: FloatArray, speed: float = UNSLOWED) -> bool:
    """Whether a motion goes on: in the last quarter of a hold along that of the third, at `speed` times its speed."""
    common, size = float(np.sum(third * last)), float(np.linalg.norm(third))
    return common >= ALIKE * size * float(np.linalg.norm(last)) and common >= speed * size**2


def settle(engine: Engine, settings: HoldSettings) -> float:
    """Follow a held state until its residual is below `force_residual` or no longer falls; its last residual."""
    check = max(10, round(engine.relaxation / 3.0))
    best = residual = engine.unbalance(engine.velocity())
    stale = 0
    for _ in range(3 * settings.hold_steps):
        if residual < settings.force_residual or stale == 6:
            break
        engine.advance(check)
        residual = engine.unbalance(engine.velocity())
        stale = 0 if residual < 0.9 * best else stale + 1
        best = min(best, residual)
    return residual
