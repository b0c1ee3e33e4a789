"""Contact strips: for every interface a pair of thin quadrilaterals, one on each block, that touch only each other.

A rigid-body engine finds contacts between whole polygons: it then decides by itself which corners touch, cannot give
two interfaces of one block different friction cheaply, and wants convex shapes. A pair of strips per interface turns
the wall's own list of interfaces into the engine's: the strip of block a has its face exactly between the two contact
points, so inset points, several interfaces between the same two blocks, friction by interface and non-convex blocks
all need nothing further. The pairs are kept apart by a colour that no neighbouring pair shares.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from shapely import STRtree, box

from harness.model.assembly import Assembly, FloatArray, IntArray

_MAX_COLOURS = 32
"""Bits of a collision category in Chipmunk."""


@dataclass(frozen=True)
class StripShape:
    """How strips are drawn.

    Attributes:
        rounding: radius around each strip, in unit lengths. The strips' faces are set back by it: the contact plane
            stays exact.
        overlap: of the rounded faces, in unit lengths: far above rounding noise, far below anything that shows in
            forces.
        depth: of a strip as a part of its length.
        overhang: how much the strip of block b is longer than that of block a at each end, as a part of the length.
            Faces of the same length would put two equal points into the engine's closest-point search (a - b at both
            ends), whose normal is then decided by rounding noise.
        margin: distance, in radii, at which two strips count as neighbours.
    """

    rounding: float = 1e-3
    overlap: float = 1e-8
    depth: float = 0.1
    overhang: float = 0.1
    margin: float = 3.0


class CannotModel(ValueError):
    """The wall has something that contact strips cannot model; the message names it."""


@dataclass(frozen=True, eq=False)
class _Strips:
    """The strips of all interfaces, in unit lengths.

    Attributes:
        on_a: (m, 4, 2) vertices of the strips of blocks a.
        on_b: (m, 4, 2) vertices of the strips of blocks b.
        colour: (m,) collision colours, 0 to 31.
    """

    on_a: FloatArray
    on_b: FloatArray
    colour: IntArray


def require_lengths(assembly: Assembly) -> None:
    """Make sure that the two contact points of every interface are a distance apart.

    Raises:
        CannotModel: they are not.
    """
    for p in np.flatnonzero(~(assembly.length > 0.0)):
        a, b = assembly.block_a[p], assembly.block_b[p]
        raise CannotModel(
            f"interface {p} between {assembly.block_ids[a]} and {assembly.block_ids[b]} has no length between its "
            "contact points; distinct elements need two points a distance apart"
        )


def build_strips(assembly: Assembly, unit: float, shape: StripShape = StripShape()) -> _Strips:
    """The pair of strips of every interface, about the middle of the wall.

    Args:
        assembly: the wall.
        unit: the length that becomes 1 [length].
        shape: how they are drawn.

    Raises:
        CannotModel: an interface has no length, or more than 32 interfaces crowd one place.
    """
    require_lengths(assembly)
    length = assembly.length / unit
    back = shape.rounding - shape.overlap / 2.0
    end1, end2 = (assembly.end1 - assembly.middle) / unit, (assembly.end2 - assembly.middle) / unit
    along = assembly.tangent * length[:, None]
    inward = assembly.normal * length[:, None]

    def strip(side: float, overhang: float) -> FloatArray:
        face1 = end1 - overhang * along + side * back * assembly.normal
        face2 = end2 + overhang * along + side * back * assembly.normal
        tail, taper = side * shape.depth * inward, 2 * shape.depth * along
        return np.stack([face1, face2, face2 + tail - taper, face1 + tail + taper], axis=1)

    on_a, on_b = strip(-1.0, 0.0), strip(1.0, shape.overhang)
    return _Strips(
        on_a, on_b, colour_strips(np.concatenate([on_a, on_b], axis=1), margin=shape.margin * shape.rounding)
    )


def colour_strips(vertices: FloatArray, margin: float) -> IntArray:
    """Colours (m,) such that pairs of strips whose boxes overlap have different ones (greedy, in order).

    Args:
        vertices: (m, k, 2) all vertices of each pair.
        margin: how far the boxes are widened.

    Raises:
        CannotModel: more than 32 colours would be needed.
    """
    low, high = vertices.min(axis=1) - margin, vertices.max(axis=1) + margin
    boxes = [box(*lo, *hi) for lo, hi in zip(low, high, strict=True)]
    colour = np.full(len(boxes), -1, dtype=np.int64)
    if not boxes:
        return colour
    first, second = STRtree(boxes).query(boxes)
    neighbours: list[list[int]] = [[] for _ in boxes]
    for i, j in zip(first, second, strict=True):
        neighbours[i].append(int(j))
    for i, near in enumerate(neighbours):
        taken = {int(colour[j]) for j in near}
        colour[i] = next(c for c in range(len(boxes) + 1) if c not in taken)
    if colour.max() >= _MAX_COLOURS:
        raise CannotModel(f"{colour.max() + 1} interfaces lie close together; the limit is {_MAX_COLOURS}")
    return colour
