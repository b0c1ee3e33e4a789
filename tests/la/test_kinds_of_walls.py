"""Limit analysis on walls of other kinds than brickwork: arches, openings, cut joints, and starts from FE."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import pytest

from cases.families import wall_21
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.case import read_case
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from harness.model.wall import Wall
from methods.la.associated import AssociatedLimitAnalysis
from methods.la.literature.cooperation import FromFiniteElements
from methods.la.search import LimitAnalysis
from methods.la.settings import AssociatedSettings, FromFeSettings, SearchSettings
from tests.la.bodies import column, running_bond
from tests.walls import assembly, stack, wedge

CASES = Path(__file__).parents[2] / "cases"


@pytest.mark.parametrize("pull", [1.0, -1.0])
def test_a_block_on_a_slope_that_is_pulled_off_its_plane_slides_without_work_of_the_live_load(pull: float):
    """It slides at cos(a) - sin(a) / mu, without work; where it is pressed onto its plane nothing moves it."""
    slope, friction = math.atan(0.3), 0.4
    c, s = math.cos(slope), math.sin(slope)

    def turned(*points: tuple[float, float]) -> list[list[float]]:
        return [[c * x - s * y, s * x + c * y] for x, y in points]

    plane = {"id": "plane", "polygon": turned((-1, -1), (2, -1), (2, 0), (-1, 0)), "fixed": True}
    block = {"id": "block", "polygon": turned((0, 0), (1, 0), (1, 0.2), (0, 0.2)), "weight": 1.0}
    away = {"block": "block", "at": turned((0.5, 0.1))[0], "force": turned((0.0, pull))[0]}
    data = {"format": "wall/1", "friction": friction, "blocks": [plane, block], "loads": {"live": {"points": [away]}}}
    wall = build(Wall.model_validate(data)).assembly
    answers = {name: load_method(name).solve(wall, load_method(name).Settings()) for name in ("la", "fe", "de")}
    greatest = load_method("la-associated").solve(wall, AssociatedSettings())
    if pull < 0.0:
        assert {each.finding for each in (*answers.values(), greatest)} == {Finding.UNBOUNDED}
        return
    assert greatest.multiplier == pytest.approx(c - s / friction, rel=1e-12)
    assert answers["de"].bracket == pytest.approx((c - s / friction,) * 2, abs=1e-4)
    assert {answers[name].finding for name in ("la", "fe")} == {Finding.NONE}
    assert "above 0.2394566 no equilibrium within yield exists, so the wall moves there" in answers["la"].sentence
    assert "at 0.2394566 times the live load the wall moves by a mechanism on which that does no work" in (
        answers["fe"].sentence
    )


def wall_of(case: str) -> Assembly:
    return read_case(CASES / case).assembly


@pytest.mark.parametrize("case", ["borri-arch-13", "opening-lintel", "column-point-push", "irregular-wall"])
def test_least_state_known_is_exact_and_never_above_the_greatest_multiplier(case: str) -> None:
    wall = wall_of(case)
    answer = LimitAnalysis().solve(wall, SearchSettings(effort="quick"))
    greatest = AssociatedLimitAnalysis().solve(wall, AssociatedSettings()).multiplier
    assert answer.finding is Finding.COLLAPSES
    assert answer.multiplier is not None
    assert greatest is not None
    assert answer.multiplier <= greatest * (1.0 + 1e-9)
    assert max(answer.details["residuals"].values()) <= 1e-11
    assert ("excludes lower ones" in answer.sentence) is answer.details["proved_least"]


def test_joints_cut_into_several_interfaces_give_the_multiplier_of_whole_joints() -> None:
    # Contact at both ends of a joint decides rocking and sliding, so cuts between add no strength and take none.
    sizes = ([0.3, 0.4, 0.3], [0.2, 0.2, 0.2])
    whole, cut = (
        LimitAnalysis().solve(column(*sizes, 0.45, halves), SearchSettings(effort="quick")) for halves in (1, 3)
    )
    assert cut.multiplier == pytest.approx(whole.multiplier, rel=1e-9)


def test_wall_that_stands_by_self_stress_alone_is_said_to() -> None:
    answer = LimitAnalysis().solve(build(Wall.model_validate(wedge())).assembly, SearchSettings())
    assert answer.multiplier == pytest.approx(0.0, abs=1e-12)
    assert answer.details["falls_without_self_stress"] == ["M"]
    assert "self-stress" in answer.sentence


@pytest.mark.parametrize("case", ["ferris-tin-loi-4-inset", "ferris-tin-loi-2-inset", "running-bond-overturns"])
def test_start_from_finite_elements_never_answers_above_their_plateau(case: str) -> None:
    answer = FromFiniteElements().solve(wall_of(case), FromFeSettings())
    assert answer.status is Status.OK
    assert answer.multiplier is not None
    assert answer.multiplier <= answer.details["fe_multiplier"] * (1.0 + 1e-9)


@pytest.mark.parametrize("name", ["la-from-fe", "la-tresca"])
def test_load_that_presses_the_wall_on_its_base_is_unbounded_without_a_state_to_start_from(name: str) -> None:
    method = load_method(name)
    pressed = assembly(stack(3), loads={"live": {"body": [{"per_weight": [0, -1]}]}})
    answer = method.solve(pressed, method.Settings())
    assert (answer.status, answer.finding) == (Status.OK, Finding.UNBOUNDED)


def test_wall_on_which_newtons_path_finds_nothing_is_solved_with_lagged_friction_bounds() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        answer = LimitAnalysis().solve(wall_of("ferris-tin-loi-2-inset"), SearchSettings())
    assert answer.multiplier is not None
    # The finite elements reach the same state by their own way.
    assert answer.multiplier <= 0.5244053414388556 + 1e-9


def test_blocks_that_move_together_are_joined_where_that_bears_less() -> None:
    answer = LimitAnalysis().solve(wall_of("ferris-tin-loi-4-inset"), SearchSettings())
    # The finite elements collapse with one rigid body of 18 blocks at 16/65; descent alone stays above.
    assert answer.multiplier is not None
    assert answer.multiplier <= 16 / 65 + 1e-9


@pytest.mark.parametrize(("proportion", "friction", "plateau"), [(3.0, 1.1, 0.8478261), (4.0, 1.2, 1.1304348)])
def test_wide_bricks_at_high_friction_are_no_longer_left_above_the_plateau_of_fe(
    proportion: float, friction: float, plateau: float
) -> None:
    answer = LimitAnalysis().solve(build(wall_21(proportion, friction)).assembly, SearchSettings(effort="quick"))
    assert answer.multiplier is not None
    assert answer.multiplier <= plateau + 1e-6


@pytest.mark.parametrize(
    ("courses", "bricks", "height", "plateau"), [(6, 2, 0.2, 31 / 65), (6, 3, 0.2, 13 / 23), (10, 5, 0.175, 8 / 13)]
)
def test_very_rough_walls_are_not_left_at_states_of_self_stress(
    courses: int, bricks: int, height: float, plateau: float
) -> None:
    # Blocks that only rock collapse alike at any higher friction; finite elements give these plateaus.
    answer = LimitAnalysis().solve(running_bond(courses, bricks, height, 10.0), SearchSettings())
    assert answer.multiplier is not None
    assert answer.multiplier <= plateau + 1e-9
    assert max(answer.details["residuals"].values()) <= 1e-11


@pytest.mark.slow
def test_forces_of_a_lower_friction_lead_to_a_mechanism_where_none_is_carried() -> None:
    """The wall holds .6267281 at friction 1.5 and 2.25 too, so that it rocks; cold starts end at 1.584."""
    answer = LimitAnalysis().solve(running_bond(10, 8, 0.175, 3.0), SearchSettings())
    assert answer.multiplier is not None
    assert answer.multiplier <= 0.6267282


@pytest.mark.parametrize(("courses", "bricks"), [(6, 3), pytest.param(16, 9, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["la", "la-associated"])
def test_wall_without_friction_bears_exactly_nothing(name: str, courses: int, bricks: int) -> None:
    method = load_method(name)
    answer = method.solve(running_bond(courses, bricks, 0.2, 0.0), method.Settings())
    assert answer.multiplier == 0.0
    assert " 0" in answer.sentence


def test_path_of_an_answer_is_the_least_known_over_search_time() -> None:
    answer = LimitAnalysis().solve(wall_of("wall-21-friction-085"), SearchSettings())
    seconds, multipliers = answer.path["cpu_seconds"], answer.path["multiplier"]
    assert len(seconds) == len(multipliers) > 1
    assert seconds[0] > 0.0
    assert sorted(seconds) == seconds
    assert sorted(multipliers, reverse=True) == multipliers
    assert multipliers[-1] == pytest.approx(answer.multiplier, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("courses", "bricks", "greatest", "known"),
    # Known: the figures of the prototypes, within 5e-5 for the first.
    [(20, 11, 0.503216, 0.48445), (28, 16, 0.474130, 0.4622), (40, 30, 0.452420, 0.4463), (60, 42, 0.437352, 0.43431)],
)
def test_walls_of_hundreds_of_blocks_reach_the_values_of_the_prototypes(
    courses: int, bricks: int, greatest: float, known: float
) -> None:
    answer = LimitAnalysis().solve(running_bond(courses, bricks, 0.175, 0.65), SearchSettings())
    assert answer.multiplier is not None
    assert answer.multiplier <= known
    assert answer.details["associated"] == pytest.approx(greatest, abs=2e-6)
    assert max(answer.details["residuals"].values()) <= 1e-11
