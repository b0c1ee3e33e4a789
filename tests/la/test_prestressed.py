"""Collapse states at the ends of paths from safe forces, on walls small enough to know their order."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

import pytest

from benchmarks.walls import drawn, irregular_wall
from harness.model.assembly import Assembly
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import make_problem
from methods.la.core.state import CollapseState, polished, residuals
from methods.la.search import LimitAnalysis
from methods.la.settings import SearchSettings
from methods.la.sources import SOURCES, Source, explore
from methods.la.sources.budget import Budget, SearchLimits
from methods.la.sources.search import Search
from methods.la.sources.springs import AnalyticCentre, CommittedHistories, LowPrestress, ShiftedAssociated
from tests.la.bodies import block_on_halves, running_bond
from tests.walls import assembly
from tests.walls import running_bond as bond

WALLS = {
    "block of the paper": block_on_halves(),
    "21 bricks": running_bond(6, 3, 0.2, 0.65),
    "55 bricks": running_bond(10, 5, 0.175, 0.65),
    "105 bricks": running_bond(14, 7, 0.175, 0.4),
}


def search_of(wall: Assembly, breakpoints: int) -> Search:
    """With a budget of breakpoints, and the greatest multiplier known."""
    problem = make_problem(wall)
    search = Search(problem, NewtonMatrix(problem), budget=Budget(SearchLimits(breakpoints=breakpoints)))
    search.solve_associated()
    return search


def states_of(source: Source, search: Search) -> Iterator[CollapseState]:
    """What a source leads to, noted as a search does."""
    for state in source.states(search):
        search.note(state)
        yield state


def assert_exact_within_statics(search: Search, state: CollapseState) -> None:
    assert max(residuals(search.problem, polished(search.problem, search.newton, state)).values()) <= 1e-12
    assert 0.0 <= state.multiplier <= search.associated.greatest * (1.0 + 1e-9)


@pytest.mark.parametrize(
    "wall",
    [pytest.param(wall, marks=[pytest.mark.slow] * (name == "105 bricks"), id=name) for name, wall in WALLS.items()],
)
@pytest.mark.parametrize("source", [AnalyticCentre(), ShiftedAssociated()], ids=["central", "safe"])
def test_safe_forces_lead_to_an_exact_state_between_the_least_known_and_the_greatest(
    source: Source, wall: Assembly
) -> None:
    search = search_of(wall, 1)
    state = next(states_of(source, search))
    assert_exact_within_statics(search, state)
    least = LimitAnalysis().solve(wall, SearchSettings(effort="quick")).multiplier
    assert least is not None
    assert state.multiplier * search.problem.unit_multiplier >= least * (1.0 - 1e-9)


@pytest.mark.parametrize(
    "wall", [irregular_wall(7, 5, 4, 0.8), irregular_wall(27, 4, 4, 0.8)], ids=["five columns", "four columns"]
)
def test_forces_with_little_self_stress_lead_to_exact_states_within_statics(wall: Assembly) -> None:
    search = search_of(wall, 1000)
    states = list(states_of(LowPrestress(), search))
    assert len(states) > 3
    assert len({round(state.multiplier, 9) for state in states}) > 1
    for state in states:
        assert_exact_within_statics(search, state)


@pytest.mark.parametrize("strength", [{"cohesion": 1.0}, {"cohesion": 1.0, "tensile_strength": 1.0}])
def test_joints_with_strength_are_followed_from_gravity_alone_on_large_walls_too(strength: dict[str, float]) -> None:
    wall = assembly(bond(3, 2), 0.6, **strength)
    search = search_of(wall, 12000)
    source = LowPrestress(one_path=wall.n_interfaces - 1)
    (state,) = states_of(source, search)
    assert_exact_within_statics(search, state)


@pytest.mark.slow
def test_mixtures_of_forces_lead_below_gravity_on_a_wall_of_hundreds_of_joints() -> None:
    # One committed history of 2,460 breakpoints may run in a loop, as rounding has it, and leave less for the mixtures.
    search = search_of(irregular_wall(5003, 9, 10, 1.13), 12000 + 2460)
    gravity, *others = states_of(LowPrestress(), search)
    lowest = min(others[len(CommittedHistories().ratios) :], key=lambda state: state.multiplier)
    assert lowest.multiplier < 0.9 * gravity.multiplier
    assert_exact_within_statics(search, lowest)


def test_committed_histories_lead_below_the_wall_without_history() -> None:
    """As `fe`'s histories do on walls of irregular blocks."""
    search = search_of(irregular_wall(5003, 9, 10, 1.13), 12000)
    count = 1 + len(CommittedHistories().ratios)
    gravity, *committed = islice(states_of(LowPrestress(), search), count)
    assert min(state.multiplier for state in committed) < 0.95 * gravity.multiplier
    for state in committed:
        assert_exact_within_statics(search, state)


def test_paths_of_springs_stop_where_the_breakpoints_are_spent() -> None:
    """All sources draw from one budget: what one has spent the next does not have."""
    search = search_of(irregular_wall(7, 5, 4, 0.8), 500)
    first = list(states_of(LowPrestress(), search))
    spent = search.budget.spent.breakpoints
    assert len(first) > 1
    assert spent >= 500
    assert not list(states_of(LowPrestress(), search))
    assert search.budget.spent.breakpoints == spent


def test_wall_to_which_nothing_else_leads_gets_its_state_from_central_forces() -> None:
    search = search_of(irregular_wall(5003, 9, 10, 1.13), 5000)
    explore(search, [source for source in SOURCES if source.name == AnalyticCentre.name])
    assert len(search.record.states) > 3
    for state in search.record.states:
        assert_exact_within_statics(search, state)


@pytest.mark.slow
def test_state_at_a_negative_multiplier_is_no_answer() -> None:
    """Statics lets this wall stand up to .0042, but the mechanism with lagged friction bounds has -.0052."""
    answer = LimitAnalysis().solve(drawn(53, 9, 16), SearchSettings(effort="quick"))
    assert answer.multiplier is None or answer.multiplier >= 0.0
    assert answer.details["falls_without_self_stress"]
