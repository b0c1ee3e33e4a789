"""The factor of safety on friction: closed forms, both ends judged, and what is said where there is no number."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from drystone.safety import FactorOfSafety, FactorSearch, ReducedWall, factor, factor_by
from drystone.walls import Wall
from harness.engine.judge import judge
from harness.model.errors import InputError
from harness.model.method import Finding, Status
from harness.model.result import Result
from tests import commands
from tests.walls import stack, wedge

EXACT = 1e-6
"""Relative width of the bracket that is asked for where a method is exact."""
EDGE = Path(__file__).parents[1] / "data" / "knife-edge"
UPRIGHT = drystone.new_wall("stack", count=3)


def sloped(degrees: float, friction: float, **more: Any) -> Wall:
    """A block of 1 x 0.2 m, unit weight 20, thickness 1, on a plane of this angle."""
    angle = math.radians(degrees)
    gravity = [-math.sin(angle), -math.cos(angle)]
    made = {"format": "wall/1", "unit_weight": 20, "friction": friction, "pattern": stack(1, 1.0, 0.2)}
    return drystone.build_wall({**made, "loads": {"gravity": gravity}, **more}, "sloped")


def pushed(friction: float) -> Wall:
    """A column on a level base, pushed sideways by a multiple of its weight."""
    return drystone.new_wall("stack", count=1, width=1.0, height=0.2, friction=friction)


@pytest.mark.parametrize("method", ["la", "la-associated", "fe"])
@pytest.mark.parametrize(("degrees", "friction"), [(20.0, 0.6), (20.0, 0.2), (33.0, 0.7)])
def test_a_block_on_a_plane_has_friction_over_slope(method: str, degrees: float, friction: float):
    found = factor(sloped(degrees, friction), method, accuracy=EXACT)
    exact = friction / math.tan(math.radians(degrees))
    assert found.value == pytest.approx(exact, rel=EXACT)
    assert found.lower <= exact * (1.0 + 1e-9)
    assert exact * (1.0 - 1e-9) <= found.upper <= exact * (1.0 + 10.0 * EXACT)


def test_distinct_elements_find_the_block_on_a_plane_to_the_accuracy_they_state():
    found = factor(sloped(20.0, 0.6), "de")
    assert found.lower <= 0.6 / math.tan(math.radians(20.0)) <= found.upper <= found.lower * 1.005
    assert found.fall_proved


def test_cohesion_is_divided_too():
    """F = (mu W cos a + c A) / (W sin a), W = 4 kN, A = 1 m2."""
    angle = math.radians(30.0)
    found = factor(sloped(30.0, 0.4, cohesion=1.0), accuracy=EXACT)
    assert found.value == pytest.approx((0.4 * 4.0 * math.cos(angle) + 1.0) / (4.0 * math.sin(angle)), rel=EXACT)


@pytest.mark.parametrize(
    ("more", "warned"),
    [
        ({}, False),
        ({"cohesion": 1.0}, True),
        ({"cohesion": 1.0, "tensile_strength": 1.0}, True),
        ({"cohesion": 1.0, "after": "residual"}, False),
    ],
    ids=["dry", "cohesion", "tension", "brittle"],
)
def test_strength_that_is_never_lost_is_warned_of(more: dict[str, Any], warned: bool):
    """In the object, in its JSON and in both results."""
    found = factor(sloped(30.0, 0.7, **more), accuracy=0.1)
    assert found.stands is not None
    assert found.falls is not None
    for warnings in (found.warnings, found.as_json()["warnings"], found.stands.warnings, found.falls.warnings):
        assert [sentence.split(" counts as plastic")[0] for sentence in warnings] == [
            "cohesion or tensile strength of 1 of 1 joints"
        ] * warned


def test_the_command_warns_of_strength_that_is_never_lost(tmp_path: Path):
    path = tmp_path / "slope.json"
    sloped(30.0, 0.7, cohesion=1.0).save(path)
    done = commands.drystone("factor", path, "--accuracy", "0.1", "--json")
    assert done.returncode == 0
    assert "of 1 of 1 joints counts as plastic" in done.stderr
    assert "counts as plastic" in json.loads(done.stdout)["warnings"][0]


def test_a_share_of_the_live_load_acts_beside_the_dead_load():
    """The block slides where its friction is the share of its weight that pushes."""
    found = factor(pushed(0.6), share=0.2, accuracy=EXACT)
    assert found.value == pytest.approx(3.0, rel=EXACT)
    assert math.isinf(factor(pushed(0.6)).lower)


def test_a_wall_just_below_its_limit_is_shown_to_fall_by_a_mechanism():
    """The 21-brick wall slides on one bed joint: F = .65 / .3, where forces have no vertex to rounding."""
    found = factor(drystone.library_wall("wall-21"), "la-associated", share=0.3)
    assert found.lower <= 0.65 / 0.3 <= found.upper <= found.lower * (1.0 + 1e-4)
    assert found.fall_proved
    assert not found.reason


def test_just_above_the_limit_a_mechanism_to_rounding_shows_the_fall():
    """Where forces have no vertex to rounding: in a band of 2e-6 of the factor before, now of less than 1e-7."""
    for wall in (drystone.read_wall(EDGE / "gb16-8500-l.json"), drystone.library_wall("heyman-arch-20-stands")):
        found = factor(wall, "la", accuracy=1e-7)
        assert found.upper <= found.lower * (1.0 + 1e-7)
        assert found.fall_proved
        assert not found.reason


def test_both_ends_are_judged_on_the_wall_of_their_factor():
    found = factor(sloped(20.0, 0.6), "fe")
    for end, at, finding in ((found.stands, found.lower, Finding.STANDS), (found.falls, found.upper, Finding.FALLS)):
        assert end is not None
        assert (end.finding, end.judge.accepted) == (finding, True)
        reduced = ReducedWall(found.wall.case, at).assembly
        np.testing.assert_allclose(reduced.friction, 0.6 / at, rtol=1e-15)
        assert judge(reduced, end, end.judge.tolerance).accepted
        assert (
            judge(ReducedWall(found.wall.case, 1.1 if end is found.falls else 2.0).assembly, end, 1e-9).accepted
            is False
        )


@pytest.mark.parametrize("method", ["la", "fe", "de"])
def test_a_stack_that_overturns_has_no_factor_whatever_its_friction(method: str):
    """Two blocks of 1 m lean out by 0.76 m, beyond 1/4 + 1/2: they fall by rotation alone."""
    leaning = {"type": "stack", "width": 1, "height": 0.25, "count": 2, "base": [-1, 0]}
    document = {"format": "wall/1", "unit_weight": 20, "friction": 0.5}
    wall = drystone.build_wall({**document, "pattern": leaning | {"offsets": [0.76 / 3 - 1, 0.76 - 1]}})
    found = factor(wall, method)
    assert found.value is None
    assert found.fall_proved
    assert found.upper == 2.0**-16
    assert "falls even with friction 65536 times as large" in found.sentence


@pytest.mark.parametrize("method", ["la", "la-associated", "fe", "de"])
def test_a_wall_that_stands_without_friction_has_an_infinite_factor(method: str):
    found = factor(UPRIGHT, method)
    assert found.value == math.inf
    assert found.stands is not None
    assert found.stands.judge.accepted
    assert (found.as_json()["infinite"], found.as_json()["factor"], found.as_json()["bracket"]) == (
        True,
        None,
        [None, None],
    )


def test_toppling_columns_depend_on_self_stress():
    """Goodman and Bray's recursion needs a friction of .7854 (1976); these columns have .7855."""
    wall = drystone.read_wall(EDGE / "gb16-7855-l.json")
    moved, greatest = factor(wall, "de"), factor(wall, "la")
    assert moved.value == pytest.approx(0.7855 / 0.7854, rel=5e-3)
    assert (moved.fall_proved, greatest.fall_proved) == (False, True)
    assert "that no equilibrium exists is not proved" in moved.sentence
    assert moved.upper < greatest.lower
    assert "ask fe and de too" in greatest.sentence


