"""Where blocks touch: pairs of faces that face each other, with the interface in the middle between them.

Two edges of different blocks are the faces of one joint if they run in opposite directions within an angle, lie beside
each other along a length, and are nowhere further apart, or further into each other, than is allowed. The interface
lies half-way between them: each end of it between a vertex of one face and the foot of its perpendicular on the other.
So nothing depends on the order or the numbering of the blocks, nor on where a polygon begins. Candidates come from a
spatial index (shapely STRtree), the rest is done on arrays.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import shapely

from harness.model.assembly import BoolArray, FloatArray, IntArray
from harness.model.errors import InputError, Spot, first_few
from harness.model.geometry import following
from harness.model.rings import rings_of

TIMES = 10.0
"""The same in greatest gaps: a drawing with joints of 2 mm and one of 15 has lost that one."""
_MOST_NEAR = 10_000_000
"""Pairs of a vertex and a face within sight of it, those of its own block too: each takes some 50 bytes, and a wall of
100,000 blocks has about 3 million."""
_CHUNK = 1_000_000
"""Pairs that are looked up at once."""
_FIRST = 16
"""Vertices that are looked up first, when it is not known how many faces one has in sight."""


@dataclass(frozen=True)
class JointLimits:
    """What may be the two faces of one joint.

    Attributes:
        gap: greatest distance between them [length].
        overlap: greatest depth by which they lie within each other [length].
        angle: greatest angle between them [radians].
        length: contacts no longer than this are corners [length].
        sight: faces further apart or deeper than that, and up to here, are near misses [length].
    """

    gap: float
    overlap: float
    angle: float
    length: float
    sight: float = 0.0


@dataclass(frozen=True)
class Contacts:
    """Contact segments between blocks. m = number found.

    Attributes:
        block_a, block_b: (m,) block indices, a < b.
        start, end: (m, 2) ends of the segments, counter-clockwise round a [length].
        corners: (k, 2) pairs of blocks that touch at a point only, and so do not support each other here.
        missed: (j, 2) pairs of blocks without a contact whose faces face each other from a little further off, or
            lie a little deeper within each other.
        missed_gap: (j,) how far or how deep [length].
        missed_at: (j, 2) middles of the segments between them [length].
    """

    block_a: IntArray
    block_b: IntArray
    start: FloatArray
    end: FloatArray
    corners: IntArray
    missed: IntArray
    missed_gap: FloatArray
    missed_at: FloatArray


@dataclass(frozen=True)
class _Edges:
    """Directed edges of all blocks, and their owners. `before` is the edge that ends where each begins."""

    owner: IntArray
    first: FloatArray
    last: FloatArray
    before: IntArray
    _seen: list[tuple[float, IntArray, IntArray]] = field(default_factory=list, repr=False)

    @cached_property
    def _points(self) -> np.ndarray:
        return np.asarray(shapely.points(self.first))

    @cached_property
    def _lines(self) -> np.ndarray:
        return np.asarray(shapely.linestrings(np.stack([self.first, self.last], axis=1)))

    @cached_property
    def _tree(self) -> shapely.STRtree:
        return shapely.STRtree(self._lines)

    def near(self, distance: float) -> tuple[IntArray, IntArray]:
        """Vertices, by the edge that begins there, and the edges of other blocks within a distance of them [length].

        The widest look so far is kept, for a closer one sees a part of it.

        Raises:
            InputError: they are more than can be looked at.
        """
        reach, vertex, edge = self._seen[-1] if self._seen else (-1.0, np.empty(0, np.int64), np.empty(0, np.int64))
        if distance > reach:
            vertex, edge = self._looked_up(distance)
            self._seen.append((distance, vertex, edge))
        elif distance < reach:
            vertex, edge = self._within(distance, vertex, edge)
        return vertex, edge

    def _looked_up(self, distance: float) -> tuple[IntArray, IntArray]:
        """The pairs within a distance, sought for so many vertices at a time as are likely to find `_CHUNK` faces.

        Raises:
            InputError: as of `near`.
        """
        count = len(self._points)
        boxes = shapely.box(*(self.first - distance).T, *(self.first + distance).T)
        # All are counted before any distance is computed, which takes ten times as long.
        first, found, pairs = 0, 0, []
        while first < count:
            last = min(count, first + max(1, _CHUNK * first // max(found, 1) if first else _FIRST))
            vertex, edge = self._tree.query(boxes[first:last])
            found += len(vertex)
            if found > _MOST_NEAR:
                raise InputError(
                    f"its outlines have {count:,} vertices, and {last:,} of them have about {found / last:.0f} faces "
                    f"each within {distance:.3g}, too many to find the joints among them",
                    "Simplify the outlines, let faces of a joint lie less apart (greatest_gap, greatest_overlap, "
                    "sight), or give the interfaces as a list",
                    "interfaces",
                )
            vertex += first
            others = self.owner[vertex] != self.owner[edge]  # most faces in sight are of the own round block
            pairs.append((vertex[others], edge[others]))
            first = last
        close = [self._within(distance, *pair) for pair in pairs]
        return np.concatenate([vertex for vertex, _ in close]), np.concatenate([edge for _, edge in close])

    def _within(self, distance: float, vertex: IntArray, edge: IntArray) -> tuple[IntArray, IntArray]:
        """Those of the pairs that are no further apart."""
        close = shapely.dwithin(self._points[vertex], self._lines[edge], distance)
        return vertex[close], edge[close]

    def side_by_side(self, distance: float) -> tuple[IntArray, IntArray]:
        """Pairs of edges, each way round, of which one ends at a vertex within a distance of the other [length].

        Wherever two faces lie beside each other, their common length ends at a vertex of one of them, which is no
        further from the other than they are apart there. So these are all the pairs there are, and they are few: a box
        about a slanting face holds hundreds of others where long faces lie side by side, the box about a vertex a few.
        """
        count = len(self.owner)
        vertex, edge = self.near(distance)
        own, other = np.concatenate([vertex, self.before[vertex]]), np.concatenate([edge, edge])
        code = np.sort(np.concatenate([own * count + other, other * count + own]))  # np.unique hashes: 5 times slower
        code = code[np.diff(code, prepend=-1) > 0]
        return code // count, code % count

    def foot(self, k: IntArray, point: FloatArray) -> FloatArray:
        """Feet (p, 2) of the perpendiculars from points (p, 2) on edges k."""
        vector = self.last[k] - self.first[k]
        share = ((point - self.first[k]) * vector).sum(axis=1) / (vector * vector).sum(axis=1)
        return np.asarray(self.first[k] + share[:, None] * vector)


def edges_of(polygons: Sequence[FloatArray]) -> _Edges:
    """The edges of polygons (k, 2), counter-clockwise each, those round holes clockwise."""
    parts = [rings_of(polygon) for polygon in polygons]
    rings = [ring for part in parts for ring in part]
    sizes = np.array([len(ring) for ring in rings])
    owner = np.repeat(np.repeat(np.arange(len(parts)), [len(part) for part in parts]), sizes)
    before = np.arange(len(owner)) - 1
    before[np.cumsum(sizes) - sizes] += sizes
    return _Edges(owner, np.concatenate(rings), np.concatenate([following(ring) for ring in rings]), before)


def find_contacts(polygons: Sequence[FloatArray], fixed: BoolArray, limits: JointLimits) -> Contacts:
    """Contact segments between the blocks, sorted by (a, b) and along the segment.

    Args:
        polygons: (n,) counter-clockwise vertex arrays (k, 2) [length].
        fixed: (n,) fixed blocks; contacts between two of them are left out, as they carry no unknown.
        limits: what may be the two faces of one joint.
    """
    edges = edges_of(polygons)
    vector = edges.last - edges.first
    direction = vector / np.linalg.norm(vector, axis=1)[:, None]
    i, j = edges.side_by_side(max(limits.gap, limits.overlap, limits.sight) / np.cos(limits.angle))
    facing = (edges.owner[i] < edges.owner[j]) & ~(fixed[edges.owner[i]] & fixed[edges.owner[j]])
    facing &= np.einsum("kd,kd->k", direction[i], direction[j]) <= -np.cos(limits.angle)
    i, j = i[facing], j[facing]

    # Along the bisector of the two faces, about a point between them.
    axis = direction[i] - direction[j]
    axis = axis / np.linalg.norm(axis, axis=1)[:, None]
    origin = 0.25 * ((edges.first[i] + edges.last[i]) + (edges.first[j] + edges.last[j]))

    def along(points: FloatArray) -> FloatArray:
        relative = points - origin
        return np.asarray(relative[:, 0] * axis[:, 0] + relative[:, 1] * axis[:, 1])

    first_i, last_i, first_j, last_j = (
        along(p) for p in (edges.first[i], edges.last[i], edges.first[j], edges.last[j])
    )
    low, high = np.maximum(first_i, last_j), np.minimum(last_i, first_j)

    def across(
        place: FloatArray, own: FloatArray, p: FloatArray, other: FloatArray, q: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """The points of both faces at an end: a vertex there, or the foot of the other face's vertex."""
        on_i = np.where((own == place)[:, None], p, edges.foot(i, q))
        return on_i, np.where((other == place)[:, None], q, edges.foot(j, p))

    ends = [
        across(low, first_i, edges.first[i], last_j, edges.last[j]),
        across(high, last_i, edges.last[i], first_j, edges.first[j]),
    ]
    gaps = np.stack([(q - p)[:, 0] * axis[:, 1] - (q - p)[:, 1] * axis[:, 0] for p, q in ends])
    start, end = (0.5 * (p + q) for p, q in ends)
    widest, deepest = gaps.max(axis=0), -gaps.min(axis=0)
    beside, off = np.einsum("kd,kd->k", end - start, axis) > limits.length, np.maximum(widest, deepest)
    near = beside & (widest <= limits.gap) & (deepest <= limits.overlap)
    seen = beside & ~near & (off <= limits.sight)

    a, b = edges.owner[i], edges.owner[j]
    kept = np.flatnonzero(near)
    kept = kept[np.lexsort((end[kept, 1], end[kept, 0], start[kept, 1], start[kept, 0], b[kept], a[kept]))]
    joined = _merge_collinear(a[kept], b[kept], start[kept], end[kept], max(limits.gap, limits.overlap))
    corners = _corner_pairs(edges, fixed, joined[0], joined[1], max(limits.gap, limits.overlap))
    code, middle = a * len(polygons) + b, 0.5 * (start + end)
    seen = np.flatnonzero(seen & ~np.isin(code, joined[0] * len(polygons) + joined[1]))
    seen = seen[np.lexsort((middle[seen, 1], middle[seen, 0], off[seen], code[seen]))]
    seen = seen[np.unique(code[seen], return_index=True)[1]]  # of every pair the least
    return Contacts(*joined, corners, np.stack([a[seen], b[seen]], axis=1), off[seen], middle[seen])


