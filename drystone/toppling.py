"""The least multiple of a motion of the ground that topples a wall, as a bracket.

Rocking is not monotone: a wall may fall under a motion and stand under a stronger one. So multiples are tried from one
that hardly moves the wall upwards by small steps, and only the first step at whose end it falls is bisected.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drystone.shaking import Shaker, Shaking
from drystone.walls import Wall, checked_wall
from harness.engine.pipeline import Runs
from harness.model.assembly import FloatArray
from harness.model.errors import InputError
from harness.model.ground_motion import GRAVITY, STRONGEST, GroundMotion
from harness.model.method import Finding

if TYPE_CHECKING:
    from methods.de.settings import TimeSteps

MOVED = 1e-2
"""Displacement of a block, in sizes of it, under which a motion hardly moves a wall."""
RATIO = 2.0 ** (1.0 / 8.0)
"""Of each multiple that is tried to the one before, on the way up to the first under which the wall falls."""
FEWEST = 2.0**-20
"""Least multiple that is tried."""


@dataclass(frozen=True, eq=False)
class LeastShaking:
    """The least multiple of a motion that was found to topple a wall.

    Attributes:
        stands: under the greatest multiple below it that was tried; None: there was none.
        falls: under the least multiple found; None: there was none.
        lower, upper: these multiples; zero and infinite where there is none.
        tried: (j, 2) all multiples in ascending order, and 1 where the wall fell, 0 where it stood, nan if undecided.
        reason: why no more were tried, where a run was ended by a limit; empty where none was.
    """

    stands: Shaking | None
    falls: Shaking | None
    lower: float
    upper: float
    tried: FloatArray
    reason: str = ""

    @property
    def accepted(self) -> bool:
        """Whether a bracket was found, nothing below it is undecided, and the judge accepts both ends."""
        ends = self.stands is not None and self.falls is not None and self.stands.accepted and self.falls.accepted
        return ends and not self.reason and not np.isnan(self.tried[self.tried[:, 0] < self.upper, 1]).any()

    @property
    def sentence(self) -> str:
        """What was found, and why no more where a run was ended."""
        return f"{self._found} {self.reason}".rstrip()

    @property
    def _found(self) -> str:
        below = self.tried[self.tried[:, 0] < self.upper]
        if self.falls is None:
            return f"No multiple up to {self.tried[-1, 0]:.6g} was found that topples the wall."
        said = f"The wall falls at {self.upper:.6g} times the motion, a peak of {self.falls.motion.peak:.6g} g"
        if self.stands is None:
            return f"{said}; none was found under which it stands."
        open_ones = int(np.isnan(below[:, 1]).sum())
        undecided = f" ({open_ones} more are undecided)" if open_ones else ""
        return (
            f"{said}, and stands at {self.lower:.6g}. It stands at all {len(below) - open_ones} multiples tried from "
            f"{below[0, 0]:.4g} up{undecided}, each at most {100.0 * (RATIO - 1.0):.0f} % above the last. Rocking is "
            "not monotone: in between it might fall earlier."
        )

    def as_json(self) -> dict[str, Any]:
        """JSON values; what is infinite or undecided is null."""
        ends = {"stands": self.stands, "falls": self.falls}
        return {
            "bracket": [self.lower, self.upper if math.isfinite(self.upper) else None],
            "sentence": self.sentence,
            "tried": [[multiple, None if math.isnan(fell) else bool(fell)] for multiple, fell in self.tried.tolist()],
            **{name: None if end is None else end.as_json() for name, end in ends.items()},
        }


def least_shaking(
    wall: Wall,
    motion: GroundMotion | str | Path,
    accuracy: float = 1e-3,
    *,
    gravity: float = GRAVITY,
    steps: TimeSteps | None = None,
    runs: Runs = Runs(),
) -> LeastShaking:
    """The least multiple of a motion that is found to topple a wall, as a bracket.

    Args:
        wall, motion, gravity, steps, runs: as of `drystone.shake`.
        accuracy: relative width of the bracket.

    Raises:
        InputError: as `drystone.shake`, or an accuracy out of range.
    """
    if not 1e-9 <= accuracy < 1.0:
        raise InputError(f"the accuracy {accuracy:g} is out of range", "Give one from 1e-9 to below 1", "accuracy")
    search, reason = _Multiples(Shaker(checked_wall(wall), motion, gravity, steps, runs)), ""
    try:
        search.climb(search.start())
        search.bisect(accuracy)
    except _CutOff as error:
        reason = str(error)
    fell = {Finding.FALLS: 1.0, Finding.STANDS: 0.0}
    tried = [[at, fell.get(search.results[at].finding, math.nan)] for at in sorted(search.results)]
    ends = search.results.get(search.lower), search.results.get(search.upper)
    return LeastShaking(*ends, search.lower, search.upper, np.array(tried), reason)


class _CutOff(Exception):
    """A run was ended by a limit: those that follow would be too."""


class _Multiples:
    """Multiples of one motion that were tried on one wall."""

    def __init__(self, shaker: Shaker) -> None:
        self.shaker = shaker
        self.results: dict[float, Shaking] = {}
        self.most = STRONGEST / shaker.motion.peak

    @property
    def upper(self) -> float:
        """The least multiple that topples the wall; infinite: none is known."""
        return min((at for at, found in self.results.items() if found.finding is Finding.FALLS), default=math.inf)

    @property
    def lower(self) -> float:
        """The greatest multiple below it under which the wall stands; zero: none is known."""
        stood = (at for at, found in self.results.items() if found.finding is Finding.STANDS and at < self.upper)
        return max(stood, default=0.0)

    def tried(self, multiple: float) -> Shaking:
        """The wall shaken by a multiple, kept."""
        if multiple not in self.results:
            self.results[multiple] = found = self.shaker.shaken(multiple)
            if found.reason:
                raise _CutOff(f"At {multiple:.6g} times the motion: {found.reason}")
        return self.results[multiple]

    def start(self) -> float:
        """A power of two that hardly moves the wall, or the least that is tried."""
        multiple = 1.0
        while self._hardly_moves(multiple) and 2.0 * multiple <= self.most:
            multiple *= 2.0
        while multiple > FEWEST and not self._hardly_moves(multiple):
            multiple *= 0.5
        return multiple

    def climb(self, multiple: float) -> None:
        """Raise the multiple in small steps until the wall falls, or the ground moves as strongly as is taken."""
        while multiple * RATIO < min(self.upper, self.most):
            multiple *= RATIO
            self.tried(multiple)

    def bisect(self, accuracy: float) -> None:
        """Halve the bracket until it is narrow enough or its middle is undecided."""
        while self.lower > 0.0 and self.lower * (1.0 + accuracy) < self.upper < math.inf:
            if self.tried(math.sqrt(self.lower * self.upper)).finding is Finding.NONE:
                return

    def _hardly_moves(self, multiple: float) -> bool:
        found = self.tried(multiple)
        return found.finding is Finding.STANDS and found.furthest[1] < MOVED * found.wall.assembly.length_scale