def test_a_block_wedged_between_supports_stands_by_self_stress_alone():
    wall = drystone.build_wall(wedge())
    assert factor(wall, "la").lower == 2.0**16
    assert factor(wall, "fe").value is None


def test_glue_holds_a_block_whose_fall_without_it_is_not_proved():
    """F = 2 c A / W = 1.5; without glue springs find a fall that self-stress could prevent, so that none is proved."""
    found = factor(drystone.build_wall(wedge() | {"cohesion": 15.0}), "fe")
    assert found.lower <= 1.5 * (1.0 + 1e-5)
    assert 1.5 <= found.upper <= 1.5002
    assert found.reason == ""


def test_a_search_that_stops_says_nothing_of_more_friction():
    search = FactorSearch(lambda at: made_up(at, 0.0, (0.0, 0.3), Status.NOT_CONVERGED))
    search.bracket(100.0)
    found = FactorOfSafety(UPRIGHT, "b", 0.0, 0.0, search.upper, None, search.falls, search.runs, search.reason)
    assert found.sentence.startswith("The wall falls with its friction divided by 0.5; no state was found that stands.")
    assert "At 0.25 the run decides nothing" in found.sentence


def made_up(at: float, limit: float, doubt: tuple[float, float], status: Status) -> Result:
    """The answer of a method that decides nothing between two factors."""
    if doubt[0] <= at <= doubt[1]:
        return Result(
            case="a",
            method="b",
            family="b",
            blocks=1,
            interfaces=1,
            status=status,
            finding=Finding.NONE,
            sentence="Why.",
        )
    finding = Finding.STANDS if at < limit else Finding.FALLS
    result = Result(
        case="a", method="b", family="b", blocks=1, interfaces=1, status=Status.OK, finding=finding, sentence="So."
    )
    return result.model_copy(update={"judge": result.judge.model_copy(update={"accepted": True})})


