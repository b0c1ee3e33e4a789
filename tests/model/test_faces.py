"""Faces of joints and outlines of blocks by hand: limits, near misses, corners, given joints, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from harness.model import geometry
from harness.model.build import build
from harness.model.contacts import Contacts, JointLimits, check_gap, find_contacts
from harness.model.errors import InputError
from harness.model.interfaces import limits_of
from harness.model.wall import Detection, Wall
from tests.known_walls import box

GROUND = box("ground", -2.0, -1.0, 10.0, 1.0, fixed=True)


def outline(x: float, y: float, width: float, height: float) -> np.ndarray:
    return np.array(box("", x, y, width, height)["polygon"])


def found(polygons: list[np.ndarray], fixed: list[int] | None = None, **limits: float) -> Contacts:
    chosen = {"gap": 1e-6, "overlap": 1e-6, "angle": 0.3, "length": 1e-6, "sight": 0.0} | limits
    held = np.isin(np.arange(len(polygons)), fixed or [])
    return find_contacts(polygons, held, JointLimits(**chosen))


def built(blocks: list[dict[str, Any]], **more: Any) -> Any:
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.5, "blocks": [GROUND, *blocks]}
    return build(Wall.model_validate(data | more))


@pytest.mark.parametrize("gap", [0.25, -0.25])
def test_limits_hold_up_to_their_ends(gap: float):
    """Quarters are exact in binary."""
    pair = [outline(0.0, 0.0, 4.0, 4.0), outline(0.0, 4.0 + gap, 4.0, 4.0)]
    assert len(found(pair, gap=0.25, overlap=0.25).block_a) == 1
    assert len(found(pair, gap=0.125, overlap=0.125).block_a) == 0
    seen = found(pair, gap=0.125, overlap=0.125, sight=0.25)
    assert (seen.missed.tolist(), seen.missed_gap.tolist(), seen.missed_at.tolist()) == (
        [[0, 1]],
        [0.25],
        [[2, 4 + gap / 2]],
    )
    assert len(found(pair, gap=0.125, overlap=0.125, sight=0.24).missed) == 0
    only = {"gap": 0.25, "overlap": 0.125} if gap < 0 else {"gap": 0.125, "overlap": 0.25}
    assert len(found(pair, **only).block_a) == 0


def test_faces_turned_by_more_than_the_angle_are_none_of_one_joint():
    for degrees, count in ((9.0, 1), (11.0, 0)):
        rise = 2.0 * math.tan(math.radians(degrees))
        upper = np.array([[0.0, 1.0], [2.0, 1.0 + rise], [2.0, 3.0], [0.0, 3.0]])
        contacts = found([outline(0.0, 0.0, 2.0, 1.0), upper], gap=1.0, angle=math.radians(10.0))
        assert len(contacts.block_a) == count
        if count:  # in the middle, by half the rise; aside by the sine of half the angle of that
            assert contacts.end[0] == pytest.approx([0.0, 1.0], abs=0.03)
            assert contacts.start[0] == pytest.approx([2.0, 1.0 + 0.5 * rise], abs=0.03)


def test_contacts_no_longer_than_the_least_are_corners():
    pair = [outline(0.0, 0.0, 2.0, 1.0), outline(1.75, 1.0, 2.0, 1.0)]
    assert len(found(pair, length=0.24).block_a) == 1
    short = found(pair, length=0.26)
    assert (len(short.block_a), short.corners.tolist()) == (0, [[0, 1]])


def test_fixed_blocks_have_neither_joints_nor_corners_between_them():
    row = [outline(0.0, 0.0, 1.0, 1.0), outline(1.0, 0.0, 1.0, 1.0), outline(2.0, 1.0, 1.0, 1.0)]
    assert found(row, [0, 1]).block_a.tolist() == []
    assert found(row, [0, 1]).corners.tolist() == [[1, 2]]
    assert found(row, [0, 1, 2]).corners.tolist() == []
    assert found(row).corners.tolist() == [[1, 2]]


def test_of_every_pair_the_least_near_miss_is_told():
    """A step in the lower block: .25 and .125 below the upper one."""
    lower = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.0, 1.0], [2.0, 0.875], [0.0, 0.875]])
    seen = found([lower, outline(0.0, 1.125, 4.0, 1.0)], sight=0.5)
    assert (seen.missed.tolist(), seen.missed_gap.tolist()) == ([[0, 1]], [0.125])
    assert seen.missed_at.tolist() == [[3.0, 1.0625]]
    both = found([lower, outline(0.0, 1.125, 4.0, 1.0), outline(4.5, 0.0, 1.0, 1.0)], gap=0.125, sight=0.5)
    assert both.missed.tolist() == [[0, 2]]  # a pair with a joint misses none


def test_parts_of_a_face_in_a_line_are_one_joint_and_round_a_bend_two():
    vertex = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [3.0, 1.0], [1.0, 1.0], [0.0, 1.0]])
    one = found([vertex, outline(0.0, 1.0, 4.0, 1.0)])
    assert [sorted([s[0], e[0]]) for s, e in zip(one.start, one.end, strict=True)] == [[0.0, 4.0]]
    apart = np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 1.0], [3.0, 1.0], [3.0, 0.5], [2.0, 0.5], [2.0, 1.0], [0.0, 1.0]])
    two = found([apart, outline(0.0, 1.0, 5.0, 1.0)])
    assert sorted(sorted([s[0], e[0]]) for s, e in zip(two.start, two.end, strict=True)) == [[0.0, 2.0], [3.0, 5.0]]
    notched = np.array(
        [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.25, 1.0], [2.25, 0.5], [2.0, 0.5], [2.0, 1.0], [0.0, 1.0]]
    )
    for gap, count in ((0.25, 1), (0.125, 2)):  # joints that lie no farther apart than faces of one joint may
        assert len(found([notched, outline(0.0, 1.0, 4.0, 1.0)], gap=gap).block_a) == count
    bent = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [2.0, 2.0], [0.0, 1.0]])
    above = np.array([[4.0, 1.0], [4.0, 3.0], [0.0, 3.0], [0.0, 1.0], [2.0, 2.0]])
    assert len(found([bent, above]).block_a) == 2


def test_joints_run_counter_clockwise_round_their_first_block_and_are_sorted():
    row = [outline(2.0, 0.0, 1.0, 1.0), outline(1.0, 0.0, 1.0, 1.0), outline(0.0, 0.0, 1.0, 1.0)]
    contacts = found(row)
    assert list(zip(contacts.block_a.tolist(), contacts.block_b.tolist(), strict=True)) == [(0, 1), (1, 2)]
    assert contacts.start.tolist() == [[2.0, 1.0], [1.0, 1.0]]
    assert contacts.end.tolist() == [[2.0, 0.0], [1.0, 0.0]]


def test_a_gap_as_wide_as_a_block_is_refused_by_the_thickness_of_the_thinnest():
    """Twice the area over the outline: 2 x .1 x 2 / 4.2 of a plate of 2 by .1."""
    shapes = geometry.shapes_of([outline(0.0, 0.0, 2.0, 0.1), outline(0.0, 0.1, 2.0, 0.2)])
    check_gap(shapes, ["plate", "board"], 0.095)
    with pytest.raises(InputError, match=r"swallows 1 block\(s\), plate: the thinnest is about 0.0952 thick"):
        check_gap(shapes, ["plate", "board"], 0.096)
    with pytest.raises(InputError, match=r"swallows 2 block\(s\), plate, board.*Allow less than 0.0952"):
        check_gap(shapes, ["plate", "board"], 0.2)


def test_limits_that_are_not_given_are_shares_of_the_block():
    bare = limits_of(Detection(), 0.5)
    assert (bare.gap, bare.overlap, bare.length, bare.sight) == pytest.approx((5e-7, 5e-7, 5e-7, 0.01))
    wide = limits_of(Detection(tolerance=0.02, greatest_angle=30.0), 0.5)
    assert (wide.gap, wide.overlap, wide.length, wide.sight) == pytest.approx((0.02, 0.02, 0.005, 0.2))
    assert wide.angle == pytest.approx(math.pi / 6.0)
    told = limits_of(Detection(greatest_gap=0.003, greatest_overlap=0.002, least_contact=0.1, sight=0.04), 0.5)
    assert (told.gap, told.overlap, told.length, told.sight) == (0.003, 0.002, 0.1, 0.04)


def test_floating_blocks_are_named_one_or_several():
    with pytest.raises(InputError, match=r'block "up".*joins it to a fixed block: floating\.') as one:
        built([box("a", 0.0, 0.0), box("up", 3.0, 2.0)])
    assert "corner" not in str(one.value)
    with pytest.raises(InputError, match=r'blocks "up", "higher".*joins them to a fixed block') as two:
        built([box("up", 3.0, 2.0), box("higher", 3.0, 3.0), box("a", 0.0, 0.0)])
    assert '"a"' not in str(two.value)
    with pytest.raises(InputError, match="a touch at a corner is no interface"):
        built([box("a", 0.0, 0.0), box("up", 1.0, 1.0)])
    names = [box(f"k{number}", 3.0, 1.0 + number) for number in range(7)]
    with pytest.raises(InputError) as many:
        built(names)
    assert '"k4"' in str(many.value)
    assert '"k5"' not in str(many.value)


@pytest.mark.parametrize(
    ("joint", "words"),
    [
        ({"between": ["a", "a"], "from": [0, 0], "to": [1, 0]}, "a block cannot touch itself"),
        ({"between": ["a", "ground"], "from": [1, 0], "to": [1, 0]}, "its two ends coincide"),
        ({"between": ["a", "ground"], "from": [0, 0], "to": [1e-300, 0]}, "its two ends coincide"),
        ({"between": ["ground", "other"], "from": [0, 0], "to": [1, 0]}, "both of its blocks are fixed"),
        ({"between": ["a", "beside"], "from": [0.5, 0], "to": [1.5, 0]}, "do not lie on opposite sides"),
    ],
)
def test_given_joints_that_are_none_are_refused_by_their_number(joint: dict[str, Any], words: str):
    sound = [
        {"between": [name, "ground"], "from": [x, 0], "to": [x + 1, 0]}
        for name, x in (("a", 0), ("beside", 1), ("b", 3))
    ]
    blocks = [box("a", 0.0, 0.0), box("beside", 1.0, 0.0), box("b", 3.0, 0.0), box("other", 5.0, 0.0, fixed=True)]
    assert built(blocks, interfaces=sound).assembly.n_interfaces == 3
    with pytest.raises(InputError, match=words) as raised:
        built(blocks, interfaces=[*sound, joint])
    assert "interfaces[3]" in str(raised.value)
    with pytest.raises(InputError, match=words) as beside:  # three are found, and this is the first of those given
        built(blocks, interfaces={"given": [joint]})
    assert "interfaces[0]" in str(beside.value)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e6])
def test_sides_of_a_given_joint_are_relative_to_the_blocks(size: float):
    """A joint below two blocks in a row, of which one is higher by 1e-10 of a block: it has no side."""
    base = box("base", -size, -size, 10.0 * size, size, fixed=True)
    row = [box("a", 0.0, 0.0, size, size), box("b", size, 1e-10 * size, size, size)]
    joint = {"between": ["a", "b"], "from": [0.5 * size, -0.5 * size], "to": [1.5 * size, -0.5 * size]}
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.5, "blocks": [base, *row]}
    with pytest.raises(InputError, match="do not lie on opposite sides"):
        build(Wall.model_validate(wall | {"interfaces": {"given": [joint]}}))


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("far", [0.0, 100.0])
def test_normals_of_given_joints_point_into_the_second_block_however_they_are_written(
    turned: bool, swapped: bool, far: float
):
    """An L on a block, so that its centroid says nothing of the side: its foot hangs beside the block."""
    hook = [[0, 1], [2, 1], [2, -3], [6, -3], [6, 2], [0, 2]]
    hook = [[x + far, y] for x, y in hook]
    blocks = [box("a", far, 0.0), {"id": "hook", "polygon": hook}]
    ground = box("floor", far - 3.0, -5.0, 20.0, 1.0, fixed=True)
    base = box("base", far - 1.0, -1.0, 2.0, 1.0, fixed=True)
    names, ends = (["a", "hook"], ([far, 1.0], [far + 1.0, 1.0]))
    if swapped:
        names = names[::-1]
    first, second = ends[::-1] if turned else ends
    joints = [
        {"between": names, "from": first, "to": second},
        {"between": ["a", "base"], "from": [far, 0.0], "to": [far + 1.0, 0.0]},
    ]
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.5, "blocks": [ground, base, *blocks]}
    wall = build(Wall.model_validate(data | {"interfaces": joints})).assembly
    assert wall.normal.tolist() == [[0.0, -1.0 if swapped else 1.0], [0.0, -1.0]]


def test_centroids_by_hand_of_outlines_of_any_number_of_vertices():
    """Of an L of 3 by 1 and 1 by 1 upon it: (3 x 1.5 + .5) / 4 and (3 x .5 + 1.5) / 4."""
    ell = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]])
    triangle = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 3.0]])
    for shift in (0.0, 4096.0):
        centres = geometry.centroids(
            [ell + shift, triangle + shift, triangle[:, ::-1][::-1] + shift, ell + 2.0 * shift]
        )
        right = [[1.25, 0.75], [1.0, 1.0], [1.0, 1.0], [1.25 + shift, 0.75 + shift]]
        np.testing.assert_allclose(centres - shift, right, atol=1e-12)


def test_sizes_and_distances_of_outlines():
    polygons = [outline(0.0, 0.0, 2.0, 2.0), outline(3.0, 0.0, 9.0, 1.0), outline(0.0, 5.0, 4.0, 4.0)]
    assert geometry.typical_size(geometry.shapes_of(polygons)) == 3.0
    points = np.array([[1.0, 1.0], [3.0, 2.0], [3.0, 4.0]])
    assert geometry.distances_beyond(polygons, np.array([0, 0, 1]), points, 0.0).tolist() == [0.0, 1.0, 3.0]
    assert geometry.counter_clockwise(polygons[0][::-1]).tolist() == polygons[0].tolist()
    assert geometry.counter_clockwise(polygons[0]) is polygons[0]


@pytest.mark.parametrize(
    ("polygon", "words"),
    [
        ([[0, 0], [1, 0], [1, 0], [0, 1]], "same vertex twice"),
        ([[0, 0], [1, 0], [0, 1], [0, 0]], "same vertex twice"),
        ([[0, 0], [1, 1], [1, 0], [0, 1]], "crosses or touches itself"),
        ([[0, 0], [1e6, 0], [1e6, 1e-7], [0, 1e-7]], "no area"),
    ],
)
def test_faults_of_outlines_name_their_element(polygon: list[Any], words: str):
    sound = outline(0.0, 0.0, 1.0, 1.0)
    blocks = [sound * 1e7, np.array(polygon, dtype=float), sound * 1e-6]  # no area is small for the extent alone
    faults = geometry.polygon_faults(blocks, ["a", "b", "c"])
    assert [str(fault.element) for fault in faults] == ["b"]
    assert words in str(faults[0])
    assert geometry.polygon_faults([], []) == []


def overlaps(shapes: np.ndarray, names: list[str], fixed: np.ndarray, tolerance: float) -> list[InputError]:
    return geometry.overlap_faults(shapes, names, *geometry.overlapping(shapes, fixed, tolerance))


@pytest.mark.parametrize("size", [0.01, 1.0, 100.0])
def test_a_drawing_may_be_as_rough_as_a_fiftieth_of_a_block_of_any_size(size: float):
    for deep, rough in ((0.0199, True), (0.0201, False)):
        polygons = [outline(0.0, 0.0, size, size), outline(size * (1.0 - deep), 0.0, size, size)]
        (fault,) = overlaps(geometry.shapes_of(polygons), ["a", "b"], np.zeros(2, dtype=bool), 0.0)
        assert ("greatest_overlap" in str(fault)) is rough


def test_overlaps_are_told_the_worst_first_with_area_depth_place_and_the_remedy():
    polygons = [outline(0.0, 0.0, 1.0, 1.0), outline(0.9, 0.0, 1.0, 1.0), outline(0.0, 0.99, 1.0, 1.0)]
    shapes, names, free = geometry.shapes_of(polygons), ["a", "b", "c"], np.zeros(3, dtype=bool)
    faults = overlaps(shapes, names, free, 1e-6)
    assert [fault.element for fault in faults] == [f'blocks "{x}" and "{y}"' for x, y in ("ab", "ac", "bc")]
    assert "an area of 0.1, 0.1 deep" in str(faults[0])
    assert "greatest_overlap" not in str(faults[0])  # no drawing is as rough as a tenth of a block
    assert "an area of 0.01, 0.01 deep" in str(faults[1])
    assert '"greatest_overlap": 0.011' in str(faults[1])
    spot = faults[0].spot
    assert spot is not None
    assert (spot.blocks, spot.at, spot.size) == (("a", "b"), pytest.approx((0.95, 0.5)), pytest.approx(0.1))
    with pytest.raises(InputError, match=r"2 more pair\(s\) overlap"):
        geometry.check_overlaps(shapes, names, free, 1e-6)
    with pytest.raises(InputError, match=r"1 more pair\(s\) overlap"):
        geometry.check_overlaps(shapes, names, np.array([False, True, True]), 1e-6)
    with pytest.raises(InputError) as alone:
        geometry.check_overlaps(shapes[:2], names[:2], free[:2], 1e-6)
    assert "more pair" not in str(alone.value)
    held = np.array([True, True, False])
    assert [fault.element for fault in overlaps(shapes, names, held, 1e-6)] == [
        'blocks "a" and "c"',
        'blocks "b" and "c"',
    ]
    # A tolerance explains the area of a strip along the outline: .0024 x 4 < .01 < .0026 x 4.
    assert len(overlaps(shapes[[0, 2]], ["a", "c"], free[:2], 0.0024)) == 1
    assert len(overlaps(shapes[[0, 2]], ["a", "c"], free[:2], 0.0026)) == 0


def test_at_most_so_many_pairs_are_compared_and_five_hundred_put_into_words():
    def equal(count: int) -> tuple[np.ndarray, list[str], np.ndarray]:
        polygons = [outline(0.0, 0.0, 1.0, 1.0)] * count
        return geometry.shapes_of(polygons), [f"s{k}" for k in range(count)], np.zeros(count, dtype=bool)

    faults = overlaps(*equal(40), 1e-6)  # 40 x 39 / 2 pairs
    assert len(faults) == 501
    assert faults[-1].problem == "280 more pairs of blocks overlap"
    with pytest.raises(InputError, match="pairs touch or overlap, too many to compare"):
        overlaps(*equal(1000), 1e-6)  # 499,500 pairs read 5 million vertices


def test_a_fan_of_wedges_about_one_point_has_no_overlap_however_many_meet_there():
    turns = 2.0 * np.pi * np.arange(301) / 300
    rim = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    shapes = geometry.shapes_of([np.array([[0.0, 0.0], rim[k], rim[k + 1]]) for k in range(300)])
    pairs, _ = geometry.overlapping(shapes, np.zeros(300, dtype=bool), 1e-6)
    assert len(pairs) == 0
