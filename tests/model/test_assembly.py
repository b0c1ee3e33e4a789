"""Sizes and scales of a wall by hand: what is small is small against these."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.model.assembly import Assembly, polygon_area, signed_area
from tests.known_walls import box, of_blocks

L_SHAPE = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]])


def two_blocks(**loads: Any) -> Assembly:
    """Blocks of 2 x 2 and 4 x 1, of weight 10 and 30, on the ground."""
    return of_blocks([box("a", 0.0, 0.0, 2.0, 2.0, weight=10.0), box("b", 4.0, 0.0, 4.0, 1.0, weight=30.0)], 0.5, loads)


def test_area_of_an_outline_has_the_sign_of_its_direction_wherever_it_lies():
    for size, shift in ((1.0, 0.0), (1.0, 4e6), (0.1, 4e6 + 0.1)):  # a tenth in a national grid: no number is exact
        shape, area = size * L_SHAPE + shift, 4.0 * size**2
        assert signed_area(shape) == pytest.approx(area)
        assert signed_area(shape[::-1]) == pytest.approx(-area)
        assert polygon_area(shape[::-1]) == pytest.approx(area)


def test_sizes_are_those_of_the_free_blocks():
    wall = two_blocks()
    assert wall.length_scale == pytest.approx((2.0 + 2.0) / 2.0)
    assert wall.middle.tolist() == [3.5, 0.75]
    assert wall.radius[wall.free] == pytest.approx([np.sqrt(2.0), np.sqrt(4.25)])
    points, block = wall.corners
    assert block.tolist() == [0] * 4 + [1] * 4 + [2] * 4
    assert points[4:8].tolist() == [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]


def test_forces_are_measured_by_the_dead_load_else_the_weight_else_the_live_load():
    wall = two_blocks(live={"body": [{"per_weight": [0.3, 0.4]}]})
    assert wall.force_scale == pytest.approx(40.0)
    dead = np.zeros((3, 3))
    dead[wall.free] = [[3.0, 4.0, 100.0], [0.0, -5.0, 0.0]]
    assert replace(wall, dead=dead).force_scale == pytest.approx(10.0)
    weightless = replace(wall, dead=np.zeros((3, 3)))
    assert weightless.force_scale == pytest.approx(40.0)
    weightless = replace(weightless, weight=np.zeros(3))
    assert weightless.force_scale == pytest.approx(20.0)
    turned = weightless.live + np.array([0.0, 0.0, 7.0])
    assert replace(weightless, live=turned).force_scale == pytest.approx(20.0)
    assert replace(weightless, live=np.zeros((3, 3))).force_scale == 1.0


def test_unit_of_multipliers_by_hand():
    wall = two_blocks()
    live = np.zeros((3, 3))
    live[wall.free] = [[3.0, -4.0, -6.0], [0.0, 0.0, 4.0]]  # 5 + 6 / 2 and 4 / 2
    assert replace(wall, live=live).load_unit == pytest.approx(40.0 / 10.0)
    assert two_blocks(live={"body": [{"per_weight": [0.0, 1.0]}]}).load_unit == pytest.approx(1.0)
    assert replace(wall, live=np.zeros((3, 3))).load_unit == 1.0
    assert (wall.has_live_load, replace(wall, live=live).has_live_load) == (False, True)


def test_a_wall_dilates_where_one_joint_does():
    wall = two_blocks()
    assert not wall.dilates
    assert replace(wall, dilatancy=np.array([0.0, 0.1])).dilates
    with pytest.raises(ValueError, match="dilatancy has 1 entries for 2"):
        replace(wall, dilatancy=np.array([0.0]))


def test_further_joints_are_plain_where_nothing_is_said_of_them():
    wall = two_blocks()
    names = ("block_a", "block_b", "end1", "end2", "face1", "face2", "normal", "friction", "dilatancy")
    given: dict[str, Any] = {name: getattr(wall, name)[:1] for name in names}
    found = wall.with_further_joints(("again",), **given)
    m = wall.n_interfaces
    assert (found.n_interfaces, found.joint[m:]) == (m + 1, ("again",))
    assert [found.crushing[m], found.brittle[m], found.bar_stiffness[m]] == [np.inf, False, 0.0]
    assert found.constant[m].tolist() == [0.0] * 4
    assert np.array_equal(found.with_joints(np.arange(m)).end1, wall.end1)
    with pytest.raises(KeyError, match="friction"):
        wall.with_further_joints(("again",), **{name: given[name] for name in names if name != "friction"})
