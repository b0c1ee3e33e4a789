"""Where blocks touch: contact segments found from polygons, and the checks a set of polygons must pass.

Edges of different blocks that run in opposite directions within a tolerance and overlap along a length are
contacts. Candidates come from a spatial index (shapely STRtree), the rest is done on arrays.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.validation import explain_validity

from harness.model.assembly import BoolArray, FloatArray, IntArray, signed_area
from harness.model.errors import InputError


@dataclass(frozen=True)
class Contacts:
    """Contact segments between blocks. m = number found.

    Attributes:
        block_a, block_b: (m,) block indices, a < b.
        start, end: (m, 2) ends of the segments [length].
        corners: (k, 2) pairs of blocks that touch at a point only, and so do not support each other here.
    """

    block_a: IntArray
    block_b: IntArray
    start: FloatArray
    end: FloatArray
    corners: IntArray


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
    areas = shapely.area(_shapes(polygons))
    return float(np.median(np.sqrt(areas)))


def distances(polygons: Sequence[FloatArray], which: IntArray, points: FloatArray) -> FloatArray:
    """Distance (k,) of points (k, 2) from the polygons of numbers `which` (k,), 0 within them [length]."""
    return np.asarray(shapely.distance(_shapes([polygons[k] for k in which]), shapely.points(points)))


def _shapes(polygons: Sequence[FloatArray]) -> np.ndarray:
    sizes = [len(polygon) for polygon in polygons]
    rings = shapely.linearrings(
        np.concatenate([np.vstack([polygon, polygon[:1]]) for polygon in polygons]),
        indices=np.repeat(np.arange(len(polygons)), np.array(sizes) + 1),
    )
    return np.asarray(shapely.polygons(rings))


def find_contacts(polygons: Sequence[FloatArray], fixed: BoolArray, tolerance: float) -> Contacts:
    """Contact segments between the blocks, sorted by (a, b) and along the segment.

    Args:
        polygons: (n,) counter-clockwise vertex arrays (k, 2) [length].
        fixed: (n,) fixed blocks; contacts between two of them are left out, as they carry no unknown.
        tolerance: edges this near to each other touch; contacts no longer than this are corners [length].
    """
    sizes = np.array([len(polygon) for polygon in polygons])
    owner = np.repeat(np.arange(len(polygons)), sizes)
    first = np.concatenate(list(polygons))
    last = np.concatenate([following(polygon) for polygon in polygons])
    direction = last - first
    edge_length = np.linalg.norm(direction, axis=1)
    direction = direction / edge_length[:, None]

    lines = shapely.linestrings(np.stack([first, last], axis=1))
    i, j = shapely.STRtree(lines).query(lines, predicate="dwithin", distance=tolerance)
    opposed = (owner[i] < owner[j]) & (np.einsum("kd,kd->k", direction[i], direction[j]) < 0.0)
    opposed &= ~(fixed[owner[i]] & fixed[owner[j]])
    i, j = i[opposed], j[opposed]

    # Edge j seen from edge i: places along i and distances from it at both ends of the overlap.
    def along_and_off(points: FloatArray) -> tuple[FloatArray, FloatArray]:
        relative = points - first[i]
        along = np.einsum("kd,kd->k", relative, direction[i])
        off = relative[:, 1] * direction[i, 0] - relative[:, 0] * direction[i, 1]
        return along, off

    along_start, off_start = along_and_off(last[j])
    along_end, off_end = along_and_off(first[j])
    low = np.maximum(along_start, 0.0)
    high = np.minimum(along_end, edge_length[i])
    overlaps = high - low > tolerance
    i, j, low, high = i[overlaps], j[overlaps], low[overlaps], high[overlaps]
    along_start, along_end = along_start[overlaps], along_end[overlaps]
    off_start, off_end = off_start[overlaps], off_end[overlaps]
    slope = (off_end - off_start) / (along_end - along_start)
    off_low = off_start + slope * (low - along_start)
    off_high = off_start + slope * (high - along_start)
    near = np.maximum(abs(off_low), abs(off_high)) <= tolerance
    i, low, high, j = i[near], low[near], high[near], j[near]
    start = first[i] + low[:, None] * direction[i]
    end = first[i] + high[:, None] * direction[i]

    a, b = owner[i], owner[j]
    order = np.lexsort((end[:, 1], end[:, 0], start[:, 1], start[:, 0], b, a))
    contacts = _merge_collinear(a[order], b[order], start[order], end[order], tolerance)
    return Contacts(*contacts, corners=_corner_pairs(polygons, fixed, contacts[0], contacts[1], tolerance))


def _merge_collinear(
    a: IntArray, b: IntArray, start: FloatArray, end: FloatArray, tolerance: float
) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
    """Join segments of the same pair that continue each other in a straight line (a vertex inside a flat face)."""
    keep: list[int] = []
    ends = end.copy()
    starts = start.copy()
    for k in range(len(a)):
        joined = False
        for kept in reversed(keep):
            if a[kept] != a[k] or b[kept] != b[k]:
                break
            one = (ends[kept] - starts[kept]) / np.linalg.norm(ends[kept] - starts[kept])
            two = ends[k] - starts[k]
            straight = abs(one[0] * two[1] - one[1] * two[0]) <= tolerance and np.dot(one, two) > 0.0
            if straight and np.linalg.norm(ends[kept] - starts[k]) <= tolerance:
                ends[kept] = ends[k]
                joined = True
            elif straight and np.linalg.norm(starts[kept] - ends[k]) <= tolerance:
                starts[kept] = starts[k]
                joined = True
            if joined:
                break
        if not joined:
            keep.append(k)
    return a[keep], b[keep], starts[keep], ends[keep]


def _corner_pairs(
    polygons: Sequence[FloatArray], fixed: BoolArray, a: IntArray, b: IntArray, tolerance: float
) -> IntArray:
    shapes = _shapes(polygons)
    i, j = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=tolerance)
    wanted = (i < j) & ~(fixed[i] & fixed[j])
    count = len(polygons)
    touching = i[wanted] * count + j[wanted]
    alone = np.setdiff1d(touching, a * count + b)
    return np.stack([alone // count, alone % count], axis=1)


def check_overlaps(polygons: Sequence[FloatArray], names: Sequence[str], fixed: BoolArray, tolerance: float) -> None:
    """Refuse blocks that share area beyond what the tolerance explains.

    Raises:
        InputError: naming the worst pair.
    """
    shapes = _shapes(polygons)
    i, j = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    wanted = (i < j) & ~(fixed[i] & fixed[j])
    i, j = i[wanted], j[wanted]
    shared = shapely.area(shapely.intersection(shapes[i], shapes[j]))
    perimeter = shapely.length(shapes)
    excess = shared - tolerance * np.minimum(perimeter[i], perimeter[j])
    if len(excess) and float(excess.max()) > 0.0:
        worst = int(np.argmax(excess))
        where = shapely.intersection(shapes[i[worst]], shapes[j[worst]]).centroid
        raise InputError(
            f"they overlap by an area of {shared[worst]:.3g} near ({where.x:.6g}, {where.y:.6g})",
            "Blocks may touch but not overlap",
            f'blocks "{names[i[worst]]}" and "{names[j[worst]]}"',
        )
