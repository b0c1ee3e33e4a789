"""What statics alone says against a fall that was measured."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from harness.engine.judge import answered
from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Status
from harness.model.method_registry import load_method
from harness.model.reading import read_wall
from methods.numerics.claims import at_limit
from methods.numerics.statics import dilatant_mechanism
from tests.known_walls import WALLS
from tests.tied_walls import bar, built
from tests.walls import assembly, running_bond, stack

EDGE = Path(__file__).parent.parent / "data" / "knife-edge"


def measured_fall(wall: Assembly) -> Answer:
    motion = np.where(wall.fixed[:, None], 0.0, [0.0, -1.0, 0.0])
    return Answer(Status.OK, Finding.FALLS, "It falls", mechanism=motion, flow="approximate")


def test_a_frictionless_stack_that_stands_is_not_said_to_fall_by_joints_that_give():
    """It bears .02723503; rounded corners of soft joints take more than that from it."""
    wall = read_wall(EDGE / "pz4-in-mu0.json").assembly
    result, judgement = answered(load_method("de-soft"), wall)
    assert (result.status, result.finding) == (Status.NOT_CONVERGED, Finding.NONE)
    assert "0.02723503" in result.sentence
    assert judgement.outcome == "not_judged"


@pytest.mark.parametrize(("friction", "dilatancy", "stands"), [(0.5, 0.0, False), (0.5, 0.5, True), (0.0, 0.0, True)])
def test_equilibrium_refutes_a_fall_only_where_no_slip_works_against_friction(friction, dilatancy, stands):
    wall = WALLS["stack that topples"]()
    size = np.ones_like(wall.friction)
    wall = replace(wall, friction=friction * size, dilatancy=dilatancy * size)
    if friction == 0.0:
        wall = replace(wall, live=np.where(wall.fixed[:, None], 0.0, [0.0, 0.0, -1.0]))  # turned, which no slip bears
    found = at_limit(wall, measured_fall(wall))
    assert (found.finding is Finding.NONE) is stands
    assert (found.finding is Finding.FALLS) is not stands


def test_what_only_its_live_load_holds_up_falls_under_its_dead_load():
    """Between smooth supports it falls; drawn up by its weight it hangs. Statics bears 1, and nothing at zero."""
    wall = WALLS["falls between supports, drawn up"]()
    found = at_limit(wall, measured_fall(wall))
    assert found.finding is Finding.FALLS
    assert found.sentence == "It falls"


def test_falls_of_springs_near_their_limit_depend_on_the_springs_and_are_not_judged():
    """Goodman and Bray's columns stand from a friction of .7854 by their recursion; springs share forces otherwise."""
    wall = read_wall(EDGE / "gb16-7855-l.json").assembly
    fe = load_method("fe")
    result, judgement = answered(fe, wall)
    assert (result.finding, judgement.outcome) == (Finding.FALLS, "not_judged")
    assert "Statics alone would bear up to 0.0967" in result.sentence
    at = replace(wall, friction=np.full_like(wall.friction, 0.79))
    soft, stiff = (fe.solve(at, fe.Settings(stiffness_ratio=ratio)) for ratio in (0.05, 10.0))
    assert soft.finding is Finding.FALLS
    assert stiff.multiplier == pytest.approx(0.0040, rel=0.02)


@pytest.mark.parametrize(("friction", "finding"), [(0.7850, Finding.FALLS), (0.7860, Finding.COLLAPSES)])
def test_springs_that_are_stiff_in_shear_have_the_limit_of_goodman_and_bray(friction: float, finding: Finding):
    """.7854 by the recursion, where each column slips at full friction under the force at the top of the next."""
    wall = read_wall(EDGE / "gb16-7855-l.json").assembly
    fe = load_method("fe")
    at = replace(wall, friction=np.full_like(wall.friction, friction))
    assert fe.solve(at, fe.Settings(stiffness_ratio=10.0)).finding is finding


def test_a_load_on_few_blocks_is_proved_to_be_borne_without_end():
    """The blocks beside its way to the ground carry none of it, not even rounding, so that each is in equilibrium."""
    load = {"live": {"points": [{"block": "2.1", "at": [0.5, 0.25], "force": [-0.79, -2.57]}]}}
    pattern = running_bond(2, 2, 0.5, 0.25)
    for method in ("la-associated", "fe"):
        result, judgement = answered(load_method(method), assembly(pattern, 0.446, loads=load))
        assert (result.finding, judgement.accepted) == (Finding.UNBOUNDED, True)


