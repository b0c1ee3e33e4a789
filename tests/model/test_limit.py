"""What the numbers of a wall tell of its multiplier, by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from harness.model.assembly import Assembly
from harness.model.limit import WRITTEN, accuracy, gross_power, smallest_resolved, strengthened
from tests.walls import assembly, stack


@pytest.fixture
def block() -> Assembly:
    """One block of .4 x .4 and weight 20 x .16, pushed to the right by its weight."""
    return assembly(stack(1, width=0.4, height=0.4))


def test_coordinates_about_a_block_are_meant_to_eight_digits(block):
    assert accuracy(block) == pytest.approx(1e-8, rel=1e-5)


def test_in_a_national_grid_the_last_place_of_the_coordinates_counts(block):
    far = replace(block, polygons=tuple(polygon + 5e6 for polygon in block.polygons))
    step = 2.0**-52 * abs(np.concatenate(far.polygons)).max()
    assert accuracy(far) == pytest.approx(1e-8 + 16.0 * step / 0.4)


def test_gross_power_is_load_times_the_fastest_speed_of_the_block(block):
    weight = 20.0 * 0.16
    still = np.zeros((block.n_blocks, 3))
    sliding, turning = still.copy(), still.copy()
    sliding[block.free, 0] = 2.0
    turning[block.free, 2] = 2.0
    assert gross_power(block, still) == 0.0
    assert gross_power(block, sliding) == pytest.approx(2.0 * weight)
    assert gross_power(block, turning) == pytest.approx(2.0 * weight * np.hypot(0.2, 0.2))


def test_a_sliding_block_tells_a_multiplier_of_its_accuracy(block):
    sliding = np.zeros((block.n_blocks, 3))
    sliding[block.free, 0] = 3.0
    assert smallest_resolved(block, sliding) == pytest.approx(accuracy(block))
    assert smallest_resolved(replace(block, live=10.0 * block.live), sliding) == pytest.approx(0.1 * accuracy(block))


def test_without_live_work_only_zero_is_zero(block):
    back = np.zeros((block.n_blocks, 3))
    back[block.free, 0] = -1.0
    assert smallest_resolved(block, back) == 0.0


def test_a_heavy_block_at_rest_does_not_widen_what_is_told():
    wall = assembly(stack(2, width=0.4, height=0.4))
    top = wall.free[np.argmax(wall.centroid[wall.free, 1])]
    sliding = np.zeros((wall.n_blocks, 3))
    sliding[top, 0] = 1.0
    dead = wall.dead.copy()
    dead[[i for i in wall.free if i != top]] *= 1e9
    assert smallest_resolved(replace(wall, dead=dead), sliding) == smallest_resolved(wall, sliding)


def test_a_strengthened_wall_has_longer_contacts_and_more_friction(block):
    share = 0.5 * accuracy(block)
    strong = strengthened(block)
    assert strong.friction == pytest.approx(block.friction + share, abs=1e-16)
    assert strong.length - block.length == pytest.approx(2.0 * share * 0.4, rel=1e-5)
    assert 2.0 * share * 0.9 < WRITTEN
