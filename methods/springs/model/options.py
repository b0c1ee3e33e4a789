"""Options of the gap-spring model and of its solvers. A `WallModel` carries them to all that is done with it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class BreakpointTolerances:
    """When a gap point sits on its breakpoint, and when it moves towards it.

    Attributes:
        force: forces, as a share of the load scale, that count as the same: a point that near its breakpoint may be in
            either state, and the choice among near ties may overrun a breakpoint by as much. Compressions that a
            path starts from are at least as large, in block weights.
        broken: slack, as a share of the load scale, up to which a brittle joint is at its strength: rounding of a path
            is less, and the judge accepts ten times as much.
    """

    force: float = 1e-12
    broken: float = 1e-9


@dataclass(frozen=True)
class NewtonTolerances:
    """When Newton's steps are at an end.

    Attributes:
        balanced: out-of-balance force, as a share of the load scale, of an equilibrium.
        falling: share of the fastest block's motion above which another falls with it; the others may still settle by
            less.
    """

    balanced: float = 1e-8
    falling: float = 1e-3


@dataclass(frozen=True)
class FirstSteps:
    """The Newton steps off the breakpoints on which gravity leaves many gap points.

    Attributes:
        shorter: factor on the first multiplier where the wall does not stand it; tries: how often, at most: a wall may
            collapse at a multiplier below it.
    """

    shorter: float = 0.1
    tries: int = 5


@dataclass(frozen=True)
class CollapseTolerances:
    """How a collapse state is solved for, and when it counts as exact.

    Attributes:
        certificate: largest relative residual at which a final state counts as an exact collapse state.
        rounds: changes of states allowed while the last piece is solved for, and iterations with inertia.
    """

    certificate: float = 1e-8
    rounds: int = 10


@dataclass(frozen=True)
class SpringOptions:
    """All options of a gap-spring model, of its equilibria and of its paths.

    Attributes:
        growth: entries of L above this cost too many digits: rows are exchanged then.
        furthest: multiple of its scale beyond which no multiplier is looked for as the load is raised.
        pins: in the factor on soft pieces of a path, at most.
        elastic: elastic force rates below this share of the strain rates count as zero: the direction is a mechanism.
        jumps: tried along one path, at most: a loop would be tried to be left for ever.
    """

    breakpoints: BreakpointTolerances = BreakpointTolerances()
    newton: NewtonTolerances = NewtonTolerances()
    first_steps: FirstSteps = FirstSteps()
    collapse: CollapseTolerances = CollapseTolerances()
    growth: float = 1e5
    furthest: float = 1e6
    pins: int = 4
    elastic: float = 1e-8
    jumps: int = 10
