"""Blocks with holes: area, centroid and inertia, joints on inner faces, and walls whose multiplier is known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Polygon

from harness.model import geometry
from harness.model.assembly import polygon_area
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.method_registry import load_method
from harness.model.repair import repair
from harness.model.rings import ringed, rings_of
from harness.model.wall import Wall
from methods.de.engines.pymunk_blocks import convex_parts
from methods.de.engines.pymunk_joints import polygon_gyration


def box(x: float, y: float, width: float, height: float) -> list[list[float]]:
    return [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]


def wall(blocks: list[dict[str, Any]], **more: Any) -> Wall:
    ground = {"id": "ground", "polygon": box(-2.0, -1.0, 8.0, 1.0), "fixed": True}
    live = {"live": {"body": [{"per_weight": [1.0, 0.0]}]}}
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": 10.0, "loads": live, "blocks": [ground, *blocks]}
    return Wall.model_validate(data | more)


FRAME = {"id": "frame", "polygon": box(0.0, 0.0, 3.0, 4.0), "holes": [box(0.5, 0.5, 2.0, 3.0)]}


def multiplier(of: Wall, method: str) -> float:
    chosen = load_method(method)
    value = chosen.solve(build(of).assembly, chosen.Settings()).multiplier
    assert value is not None
    return float(value)


@pytest.mark.parametrize("method", ["la-associated", "la", "fe"])
def test_frame_topples_as_one_rigid_ring_about_its_toe(method: str):
    # Tilted by a multiple of its weight at the middle of its height: half the width over half the height.
    assert multiplier(wall([FRAME]), method) == pytest.approx(3.0 / 4.0, rel=2e-3)  # fe: stiffness of the joint


@pytest.mark.parametrize("method", ["la-associated", "la", "fe"])
def test_block_standing_in_a_frame_topples_alone_before_it(method: str):
    # The block is 0.4 wide and 1.6 high and topples on the sill at 0.25; the frame would hold 0.75.
    inner = {"id": "inner", "polygon": box(1.2, 0.5, 0.4, 1.6)}
    assembly = build(wall([FRAME, inner])).assembly
    assert sorted(zip(assembly.block_a.tolist(), assembly.block_b.tolist(), strict=True)) == [(0, 1), (1, 2)]
    assert multiplier(wall([FRAME, inner]), method) == pytest.approx(0.4 / 1.6, rel=2e-3)


def test_weight_is_that_of_the_stone_and_not_of_the_hole():
    assembly = build(wall([FRAME])).assembly
    assert assembly.weight[1] == pytest.approx(20.0 * (3.0 * 4.0 - 2.0 * 3.0))


def test_filled_hole_has_joints_on_all_four_inner_faces():
    filling = {"id": "filling", "polygon": box(0.5, 0.5, 2.0, 3.0)}
    assembly = build(wall([FRAME, filling])).assembly
    inner = (assembly.block_a == 1) & (assembly.block_b == 2)
    assert inner.sum() == 4
    assert sorted(assembly.length[inner]) == pytest.approx([2.0, 2.0, 3.0, 3.0])
    towards = assembly.centroid[2] - 0.5 * (assembly.end1 + assembly.end2)[inner]
    assert np.all(np.einsum("kd,kd->k", assembly.normal[inner], towards) > 0.0)  # from the frame into the filling


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(*[st.floats(0.05, 0.95)] * 2, st.floats(0.01, 0.2)), min_size=1, max_size=4))
def test_line_with_cuts_has_the_area_centroid_and_inertia_of_the_stone(squares: list[tuple[float, float, float]]):
    holes = [np.array(box(x, y, side, side)) for x, y, side in squares if x + side < 1.0 and y + side < 1.0]
    shape = Polygon(box(0.0, 0.0, 1.0, 1.0), holes)
    if not holes or not shape.is_valid:
        return
    line = ringed(np.array(box(0.0, 0.0, 1.0, 1.0)), holes)
    assert polygon_area(line) == pytest.approx(shape.area)
    assert geometry.centroids([line])[0] == pytest.approx(np.array(shape.centroid.coords[0]))
    assert geometry.shapes_of([line])[0].equals(shape)
    assert len(rings_of(line)) == 1 + len(holes)
    # About the origin: the square of the whole less those of the holes, each that of its middle and its own.
    parts = [(1.0, 0.5, 0.5, 1.0)] + [(-(float(np.ptp(h[:, 0])) ** 2), *h.mean(axis=0), np.ptp(h[:, 0])) for h in holes]
    inertia = sum(area * (x * x + y * y + side * side / 6.0) for area, x, y, side in parts)
    assert polygon_gyration(line) * shape.area == pytest.approx(inertia)
    assert sum(Polygon(part).area for part in convex_parts(line)) == pytest.approx(shape.area)


@pytest.mark.parametrize(
    ("holes", "words"),
    [
        ([box(2.0, 1.0, 2.0, 1.0)], "holes[0] is no polygon within it"),
        ([box(1.0, 1.0, 1.0, 1.0), [[1.0, 3.0], [1.2, 3.0], [1.1, 3.0]]], "holes[1] is no polygon within it"),
        ([box(1.0, 1.0, 1.0, 1.0), box(1.5, 1.5, 1.0, 1.0)], "holes touch each other"),
    ],
)
def test_holes_that_are_none_are_refused(holes: list[Any], words: str):
    with pytest.raises(InputError) as caught:
        build(wall([FRAME | {"holes": holes}]))
    assert words in str(caught.value)


def test_block_across_the_rim_of_a_hole_overlaps():
    with pytest.raises(InputError, match="overlap"):
        build(wall([FRAME, {"id": "inner", "polygon": box(1.0, 0.4, 1.0, 1.0)}]))


def test_repair_closes_a_gap_within_a_hole_and_keeps_the_hole():
    inner = {"id": "inner", "polygon": box(1.0, 0.502, 1.0, 1.0)}
    mended = repair(wall([FRAME, inner]), 0.005).wall
    (frame,) = [block for block in mended.blocks if block.id == "frame"]
    assert len(frame.holes) == 1
    assert build(mended).assembly.n_interfaces == 2
