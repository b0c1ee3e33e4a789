"""Finite elements and limit analysis together, as Baggio and Trovalusci (1995) propose in their conclusion.

The contact forces r_FE and the multiplier of the finite-element collapse state are projected onto equilibrium and yield
by a quadratic programme (OSQP, polished),

    min |r - r_FE|^2 + m (lambda - lambda_FE)^2   s.t.  C' r + f0 + lambda fL = 0,   S r + s0 >= 0,

with m interfaces. The extreme mechanism nearest to these forces starts the ray descent.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import osqp
import scipy.sparse as sp

from harness.model.assembly import Assembly, FloatArray
from harness.model.joint_law import block_diagonal
from harness.model.method import Answer, Finding
from harness.model.method_registry import load_method
from methods.la.answers import collapse_answer, not_converged, unbounded_answer
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.core.state import polished
from methods.la.family import LimitAnalysisFamily
from methods.la.methods import LA_FROM_FE
from methods.la.sources.budget import Budget, SearchLimits
from methods.la.sources.search import Search


def _project_forces(problem: Problem, forces: FloatArray, multiplier: float) -> tuple[FloatArray, float, bool]:
    """The nearest forces (m, 3) in equilibrium within yield, their multiplier, and whether OSQP solved it.

    Args:
        problem: the scaled wall.
        forces: (m, 3) scaled contact forces.
        multiplier: scaled multiplier they belong to.
    """
    m = problem.n_interfaces
    rows = block_diagonal(problem.law.rows)
    slacks = sp.hstack([rows, sp.csr_matrix((rows.shape[0], 1))])
    equilibrium = sp.hstack([problem.statics, sp.csr_matrix(problem.live[:, None])])
    target = np.append(forces.ravel(), multiplier)
    weight = np.append(np.ones(3 * m), float(m))
    solver = osqp.OSQP()
    solver.setup(
        P=sp.diags(weight).tocsc(),
        q=-weight * target,
        A=sp.csc_matrix(sp.vstack([equilibrium, slacks])),
        l=np.append(-problem.dead, np.zeros(rows.shape[0])),
        u=np.append(-problem.dead, np.full(rows.shape[0], np.inf)),
        eps_abs=1e-8,
        eps_rel=1e-8,
        max_iter=20000,
        polishing=True,
        verbose=False,
    )
    result = solver.solve(raise_error=False)
    value = np.asarray(result.x, dtype=float)
    if result.info.status_val not in (1, 2) or not np.all(np.isfinite(value)):
        return forces, multiplier, False
    return value[:-1].reshape(-1, 3), float(value[-1]), True


def finite_element_answer(assembly: Assembly, name: str) -> Answer:
    """The answer of an installed finite-element method at its default settings."""
    method = load_method(name)
    return method.solve(assembly, method.Settings())


def without_start(given: Answer) -> Answer:
    """The answer where finite elements end without a collapse state to start from."""
    if given.finding is Finding.UNBOUNDED:
        return unbounded_answer(f"There is no collapse state to start from: {given.sentence}.")
    return not_converged("The finite-element run gave no collapse state to start from.")


class FromFiniteElements(LimitAnalysisFamily):
    """Ray descent from the finite-element collapse state, against a cold start (`la-from-fe`)."""

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """FE forces projected onto equilibrium and yield, nearest mechanism, descent; and the same from cold."""
        given = finite_element_answer(assembly, settings.fe_method)
        if given.finding is not Finding.COLLAPSES or given.forces is None or given.multiplier is None:
            return without_start(given)
        forces, _, projected = _project_forces(
            problem, given.forces / problem.unit_force, given.multiplier / problem.unit_multiplier
        )
        limits = SearchLimits(failures=settings.failures)
        warm = Search(problem, newton, settings.seed, Budget(limits))
        first = warm.nearest_state(problem.slacks(forces), _fe_rates(problem, given))
        warm_end = None if first is None else warm.descend(first)
        cold = Search(problem, newton, settings.seed, Budget(limits))
        second = cold.interior()
        cold_end = None if second is None else cold.descend(second)
        spent, cold_spent = warm.budget.spent.programmes, cold.budget.spent.programmes + cold.budget.spent.newton_steps
        if first is None or warm_end is None:
            return not_converged("No collapse state lies near the finite-element forces.")
        unit = problem.unit_multiplier
        plateau = given.multiplier * (1.0 + 1e-9)
        ends = [end for end in (warm_end, cold_end) if end is not None and end.multiplier * unit <= plateau]
        if not ends:
            return not_converged(
                f"The descent from the finite-element state ends at {warm_end.multiplier * unit:.7g}, above the "
                f"plateau {given.multiplier:.7g} it started from."
            )
        state = polished(problem, newton, ends[0])
        details: dict[str, Any] = {
            "fe_multiplier": given.multiplier,
            "projected": projected,
            "first_multiplier": first.multiplier * unit,
            "iterations": {"from_fe": spent, "cold": cold_spent},
            "cold_first_multiplier": None if second is None else second.multiplier * unit,
            "cold_multiplier": None if cold_end is None else cold_end.multiplier * unit,
            "gain_in_value": None if cold_end is None else (cold_end.multiplier - warm_end.multiplier) * unit,
            "gain_in_iterations": cold_spent - spent,
        }
        return collapse_answer(
            problem,
            state,
            f"From the finite-element state at {given.multiplier:.6g} the descent leads to a collapse state at "
            f"{state.multiplier * unit:.7g}.",
            LA_FROM_FE.tolerance,
            spent,
            details,
        )


def _fe_rates(problem: Problem, answer: Answer) -> np.ndarray[Any, np.dtype[np.float64]] | None:
    """(m, 4) rates of the finite-element mechanism, scaled to the live work; None if it has none."""
    if answer.mechanism is None:
        return None
    velocities = problem.from_mechanism(answer.mechanism)
    work = float(problem.live @ velocities)
    if work <= 0.0:
        return None
    return np.maximum(problem.rates_of_velocities(velocities * (problem.live_work / work), False), 0.0)
