"""Blocks of every pattern by hand: their outlines, names, order and which are fixed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from harness.model.errors import InputError
from harness.model.pattern import blocks_of, count_of
from harness.model.pattern_fields import Pattern

Outline = list[tuple[float, float]]


def pattern(kind: str, **fields: Any) -> Any:
    return TypeAdapter(Pattern).validate_python({"type": kind} | fields)


def box(left: float, bottom: float, right: float, top: float) -> Outline:
    return [(left, bottom), (right, bottom), (right, top), (left, top)]


def require(made: Any, outlines: dict[str, Outline], fixed: set[str]) -> None:
    """These blocks in this order, their vertices in this order too."""
    blocks = blocks_of(made)
    assert [block.id for block in blocks] == list(outlines)
    for block, outline in zip(blocks, outlines.values(), strict=True):
        np.testing.assert_allclose(block.polygon, outline, atol=1e-12)
    assert {block.id for block in blocks if block.fixed} == fixed
    assert count_of(made) == len(blocks)


def test_courses_of_a_bond_lie_one_on_the_other_from_the_origin_with_their_gaps():
    made = pattern(
        "running_bond", block_length=0.4, block_height=0.2, origin=(10.0, 5.0), prefix="w-",
        courses=[[1, -0.5, 1], [0.5, 1, 1.5]],
    )  # fmt: skip
    outlines = {
        "w-base": box(10.0, 4.8, 11.2, 5.0),  # as wide as the longest course
        "w-1.1": box(10.0, 5.0, 10.4, 5.2),
        "w-1.2": box(10.6, 5.0, 11.0, 5.2),
        "w-2.1": box(10.0, 5.2, 10.2, 5.4),
        "w-2.2": box(10.2, 5.2, 10.6, 5.4),
        "w-2.3": box(10.6, 5.2, 11.2, 5.4),
    }
    require(made, outlines, {"w-base"})


@pytest.mark.parametrize("start", ["half", "full"])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_counted_courses_alternate_whole_and_half_bricks(start: str, count: int):
    made = pattern("running_bond", block_length=1.0, block_height=1.0, count=count, bricks=2, start=start, base=False)
    half, full = [(0.0, 0.5), (0.5, 1.5), (1.5, 2.0)], [(0.0, 1.0), (1.0, 2.0)]
    outlines = {
        f"{row + 1}.{place}": box(left, float(row), right, row + 1.0)
        for row in range(count)
        for place, (left, right) in enumerate(half if (row % 2 == 0) == (start == "half") else full, start=1)
    }
    require(made, outlines, set())


def test_voussoirs_of_a_ring_go_from_its_first_joint_to_its_last_between_abutments():
    made = pattern("ring", inner_radius=1.0, outer_radius=2.0, count=2, origin=(10.0, 5.0))
    outlines = {
        "abutment-1": [(9.0, 5.0), (8.0, 5.0), (8.0, 4.5), (9.0, 4.5)],  # half as deep as the ring
        "v1": [(9.0, 5.0), (8.0, 5.0), (10.0, 7.0), (10.0, 6.0)],
        "v2": [(10.0, 6.0), (10.0, 7.0), (12.0, 5.0), (11.0, 5.0)],
        "abutment-2": [(11.0, 5.0), (12.0, 5.0), (12.0, 4.5), (11.0, 4.5)],
    }
    require(made, outlines, {"abutment-1", "abutment-2"})


def test_a_ring_the_other_way_round_begins_at_its_right():
    made = pattern("ring", inner_radius=1.0, outer_radius=2.0, count=1, angles=(0.0, 90.0))
    outlines = {
        "abutment-1": [(1.0, 0.0), (2.0, 0.0), (2.0, -0.5), (1.0, -0.5)],
        "v1": [(1.0, 0.0), (2.0, 0.0), (0.0, 2.0), (0.0, 1.0)],
        "abutment-2": [(0.0, 1.0), (0.0, 2.0), (-0.5, 2.0), (-0.5, 1.0)],
    }
    require(made, outlines, {"abutment-1", "abutment-2"})


@pytest.mark.parametrize(("supports", "fixed"), [("end_voussoirs", {"v1", "v3"}), ("none", set())])
def test_a_ring_may_stand_on_its_end_voussoirs_or_on_nothing(supports: str, fixed: set[str]):
    made = pattern("ring", inner_radius=1.0, outer_radius=2.0, count=3, supports=supports)
    blocks = blocks_of(made)
    assert [block.id for block in blocks] == ["v1", "v2", "v3"]
    assert {block.id for block in blocks if block.fixed} == fixed
    assert count_of(made) == 3


def test_blocks_of_a_stack_are_shifted_one_by_one_on_a_base():
    fields = {"width": 2.0, "height": 1.0, "count": 2, "origin": (10.0, 5.0)}
    straight = {"base": box(10.0, 4.0, 12.0, 5.0), "1": box(10.0, 5.0, 12.0, 6.0), "2": box(10.0, 6.0, 12.0, 7.0)}
    require(pattern("stack", **fields), straight, {"base"})
    shifted = {"base": box(9.0, 4.0, 14.0, 5.0), "1": box(10.25, 5.0, 12.25, 6.0), "2": box(9.5, 6.0, 11.5, 7.0)}
    require(pattern("stack", **fields, offsets=[0.25, -0.5], base=(-1.0, 4.0)), shifted, {"base"})


def test_letters_of_a_panel_are_blocks_of_cells_whose_rows_are_listed_from_the_top():
    made = pattern("panel", cell_length=2.0, cell_height=0.5, layout=["ab.", "aCC"], fixed="C", origin=(10.0, 5.0))
    boxes = {"a": (10.0, 5.0, 12.0, 6.0), "C": (12.0, 5.0, 16.0, 5.5), "b": (12.0, 5.5, 14.0, 6.0)}
    blocks = blocks_of(made)
    assert [block.id for block in blocks] == list(boxes)  # from the bottom, from the left
    for block, sides in zip(blocks, boxes.values(), strict=True):
        assert {tuple(point) for point in block.polygon} == set(box(*sides))
        assert len(block.polygon) == 4
    assert [block.id for block in blocks if block.fixed] == ["C"]
    assert count_of(made) == 3


@pytest.mark.parametrize("layout", [["aba"], ["aaa", "aba", "aaa"]])
def test_a_letter_whose_cells_are_apart_or_enclose_a_hole_is_refused(layout: list[str]):
    with pytest.raises(InputError, match="one block without holes"):
        blocks_of(pattern("panel", cell_length=1.0, cell_height=1.0, layout=layout))


BOND = {"block_length": 1.0, "block_height": 1.0}
RING = {"inner_radius": 1.0, "outer_radius": 2.0, "count": 3}
REFUSED: dict[str, tuple[str, dict[str, Any], str]] = {
    "no courses": ("running_bond", BOND, "either courses, or count and bricks"),
    "a count without bricks": ("running_bond", BOND | {"count": 2}, "either courses, or count and bricks"),
    "both": ("running_bond", BOND | {"courses": [[1]], "count": 2, "bricks": 2}, "either courses"),
    "an empty list": ("running_bond", BOND | {"courses": []}, "no course"),
    "an empty course": ("running_bond", BOND | {"courses": [[1], []]}, "course 2 has"),
    "a course of gaps": ("running_bond", BOND | {"courses": [[1], [-1]]}, "course 2 has"),
    "a width of zero": ("running_bond", BOND | {"courses": [[1, 0]]}, "course 1 has"),
    "too many bricks": ("running_bond", BOND | {"count": 1000, "bricks": 101}, "more than 100000 blocks"),
    "a ring without depth": ("ring", RING | {"outer_radius": 1.0}, "greater than inner_radius"),
    "a ring of no angle": ("ring", RING | {"angles": (90.0, 90.0)}, "angles must differ"),
    "a closed ring": ("ring", RING | {"angles": (0.0, 360.0)}, "angles must differ"),
    "an offset less": ("stack", {"width": 1.0, "height": 1.0, "count": 2, "offsets": [0.0]}, "2 entries"),
    "rows of two lengths": ("panel", {"cell_length": 1.0, "cell_height": 1.0, "layout": ["ab", "a"]}, "equal length"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_pattern_that_contradicts_itself_is_refused(name: str):
    kind, fields, words = REFUSED[name]
    with pytest.raises(ValidationError, match=words):
        pattern(kind, **fields)


def test_patterns_at_their_limits_are_taken():
    assert count_of(pattern("running_bond", **BOND, count=1000, bricks=100, start="full", base=False)) == 100_500
    assert len(blocks_of(pattern("ring", **RING, angles=(-90.0, 269.0)))) == 5
