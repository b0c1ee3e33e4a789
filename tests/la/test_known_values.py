"""Limit analysis reaches the values that are known: closed forms, exact fractions, figures of the literature."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from harness.model.build import build
from harness.model.method import Answer, Finding, Status
from harness.model.wall import Wall
from methods.la.associated import AssociatedLimitAnalysis, AssociatedLimitAnalysisCvxpy
from methods.la.literature.paper_programme import PaperProgramme
from methods.la.literature.tresca import TrescaSequence
from methods.la.search import LimitAnalysis
from methods.la.settings import (
    AssociatedSettings,
    CvxpySettings,
    PaperSettings,
    SearchSettings,
    TrescaSettings,
)
from tests.la.bodies import block_on_halves, column, running_bond

STATES = Path(__file__).parents[1] / "data" / "least-states"


def least(wall: object, **settings: object) -> Answer:
    return LimitAnalysis().solve(wall, SearchSettings(**settings))  # type: ignore[arg-type]


def test_single_block_of_the_paper_has_both_of_its_multipliers() -> None:
    # Closed forms of the paper: 0.4 by sliding on the weaker half alone, 0.6/1.1 by dilatant sliding.
    assert least(block_on_halves()).multiplier == pytest.approx(0.4, abs=1e-12)
    associated = AssociatedLimitAnalysis().solve(block_on_halves(), AssociatedSettings())
    assert associated.multiplier == pytest.approx(0.6 / 1.1, abs=1e-12)


@pytest.mark.parametrize(
    ("friction", "associated", "fraction"),
    [
        (0.4, 0.4, (2, 5)),
        (0.65, 0.584461, (1567589759, 2809311829)),
        (0.75, 0.622318, (84797, 153631)),
        (0.85, 0.690766, (3165869, 5889025)),
        (1.0, 0.979073, (307, 575)),
    ],
)
def test_wall_of_21_bricks_reaches_the_least_state_known_and_confirms_it_in_fractions(
    friction: float, associated: float, fraction: tuple[int, int]
) -> None:
    answer = least(running_bond(6, 3, 0.2, friction))
    assert answer.status is Status.OK
    assert answer.multiplier is not None
    assert answer.multiplier <= fraction[0] / fraction[1] + 1e-12
    assert answer.details["associated"] == pytest.approx(associated, abs=1e-6)
    confirmation = answer.details["rational_confirmation"]
    assert confirmation["confirmed"]
    assert confirmation["value"] == pytest.approx(answer.multiplier, abs=1e-12)


@pytest.mark.parametrize(
    ("courses", "bricks", "associated", "known"),
    [(6, 5, 0.642859, 0.6389819), (10, 5, 0.579999, 0.5574160), (14, 7, 0.540900, 0.5156316)],
)
def test_larger_walls_reach_the_values_of_the_prototypes_quickly(
    courses: int, bricks: int, associated: float, known: float
) -> None:
    answer = least(running_bond(courses, bricks, 0.175, 0.65), effort="quick")
    assert answer.multiplier is not None
    assert answer.multiplier <= known
    assert answer.details["associated"] == pytest.approx(associated, abs=1e-6)


@pytest.mark.parametrize(("name", "known"), [("rectangles-27", 0.5440655833), ("rectangles-31", 0.6063371891)])
def test_search_reaches_states_whose_mechanism_carries_less_by_other_forces(name: str, known: float) -> None:
    """Walls of 23 and 26 rectangles; both states were found by mechanisms from another friction, not by this search."""
    wall = build(Wall.model_validate_json((STATES / f"{name}.json").read_text())).assembly
    answer = least(wall)
    assert answer.multiplier is not None
    assert answer.multiplier <= known + 1e-10  # the digits that are recorded


def test_residuals_after_polish_are_rounding() -> None:
    answer = least(running_bond(10, 5, 0.175, 0.65), effort="quick")
    assert max(answer.details["residuals"].values()) <= 1e-12


def test_associated_programme_agrees_between_simplex_interior_point_and_cvxpy() -> None:
    wall = running_bond(10, 5, 0.175, 0.65)
    values = [
        AssociatedLimitAnalysis().solve(wall, AssociatedSettings(solver=solver)) for solver in ("highs", "interior")
    ]
    values.append(AssociatedLimitAnalysisCvxpy().solve(wall, CvxpySettings()))
    multipliers = [answer.multiplier for answer in values]
    assert all(value is not None for value in multipliers)
    assert np.ptp(np.array(multipliers, dtype=float)) <= 1e-9


def test_programme_of_the_paper_has_its_281_unknowns_and_ends_at_a_collapse_state() -> None:
    answer = PaperProgramme().solve(running_bond(6, 3, 0.2, 0.65), PaperSettings())
    assert answer.details["unknowns"] == 281
    assert answer.status is Status.OK
    assert answer.multiplier is not None
    assert 0.5579977 <= answer.multiplier <= 0.584462


def test_programme_of_the_paper_refuses_more_blocks_than_it_can_be_trusted_with() -> None:
    answer = PaperProgramme().solve(running_bond(10, 5, 0.175, 0.65), PaperSettings())
    assert answer.status is Status.REFUSED


def test_friction_bound_sequence_stalls_above_the_least_value() -> None:
    answer = TrescaSequence().solve(running_bond(6, 3, 0.2, 0.75), TrescaSettings())
    assert answer.multiplier == pytest.approx(0.565217, abs=1e-6)


@pytest.mark.parametrize(("friction", "expected"), [(0.25, 0.25), (0.7, 0.3)])
def test_column_slides_or_rocks(friction: float, expected: float) -> None:
    wall = column([0.3] * 5, [0.2] * 5, friction)
    assert least(wall).multiplier == pytest.approx(expected, abs=1e-12)


def test_frictionless_wall_slides_at_once() -> None:
    answer = least(column([0.3, 0.3], [0.2, 0.2], 0.0))
    assert (answer.finding, answer.multiplier) == (Finding.AT_LIMIT, 0.0)


def test_very_large_friction_leaves_only_rocking() -> None:
    answer = least(column([0.3, 0.5], [0.2, 0.4], 1e5))
    # The upper block rocks about its end of the joint, 0.15 from its axis, with its centroid 0.2 above.
    assert answer.multiplier == pytest.approx(min(0.15 / 0.2, (0.15 * 0.26) / (0.06 * 0.1 + 0.2 * 0.4)), rel=1e-9)
