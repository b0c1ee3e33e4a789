"""The gap springs on walls whose slips lift: full dilatancy ends at the associated maximum, less of it below.

With the dilatancy of the friction the flow is associated, and the limit is unique (Drucker 1954): whatever the
stiffness, the path must end at the maximum that a linear programme finds. The judge holds every answer to the flow of
the wall.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import answered
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.case import case_folders, read_case, shipped_cases
from harness.model.errors import InputError
from harness.model.method import Finding, Status
from harness.model.method_registry import check_takes, load_method
from harness.model.result import Result
from harness.model.wall import Wall
from methods.springs.model.factor import make_factor
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import build_model
from methods.springs.rest.newton import newton
from methods.springs.rest.pseudo_transient import PseudoTransient
from tests.walls import assembly, running_bond, stack

SAME = 1e-9
"""Relative difference of two multipliers that are each known to 1e-10."""


def found(wall: Assembly, name: str = "fe", **settings: Any) -> Result:
    """The answer of a method, which the judge accepts."""
    result, judgement = answered(load_method(name), wall, **settings)
    assert judgement.accepted, judgement.sentence
    return result


def dilatant(wall: Assembly, share: float) -> Assembly:
    return replace(wall, dilatancy=share * wall.friction)


@pytest.mark.parametrize("name", ["fe", "fe-newton"])
@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_free_block_slides_at_its_friction_and_rises_by_its_dilatancy(name: str, share: float):
    """What lifts it does not change the limit: lambda = mu, and it moves along the angle of dilatancy."""
    result = found(dilatant(assembly(stack(1, 1.0, 0.2), 0.5), share), name)
    assert result.multiplier == pytest.approx(0.5, rel=SAME)
    assert result.mechanism is not None
    along, up, turn = result.mechanism[-1]
    assert (up / along, turn / along) == pytest.approx((0.5 * share, 0.0), abs=SAME)


def between_plates(share: float) -> Assembly:
    """A block between two plates that cannot move, pushed along them."""
    plate = [[0.0, 0.0], [3.0, 0.0], [3.0, 0.5], [0.0, 0.5]]
    blocks = [
        {"id": "below", "polygon": [[x, y - 0.5] for x, y in plate], "fixed": True},
        {"id": "above", "polygon": [[x, y + 1.0] for x, y in plate], "fixed": True},
        {"id": "block", "polygon": [[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]]},
    ]
    push = {"live": {"points": [{"block": "block", "at": [1.0, 0.5], "force": [1, 0]}]}}
    friction = {"default": 0.4, "dilatancy": 0.4 * share}
    content = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "blocks": blocks, "loads": push}
    return build(Wall.model_validate(content)).assembly


@pytest.mark.parametrize("share", [0.01, 0.5, 1.0])
def test_block_between_two_plates_jams_where_it_would_have_to_lift(share: float):
    """Without dilatancy it slides on the lower plate at mu W = 8; with any it presses itself against the upper one."""
    assert found(between_plates(0.0)).multiplier == pytest.approx(0.4 * 20.0, rel=SAME)
    assert found(between_plates(share)).finding is Finding.UNBOUNDED


def wedge(slope: float, friction: float, dilatancy: float) -> Assembly:
    """A wedge under a block that a smooth wall holds back, pushed under it; the wedge has no weight to speak of."""
    rise = 2.0 * np.tan(slope)
    blocks = [
        {"id": "floor", "polygon": [[-4, -1], [4, -1], [4, 0], [-4, 0]], "fixed": True},
        {"id": "wall", "polygon": [[-1, 1], [0.5, 1], [0.5, 4], [-1, 4]], "fixed": True},
        {"id": "wedge", "polygon": [[0, 0], [2, 0], [2, rise]], "unit_weight": 1e-6},
        {"id": "block", "polygon": [[0.5, 0.5 * np.tan(slope)], [2, rise], [2, 3], [0.5, 3]]},
    ]
    rough = {"default": friction, "dilatancy": dilatancy, "rules": [{"between": ["wall", "block"], "value": 0.0}]}
    push = {"live": {"points": [{"block": "wedge", "at": [2, 0.1], "force": [-1, 0]}]}}
    content = {"format": "wall/1", "unit_weight": 20.0, "friction": rough, "blocks": blocks, "loads": push}
    return build(Wall.model_validate(content)).assembly


@pytest.mark.parametrize("dilatancy", [0.0, 0.1, 0.2])
def test_wedge_is_driven_in_at_the_force_of_statics_whatever_its_joints_lift(dilatancy: float):
    """W (tan(slope + phi) + tan phi) pushes a wedge under a weight W that a smooth wall holds (Coulomb)."""
    slope, friction = 0.25, 0.2
    wall = wedge(slope, friction, dilatancy)
    weight = float(wall.weight[-1])
    phi = np.arctan(friction)
    expected = weight * (np.tan(slope + phi) + np.tan(phi))
    assert found(wall).multiplier == pytest.approx(expected, rel=1e-5)  # the weight of the wedge is 1e-7 of it


@pytest.mark.parametrize("name", ["fe", "fe-newton"])
@pytest.mark.parametrize(("courses", "bricks", "friction"), [(3, 2, 0.65), (4, 2, 0.85), (6, 3, 0.65)])
def test_dilatancy_of_the_friction_ends_at_the_associated_maximum(
    name: str, courses: int, bricks: int, friction: float
):
    wall = dilatant(assembly(running_bond(courses, bricks), friction), 1.0)
    greatest = found(wall, "la-associated").multiplier
    for settings in ({}, {"points": 5}, {"stiffness_ratio": 0.05}):
        assert found(wall, name, **settings).multiplier == pytest.approx(greatest, rel=SAME)


@pytest.mark.parametrize("share", [0.3, 0.7])
def test_less_dilatancy_ends_between_the_least_known_and_the_associated_maximum(share: float):
    wall = dilatant(assembly(running_bond(4, 3), 0.75), share)
    least, greatest = (found(wall, name).multiplier for name in ("la", "la-associated"))
    assert least is not None
    assert greatest is not None
    own = found(wall).multiplier
    assert own is not None
    assert least * (1.0 - SAME) <= own <= greatest * (1.0 + SAME)
    by_newton = found(wall, "fe-newton").multiplier
    assert by_newton == pytest.approx(own, rel=1e-3)  # two ways through the same law


def test_convex_steps_bracket_the_associated_maximum():
    """With the dilatancy of the friction no limit is frozen: every step is one programme."""
    wall = dilatant(assembly(running_bond(4, 2), 0.75), 1.0)
    greatest = found(wall, "la-associated").multiplier
    result = found(wall, "fe-qp")
    assert greatest is not None
    assert result.bracket is not None
    low, high = result.bracket
    assert low - 1e-3 * greatest <= greatest <= high + 1e-3 * greatest


def test_joints_with_strength_lift_too():
    wall = dilatant(assembly(running_bond(4, 2), 0.65, cohesion=2.0, tensile_strength=1.0), 1.0)
    greatest = found(wall, "la-associated").multiplier
    assert found(wall).multiplier == pytest.approx(greatest, rel=SAME)


def test_motion_to_rest_ends_in_the_law_itself():
    """Slow motion under frozen dissipation comes to the equilibrium that Newton finds."""
    wall = dilatant(assembly(running_bond(6, 3), 0.65), 0.6)
    model = build_model(wall, GapSettings())
    factor = make_factor(model)
    virgin = newton(model, factor, np.zeros(model.n_unknowns), 0.0, model.history, 0)
    motion = PseudoTransient(model, factor, virgin, True)
    assert motion.move(0.0).found
    rest = motion.move(0.4)
    assert rest.found
    assert np.array_equal(rest.history, model.history)
    near = newton(model, factor, rest.u, 0.4, model.history)
    assert near.found
    assert near.u == pytest.approx(rest.u, rel=1e-6, abs=1e-9 * abs(rest.u).max())


def test_updates_of_the_plastic_slip_are_refused_where_joints_dilate():
    wall = dilatant(assembly(running_bond(3, 2), 0.65), 0.5)
    result, _ = answered(load_method("fe"), wall, histories=(0.0, 0.01))
    assert result.status is Status.REFUSED
    assert "dilat" in result.sentence
    assert len(found(wall).details["histories"]) == 1


def test_brittle_joints_that_dilate_are_refused():
    wall = dilatant(assembly(stack(2), 0.5, cohesion=2.0, after="residual"), 0.5)
    with pytest.raises(InputError, match="fe takes brittle joints without dilatancy; that between"):
        check_takes(load_method("fe"), wall)


@pytest.mark.slow
def test_dilatancy_of_the_friction_ends_at_the_associated_maximum_of_every_library_wall():
    held = 0
    for folder in case_folders([shipped_cases()]).values():
        wall = read_case(folder).assembly
        if wall.n_free > 60 or wall.crushes or wall.breaks or np.any(wall.support_motion) or len(wall.bars):
            continue
        own, greatest = found(dilatant(wall, 1.0)), found(wall, "la-associated")
        assert own.finding is greatest.finding, folder.name
        assert (own.multiplier or 0.0) == pytest.approx(greatest.multiplier or 0.0, rel=1e-4), folder.name
        held += 1
    assert held > 50
