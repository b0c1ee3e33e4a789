"""A drawing mended: gaps and overlaps closed by moving vertices a little, outlines drawn twice taken once.

Vertices within the snapping distance of each other become one; a vertex that near to the face of another block comes to
lie on it, and the face gets a vertex there. What moved, and how far, is kept to be shown.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

from harness.model import geometry
from harness.model.assembly import FloatArray, IntArray
from harness.model.blocks import blocks_of_wall, polygons_of
from harness.model.errors import InputError
from harness.model.groups import groups_of
from harness.model.rings import rings_of
from harness.model.wall import Block, Wall

_ROUNDING = 1e-9
"""Share of the snapping distance below which a vertex has not moved: means of equal numbers differ in last digits."""


@dataclass(frozen=True)
class _Move:
    """A vertex that moved.

    Attributes:
        block: its block; vertex: its number in the outline, counter-clockwise; start, end: where from and to [length].
    """

    block: str
    vertex: int
    start: tuple[float, float]
    end: tuple[float, float]

    @property
    def distance(self) -> float:
        """How far it moved [length]."""
        return float(np.hypot(self.end[0] - self.start[0], self.end[1] - self.start[1]))


@dataclass(frozen=True)
class _Repaired:
    """A mended wall.

    Attributes:
        wall: with every block written out; moves: vertices that moved; doubles: (left out, kept) outlines drawn twice;
        splits: (block, vertices) put into the faces of a block where others end.
    """

    wall: Wall
    moves: tuple[_Move, ...]
    doubles: tuple[tuple[str, str], ...]
    splits: tuple[tuple[str, int], ...]


def repair(wall: Wall, snap: float) -> _Repaired:
    """The wall with gaps and overlaps closed; no vertex moves further than `snap` [length].

    Raises:
        InputError: a block would vanish, because one of its edges is no longer than `snap`.
    """
    blocks, doubles = without_doubles(blocks_of_wall(wall), snap)
    drawn = polygons_of(blocks)
    for block, polygon in zip(blocks, drawn, strict=True):
        shortest = float(np.linalg.norm(geometry.following(polygon) - polygon, axis=1).min())
        if shortest <= snap:
            raise InputError(
                f"its shortest edge is {shortest:.3g} long and would vanish",
                f"Snap over less than {shortest:.3g}",
                f'block "{block.id}"',
            )
    owner = np.repeat(np.arange(len(drawn)), [len(polygon) for polygon in drawn])
    before = np.concatenate(drawn)
    after = met_points(before, snap)
    onto = _faces_met(before, after, owner, snap)
    moves = tuple(
        _Move(blocks[owner[k]].id, int(k - np.searchsorted(owner, owner[k])), _pair(before[k]), _pair(after[k]))
        for k in np.flatnonzero(np.linalg.norm(after - before, axis=1) > _ROUNDING * snap).tolist()
    )
    outlines, splits = [], []
    for number, block in enumerate(blocks):
        outline = _split(np.flatnonzero(owner == number), after, onto)
        outer, *holes = [[(x, y) for x, y in ring.tolist()] for ring in rings_of(np.array(outline))]
        outlines.append(block.model_copy(update={"polygon": outer, "holes": holes}))
        added = len(outline) - int((owner == number).sum())
        if added:
            splits.append((block.id, added))
    mended = wall.model_copy(update={"pattern": None, "blocks": outlines})
    return _Repaired(mended, moves, tuple(doubles), tuple(splits))


def _pair(point: FloatArray) -> tuple[float, float]:
    return float(point[0]), float(point[1])


def without_doubles(blocks: list[Block], snap: float) -> tuple[list[Block], list[tuple[str, str]]]:
    """The blocks without those that repeat the outline of an earlier one, and the pairs of names."""
    shapes = geometry.shapes_of(polygons_of(blocks))
    i, j = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    i, j = i[i < j], j[i < j]
    apart = shapely.area(shapely.symmetric_difference(shapes[i], shapes[j]))
    same = apart <= snap * np.minimum(shapely.length(shapes[i]), shapely.length(shapes[j]))
    kept_of = dict(zip(j[same].tolist(), i[same].tolist(), strict=True))
    doubles = [(blocks[k].id, blocks[kept].id) for k, kept in sorted(kept_of.items())]
    return [block for k, block in enumerate(blocks) if k not in kept_of], doubles


def met_points(points: FloatArray, snap: float) -> FloatArray:
    """The points (k, 2), those near to each other at their mean unless one of them would move too far."""
    from scipy.spatial import cKDTree

    pairs = cKDTree(points).query_pairs(snap, output_type="ndarray")
    label = groups_of(len(points), pairs[:, 0], pairs[:, 1])
    size = np.bincount(label)
    mean = np.stack([np.bincount(label, points[:, axis]) / size for axis in (0, 1)], axis=1)
    furthest = np.zeros(len(size))
    np.maximum.at(furthest, label, np.linalg.norm(mean[label] - points, axis=1))
    return np.where(((size > 1) & (furthest <= snap))[label][:, None], mean[label], points)


def _faces_met(before: FloatArray, after: FloatArray, owner: IntArray, snap: float) -> dict[int, list[int]]:
    """Vertices that end in the face of another block, by the vertex at which that face begins; `after` is moved there.

    A vertex goes to the face it is nearest to, and no further than `snap` from where it was drawn.
    """
    last = np.arange(len(owner)) + 1
    starts = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
    last[np.append(starts[1:], len(owner)) - 1] = starts
    edges = shapely.linestrings(np.stack([after, after[last]], axis=1))
    vertex, edge = shapely.STRtree(edges).query(shapely.points(after), predicate="dwithin", distance=snap)
    ends = np.any(np.all(after[vertex][:, None] == np.stack([after[edge], after[last[edge]]], axis=1), axis=2), axis=1)
    wanted = (owner[vertex] != owner[edge]) & ~ends
    vertex, edge = vertex[wanted], edge[wanted]
    order = np.argsort(shapely.distance(shapely.points(after[vertex]), edges[edge]), kind="stable")
    onto: dict[int, list[int]] = {}
    placed: dict[tuple[float, ...], tuple[float, ...]] = {}
    for v, e in zip(vertex[order].tolist(), edge[order].tolist(), strict=True):
        at = tuple(after[v].tolist())
        if at not in placed and at not in placed.values():
            line = after[last[e]] - after[e]
            foot = after[e] + (after[v] - after[e]) @ line / (line @ line) * line
            shared = np.flatnonzero(np.all(after == after[v], axis=1))
            if np.linalg.norm(before[shared] - foot, axis=1).max() > snap:
                continue
            placed[at] = tuple(foot.tolist())
            after[shared] = foot
        onto.setdefault(e, []).append(v)
    return onto


def _split(numbers: IntArray, after: FloatArray, onto: dict[int, list[int]]) -> list[list[float]]:
    """The outline of the block of vertices `numbers`, with those of others that end in its faces."""
    outline: list[list[float]] = []
    for k in numbers.tolist():
        outline.append(after[k].tolist())
        own = {tuple(after[v].tolist()) for v in onto.get(k, [])}
        outline += [list(point) for point in sorted(own, key=lambda p: float(np.hypot(*(np.array(p) - after[k]))))]
    return [point for point, following in zip(outline, outline[1:] + outline[:1], strict=True) if point != following]
