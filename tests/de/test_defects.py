"""Requirements on imperfect contacts: seeded, one-sided, and of the size the experiment points at."""

from __future__ import annotations

import numpy as np
import pytest

from methods.de.uneven.defects import closed_contacts, crown, cut_corners, lose_contacts
from tests.de.answers import run
from tests.walls import assembly, running_bond, stack


def test_cuts_repeat_with_their_seed_and_stay_below_their_size():
    wall = assembly(running_bond(6, 3), 0.75)
    one, two, other = (cut_corners(wall, 0.05, seed=seed) for seed in (1, 1, 2))
    assert np.array_equal(one.end1, two.end1)
    assert not np.array_equal(one.end1, other.end1)
    moved = np.linalg.norm(one.end1 - wall.end1, axis=1)
    assert 0.0 < moved.max() <= 0.05 * 0.2
    assert np.allclose(one.tangent, wall.tangent)


def test_no_defect_leaves_the_wall_alone():
    wall = assembly(running_bond(4, 2))
    assert np.array_equal(cut_corners(wall, 0.0).end1, wall.end1)


def test_defects_of_beds_leave_heads_alone():
    wall = assembly(running_bond(4, 2))
    cut = cut_corners(wall, 0.1, faces="beds", seed=4)
    head = np.array([joint == "head" for joint in wall.joint])
    assert np.array_equal(cut.end1[head], wall.end1[head])
    assert not np.array_equal(cut.end1[~head], wall.end1[~head])


def test_crowned_beds_lower_overturning_in_proportion():
    wall = crown(assembly(stack(1, 0.2, 0.4), 0.7), 0.2)
    assert run(wall, orders=1).multiplier == pytest.approx(0.6 * 0.5, rel=5e-4)


def test_crown_of_half_the_length_is_refused():
    with pytest.raises(ValueError, match=r"below 0\.5"):
        crown(assembly(stack(1)), 0.5)


def test_chipped_corners_of_a_twentieth_of_the_height_cost_a_few_percent():
    wall = assembly(running_bond(6, 3), 0.75)
    loads = [run(cut_corners(wall, 0.05, seed=seed), orders=1, accuracy=2e-3).multiplier for seed in range(3)]
    assert 0.95 < np.mean(loads) / (13 / 23) < 0.995


def test_contacts_that_carry_nothing_can_be_left_out():
    wall = assembly(running_bond(4, 2))
    dead = run(wall, orders=1)
    closed = closed_contacts(wall, dead.forces)
    beds = np.array([joint == "bed" for joint in wall.joint])
    assert closed[beds].sum() > 0
    assert wall.with_joints(closed).n_interfaces == closed.sum()


def test_lost_contacts_are_seeded():
    wall = assembly(running_bond(6, 3))
    assert lose_contacts(wall, 0.0).n_interfaces == wall.n_interfaces
    some = lose_contacts(wall, 0.3, seed=5)
    assert some.joint == lose_contacts(wall, 0.3, seed=5).joint
    assert some.n_interfaces < wall.n_interfaces
