"""The lower bound is never above a collapse state, and meets the least one where that is known."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.bounds import small_wall
from drystone.certificates import read_certificate, write_certificate
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.wall import Wall
from methods.la.bounds import BoundedLimitAnalysis
from methods.la.certify.window_certificate import certificate_of, certified_bracket, certifier_of, equations_of
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.find_certificate import certificate
from methods.la.search import LimitAnalysis
from methods.la.settings import BoundSettings, SearchSettings
from methods.la.sources.budget import SearchLimits
from methods.la.sources.paths import OtherWeights
from methods.la.sources.search import Search
from methods.proof.search.bracket import bracket
from methods.proof.search.relaxation import Relaxation
from methods.proof.search.slack_bounds import SlackProgramme
from methods.proof.search.subproblem import Subproblem
from methods.proof.search.window_search import Bracket, Stop
from methods.proof.verify import document as documents
from methods.proof.verify.checker import verify
from methods.proof.verify.document import FORMAT
from tests.bound.by_cases import in_cases
from tests.enumeration import least_by_enumeration
from tests.la.bodies import column, running_bond
from tests.walls import assembly, wall_data


def in_windows(problem: Problem, upper: float, seconds: float) -> Bracket:
    """The bracket of windows first, as the product makes it."""
    return bracket(equations_of(problem), upper, seconds)


@pytest.mark.parametrize("bracketed", [in_windows, in_cases])
@settings(max_examples=8, deadline=None, derandomize=True)
@given(
    st.lists(st.tuples(st.floats(0.2, 1.5), st.floats(0.1, 1.0)), min_size=1, max_size=2),
    st.floats(0.1, 1.5),
    st.floats(1.0, 1.3),
)
def test_the_bound_passes_no_mechanism_of_all(
    bracketed: Callable[[Problem, float, float], Bracket],
    blocks: list[tuple[float, float]],
    friction: float,
    above: float,
) -> None:
    wall = column([width for width, _ in blocks], [height for _, height in blocks], friction)
    problem = make_problem(wall)
    least = least_by_enumeration(wall) / problem.unit_multiplier
    found = bracketed(problem, above * least, 0.3)
    # Enumeration and bound both come from linear programmes with tolerances of 1e-7 and less.
    assert found.lower <= least * (1.0 + 1e-6)


IRREGULAR = 0.20764497636585685
"""Least multiplier of the irregular wall of seed 10, at which windows alone stall .2 % below."""


@pytest.mark.slow
def test_cases_close_the_bracket_of_an_irregular_wall() -> None:
    problem = make_problem(small_wall(10))
    found = in_cases(problem, IRREGULAR / problem.unit_multiplier, 60.0)
    assert found.closed
    assert found.branches > 0


def test_no_case_loses_a_state() -> None:
    # From an upper end that is no state, a bound that lost the state in one of the cases would pass it.
    problem = make_problem(small_wall(10))
    least = IRREGULAR / problem.unit_multiplier
    found = in_cases(problem, 1.05 * least, 3.0)
    assert found.branches > 0
    assert found.lower <= least * (1.0 + 1e-6)


@pytest.mark.parametrize(
    ("courses", "bricks", "least"),
    [(2, 2, 0.65), pytest.param(3, 2, 7 / 11, marks=pytest.mark.slow), pytest.param(4, 2, 0.6, marks=pytest.mark.slow)],
)
def test_the_bracket_of_a_bonded_wall_closes(courses: int, bricks: int, least: float) -> None:
    settings = BoundSettings(bound_seconds=60.0, effort="quick")
    answer = BoundedLimitAnalysis().solve(running_bond(courses, bricks, 0.2, 0.65), settings)
    assert answer.multiplier == pytest.approx(least, rel=1e-9)
    assert answer.details["lower_bound"] == pytest.approx(least, rel=1e-6)  # CLOSED
    assert answer.details["lower_bound"] <= least * (1.0 + 1e-9)
    assert answer.details["certified_bound"] == pytest.approx(least, rel=1e-6)
    assert answer.sentence.startswith("The minimum collapse multiplier is")


def test_a_bound_cut_short_is_smaller_but_holds() -> None:
    problem = make_problem(running_bond(3, 3, 0.2, 0.65))
    bounds = [bracket(equations_of(problem), 7 / 11, seconds).lower for seconds in (1e-3, 0.5)]
    assert all(0.0 <= bound <= 7 / 11 for bound in bounds)
    assert bounds[0] < 7 / 11


@pytest.mark.parametrize("wall", [running_bond(2, 2, 0.2, 0.65), running_bond(3, 3, 0.2, 0.9)], ids=["2x2", "3x3"])
def test_products_of_collapse_states_satisfy_the_relaxation(wall: Assembly) -> None:
    """The relaxation must not cut off any collapse state, the least or not."""
    problem = make_problem(wall)
    search = Search(problem, NewtonMatrix(problem))
    equations = equations_of(problem)
    programme = SlackProgramme(equations)
    search.budget.limits = SearchLimits(starts=6)
    states = list(OtherWeights().states(search))
    assert states
    for state, share, limited in itertools.product(states, (0.0, 0.97), (0, 3)):
        low, high = share * state.multiplier, 1.01 * state.multiplier
        normal = state.forces.reshape(-1, 3)[:limited, :2].sum(axis=1)
        case = Subproblem(normal={p: (0.9 * force, 1.1 * force + 0.01) for p, force in enumerate(normal.tolist())})
        bounds = programme.bounds(low, high, case)
        assert bounds is not None
        relaxation = Relaxation(equations, low, high, bounds, case)
        rates = problem.rates_of_velocities(state.velocities, False)
        scale = equations.n_blocks / float(problem.live @ state.velocities)
        statics = np.concatenate([state.forces.ravel(), [state.multiplier, 1.0]])
        slip = (rates[:, 2] - rates[:, 3])[relaxation.unloadable]
        motion = scale * np.concatenate([state.velocities, rates.ravel()[relaxation.free], slip])
        rows = relaxation.rows @ (relaxation.statics.T @ statics) * relaxation.row_scale
        columns = relaxation.columns @ (relaxation.motions.T @ motion) * relaxation.column_scale
        products = np.outer(rows, columns)
        size = abs(products).max()
        assert rates.ravel()[bounds.least > 1e-6].max(initial=0.0) * scale <= 1e-8
        assert products[~np.isneginf(relaxation.lower)].size
        assert (relaxation.lower - products).max() <= 1e-8 * size
        assert (products - relaxation.upper).max() <= 1e-8 * size


def test_the_bound_of_a_wall_of_two_components_is_the_lesser_of_theirs() -> None:
    panel = {"type": "panel", "cell_length": 0.3, "cell_height": 1.0, "layout": ["A.B", "A.C", "GGG"], "fixed": "G"}
    wall = assembly(panel, 0.5)
    answer = BoundedLimitAnalysis().solve(wall, BoundSettings(bound_seconds=5.0))
    assert len(answer.details["components"]) == 2
    assert answer.multiplier is not None
    assert 0.0 < answer.details["lower_bound"] <= answer.multiplier * (1.0 + 1e-9)


def test_a_search_that_is_asked_for_a_bound_has_it_and_deep_ones_are() -> None:
    wall = running_bond(3, 2, 0.2, 0.65)
    assert not LimitAnalysis().solve(wall, SearchSettings()).details["proved_least"]
    asked = LimitAnalysis().solve(wall, SearchSettings(bound_seconds=30.0))
    assert asked.details["certified_bound"] == pytest.approx(7 / 11, rel=2e-6)
    assert "certificate" in asked.details
    assert SearchSettings().bound is None
    assert SearchSettings(effort="deep").bound == BoundSettings(bound_seconds=60.0)
    assert SearchSettings(effort="deep", bound_seconds=0.0).bound is None


def rectangle(x: float, y: float, width: float, height: float) -> list[list[float]]:
    return [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]


def test_what_is_proved_of_the_component_that_fails_is_not_said_of_a_wall_with_a_harder_one() -> None:
    """A column that rocks at .6 beside three courses of three bricks, whose 7/11 no search proves."""
    courses = [[(0.0, 0.2), (0.2, 0.4), (0.6, 0.4), (1.0, 0.2)], [(0.0, 0.4), (0.4, 0.4), (0.8, 0.4)]]
    blocks = [
        {"id": f"{row}-{x}", "polygon": rectangle(x, 0.2 * row, width, 0.2)}
        for row in range(3)
        for x, width in courses[row % 2]
    ]
    blocks.append({"id": "column", "polygon": rectangle(2.5, 0.0, 0.3, 0.5)})
    blocks.append({"id": "floor", "polygon": rectangle(-1.0, -0.2, 5.0, 0.2), "fixed": True})
    data = {name: value for name, value in wall_data({}).items() if name != "pattern"}
    wall = build(Wall.model_validate(data | {"blocks": blocks})).assembly
    alone = LimitAnalysis().solve(wall, SearchSettings())
    assert alone.multiplier == pytest.approx(0.6)
    assert len(alone.details["components"]) == 2
    assert not alone.details["proved_least"]
    assert alone.details["lower_bound"] == 0.0
    assert "of the whole wall nothing is proved" in alone.sentence
    both = BoundedLimitAnalysis().solve(wall, BoundSettings(bound_seconds=30.0))
    assert both.details["proved_least"]
    assert both.details["lower_bound"] == pytest.approx(0.6, rel=2e-6)  # the margin of the tree
    assert "certificate" not in both.details
    assert "The other components bear more, to rounding" in both.sentence


@pytest.mark.parametrize(
    ("limit", "most"),
    [("MOST_BYTES", 60_000), ("MOST_BYTES", 120_000), ("MOST_VALUES", 20_000)],
)
def test_the_search_ends_before_its_certificate_is_larger_than_is_checked(
    limit: str, most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = make_problem(small_wall(10))
    monkeypatch.setattr(documents, limit, most)
    found, document = certified_bracket(problem, IRREGULAR, np.zeros((12, 3)), 60.0)
    assert found.stopped is Stop.SPACE
    read = documents.read(json.dumps(document).encode())
    assert 0.0 < float(verify(read)[0]) <= found.lower * problem.unit_multiplier <= IRREGULAR


def test_the_search_ends_before_its_certificate_is_nested_deeper_than_is_read(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    problem = make_problem(small_wall(10))
    certifier, levels = certifier_of(problem), 14  # of two divisions
    monkeypatch.setattr("methods.proof.search.certifier.MOST_NESTED", levels)
    monkeypatch.setattr("drystone.certificates.MOST_NESTED", levels)
    found = in_cases(problem, IRREGULAR / problem.unit_multiplier, certify=certifier)
    assert 0 < found.branches <= 3
    assert not found.closed
    document = certificate_of(problem, IRREGULAR, np.zeros((12, 3)), certifier)
    assert document is not None
    write_certificate(tmp_path / "certificate.json", document)
    assert read_certificate(tmp_path / "certificate.json") == document


def test_a_certificate_of_many_divisions_is_read(tmp_path: Path) -> None:
    # Friction .85 needed more than 13 on 21 bricks: what was written was refused as nested too deeply.
    node: dict[str, Any] = {"steps": []}
    for _ in range(150):
        node = {"contact": 0, "parts": [node, {"steps": []}], "steps": []}
    document = {"format": FORMAT, "windows": [], "cases": node}
    write_certificate(tmp_path / "certificate.json", document)
    assert read_certificate(tmp_path / "certificate.json") == document


@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.parametrize(("limit", "most"), [("MOST_OBJECTS", 150), ("MOST_VALUES", 60_000), ("MOST_BYTES", 400_000)])
def test_a_search_that_divides_its_states_ends_before_its_certificate_is_larger_than_is_checked(
    jobs: int, limit: str, most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Divisions and the wall itself hold objects as well: they were not counted.
    problem = make_problem(small_wall(10))
    monkeypatch.setattr(documents, limit, most)
    certifier = certifier_of(problem)
    found = in_cases(problem, IRREGULAR / problem.unit_multiplier, certify=certifier, jobs=jobs)
    assert found.branches > 0
    assert not found.closed
    document = certificate_of(problem, IRREGULAR, np.zeros((12, 3)), certifier)
    assert document is not None
    assert verify(documents.read(documents.written(document).encode()))[0] > 0


def test_a_certificate_of_a_tree_is_as_large_as_it_is_written(monkeypatch: pytest.MonkeyPatch) -> None:
    # It was measured on one line, and written on a line for each number.
    wall = column([0.5, 0.4, 0.6], [0.3, 0.5, 0.2], 0.55)
    document = certificate(wall)
    assert document is not None
    monkeypatch.setattr(documents, "MOST_BYTES", len(documents.written(document)))
    assert certificate(wall) == document
    monkeypatch.setattr(documents, "MOST_BYTES", len(documents.written(document)) - 1)
    assert certificate(wall) is None
