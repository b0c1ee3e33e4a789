"""`de` on walls whose slips lift: with the dilatancy of the friction the associated maximum is the answer.

By normality the limit is then unique (Drucker 1954), whatever the order of the sweeps. The judge holds the measured
motion to the lift of its slips.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import answered, judge
from harness.model.assembly import Assembly
from harness.model.case import case_folders, read_case, shipped_cases
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from harness.model.result import Result, relative_velocities
from tests.fe.test_dilatancy_fe import between_plates, dilatant, wedge
from tests.walls import assembly, running_bond, stack

STATED = 5e-3
FORCES = 1e-6


def found(wall: Assembly, name: str = "de", **settings: Any) -> Result:
    """The answer of a method, which the judge accepts."""
    result, judgement = answered(load_method(name), wall, **settings)
    assert judgement.accepted, judgement.sentence
    return result


@pytest.mark.parametrize("share", [0.3, 1.0])
def test_free_block_slides_at_its_friction_and_rises_by_its_dilatancy(share: float):
    result = found(dilatant(assembly(stack(1, 1.0, 0.2), 0.5), share))
    assert result.multiplier == pytest.approx(0.5, rel=STATED)
    assert result.mechanism is not None
    along, up, turn = result.mechanism[-1]
    assert (up / along, turn / along) == pytest.approx((0.5 * share, 0.0), abs=1e-6)


@pytest.mark.parametrize("share", [0.01, 0.5, 1.0])
def test_block_between_two_plates_jams_where_it_would_have_to_lift(share: float):
    assert found(between_plates(share)).finding is Finding.UNBOUNDED


def test_dry_block_between_two_plates_slides_at_the_thrust_that_it_bears():
    """Each P >= 0 of the upper plate is in balance with sliding at mu (W + 2 P): the limit has no one value.

    `la` and `fe` find the least, P = 0; statics knows no greatest. `de` ends where its history left P.
    """
    wall = between_plates(0.0)
    least, greatest = found(wall, "la").multiplier, found(wall, "la-associated")
    assert least is not None
    assert least == pytest.approx(0.4 * 20.0)
    assert greatest.finding is Finding.UNBOUNDED
    result = found(wall)
    assert result.bracket is not None
    assert result.forces is not None
    assert result.bracket[0] >= least * (1.0 - STATED)
    lower, upper = np.asarray(result.forces)[:, :2].sum(axis=1)
    assert lower - upper == pytest.approx(20.0, rel=STATED)
    assert result.multiplier == pytest.approx(0.4 * (20.0 + 2.0 * upper), rel=STATED)


@pytest.mark.parametrize("dilatancy", [0.1, 0.2])
def test_wedge_is_driven_in_at_the_force_of_statics_whatever_its_joints_lift(dilatancy: float):
    """W (tan(slope + phi) + tan phi) pushes a wedge under a weight W that a smooth wall holds (Coulomb)."""
    wall, phi = wedge(0.25, 0.2, dilatancy), np.arctan(0.2)
    expected = float(wall.weight[-1]) * (np.tan(0.25 + phi) + np.tan(phi))
    assert found(wall).multiplier == pytest.approx(expected, rel=STATED)


@pytest.mark.parametrize(("courses", "bricks", "friction"), [(3, 2, 0.65), (4, 2, 0.85), (6, 3, 0.65)])
def test_dilatancy_of_the_friction_ends_at_the_associated_maximum(courses: int, bricks: int, friction: float):
    wall = dilatant(assembly(running_bond(courses, bricks), friction), 1.0)
    greatest = found(wall, "la-associated").multiplier
    result = found(wall)
    assert result.bracket is not None
    assert greatest is not None
    assert result.bracket[0] <= greatest * (1.0 + FORCES)
    assert result.multiplier == pytest.approx(greatest, rel=1e-3)
    assert result.details["spread"] < 1e-3  # whatever the order
    dry = found(replace(wall, dilatancy=np.zeros_like(wall.dilatancy))).multiplier
    assert dry is not None
    assert dry <= greatest * (1.0 + STATED)


def test_joints_with_strength_lift_too():
    wall = dilatant(assembly(running_bond(4, 2), 0.65, cohesion=2.0, tensile_strength=1.0), 1.0)
    assert found(wall).multiplier == pytest.approx(found(wall, "la-associated").multiplier, rel=STATED)


def test_judge_refuses_a_measured_motion_without_the_lift():
    """The motion of a block that slides level is one of a dry joint, and penetrates one that dilates."""
    dry = assembly(stack(1, 1.0, 0.2), 0.5)
    level, wall = found(dry), dilatant(dry, 1.0)
    said = judge(wall, level, FORCES)
    assert said.accepted is False
    assert "motion_interpenetration" in said.sentence
    lifted = found(wall)
    assert judge(dry, lifted, FORCES).accepted is False  # which opens under force
    assert lifted.mechanism is not None
    opening, slip = relative_velocities(wall, np.asarray(lifted.mechanism))
    assert opening == pytest.approx(np.tile(0.5 * abs(slip)[:, None], 2), abs=1e-9 * float(abs(slip).max()))


def test_pymunk_does_not_dilate_and_says_so():
    result, _ = answered(load_method("de"), dilatant(assembly(stack(1, 1.0, 0.2), 0.5), 0.5), engine="pymunk")
    assert result.status is Status.REFUSED
    assert "do not dilate" in result.sentence


@pytest.mark.slow
def test_dilatancy_of_the_friction_ends_at_the_associated_maximum_of_small_library_walls():
    held = 0
    for folder in case_folders([shipped_cases()]).values():
        wall = read_case(folder).assembly
        if wall.n_free > 32 or wall.crushes or wall.breaks or np.any(wall.support_motion) or len(wall.bars):
            continue
        (own, _), greatest = answered(load_method("de"), dilatant(wall, 1.0)), found(wall, "la-associated")
        if own.status is Status.OK and own.multiplier is not None and greatest.multiplier is not None:
            assert own.multiplier == pytest.approx(greatest.multiplier, rel=STATED, abs=1e-6), folder.name
            held += 1
    assert held > 25
