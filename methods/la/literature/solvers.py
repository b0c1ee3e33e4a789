"""What solves the methods of the literature and the co-operation with finite elements."""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Status
from harness.model.method_registry import load_method
from methods.la.answers import NO_MOTION, collapse_answer, not_converged, unbounded_answer
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState, moving_contacts, polished, tight_contacts
from methods.la.family import LimitAnalysisFamily
from methods.la.interior.associated import solve_associated
from methods.la.literature.cooperation import project_forces
from methods.la.literature.paper_programme import PaperResult, solve_paper_programme
from methods.la.literature.tresca import tresca_sequence
from methods.la.methods import LA_FROM_FE, LA_PAPER, LA_TRESCA
from methods.la.sources.budget import Budget, SearchLimits
from methods.la.sources.search import Search
from methods.numerics.failures import NumericalFailure


def _finite_element_answer(assembly: Assembly, name: str) -> Answer:
    """The answer of an installed finite-element method at its default settings."""
    method = load_method(name)
    return method.solve(assembly, method.Settings())


def _without_start(given: Answer) -> Answer:
    """The answer where finite elements end without a collapse state to start from."""
    if given.finding is Finding.UNBOUNDED:
        return unbounded_answer(f"There is no collapse state to start from: {given.sentence}.")
    return not_converged("The finite-element run gave no collapse state to start from.")


class PaperProgramme(LimitAnalysisFamily):
    """The paper's own programme (8)-(11) in reduced unknowns, by Ipopt (`la-paper`)."""

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """A local solution of the programme, made exact on the mechanism it ends at."""
        if assembly.n_free > settings.max_blocks:
            return Answer(
                Status.REFUSED,
                Finding.NONE,
                f"The programme of the paper is not reliable above {settings.max_blocks} blocks; "
                f"this wall has {assembly.n_free}. Use la, or raise max_blocks.",
            )
        start = None
        if settings.start == "fe":
            given = _finite_element_answer(assembly, "fe")
            if given.finding is not Finding.COLLAPSES or given.forces is None:
                return _without_start(given)
            start = given.forces / problem.unit_force
        try:
            result = solve_paper_programme(problem, start, settings.max_iterations, settings.epsilons)
        except (ValueError, NumericalFailure) as error:
            return not_converged(f"The programme could not be set up or solved: {error}")
        return _paper_answer(problem, newton, result, settings.start, LA_PAPER.tolerance)


def _paper_answer(problem: Problem, newton: NewtonMatrix, result: PaperResult, start: str, tolerance: float) -> Answer:
    """The exact state on the mechanism that the programme ends at, with what the programme itself said."""
    details: dict[str, Any] = {
        "unknowns": result.unknowns,
        "programme_value": result.multiplier * problem.unit_multiplier,
        "solver_message": result.message,
        "start": start,
    }
    if not (np.all(np.isfinite(result.forces)) and np.all(np.isfinite(result.rates))):
        return not_converged(f"Ipopt ended with {result.message}.", result.iterations, details)
    search = Search(problem, newton)
    state = search.nearest_state(problem.slacks(result.forces), result.rates)
    if state is None and not search.finds_motion():
        return unbounded_answer(NO_MOTION, result.iterations, details)
    if state is None:
        return not_converged(
            f"Ipopt ended with {result.message} and no collapse state lies near its end.", result.iterations, details
        )
    multiplier = problem.to_multiplier(state.multiplier)
    return collapse_answer(
        problem,
        polished(problem, newton, state),
        f"The programme of the paper leads to a collapse state at {multiplier:.7g}, a local solution.",
        tolerance,
        result.iterations,
        details,
    )


class TrescaSequence(LimitAnalysisFamily):
    """Sequence of programmes with the friction bound of the previous iterate: a baseline (`la-tresca`)."""

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The sequence from the associated solution; its fixed point is a collapse state, not the least one."""
        associated = solve_associated(problem, newton)
        if associated.outcome == "unbounded":
            return unbounded_answer("Statically the live load can grow without limit, so the sequence diverges.")
        if associated.state is None:
            return not_converged(f"The associated programme that starts the sequence ended as {associated.outcome}.")
        result = tresca_sequence(
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


class FromFiniteElements(LimitAnalysisFamily):
    """Ray descent from the finite-element collapse state, against a cold start (`la-from-fe`)."""

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """FE forces projected onto equilibrium and yield, nearest mechanism, descent; and the same from cold."""
        given = _finite_element_answer(assembly, settings.fe_method)
        if given.finding is not Finding.COLLAPSES or given.forces is None or given.multiplier is None:
            return _without_start(given)
        forces, _, projected = project_forces(
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
