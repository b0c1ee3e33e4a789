"""The blocks of a wall: those of its patterns written out, their outlines, their weights."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.validation import explain_validity

from harness.model import geometry
from harness.model.assembly import BoolArray, FloatArray, polygon_area
from harness.model.errors import InputError, Spot, raise_faults
from harness.model.fields import MOST_BLOCKS
from harness.model.input_checks import thickness_of
from harness.model.names import faults_of_wall
from harness.model.pattern import blocks_of, count_of
from harness.model.pattern_fields import PatternBase
from harness.model.rings import ringed
from harness.model.wall import Block, Wall


def blocks_of_wall(wall: Wall) -> list[Block]:
    """All blocks of a wall, those of its patterns first.

    Raises:
        InputError: there are none, too many, or names are wrong.
    """
    blocks = written_out(wall)
    raise_faults(faults_of_wall(wall, blocks))
    return blocks


def written_out(wall: Wall) -> list[Block]:
    """All blocks of a wall, those of its patterns first, whatever their names.

    Raises:
        InputError: there are none, or too many.
    """
    patterns: list[PatternBase] = (
        [] if wall.pattern is None else list(wall.pattern) if isinstance(wall.pattern, list) else [wall.pattern]
    )
    expected = sum(count_of(pattern) for pattern in patterns) + len(wall.blocks)
    if expected > MOST_BLOCKS:
        raise InputError(
            f"the wall has {expected:,} blocks, and at most {MOST_BLOCKS:,} are built",
            "Analyse a part of it",
            "pattern" if patterns else "blocks",
        )
    blocks = [block for pattern in patterns for block in blocks_of(pattern)] + list(wall.blocks)
    if not blocks:
        raise InputError("the wall has no blocks", 'Give "blocks" or a "pattern"', "blocks")
    return blocks


def polygons_of(blocks: Sequence[Block]) -> list[FloatArray]:
    """The outlines (k, 2) of blocks, counter-clockwise [length]; one with holes goes along a cut to each and back.

    Raises:
        InputError: some are no polygons; all of them are reported.
    """
    polygons = [np.array(block.polygon, dtype=float) for block in blocks]
    holes = {k: [np.array(hole, dtype=float) for hole in block.holes] for k, block in enumerate(blocks) if block.holes}
    elements = [f'block "{block.id}"' for block in blocks]
    raise_faults(geometry.polygon_faults(polygons, elements))
    raise_faults([fault for k, within in holes.items() for fault in _hole_faults(polygons[k], within, elements[k])])
    return [
        ringed(polygon, holes[k]) if k in holes else geometry.counter_clockwise(polygon)
        for k, polygon in enumerate(polygons)
    ]


def support_faults(fixed: BoolArray) -> list[InputError]:
    """What is wrong where no block is fixed, or every one."""
    if not fixed.any():
        return [InputError("no block is fixed", 'Mark the supports with "fixed": true', "blocks")]
    return [InputError("every block is fixed", "Leave at least one block free to move", "blocks")] * bool(fixed.all())


def weight_of(block: Block, wall: Wall) -> float:
    """The weight of a block of a wall [force].

    Raises:
        InputError: nothing says it.
    """
    if block.weight is not None:
        return block.weight
    unit_weight = block.unit_weight if block.unit_weight is not None else wall.unit_weight
    if unit_weight is None:
        if block.fixed:
            return 0.0
        raise InputError(
            "it has no weight",
            'Give it "weight", or "unit_weight" for it or for the wall',
            f'block "{block.id}"',
            spot=Spot((block.id,)),
        )
    area = polygon_area(np.array(block.polygon, dtype=float))
    area -= sum(polygon_area(np.array(hole, dtype=float)) for hole in block.holes)
    per_area = float(unit_weight) * area * thickness_of(block, wall)
    return per_area if wall.units.unit_weight is None else per_area * wall.units.unit_weight_factor


def _hole_faults(outer: FloatArray, holes: Sequence[FloatArray], element: str) -> list[InputError]:
    """What is wrong with the holes (i, 2) of a block whose outline (j, 2) is a polygon."""
    stone = shapely.Polygon(outer)
    faults = []
    for number, hole in enumerate(holes):
        cut = shapely.Polygon(hole)
        if not cut.is_valid or cut.area <= 1e-12 * stone.area or not stone.covers(cut):
            remedy = "Give the vertices in order round a hole inside its outline"
            faults.append(InputError(f"holes[{number}] is no polygon within it", remedy, element))
    whole = shapely.Polygon(outer, holes)
    if not faults and not whole.is_valid:
        why = f"its holes touch each other or its outline along a length ({explain_validity(whole)})"
        faults.append(InputError(why, "Give them as one, or apart", element))
    return faults
