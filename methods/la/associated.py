"""The method `la-associated`: max lambda s.t. C' r + f0 + lambda fL = 0, S r + s0 >= 0 (Livesley 1978).

`methods.la.interior.associated` solves it with its dual. This module loads no compiled code.
"""

from __future__ import annotations

from functools import partial
from typing import Any

from harness.model.assembly import Assembly
from harness.model.method import Answer
from methods.la.answers import collapse_answer, not_converged, unbounded_answer
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.family import LimitAnalysisFamily
from methods.la.interior.associated import (
    AssociatedResult,
    EndOfPath,
    solve_associated,
    solve_with_cvxpy,
    with_mechanism,
)
from methods.la.interior.cones import greatest_by_cones
from methods.numerics.stress_blocks import Greatest, greatest_by_chords


class AssociatedLimitAnalysis(LimitAnalysisFamily):
    """Greatest multiplier of statics, the linear programme of associated limit analysis (`la-associated`).

    Args:
        end: of its own interior point.
    """

    gives_most = True

    def __init__(self, end: EndOfPath = EndOfPath()) -> None:
        self._end = end

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The linear programme by simplex or interior point."""
        return _associated_answer(problem, solve_associated(problem, newton, settings.solver, self._end), 1e-9)

    def greatest(self, settings: Any) -> Greatest:
        """Linear programmes with chords and tangents of the stress blocks."""
        return greatest_by_chords


class AssociatedLimitAnalysisCvxpy(LimitAnalysisFamily):
    """The same linear programme written in cvxpy, to be read beside the formulas (`la-associated-cvxpy`)."""

    gives_most = True

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The linear programme through cvxpy; its mechanism is found as for `la-associated`."""
        outcome, forces, multiplier = solve_with_cvxpy(problem, settings.solver)
        if forces is None:
            return _associated_answer(problem, AssociatedResult(outcome), 1e-9)
        return _associated_answer(problem, with_mechanism(problem, newton, forces, multiplier, 0), 1e-9)

    def greatest(self, settings: Any) -> Greatest:
        """The programme of cones."""
        return partial(greatest_by_cones, solver=settings.cone_solver)


def _associated_answer(problem: Problem, result: AssociatedResult, tolerance: float) -> Answer:
    """The answer that belongs to the outcome of the associated programme."""
    if result.outcome == "unbounded":
        return unbounded_answer(
            "Statically the live load can grow without limit: it cannot make the wall collapse under associated flow.",
            result.iterations,
        )
    if result.state is None:
        return not_converged(f"The linear programme ended as {result.outcome}.", result.iterations)
    if not result.gap <= tolerance:
        return not_converged(
            f"The static and the kinematic multiplier differ by {result.gap:.2g}, more than {tolerance:.2g}.",
            result.iterations,
        )
    multiplier = problem.to_multiplier(result.state.multiplier)
    return collapse_answer(
        problem,
        result.state,
        f"The greatest multiplier within statics and yield is {multiplier:.7g}, an upper bound whatever the flow.",
        tolerance,
        result.iterations,
        {"duality_gap": result.gap, "unknowns": 3 * problem.n_interfaces + 1},
    )
