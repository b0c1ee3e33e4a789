"""Velocities of a wall by hand: of its vertices, across its joints, and what its joints are called for them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.model.displaced import DisplacedState, carried, released
from harness.model.load_steps import UNKNOWN, LoadSteps
from harness.model.method import Answer, Finding, Status
from harness.model.result import (
    Result,
    contact_states,
    fastest_vertex,
    measured_width,
    normalised_mechanism,
    relative_velocities,
    result_of,
    vertex_velocities,
)
from tests.known_walls import box, of_blocks

WALL = of_blocks([box("a", 0.0, 0.0, 2.0, 4.0), box("b", 0.0, 4.0, 2.0, 2.0)])
"""Block a on the ground, block b on a; centroids (1, 2) and (1, 5)."""


def motion(a: Any, b: Any) -> Any:
    return np.array([[0.0, 0.0, 0.0], a, b], dtype=float)


def joint(first: str, second: str) -> int:
    names = {first, second}
    return next(
        p
        for p, (a, b) in enumerate(zip(WALL.block_a, WALL.block_b, strict=True))
        if {WALL.block_ids[a], WALL.block_ids[b]} == names
    )


def test_a_point_moves_across_its_arm_where_its_block_turns():
    points = np.array([[3.0, 2.0], [1.0, 5.0]])
    found = vertex_velocities(points, np.array([1.0, 2.0]), np.array([0.5, -0.25, 2.0]))
    assert found.tolist() == [[0.5, -0.25 + 2.0 * 2.0], [0.5 - 2.0 * 3.0, -0.25]]
    each = vertex_velocities(points, np.array([[1.0, 2.0], [1.0, 4.0]]), np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 3.0]]))
    assert each.tolist() == [[1.0, 0.0], [-3.0, 0.0]]


def test_the_fastest_vertex_of_a_block_that_turns_is_the_farthest():
    # Corners of a lie 1 and 2 from its centroid across and along.
    assert fastest_vertex(WALL, motion([0, 0, 3], [0, 0, 0])) == pytest.approx(3.0 * np.sqrt(5.0))
    assert fastest_vertex(WALL, motion([3, 4, 0], [0, 0, 0])) == pytest.approx(5.0)


@pytest.mark.parametrize("size", [1e-250, 1.0, 1e250])
def test_a_mechanism_of_any_size_is_scaled_to_a_fastest_vertex_of_one(size: float):
    found = normalised_mechanism(WALL, size * motion([0, 0, 0], [3, 4, 0]))
    np.testing.assert_allclose(found, motion([0, 0, 0], [0.6, 0.8, 0]), atol=1e-15)
    at_rest = np.zeros((3, 3))
    assert normalised_mechanism(WALL, at_rest) is at_rest
    endless = motion([np.inf, 0, 0], [0, 0, 0])
    assert normalised_mechanism(WALL, endless) is endless


def across(mechanism: Any) -> tuple[list[float], float]:
    """Openings in ascending order and the slip to the right of the upper block on the joint of a and b."""
    opening, slip = relative_velocities(WALL, mechanism)
    p = joint("a", "b")
    upper_is_b = WALL.block_ids[WALL.block_b[p]] == "b"
    way = WALL.tangent[p, 0] if upper_is_b else -WALL.tangent[p, 0]
    return sorted(opening[p].tolist()), float(way * slip[p])


def test_openings_and_slip_of_a_joint_are_those_of_its_two_ends():
    assert across(motion([0, 0, 0], [0.25, 0.5, 0])) == ([0.5, 0.5], 0.25)
    # b turns about its centroid, 1 above the joint, whose ends lie 1 to the left and to the right: they move by 2 w.
    assert across(motion([0, 0, 0], [0, 0, 0.5])) == ([-0.5, 0.5], 0.5)
    assert across(motion([1, 2, 0], [1, 2, 0])) == ([0.0, 0.0], 0.0)
    # Both turn about the middle of their joint, at (1, 4), as one.
    assert across(motion([1, 0, 0.5], [-0.5, 0, 0.5])) == ([0.0, 0.0], 0.0)


@pytest.mark.parametrize(
    ("b", "state"),
    [
        ([0, 0, 0], "stick"),
        ([1, 0, 0], "slip"),
        ([0, 1, 0], "open"),
        ([-1, 1, 1], "rock"),  # about one end of the joint: the other opens
        ([9e-6, 0, 0], "stick"),
        ([1.1e-5, 0, 0], "slip"),
    ],
)
def test_states_of_a_joint_for_a_motion_of_the_block_upon_it(b: list[float], state: str):
    wall = of_blocks([box("a", 0.0, 0.0, 2.0, 4.0), box("b", 0.0, 4.0, 2.0, 2.0), box("c", 8.0, 0.0, 1.0, 1.0)])
    # A block apart moves at speed one, so that slow motions stay slow when the mechanism is scaled.
    mechanism = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], b, [1.0, 0.0, 0.0]])
    p = next(p for p, pair in enumerate(zip(wall.block_a, wall.block_b, strict=True)) if set(pair) == {1, 2})
    found = contact_states(wall, mechanism)
    assert found is not None
    assert found[p] == state


def test_without_a_mechanism_no_joint_has_a_state():
    assert contact_states(WALL, None) is None


@pytest.mark.parametrize(
    ("changes", "width"),
    [
        ({}, 0.25),
        ({"bracket": (-0.4, -0.3), "multiplier": -0.35}, 0.25),
        ({"bracket": None}, None),
        ({"multiplier": 0.0}, 0.25),  # what its ends are shares of is not the multiplier
        ({"bracket": (0.0, 0.0), "multiplier": 0.0}, None),
        ({"finding": Finding.AT_LIMIT, "bracket": (0.0, 0.4), "multiplier": 0.0}, None),
        ({"flow": "non-associated"}, None),
    ],
)
def test_the_width_of_a_measured_bracket_is_a_share_of_its_larger_end(changes: dict[str, Any], width: float | None):
    answer = Answer(Status.OK, Finding.COLLAPSES, "", 0.35, (0.3, 0.4), flow="approximate")
    found = measured_width(replace(answer, **changes))
    assert found == (None if width is None else pytest.approx(width))


def result(answer: Answer) -> Result:
    return result_of(answer, WALL, case="wall", method="la", family="la")


def test_a_result_keeps_forces_motion_and_their_multiplier():
    forces = np.arange(3.0 * WALL.n_interfaces).reshape(-1, 3)
    answer = Answer(Status.OK, Finding.COLLAPSES, "It slides.", 0.5, forces=forces, details={"unknowns": 7})
    found = result(answer)
    np.testing.assert_array_equal(found.forces, forces)
    assert (found.forces_multiplier, found.unknowns) == (0.5, 7)
    assert (found.blocks, found.interfaces, found.mechanism, found.states) == (2, WALL.n_interfaces, None, None)
    moved = result(replace(answer, forces=None, forces_multiplier=0.25, mechanism=motion([2, 0, 0], [2, 0, 0])))
    assert (moved.forces, moved.forces_multiplier) == (None, 0.25)
    np.testing.assert_array_equal(moved.mechanism, motion([1, 0, 0], [1, 0, 0]))
    assert moved.states is not None
    assert [moved.states[joint("a", "b")], moved.states[joint("g", "a")]] == ["stick", "slip"]


def test_a_displaced_state_is_read_as_it_was_written():
    assert DisplacedState.of({}) is None
    vectors = [np.array([[1.0, 2.0]]), np.array([[0.0, 1.0]]), np.array([[3.0, 4.0]])]
    state = DisplacedState(np.ones((3, 3)), np.array([1]), np.array([2]), *vectors)
    again = DisplacedState.of(state.as_details())
    assert again is not None
    for name, value in vars(state).items():
        assert getattr(again, name).dtype == value.dtype
        assert getattr(again, name).tolist() == value.tolist()


@pytest.mark.parametrize(
    ("release", "seen"),
    [
        ({"frames": [[[0, 0, 0]] * 3, [[1, 0, 0]] * 3]}, True),
        ({"frames": [[[0, 0, 0]] * 3]}, False),  # one frame is no motion
        ({"frames": [[[0, 0, 0]] * 2] * 2}, False),  # of another wall
        ({"frames": [[0, 0, 0], [1, 0, 0]]}, False),
        ({"frames": None}, False),
        (None, False),
    ],
)
def test_a_collapse_that_was_followed_has_frames_of_all_blocks(release: Any, seen: bool):
    found = released(result(Answer(Status.OK, Finding.FALLS, "", details={"release": release} if release else {})), 3)
    assert (found is not None) is seen
    assert found is None or found.shape == (2, 3, 3)


def test_blocks_are_carried_by_shifts_and_quarter_turns_about_their_centroids():
    ground, a, b = carried(WALL, np.array([[0.0, 0.0, 0.0], [10.0, 20.0, np.pi / 2], [0.0, 0.0, np.pi]]))
    assert ground.tolist() == WALL.polygons[0].tolist()
    # Corner (0, 0) of a lies (-1, -2) from its centroid (1, 2), turned (2, -1); of b (-1, -1) from (1, 5).
    np.testing.assert_allclose(a[WALL.polygons[1].tolist().index([0.0, 0.0])], [13.0, 21.0], atol=1e-12)
    np.testing.assert_allclose(b[WALL.polygons[2].tolist().index([0.0, 4.0])], [2.0, 6.0], atol=1e-12)


def test_load_steps_of_a_component_are_placed_in_the_whole_wall():
    wall = of_blocks([box("a", 0.0, 0.0), box("b", 6.0, 0.0), box("c", 6.0, 1.0)])
    blocks = ("g", "b", "c")
    steps = LoadSteps(
        blocks, np.array([0.0, 0.5]), np.arange(18.0).reshape(2, 3, 3), np.arange(12.0).reshape(2, 2, 3),
        np.array([[0, 1], [2, 3]]),
    )  # fmt: skip
    found = LoadSteps.of(steps.as_details(), wall)
    assert found is not None
    assert (found.blocks, found.multiplier.tolist()) == (wall.block_ids, [0.0, 0.5])
    place = [wall.block_ids.index(name) for name in blocks]
    own = [p for p in range(3) if "a" not in (wall.block_ids[wall.block_a[p]], wall.block_ids[wall.block_b[p]])]
    other = next(p for p in range(3) if p not in own)
    assert found.displacements[:, place].tolist() == steps.displacements.tolist()
    assert not found.displacements[:, wall.block_ids.index("a")].any()
    assert found.forces[:, own].tolist() == steps.forces.tolist()
    assert not found.forces[:, other].any()
    assert found.states[:, own].tolist() == steps.states.tolist()
    assert found.states[:, other].tolist() == [UNKNOWN, UNKNOWN]
    assert LoadSteps.of({}, wall) is None
    assert LoadSteps.of(replace(steps, blocks=("g", "x", "c")).as_details(), wall) is None
    for name in ("displacements", "forces", "states"):
        less = replace(steps, **{name: getattr(steps, name)[:1]})
        assert LoadSteps.of(less.as_details(), wall) is None
