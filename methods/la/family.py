"""What every method of limit analysis does first: take the wall apart, scale, answer where the dead load decides."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Solver
from methods.la.answers import dead_load_answer
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.crushing import crushing_answer
from methods.numerics.claims import analysed
from methods.numerics.residual_strength import plastic_and_residual
from methods.numerics.stress_blocks import Greatest

Answering = Callable[[Assembly, Problem, NewtonMatrix, Any], Answer]
"""Answers for a component that stands under its dead load and carries a live load, by the settings."""


def _proved_of_all(answer: Answer, parts: Sequence[Answer]) -> Answer:
    """The answer for a wall with the lower bound that holds of all of its components, not of the deciding one alone.

    A component that fails at a higher multiplier, as far as is known, may fail below too. A certificate of one
    component is none of the wall.

    Args:
        answer: for the wall.
        parts: those for the components that were analysed; a component whose analysis was stopped is missing.
    """
    components = answer.details.get("components", ())
    own = answer.details.get("lower_bound")
    if len(components) < 2 or own is None or answer.multiplier is None:
        return answer
    lower = 0.0
    if len(parts) == len(components):
        bounds = [part.details.get("lower_bound", 0.0) for part in parts if part.finding is not Finding.STANDS]
        lower = min([own, *bounds])
    proved = bool(answer.details["proved_least"]) and lower >= min(own, answer.multiplier)
    kept = {name: value for name, value in answer.details.items() if name not in ("certificate", "certified_bound")}
    details = kept | {"lower_bound": lower, "proved_least": proved}
    rest = f"there is none below {lower:.7g}" if lower > 0.0 else "nothing is proved"
    said = ""
    if not proved and (answer.details["proved_least"] or own > lower):
        said = f" The proof covers that component alone; of the whole wall {rest}."
    elif len(kept) < len(answer.details):
        said = " The other components bear more, to rounding."
    return replace(answer, sentence=answer.sentence + said, details=details)


class LimitAnalysisFamily(Solver):
    """Base of the solvers: a wall that falls under its dead load, or has no live load, is answered here."""

    gives_most = False
    """Whether it answers with the most that statics allows."""

    def solve(self, assembly: Assembly, settings: Any, answer: Answering | None = None) -> Answer:
        """The answer from those for the independent components of the wall, with what is proved of all of them.

        Args:
            assembly, settings: as of `Solver`.
            answer: answers for components; None: the method's own.
        """

        def of_components(wall: Assembly) -> Answer:
            parts: list[Answer] = []

            def solve_part(part: Assembly) -> Answer:
                parts.append(self._of_component(part, settings, answer or self.answer))
                return parts[-1]

            return _proved_of_all(analysed(wall, solve_part), parts)

        return plastic_and_residual(assembly, of_components, most=self.gives_most)

    def _of_component(self, assembly: Assembly, settings: Any, answer: Answering) -> Answer:
        """The answer of the dead load where it decides, else that of `answer`."""
        if assembly.crushes:
            return self.crushing(assembly, settings)
        problem = make_problem(assembly)
        newton = NewtonMatrix(problem)
        early = dead_load_answer(problem, newton, assembly.has_live_load)
        return early if early is not None else answer(assembly, problem, newton, settings)

    def crushing(self, assembly: Assembly, settings: Any) -> Answer:
        """The answer for a component whose joints crush: by default the associated one."""
        return crushing_answer(assembly, self.greatest(settings))

    def greatest(self, settings: Any) -> Greatest:
        """What solves for the greatest multiplier where joints crush.

        Raises:
            ValueError: the method takes no such joints, which `check_takes` refuses before.
        """
        raise ValueError("it takes no joints with compressive strength")

    @abstractmethod
    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The answer for a wall that stands under its dead load and carries a live load."""
