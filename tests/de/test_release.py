"""Requirements on the collapse that is followed: it falls above the multiplier and stands below."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.method import Finding
from methods.de.damped_holds import ReleasedCollapse
from methods.de.engines.pymunk_blocks import convex_parts
from methods.de.holds.release import ReleaseSettings, even_frames, release
from tests.walls import assembly, running_bond, stack


def test_released_wall_moves_as_its_mechanism_says():
    wall = assembly(running_bond(6, 3))
    answer = ReleasedCollapse().solve(wall, ReleaseSettings(orders=1))
    assert answer.finding is Finding.COLLAPSES
    history = answer.details["release"]
    assert history["reached"]
    assert len(answer.path["time"]) == len(history["frames"]) <= 40
    assert len(history["separated"]) > 0
    last = np.array(history["frames"][-1])
    cosine = np.sum(last * answer.mechanism) / np.linalg.norm(last) / np.linalg.norm(answer.mechanism)
    assert cosine > 0.8
    travel = np.array(answer.path["live_displacement"])
    assert np.all(np.diff(travel) > 0.0)


@pytest.mark.parametrize(("factor", "falls"), [(0.9, False), (1.1, True)])
def test_stack_released_below_and_above_its_exact_multiplier(factor, falls):
    wall = assembly(stack(3, 0.4, 0.2), 0.9)
    followed = release(wall, factor * 2.0 / 3.0, ReleaseSettings(release_steps=5000))
    assert followed.reached is falls


def test_frictions_by_joint_are_kept_in_the_release():
    rough = {"default": 0.9, "rules": [{"between": ["1", "2"], "value": 0.1}]}
    wall = assembly(stack(3, 0.4, 0.2), rough)
    followed = release(wall, 0.3, ReleaseSettings(release_steps=5000))
    assert followed.reached
    # The block on the rough base stays; the two above slide off together.
    assert np.abs(followed.places[-1, 1]).max() < 0.01
    assert followed.places[-1, 2, 0] == pytest.approx(followed.places[-1, 3, 0], rel=0.05)


def test_frames_are_even_in_distance():
    travel = np.linspace(0.0, 1.0, 1001) ** 2
    chosen = even_frames(travel, 11)
    assert chosen[0] == 0
    assert chosen[-1] == 1000
    assert np.allclose(np.diff(travel[chosen]), 0.1, atol=0.01)


def test_a_block_that_is_not_convex_is_decomposed_without_loss():
    shape = np.array([[0.0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]])
    parts = [np.array(part) for part in convex_parts(shape)]
    areas = [np.sum(p[:, 0] * np.roll(p[:, 1], -1) - np.roll(p[:, 0], -1) * p[:, 1]) / 2 for p in parts]
    assert len(parts) >= 2
    assert sum(areas) == pytest.approx(3.0)


@pytest.mark.parametrize(("courses", "bricks", "steps"), [(13, 15, 1200), (30, 31, 240)])
def test_frames_of_a_large_wall_are_so_few_that_they_hold_twenty_thousand_numbers(
    courses: int, bricks: int, steps: int
):
    """Every twentieth step is looked at; eight frames at least, and forty at most, evenly over the way travelled."""
    wall = assembly(running_bond(courses, bricks))
    followed = release(wall, 3.0, ReleaseSettings(release_steps=steps, reach=100.0))
    looked = 1 + steps // 20
    most = min(40, looked, max(8, 20_000 // (3 * wall.n_blocks)))
    # Where two of the even distances fall between the same looks a frame is missing: here one or two.
    assert most - 2 <= len(followed.places) <= most
    assert followed.time[[0, -1]] == pytest.approx([0.0, 0.002 * steps])
    assert (followed.places.shape[1:], len(followed.time)) == ((wall.n_blocks, 3), len(followed.places))
