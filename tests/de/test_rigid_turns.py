"""Blocks that turn together as one rigid body do not shear the joints between them."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.assembly import FloatArray
from methods.de.engines.soft_wall import ExplicitTuning, SoftWall
from tests.walls import assembly, running_bond, stack

WALLS = {"bond": assembly(running_bond(3, 2), 0.65), "stack": assembly(stack(3), 0.5)}
CENTRE = np.array([0.37, -0.8])


def turning(name: str, angle: float, speed: float, strayed: float) -> tuple[SoftWall, FloatArray]:
    """A wall turned about a point, pressed and rough, with the velocity it has when it turns on from `angle - strayed`.

    Args:
        name: of the wall; angle: it is turned by; speed: of the turning; strayed: by how much less the velocities are.

    Returns:
        the wall, and (2m,) from the corner's centroid to the face's, along the face of each contact [length].
    """
    wall = WALLS[name]
    soft = SoftWall(wall, 1e4, 0.5, 0.01 * wall.length_scale)
    contacts = soft.contacts
    soft.contacts = contacts._replace(radius=1.001 * contacts.radius, friction=np.full(len(contacts.kn), 1e9))
    arm = wall.centroid - CENTRE
    soft.places[:, :2] = turned(arm, angle) - arm
    soft.places[:, 2] = angle
    before = turned(arm, angle - strayed)
    soft._velocity[:] = speed * np.column_stack([-before[:, 1], before[:, 0], np.ones(len(before))])
    between = turned(arm[contacts.face] - arm[contacts.corner], angle)
    return soft, (between * turned(contacts.along, angle)).sum(axis=1) * contacts.side


def turned(vectors: FloatArray, angle: float) -> FloatArray:
    """Vectors (k, 2) turned by an angle."""
    return vectors @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


@pytest.mark.parametrize("name", WALLS)
@pytest.mark.parametrize("angle", [0.0, 0.3, -1.2])
@pytest.mark.parametrize("speed", [1e-3, -0.5])
def test_blocks_that_turn_as_one_body_do_not_shear_their_joints(name: str, angle: float, speed: float):
    """Both blocks of a contact have the same velocity at the point of contact, to rounding of its terms."""
    soft, _ = turning(name, angle, speed, 0.0)
    soft.advance(1)
    size = soft.contacts.kt.max() * ExplicitTuning().time_step * abs(speed) * soft.assembly.length_scale
    assert abs(soft.shear).max() <= 1e-14 * size


@pytest.mark.parametrize("step", [1e-3, -1e-3, 1e-4])
def test_a_finite_step_of_turning_shears_by_the_square_of_its_angle(step: float):
    """The velocity of a step is that before it: (omega dt)^2 times the distance of the centroids, and no more."""
    soft, between = turning("bond", 0.2, step / ExplicitTuning().time_step, step)
    soft.advance(1)
    expected = soft.contacts.kt * step**2 * between
    # The next term of the series is smaller by the angle of the step.
    np.testing.assert_allclose(soft.shear, expected, atol=2.0 * abs(step) * abs(expected).max())
    assert abs(expected).max() > 0.1 * soft.contacts.kt.max() * step**2 * soft.assembly.length_scale
