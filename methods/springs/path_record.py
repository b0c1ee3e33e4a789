"""What is kept of an equilibrium path: its points, its limit points and why it ended."""

from __future__ import annotations

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
    TIME = "time"


@dataclass
class PathRecord:
    """Multiplier against live displacement, with the limit points passed."""

    multiplier: list[float] = field(default_factory=list)
    displacement: list[float] = field(default_factory=list)
    slipping: list[int] = field(default_factory=list)
    open: list[int] = field(default_factory=list)
    peak: float = -np.inf
    first_limit: float | None = None
    events: int = 0

    def add(self, multiplier: float, displacement: float, slipping: int, n_open: int) -> None:
        """Append one point of the path."""
        self.multiplier.append(multiplier)
        self.displacement.append(displacement)
        self.slipping.append(slipping)
        self.open.append(n_open)


@dataclass(frozen=True, eq=False)
class Snapshot:
    """A mechanism met on the path: multiplier, gaps g and tau (P,), states (P,) and velocity (N,)."""

    multiplier: float
    opening: FloatArray
    trial: FloatArray
    state: IntArray
    velocity: FloatArray
