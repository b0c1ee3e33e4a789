"""What is kept of an equilibrium path: its points, its limit points and why it ended."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from harness.model.assembly import FloatArray, IntArray


class PathEnd(StrEnum):
    """Why a stretch of path ended."""

    TARGET = "target"
    PLATEAU = "plateau"
    UNBOUNDED = "unbounded"
    RUNS_DOWN = "runs_down"
    TURNED_DOWN = "turned_down"
    EVENTS = "events"
    BREAKDOWN = "breakdown"
    BROKEN = "broken"
    TIME = "time"


@dataclass(frozen=True, eq=False)
class PathStep:
    """A point of the path: multiplier, displacements u (N,), gaps g and tau (P,) and states (P,)."""

    multiplier: float
    u: FloatArray
    opening: FloatArray
    trial: FloatArray
    state: IntArray


@dataclass
class PathRecord:
    """Multiplier against live displacement, with the limit points passed.

    Attributes:
        change: of every point the joint or bar that changes there, its state before and after; None where none does.
        steps: points kept whole, spread evenly over those met; most: up to twice as many are, 0: none.
    """

    multiplier: list[float] = field(default_factory=list)
    displacement: list[float] = field(default_factory=list)
    slipping: list[int] = field(default_factory=list)
    open: list[int] = field(default_factory=list)
    bars: list[list[float]] = field(default_factory=list)
    change: list[tuple[int, int, int] | None] = field(default_factory=list)
    peak: float = -np.inf
    first_limit: float | None = None
    events: int = 0
    most: int = 0
    steps: list[PathStep] = field(default_factory=list)
    _met: int = field(default=0, init=False)
    _every: int = field(default=1, init=False)

    def keep(self, step: Callable[[], PathStep], always: bool = False) -> None:
        """Keep a point whole if it is its turn, or `always`; where there are too many, every second one goes."""
        if self.most and (always or self._met % self._every == 0):
            self.steps.append(step())
            if len(self.steps) > 2 * self.most:
                del self.steps[1::2]
                self._every *= 2
        self._met += 1

    def add(
        self,
        multiplier: float,
        displacement: float,
        slipping: int,
        n_open: int,
        bars: Sequence[float] | FloatArray = (),
        change: tuple[int, int, int] | None = None,
    ) -> None:
        """Append one point of the path; `bars` are tensions (k,) beyond the prestress of ties and props [force]."""
        self.multiplier.append(multiplier)
        self.displacement.append(displacement)
        self.slipping.append(slipping)
        self.open.append(n_open)
        self.bars.append([float(tension) for tension in bars])
        self.change.append(change)


@dataclass(frozen=True, eq=False)
class PathSnapshot:
    """A mechanism met on the path: multiplier, gaps g and tau (P,), states (P,) and velocity (N,)."""

    multiplier: float
    opening: FloatArray
    trial: FloatArray
    state: IntArray
    velocity: FloatArray