def test_the_ends_close_in_on_factors_that_decide_nothing():
    search = FactorSearch(lambda at: made_up(at, 1.2, (1.1, 1.25), Status.NOT_CONVERGED))
    search.bracket(100.0)
    search.bisect(EXACT)
    assert (search.lower, search.upper) == (pytest.approx(1.1, rel=EXACT), pytest.approx(1.25, rel=EXACT))
    assert search.reason.endswith("decides nothing: Why.")


def test_a_run_that_is_cut_off_ends_the_search():
    search = FactorSearch(lambda at: made_up(at, 1.2, (1.1, 1.5), Status.TIMEOUT))
    search.bracket(100.0)
    search.bisect(EXACT)
    assert (search.lower, search.upper, search.runs) == (1.0, 2.0, 4)


def test_a_run_without_friction_that_is_cut_off_is_called_so():
    search = FactorSearch(lambda at: made_up(at, 1.2, (1.1, math.inf), Status.TIMEOUT))
    search.bracket(100.0)
    assert (search.runs, search.reason) == (1, "Without friction the run decides nothing: Why.")


def test_a_wall_as_drawn_that_decides_nothing_has_no_factor():
    search = FactorSearch(lambda at: made_up(at, 1.2, (0.9, 1.1), Status.NOT_CONVERGED))
    search.bracket(100.0)
    search.bisect(EXACT)
    found = FactorOfSafety(
        UPRIGHT, "b", 0.0, search.lower, search.upper, search.stands, search.falls, search.runs, search.reason
    )
    assert found.value is None
    assert found.sentence == (
        "The wall falls without friction; no state was found that stands. At 1 the run decides nothing: Why. "
        "Proved: no equilibrium exists without friction."
    )


def test_runs_are_kept_and_found_again(tmp_path: Path):
    store = tmp_path / "store.sqlite"
    first, second = (factor(sloped(20.0, 0.6), "la-associated", store=store, accuracy=1e-3) for _ in range(2))
    assert first.stands is not None
    assert second.stands is not None
    assert first.stands.started == second.stands.started
    assert first.as_json() == second.as_json()
    other = factor(sloped(20.0, 0.6), "la-associated", store=store, accuracy=1e-3, share=0.0)
    assert other.stands is not None
    assert other.stands.key == first.stands.key


REFUSED: list[tuple[Callable[[], Any], str]] = [
    (lambda: factor(UPRIGHT, "lb"), 'no method is called "lb"'),
    (lambda: factor(sloped(20.0, 0.6), share=0.5), "a share of the live load is asked for and there is none"),
    (lambda: factor(UPRIGHT, share=math.nan), "the share nan is no number up to 1e+15"),
    (lambda: factor(UPRIGHT, accuracy=0.0), "the accuracy 0 is out of range"),
    (lambda: factor(sloped(20.0, 0.6, cohesion=1.0), "la-paper"), "la-paper takes dry joints only"),
    (lambda: factor_by(UPRIGHT, "la", {"no": 1}), "no"),
]


@pytest.mark.parametrize(("asked", "told"), REFUSED)
def test_what_cannot_be_asked_is_refused(asked: Callable[[], Any], told: str):
    with pytest.raises(InputError) as refused:
        asked()
    assert told in str(refused.value)


def test_the_command_prints_a_sentence_or_one_json_document(tmp_path: Path):
    path = tmp_path / "slope.json"
    sloped(20.0, 0.6).save(path)
    said = commands.drystone("factor", path, "--method", "la-associated", "--accuracy", "1e-3")
    assert (said.returncode, said.stderr) == (0, "")
    assert said.stdout.startswith("The factor of safety on friction is 1.64")
    answer = json.loads(commands.drystone("factor", path, "--accuracy", "1e-3", "--json").stdout)
    assert answer["bracket"][0] == answer["factor"] == answer["stands"]["factor"] <= 1.6484865 <= answer["bracket"][1]
    assert answer["falls"]["result"]["finding"] == "falls"
    refused = commands.drystone("factor", path, "--share", "0.1")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert f"{path}: loads.live: a share of the live load" in refused.stderr
