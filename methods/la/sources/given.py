"""States of mechanisms that are given: those of walls with the same blocks and joints, of other friction or shape."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from harness.model.assembly import FloatArray
from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState, moving_contacts
from methods.la.sources.search import Search


@dataclass(frozen=True, eq=False)
class GivenMechanisms:
    """Mechanisms told by how their joints move. A state counts here only if forces of this wall fit its mechanism.

    Attributes:
        motions: (m, 3) openings at both ends and slip of the joints of each, at any scale.
        most: interfaces up to which mechanisms are vertices, which tell whether the joints can move so here.
    """

    motions: tuple[FloatArray, ...]
    most: int = 1000
    name: ClassVar[str] = "mechanisms of neighbouring walls"

    @property
    def moves(self) -> bool:
        """Whether anything moves in any of them."""
        return any(motion.any() for motion in self.motions)

    def applies(self, problem: Problem) -> bool:
        """Where mechanisms are vertices."""
        return problem.n_interfaces <= self.most

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state a mechanism whose joints can move alike in this wall and that forces fit."""
        for motion in self.motions:
            moving = moving_contacts(search.problem.rates_of_strains(motion, False))
            if not moving.any():
                continue
            search.budget.spent.programmes += 1
            mechanism = search.kinematic.solve(moving, np.ones(moving.shape))
            state = None if mechanism is None else search.state_of(mechanism.velocities, mechanism.rates)
            if state is not None:
                yield state
