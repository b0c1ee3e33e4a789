"""Where a travelling load acts: the faces of a wall that look up, and places on them from left to right."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np
import shapely

from harness.model.assembly import FloatArray, IntArray
from harness.model.errors import InputError
from harness.model.fields import Point
from harness.model.fill import highest_faces
from harness.model.geometry import CHUNK, shapes_of
from harness.model.load_fields import Load, Loads, PointForce, Travelling
from harness.model.pressure import Outlines, outlines_of
from harness.model.rings import rings_of
from harness.model.wall import Block

_SHARE = 1e-3
"""Of the size of a block: faces as near as this touch, as in `harness.model.pressure`, and shorter ones are none."""
_LEVEL = 1e-6
"""Sine of the angle from upright within which a face is upright, as coordinates are rounded, and does not look up."""

_MOST_READ = 2_000_000
"""Vertices of blocks that touch faces and are compared with them, a few seconds of work."""

Face = tuple[int, FloatArray, FloatArray]
"""A block and the two ends (2,) of a face of it, from left to right."""


class Upward:
    """The faces of a wall on which loads travel, found once for all loads that go along the same.

    Args:
        blocks: all n of the wall; polygons: their counter-clockwise outlines (k, 2) [length].
        gravity: its direction (x, y); none where it is zero: down is -y then.
    """

    def __init__(self, blocks: Sequence[Block], polygons: Sequence[FloatArray], gravity: Point) -> None:
        self._blocks, self._to_up = blocks, _to_up(gravity)
        self._polygons = [polygon @ self._to_up.T for polygon in polygons]
        self._found: dict[str, list[Face]] = {}

    def loads(self, given: Travelling, place: str, most: int) -> list[Loads]:
        """A live load for each place of a travelling load, from left to right as gravity has it.

        Args:
            given: the travelling load; place: of it in the file, for errors.
            most: load cases that a wall may still have.

        Raises:
            InputError: it acts on no face, or at more places than that.
        """
        faces = self._faces(given)
        if not faces:
            remedy = 'Name free blocks with a face that looks up and has no joint, or leave "blocks" and "group" out'
            raise InputError("it acts on no face", remedy, place)
        if given.per_face * len(faces) > most:
            raise InputError(
                f"it acts at {given.per_face * len(faces):,} places, each a load case, and the wall may have "
                f"{most:,} more at most",
                'Name fewer blocks, or give a smaller "per_face"',
                place,
            )
        shares = (np.arange(given.per_face) + 0.5) / given.per_face
        found = []
        for block, left, right in faces:
            for share in shares.tolist():
                x, y = ((left + share * (right - left)) @ self._to_up).tolist()
                force = PointForce(block=self._blocks[block].id, at=(x, y), force=given.force)
                found.append(Loads(live=Load(points=[force])))
        return found

    def _faces(self, given: Travelling) -> list[Face]:
        """The faces that a travelling load acts on, from left to right."""
        if given.along not in self._found:
            free = [k for k, block in enumerate(self._blocks) if not block.fixed]
            faces = upward_faces(self._polygons, free, from_above=given.along == "top")
            self._found[given.along] = sorted(faces, key=lambda face: tuple(face[1] + face[2]))
        named = None if given.blocks is None else set(given.blocks)
        return [
            face
            for face in self._found[given.along]
            if (named is None or self._blocks[face[0]].id in named)
            and (given.group is None or given.group in self._blocks[face[0]].groups)
        ]


def _to_up(gravity: Point) -> FloatArray:
    """The rotation (2, 2) after which gravity points to -y."""
    size = math.hypot(*gravity)
    x, y = (gravity[0] / size, gravity[1] / size) if size > 0.0 else (0.0, -1.0)
    return np.array([[-y, x], [-x, -y]])


def upward_faces(polygons: Sequence[FloatArray], chosen: Iterable[int], *, from_above: bool) -> list[Face]:
    """The parts of edges of the chosen blocks that look towards +y and touch no other block.

    Args:
        polygons: (n,) counter-clockwise outlines (k, 2), those with holes too [length].
        chosen: indices of blocks.
        from_above: whether parts with stone anywhere above them are left out, that of their own block too.

    Raises:
        InputError: so many blocks touch so many faces, or lie above them, that they take minutes to compare.
    """
    outlines = _outlines_and_holes(polygons)
    # What looks up runs from right to left on a counter-clockwise outline.
    along = outlines.first - outlines.last
    looks_up = (along[:, 0] > _LEVEL * np.hypot(*along.T)) & np.isin(outlines.block, list(chosen))
    edges = np.flatnonzero(looks_up)
    shapes = shapes_of(polygons)
    touch = _SHARE * np.sqrt(shapely.area(shapes))[outlines.block[edges]]
    seen = _highest(outlines, edges) if from_above else _bare(outlines, edges, shapes, touch)
    left, along = outlines.last[edges], along[edges]
    length = np.hypot(*along.T)
    return [
        (int(outlines.block[edge]), left[k] + a * along[k], left[k] + b * along[k])
        for k, (edge, gaps) in enumerate(zip(edges.tolist(), seen, strict=True))
        for a, b in gaps
        if (b - a) * length[k] > touch[k]
    ]


def _outlines_and_holes(polygons: Sequence[FloatArray]) -> Outlines:
    """The edges of all blocks and of their holes, without the cuts between these."""
    rings = [(k, ring) for k, polygon in enumerate(polygons) for ring in rings_of(polygon)]
    edges = outlines_of([ring for _, ring in rings])
    return Outlines(edges.first, edges.last, np.array([k for k, _ in rings], dtype=np.int64)[edges.block])


def _highest(outlines: Outlines, edges: IntArray) -> list[list[tuple[float, float]]]:
    """Of each edge the parts, in shares of its width, that are seen from above."""
    x, face = highest_faces(outlines)
    change = np.flatnonzero(np.diff(face)) + 1
    parts: dict[int, list[tuple[float, float]]] = defaultdict(list)
    for start, stop in pairwise([0, *change.tolist(), len(face)]):
        parts[int(face[start])].append((float(x[start]), float(x[stop])))
    found = []
    for edge in edges.tolist():
        left, right = outlines.last[edge, 0], outlines.first[edge, 0]
        found.append([((low - left) / (right - left), (high - left) / (right - left)) for low, high in parts[edge]])
    return found


def _bare(
    outlines: Outlines, edges: IntArray, shapes: np.ndarray, touch: FloatArray
) -> list[list[tuple[float, float]]]:
    """Of each edge the parts, in shares of its width, that no other block touches.

    Args:
        outlines: of all blocks; edges: (k,) of them; shapes: (n,) of the blocks.
        touch: (k,) distance within which a block touches an edge [length].

    Raises:
        InputError: as of `upward_faces`.
    """
    left, right, owner = outlines.last[edges], outlines.first[edges], outlines.block[edges]
    along = right - left
    off = (touch / np.hypot(*along.T))[:, None] * np.stack([-along[:, 1], along[:, 0]], axis=1)
    lines = shapely.linestrings(np.stack([left + off, right + off], axis=1))
    begin, width = (left + off)[:, 0], along[:, 0]
    tree, hidden = shapely.STRtree(shapes), [list[tuple[float, float]]() for _ in edges]
    vertices, read = shapely.get_num_coordinates(shapes), 0
    for first in range(0, len(lines), CHUNK):
        face, other = tree.query(lines[first : first + CHUNK])
        face += first
        others = owner[face] != other
        face, other = face[others], other[others]
        read += int(vertices[other].sum())
        if read > _MOST_READ:
            raise InputError(
                f"so many blocks touch the {len(lines):,} faces that look up that more than {_MOST_READ:,} "
                "vertices would be compared with them",
                'Say "along": "top", simplify the outlines, or write the load cases out as point forces',
                "travelling",
            )
        # A block that touches a face in several places leaves what is between them bare.
        pieces, pair = shapely.get_parts(shapely.intersection(lines[face], shapes[other]), return_index=True)
        face = face[pair]
        low, _, high, _ = shapely.bounds(pieces).T
        low, high = ((end - begin[face]) / width[face] for end in (low, high))
        cut = np.isfinite(low)
        for k, a, b in zip(face[cut].tolist(), low[cut].tolist(), high[cut].tolist(), strict=True):
            hidden[k].append((a, b))
    return [_gaps(intervals) for intervals in hidden]


def _gaps(hidden: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """What intervals leave of [0, 1]."""
    found, reached = [], 0.0
    for low, high in sorted(hidden):
        if low > reached:
            found.append((reached, min(low, 1.0)))
        reached = max(reached, high)
    return [*found, (reached, 1.0)] if reached < 1.0 else found
