"""The sequence of linear programmes with the friction bound of the previous iterate (Gilbert, Casapulla, Ahmed 2006).

With the bound c of shear held, iterate k solves

    max lambda   s.t.  C' r + f0 + lambda fL = 0,   n1, n2 >= 0,   -c <= s <= c,

whose mechanism slips without dilatancy, and c moves towards mu (n1 + n2) of its forces by a given weight. A fixed point
is a collapse state of zero dilatancy, but seldom a low one: a baseline of the literature.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import Assembly, FloatArray
from harness.model.method import Answer
from methods.la.answers import collapse_answer, not_converged, unbounded_answer
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState, moving_contacts, polished, tight_contacts
from methods.la.family import LimitAnalysisFamily
from methods.la.interior.associated import solve_associated
from methods.la.methods import LA_TRESCA
from methods.la.sources.search import Search
from methods.numerics.linear_programme import INFINITY, Programme


@dataclass(frozen=True)
class _TrescaResult:
    """Scaled forces (m, 3) and multiplier of the last iterate, the multipliers of all, and how it ended."""

    forces: FloatArray | None
    multiplier: float
    history: list[float]
    change: float
    outcome: str


def _tresca_sequence(
    problem: Problem, forces: FloatArray, max_iterations: int, weight: float, tolerance: float
) -> _TrescaResult:
    """The sequence from given forces.

    Args:
        problem: the scaled wall.
        forces: (m, 3) whose normal forces give the first bound.
        max_iterations: programmes at most.
        weight: part of the new normal force in the next bound, in (0, 1].
        tolerance: largest change of a normal force, in mean block weights, that counts as settled.
    """
    m = problem.n_interfaces
    lower = np.append(np.tile([0.0, 0.0, -INFINITY], m), -INFINITY)
    cost = np.append(np.zeros(3 * m), -1.0)
    matrix = sp.csc_matrix(sp.hstack([problem.statics, sp.csr_matrix(problem.live[:, None])]))
    programme = Programme(matrix, cost, (lower, np.full(3 * m + 1, INFINITY)), (-problem.dead, -problem.dead))
    law = problem.law
    bound = law.strength(forces)
    history: list[float] = []
    change, multiplier = float("inf"), float("nan")
    for _ in range(max_iterations):
        programme.set_columns(
            0,
            np.column_stack([np.zeros((m, 2)), -bound]).ravel(),
            np.column_stack([np.full((m, 2), INFINITY), bound]).ravel(),
        )
        status, value, _ = programme.run()
        if status != "optimal":
            return _TrescaResult(None, float("nan"), history, change, status)
        forces, multiplier = value[:-1].reshape(-1, 3), float(value[-1])
        history.append(multiplier)
        wanted = law.strength(np.maximum(forces, 0.0))
        change = float(abs(wanted - bound).max(initial=0.0))
        if change <= tolerance:
            return _TrescaResult(forces, multiplier, history, change, "settled")
        bound = (1.0 - weight) * bound + weight * wanted
    return _TrescaResult(forces, multiplier, history, change, "not settled")


class TrescaSequence(LimitAnalysisFamily):
    """Sequence of programmes with the friction bound of the previous iterate: a baseline (`la-tresca`)."""

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The sequence from the associated solution; its fixed point is a collapse state, not the least one."""
        associated = solve_associated(problem, newton)
        if associated.outcome == "unbounded":
            return unbounded_answer("Statically the live load can grow without limit, so the sequence diverges.")
        if associated.state is None:
            return not_converged(f"The associated programme that starts the sequence ended as {associated.outcome}.")
        result = _tresca_sequence(
            problem, associated.state.forces, settings.max_iterations, settings.weight, settings.settled
        )
        details = {"history": [value * problem.unit_multiplier for value in result.history], "change": result.change}
        if result.forces is None or result.outcome != "settled":
            return not_converged(f"The sequence is {result.outcome}.", len(result.history), details)
        search = Search(problem, newton)
        tight = tight_contacts(problem, result.forces) | (problem.slacks(result.forces) < 1e-6)
        mechanism = search.kinematic.solve(tight, np.ones(tight.shape))
        if mechanism is None:
            return not_converged("No mechanism is complementary to the last forces.", len(result.history), details)
        state = CollapseState(result.forces, result.multiplier, mechanism.velocities, moving_contacts(mechanism.rates))
        state = polished(problem, newton, state, tight=tight)
        return collapse_answer(
            problem,
            state,
            f"The sequence converges to {problem.to_multiplier(state.multiplier):.7g}: a collapse state, "
            "seldom the least one.",
            LA_TRESCA.tolerance,
            len(result.history),
            details,
        )
