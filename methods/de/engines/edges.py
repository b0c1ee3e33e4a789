"""Which edges of two blocks meet in an interface, and how far apart they are once the blocks have moved."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray

SAME = 1e-6
"""Distance, in length scales, at which points count as the same."""

_SHORTEST = 1e-3
"""Length, in length scales, that two edges must share to touch at all."""


def edge_of(assembly: Assembly, block: int, p: int) -> tuple[int, int] | None:
    """The two vertices of a block's edge on which interface p lies, along its tangent; None where it lies on none."""
    polygon, small = assembly.polygons[block], SAME * assembly.length_scale
    middle, along = 0.5 * (assembly.face1[p] + assembly.face2[p]), assembly.tangent[p]
    across = np.array([-along[1], along[0]])
    for one in range(len(polygon)):
        two = (one + 1) % len(polygon)
        ends = polygon[[one, two]] - middle
        if np.abs(ends @ across).max() > small:
            continue
        first, second = ends @ along
        if min(first, second) <= small and max(first, second) >= -small:
            return (one, two) if first <= second else (two, one)
    return None


@dataclass(frozen=True, eq=False)
class FacingEdges:
    """The edges that meet in the interfaces of a wall, and move with the blocks.

    Attributes:
        assembly: the wall with even blocks where they were drawn.
        first, second: (m, 2, 2) ends of the edges of blocks a and b from their centroids [length].
        side: (m,) 1 where the tangent turned left by a right angle points from a into b, -1 where it points back.
    """

    assembly: Assembly
    first: FloatArray
    second: FloatArray
    side: FloatArray

    @classmethod
    def of(cls, assembly: Assembly, outlines: tuple[FloatArray, ...]) -> FacingEdges:
        """The edges of blocks with other outlines (n,) of as many vertices each as the wall's.

        Raises:
            ValueError: an interface does not lie on edges of both its blocks.
        """
        found: list[FloatArray] = []
        for p in range(assembly.n_interfaces):
            for block in (int(assembly.block_a[p]), int(assembly.block_b[p])):
                edge = edge_of(assembly, block, p)
                if edge is None:
                    raise ValueError(
                        f"the interface of blocks {assembly.block_ids[assembly.block_a[p]]} and "
                        f"{assembly.block_ids[assembly.block_b[p]]} does not lie on edges of both"
                    )
                found.append(outlines[block][list(edge)] - assembly.centroid[block])
        ends = np.array(found).reshape(-1, 2, 2, 2)
        along, normal = assembly.tangent, assembly.normal
        return cls(assembly, ends[:, 0], ends[:, 1], np.sign(along[:, 0] * normal[:, 1] - along[:, 1] * normal[:, 0]))

    def at(self, places: FloatArray) -> tuple[Assembly, FloatArray]:
        """The wall with its blocks at places (n, 3), and the openings (m, 2) at the ends of what the edges share.

        Contact points lie midway between the edges; openings are negative where the blocks overlap [length]. Edges that
        share nothing are a length scale apart.
        """
        wall = self.assembly
        a, b = _moved(wall, wall.block_a, self.first, places), _moved(wall, wall.block_b, self.second, places)
        along = _unit(_unit(a[:, 1] - a[:, 0]) + _unit(b[:, 1] - b[:, 0]))
        normal = self.side[:, None] * np.stack([-along[:, 1], along[:, 0]], axis=1)
        starts = np.stack([np.zeros(len(a)), _dot(b[:, 0] - a[:, 0], along)])
        ends = np.stack([_dot(a[:, 1] - a[:, 0], along), _dot(b[:, 1] - a[:, 0], along)])
        low, high = starts.max(axis=0), ends.min(axis=0)
        apart = high - low < _SHORTEST * wall.length_scale
        high = np.where(apart, low + _SHORTEST * wall.length_scale, high)
        points, openings = [], []
        for s in (low, high):
            on_a, on_b = (
                edge[:, 0] + ((s - start) / (end - start))[:, None] * (edge[:, 1] - edge[:, 0])
                for edge, start, end in zip((a, b), starts, ends, strict=True)
            )
            points.append(0.5 * (on_a + on_b))
            openings.append(np.where(apart, wall.length_scale, _dot(on_b - on_a, normal)))
        moved = replace(
            wall,
            centroid=wall.centroid + places[:, :2],
            end1=points[0],
            end2=points[1],
            face1=points[0],
            face2=points[1],
            normal=normal,
        )
        return moved, np.stack(openings, axis=1)


def _moved(assembly: Assembly, block: IntArray, points: FloatArray, places: FloatArray) -> FloatArray:
    """(m, 2, 2) points from the centroids of blocks (m,), where they are at places (n, 3)."""
    cosine, sine = np.cos(places[block, 2])[:, None], np.sin(places[block, 2])[:, None]
    x, y = points[..., 0], points[..., 1]
    turned = np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=2)
    out: FloatArray = turned + (assembly.centroid[block] + places[block, :2])[:, None, :]
    return out


def _dot(one: FloatArray, two: FloatArray) -> FloatArray:
    out: FloatArray = (one * two).sum(axis=1)
    return out


def _unit(vectors: FloatArray) -> FloatArray:
    out: FloatArray = vectors / np.linalg.norm(vectors, axis=1)[:, None]
    return out
