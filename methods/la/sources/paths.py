"""States at the ends of central paths: with less friction in unloaded joints, as it is, associated, other weights."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState
from methods.la.interior.path_programmes import exact_state
from methods.la.interior.tresca_iteration import tresca_mechanism
from methods.la.sources.friction_continuation import with_reduced_friction
from methods.la.sources.search import Search
from methods.numerics.failures import SingularMatrix


@dataclass(frozen=True)
class ReducedFriction:
    """The central path of the wall whose unloaded joints have a part of their friction; it ends low at any size.

    Attributes:
        factors: on that friction, tried in order.
        pool: mechanisms of the smoother wall that are tried on the wall itself.
        least, most: interfaces between which it is tried; above 6,000 Newton's path of the whole wall stalls at folds.
        anyway: whether a factor is tried though a state is known.
    """

    name: ClassVar[str] = "reduced friction in unloaded joints"
    factors: tuple[float, ...] = (0.3, 0.6, 0.0)
    pool: int = 24
    least: int = 0
    most: int = 6000
    anyway: bool = True

    def applies(self, problem: Problem) -> bool:
        """On walls on which Newton's path arrives, with joints that the dead load does not press."""
        return self.least <= problem.n_interfaces <= self.most and bool(problem.unloaded_joints.any())

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state a factor, or more where none is known and only forces of the smoother wall lead to one."""
        for factor in self.factors:
            if search.record.known and not self.anyway:
                return
            guide = with_reduced_friction(search.problem, factor)
            if guide is not None:
                yield from self._states_of(search, search.varied(guide))

    def _states_of(self, search: Search, smooth: Search) -> Iterator[CollapseState]:
        end = smooth.path_end()
        if end is None:
            return
        state = search.nearest_state(end.point.slack, end.point.rates)
        if state is not None:
            yield state
        elif not search.record.known and smooth.nearest_state(end.point.slack, end.point.rates) is not None:
            yield from search.adopt(smooth, self.pool)


@dataclass(frozen=True)
class CentralPath:
    """The central path of the wall itself.

    Attributes:
        most: interfaces above which it is not followed: above 6,000 Newton's path stalls at folds.
        anyway: whether it is followed though a state is known.
    """

    name: ClassVar[str] = "central path"
    most: int = 6000
    anyway: bool = True

    def applies(self, problem: Problem) -> bool:
        """On walls on which Newton's path arrives."""
        return problem.n_interfaces <= self.most

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state."""
        if self.anyway or not search.record.known:
            state = search.interior()
            if state is not None:
                yield state


@dataclass(frozen=True)
class AssociatedForces:
    """The forces of the associated maximum, where no state is known: its mechanism fits them if joints dilate by their
    friction (duality of linear programmes), however degenerate the wall.
    """

    name: ClassVar[str] = "associated forces"

    def applies(self, problem: Problem) -> bool:
        """On every wall."""
        return True

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state."""
        greatest = search.associated.state
        if greatest is None or search.record.known:
            return
        state = search.nearest_state(search.problem.slacks(greatest.forces))
        if state is not None:
            yield state


@dataclass(frozen=True)
class OtherWeights:
    """Central paths of the wall with blocks of other weights, until as many as the budget says led to nothing lower.

    Mechanisms do not depend on the weights, only the forces that fit them do. With random weights the central path
    goes by other forces, and ends at mechanisms that it misses with those of the wall, from any start. Unloaded joints
    have a part of their friction, as in `ReducedFriction`.

    Attributes:
        spread: weights are between 1 - spread and 1 + spread times those of the wall.
        factor: on the friction of the unloaded joints.
        blocks_at_once: of all copies that are followed together; many more leave the cache of a processor.
    """

    name: ClassVar[str] = "other block weights"
    spread: float = 0.6
    factor: float = 0.3
    blocks_at_once: int = 1000

    def applies(self, problem: Problem) -> bool:
        """On every wall."""
        return True

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state a mechanism that paths end at and forces of the wall fit."""
        guide = with_reduced_friction(search.problem, self.factor) or search.problem
        blocks, most = search.problem.n_velocities // 3, search.budget.limits.starts
        at_once = 1 if search.newton.large else max(self.blocks_at_once // blocks, 1)
        tried: set[bytes] = set()
        in_vain = 0
        while in_vain < most and search.budget.steps_left(search.record.known):
            count, least = min(at_once, most - in_vain), search.record.least
            shares = search.generator.uniform(1.0 - self.spread, 1.0 + self.spread, size=(count, blocks))
            dead = guide.dead * np.repeat(shares, 3, axis=1)
            for slack, rates in search.ends_of_copies(guide, dead):
                moving = np.packbits(rates >= slack).tobytes()
                state = search.nearest_state(slack, rates, search.record.least) if moving not in tried else None
                tried.add(moving)
                if state is not None:
                    yield state
            in_vain = 0 if search.record.least < least else in_vain + count


@dataclass(frozen=True)
class TrescaMechanisms:
    """Paths with friction bounds that lag behind, where nothing else led to a state
    (`methods.la.interior.tresca_iteration`).

    Attributes:
        attempts: Newton steps with lagged bounds and how fast the bounds follow, tried until one leads to a state.
        most: interfaces above which none is tried: the paths stall.
    """

    name: ClassVar[str] = "lagged friction bounds"
    attempts: tuple[tuple[int, float], ...] = ((80, 0.3), (120, 0.15), (100, 0.6))
    most: int = 6000

    def applies(self, problem: Problem) -> bool:
        """On joints that slide without lifting."""
        return problem.n_interfaces <= self.most and not problem.dilates

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state at most."""
        if search.record.known:
            return
        for steps, follow in self.attempts:
            try:
                path, spent = tresca_mechanism(search.problem, search.newton, steps, follow)
            except SingularMatrix:
                continue
            state, more = exact_state(search.problem, search.newton, path, search.choices.exactness)
            search.stepped(spent + more)
            if state is not None:
                yield state
                return
