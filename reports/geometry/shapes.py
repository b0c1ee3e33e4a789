"""Geometry that every drawing needs: extent of a wall, centres of pressure, loads as arrows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.case import Case
from harness.model.errors import InputError
from harness.model.result import vertex_velocities


def problem(case: Case) -> str:
    """Why the wall of a case cannot be built, or nothing if it can."""
    try:
        _ = case.built
    except InputError as error:
        return str(error)
    return ""


@dataclass(frozen=True)
class Extent:
    """The rectangle round a wall [length]."""

    left: float
    bottom: float
    right: float
    top: float

    @property
    def width(self) -> float:
        """From left to right."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """From bottom to top."""
        return self.top - self.bottom

    @property
    def longest(self) -> float:
        """The longer side."""
        return max(self.width, self.height)


def extent(assembly: Assembly) -> Extent:
    """The rectangle round all blocks, ties and props."""
    return _round(np.concatenate([assembly.corners[0], assembly.bars.end1, assembly.bars.end2]))


def extent_of(polygons: Sequence[FloatArray]) -> Extent:
    """The rectangle round polygons (k, 2)."""
    return _round(np.concatenate(list(polygons)))


def _round(points: FloatArray) -> Extent:
    low, high = points.min(axis=0), points.max(axis=0)
    return Extent(float(low[0]), float(low[1]), float(high[0]), float(high[1]))


@dataclass(frozen=True)
class Thrusts:
    """Resultant contact forces. p runs over the interfaces that carry force.

    Attributes:
        interface: (p,) their indices.
        point: (p, 2) centres of pressure [length].
        force: (p, 2) force of block a on block b [force].
        size: (p,) magnitude [force].
    """

    interface: IntArray
    point: FloatArray
    force: FloatArray
    size: FloatArray


def thrusts(assembly: Assembly, forces: FloatArray, smallest: float = 1e-9) -> Thrusts:
    """Resultants of contact forces (m, 3) at their centres of pressure, those below `smallest` of the largest left out.

    The centre of pressure lies at (n1 end1 + n2 end2) / (n1 + n2).
    """
    forces = np.asarray(forces, dtype=float).reshape(-1, 3)
    normal = forces[:, 0] + forces[:, 1]
    vector = normal[:, None] * assembly.normal + forces[:, 2:3] * assembly.tangent
    size = np.linalg.norm(vector, axis=1)
    largest = float(size.max(initial=0.0))
    kept = np.flatnonzero((size > smallest * largest) & (normal > 0.0))
    share = (forces[kept, 1] / normal[kept])[:, None]
    point = (1.0 - share) * assembly.end1[kept] + share * assembly.end2[kept]
    return Thrusts(kept, point, vector[kept], size[kept])


def amplitude(assembly: Assembly, mechanism: FloatArray) -> float:
    """Displacement of the fastest vertex that shows a normalised mechanism well [length].

    An eighth of the wall at most, and no block turned by more than a quarter radian.
    """
    longest = extent(assembly).longest
    turning = float(abs(np.asarray(mechanism)[:, 2]).max(initial=0.0))
    return min(0.125 * longest, 0.25 / turning) if turning > 0.0 else 0.125 * longest


def displaced(assembly: Assembly, mechanism: FloatArray, scale: float) -> list[FloatArray]:
    """Polygons moved along a velocity field for a `scale` of time, without large rotations."""
    points, block = assembly.corners
    motion = np.asarray(mechanism, dtype=float)[block]
    moved = points + scale * vertex_velocities(points, assembly.centroid[block], motion)
    return np.split(moved, np.cumsum([len(polygon) for polygon in assembly.polygons])[:-1])


def moving(assembly: Assembly, mechanism: FloatArray, smallest: float = 1e-3) -> np.ndarray:
    """(n,) whether any vertex of a block moves faster than `smallest` of the fastest vertex of the wall."""
    points, block = assembly.corners
    motion = np.asarray(mechanism, dtype=float)[block]
    arm = points - assembly.centroid[block]
    speeds = np.hypot(motion[:, 0] - motion[:, 2] * arm[:, 1], motion[:, 1] + motion[:, 2] * arm[:, 0])
    speed = np.zeros(assembly.n_blocks)
    np.maximum.at(speed, block, speeds)
    return np.asarray(speed > smallest * max(float(speed.max(initial=0.0)), 1e-300))


@dataclass(frozen=True)
class _Arrow:
    """A load on a block, drawn at the point its line of action passes through.

    Attributes:
        block: index.
        point: (2,) [length].
        force: (2,) [force].
    """

    block: int
    point: FloatArray
    force: FloatArray


def load_arrows(assembly: Assembly, load: FloatArray) -> list[_Arrow]:
    """Generalised loads (n, 3) as arrows: at the centroid, or where their moment puts the line of action."""
    arrows = []
    largest = float(np.linalg.norm(load[:, :2], axis=1).max(initial=0.0))
    for block in range(assembly.n_blocks):
        force, moment = load[block, :2], float(load[block, 2])
        square = float(force @ force)
        if largest == 0.0 or square <= (1e-9 * largest) ** 2:
            continue
        arm = moment / square * np.array([force[1], -force[0]])
        arrows.append(_Arrow(block, assembly.centroid[block] + arm, force))
    return arrows


def drawn_every(arrows: int, most: int = 60) -> int:
    """One of how many load arrows is drawn, so that a body force on many blocks stays readable."""
    return max(1, -(-arrows // most))


def extra_dead_load(assembly: Assembly) -> FloatArray:
    """Dead load (n, 3) beyond the weights of the free blocks: what has to be drawn."""
    weights = np.zeros((assembly.n_blocks, 3))
    weights[assembly.free, 1] = -assembly.weight[assembly.free]
    extra = assembly.dead - weights
    extra[abs(extra) < 1e-9 * max(assembly.force_scale, 1e-300)] = 0.0
    return extra
