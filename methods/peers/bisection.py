"""The multiplier between a load that a program of other people bears and one that it does not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import best_so_far
from harness.model.errors import optional
from harness.model.method import Answer, Finding, Solver, Status
from methods.numerics.claims import analysed
from methods.peers.settings import BisectionSettings


class _Borne(Protocol):
    """A wall in a program that says of a multiplier whether it bears it.

    Attributes:
        assembly: the wall.
        said: what came of each multiplier.
        forces: (m, 3) contact forces of the greatest that was borne [force].
        motion: (n, 3) motion of the least that was not; None where the program has none.
    """

    assembly: Assembly
    said: list[str]
    forces: FloatArray | None
    motion: FloatArray | None

    def at(self, multiplier: float) -> bool:
        """Whether it bears a multiplier."""
        ...


@dataclass(frozen=True)
class Words:
    """What sentences say of a program.

    Attributes:
        program: its name.
        bears: what it did at a load that it bears.
        no_proof: why the other end shows no collapse.
    """

    program: str
    bears: str
    no_proof: str


class Bisection(Solver):
    """The multiplier by bisection.

    Args:
        method: name of it, for messages.
        words: of its sentences.
        module: of the program, by its name for Python; extra: of drystone that brings it.
        problem: of a wall, settings and that module; with `refusal`, why a wall is refused.
    """

    def __init__(self, method: str, words: Words, module: str, extra: str, problem: Any) -> None:
        self._method, self._words, self._module, self._extra, self._problem = method, words, module, extra, problem

    def solve(self, assembly: Assembly, settings: BisectionSettings) -> Answer:
        """The bracket with the forces of its lower end.

        Raises:
            InputError: the package is not installed.
        """
        package = optional(self._module, self._extra, f"method {self._method}")
        return analysed(assembly, lambda part: self._of_component(package, part, settings))

    def _of_component(self, package: Any, assembly: Assembly, settings: BisectionSettings) -> Answer:
        if assembly.n_free == 0:
            return Answer(Status.OK, Finding.STANDS, "every block is fixed: nothing can move")
        low, high = float(assembly.friction.min()), float(assembly.friction.max())
        refusal = self._problem.refusal(assembly)
        if low != high:
            program = self._words.program
            refusal = f"{program} takes one friction coefficient for all joints; the wall has {low:g} to {high:g}"
        if refusal:
            return Answer(Status.REFUSED, Finding.NONE, refusal)
        problem: _Borne = self._problem(assembly, settings, package)
        borne, not_borne = list[float](), list[float]()

        def bisected() -> bool:
            unit = assembly.load_unit
            if not problem.at(0.0):
                return True
            borne.append(0.0)
            step = settings.load_step * unit
            while assembly.has_live_load and borne[-1] < settings.load_cap * unit:
                width = 0.5 * (not_borne[-1] - borne[-1]) if not_borne else step
                if not_borne and 2.0 * width <= settings.accuracy * not_borne[-1]:
                    break
                step *= 2.0
                middle = borne[-1] + width
                (borne if problem.at(middle) else not_borne).append(middle)
            return True

        ended = best_so_far(bisected, lambda: False)
        return self._concluded(problem, settings, max(borne, default=None), min(not_borne, default=None), ended)

    def _concluded(
        self, problem: _Borne, settings: BisectionSettings, borne: float | None, not_borne: float | None, ended: bool
    ) -> Answer:
        words, asked = f"{self._words.program} {self._words.bears}", {"asked": problem.said}
        if borne is None:
            sentence = f"{words} under no load, not even the dead load, which does not show that the wall falls"
            return Answer(Status.NOT_CONVERGED, Finding.NONE, sentence, details=asked)
        if not problem.assembly.has_live_load:
            sentence = f"{words} under the dead load; no live load is given"
            answer = Answer(Status.OK, Finding.STANDS, sentence, details=asked)
        elif not_borne is None:
            sentence = f"{words} up to multiplier {borne:.6g}; larger loads were not tried"
            answer = Answer(Status.NOT_CONVERGED, Finding.NONE, sentence, details=asked)
        else:
            sentence = f"{words} at {borne:.6g} and not at {not_borne:.6g}; {self._words.no_proof}"
            loose = not_borne - borne > settings.accuracy * not_borne
            answer = Answer(Status.NOT_CONVERGED if loose else Status.OK, Finding.COLLAPSES, sentence, details=asked)
            answer.multiplier, answer.bracket = 0.5 * (borne + not_borne), (borne, not_borne)
            answer.bracket_meaning = "[highest multiplier that was borne, lowest that was not]"
            if problem.motion is not None:
                answer.mechanism, answer.flow = problem.motion, "approximate"
        if not ended:
            answer.details["stopped_by_limit"] = True
        answer.forces, answer.forces_multiplier = problem.forces, borne
        answer.iterations = len(problem.said)
        return answer


def prism(corners: FloatArray) -> tuple[list[list[float]], list[list[int]]]:
    """The prism over a polygon: its vertices (2k, 3), and its faces as lists of numbers of these.

    Args:
        corners: (k, 2) of the polygon; faces look outward if they run counter-clockwise.
    """
    k = len(corners)
    vertices = [[float(x), side, float(y)] for side in (-0.5, 0.5) for x, y in corners]
    sides = [[j, k + j, k + (j + 1) % k, (j + 1) % k] for j in range(k)]
    return vertices, [list(range(k)), list(range(2 * k - 1, k - 1, -1)), *sides]
