"""Requirements on the strips and the orders that `de` is built on."""

from __future__ import annotations

import numpy as np
import pytest

from methods.de.engines.mass_scaling import courses, insertion_orders, tunings
from methods.de.engines.pymunk_joints import polygon_gyration
from methods.de.engines.strips import CannotModel, build_strips, colour_strips
from tests.walls import assembly, running_bond, stack


def test_strips_touch_their_partner_between_the_contact_points():
    wall = assembly(running_bond(4, 2))
    strips = build_strips(wall, wall.length_scale)
    along = np.einsum("pvk,pk->pv", strips.on_a[:, :2], wall.tangent)
    ends = np.stack([np.sum((e - wall.middle) * wall.tangent, axis=1) for e in (wall.end1, wall.end2)], axis=1)
    assert np.allclose(along, ends / wall.length_scale, atol=1e-12)


def test_neighbouring_strips_have_different_colours():
    wall = assembly(running_bond(8, 4))
    strips = build_strips(wall, wall.length_scale)
    vertices = np.concatenate([strips.on_a, strips.on_b], axis=1)
    low, high = vertices.min(axis=1), vertices.max(axis=1)
    for p in range(len(low)):
        meets = np.all((low[p] <= high) & (low <= high[p]), axis=1)
        meets[p] = False
        assert not np.any(strips.colour[meets] == strips.colour[p])


def test_more_than_32_interfaces_in_one_place_are_refused():
    one = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    with pytest.raises(CannotModel, match="33 interfaces lie close together"):
        colour_strips(np.repeat(one[None], 33, axis=0), margin=0.0)


def test_courses_count_from_the_supports():
    wall = assembly(stack(4))
    assert courses(wall).tolist() == [0, 1, 2, 3, 4]


def test_orders_are_permutations_and_repeatable():
    wall = assembly(running_bond(4, 3))
    first = insertion_orders(wall, courses(wall), 6, seed=3)
    again = insertion_orders(wall, courses(wall), 6, seed=3)
    for (name, blocks, joints), (name2, blocks2, joints2) in zip(first, again, strict=True):
        assert name == name2
        assert np.array_equal(blocks, blocks2)
        assert np.array_equal(joints, joints2)
        assert sorted(blocks) == sorted(wall.free)
        assert sorted(joints) == list(range(wall.n_interfaces))


def test_a_given_mass_decay_leaves_one_tuning():
    wall = assembly(stack(4))
    assert [t.mass_decay for t in tunings(courses(wall), 0.1)] == [0.1]


def test_gyration_of_a_square_is_a_sixth_of_its_side_squared():
    square = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    assert polygon_gyration(square) == pytest.approx(1 / 6)
