"""The judge on walls with brittle joints: what an answer calls broken is dry, and what it calls whole rests."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import answered, judge
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.foreign.result_document import answer_from_file
from harness.model.method import Answer, Finding, Status
from harness.model.method_registry import load_method
from harness.model.result import Judgement, Result, result_of
from harness.model.wall import Wall
from tests.walls import assembly, stack

WALLS = {
    "slides": {"pattern": stack(2, 1.0, 0.2), "friction": 0.5, "cohesion": 1.0},
    "topples": {"pattern": stack(2, 0.4, 1.0), "friction": 1.0, "cohesion": 8.0, "tensile_strength": 4.0},
}


@cache
def state(name: str, method: str, after: str = "residual") -> tuple[Assembly, Result]:
    wall = assembly(**WALLS[name], after=after)
    return wall, answered(load_method(method), wall)[0]


def judged(wall: Assembly, result: Result, **details: Any) -> Judgement:
    kept = {key: value for key, value in (result.details | details).items() if value is not None}
    return judge(wall, result.model_copy(update={"details": kept}), 1e-8)


@pytest.mark.parametrize("method", ["la", "la-associated", "fe"])
@pytest.mark.parametrize("name", WALLS)
def test_right_answers_are_accepted(name: str, method: str):
    wall, result = state(name, method)
    assert judged(wall, result).accepted is True


@pytest.mark.parametrize("name", WALLS)
def test_a_plastic_mechanism_that_moves_a_whole_brittle_joint_is_rejected(name: str):
    """It is a collapse state if joints keep their strength; a joint that has moved has none."""
    plastic, result = state(name, "la", "plastic")
    wall, _ = state(name, "la")
    assert judged(plastic, result, without_strength=None).accepted is True
    said = judged(wall, result, without_strength=None)
    assert said.accepted is False
    assert "calls whole moves" in said.sentence
    assert said.residuals["whole"] > 0.01


@pytest.mark.parametrize("name", WALLS)
def test_the_associated_state_of_whole_joints_is_an_upper_bound(name: str):
    wall, result = state(name, "la-associated")
    assert "upper bound" in judged(wall, result).sentence


@pytest.mark.parametrize(
    "listed", [None, [], [1], [0, 5], [-1], ["0"], [True], "0", 0], ids=lambda listed: repr(listed)
)
def test_a_residual_state_without_its_list_of_broken_joints_is_rejected(listed: Any):
    """The lower joint moves in it, which bears only friction: called whole, it would take more."""
    wall, result = state("slides", "la")
    moving = int(np.argmax(abs(np.array(result.forces)[:, 2])))
    assert judged(wall, result, broken=[moving]).accepted is True
    given = [1 - moving] if listed == [1] else listed
    assert judged(wall, result, broken=given).accepted is False


def test_a_joint_that_is_not_brittle_cannot_be_called_broken():
    _, result = state("slides", "la")
    lower = {"between": ["base", "1"], "value": 0.5, "cohesion": 1.0, "after": "residual"}
    upper = lower | {"between": ["1", "2"], "after": "plastic"}
    mixed = assembly(stack(2, 1.0, 0.2), {"default": 0.5, "rules": [lower, upper]})
    assert mixed.brittle.sum() == 1
    said = judged(mixed, result)
    assert said.accepted is False
    assert "not brittle" in said.sentence


@pytest.mark.parametrize("name", WALLS)
def test_a_break_is_shown_by_forces_at_strength_and_a_motion_that_nothing_resists(name: str):
    wall, result = state(name, "fe")
    breaking = result.details["breaking"]
    assert len(breaking) == 1
    right = judged(wall, result)
    assert right.accepted is True
    assert right.residuals["breaking"] < 1e-8
    other = [1 - breaking[0]]
    for listed in (other, [*breaking, *other], [], [7], "0"):
        assert judged(wall, result, breaking=listed).accepted is False
    assert judged(wall, result, broken=breaking).accepted is False
    measured = {"flow": "approximate", "bracket": (0.0, 1e50)}
    assert "one multiplier" in judge(wall, result.model_copy(update=measured), 1e-8).sentence
    assert judge(wall, result.model_copy(update=measured), 1e-8).accepted is False
    unshown = judge(wall, result.model_copy(update={"mechanism": None}), 1e-8)
    assert unshown.accepted is None
    still = np.array(result.mechanism)
    for motion in (-still, 0.0 * still, still * [0.0, 1.0, 0.0] + [0.0, 0.1, 0.0]):
        wrong = judge(wall, result.model_copy(update={"mechanism": motion.tolist()}), 1e-8)
        assert wrong.accepted is False


def test_a_break_below_its_multiplier_is_rejected():
    """At nine tenths of the load no joint is at its strength."""
    wall, result = state("slides", "fe")
    forces = np.array(result.forces) * [1.0, 1.0, 0.9]
    lower = {"multiplier": 0.9 * (result.multiplier or 0.0), "forces_multiplier": 0.9 * (result.multiplier or 0.0)}
    said = judge(wall, result.model_copy(update=lower | {"forces": forces.tolist()}), 1e-8)
    assert said.accepted is False
    assert said.residuals["breaking"] > 1e-3


def test_the_plastic_answer_beside_the_residual_one_is_judged_too():
    wall, result = state("slides", "la")
    plastic = result.details["with_strength"]
    assert judged(wall, result, with_strength=plastic | {"multiplier": 0.9}).accepted is False
    assert judged(wall, result, with_strength={"finding": "?"}).accepted is False
    none = plastic | {"status": "not_converged", "finding": "none", "multiplier": None}
    assert judged(wall, result, with_strength=none).accepted is True
    for claim in ({"multiplier": 99.0}, {"bracket": [0.0, 99.0]}):
        assert judged(wall, result, with_strength=none | claim).accepted is False


@pytest.mark.parametrize("method", ["la", "fe"])
def test_an_answer_from_a_file_says_which_joints_are_broken(method: str):
    """As `drystone judge` reads the output of `drystone run --json --fields`."""
    wall, result = state("topples", method)
    written = json.loads(result.model_dump_json())
    answer = answer_from_file(written, wall, "answer.json")
    read = result_of(answer, wall, case="x", method=method, family=method)
    assert judge(wall, read, 1e-8).accepted is True
    written["details"] |= {"broken": [0, 1, 7]}
    read = result_of(answer_from_file(written, wall, "answer.json"), wall, case="x", method=method, family=method)
    assert judge(wall, read, 1e-8).accepted is False


@pytest.mark.parametrize("on_top", [False, True], ids=["beside it", "on the wall"])
def test_a_block_that_slides_on_ice_hides_no_brittle_joint_that_moves(on_top: bool):
    """It needs no force, so that the plastic collapse state beside it may be as slow as one likes."""

    def block(name: str, x: float, y: float, height: float, fixed: bool = False) -> dict[str, Any]:
        corners = [[x, y], [x + 1.0, y], [x + 1.0, y + height], [x, y + height]]
        return {"id": name, "polygon": corners, "fixed": fixed}

    below, ice = ("block", block("ice", 0.0, 0.2, 0.2)) if on_top else ("floor", block("ice", 9.0, 0.0, 0.2))
    blocks = [block("base", 0.0, -1.0, 1.0, True), block("block", 0.0, 0.0, 0.2), ice]
    blocks += [] if on_top else [block("floor", 9.0, -1.0, 1.0, True)]
    body = {"live": {"body": [{"blocks": ["block"], "per_weight": [1, 0]}]}}
    plain = {"format": "wall/1", "unit_weight": 20.0, "blocks": blocks, "loads": body}

    def wall(after: str) -> Assembly:
        glued = {"between": ["base", "block"], "value": 0.5, "cohesion": 1.0, "after": after}
        rules = [glued, {"between": [below, "ice"], "value": 0.0}]
        return build(Wall.model_validate(plain | {"friction": {"default": 0.5, "rules": rules}})).assembly

    plastic, brittle = wall("plastic"), wall("residual")
    result, _ = answered(load_method("la"), plastic)
    motion = 1e-9 * np.array(result.mechanism) / abs(np.array(result.mechanism)).max()
    motion[brittle.block_ids.index("ice"), 0] += 1.0
    hidden = result.model_copy(update={"mechanism": motion.tolist()})
    assert judged(plastic, hidden, without_strength=None).accepted is True
    assert judged(brittle, hidden, without_strength=None).residuals["whole"] > 0.1
    assert judged(brittle, hidden, without_strength=None).accepted is False


@pytest.mark.parametrize(("unit_weight", "shown"), [(20.0, None), (40.0, True)])
def test_a_fall_after_a_break_is_shown_only_where_the_joints_could_not_bear_the_weight_whole(
    unit_weight: float, shown: bool | None
):
    """A block of weight .2 gamma hangs on T = 6: it can bear 4, not 8. That anything breaks it at 4 nobody shows."""
    panel = {"type": "panel", "cell_length": 1.0, "cell_height": 0.2, "layout": ["L", "B"], "fixed": "L"}
    glue = {"cohesion": 10.0, "tensile_strength": 6.0, "after": "residual"}
    wall = assembly(panel, 0.5, unit_weight=unit_weight, **glue)
    motion = np.where(wall.fixed[:, None], 0.0, [[0.0, -1.0, 0.0]])
    answer = Answer(Status.OK, Finding.FALLS, "it falls", mechanism=motion, flow="associated")
    answer.details = {"broken": [0], "broken_at": [0.0]}
    result = result_of(answer, wall, case="glued", method="own", family="own")
    assert judge(wall, result, 1e-8).accepted is shown


@pytest.mark.parametrize("loads", [{}, {"live": {"body": [{"per_weight": [1, 0]}]}}])
def test_two_voussoirs_that_stand_on_whole_joints_alone_are_not_said_to_fall(loads: dict[str, Any]):
    """Their thrust is flatter than the friction: they fall once the joints have broken, which is not shown."""
    ring = {"type": "ring", "inner_radius": 1.0, "outer_radius": 1.05, "count": 2, "angles": [150, 30]}
    strength = {"cohesion": 2.0, "tensile_strength": 1.0, "after": "residual"}
    wall = assembly(ring, 0.1, loads=loads, **strength)
    safe, judgement = answered(load_method("la"), wall)
    assert safe.sentence.startswith(
        "With all brittle joints broken, a safe estimate: the wall falls under its dead load"
    )
    assert (safe.finding, judgement.accepted) == (Finding.FALLS, None)
    whole, judgement = answered(load_method("la-associated"), wall)
    assert (whole.finding, judgement.accepted) == (Finding.COLLAPSES if loads else Finding.STANDS, True)
    assert "That is as if all joints kept their strength, an upper estimate" in whole.sentence
    followed, judgement = answered(load_method("fe"), wall)
    assert (followed.finding, judgement.accepted) == (Finding.COLLAPSES if loads else Finding.STANDS, True)
    assert 0.0 < (followed.multiplier or 1e-3) < (whole.multiplier or 1.0)
