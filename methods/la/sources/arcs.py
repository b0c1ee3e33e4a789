"""States at the ends of paths by arc length in the part of a large wall that the associated mechanism moves."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState
from methods.la.interior.arc import ArcPath
from methods.la.interior.interior_starting_point import interior_starting_point
from methods.la.interior.path_programmes import cheapest_mechanism, exact_state
from methods.la.interior.region import Region, in_whole, moving_region
from methods.la.sources.friction_continuation import with_reduced_friction
from methods.la.sources.search import Search
from methods.numerics.failures import SingularMatrix


@dataclass(frozen=True)
class ArcStart:
    """How a path by arc length begins, and how far it is followed.

    Attributes:
        smooth: factor on the friction of the joints that the dead load leaves unloaded.
        gap: relative gap of the associated path at which the forces of its start are taken.
        spread: of the weights about their mean.
        gaps: of the path at which its mechanism is tried.
        least_steps: Newton steps from one of them to the next, or one a moving block where those are more.
    """

    smooth: float
    gap: float
    spread: float
    gaps: tuple[float, ...]
    least_steps: int


_NEAR_PATH = (10.0, (1e-6, 1e-8), 600)
_FAR_PATH = (np.inf, (1e-8, 1e-9, 1e-10), 2000)
"""Spread, gaps and steps of paths near the central one, and of those with the weights of their start."""

NEAR = (ArcStart(0.3, 1e-3, *_NEAR_PATH), ArcStart(0.3, 1e-2, *_NEAR_PATH), ArcStart(0.45, 1e-2, *_NEAR_PATH))
"""Beginnings near the central path, which end low but do not always arrive."""
FAR = (ArcStart(0.15, 1e-2, *_FAR_PATH), ArcStart(0.3, 1e-3, *_FAR_PATH), ArcStart(0.0, 1e-2, *_FAR_PATH))
"""Beginnings with the weights of their start, for where the others do not arrive."""


@dataclass(frozen=True)
class ArcPaths:
    """Paths of zero-dilatancy flow followed past their folds, one mechanism and one programme each.

    Attributes:
        least: interfaces from which they are followed.
        near: beginnings of the paths; far: those from `many` blocks on, until one does not arrive, as then no other.
        many: moving blocks on which a path near the central one folds a thousand times and more.
        anyway: whether they are followed though a state is known.
    """

    name: ClassVar[str] = "paths by arc length"
    least: int = 1001
    near: tuple[ArcStart, ...] = NEAR
    far: tuple[ArcStart, ...] = FAR
    many: int = 2000
    anyway: bool = True

    def applies(self, problem: Problem) -> bool:
        """On walls too large for descents."""
        return problem.n_interfaces >= self.least

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state a path that arrives; none where no associated mechanism tells the part that moves."""
        if search.associated.state is None or (search.record.known and not self.anyway):
            return
        region = moving_region(search.problem, search.associated.state.velocities)
        many = region.problem.n_velocities // 3 > self.many
        for arc_start in self.far if many else self.near:
            known = search.record.known
            if (known and not self.anyway) or not search.budget.steps_left(known):
                return
            state = None
            with suppress(SingularMatrix):  # It ends one path, not the search.
                state = _end_of(arc_start, search, region)
            if state is not None:
                yield state
            elif many:
                return


def _end_of(arc_start: ArcStart, search: Search, region: Region) -> CollapseState | None:
    """The state that one path by arc length leads to."""
    begun = _begun(arc_start, search, region)
    if begun is None:
        return None
    most = max(arc_start.least_steps, region.problem.n_velocities // 3)
    return _state_on(begun[1], begun[0], arc_start.gaps, most, search, region)


def _begun(arc_start: ArcStart, search: Search, region: Region) -> tuple[Problem, ArcPath] | None:
    """The part of the wall with the friction of a beginning, and its path from there; None without any."""
    part = region.problem
    guide = with_reduced_friction(part, arc_start.smooth) or part
    start, steps = interior_starting_point(guide, region.newton, arc_start.gap)
    search.budget.stepped(steps, part.n_velocities // 3)
    return None if start is None else (guide, ArcPath(guide, region.newton, start, arc_start.spread))


def _state_on(
    arc: ArcPath, guide: Problem, gaps: tuple[float, ...], most: int, search: Search, region: Region
) -> CollapseState | None:
    """The state of the wall by the mechanism at the first of these gaps of a path that has one.

    Args:
        arc: the path, of `guide`; gaps: at which its mechanism is tried; most: Newton steps from one to the next.
        search: whose wall it is; region: the part of it.
    """
    problem, part = search.problem, region.problem
    blocks, exactness = part.n_velocities // 3, search.choices.exactness
    quick = replace(exactness, shares=exactness.shares[:1])
    for gap in gaps:
        path = arc.follow(gap, most)
        search.budget.stepped(path.iterations, blocks)
        if not path.converged:
            return None
        mechanism = cheapest_mechanism(guide, region.newton, path.point.slack, np.random.default_rng(search.seed))
        state, steps = exact_state(part, region.newton, mechanism, quick)
        search.budget.stepped(mechanism.iterations + steps, blocks)
        if state is None:
            continue
        state, steps = exact_state(problem, search.newton, in_whole(problem, region, mechanism), exactness)
        search.stepped(steps)
        if state is not None:
            return state
    return None