def test_a_path_of_springs_goes_on_for_ever_beside_motions_without_stiffness():
    """A soft motion was held at the last change of state, and a path in equilibrium at any multiplier called lost."""
    force = {"block": "1.1", "at": [-0.0034252198880441315, 0.18358005435201766]}
    load = {"live": {"points": [force | {"force": [0.03391643611607521, -0.9994246721795416]}]}}
    pattern = running_bond(2, 4, 0.35882078763109954, 0.27649315851629586)
    result, judgement = answered(load_method("fe"), assembly(pattern, 0.3450796169236702, loads=load))
    assert (result.finding, judgement.accepted) == (Finding.UNBOUNDED, True)


def test_blocks_without_dead_load_that_are_pushed_collapse_at_zero_and_do_not_fall():
    """Of a wall without gravity only fill on its top bears: the greatest multiplier is zero, and came out as -7e-37."""
    courses = [[0.5, 1, 1, 0.5], [1, -1, 1], [0.5, 0.5, -1, 0.5, 0.5], [0.75, 1.5, 0.75], [1, 1, 1]]
    fill = {"level": 1.783, "unit_weight": 19.8, "between": [0.6642665272491222, 0.9309418123712654], "factor": 1.35}
    live = {"body": [{"per_weight": [-1.35, -0.405]}]}
    pattern = {"type": "running_bond", "block_length": 0.6, "block_height": 0.3, "courses": courses}
    loads = {"gravity": [0, 0], "dead": {"fills": [fill]}, "live": live}
    result, judgement = answered(
        load_method("la-associated"), assembly(pattern, 0.8, loads=loads, thickness=1.37, unit_weight=20.04)
    )
    assert (result.finding, result.multiplier) == (Finding.COLLAPSES, pytest.approx(0.0))
    assert judgement.accepted, judgement.sentence  # relative to dead loads that move by more than rounding


def test_a_fall_by_little_that_was_measured_is_proved_by_a_mechanism_to_rounding():
    """On a slope of .0125 with a friction 1e-5 below: the dead load does work 1e-7, as do closings of 1e-14 at 1e7."""
    loads = {"gravity": [0.0125, -1.0], "live": None}
    wall = assembly(running_bond(3, 2, 0.5, 0.25), 0.0125 * (1.0 - 1e-5), loads=loads)
    result, judgement = answered(load_method("fe"), wall)
    assert (result.finding, judgement.accepted) == (Finding.FALLS, True)


@pytest.mark.parametrize(("cohesion", "falls"), [(1.19, True), (1.21, False)])
def test_a_block_slides_down_where_its_weight_does_more_work_than_cohesion_takes(cohesion: float, falls: bool):
    """Weight 4 down a slope of .5 with friction .2: c A = 1.2 holds it."""
    wall = assembly(stack(1, 1.0), 0.2, cohesion=cohesion, loads={"gravity": [0.5, -1.0], "live": None})
    mechanism = dilatant_mechanism(wall, wall.dead)
    assert (mechanism is not None) is falls
    if mechanism is not None:
        law = wall.law.associated
        strains = (wall.kinematic_matrix @ mechanism[wall.free].ravel()).reshape(-1, 3)
        assert (wall.dead * mechanism).sum() > law.dissipation(law.rates(strains))


@pytest.mark.parametrize("method", ["fe", "de"])
def test_a_fall_of_a_tied_wall_that_no_share_of_its_dead_load_holds_up_is_proved(method: str):
    """The prestress pulls a stone off: no forces at all bear the share zero, but rounding of the load was left."""

    def stone(name: str, left: float, bottom: float, right: float, top: float, **more: object) -> dict[str, object]:
        return {"id": name, "polygon": [[left, bottom], [right, bottom], [right, top], [left, top]], **more}

    blocks = [
        stone("ground", -0.5, -0.3, 1.4, 0.0, fixed=True),
        stone("left", 0.0, 0.0, 0.3, 0.45),
        stone("right", 0.675, 0.0, 0.9, 0.45, thickness=0.2),
        stone("pulled", 0.0, 0.45, 0.225, 0.75),
        stone("long", 0.225, 0.45, 0.675, 0.75, thickness=0.2),
    ]
    wall = {
        **{"format": "wall/1", "unit_weight": 20, "thickness": 0.5, "blocks": blocks},
        "friction": {"default": 0.6, "rules": [{"joint": "head", "value": 0.0}]},
        "loads": {"gravity": [-0.1, -1], "live": {"body": [{"per_weight": [1, 0]}]}},
        "ties": [bar(("ground", [-0.5, 0.0]), ("pulled", [0.0, 0.6]), 3.0, prestress=0.75)],
    }
    result, judgement = answered(load_method(method), built(wall))
    assert (result.finding, judgement.accepted) == (Finding.FALLS, True)
