"""Small walls that several tests share."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial import Voronoi

from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.case import Case, CaseFile, Reference
from harness.model.wall import Wall

PUSH = {"live": {"body": [{"per_weight": [1, 0]}]}}


def wall_data(pattern: dict[str, Any], friction: Any = 0.65, **more: Any) -> dict[str, Any]:
    return {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "pattern": pattern, "loads": PUSH} | more


def running_bond(count: int, bricks: int, length: float = 0.4, height: float = 0.2) -> dict[str, Any]:
    return {
        "type": "running_bond",
        "block_length": length,
        "block_height": height,
        "count": count,
        "bricks": bricks,
    }


def stack(count: int, width: float = 0.3, height: float = 0.2) -> dict[str, Any]:
    return {"type": "stack", "width": width, "height": height, "count": count}


def assembly(pattern: dict[str, Any], friction: Any = 0.65, **more: Any) -> Assembly:
    return build(Wall.model_validate(wall_data(pattern, friction, **more))).assembly


def case(pattern: dict[str, Any], friction: Any = 0.65, references: list[Reference] | None = None, **more: Any) -> Case:
    file = CaseFile(id="made-up", title="A wall of a test", source="the tests", references=references or [])
    return Case(file, Wall.model_validate(wall_data(pattern, friction, **more)), "made-up/wall.json")


def rubble(seed: int, columns: int, courses: int, friction: float) -> Assembly:
    """A wall of irregular blocks, Voronoi cells in a box of 3 x 2, on a fixed block."""
    width, height = 3.0, 2.0
    row, column = np.divmod(np.arange(columns * courses), columns)
    places = np.column_stack([column + 0.25 + 0.5 * (row % 2), row + 0.5])
    places += np.random.default_rng(seed).uniform(-0.35, 0.35, places.shape)
    places = np.clip(places / [columns, courses], 0.03, 0.97)
    seeds = places * [width, height]
    images = [seeds * [-1, 1], seeds * [1, -1], [2 * width, 0] + seeds * [-1, 1], [0, 2 * height] + seeds * [1, -1]]
    cells = Voronoi(np.vstack([seeds, *images]))
    corners = [cells.vertices[cells.regions[cells.point_region[k]]].round(9) for k in range(len(seeds))]
    base = [[-1, -0.5], [width + 1, -0.5], [width + 1, 0], [-1, 0]]
    blocks: list[dict[str, Any]] = [{"id": "base", "polygon": base, "fixed": True}]
    blocks += [{"id": f"b{k}", "polygon": corner.tolist()} for k, corner in enumerate(corners)]
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "blocks": blocks, "loads": PUSH}
    return build(Wall.model_validate(wall)).assembly