def _merge_collinear(
    a: IntArray, b: IntArray, start: FloatArray, end: FloatArray, tolerance: float
) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
    """Join segments of the same pair that continue each other in a straight line (a vertex inside a flat face)."""
    keep: list[int] = []
    ends = end.copy()
    starts = start.copy()
    of_pair: list[int] = []
    for k in range(len(a)):
        joined = False
        if of_pair and (a[of_pair[0]] != a[k] or b[of_pair[0]] != b[k]):
            of_pair = []
        for kept in _meeting(of_pair, starts, ends, k, tolerance):
            one = (ends[kept] - starts[kept]) / np.linalg.norm(ends[kept] - starts[kept])
            two = ends[k] - starts[k]
            straight = abs(one[0] * two[1] - one[1] * two[0]) <= tolerance and np.dot(one, two) > 0.0
            meeting = (np.linalg.norm(ends[kept] - starts[k]), np.linalg.norm(starts[kept] - ends[k]))
            if straight and min(meeting) <= tolerance:
                # The whole of both: where the tolerance is as long as they are, one may lie beside the other.
                points = np.stack([starts[kept], starts[k], ends[kept], ends[k]])
                places = points @ one
                starts[kept], ends[kept] = points[int(np.argmin(places))], points[int(np.argmax(places))]
                joined = True
                break
        if not joined:
            keep.append(k)
            of_pair.append(k)
    return a[keep], b[keep], starts[keep], ends[keep]


