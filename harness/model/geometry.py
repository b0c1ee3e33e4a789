"""Polygons: what a set of them must be, their centroids, sizes and distances."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.validation import explain_validity

from harness.model.assembly import BoolArray, FloatArray, IntArray, signed_area
from harness.model.errors import InputError

NEAR = 0.02
"""Gap or overlap, in typical block sizes, that may be the accuracy of a drawing: 5 mm between bricks of 250 mm."""


def counter_clockwise(polygon: FloatArray) -> FloatArray:
    """The polygon (k, 2) with its vertices in counter-clockwise order."""
    return polygon if signed_area(polygon) > 0.0 else np.ascontiguousarray(polygon[::-1])


def following(vertices: FloatArray) -> FloatArray:
    """The vertex after each vertex, round the polygon (`np.roll`, which costs ten times as much on a few numbers)."""
    return np.concatenate([vertices[1:], vertices[:1]])


def centroid(polygon: FloatArray) -> FloatArray:
    """Centroid (2,) of a counter-clockwise polygon (k, 2) [length], computed about its first vertex."""
    shifted = polygon - polygon[0]
    x, y = shifted[:, 0], shifted[:, 1]
    x1, y1 = following(x), following(y)
    cross = x * y1 - x1 * y
    doubled_area = cross.sum()
    local = np.array([((x + x1) * cross).sum(), ((y + y1) * cross).sum()]) / (3.0 * doubled_area)
    return np.asarray(polygon[0] + local)


def check_polygon(polygon: FloatArray, element: str) -> None:
    """Refuse a polygon that crosses itself, repeats a vertex or has no area.

    Raises:
        InputError: naming `element`.
    """
    if np.any(np.all(polygon == following(polygon), axis=1)):
        raise InputError(
            "its polygon gives the same vertex twice in a row",
            "List each vertex once and do not repeat the first at the end",
            element,
        )
    shape = shapely.Polygon(polygon)
    if not shape.is_valid:
        raise InputError(
            f"its polygon crosses or touches itself ({explain_validity(shape)})",
            "Give the vertices in order round the block",
            element,
        )
    extent = float(np.ptp(polygon, axis=0).max())
    if shape.area <= 1e-12 * extent**2:
        raise InputError("its polygon has no area", "Give at least three vertices that are not on one line", element)


def typical_size(polygons: Sequence[FloatArray]) -> float:
    """Median over the polygons of the square root of the area [length]."""
    areas = shapely.area(shapes_of(polygons))
    return float(np.median(np.sqrt(areas)))


def distances(polygons: Sequence[FloatArray], which: IntArray, points: FloatArray) -> FloatArray:
    """Distance (k,) of points (k, 2) from the polygons of numbers `which` (k,), 0 within them [length]."""
    return np.asarray(shapely.distance(shapes_of([polygons[k] for k in which]), shapely.points(points)))


def shapes_of(polygons: Sequence[FloatArray]) -> np.ndarray:
    """The polygons (n,) as shapely geometries."""
    sizes = [len(polygon) for polygon in polygons]
    rings = shapely.linearrings(
        np.concatenate([np.vstack([polygon, polygon[:1]]) for polygon in polygons]),
        indices=np.repeat(np.arange(len(polygons)), np.array(sizes) + 1),
    )
    return np.asarray(shapely.polygons(rings))


def check_overlaps(polygons: Sequence[FloatArray], names: Sequence[str], fixed: BoolArray, tolerance: float) -> None:
    """Refuse blocks that share area beyond what the tolerance explains.

    Raises:
        InputError: naming the worst pair.
    """
    shapes = shapes_of(polygons)
    i, j = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    wanted = (i < j) & ~(fixed[i] & fixed[j])
    i, j = i[wanted], j[wanted]
    shared = shapely.area(shapely.intersection(shapes[i], shapes[j]))
    perimeter = shapely.length(shapes)
    excess = shared - tolerance * np.minimum(perimeter[i], perimeter[j])
    if len(excess) and float(excess.max()) > 0.0:
        worst = int(np.argmax(excess))
        where = shapely.intersection(shapes[i[worst]], shapes[j[worst]]).centroid
        depth = _width(shapely.intersection(shapes[i[worst]], shapes[j[worst]]))
        size = float(np.sqrt(min(shapely.area(shapes[i[worst]]), shapely.area(shapes[j[worst]]))))
        allowed = f'; if the drawing is no more accurate, say "interfaces": {{"greatest_overlap": {1.1 * depth:.2g}}}'
        raise InputError(
            f"they overlap by an area of {shared[worst]:.3g}, {depth:.3g} deep, near ({where.x:.6g}, {where.y:.6g})",
            "Blocks may touch but not overlap" + (allowed if depth <= NEAR * size else ""),
            f'blocks "{names[i[worst]]}" and "{names[j[worst]]}"',
        )


def _width(shape: shapely.Geometry) -> float:
    """Least width of a shape: the shorter side of the least rectangle about it [length]."""
    corners = shapely.get_coordinates(shapely.oriented_envelope(shape))
    return float(np.linalg.norm(np.diff(corners, axis=0), axis=1).min()) if len(corners) > 2 else 0.0
