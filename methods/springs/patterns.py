"""Small regular walls and an arch, for benches, studies and the warm-up, which need no cases."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.wall import Wall


def running_bond(
    courses: int, bricks: int, friction: float, length: float = 0.4, height: float = 0.2, lean: float = 1.0
) -> Assembly:
    """A running bond on a fixed base, pushed sideways by its own weight times the multiplier.

    Args:
        courses: number of courses; odd ones (from the bottom) start and end with half bricks.
        bricks: bricks of an unbroken course; friction: of all joints; length, height: of a brick [length].
        lean: horizontal live load in weights; -1 pushes the other way.

    Returns:
        The wall; weights are areas [force].
    """
    x_of: list[list[tuple[float, float]]] = []
    for k in range(courses):
        cuts = [0.0, *np.arange(0.5, bricks), bricks] if k % 2 == 0 else list(np.arange(bricks + 1.0))
        x_of.append([(float(a), float(b)) for a, b in pairwise(cuts)])
    bodies: list[tuple[float, float, float, float]] = [(0.0, float(bricks), -1.0, 0.0)]
    pairs: list[tuple[int, int, tuple[float, float], tuple[float, float], str]] = []
    below = [(0.0, float(bricks), 0)]
    for k, course in enumerate(x_of):
        row = [(a, b, len(bodies) + j) for j, (a, b) in enumerate(course)]
        bodies += [(a, b, float(k), k + 1.0) for a, b in course]
        for a0, b0, i in below:
            for a1, b1, j in row:
                low, high = max(a0, a1), min(b0, b1)
                if high - low > 1e-9:
                    pairs.append((i, j, (low, float(k)), (high, float(k)), "bed"))
        for (_, b0, i), (_, _, j) in pairwise(row):
            pairs.append((i, j, (b0, float(k)), (b0, k + 1.0), "head"))
        below = row
    size = np.array([length, height])
    box = np.array(bodies)
    polygons = tuple(np.array([[a, y0], [b, y0], [b, y1], [a, y1]]) * size for a, b, y0, y1 in bodies)
    weight = (box[:, 1] - box[:, 0]) * (box[:, 3] - box[:, 2]) * length * height
    weight[0] = 0.0
    fixed = np.zeros(len(bodies), dtype=bool)
    fixed[0] = True
    dead, live = np.zeros((len(bodies), 3)), np.zeros((len(bodies), 3))
    dead[:, 1] = -weight
    live[:, 0] = lean * weight
    end1 = np.array([p[2] for p in pairs]) * size
    end2 = np.array([p[3] for p in pairs]) * size
    bed = np.array([p[4] == "bed" for p in pairs])
    return Assembly(
        name=f"running bond {courses} x {bricks}",
        block_ids=tuple(f"b{i}" for i in range(len(bodies))),
        polygons=polygons,
        centroid=np.array([p.mean(axis=0) for p in polygons]),
        weight=weight,
        fixed=fixed,
        block_a=np.array([p[0] for p in pairs]),
        block_b=np.array([p[1] for p in pairs]),
        end1=end1,
        end2=end2,
        face1=end1,
        face2=end2,
        normal=np.where(bed[:, None], [0.0, 1.0], [1.0, 0.0]),
        friction=np.full(len(pairs), friction),
        dilatancy=np.zeros(len(pairs)),
        joint=tuple(p[4] for p in pairs),
        dead=dead,
        live=live,
    )


def block_on_halves(friction: tuple[float, float]) -> Assembly:
    """The block of Baggio and Trovalusci (1995): L x L/2 on two contact halves with different friction, L = 1."""
    base = np.array([[0.0, -0.5], [1.0, -0.5], [1.0, 0.0], [0.0, 0.0]])
    block = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]])
    end1, end2 = np.array([[0.0, 0.0], [0.5, 0.0]]), np.array([[0.5, 0.0], [1.0, 0.0]])
    return Assembly(
        name="block on two halves",
        block_ids=("base", "block"),
        polygons=(base, block),
        centroid=np.array([[0.5, -0.25], [0.5, 0.25]]),
        weight=np.array([0.0, 1.0]),
        fixed=np.array([True, False]),
        block_a=np.array([0, 0]),
        block_b=np.array([1, 1]),
        end1=end1,
        end2=end2,
        face1=end1,
        face2=end2,
        normal=np.array([[0.0, 1.0], [0.0, 1.0]]),
        friction=np.array(friction),
        dilatancy=np.zeros(2),
        joint=("bed", "bed"),
        dead=np.array([[0.0, 0.0, 0.0], [0.0, -1.0, 0.0]]),
        live=np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
    )


def arch(friction: float, point_load: bool = False, count: int = 27) -> Assembly:
    """A semicircular arch of voussoirs, radii 1 and 1.2, between fixed abutments.

    Args:
        friction: of all joints.
        point_load: live load of one weight of the arch down on its seventh voussoir, at the middle of the outer edge;
            otherwise its own weight sideways.
        count: of voussoirs.
    """
    live: dict[str, Any] = {"body": [{"per_weight": [1.0, 0.0]}]}
    if point_load:
        half, angle = math.pi / (2 * count), math.pi * (1.0 - 6.5 / count)
        weight = count * 0.5 * (1.2**2 - 1.0) * math.sin(2.0 * half)
        chord = 1.2 * math.cos(half)
        at = [chord * math.cos(angle), chord * math.sin(angle)]
        live = {"points": [{"block": "v7", "at": at, "force": [0.0, -weight]}]}
    ring = {"type": "ring", "inner_radius": 1.0, "outer_radius": 1.2, "count": count}
    wall = {"format": "wall/1", "unit_weight": 1.0, "friction": friction, "pattern": ring, "loads": {"live": live}}
    return build(Wall.model_validate(wall)).assembly
