"""Outlines with holes as one closed line, which goes along a cut to every hole and back.

Area, centroid and moments of such a line are those of the stone, for what is added along the cut one way is taken off
on the way back; so whatever computes with outlines needs to know of no hole. What draws them, or looks for faces, asks
for the rings.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from harness.model.assembly import FloatArray, signed_area

_Vertex = tuple[float, float]


def ringed(outer: FloatArray, holes: Sequence[FloatArray]) -> FloatArray:
    """One closed line (k, 2) round a stone with holes: counter-clockwise outside, clockwise inside.

    Args:
        outer: (j, 2) vertices outside, either way; holes: (i, 2) vertices of each hole, either way [length].
    """
    line = _turned(outer, 1.0)
    stone = shapely.Polygon(line, holes)
    left = [_turned(hole, -1.0) for hole in holes]
    while left:
        number, at, begin = _shortest_cut(stone, line, left)
        hole = np.roll(left.pop(number), -begin, axis=0)
        line = np.concatenate([line[: at + 1], hole, hole[:1], line[at:]])
    return line


def _turned(ring: FloatArray, way: float) -> FloatArray:
    return ring if signed_area(ring) * way > 0.0 else np.ascontiguousarray(ring[::-1])


def _shortest_cut(stone: shapely.Polygon, line: FloatArray, holes: Sequence[FloatArray]) -> tuple[int, int, int]:
    """Hole, vertex of the line and vertex of the hole between which the shortest cut lies that stays in the stone.

    There is one: of all pairs of vertices of two rings, the nearest that see each other.
    """
    pairs = sorted(
        (float(np.hypot(*(vertex - corner))), number, at, begin)
        for number, hole in enumerate(holes)
        for at, vertex in enumerate(line)
        for begin, corner in enumerate(hole)
    )
    for _, number, at, begin in pairs:
        if stone.covers(shapely.LineString([line[at], holes[number][begin]])):
            return number, at, begin
    return pairs[0][1:]  # a stone that is no polygon, which is reported elsewhere


def rings_of(line: FloatArray) -> list[FloatArray]:
    """The outline and the holes (j, 2) of a closed line of `ringed`; the line itself if it has no cut."""
    if len(line) < 8:  # two triangles and the two vertices of the cut once more
        return [line]
    vertices: list[_Vertex] = [(x, y) for x, y in line.tolist()]
    if len(set(vertices)) == len(vertices):
        return [line]
    steps = list(zip(vertices, vertices[1:] + vertices[:1], strict=True))
    there = set(steps)
    after = dict(step for step in steps if step[::-1] not in there)
    rings = []
    while after:
        ring = [next(iter(after))]
        while (vertex := after.pop(ring[-1], ring[0])) != ring[0]:
            ring.append(vertex)
        rings.append(np.array(ring))
    return sorted(rings, key=lambda ring: -signed_area(ring))
