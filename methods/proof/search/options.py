"""Options of the search for a lower bound; docs/notes/lower-bound.md gives the evidence.

`ProofOptions` travels with the `Equations` of the wall."""

from __future__ import annotations

import time
from dataclasses import dataclass

CLOSED = 1e-6
"""Relative distance of bound and state at which a bracket is closed."""

PROVED = 2.001e-6
"""Relative distance of a certified bound at which the state is called the minimum: as near as trees come."""


NARROW = 4e-3
"""Relative width of a window below which a narrower one costs more than it gains."""


@dataclass(frozen=True)
class Steps:
    """Step sizes of the splitting for one cost: the first, and the least and the greatest that checks may come to.

    Where the step of the last window is not kept, the first is taken again: kept ones of the size were too large.
    """

    first: float
    least: float
    most: float
    kept: bool


@dataclass(frozen=True)
class Rounding:
    """What counts as rounding in dual matrices, in rows of the relaxation, in programmes and in certificates.

    Attributes:
        repairs: of a dual matrix; the second takes what the first left to rounding.
        tolerance: of linear programmes, and so what is zero beside them: the norm of an inequality that vanishes on its
            whole space, what is left in A Z B' (relative to the largest multiplier) of a dual matrix that proves
            something, and the error of a programme's value, in load units.
        margin: added to both sides of a bound from a linear programme, in mean block weights: a thousand times the
            tolerance.
        halvings: of the range of a normal force, to where it is divided.
    """

    repairs: int = 2
    tolerance: float = 1e-9
    margin: float = 1e-6
    halvings: int = 40


@dataclass(frozen=True)
class Precision:
    """Binary places of the numbers in the certificate of a window, which `Scales` carries.

    Attributes:
        velocities: of virtual velocities; forces: of virtual forces, and of
            what steps of cases prove; weights: of the size of mechanisms;
        motions: of the velocities that strains give; size: of multipliers of products that bound the size,
        the first with which it is at most `enough_size` times that of the search.
        multipliers: of those that bound the multiplier, at first and at most, with as many more as what is lost needs.
        refinements: of what the multipliers of products leave, before they are rounded.
    """

    velocities: int = 40
    forces: int = 54
    weights: int = 20
    motions: int = 30
    size: tuple[int, ...] = (20, 24, 28, 36)
    enough_size: float = 1.1
    multipliers: tuple[int, int] = (28, 54)
    refinements: int = 2


@dataclass(frozen=True)
class ProofOptions:
    """All options of one search.

    Attributes:
        size, multiplier: steps of the splitting for the size of mechanisms and for the multiplier.
        jobs: processes that work on the parts of divided states.
    """

    rounding: Rounding = Rounding()
    size: Steps = Steps(25.0, 2.5, 2.5e4, kept=False)
    multiplier: Steps = Steps(1e3, 1e2, 1e5, kept=True)
    jobs: int = 1

    def clock(self) -> float:
        """Seconds of CPU time, or of elapsed time where several processes share it."""
        return time.process_time() if self.jobs == 1 else time.perf_counter()
