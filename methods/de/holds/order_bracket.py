"""Search of the multiplier of one insertion order: load steps up to a state that is not held, then bisection."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from harness.model.assembly import FloatArray
from methods.de.engines.engine import Engine
from methods.de.holds.load_step import LoadStep, State, hold, least_motion
from methods.de.holds.motion import MotionProof, StaticLimit
from methods.de.settings import HoldSettings

_WIDE = 5e-3
"""Relative width of [held, moving] above which undecided holds make the search look for a lower moving state."""
_ROUNDS = 4
"""Bisections at most, each above the highest multiplier held so far."""
_CHEAP = 1_000_000
"""Contact updates up to which a search keeps to the full accuracy."""
_GROWTH = 2.0
"""Factor on load steps after an undecided one."""
_PATIENCE = 4
"""Multiple of the length of a hold that the dead load has."""
_HALVED = 2.0
"""Residual of a motion, or live load as a part of the dead load, in residuals that show a motion, up to which half of
the multiplier would show none."""


CREEPING = 2e-3
"""Accuracy of a search that is no longer cheap: just under collapse a wall creeps, just above it moves slowly, and
narrower costs much."""
LOOSE = 0.01
"""Widest bracket, as a part of the multiplier, that still counts as converged: twice the accuracy that is stated, so
that its middle keeps it."""


@dataclass(eq=False)
class OrderBracket:
    """What one insertion order found.

    Attributes:
        order: name of the insertion order.
        held: highest multiplier held, or None if the wall is not held at zero.
        moving: lowest multiplier at which it moved, or None.
        undecided: multipliers of undecided load steps, none of them called held.
        state: contact state of the engine at `held`.
        moving_residual: of that motion; velocity: (n, 3) its field.
        moving_forces: (m, 3) contact forces of the motion under the dead load alone [force].
        proof: what shows that it moved there.
        nothing: whether none of the live load is held as far as residuals tell: half of `moving` would leave less out
            of balance than shows a motion. The multiplier is then zero.
        holds: number of holds.
        steps: time steps made.
        capped: whether the load cap was held.
        exhausted: whether the work ran out.
        trials: (multiplier, residual) of every hold in order.
    """

    order: str
    held: float | None = None
    moving: float | None = None
    undecided: list[float] = field(default_factory=list)
    state: FloatArray | None = None
    moving_residual: float = 0.0
    velocity: FloatArray | None = None
    moving_forces: FloatArray | None = None
    proof: MotionProof | None = None
    nothing: bool = False
    holds: int = 0
    steps: int = 0
    capped: bool = False
    exhausted: bool = False
    trials: list[tuple[float, float]] = field(default_factory=list)

    @property
    def path(self) -> dict[str, list[float]]:
        """Multipliers and residuals of the holds in order, as answers give them."""
        return {"multiplier": [t[0] for t in self.trials], "residual": [t[1] for t in self.trials]}

    @property
    def middle(self) -> float | None:
        """Middle of [held, moving]; zero where nothing is held."""
        if self.held is None or self.moving is None:
            return None
        if self.nothing:
            return 0.0
        return (self.held + self.moving) / 2.0

    @property
    def width(self) -> float | None:
        """(moving - held) / moving; zero where nothing is held."""
        if self.nothing:
            return 0.0
        if self.held is None or self.moving is None or self.moving <= 0.0:
            return None
        return (self.moving - self.held) / self.moving

    def shows(self, ask_multiplier: bool) -> bool:
        """Whether the search came to an end that says something."""
        if self.held is None:
            return self.moving is not None
        if not ask_multiplier or self.capped:
            return True
        return self.width is not None and self.width <= LOOSE


class BracketSearch:
    """The bracket of one insertion order, step by step.

    Args:
        engine: the wall in that order.
        settings: steps and tolerances.
        statics: the multipliers that statics bears on the wall.
        unit: multiplier at which the live load equals the dead load.
        order: name of the order.

    Attributes:
        states: multiplier and contact state of the engine of everything that was held, the highest last.
    """

    def __init__(
        self,
        engine: Engine,
        settings: HoldSettings,
        statics: StaticLimit,
        unit: float,
        order: str,
    ) -> None:
        self.engine = engine
        self.settings = settings
        self.statics = statics
        self.unit = unit
        self.found = OrderBracket(order)
        self.states: list[tuple[float, FloatArray]] = []

    def run(self, ask_multiplier: bool = True) -> OrderBracket:
        """Hold at zero, then, if asked, climb and bisect."""
        if self._try(0.0).state is State.HELD and ask_multiplier:
            self._climb()
            if not self.found.capped:
                self._narrow()
        return self.found

    def _spent(self) -> bool:
        self.found.exhausted = self.engine.steps * self.engine.interfaces >= self.settings.work
        return self.found.exhausted

    def _try(self, multiplier: float) -> LoadStep:
        """Hold at this multiplier from the highest held state, and note what came of it."""
        found = self.found
        if found.state is not None:
            self.engine.restore(found.state)
        self.engine.load(multiplier)
        patience = _PATIENCE if multiplier == 0.0 else 1
        end = hold(self.engine, self.settings, self.statics, patience)
        found.steps = self.engine.steps
        found.holds += 1
        found.trials.append((multiplier, end.residual))
        if end.state is State.HELD:
            found.held, found.state = multiplier, self.engine.save()
            self.states.append((multiplier, found.state))
        elif end.state is State.MOVING and (found.moving is None or multiplier < found.moving):
            found.moving, found.velocity, found.proof = multiplier, end.velocity, end.proof
            found.moving_residual = end.residual
            if multiplier == 0.0:
                found.moving_forces = self.engine.contact_forces()
        elif end.state is State.UNDECIDED:
            found.undecided.append(multiplier)
        return end

    def _climb(self) -> None:
        """Load steps until a state moves, or the cap is held; twice as large after each undecided one.

        So an upper end is shown before it is narrowed, and is the answer where the time is over.
        """
        cap = self.settings.load_cap * self.unit
        multiplier, growth = 0.0, 1.0
        while not self._spent() and multiplier < cap:
            step = max(self.settings.load_step * self.unit, self.settings.load_growth * multiplier)
            multiplier = min(multiplier + growth * step, cap)
            state = self._try(multiplier).state
            if state is State.MOVING:
                return
            if state is State.UNDECIDED:
                growth *= _GROWTH
            self.found.capped = state is State.HELD and multiplier >= cap

    def _narrow(self) -> None:
        """Bisect until the bracket is not loose: again above what turned out to be held beyond an undecided hold."""
        for _ in range(_ROUNDS):
            held = self.found.held
            self._bisect()
            if self._spent() or self.found.shows(True) or self.found.held == held:
                return

    def _bisect(self) -> None:
        """Narrow [held, lowest not held] to the accuracy; then settle an undecided hold in between, if any."""
        found = self.found
        if found.held is None:
            return
        top = [m for m in (found.moving, *found.undecided) if m is not None and m > found.held]
        if not top:
            return
        high = min(top)
        moves = found.moving == high
        while not self._spent():
            cheap = self.engine.steps * self.engine.interfaces < _CHEAP
            accuracy = self.settings.accuracy if cheap else max(self.settings.accuracy, CREEPING)
            left = min(found.moving_residual, high / self.unit)
            vanishing = left <= _HALVED * least_motion(self.settings)
            found.nothing = found.held == 0.0 and moves and vanishing
            if found.nothing:
                return
            if high - found.held <= accuracy * high:
                break
            middle = (found.held + high) / 2.0
            state = self._try(middle).state
            if state is not State.HELD:
                high, moves = middle, state is State.MOVING
        if found.moving is None or found.moving - found.held > _WIDE * found.moving:
            self._raise_upper_end(high)

    def _raise_upper_end(self, high: float) -> None:
        """The lowest state not held was undecided: find the lowest state above it that moves, by growing steps.

        None is asked below an undecided multiplier either.
        """
        found = self.found
        step = CREEPING * high
        multiplier = high + step
        while not self._spent() and multiplier <= self.settings.load_cap * self.unit:
            if found.moving is not None and multiplier >= found.moving:
                return
            doubtful = any(multiplier <= m < (found.moving or np.inf) for m in found.undecided)
            if not doubtful and self._try(multiplier).state is State.MOVING:
                return
            step *= _GROWTH
            multiplier += step
