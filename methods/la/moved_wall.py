"""A wall whose blocks have moved far, with the joints that are left of it: pins where a joint has opened at one end.

Every end of a joint is a point of both its blocks. Where they still meet it bears; where they have parted it does not.
The normal of a joint turns by the mean of the rotations of its two blocks. Nothing slides.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from harness.model.assembly import Assembly, BoolArray, FloatArray, IntArray
from harness.model.displaced import carried
from methods.la.settings import ClosureTolerances

_ROUNDING = 8.0 * float(np.finfo(float).eps)
"""Rounding of the distance of two points, in their coordinates, which sum a centroid, its displacement and an arm."""


@dataclass(frozen=True, eq=False)
class MovedWall:
    """A wall with its blocks at other places.

    Attributes:
        drawn: the wall before it moved.
        displacement: of its supports in the direction of their motion.
        places: (n, 3) displacements of the centroids [length] and rotations [rad].
        closed: (m, 2) ends of joints that still meet.
    """

    drawn: Assembly
    displacement: float
    places: FloatArray
    closed: BoolArray

    @classmethod
    def at_rest(cls, drawn: Assembly) -> MovedWall:
        """The wall as drawn, about its middle: far from it coordinates have no digits left for pins that meet."""
        middle = drawn.middle
        ends = {name: getattr(drawn, name) - middle for name in ("centroid", "end1", "end2", "face1", "face2")}
        drawn = replace(drawn, polygons=tuple(polygon - middle for polygon in drawn.polygons), **ends)
        return cls(drawn, 0.0, np.zeros((drawn.n_blocks, 3)), np.ones((drawn.n_interfaces, 2), dtype=bool))

    @cached_property
    def _points(self) -> tuple[FloatArray, FloatArray]:
        """(m, 2, 2) the two ends of every joint, as points of block a and of block b [length]."""
        drawn = self.drawn
        ends = np.stack([drawn.end1, drawn.end2], axis=1)

        def of(block: IntArray) -> FloatArray:
            arm = ends - drawn.centroid[block][:, None]
            turned = _turned(arm.reshape(-1, 2), np.repeat(self.places[block, 2], 2)).reshape(-1, 2, 2)
            return np.asarray(drawn.centroid[block][:, None] + self.places[block, None, :2] + turned)

        return of(drawn.block_a), of(drawn.block_b)

    @cached_property
    def _axes(self) -> tuple[FloatArray, FloatArray]:
        """(m, 2) unit normals and tangents of the joints."""
        drawn = self.drawn
        angle = 0.5 * (self.places[drawn.block_a, 2] + self.places[drawn.block_b, 2])
        return _turned(drawn.normal, angle), _turned(drawn.tangent, angle)

    @property
    def gaps(self) -> FloatArray:
        """(m, 2) distances along the normal at the ends of the joints [length], negative where blocks overlap."""
        of_a, of_b = self._points
        return np.asarray(((of_b - of_a) * self._axes[0][:, None]).sum(axis=2))

    @property
    def shifts(self) -> FloatArray:
        """(m, 2) distances along the tangent [length]."""
        of_a, of_b = self._points
        return np.asarray(((of_b - of_a) * self._axes[1][:, None]).sum(axis=2))

    @cached_property
    def assembly(self) -> Assembly:
        """The wall as it stands: an end that has parted lies on the line of its joint, and is to bear nothing."""
        drawn = self.drawn
        normal, tangent = self._axes
        ends = 0.5 * (self._points[0] + self._points[1])
        along = drawn.length[:, None] * tangent
        first, second = self.closed.T
        end1 = np.where((~first & second)[:, None], ends[:, 1] - along, ends[:, 0])
        end2 = np.where((first | ~second)[:, None], end1 + along, ends[:, 1])
        return replace(
            drawn,
            polygons=tuple(carried(drawn, self.places)),
            centroid=drawn.centroid + self.places[:, :2],
            end1=end1,
            end2=end2,
            face1=end1,
            face2=end2,
            normal=normal,
            support_motion=self._support_velocity(),
        )

    def _support_velocity(self) -> FloatArray:
        """(n, 3) motion of the supports by the displacement, about the poles of their rotations."""
        motion = self.drawn.support_motion
        return np.column_stack([_turned(motion[:, :2], self.displacement * motion[:, 2]), motion[:, 2]])

    def moved(self, mechanism: FloatArray, step: float, held: BoolArray, by: ClosureTolerances) -> MovedWall | None:
        """The wall a step of the supports further, None where what is held cannot meet any more.

        Args:
            mechanism: (n, 3) motion of all blocks by which the step begins.
            step: of the displacement.
            held: (m, 2) ends of joints that go on to meet.
            by: how exactly.
        """
        further = self.displacement + step
        places = self.places + step * mechanism
        fixed = self.drawn.fixed
        places[fixed] = support_places(self.drawn.support_motion, further)[fixed]
        wall = MovedWall(self.drawn, further, places, held)
        meets = held.any(axis=1)
        wanted = np.column_stack([held, meets]).ravel()
        share = held / np.maximum(held.sum(axis=1), 1)[:, None]
        apart = max(by.distance * self.drawn.length_scale, _ROUNDING * float(abs(np.stack(wall._points)).max()))
        for _ in range(by.steps):
            misses = np.column_stack([wall.gaps, (share * wall.shifts).sum(axis=1)])
            miss = misses.ravel()[wanted]
            if not float(abs(miss).max(initial=0.0)) > apart:
                return wall
            wall = replace(wall, places=wall._corrected(wanted, miss, by.damping))
        return None

    def _corrected(self, wanted: BoolArray, miss: FloatArray, damping: float) -> FloatArray:
        """The places (n, 3) after a damped Gauss-Newton step on what points that are to meet miss."""
        drawn = self.drawn
        unit = np.tile([1.0, 1.0, 1.0 / drawn.length_scale], drawn.n_free)
        matrix = self.assembly.kinematic_matrix[wanted] @ sp.diags(unit)
        normal = (matrix.T @ matrix).tocsc()
        shift = damping * float(normal.diagonal().mean())
        step = spsolve(normal + shift * sp.identity(normal.shape[0], format="csc"), -(matrix.T @ miss))
        places = self.places.copy()
        places[drawn.free] += (unit * step).reshape(-1, 3)
        return places


def support_places(motion: FloatArray, displacement: float) -> FloatArray:
    """(n, 3) places of supports after a multiple of their motion (n, 3); rotations about their poles are finite."""
    angle = displacement * motion[:, 2]
    chord = np.sinc(0.5 * angle / np.pi)  # the chord of the arc of the centroid, over the arc
    return np.column_stack([displacement * chord[:, None] * _turned(motion[:, :2], 0.5 * angle), angle])


def _turned(vectors: FloatArray, angle: FloatArray) -> FloatArray:
    """Vectors (k, 2) turned by angles (k,) counter-clockwise."""
    cosine, sine = np.cos(angle), np.sin(angle)
    x, y = vectors.T
    return np.column_stack([cosine * x - sine * y, sine * x + cosine * y])
