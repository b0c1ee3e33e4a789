"""Collapse states at the ends of paths from safe forces, on walls small enough to know their order."""

from __future__ import annotations

from itertools import islice

import numpy as np
import pytest

from harness.model.assembly import Assembly
from methods.la.adapter import LimitAnalysis
from methods.la.associated import solve_associated
from methods.la.irregular_walls import drawn, irregular_wall
from methods.la.newton_matrix import NewtonMatrix
from methods.la.prestressed import COMMITTED, gravity_of, last_states, light_states
from methods.la.problem import make_problem
from methods.la.search import Search
from methods.la.settings import SearchSettings
from methods.la.state import polished, residuals
from tests.la.bodies import block_on_halves, running_bond

WALLS = {
    "block of the paper": block_on_halves(),
    "21 bricks": running_bond(6, 3, 0.2, 0.65),
    "55 bricks": running_bond(10, 5, 0.175, 0.65),
    "210 bricks": running_bond(20, 10, 0.175, 0.4),
}


@pytest.mark.parametrize("wall", WALLS.values(), ids=WALLS)
def test_safe_forces_lead_to_an_exact_state_between_the_least_known_and_the_greatest(wall: Assembly) -> None:
    problem = make_problem(wall)
    newton = NewtonMatrix(problem)
    state = next(last_states(Search(problem, newton), np.inf, 1))
    assert max(residuals(problem, polished(problem, newton, state)).values()) <= 1e-12
    associated = solve_associated(problem, newton).state
    assert associated is not None
    assert state.multiplier <= associated.multiplier * (1.0 + 1e-9)
    least = LimitAnalysis().solve(wall, SearchSettings(effort="quick")).multiplier
    assert least is not None
    assert state.multiplier * problem.unit_multiplier >= least * (1.0 - 1e-9)


@pytest.mark.parametrize(
    "wall", [WALLS["21 bricks"], irregular_wall(27, 4, 4, 0.8)], ids=["bricks", "irregular blocks"]
)
def test_forces_with_little_self_stress_lead_to_exact_states_within_statics(wall: Assembly) -> None:
    problem = make_problem(wall)
    newton = NewtonMatrix(problem)
    states = list(light_states(Search(problem, newton), gravity_of(problem), 1000))
    associated = solve_associated(problem, newton).state
    assert associated is not None
    assert len(states) > 3
    assert len({round(state.multiplier, 9) for state in states}) > 1
    for state in states:
        assert max(residuals(problem, polished(problem, newton, state)).values()) <= 1e-12
        assert 0.0 <= state.multiplier <= associated.multiplier * (1.0 + 1e-9)


def test_mixtures_of_forces_lead_below_gravity_on_a_wall_of_hundreds_of_joints() -> None:
    problem = make_problem(irregular_wall(5003, 9, 10, 1.13))
    newton = NewtonMatrix(problem)
    # One committed history of 2,460 kinks may run in a loop, as rounding has it, and leave less for the mixtures.
    gravity, *others = light_states(Search(problem, newton), gravity_of(problem), 12000 + 2460)
    lowest = min(others[len(COMMITTED) :], key=lambda state: state.multiplier)
    assert lowest.multiplier < 0.9 * gravity.multiplier
    assert max(residuals(problem, polished(problem, newton, lowest)).values()) <= 1e-12


def test_committed_histories_lead_below_the_wall_without_history() -> None:
    """As `fe`'s histories do on walls of irregular blocks."""
    problem = make_problem(irregular_wall(5003, 9, 10, 1.13))
    newton = NewtonMatrix(problem)
    gravity, *committed = islice(light_states(Search(problem, newton), gravity_of(problem), 12000), 1 + len(COMMITTED))
    assert min(state.multiplier for state in committed) < 0.95 * gravity.multiplier
    for state in committed:
        assert max(residuals(problem, polished(problem, newton, state)).values()) <= 1e-12


def test_last_resort_leads_to_exact_states_within_statics() -> None:
    problem = make_problem(irregular_wall(5003, 9, 10, 1.13))
    newton = NewtonMatrix(problem)
    greatest = solve_associated(problem, newton).greatest
    states = list(last_states(Search(problem, newton), greatest, 5000))
    assert len(states) > 3
    for state in states:
        assert max(residuals(problem, polished(problem, newton, state)).values()) <= 1e-12
        assert 0.0 <= state.multiplier <= greatest * (1.0 + 1e-9)


def test_wall_whose_central_paths_lead_nowhere_gets_its_state_from_the_springs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Here those of a small wall, which are left out."""
    monkeypatch.setattr("methods.la.least.SIMPLEX_SEARCH", 100)
    monkeypatch.setattr("methods.la.least.LIGHT_UP_TO", 100)
    monkeypatch.setattr("methods.la.large.MOST_INTERFACES", 100)
    monkeypatch.setattr("methods.la.large.LEADS", ())
    monkeypatch.setattr("methods.la.large.FAR_LEADS", ())
    answer = LimitAnalysis().solve(WALLS["210 bricks"], SearchSettings())
    assert answer.multiplier is not None
    assert answer.details["kinks"] > 0
    # The bound is tight here, and both numbers are rounded.
    assert answer.multiplier <= answer.details["associated"] * (1.0 + 1e-12)
    assert max(answer.details["residuals"].values()) <= 1e-12


def test_state_at_a_negative_multiplier_is_no_answer() -> None:
    """Statics lets this wall stand up to .0042, but the mechanism with lagged friction bounds has -.0052."""
    answer = LimitAnalysis().solve(drawn(53, 9, 16), SearchSettings(effort="quick"))
    assert answer.multiplier is None or answer.multiplier >= 0.0
    assert answer.details["falls_without_self_stress"]
