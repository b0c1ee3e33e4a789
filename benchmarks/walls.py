"""Walls that benchmarks, studies and tests share: bonds, stacks, and walls that chance draws."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.spatial import Voronoi

from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.wall import Wall

PUSH = {"live": {"body": [{"per_weight": [1, 0]}]}}
WIDTH, HEIGHT = 3.0, 2.0
"""Of an irregular wall."""


def pushed(pattern: dict[str, Any], friction: float) -> Assembly:
    """The assembly of a pattern pushed sideways by its weight."""
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "pattern": pattern, "loads": PUSH}
    return build(Wall.model_validate(data)).assembly


def stack(count: int, width: float, height: float, friction: float) -> Assembly:
    """A stack of equal blocks."""
    return pushed({"type": "stack", "width": width, "height": height, "count": count}, friction)


def bond(count: int, bricks: int, friction: float, height: float = 0.175, length: float = 0.4) -> Assembly:
    """A running bond that starts with half bricks."""
    pattern = {"type": "running_bond", "block_length": length, "block_height": height, "count": count, "bricks": bricks}
    return pushed(pattern, friction)


def random_wall(seed: int) -> Assembly:
    """The random coursed wall of this seed.

    3 to 10 courses of 3 to 8 block lengths, blocks of 0.5 to 1.25 lengths, height 0.3 to 0.75 of the length, friction
    0.3 to 1.1.
    """
    generator = np.random.default_rng(seed)
    length = float(generator.integers(3, 9))
    courses = []
    for _ in range(int(generator.integers(3, 11))):
        widths: list[float] = []
        while length - sum(widths) > 0.0:
            width = min(float(generator.choice([0.5, 0.75, 1.0, 1.25])), length - sum(widths))
            widths.append(width)
        courses.append(widths)
    wall = {
        "format": "wall/1",
        "unit_weight": 20.0,
        "friction": round(float(generator.uniform(0.3, 1.1)), 3),
        "pattern": {
            "type": "running_bond",
            "block_length": 0.4,
            "block_height": round(0.4 * float(generator.uniform(0.3, 0.75)), 3),
            "courses": courses,
        },
        "loads": {"live": {"body": [{"per_weight": [1.0, 0.0]}]}},
    }
    return build(Wall.model_validate(wall), f"random wall {seed}").assembly


def irregular_wall(seed: int, columns: int, courses: int, friction: float) -> Assembly:
    """Voronoi cells of disturbed courses, pushed sideways, on a fixed block."""
    row, column = np.divmod(np.arange(columns * courses), columns)
    places = np.column_stack([column + 0.25 + 0.5 * (row % 2), row + 0.5])
    places += np.random.default_rng(seed).uniform(-0.35, 0.35, places.shape)
    seeds = np.clip(places / [columns, courses], 0.03, 0.97) * [WIDTH, HEIGHT]
    images = [seeds * [-1, 1], seeds * [1, -1], [2 * WIDTH, 0] + seeds * [-1, 1], [0, 2 * HEIGHT] + seeds * [1, -1]]
    cells = Voronoi(np.vstack([seeds, *images]))
    corners = [cells.vertices[cells.regions[cells.point_region[k]]].round(9) for k in range(len(seeds))]
    base = [[-1, -0.5], [WIDTH + 1, -0.5], [WIDTH + 1, 0], [-1, 0]]
    blocks: list[dict[str, Any]] = [{"id": "base", "polygon": base, "fixed": True}]
    blocks += [{"id": f"b{k}", "polygon": corner.tolist()} for k, corner in enumerate(corners)]
    return _built(f"irregular wall {seed}", friction, blocks, PUSH)


def drawn(seed: int, least: int = 3, most: int = 8) -> Assembly:
    """The wall of a seed: courses and columns from `least` to `most`, friction from 0.3 to 1.0."""
    generator = np.random.default_rng([seed, 1])
    columns, courses = (int(count) for count in generator.integers(least, most + 1, 2))
    return irregular_wall(seed, columns, courses, round(float(generator.uniform(0.3, 1.0)), 3))


def courses_of_stones(seed: int) -> Assembly:
    """The wall of a seed: 4 to 8 courses of unequal height of one to three stones of unequal length, pushed sideways.

    Stones of different height and length leave many joints that carry nothing in some state.
    """
    generator = np.random.default_rng([seed, 11])
    length = round(float(generator.uniform(0.5, 1.2)), 2)
    blocks: list[dict[str, Any]] = [
        {"id": "ground", "polygon": _rectangle(-0.2, -0.2, length + 0.2, 0.0), "fixed": True}
    ]
    base = 0.0
    for course in range(int(generator.integers(4, 9))):
        top = round(base + float(generator.uniform(0.12, 0.3)), 2)
        within = generator.uniform(0.15, 0.85, int(generator.choice([0, 1, 2], p=[0.4, 0.4, 0.2])))
        ends = [0.0, *sorted(set(np.round(within * length, 2).tolist())), length]
        for place, (left, right) in enumerate(pairwise(ends)):
            blocks.append({"id": f"{course}.{place}", "polygon": _rectangle(left, base, right, top)})
        base = top
    return _built(f"courses of stones {seed}", round(float(generator.uniform(0.3, 1.3)), 2), blocks, PUSH)


def small_arch(seed: int) -> Assembly:
    """The arch of a seed: 4 to 8 equal voussoirs of a circle between abutments, and a weight on one of them."""
    generator = np.random.default_rng([seed, 13])
    count, half = int(generator.integers(4, 9)), float(generator.uniform(0.7, 1.4))
    inner, outer = 2.0, 2.0 + round(float(generator.uniform(0.25, 0.6)), 2)
    angles = 0.5 * np.pi + np.linspace(half, -half, count + 1)
    angles = np.concatenate([[angles[0] + 0.15], angles, [angles[-1] - 0.15]])
    corners = np.column_stack([np.cos(angles), np.sin(angles)]).round(6)
    blocks: list[dict[str, Any]] = []
    for k in range(count + 2):
        a, b = corners[k], corners[k + 1]
        polygon = [(r * c).round(6).tolist() for r, c in ((inner, a), (outer, a), (outer, b), (inner, b))]
        blocks.append({"id": f"v{k}", "polygon": polygon} | ({"fixed": True} if k in (0, count + 1) else {}))
    under = int(generator.integers(1, count + 1))
    at = (0.5 * outer * (corners[under] + corners[under + 1])).round(6).tolist()
    load = {"live": {"points": [{"block": f"v{under}", "at": at, "force": [0, -1]}]}}
    return _built(f"small arch {seed}", round(float(generator.uniform(0.4, 0.9)), 2), blocks, load)


def _rectangle(left: float, bottom: float, right: float, top: float) -> list[list[float]]:
    return [[left, bottom], [right, bottom], [right, top], [left, top]]


def _built(name: str, friction: float, blocks: list[dict[str, Any]], loads: dict[str, Any]) -> Assembly:
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "blocks": blocks, "loads": loads}
    return build(Wall.model_validate(wall), name).assembly


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
