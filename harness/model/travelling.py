"""Where a travelling load acts: the faces of a wall that look up, and places on them from left to right."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
import shapely

from harness.model.assembly import FloatArray
from harness.model.errors import InputError
from harness.model.fields import Point
from harness.model.geometry import following
from harness.model.load_fields import Load, Loads, PointForce, Travelling
from harness.model.wall import Block

SHARE = 1e-3
"""Of the size of a block: faces as near as this touch, as in `harness.model.pressure`, and shorter ones are none."""
LEVEL = 1e-6
"""Sine of the angle from upright within which a face is upright, as coordinates are rounded, and does not look up."""

Face = tuple[int, FloatArray, FloatArray]
"""A block and the two ends (2,) of a face of it, from left to right."""


def travelling_loads(
    given: Travelling, blocks: Sequence[Block], polygons: Sequence[FloatArray], gravity: Point, place: str
) -> list[Loads]:
    """A live load for each place of a travelling load, from left to right as gravity has it.

    Args:
        given: the travelling load.
        blocks: all n of the wall; polygons: their counter-clockwise outlines (k, 2) [length].
        gravity: its direction (x, y); none where it is zero: down is -y then.
        place: of the load in the file, for errors.

    Raises:
        InputError: it acts on no face.
    """
    chosen = [
        k
        for k, block in enumerate(blocks)
        if not block.fixed
        and (given.blocks is None or block.id in given.blocks)
        and (given.group is None or given.group in block.groups)
    ]
    to_up = _to_up(gravity)
    faces = upward_faces([polygon @ to_up.T for polygon in polygons], chosen, from_above=given.along == "top")
    if not faces:
        remedy = 'Name free blocks with a face that looks up and has no joint, or leave "blocks" and "group" out'
        raise InputError("it acts on no face", remedy, place)
    shares = (np.arange(given.per_face) + 0.5) / given.per_face
    found = []
    for block, left, right in sorted(faces, key=lambda face: tuple(face[1] + face[2])):
        for share in shares.tolist():
            x, y = ((left + share * (right - left)) @ to_up).tolist()
            found.append(Loads(live=Load(points=[PointForce(block=blocks[block].id, at=(x, y), force=given.force)])))
    return found


def _to_up(gravity: Point) -> FloatArray:
    """The rotation (2, 2) after which gravity points to -y."""
    size = math.hypot(*gravity)
    x, y = (gravity[0] / size, gravity[1] / size) if size > 0.0 else (0.0, -1.0)
    return np.array([[-y, x], [-x, -y]])


def upward_faces(polygons: Sequence[FloatArray], chosen: Iterable[int], *, from_above: bool) -> list[Face]:
    """The parts of edges of the chosen blocks that look towards +y and touch no other block.

    Args:
        polygons: (n,) counter-clockwise outlines (k, 2) [length].
        chosen: indices of blocks.
        from_above: whether parts with a block anywhere above them are left out.
    """
    shapes = [shapely.Polygon(polygon) for polygon in polygons]
    tree = shapely.STRtree(shapes)
    top = max(float(polygon[:, 1].max()) for polygon in polygons)
    faces: list[Face] = []
    for block in chosen:
        polygon = polygons[block]
        touch = SHARE * math.sqrt(shapes[block].area)
        for start, end in zip(polygon, following(polygon), strict=True):
            right, left = start, end  # what looks up runs from right to left on a counter-clockwise outline
            width, length = float(right[0] - left[0]), float(np.hypot(*(right - left)))
            if width <= LEVEL * length:
                continue
            normal = np.array([left[1] - right[1], width]) / length
            line = shapely.LineString([left + touch * normal, right + touch * normal])
            above = line
            if from_above:
                first, last = line.coords
                above = shapely.Polygon([first, last, (last[0], top + touch), (first[0], top + touch)])
            hidden = []
            for other in tree.query(above).tolist():
                if other == block:
                    continue
                cut = shapely.intersection(above, shapes[other])
                if not cut.is_empty:
                    low, _, high, _ = cut.bounds
                    offset = touch * float(normal[0])
                    hidden.append(((low - offset - left[0]) / width, (high - offset - left[0]) / width))
            faces += [
                (block, left + a * (right - left), left + b * (right - left))
                for a, b in _gaps(hidden)
                if (b - a) * length > touch
            ]
    return faces


def _gaps(hidden: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """What intervals leave of [0, 1]."""
    found, reached = [], 0.0
    for low, high in sorted(hidden):
        if low > reached:
            found.append((reached, min(low, 1.0)))
        reached = max(reached, high)
    return [*found, (reached, 1.0)] if reached < 1.0 else found
