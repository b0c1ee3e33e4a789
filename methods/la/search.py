"""The method `la`: the search for the least collapse state (`methods.la.least`)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from harness.model.assembly import Assembly, FloatArray
from harness.model.components import joints_of
from harness.model.method import Answer
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.crushing import dead_load_decides
from methods.la.family import LimitAnalysisFamily
from methods.la.least import least_known
from methods.la.methods import LA
from methods.la.sources import from_motions
from methods.la.sources.search import Choices
from methods.numerics.stress_blocks import greatest_by_chords
from methods.numerics.tangent_search import TangentTolerances, by_tangents
from methods.springs.warm_up import load_kernels

load_kernels()


class LimitAnalysis(LimitAnalysisFamily):
    """Least collapse state known, under zero dilatancy (`la`): the method to use.

    Args:
        choices: how its search solves its programmes.
        tangents: how the stress blocks of joints that crush are approached.
    """

    def __init__(self, choices: Choices = Choices(), tangents: TangentTolerances = TangentTolerances()) -> None:
        self._choices, self._tangents = choices, tangents

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The search that the settings ask for, and a lower bound where they ask for one."""
        known = least_known(problem, newton, settings, LA.tolerance, choices=self._choices)
        if settings.bound is None:
            return known
        from methods.la.bounds import with_bound  # the relaxation, which most searches do without

        return with_bound(assembly, problem, known, settings.bound)

    def crushing(self, assembly: Assembly, settings: Any) -> Answer:
        """The least of the states of the stress blocks that the search finds within tangents; nothing is proved."""
        early = dead_load_decides(assembly, greatest_by_chords)
        if isinstance(early, Answer):
            return early
        unproved = settings.model_copy(update={"bound_seconds": 0.0})
        return by_tangents(assembly, lambda wall: self._of_component(wall, unproved, self.answer), self._tangents)

    def solve_from(self, assembly: Assembly, settings: Any, motions: Sequence[FloatArray]) -> Answer:
        """The least of the states that given motions of the joints (m, 3) lead to, without a search of its own.

        A component in which they move nothing is searched as always, and so is a wall with ties, props or joints that
        crush: what bars and further limits of joints do in a mechanism is not given.
        """
        if len(assembly.bars) or assembly.crushes:
            return self.solve(assembly, settings)

        def answered(part: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
            sources = from_motions([motion[joints_of(part, assembly)] for motion in motions])
            return least_known(problem, newton, settings, LA.tolerance, sources, self._choices)

        return self.solve(assembly, settings, answered)