def _meeting(kept: list[int], starts: FloatArray, ends: FloatArray, k: int, tolerance: float) -> list[int]:
    """Those of the segments kept that may meet segment k within a tolerance, the last first.

    Faces of thousands of vertices have as many segments in one pair of blocks.
    """
    if not kept:
        return []
    index = np.array(kept)
    apart = np.minimum(np.hypot(*(ends[index] - starts[k]).T), np.hypot(*(starts[index] - ends[k]).T))
    return [int(kept) for kept in index[apart <= tolerance * (1.0 + 1e-9)][::-1]]


def _corner_pairs(edges: _Edges, fixed: BoolArray, a: IntArray, b: IntArray, tolerance: float) -> IntArray:
    """Pairs (k, 2) of blocks without a contact of which one has a vertex within the tolerance of the other."""
    vertex, edge = edges.near(tolerance)
    i, j = np.sort([edges.owner[vertex], edges.owner[edge]], axis=0)
    wanted = ~(fixed[i] & fixed[j])
    count = len(fixed)
    alone = np.setdiff1d(i[wanted] * count + j[wanted], a * count + b)
    return np.stack([alone // count, alone % count], axis=1)


def check_gap(shapes: np.ndarray, names: Sequence[str], gap: float) -> None:
    """Refuse a greatest gap as wide as a block: the faces of its two neighbours would meet across it.

    Raises:
        InputError: naming the thinnest block.
    """
    width = 2.0 * shapely.area(shapes) / shapely.length(shapes)
    thin = np.flatnonzero(width <= gap)
    if len(thin):
        least = thin[int(np.argmin(width[thin]))]
        raise InputError(
            f"a greatest gap of {gap:.3g} swallows {len(thin)} block(s), "
            f"{first_few([names[k] for k in thin.tolist()], 5)}: the thinnest is about {width[least]:.3g} thick",
            f"Allow less than {width.min():.3g}",
            "interfaces",
            spot=Spot((names[least],), size=float(width[least])),
        )
