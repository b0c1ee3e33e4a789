"""Fill above a wall becomes a dead load: the weight of the column above each place of the faces that the sky sees.

Seen from above a wall has at each x one highest face. Where that lies below the level of the fill it bears the vertical
stress gamma (level - y) on its horizontal projection. Faces are cut at every vertex, and at the level, so that the
stress is linear on each part; its force and moment are exact. The fill does not spread its weight;
`harness.model.passive` has what resists.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from harness.model.assembly import BoolArray, FloatArray, IntArray
from harness.model.errors import InputError
from harness.model.pressure import Outlines
from harness.model.pressure_fields import Fill

NO_FACE = -1
_MOST_COMPARED = 1_000_000_000
"""Places whose heights are compared on all faces that look up, some seconds of work."""


def fill_forces(
    fill: Fill,
    chosen: BoolArray,
    outlines: Outlines,
    centroids: FloatArray,
    thickness: Sequence[float],
    unit_weight_factor: float,
    place: str,
) -> FloatArray:
    """Generalised forces (n, 3) of a fill about the centroids of the blocks [force, force, force length].

    Args:
        fill: above the wall.
        chosen: (n,) whether it may load a block; others bear what is above them apart from the wall.
        outlines: of all blocks, counter-clockwise.
        centroids: (n, 2) of the blocks [length].
        thickness: (n,) out of plane [length].
        unit_weight_factor: what a unit weight of the file is multiplied with to be in force/length^3.
        place: of the fill in the file, for errors.

    Raises:
        InputError: no face that it may load lies below its level, and it does not resist either.
    """
    x, face = highest_faces(outlines, fill.between)
    forces = np.zeros((len(centroids), 3))
    gamma = unit_weight_factor * fill.unit_weight * fill.factor
    loaded = False
    for left, right, edge in zip(x[:-1], x[1:], face, strict=True):
        block = int(outlines.block[edge])
        if edge == NO_FACE or not chosen[block]:
            continue
        ends = np.array([left, right])
        depth = fill.level - heights(outlines, int(edge), ends)
        if depth.max() <= 0.0:
            continue
        loaded = True
        if depth.min() < 0.0:
            cut = left + (right - left) * depth[0] / (depth[0] - depth[1])
            ends = np.where(depth < 0.0, cut, ends)
        stress, arm = gamma * np.maximum(depth, 0.0), ends - centroids[block, 0]
        extent = thickness[block] * (ends[1] - ends[0])
        weighted = np.array([2.0 * stress[0] + stress[1], stress[0] + 2.0 * stress[1]])
        forces[block] -= extent * np.array([0.0, 0.5 * stress.sum(), float(arm @ weighted) / 6.0])
    if not loaded and fill.passive is None:
        raise InputError(
            f"no face of a free block that it may load looks up below its level {fill.level:.6g}",
            'Give a "level" above the extrados, and "between" that meets it',
            place,
        )
    return forces


def highest_faces(outlines: Outlines, between: tuple[float, float] | None = None) -> tuple[FloatArray, IntArray]:
    """(k + 1,) places x from left to right, and (k,) the edge that is highest between each two; `NO_FACE` if none.

    Args:
        outlines: of all blocks, counter-clockwise: edges that look up go to the left.
        between: range of x; the whole wall if None.

    Raises:
        InputError: so many faces lie above each other that they take minutes to compare.
    """
    first, last = outlines.first[:, 0], outlines.last[:, 0]
    up = np.flatnonzero(last < first)
    low, high = (float(last[up].min()), float(first[up].max())) if between is None else between
    x = np.unique(np.clip(np.concatenate([first[up], last[up], [low, high]]), low, high))
    middle = 0.5 * (x[:-1] + x[1:])
    face, height = np.full(len(middle), NO_FACE), np.full(len(middle), -np.inf)
    starts, stops = np.searchsorted(middle, last[up]), np.searchsorted(middle, first[up])
    compared = int((stops - starts).sum())
    if compared > _MOST_COMPARED:
        raise InputError(
            f"{len(up):,} faces that look up lie above each other at {compared:,} places, and the heights of at most "
            f"{_MOST_COMPARED:,} are compared",
            "Analyse a part of the wall, or simplify the outlines",
            "blocks",
        )
    for edge, start, stop in zip(up.tolist(), starts.tolist(), stops.tolist(), strict=True):
        own = heights(outlines, edge, middle[start:stop])
        above = np.flatnonzero(own > height[start:stop]) + start
        face[above], height[above] = edge, own[above - start]
    return x, face


def heights(outlines: Outlines, edge: int, x: FloatArray) -> FloatArray:
    """(k,) heights of an edge, which is not vertical, at places x (k,)."""
    (x1, y1), (x2, y2) = outlines.first[edge], outlines.last[edge]
    return np.asarray(y1 + (y2 - y1) * ((x - x1) / (x2 - x1)))
