"""Requirements on walls of uneven blocks: even ones as before, scatter, contacts for any method."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.method import Finding
from methods.de.uneven.settled_contacts import load_uneven, settle_uneven, uneven_blocks
from tests.de.answers import run, unbalanced
from tests.walls import assembly, running_bond, stack


def test_even_blocks_have_the_exact_multiplier():
    wall = assembly(stack(3, 0.4, 0.2), 0.9)
    found = load_uneven(wall, 0.0, accuracy=0.01)
    # Step of the bisection, and 0.5 % for the finite overlap and displacement.
    assert found.stood <= 2 / 3 * 1.005
    assert found.fell >= 2 / 3 * 0.99
    assert found.fell - found.stood <= 0.01


def test_uneven_blocks_scatter_about_the_even_multiplier():
    # Cuts shorten the base and lower the centroids alike: for a stack the load may rise as well as fall.
    wall = assembly(stack(3, 0.4, 0.2), 0.9)
    found = [load_uneven(wall, 0.1, seed=seed, step=0.04, accuracy=0.02) for seed in range(4)]
    fell = np.array([loading.fell for loading in found])
    assert np.ptp(fell) > 0.03
    assert np.all(np.abs(fell / (2 / 3) - 1) < 0.15)


def test_uneven_blocks_repeat_with_their_seed_and_lose_area():
    wall = assembly(running_bond(4, 2))
    one, two, other = (uneven_blocks(wall, 0.05, seed=seed) for seed in (1, 1, 2))
    assert all(np.array_equal(a, b) for a, b in zip(one, two, strict=True))
    assert not np.array_equal(one[1], other[1])
    assert np.array_equal(one[0], wall.polygons[0])
    for outline, polygon in zip(one[1:], wall.polygons[1:], strict=True):
        assert np.ptp(outline[:, 0]) <= np.ptp(polygon[:, 0])
        assert np.ptp(outline[:, 1]) <= np.ptp(polygon[:, 1])


def test_settled_wall_is_an_assembly_that_stands_on_its_closed_contacts():
    wall = assembly(running_bond(3, 2), 0.75)
    settled = settle_uneven(wall, 0.02, seed=3)
    assert settled.at_rest
    imperfect = settled.assembly
    assert 0 < imperfect.n_interfaces < wall.n_interfaces
    assert settled.single_points > 0
    assert np.allclose(np.linalg.norm(imperfect.normal, axis=1), 1.0)
    assert np.allclose(np.sum(imperfect.normal * imperfect.tangent, axis=1), 0.0, atol=1e-12)
    towards = np.sum(
        (imperfect.centroid[imperfect.block_b] - imperfect.centroid[imperfect.block_a]) * imperfect.normal, 1
    )
    assert np.all(towards > 0.0)
    answer = run(imperfect, orders=1)
    assert answer.finding is Finding.COLLAPSES
    assert unbalanced(imperfect, answer) < 1e-5


def test_a_wall_that_does_not_stand_even_is_said_to_fall():
    wall = assembly(stack(3) | {"offsets": [0.0, 0.0, 0.2]}, 0.7)
    found = load_uneven(wall, 0.0, most_steps=4000)
    assert found.stood is None
    assert found.fell == pytest.approx(0.0)


def test_gaps_that_close_while_the_wall_settles_are_no_fall():
    # The top course sinks by nearly half a block size until all gaps are closed.
    wall = assembly(running_bond(6, 3), 0.75)
    found = load_uneven(wall, 0.12, greatest=0.02)
    assert found.stood == pytest.approx(0.02)
