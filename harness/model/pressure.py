"""Pressure on faces of blocks becomes forces: the exact integral of a linear field over the loaded part of each edge.

A field is linear in the position along the segment, or in the depth below a level and zero above it. An edge is cut at
the level, so that the field is linear on every part. With the traction t1 and t2 at the ends x1 and x2 of a part of
length L, the force is L (t1 + t2)/2 and the moment about c is L [a1 x (2 t1 + t2) + a2 x (t1 + 2 t2)]/6, a = x - c.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from harness.model.assembly import BoolArray, FloatArray, IntArray
from harness.model.errors import InputError
from harness.model.geometry import following
from harness.model.pressure_fields import Earth, Pressure, Water

_ON_FACE = 1e-3
"""Distance from a face, in typical block sizes, within which a segment lies on it: coordinates are rounded."""


def _earth_coefficient(earth: Earth) -> float:
    """Horizontal over vertical stress: K as given, (1 - sin phi)/(1 + sin phi) active, 1 - sin phi at rest."""
    if earth.coefficient is not None:
        return earth.coefficient
    sine = math.sin(math.radians(earth.friction_angle or 0.0))
    return (1.0 - sine) / (1.0 + sine) if earth.state == "active" else 1.0 - sine


@dataclass(frozen=True, eq=False)
class Outlines:
    """The edges of all blocks: ends (e, 2) and (e, 2) [length], counter-clockwise, and the block (e,) of each."""

    first: FloatArray
    last: FloatArray
    block: IntArray


def outlines_of(polygons: Sequence[FloatArray]) -> Outlines:
    """The edges of counter-clockwise polygons (k, 2)."""
    block = np.repeat(np.arange(len(polygons)), [len(polygon) for polygon in polygons])
    return Outlines(np.concatenate(polygons), np.concatenate([following(polygon) for polygon in polygons]), block)


def pressure_forces(
    pressure: Pressure,
    chosen: BoolArray,
    outlines: Outlines,
    centroids: FloatArray,
    thickness: Sequence[float],
    unit_weight_factor: float,
    size: float,
    place: str,
) -> FloatArray:
    """Generalised forces (n, 3) of a pressure about the centroids of the blocks [force, force, force length].

    Args:
        pressure: along its segment.
        chosen: (n,) whether it may act on a block.
        outlines: of all blocks.
        centroids: (n, 2) of the blocks [length].
        thickness: (n,) out of plane [length].
        unit_weight_factor: what a unit weight of the file is multiplied with to be in force/length^3.
        size: of a typical block [length].
        place: of the pressure in the file, for errors.

    Raises:
        InputError: part of the segment lies on no face of the blocks, or on faces of two.
    """
    start, end = np.array(pressure.start), np.array(pressure.end)
    length = float(np.hypot(*(end - start)))
    along = (end - start) / length
    faces = _faces_along(start, along, length, chosen, outlines, _ON_FACE * size)
    _check_cover(faces, start, along, length, _ON_FACE * size, place)
    forces = np.zeros((len(centroids), 3))
    for first, last, block, side in faces:
        inward = side * np.array([-along[1], along[0]])
        for begins, ends in _cut_at_level(pressure, start, along, first, last):
            points = start + np.outer([begins, ends], along)
            traction = _traction(pressure, points, [begins / length, ends / length], inward, unit_weight_factor)
            deep = thickness[block] if pressure.line_load is None else 1.0
            extent = pressure.factor * deep * (ends - begins)
            weighted = np.array([[2.0, 1.0], [1.0, 2.0]]) @ traction
            arm = points - centroids[block]
            moment = float((arm[:, 0] * weighted[:, 1] - arm[:, 1] * weighted[:, 0]).sum())
            forces[block] += extent * np.append(0.5 * traction.sum(axis=0), moment / 6.0)
    return forces


def _faces_along(
    start: FloatArray, along: FloatArray, length: float, chosen: BoolArray, outlines: Outlines, tolerance: float
) -> list[tuple[float, float, int, float]]:
    """Parts of the segment on edges: from and to along it, the block, and 1 where its inside is to the left, or -1."""
    found = []
    ends = np.stack([outlines.first, outlines.last]) - start
    off = abs(along[0] * ends[..., 1] - along[1] * ends[..., 0]).max(axis=0)
    for edge in np.flatnonzero((off <= tolerance) & chosen[outlines.block]).tolist():
        a, b = (ends[:, edge] @ along).tolist()
        first, last = max(0.0, min(a, b)), min(length, max(a, b))
        if last - first > tolerance:
            found.append((first, last, int(outlines.block[edge]), 1.0 if b > a else -1.0))
    return sorted(found)


def _check_cover(
    faces: Sequence[tuple[float, float, int, float]],
    start: FloatArray,
    along: FloatArray,
    length: float,
    tolerance: float,
    place: str,
) -> None:
    """Every part of the segment lies on one face.

    Raises:
        InputError: naming the first part that lies on none, or on two.
    """
    reached = 0.0
    for first, last, *_ in [*faces, (length, length, -1, 0.0)]:
        here, there = (f"({x:.6g}, {y:.6g})" for x, y in (start + np.outer(sorted((reached, first)), along)).tolist())
        if first > reached + tolerance:
            raise InputError(
                f"from {here} to {there} it lies on no face of a free block that it may act on",
                'Let "from" and "to" lie on faces that are in one line',
                place,
            )
        if first < reached - tolerance:
            raise InputError(
                f"from {here} to {there} it lies on faces of two blocks, and would push into both",
                'Name the blocks it acts on: "blocks": [...]',
                place,
            )
        reached = last


def _cut_at_level(
    pressure: Pressure, start: FloatArray, along: FloatArray, first: float, last: float
) -> list[tuple[float, float]]:
    """The parts of [first, last] on which the field is linear and not zero."""
    field: Water | Earth | None = pressure.water or pressure.earth
    if field is None:
        return [(first, last)]
    depth_first, depth_last = (field.level - start[1] - along[1] * place for place in (first, last))
    if max(depth_first, depth_last) <= 0.0:
        return []
    if min(depth_first, depth_last) >= 0.0:
        return [(first, last)]
    cut = first + (last - first) * depth_first / (depth_first - depth_last)
    return [(first, cut)] if depth_first > 0.0 else [(cut, last)]


def _traction(
    pressure: Pressure, points: FloatArray, shares: Sequence[float], inward: FloatArray, unit_weight_factor: float
) -> FloatArray:
    """Forces (2, 2) per area, of a line load per length, at two points (2, 2) of a face.

    `shares` (2,) of the segment lie behind them.
    """
    if pressure.line_load is not None:
        return np.tile(pressure.line_load, (2, 1))
    if pressure.water is not None:
        depth = np.maximum(0.0, pressure.water.level - points[:, 1])
        return np.outer(unit_weight_factor * pressure.water.unit_weight * depth, inward)
    if pressure.earth is not None:
        depth = np.maximum(0.0, pressure.earth.level - points[:, 1])
        vertical = pressure.earth.surcharge + unit_weight_factor * pressure.earth.unit_weight * depth
        return np.outer(vertical, [_earth_coefficient(pressure.earth) * inward[0], min(0.0, inward[1])])
    ends = (pressure.uniform,) * 2 if pressure.linear is None else pressure.linear
    begin, end = np.array(ends, dtype=float)
    return np.outer(begin + (end - begin) * np.array(shares), inward)
