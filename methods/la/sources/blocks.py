"""States sought from mechanisms: of single blocks, and of all moving blocks as one body."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState
from methods.la.sources.mechanisms import motions_of
from methods.la.sources.record import LEAST_IMPROVEMENT
from methods.la.sources.search import Search


@dataclass(frozen=True)
class SingleBlocks:
    """Blocks that may move alone below the least multiplier known.

    Attributes:
        most: interfaces above which they are not asked.
    """

    name: ClassVar[str] = "single blocks"
    most: int = 2000

    def applies(self, problem: Problem) -> bool:
        """On joints that slide without lifting."""
        return problem.n_interfaces <= self.most and not problem.dilates

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state a motion that forces fit."""
        problem = search.problem
        for block in range(problem.assembly.n_free):
            for velocities, least in motions_of(problem, block):
                search.budget.spent.programmes += 1
                if least >= search.record.least - LEAST_IMPROVEMENT:
                    continue
                state = search.state_of(velocities, problem.rates_of_velocities(velocities, False), search.record.least)
                if state is not None:
                    yield state


@dataclass(frozen=True)
class JoinedBlocks:
    """The blocks that move in the least state known, as one rigid body: descent splits them and seldom joins them."""

    name: ClassVar[str] = "moving blocks joined"

    def applies(self, problem: Problem) -> bool:
        """On every wall."""
        return True

    def states(self, search: Search) -> Iterator[CollapseState]:
        """The joined state, where it is lower."""
        if not search.record.known or not search.budget.limits.descents:
            return
        least = search.record.improvements[-1].state
        joined = search.as_one_block(least)
        if joined is not None and joined.multiplier < least.multiplier:
            yield joined
