"""Where a travelling load acts: the faces of a wall that look up, and places on them from left to right."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
import shapely

from harness.model.assembly import FloatArray, IntArray
from harness.model.errors import InputError
from harness.model.fields import Point
from harness.model.geometry import CHUNK, following
from harness.model.load_fields import Load, Loads, PointForce, Travelling
from harness.model.wall import Block

SHARE = 1e-3
"""Of the size of a block: faces as near as this touch, as in `harness.model.pressure`, and shorter ones are none."""
LEVEL = 1e-6
"""Sine of the angle from upright within which a face is upright, as coordinates are rounded, and does not look up."""

MOST_READ = 2_000_000
"""Vertices of blocks above faces that are compared with them, a few seconds of work."""

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
        polygons: (n,) counter-clockwise outlines (k, 2) [length].
        chosen: indices of blocks.
        from_above: whether parts with a block anywhere above them are left out.

    Raises:
        InputError: so many blocks lie above so many faces that they take minutes to compare.
    """
    which = list(chosen)
    owner = np.repeat(np.array(which, dtype=np.int64), [len(polygons[k]) for k in which])
    if not len(owner):
        return []
    # What looks up runs from right to left on a counter-clockwise outline.
    right = np.concatenate([polygons[k] for k in which])
    left = np.concatenate([following(polygons[k]) for k in which])
    looks_up = right[:, 0] - left[:, 0] > LEVEL * np.hypot(*(right - left).T)
    owner, left, right = owner[looks_up], left[looks_up], right[looks_up]
    shapes = np.array([shapely.Polygon(polygon) for polygon in polygons])
    touch = SHARE * np.sqrt(shapely.area(shapes))[owner]
    length, along = np.hypot(*(right - left).T), right - left
    off = (touch / length)[:, None] * np.stack([-along[:, 1], along[:, 0]], axis=1)
    ends = np.stack([left + off, right + off], axis=1)
    tree = shapely.STRtree(shapes)
    seen = _seen(tree, shapely.linestrings(ends), owner, ends[:, 0, 0], along[:, 0])
    if from_above:
        # Most faces are covered by the blocks that lie on them: only what is left is compared with all blocks above.
        top = max(float(polygon[:, 1].max()) for polygon in polygons)
        bare = np.array([k for k, gaps in enumerate(seen) if _long(gaps, length[k], touch[k])], dtype=np.int64)
        sky = ends[bare][:, ::-1].copy()
        sky[:, :, 1] = top + touch[bare][:, None]
        columns = shapely.polygons(np.concatenate([ends[bare], sky], axis=1))
        above = _seen(tree, columns, owner[bare], ends[bare, 0, 0], along[bare, 0])
        seen = [[] for _ in seen]
        for k, gaps in zip(bare.tolist(), above, strict=True):
            seen[k] = gaps
    return [
        (int(owner[k]), left[k] + a * along[k], left[k] + b * along[k])
        for k, gaps in enumerate(seen)
        for a, b in _long(gaps, length[k], touch[k])
    ]


def _long(gaps: list[tuple[float, float]], length: float, touch: float) -> list[tuple[float, float]]:
    """The parts of a face that are longer than what is none."""
    return [(a, b) for a, b in gaps if (b - a) * length > touch]


def _seen(
    tree: shapely.STRtree, areas: np.ndarray, owner: IntArray, begin: FloatArray, width: FloatArray
) -> list[list[tuple[float, float]]]:
    """Of every face the parts, in shares of its width, where no other block lies in the area above it.

    Args:
        tree: of the outlines of all blocks.
        areas: (k,) that are looked through; owner: (k,) blocks of the faces; begin, width: (k,) along x [length].

    Raises:
        InputError: as of `upward_faces`.
    """
    shapes, hidden = tree.geometries, [list[tuple[float, float]]() for _ in areas]
    vertices, read = shapely.get_num_coordinates(tree.geometries), 0
    for first in range(0, len(areas), CHUNK):
        face, other = tree.query(areas[first : first + CHUNK])
        face += first
        others = owner[face] != other
        face, other = face[others], other[others]
        read += int(vertices[other].sum())
        if read > MOST_READ:
            raise InputError(
                f"above the {len(areas):,} faces that look up lie so many blocks that more than {MOST_READ:,} "
                "vertices would be compared with them",
                'Say "along": "extrados", simplify the outlines, or write the load cases out as point forces',
                "travelling",
            )
        low, _, high, _ = shapely.bounds(shapely.intersection(areas[face], shapes[other])).T
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
