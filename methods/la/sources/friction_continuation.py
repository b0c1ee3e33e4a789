"""Continuation in friction: mechanisms found at lower friction are carried in steps to the friction of the wall.

The mechanisms of zero-dilatancy flow do not depend on friction, only the forces that fit them do. At high friction
the low collapse states have small basins; at lower friction the same mechanisms are found at once.

Central paths keep all the self-stress that friction allows, and may arrive nowhere on walls that hardly stand. Springs
from gravity, with little self-stress, lead to other mechanisms at lower friction, which are carried on as well.

With less friction in the joints that the dead load leaves unloaded, the head joints of a wall, self-stress gives these
no shear. Little of the non-associated problem is left that is not convex, and the interior point ends low on walls of
any size.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from harness.model.assembly import FloatArray
from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState
from methods.la.sources.search import Search, Source

_ROUGHEST = 1.5
"""Friction of all joints at most, where unloaded ones are lowered further; above, starts end at self-stress."""


def with_reduced_friction(problem: Problem, factor: float) -> Problem | None:
    """The wall with friction of _ROUGHEST at most, times `factor` in the unloaded joints; None if all are loaded."""
    unloaded = problem.unloaded_joints
    if not unloaded.any():
        return None
    friction = np.minimum(problem.friction, _ROUGHEST)
    return problem.with_friction(np.where(unloaded, factor * friction, friction))


@dataclass(frozen=True)
class FrictionContinuation:
    """Steps of lower friction, each with its own path and what the step before found.

    Attributes:
        pool: mechanisms carried from one step to the next.
        rough: friction above which the steps are shares of this instead: much higher, most starts end at self-stress.
        rough_steps: friction of the steps added for joints that are rougher still.
        beside: the starting-point strategy that each step tries as well.
    """

    name: ClassVar[str] = "friction continuation"
    pool: int = 24
    rough: float = 1.0
    rough_steps: tuple[float, ...] = (1.0, 1.5, 2.25)
    beside: Source | None = None

    def applies(self, problem: Problem) -> bool:
        """On every wall; the budget says how many steps there are."""
        return True

    def states(self, search: Search) -> Iterator[CollapseState]:
        """States of the mechanisms that were lowest on the last step."""
        below: Search | None = None
        for friction in self._steps(search):
            if not search.budget.steps_left(search.record.known):
                break
            step = search.varied(search.problem.with_friction(friction))
            found = step.interior()
            states = [] if found is None else [found]
            if below is not None:
                states += step.adopt(below, self.pool)
            if self.beside is not None and self.beside.applies(step.problem):
                states += self.beside.states(step)
            step.descend_from(states)
            below = step
        if below is not None:
            yield from search.adopt(below, self.pool)

    def _steps(self, search: Search) -> list[FloatArray]:
        friction = search.problem.friction
        greatest = float(friction.max(initial=0.0))
        steps = [factor * np.minimum(friction, self.rough) for factor in search.budget.limits.continuation]
        return steps + [np.minimum(friction, most) for most in self.rough_steps if most < greatest]
