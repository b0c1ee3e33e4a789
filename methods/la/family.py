"""What every method of limit analysis does first: take the wall apart, scale, answer where the dead load decides."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar

from harness.model.assembly import Assembly
from harness.model.method import Answer
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.state_answers import dead_load_answer
from methods.numerics.statics import analysed

Answering = Callable[[Assembly, Problem, NewtonMatrix, Any], Answer]
"""Answers for a component that stands under its dead load and carries a live load, by the settings."""


class LimitAnalysisFamily(ABC):
    """Base of the adapters: a wall that falls under its dead load, or has no live load, is answered here."""

    family: ClassVar[str] = "la"

    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        """The answer from those for the independent components of the wall."""
        return analysed(assembly, lambda part: self._of_component(part, settings))

    def _of_component(self, assembly: Assembly, settings: Any, answer: Answering | None = None) -> Answer:
        """The answer of the dead load where it decides, else that of `answer`, by default the method's own."""
        problem = make_problem(assembly)
        newton = NewtonMatrix(problem)
        early = dead_load_answer(problem, newton, assembly.has_live_load)
        return early if early is not None else (answer or self.answer)(assembly, problem, newton, settings)

    @abstractmethod
    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The answer for a wall that stands under its dead load and carries a live load."""
