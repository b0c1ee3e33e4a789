"""One damped load step: keep the load, let the wall settle, and judge whether it is held, moves, or is undecided."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from harness.model.assembly import FloatArray
from harness.model.deadline import Deadline
from methods.de.engines.engine import Engine, MeasuredState, motion_units
from methods.de.holds.motion import HeldMotion, MotionProof, StaticLimit, Trend, by_power, by_virtual_work
from methods.de.settings import HoldSettings

_SMALL = 0.01
"""Live load, as a part of the dead load, below which residuals are given as shares of it: .0001 and .002 in `de`."""


class State(StrEnum):
    """What a hold showed."""

    HELD = "held"
    MOVING = "moving"
    UNDECIDED = "undecided"


@dataclass(frozen=True, eq=False)
class LoadStep:
    """The end of a hold.

    Attributes:
        state: held, moving or undecided.
        residual: largest out-of-balance force at the end, as a part of the mean dead load of a block.
        steps: time steps made.
        velocity: (n, 3) velocity field at the end [length, length, radian], its mean if unsteady, as `Engine.velocity`.
        proof: what shows that it moves; None unless it does.
    """

    state: State
    residual: float
    steps: int
    velocity: FloatArray
    proof: MotionProof | None = None


@dataclass(eq=False)
class ConvergenceMonitor:
    """What a hold shows from check to check.

    Attributes:
        held, moving: residuals below which a wall rests, and from which it may move.
        units: (3,) by which velocities are divided to be compared (`motion_units`).
        velocities: (n, 3) velocity fields without dimension.
        residuals: largest forces out of balance, as parts of the mean dead load of a block.
        trend: when a motion counts as one that goes on.
    """

    held: float
    moving: float
    units: FloatArray
    trend: Trend = field(default_factory=Trend)
    velocities: list[FloatArray] = field(default_factory=list)
    residuals: list[float] = field(default_factory=list)

    def note(self, velocity: FloatArray, residual: float) -> None:
        """Add a check: velocities (n, 3) [length, length, radian] and the residual that goes with them."""
        self.velocities.append(velocity / self.units)
        self.residuals.append(residual)

    @property
    def rests(self) -> bool:
        """Whether the residual was small enough at the last two checks and did not grow: creep begins so.

        Growth below a hundredth of what is small enough is rounding.
        """
        if len(self.residuals) < 2:
            return False
        before, last = self.residuals[-2:]
        return max(before, last) < self.held and last <= max(before, 0.01 * self.held)

    @property
    def steady(self) -> bool:
        """Whether the field has hardly changed over the last few checks, for the first time after as many others."""
        count = self.trend.checks
        if len(self.velocities) <= count or len(self.velocities) % count:
            return False
        last = self.velocities[-1]
        change = max(float(np.abs(before - last).max(initial=0.0)) for before in self.velocities[-count - 1 : -1])
        return change <= self.trend.steady * count * float(np.abs(last).max(initial=0.0))

    @property
    def doubled(self) -> bool:
        """Whether there are as many checks as a power of two, from 16 on."""
        count = len(self.residuals)
        return count >= 16 and count & (count - 1) == 0

    @property
    def quarters(self) -> list[FloatArray]:
        """Mean fields of the second, third and last quarter."""
        part = len(self.velocities) // 4
        return [np.mean(self.velocities[-k * part : len(self.velocities) - (k - 1) * part], axis=0) for k in (3, 2, 1)]

    @property
    def decay(self) -> float:
        """Rate at which the residual falls towards rest, in logarithms a check; 0 where it does not do so evenly.

        That is the slowest relaxation of the wall itself: contacts pass their forces on from block to block, and a
        long chain of blocks takes many relaxation times of the damping for it.
        """
        part = len(self.residuals) // 4
        if part < 2:
            return 0.0
        old, middle, new = (float(np.log(np.mean(self.residuals[-k * part :][:part]))) for k in (3, 2, 1))
        return (middle - new) / part if 0.5 * (old - middle) <= middle - new and middle > new else 0.0

    def over(self, usual: float, affordable: float, relaxations: float) -> bool:
        """Whether the time of a hold is over.

        Args:
            usual: checks that a hold has.
            affordable: checks that it has at most, on its way to rest.
            relaxations: relaxation times of the wall for which it is then followed.
        """
        count = len(self.residuals)
        if count < usual or count >= affordable:
            return count >= usual
        return not 0.0 < count * self.decay < relaxations

    def motion(self, engine: MeasuredState, statics: StaticLimit) -> HeldMotion | None:
        """The motion, where it is shown that the wall moves; else None. Virtual work is asked where statics fails."""
        if len(self.velocities) < 8 or self.residuals[-1] <= self.moving:
            return None
        wall, load = engine.assembly, engine.assembly.dead + engine.multiplier * engine.assembly.live
        quarters = self.quarters
        last = (self.velocities[-1] if self.steady else quarters[-1]) * self.units
        motion = None if statics.bears(engine.multiplier) else by_virtual_work(wall, load, last)
        if motion is None and self.trend.goes_on(quarters):
            motion = by_power(wall, load, last, engine.contact_forces())
        return motion


def hold(engine: Engine, settings: HoldSettings, statics: StaticLimit, patience: int = 1) -> LoadStep:
    """Let the engine settle under its present load.

    Held: the residual stays below `held_residual` at two checks in a row. Moving: `motion.py` shows it; this
    is asked where the field is steady, at each doubling of the checks, and at the end. Undecided: neither, when
    `hold_steps` relaxation times are over. That is the time of the damping, or of the wall on its way to rest where
    that is longer (`ConvergenceMonitor.decay`).

    Args:
        engine: the wall with its load.
        settings: tolerances.
        statics: the multipliers that statics bears on the wall.
        patience: factor on the longest time.
    """
    check = max(10, round(engine.relaxation / 3.0))
    usual = patience * hold_limit(engine, settings) / check
    units = motion_units(engine.assembly)
    start, watch = engine.steps, ConvergenceMonitor(*reported_residuals(engine, settings), units)
    affordable = (watch.trend.followed * settings.work / max(engine.interfaces, 1) - engine.steps) / check
    deadline = Deadline.of_run()
    while True:
        deadline.ask()
        engine.advance(check)
        velocity = engine.velocity()
        watch.note(velocity, engine.unbalance(velocity))
        residual = watch.residuals[-1]
        if watch.rests:
            return LoadStep(State.HELD, residual, engine.steps - start, velocity)
        over = watch.over(usual, affordable, patience * settings.hold_steps)
        if over or watch.steady or watch.doubled:
            motion = watch.motion(engine, statics)
            if motion is not None:
                return LoadStep(State.MOVING, residual, engine.steps - start, motion.field, motion.proof)
        if over or not np.isfinite(residual):
            return LoadStep(State.UNDECIDED, residual, engine.steps - start, velocity)


def reported_residuals(engine: MeasuredState, settings: HoldSettings) -> tuple[float, float]:
    """Residuals below which a wall rests under its present load, and from which it may move.

    What a multiplier too high by a share leaves out of balance is that share of the live load. Where that is a small
    part of the dead load both are less. Fixed parts of the dead load would make brackets of small multipliers too wide.
    """
    live = abs(engine.multiplier) / engine.assembly.load_unit
    if live == 0.0:
        return settings.held_residual, 2.0 * settings.held_residual
    share, least = min(1.0, live / _SMALL), least_motion(settings)
    return max(share * settings.held_residual, 0.5 * least), max(share * settings.moving_residual, least)


def least_motion(settings: HoldSettings) -> float:
    """The least residual that tells a motion: what contact forces are followed to leaves at most a quarter of it."""
    return 4.0 * settings.force_residual


def hold_limit(engine: Engine, settings: HoldSettings) -> int:
    """Most time steps of one hold that does not come nearer to rest."""
    return int(settings.hold_steps * max(engine.relaxation, 3.0 * engine.courses, 100.0))


def settle(engine: Engine, settings: HoldSettings) -> float:
    """Follow a held state until its residual is below `force_residual` or no longer falls; its last residual.

    It no longer falls where six looks, two relaxation times, bring less than a tenth.
    """
    check = max(10, round(engine.relaxation / 3.0))
    best = residual = engine.unbalance(engine.velocity())
    stale = 0
    deadline = Deadline.of_run()
    for _ in range(3 * settings.hold_steps):
        deadline.ask()
        if residual < settings.force_residual or stale == 6:
            break
        engine.advance(check)
        residual = engine.unbalance(engine.velocity())
        stale += 1
        if residual < 0.9 * best:
            best, stale = residual, 0
    return residual
