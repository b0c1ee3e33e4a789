"""Options of the search for a lower bound; docs/notes/lower-bound.md gives the evidence.

`ProofOptions` travels with the `Equations` of the wall."""

from __future__ import annotations

from dataclasses import dataclass

CLOSED = 1e-6
"""Relative distance of bound and state at which a bracket is closed."""

PROVED = 2.001e-6
"""Relative distance of a certified bound at which the state is called the minimum: as near as trees come."""


@dataclass(frozen=True)
class Windows:
    """How windows on the multiplier follow each other.

    Attributes:
        narrow: relative width of a window below which a narrower one costs more than it gains.
        gain: part of the bracket that one window must gain before the next is built, and the last half of its time to
            go on with it.
        size: bound of the size of mechanisms, in that which its relaxation comes to, that is good enough.
        above: relative distance of the window's upper end above the state, so that rounding does not cut it off.
        below: part of the bracket that a certificate may lose to rounding before it takes more digits.
        finished: relative distance at which a window ends: less than `CLOSED`, because a certificate loses some.
        patience: iterations in which the bracket is to lose `gain` of itself; else its states are divided.
        worth: part of the bracket that a window must gain for the next not to be of a half of its states.
        inside: part of the range of a normal force that either half of a division has at least, so that none is divided
            next to the end of its range.
        share: of its iterations that a window may spend so.
        least_weight: of a rate in the size of mechanisms, the greatest price being one. A smaller one loses less to the
            price, but the size may then be unbounded.
        newest_weight: share of the weights that the last check has, since prices change from one to the next.
    """

    narrow: float = 4e-3
    gain: float = 0.3
    size: float = 2.5
    above: float = 1e-9
    below: float = 1e-2
    finished: float = 5e-7
    patience: int = 12_000
    worth: float = 0.1
    inside: float = 0.1
    share: float = 0.5
    least_weight: float = 0.3
    newest_weight: float = 0.25


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
class Restarts:
    """When the splitting is checked and restarted, and how its step changes.

    Attributes:
        checked_every, checked_later: iterations between two safe bounds, and as a share of those made; a safe bound may
            cost hundreds of iterations.
        sufficient, necessary: a restart where the residual fell to the first of these shares, or to the second and
            rises.
        long, patience: or where the round is longer than this share of the run and so many iterations.
        step_change: factor by which a check changes the step at most; step_kept: below which it leaves the step. A
            larger change may let the step diverge.
        tiny: losses and distances below this, relative and absolute, are rounding.
        rounding: units of rounding of the iterate's norm below which a residual in single precision says nothing more.
    """

    checked_every: int = 200
    checked_later: float = 0.1
    sufficient: float = 0.2
    necessary: float = 0.8
    long: float = 0.36
    patience: int = 200
    step_change: float = 2.0
    step_kept: float = 1.2
    tiny: float = 1e-9
    rounding: float = 16.0


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
    """

    windows: Windows = Windows()
    restarts: Restarts = Restarts()
    rounding: Rounding = Rounding()
    size: Steps = Steps(25.0, 2.5, 2.5e4, kept=False)
    multiplier: Steps = Steps(1e3, 1e2, 1e5, kept=True)
