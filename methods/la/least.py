"""The run of `la`: starts, descents, restarts and continuation in order, and the answer they lead to."""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.model.method import Answer
from methods.la.answers import collapse_answer, not_converged, unbounded_answer
from methods.la.associated import AssociatedResult, solve_associated
from methods.la.newton_matrix import NewtonMatrix
from methods.la.problem import Problem
from methods.la.search import Effort, Search
from methods.la.settings import SearchSettings
from methods.la.state import CollapseState, polished

STARTS = {"quick": 0, "normal": 3, "deep": 40}
FAILURES = {"quick": 8, "normal": 20, "deep": 60}


def least_known(problem: Problem, settings: SearchSettings, tolerance: float) -> Answer:
    """The answer with the least collapse state that the search finds.

    Args:
        problem: the scaled wall, which stands under its dead load and has a live load.
        settings: effort and seed.
        tolerance: largest residual of a state that is returned.
    """
    newton = NewtonMatrix(problem)
    associated = solve_associated(problem, newton)
    search = Search(problem, newton, settings.seed)
    starts = STARTS[settings.effort] if settings.starts is None else settings.starts
    effort = Effort(failures=settings.failures or FAILURES[settings.effort])
    found: list[CollapseState] = []
    for state in _starting_states(search, associated, starts):
        found.append(search.descend(state, effort))
    if not found:
        return _nothing_found(search, associated)
    best = polished(problem, newton, min(found, key=lambda state: state.multiplier))
    return _answer(problem, search, best, found, associated, tolerance)


def _starting_states(search: Search, associated: AssociatedResult, starts: int) -> list[CollapseState]:
    states = [search.interior()]
    if associated.state is not None:
        states.append(search.nearest_mechanism(associated.state.forces))
    states += [search.interior(spread=2.0) for _ in range(starts)]
    return [state for state in states if state is not None]


def _nothing_found(search: Search, associated: AssociatedResult) -> Answer:
    shape = (search.problem.n_interfaces, 4)
    if search.kinematic.solve(np.ones(shape, dtype=bool), np.ones(shape)) is None:
        return unbounded_answer("No mechanism lets the live load do work: it cannot make the wall collapse.")
    if associated.outcome == "unbounded":
        return unbounded_answer(
            "Statics allows any live load, and the search found no collapse state under zero dilatancy either."
        )
    return not_converged("The search found no collapse state.", search.newton_steps)


def _answer(
    problem: Problem,
    search: Search,
    best: CollapseState,
    found: list[CollapseState],
    associated: AssociatedResult,
    tolerance: float,
) -> Answer:
    unit = problem.unit_multiplier
    values = [state.multiplier * unit for state in found]
    agreeing = sum(value <= best.multiplier * unit * (1.0 + 1e-7) + 1e-12 for value in values)
    details: dict[str, Any] = {
        "starts": len(values),
        "starts_agree": agreeing == len(values),
        "starts_at_least_known": agreeing,
        "start_values": values,
        "newton_steps": search.newton_steps,
        "programmes": search.programmes,
        "unknowns": 7 * problem.n_interfaces + problem.n_velocities + 1,
    }
    if associated.state is not None:
        details["associated"] = associated.state.multiplier * unit
    return collapse_answer(
        problem,
        best,
        f"The least collapse multiplier known is {best.multiplier * unit:.7g}; {agreeing} of {len(values)} starts "
        "lead to it. It is not proved to be the minimum.",
        tolerance,
        search.newton_steps,
        details,
    )
