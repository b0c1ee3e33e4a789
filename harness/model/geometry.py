"""Polygons: what a set of them must be, their centroids, sizes and distances."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from shapely.validation import explain_validity

from harness.model.assembly import BoolArray, FloatArray, IntArray, signed_area
from harness.model.errors import MOST_WORDED, InputError, Spot, raise_faults, uncounted
from harness.model.rings import rings_of

NEAR = 0.02
"""Gap or overlap, in typical block sizes, that may be the accuracy of a drawing: 5 mm between bricks of 250 mm."""
_READ_A_VERTEX = 20
"""Times that a vertex is read, on the average, in the comparison of blocks that meet. A block of a wall has 6
neighbours, 8 in a grid, and each pair reads the vertices of both."""
_READ_BESIDES = 2_000_000
"""Vertices read besides, a few seconds of work: a fan of 600 wedges about one point, or 400 blocks on a ground of
5,000 vertices."""
_PAIRS_A_BLOCK = 10
"""Pairs of blocks that touch or overlap, a block: a block of a wall has 6 neighbours."""
_PAIRS_BESIDES = 10_000
"""Such pairs besides, of which the common area is computed where blocks are known to overlap, a second of work."""
CHUNK = 32
"""Geometries that are looked up at once: what is found beyond a limit is at most what so many find."""


def counter_clockwise(polygon: FloatArray) -> FloatArray:
    """The polygon (k, 2) with its vertices in counter-clockwise order."""
    return polygon if signed_area(polygon) > 0.0 else np.ascontiguousarray(polygon[::-1])


def following(vertices: FloatArray) -> FloatArray:
    """The vertex after each vertex, round the polygon (`np.roll`, which costs ten times as much on a few numbers)."""
    return np.concatenate([vertices[1:], vertices[:1]])


def centroids(polygons: Sequence[FloatArray]) -> FloatArray:
    """Centroids (n, 2) of counter-clockwise polygons [length], each computed about its first vertex.

    Those of as many vertices are computed together: one by one they take a tenth of the time of a wall's expansion.
    """
    sizes = np.array([len(polygon) for polygon in polygons])
    found = np.empty((len(polygons), 2))
    for size in sorted(set(sizes.tolist())):
        same = np.flatnonzero(sizes == size)
        outlines = np.stack([polygons[k] for k in same.tolist()])
        x, y = np.ascontiguousarray((outlines - outlines[:, :1]).transpose(2, 0, 1))
        x1, y1 = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
        cross = x * y1 - x1 * y
        moments = np.stack([((x + x1) * cross).sum(axis=1), ((y + y1) * cross).sum(axis=1)], axis=1)
        found[same] = outlines[:, 0] + moments / (3.0 * cross.sum(axis=1))[:, None]
    return found


def polygon_faults(polygons: Sequence[FloatArray], elements: Sequence[str]) -> list[InputError]:
    """A fault, naming its element, for every polygon that crosses itself, repeats a vertex or has no area."""
    if not polygons:
        return []
    first = np.cumsum([0, *(len(polygon) for polygon in polygons[:-1])])
    vertices = np.concatenate(list(polygons))
    onward = np.concatenate([following(polygon) for polygon in polygons])
    # Vertices so near that the square of their distance is zero are one: no direction can be computed between them.
    doubled = np.logical_or.reduceat(((vertices - onward) ** 2).sum(axis=1) == 0.0, first)
    extent = (np.maximum.reduceat(vertices, first) - np.minimum.reduceat(vertices, first)).max(axis=1)
    shapes = shapely.polygons(_closed(polygons))  # as they are: an outline that touches itself is no hole
    faulty = doubled | ~shapely.is_valid(shapes) | (shapely.area(shapes) <= 1e-12 * extent**2)
    return [_fault_of(shapes[k], elements[k], doubled=bool(doubled[k])) for k in np.flatnonzero(faulty).tolist()]


def _fault_of(shape: shapely.Polygon, element: str, *, doubled: bool) -> InputError:
    if doubled:
        return InputError(
            "its polygon gives the same vertex twice in a row",
            "List each vertex once and do not repeat the first at the end",
            element,
        )
    if not shape.is_valid:
        return InputError(
            f"its polygon crosses or touches itself ({explain_validity(shape)})",
            "Give the vertices in order round the block",
            element,
        )
    return InputError("its polygon has no area", "Give at least three vertices that are not on one line", element)


def typical_size(shapes: np.ndarray) -> float:
    """Median over blocks (n,), as `shapes_of` gives them, of the square root of the area [length]."""
    return float(np.median(np.sqrt(shapely.area(shapes))))


def distances_beyond(polygons: Sequence[FloatArray], which: IntArray, points: FloatArray, near: float) -> FloatArray:
    """Distance (k,) of points (k, 2) from the polygons of numbers `which` (k,), 0 where it is no more than `near`.

    Each polygon is indexed once, so that thousands of points of one with thousands of vertices take no product of both.
    """
    found, at = np.zeros(len(which)), shapely.points(points)
    used, place = np.unique(which, return_inverse=True)
    shapes = shapes_of([polygons[k] for k in used]) if len(used) else np.empty(0, dtype=object)
    shapely.prepare(shapes)
    beyond = np.flatnonzero(~shapely.dwithin(shapes[place], at, near))
    for number in np.unique(place[beyond]).tolist():
        mine = beyond[place[beyond] == number] if len(used) > 1 else beyond
        ring = shapely.get_coordinates(shapely.get_exterior_ring(shapes[number]))
        edges = shapely.STRtree(shapely.linestrings(np.stack([ring[:-1], ring[1:]], axis=1)))
        found[mine] = edges.query_nearest(at[mine], all_matches=False, return_distance=True)[1]
    return found


def shapes_of(polygons: Sequence[FloatArray]) -> np.ndarray:
    """The polygons (n,), those with holes too, as shapely geometries."""
    parts = [rings_of(polygon) for polygon in polygons]
    rings = _closed([ring for part in parts for ring in part])
    return np.asarray(shapely.polygons(rings, indices=np.repeat(np.arange(len(parts)), [len(part) for part in parts])))


def _closed(rings: Sequence[FloatArray]) -> np.ndarray:
    """Lines (n,) of shapely round polygons (k, 2)."""
    closed = np.array([len(ring) for ring in rings]) + 1
    owner = np.repeat(np.arange(len(rings)), closed)
    vertex = np.arange(len(owner)) - owner
    last = np.cumsum(closed) - 1
    vertex[last] = vertex[last] - closed + 1
    return np.asarray(shapely.linearrings(np.concatenate(list(rings))[vertex], indices=owner))


def overlapping(shapes: np.ndarray, fixed: BoolArray, tolerance: float) -> tuple[IntArray, FloatArray]:
    """Pairs (k, 2) of blocks that share area beyond what a tolerance [length] explains, the worst first, and the areas.

    Args:
        shapes: (n,) of the blocks; fixed: (n,) which of them are: two fixed ones may overlap.

    Raises:
        InputError: so many meet that it cannot be seen which of them overlap.
    """
    i, j = _meeting(shapes)
    _check_crossings(shapes, i, j)
    perimeter = shapely.length(shapes)
    nothing = np.empty((0, 2), dtype=np.int64), np.empty(0)
    # No pair shares more than all blocks together, and their union is found in n log n, where pairs are many.
    meet = np.isin(np.arange(len(shapes)), np.stack([i, j]))  # blocks apart from all share nothing, and cost the most
    apart = shapely.area(shapes[meet & ~fixed]).sum() + shapely.union_all(shapes[meet & fixed]).area
    common = float(apart - shapely.union_all(shapes[meet]).area)
    if common <= tolerance * perimeter.min():
        return nothing
    wanted = ~(fixed[i] & fixed[j])
    i, j = i[wanted], j[wanted]
    if len(i) > _PAIRS_A_BLOCK * len(shapes) + _PAIRS_BESIDES:
        raise InputError(
            f"they share an area of {common:.3g} in all, and {len(i):,} pairs of the {len(shapes):,} touch or overlap, "
            "too many to say which",
            "Blocks may touch but not overlap: draw each once",
            "blocks",
        )
    shared = shapely.area(shapely.intersection(shapes[i], shapes[j]))
    excess = shared - tolerance * np.minimum(perimeter[i], perimeter[j])
    worst = np.flatnonzero(excess > 0.0)
    worst = worst[np.argsort(-excess[worst], kind="stable")]
    return np.stack([i[worst], j[worst]], axis=1), shared[worst]


def _meeting(shapes: np.ndarray) -> tuple[IntArray, IntArray]:
    """Pairs of blocks, the first number the smaller, that touch or share area.

    Raises:
        InputError: their common areas would take more vertices to compute than the limit allows.
    """
    tree, vertices = shapely.STRtree(shapes), shapely.get_num_coordinates(shapes)
    most = _READ_A_VERTEX * int(vertices.sum()) + _READ_BESIDES
    found, read = [], 0
    for first in range(0, len(shapes), CHUNK):
        i, j = tree.query(shapes[first : first + CHUNK], predicate="intersects")
        i += first
        once = i < j
        i, j = i[once], j[once]
        found.append(np.stack([i, j]))
        read += int((vertices[i] + vertices[j]).sum())
        if read > most:
            number = sum(pairs.shape[1] for pairs in found)
            raise InputError(
                f"among its {len(shapes):,} blocks more than {number - 1:,} pairs touch or overlap, "
                "too many to compare their outlines",
                "Blocks may touch but not overlap: draw each once, and simplify outlines of thousands of vertices",
                "blocks",
            )
    i, j = np.concatenate(found, axis=1)
    return i, j


def _check_crossings(shapes: np.ndarray, i: IntArray, j: IntArray) -> None:
    """Refuse outlines of pairs (k,) and (k,) of blocks that cross each other at too many points.

    Outlines of p and q vertices cross at up to p q points; where this is at most a multiple of p + q, the limit on
    vertices is one on crossings. The others are counted.

    Raises:
        InputError: as a comb across another has.
    """
    vertices = shapely.get_num_coordinates(shapes)
    many = vertices[i] * vertices[j] > _READ_A_VERTEX * (vertices[i] + vertices[j])
    if not many.any():
        return
    rings = shapely.get_rings(shapes[np.union1d(i[many], j[many])])
    points, ring = shapely.get_coordinates(rings, return_index=True)
    onward = ring[1:] == ring[:-1]
    edges = shapely.linestrings(np.stack([points[:-1][onward], points[1:][onward]], axis=1))
    # To look at an edge that crosses costs as much as to read five vertices or more.
    most = (_READ_A_VERTEX * len(edges)) // 5 + _READ_BESIDES // _READ_A_VERTEX
    tree = shapely.STRtree(edges)
    for predicate in (None, "crosses"):  # where few boxes of edges meet, few edges do, and boxes cost a twentieth
        found = 0
        for first in range(0, len(edges), CHUNK):
            found += tree.query(edges[first : first + CHUNK], predicate=predicate).shape[1]
            if found > 2 * most:
                break
        else:
            return
    raise InputError(
        f"outlines of its blocks cross each other at more than {most:,} points, too many to compute what they share",
        "Blocks may touch but not overlap; simplify outlines of thousands of vertices",
        "blocks",
    )


def overlap_faults(
    shapes: np.ndarray, names: Sequence[str], pairs: IntArray, shared: FloatArray, most: int = MOST_WORDED
) -> list[InputError]:
    """The first so many pairs (k, 2) of overlapping blocks in words, and how many more there are.

    Args:
        shapes: (n,) of the blocks; names: (n,).
        pairs, shared: as `overlapping` gives them.
        most: pairs that get a fault each.
    """
    worded = zip(pairs[:most].tolist(), shared[:most].tolist(), strict=True)
    faults = [_overlap(shapes[a], shapes[b], (names[a], names[b]), area) for (a, b), area in worded]
    if len(pairs) > most:
        faults.append(uncounted(len(pairs) - most, "pairs of blocks overlap", "blocks"))
    return faults


def _overlap(one: shapely.Geometry, other: shapely.Geometry, names: tuple[str, str], area: float) -> InputError:
    common = shapely.intersection(one, other)
    where, depth = common.centroid, _width(common)
    size = float(np.sqrt(min(one.area, other.area)))
    allowed = f'; if the drawing is no more accurate, say "interfaces": {{"greatest_overlap": {1.1 * depth:.2g}}}'
    return InputError(
        f"they overlap by an area of {area:.3g}, {depth:.3g} deep",
        "Blocks may touch but not overlap" + (allowed if depth <= NEAR * size else ""),
        f'blocks "{names[0]}" and "{names[1]}"',
        spot=Spot(names, (where.x, where.y), depth),
    )


def check_overlaps(shapes: np.ndarray, names: Sequence[str], fixed: BoolArray, tolerance: float) -> None:
    """Refuse blocks that share area beyond what the tolerance explains.

    Raises:
        InputError: naming the worst pair, and how many more there are; or more meet than can be compared.
    """
    pairs, shared = overlapping(shapes, fixed, tolerance)
    found = overlap_faults(shapes, names, pairs[:1], shared[:1])
    if len(pairs) > 1:
        found[0].remedy += f"; {len(pairs) - 1} more pair(s) overlap, and `drystone validate` lists them"
    raise_faults(found)


def _width(shape: shapely.Geometry) -> float:
    """Least width of a shape: the shorter side of the least rectangle about it [length]."""
    corners = shapely.get_coordinates(shapely.oriented_envelope(shape))
    return float(np.linalg.norm(np.diff(corners, axis=0), axis=1).min()) if len(corners) > 2 else 0.0
