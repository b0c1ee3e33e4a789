"""Requirements on a measured motion: one that the joints do not allow is rejected, whatever its multiplier is worth."""

from __future__ import annotations

import numpy as np
import pytest

from harness.engine.judge import judge
from harness.engine.measured_motion import TOLERANCE, motion_residuals
from harness.model.details import MOVING_FORCES
from harness.model.method import Finding, Status
from harness.model.result import Result
from tests.walls import assembly, stack

WIDTH, HEIGHT, FRICTION = 0.4, 0.8, 0.7


def rocking():
    """A slender block at the load that tips it about its right end, with the motion and the forces by hand."""
    wall = assembly(stack(1, WIDTH, HEIGHT), FRICTION)
    block = int(wall.free[0])
    multiplier = WIDTH / HEIGHT
    # Clockwise about the right end of its base, which lies (WIDTH / 2, -HEIGHT / 2) from the centroid.
    motion = np.zeros((wall.n_blocks, 3))
    motion[block] = -1.0 * np.array([-0.5 * HEIGHT, -0.5 * WIDTH, 1.0])
    weight = wall.weight[block]
    pressed = (wall.end1[0, 0], wall.end2[0, 0]).index(max(wall.end1[0, 0], wall.end2[0, 0]))
    forces = np.zeros((1, 3))
    forces[0, pressed] = weight
    upward = 1.0 if wall.block_b[0] == block else -1.0
    forces[0, 2] = -upward * np.sign(wall.tangent[0, 0]) * multiplier * weight
    return wall, motion, forces, multiplier


def result(wall, motion, forces, multiplier, moving=True):
    """The answer of a method that measures."""
    return Result(
        case="rocking",
        method="measured",
        family="measured",
        status=Status.OK,
        finding=Finding.COLLAPSES,
        sentence="",
        multiplier=multiplier,
        bracket=(multiplier, multiplier),
        forces=forces.tolist(),
        mechanism=motion.tolist(),
        flow="approximate",
        blocks=1,
        interfaces=1,
        details={MOVING_FORCES: forces.tolist()} if moving else {},
    )


def test_a_block_that_tips_about_its_corner_is_accepted():
    wall, motion, forces, multiplier = rocking()
    said = judge(wall, result(wall, motion, forces, multiplier), 1e-9)
    assert said.accepted, said.sentence
    motion_only = {name: value for name, value in said.residuals.items() if name.startswith("motion_")}
    assert len(motion_only) == 5
    assert max(motion_only.values()) < 1e-12  # rounding
    assert said.worst is not None
    assert not said.worst[0].startswith("motion_")


@pytest.mark.parametrize("factor", [0.1, 0.3162, 0.75, 1.3, 3.162, 10.0, -1.0])
def test_rotations_in_other_units_are_rejected(factor):
    wall, motion, forces, multiplier = rocking()
    said = judge(wall, result(wall, motion * [1.0, 1.0, factor], forces, multiplier), 1e-9)
    assert said.accepted is False
    assert "measured motion" in said.sentence


def test_each_law_of_the_joints_is_asked_for():
    wall, motion, forces, multiplier = rocking()
    block = wall.free[0]
    fastest = float(np.hypot(WIDTH, HEIGHT))  # of the corner opposite to the hinge

    def changed(step):
        other = motion.copy()
        other[block] += step
        return motion_residuals(wall, other, multiplier, forces)

    sunk, lifted, slid = (changed(np.array(step) * fastest) for step in ([0, -0.1, 0], [0, 0.1, 0], [0.1, 0, 0]))
    assert sunk["motion_interpenetration"] > TOLERANCE
    assert lifted["motion_opening"] > TOLERANCE >= lifted["motion_interpenetration"]
    # At multiplier 1/2 friction .7 is not at its limit.
    assert slid["motion_sliding"] > TOLERANCE >= max(slid["motion_opening"], slid["motion_interpenetration"])
    ground = motion.copy()
    ground[int(np.flatnonzero(wall.fixed)[0]), 0] = 0.1 * fastest
    assert motion_residuals(wall, ground, multiplier, forces)["motion_supports"] > TOLERANCE


def test_without_its_forces_a_motion_must_not_penetrate():
    wall, motion, forces, multiplier = rocking()
    assert judge(wall, result(wall, motion, forces, multiplier, moving=False), 1e-9).accepted
    turned = result(wall, motion * [1.0, 1.0, 3.0], forces, multiplier, moving=False)
    assert judge(wall, turned, 1e-9).accepted is False


@pytest.mark.parametrize("given", ["many", [[0.0, 0.0]], [[0.0, 0.0, float("nan")]], [[1.0, 2.0, 3.0]] * 2])
def test_forces_of_a_motion_that_are_none_are_rejected(given):
    wall, motion, forces, multiplier = rocking()
    wrong = result(wall, motion, forces, multiplier)
    wrong.details[MOVING_FORCES] = given
    said = judge(wall, wrong, 1e-9)
    assert said.accepted is False
    assert "1 finite triples" in said.sentence
