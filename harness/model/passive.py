"""Passive fill: what resists blocks that move into it, as bars from the ground that bear compression alone.

A face beside a fill bears a horizontal pressure from zero to m K_p gamma z on its vertical projection, z the depth
below the level of the fill, as LimitState:RING states it (Gilbert 2007). It acts only where the face moves into the
fill, and does no work where it moves away. The pressures on one side of a block have one resultant here, through the
centre of the full pressure: it presses as a whole or not at all.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence

import numpy as np
import shapely

from harness.model.assembly import BoolArray, FloatArray, IntArray
from harness.model.bars import Bars
from harness.model.errors import InputError
from harness.model.fill import NO_FACE, heights, highest_faces
from harness.model.laid import Laid
from harness.model.pressure import Outlines, outlines_of
from harness.model.pressure_fields import Fill, Passive

FILL = "fill"
"""The kind of such bars."""
_UPRIGHT = 0.01
"""Slope from the vertical within which a face is upright, as surveys are rounded; beyond it an overhang is none."""
_NOTHING = 1e-9
"""Slope from the level within which a face is level; share of the largest force, and of the depth and the height of a
face, that is none: rounding."""

_Strip = tuple[int, int, FloatArray]
"""Part of a face: its edge, 1 where the fill is on its right and -1 on its left, and its two ends (2, 2) [length]."""


def _passive_coefficient(passive: Passive) -> float:
    """Horizontal over vertical stress where the fill yields: K_p as given, or (1 + sin phi)/(1 - sin phi)."""
    if passive.coefficient is not None:
        return passive.coefficient
    sine = math.sin(math.radians(passive.friction_angle or 0.0))
    return (1.0 + sine) / (1.0 - sine)


def passive_bars(
    fill: Fill,
    passive: Passive,
    chosen: BoolArray,
    laid: Laid,
    thickness: Sequence[float],
    unit_weight_factor: float,
    ground: int,
    name: str,
    place: str,
) -> Bars:
    """The bars of a fill that resists: one for each side of each block on which it lies.

    Args:
        fill: beside or above the wall; passive: how it resists.
        chosen: (n,) whether it may resist a block.
        laid: blocks and joints of the wall; thickness: (n,) of the blocks [length].
        unit_weight_factor: what a unit weight of the file is multiplied with to be in force/length^3.
        ground: index of a fixed block that stands for the ground.
        name: of the fill, for messages and tables; place: of it in the file, for errors.

    Raises:
        InputError: it lies beside no face.
    """
    full = _sums(fill, chosen, laid, thickness)
    if not full:
        raise InputError(
            f"no face of a free block that it may resist looks sideways below its level {fill.level:.6g}",
            'Leave "passive" out, or give a "level" above such a face, and "between" that begins or ends at it',
            place,
        )
    strongest = passive.mobilised * _passive_coefficient(passive) * unit_weight_factor * fill.unit_weight
    names, keys, found = tuple(laid.index), list(full), np.array(list(full.values()))
    middle = found[:, 1:3] / found[:, :1]
    side = np.array([key[1] for key in keys], dtype=float)
    away = np.column_stack(
        [side * found[:, 3] / np.array(thickness)[[block for block, _ in keys]], np.zeros(len(keys))]
    )
    return Bars(
        names=tuple(f"{name}, {'right' if way > 0 else 'left'} of {names[k]}" for k, way in keys),
        kinds=(FILL,) * len(keys),
        block_a=np.full(len(keys), ground),
        block_b=np.array([block for block, _ in keys]),
        end1=middle + away,
        end2=middle,
        prestress=np.zeros(len(keys)),
        least=-strongest * found[:, 0],
        greatest=np.zeros(len(keys)),
    )


def _sums(fill: Fill, chosen: BoolArray, laid: Laid, thickness: Sequence[float]) -> dict[tuple[int, int], FloatArray]:
    """By block and side where there are any, in order: the integrals of `_pressed` times the thickness."""
    outlines = outlines_of(laid.polygons)
    joints = _on_edges(outlines, laid)
    sums: dict[tuple[int, int], FloatArray] = defaultdict(lambda: np.zeros(4))
    highest = highest_faces(outlines, fill.between)
    for edge, side, ends in [*_below_the_sky(outlines, *highest), *_upright(fill, outlines, *highest)]:
        block = int(outlines.block[edge])
        if chosen[block]:
            sums[block, side] += _pressed(fill.level, ends) * thickness[block]
            for part in _covered(ends, joints[edge]):
                sums[block, side] -= _pressed(fill.level, part) * thickness[block]
    least = _NOTHING * max((found[0] for found in sums.values()), default=0.0)
    return {key: sums[key] for key in sorted(sums) if sums[key][0] > least}


def _pressed(level: float, ends: FloatArray) -> FloatArray:
    """Integrals over the vertical projection of a strip below a level: of z, of z x and of z y; and its height."""
    low, high = ends[np.argsort(ends[:, 1])]
    top, bottom = max(level - high[1], 0.0), level - low[1]
    if bottom - top <= _NOTHING * max(bottom, high[1] - low[1]):
        return np.zeros(4)
    force = 0.5 * (bottom - top) * (bottom + top)
    depth = (bottom**2 + bottom * top + top**2) / 3.0 * (bottom - top) / force
    share = (level - depth - low[1]) / (high[1] - low[1])
    at = low + share * (high - low)
    return np.array([force, force * at[0], force * at[1], bottom - top])


def _below_the_sky(outlines: Outlines, x: FloatArray, face: IntArray) -> Iterator[_Strip]:
    """Parts of the inclined faces that the sky sees; `x`, `face` as of `highest_faces`."""
    for left, right, edge in zip(x[:-1], x[1:], face.tolist(), strict=True):
        if edge == NO_FACE or _is_upright(outlines, edge):
            continue
        places = np.array([left, right])
        y = heights(outlines, edge, places)
        if abs(y[1] - y[0]) > _NOTHING * (right - left):
            yield edge, 1 if y[0] > y[1] else -1, np.column_stack([places, y])


def _upright(fill: Fill, outlines: Outlines, x: FloatArray, face: IntArray) -> Iterator[_Strip]:
    """Parts of the upright faces above the highest face just beside them; `x`, `face` as of `highest_faces`."""
    for edge in range(len(outlines.block)):
        if not _is_upright(outlines, edge):
            continue
        low, high = sorted((outlines.first[edge], outlines.last[edge]), key=lambda end: float(end[1]))
        hair = 1e-6 * float(high[1] - low[1])
        side = 1 if outlines.last[edge, 1] > outlines.first[edge, 1] else -1
        beside = side * (max(side * float(low[0]), side * float(high[0])) + hair)
        if fill.between is not None and not fill.between[0] <= beside <= fill.between[1]:
            continue
        part = int(np.searchsorted(x, beside)) - 1
        inside = 0 <= part < len(face) and face[part] != NO_FACE
        floor = float(heights(outlines, int(face[part]), np.array([beside]))[0]) if inside else -np.inf
        if floor < high[1] - hair:
            yield edge, side, np.array([[low[0], max(low[1], floor)], high])


def _on_edges(outlines: Outlines, laid: Laid) -> dict[int, list[tuple[float, float]]]:
    """Ranges of y, from low to high, in which an edge of a block has a joint: no fill lies in a joint, if it is wide.

    A joint is on the edge of each of its blocks that is nearest to its middle.
    """
    edges: dict[int, list[int]] = defaultdict(list)
    for edge, block in enumerate(outlines.block.tolist()):
        edges[block].append(edge)
    found: dict[int, list[tuple[float, float]]] = defaultdict(list)
    for a, b, first, last in zip(laid.block_a.tolist(), laid.block_b.tolist(), laid.face1, laid.face2, strict=True):
        middle = shapely.Point(0.5 * (first + last))
        for block in (a, b):
            lines = shapely.linestrings([[outlines.first[k], outlines.last[k]] for k in edges[block]])
            nearest = edges[block][int(np.argmin(shapely.distance(lines, middle)))]
            found[nearest].append((float(min(first[1], last[1])), float(max(first[1], last[1]))))
    return found


def _covered(ends: FloatArray, joints: list[tuple[float, float]]) -> Iterator[FloatArray]:
    """The parts (2, 2) of a strip with joints, whose ranges of y do not overlap."""
    low, high = ends[np.argsort(ends[:, 1])]
    for begin, end in joints:
        cut = np.clip([begin, end], low[1], high[1])
        if cut[1] > cut[0]:
            yield low + (cut - low[1])[:, None] / (high[1] - low[1]) * (high - low)


def _is_upright(outlines: Outlines, edge: int) -> bool:
    across, along = outlines.last[edge] - outlines.first[edge]
    return bool(abs(across) < _UPRIGHT * abs(along))
