"""Contacts found from polygons: T-junctions, several segments, corners, gaps, non-convex blocks, size."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.build import build
from harness.model.contacts import JointLimits, find_contacts
from harness.model.wall import Wall


def rectangle(left: float, bottom: float, right: float, top: float) -> np.ndarray:
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top]])


def contacts(polygons: list[np.ndarray], tolerance: float = 1e-6, sight: float = 0.0):
    limits = JointLimits(tolerance, tolerance, 0.3, tolerance, sight)
    return find_contacts(polygons, np.zeros(len(polygons), bool), limits)


def test_t_junction_gives_one_interface_for_each_block_above():
    found = contacts([rectangle(0, 0, 2, 1), rectangle(0, 1, 0.7, 2), rectangle(0.7, 1, 2, 2)])
    segments = {
        (a, b): sorted([tuple(p), tuple(q)])
        for a, b, p, q in zip(found.block_a, found.block_b, found.start, found.end, strict=True)
    }
    assert segments == {
        (0, 1): [(0.0, 1.0), (0.7, 1.0)],
        (0, 2): [(0.7, 1.0), (2.0, 1.0)],
        (1, 2): [(0.7, 1.0), (0.7, 2.0)],
    }


def test_arch_shaped_block_touches_the_same_support_in_two_segments():
    portal = np.array([[0, 0], [1, 0], [1, 1], [2, 1], [2, 0], [3, 0], [3, 2], [0, 2]], dtype=float)
    found = contacts([rectangle(0, -1, 3, 0), portal])
    assert len(found.block_a) == 2
    assert sorted(np.abs(found.end - found.start)[:, 0].tolist()) == [1.0, 1.0]


def test_l_shaped_block_touches_its_neighbour_on_a_bed_and_on_a_head():
    corner = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], dtype=float)
    found = contacts([corner, rectangle(1, 1, 2, 2)])
    assert len(found.block_a) == 2


def test_vertex_within_a_flat_face_does_not_split_the_interface():
    base = np.array([[0, -1], [2, -1], [2, 0], [1, 0], [0, 0]], dtype=float)
    found = contacts([base, rectangle(0, 0, 2, 1)])
    assert len(found.block_a) == 1
    assert abs(found.end - found.start)[0, 0] == 2.0


def test_touch_at_a_corner_is_reported_and_is_no_interface():
    found = contacts([rectangle(0, 0, 1, 1), rectangle(1, 1, 2, 2)])
    assert len(found.block_a) == 0
    assert found.corners.tolist() == [[0, 1]]


@pytest.mark.parametrize(("gap", "expected"), [(0.5e-6, 1), (2e-6, 0), (-0.5e-6, 1)])
def test_gap_counts_as_contact_within_the_tolerance_only(gap: float, expected: int):
    found = contacts([rectangle(0, 0, 1, 1), rectangle(0, 1 + gap, 1, 2)])
    assert len(found.block_a) == expected


def test_faces_that_look_the_same_way_do_not_touch():
    found = contacts([rectangle(0, 0, 1, 1), rectangle(0, 0.5, 1, 1)])
    assert all(
        {a, b} != {0, 1} or p[1] != 1.0 for a, b, p in zip(found.block_a, found.block_b, found.start, strict=True)
    )


def test_inclined_faces_touch_along_their_common_length():
    turn = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
    found = contacts([rectangle(0, 0, 2, 1) @ turn.T, rectangle(0.5, 1, 3, 2) @ turn.T])
    assert len(found.block_a) == 1
    assert np.linalg.norm(found.end - found.start) == pytest.approx(1.5, abs=1e-12)


def test_order_of_blocks_does_not_change_the_contacts_found():
    wall = Wall.model_validate(
        {
            "format": "wall/1",
            "unit_weight": 1,
            "friction": 0.6,
            "pattern": {"type": "running_bond", "block_length": 0.4, "block_height": 0.175, "count": 8, "bricks": 5},
        }
    )
    polygons = list(build(wall).assembly.polygons)
    order = np.random.default_rng(3).permutation(len(polygons))
    one, two = contacts(polygons), contacts([polygons[k] for k in order])

    def keys(found, names):
        return sorted(
            (*sorted((names[a], names[b])), *np.round(sorted([tuple(p), tuple(q)]), 9).ravel())
            for a, b, p, q in zip(found.block_a, found.block_b, found.start, found.end, strict=True)
        )

    assert keys(one, np.arange(len(polygons))) == keys(two, order)


def test_ten_thousand_blocks_give_every_interface_of_the_bond():
    courses, bricks = 120, 84
    data = {"type": "running_bond", "block_length": 0.4, "block_height": 0.175, "count": courses, "bricks": bricks}
    built = build(Wall.model_validate({"format": "wall/1", "unit_weight": 1, "friction": 0.6, "pattern": data}))
    half, full = courses // 2, courses // 2
    heads = half * bricks + full * (bricks - 1)
    beds = (bricks + 1) + (courses - 1) * 2 * bricks
    assert built.assembly.n_free == half * (bricks + 1) + full * bricks
    assert built.assembly.n_interfaces == heads + beds
