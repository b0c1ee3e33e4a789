"""Attacks on the judge: answers that are false in a part that no residual sees, and right ones that were rejected.

The true multipliers are known by hand: a block on friction .3 slides at .3; one that is twice as high as wide topples
at .5 on rough ground.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import drystone
from harness.engine.judge import COARSEST, answered, judge
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.displaced import DisplacedState
from harness.model.method import Answer, Finding, Method, Status
from harness.model.method_registry import load_method
from harness.model.result import Judgement, result_of
from harness.model.wall import Wall
from tests.best_cheats import bearing
from tests.known_walls import LEAN, WALLS, box, of_blocks
from tests.walls import PUSH, assembly, stack

TRUE = 0.3


def solved(wall: Assembly, method: str = "la") -> Answer:
    found = load_method(method)
    return found.solve(wall, found.Settings())


def said(wall: Assembly, answer: Answer, tolerance: float = 1e-9) -> Judgement:
    return judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), tolerance)


def sliding() -> Assembly:
    return of_blocks([box("a", 0.0, 0.0)], TRUE)


def measured(wall: Assembly, **parts: Any) -> Answer:
    """A right measured answer about a block that slides, with other parts."""
    forces = bearing(np.random.default_rng(0), wall, wall.dead + TRUE * wall.live, 1e3)
    right = Answer(
        Status.OK, Finding.COLLAPSES, "", TRUE, (TRUE, 0.301), forces=forces, forces_multiplier=TRUE, flow="approximate"
    )
    return replace(right, **parts)


def test_the_measured_answer_that_is_attacked_is_right():
    assert said(sliding(), measured(sliding())).outcome == "accepted"


@pytest.mark.parametrize(
    ("parts", "outcome"),
    [
        ({"multiplier": 1e6}, "rejected"),
        ({"multiplier": 0.29, "bracket": (0.295, 0.301)}, "rejected"),
        ({"multiplier": 0.1, "bracket": (0.0, 0.2)}, "rejected"),  # its own forces bear .3
        ({"bracket": (-0.1, 0.4)}, "rejected"),
        ({"multiplier": -0.05, "bracket": (-0.1, 0.4)}, "rejected"),
        ({"bracket": None}, "not_judged"),  # nothing shows that it collapses
        ({"multiplier": 0.1, "bracket": None}, "not_judged"),
    ],
)
def test_a_measured_multiplier_lies_in_its_bracket_above_what_its_forces_bear(parts: dict[str, Any], outcome: str):
    assert said(sliding(), measured(sliding(), **parts)).outcome == outcome


@pytest.mark.parametrize("bracket", [(10.0, 20.0), (0.1, 0.2)])
def test_the_multiplier_of_a_collapse_state_lies_in_its_bracket(bracket: tuple[float, float]):
    wall = sliding()
    state = solved(wall)
    assert said(wall, state).outcome == "accepted"
    assert said(wall, replace(state, bracket=bracket)).outcome == "rejected"


FALLING, DOWN, STANDING = (
    lambda: (assembly(stack(3) | LEAN, 0.5), "fe"),
    lambda: (WALLS["drawn down"](), "la-associated"),
    lambda: (assembly(stack(3), 0.5, loads={}), "la"),
)


@pytest.mark.parametrize("made", [FALLING, DOWN, STANDING], ids=["falls", "unbounded", "stands"])
@pytest.mark.parametrize("parts", [{"multiplier": 0.7}, {"multiplier": 0.0}, {"bracket": (0.7, 0.8)}])
def test_what_has_no_multiplier_gives_none(made: Any, parts: dict[str, Any]):
    wall, method = made()
    answer = solved(wall, method)
    assert said(wall, answer).outcome == "accepted"
    judgement = said(wall, replace(answer, **parts))
    assert judgement.outcome == "rejected"
    assert f'"{answer.finding}"' in judgement.sentence


def test_no_live_load_is_never_unbounded():
    wall = assembly(stack(3), 0.5, loads={})
    nothing = {"live_forces": np.zeros((wall.n_interfaces, 3)).tolist()}
    claim = replace(solved(wall), finding=Finding.UNBOUNDED, forces_multiplier=0.0, details=nothing)
    assert said(wall, claim).outcome == "rejected"
    on_support = replace(wall, live=np.where(wall.fixed[:, None], 1.0, 0.0) * [1.0, 0.0, 0.0])
    assert said(on_support, claim).outcome == "rejected"


@pytest.mark.parametrize("tolerance", [1.1 * COARSEST, 1e3, np.inf, np.nan])
def test_a_tolerance_that_lets_everything_pass_shows_nothing(tolerance: float):
    wall = sliding()
    state = solved(wall)
    assert said(wall, state, COARSEST).outcome == "accepted"
    assert said(wall, state, tolerance).outcome != "accepted"
    assert said(wall, replace(state, multiplier=0.9, forces_multiplier=0.9), tolerance).outcome != "accepted"


@pytest.mark.parametrize("motion", [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [-1.0, 0.1, 0.0]])
def test_a_measured_motion_is_one_that_the_loads_drive(motion: list[float]):
    """Back against the push, up against the weight, or none at all."""
    wall = sliding()
    field = np.zeros((wall.n_blocks, 3))
    field[wall.free[0]] = [1.0, 0.0, 0.0]
    assert said(wall, measured(wall, mechanism=field)).outcome == "accepted"
    field[wall.free[0]] = motion
    assert said(wall, measured(wall, mechanism=field)).outcome == "rejected"


def resting(wall: Assembly, turn: float, multiplier: float) -> Answer:
    """The state in which a block, turned back about the corner it would topple over, balances upon it."""
    block = int(wall.free[0])
    corner = np.array([1.0, 0.0])
    cosine, sine = np.cos(turn), np.sin(turn)
    centre = corner + np.array([[cosine, -sine], [sine, cosine]]) @ (wall.centroid[block] - corner)
    places = np.zeros((wall.n_blocks, 3))
    places[block] = [*(centre - wall.centroid[block]), turn]
    weight = -wall.dead[block, 1]
    state = DisplacedState(
        *(places, np.array([0]), np.array([block]), corner[None], np.array([[0.0, 1.0]])),
        np.array([[-multiplier * weight, weight]]),
    )
    bracket = (multiplier, 1.001 * multiplier)
    return Answer(Status.OK, Finding.COLLAPSES, "", multiplier, bracket, flow="approximate", details=state.as_details())


@pytest.mark.parametrize(("turn", "outcome"), [(0.001, "accepted"), (0.02, "not_judged"), (0.4, "not_judged")])
def test_a_block_that_balances_on_its_corner_shows_no_multiplier_above_the_true_one(turn: float, outcome: str):
    """It topples at .5 = tan(beta); turned back by theta it balances at tan(beta + theta), 1.17 at .4 rad."""
    wall = of_blocks([box("a", 0.0, 0.0, 1.0, 2.0)], 5.0)
    multiplier = float(np.tan(np.arctan(0.5) + turn))
    assert said(wall, resting(wall, turn, multiplier), 1e-6).outcome == outcome
    assert multiplier <= 0.5 * 1.005 or outcome != "accepted"


def test_a_block_that_falls_does_not_stand_because_it_would_further_back():
    """Its centre lies .1 beyond the edge; moved back by .2 it would stand."""
    over = {"id": "a", "polygon": [[-0.4, 0.0], [0.6, 0.0], [0.6, 1.0], [-0.4, 1.0]]}
    blocks = [box("g", -5.0, -1.0, 5.0, 1.0, fixed=True), over]
    wall = build(
        Wall.model_validate({"format": "wall/1", "unit_weight": 20.0, "friction": 0.7, "blocks": blocks})
    ).assembly
    block = int(wall.free[0])
    places = np.zeros((2, 3))
    places[block, 0] = -0.2
    weight = -wall.dead[block, 1]
    point = np.array([[wall.centroid[block, 0] - 0.2, 0.0]])
    up = np.array([[0.0, 1.0]])
    state = DisplacedState(places, np.array([0]), np.array([block]), point, up, weight * up)
    claim = Answer(Status.OK, Finding.STANDS, "", flow="approximate", details=state.as_details())
    assert said(wall, claim, 1e-6).outcome == "not_judged"


def test_a_component_at_rest_in_a_measured_field_is_not_held_to_its_noise():
    wall = WALLS["three"]()
    answer = solved(wall, "de-soft")
    assert answer.multiplier == pytest.approx(TRUE, rel=5e-3)
    assert said(wall, answer, load_method("de-soft").tolerance).outcome == "accepted"
    field = np.array(answer.mechanism)
    field[wall.block_ids.index("b")] = [0.01, -0.01, 0.0]  # of the fastest: no noise, and into the ground
    assert said(wall, replace(answer, mechanism=field), load_method("de-soft").tolerance).outcome == "rejected"


def edge(inside: float) -> Assembly:
    """A cube whose centre lies so far inside the edge of its support: its multiplier is twice that."""
    blocks = [
        box("g", -5.0, -1.0, 5.5, 1.0, fixed=True),
        {"id": "a", "polygon": [[-inside, 0.0], [1.0 - inside, 0.0], [1.0 - inside, 1.0], [-inside, 1.0]]},
    ]
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.7, "blocks": blocks, "loads": PUSH}
    return build(Wall.model_validate(data)).assembly


@pytest.mark.parametrize("method", ["la", "la-associated", "fe"])
@pytest.mark.parametrize(("inside", "finding"), [(1e-6, "collapses"), (1e-8, "at its limit"), (1e-10, "at its limit")])
def test_an_edge_is_accepted_on_both_sides_of_what_its_numbers_tell(method: str, inside: float, finding: str):
    """At 1e-8 the numbers leave a multiplier of 2.8e-8 open, and the forces of its 2e-8 show it."""
    result, judgement = answered(load_method(method), edge(inside))
    assert (result.finding, judgement.outcome) == (finding, "accepted")
    claim = replace(solved(edge(1e-8)), multiplier=0.0)
    assert said(edge(4e-8), claim).outcome == "rejected"


def test_an_idle_roller_does_not_make_a_wall_be_at_its_limit():
    """A heavy block that rolls free may be of any speed, whose power beside nothing is of any size."""
    smooth = {"default": TRUE, "rules": [{"between": ["g", "h"], "value": 0.0}]}
    push = {"live": {"body": [{"per_weight": [1.0, 0.0], "blocks": ["a"]}]}}
    wall = of_blocks([box("a", 0.0, 0.0), box("h", 5.0, 0.0, weight=1e6)], smooth, push)
    motion = np.zeros((3, 3))
    motion[wall.block_ids.index("a")] = [1.0, TRUE, 0.0]
    motion[wall.block_ids.index("h")] = [1e8, 0.0, 0.0]
    for at in (0.0, TRUE):
        forces = bearing(np.random.default_rng(0), wall, wall.dead + at * wall.live, 1e8)
        claim = Answer(Status.OK, Finding.AT_LIMIT, "", 0.0, forces=forces, mechanism=motion, flow="associated")
        assert said(wall, claim).outcome == "rejected"


@pytest.mark.parametrize("weight", [1.0, 1e-6, 1e-7])
def test_a_light_stone_falls_however_heavy_its_neighbour(weight: float):
    """Its dead work is a millionth of the weight of the wall, and all that there is where it moves."""
    upper = {"id": "b", "polygon": [[0.6, 1.0], [1.6, 1.0], [1.6, 2.0], [0.6, 2.0]], "weight": weight}
    wall = of_blocks([box("a", 0.0, 0.0, weight=1.0), upper], 0.5, {})
    motion = np.zeros((3, 3))
    edge_point, block = np.array([1.0, 1.0]), wall.block_ids.index("b")
    arm = wall.centroid[block] - edge_point
    motion[block] = [arm[1], -arm[0], -1.0]
    claim = Answer(Status.OK, Finding.FALLS, "", mechanism=motion)
    assert said(wall, claim, 1e-3).outcome == "accepted"
    assert said(replace(wall, dead=-wall.dead), claim, 1e-3).outcome == "rejected"


class Meddler(Method):
    """A method that makes the live load ten times lighter, and answers for that wall."""

    name, family, title, tolerance = "meddler", "meddler", "changes its wall", 1e-9

    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        assembly.live[:] *= 0.1
        assembly.__dict__.pop("load_unit", None)
        return solved(assembly)


def test_a_method_that_changes_its_wall_is_judged_on_the_wall_that_was_asked_about():
    wall = sliding()
    live = wall.live.copy()
    result, judgement = answered(Meddler(), wall)
    assert result.multiplier == pytest.approx(10.0 * TRUE)
    assert judgement.outcome == "rejected"
    assert (wall.live == live).all()
    asked = drystone.new_wall("stack", count=1, friction=TRUE)
    found = drystone.analyse(asked, Meddler())
    assert found.judge.outcome == "rejected"
    assert drystone.analyse(asked, "la").multiplier == pytest.approx(TRUE)
