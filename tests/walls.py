"""Small walls that several tests share."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from harness.model.assembly import Assembly
from harness.model.build import Built, build
from harness.model.case import Case, CaseFile, Reference
from harness.model.load_cases import each_built, named_loads
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


def built_load_case(wall: Wall, name: str) -> Built:
    ((_, _, built),) = each_built(wall, {name: name}, named_loads(wall))
    return built


def assembly(pattern: dict[str, Any], friction: Any = 0.65, **more: Any) -> Assembly:
    return build(Wall.model_validate(wall_data(pattern, friction, **more))).assembly


def case(pattern: dict[str, Any], friction: Any = 0.65, references: list[Reference] | None = None, **more: Any) -> Case:
    file = CaseFile(id="made-up", title="A wall of a test", source="the tests", references=references or [])
    return Case(file, Wall.model_validate(wall_data(pattern, friction, **more)), "made-up/wall.json")


def wedge() -> dict[str, Any]:
    """A block between two fixed ones, which only friction on its sides can hold; its live load draws it down."""
    panel = {"type": "panel", "cell_length": 1.0, "cell_height": 1.0, "layout": ["LMR"], "fixed": "LR"}
    return wall_data(panel, 0.5, loads={"live": {"body": [{"per_weight": [0, -1]}]}})


def beside(assembly: Assembly, share: float) -> Assembly:
    """With an independent block beside it, on a fixed block of its own: `share` of the wall's weight, pressed down.

    The block bears any live load, which on it is its own weight, so no multiplier may change.
    """
    size = assembly.length_scale
    points = np.vstack(assembly.polygons)
    place = points.max(axis=0) + 3.0 * size
    square = size * np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    n = assembly.n_blocks
    weight = share * assembly.force_scale
    down = np.array([0.0, -weight, 0.0])
    ends = place + size * np.array([[-0.5, -0.5], [0.5, -0.5]])
    live = down if assembly.has_live_load else np.zeros(3)
    return replace(
        assembly,
        block_ids=(*assembly.block_ids, "beside", "beside base"),
        polygons=(*assembly.polygons, place + square, place + square - [0.0, size]),
        centroid=np.vstack([assembly.centroid, place, place - [0.0, size]]),
        weight=np.append(assembly.weight, [weight, 0.0]),
        fixed=np.append(assembly.fixed, [False, True]),
        dead=np.vstack([assembly.dead, down, np.zeros(3)]),
        live=np.vstack([assembly.live, live, np.zeros(3)]),
        support_motion=np.vstack([assembly.support_motion, np.zeros((2, 3))]),
        block_a=np.append(assembly.block_a, n + 1),
        block_b=np.append(assembly.block_b, n),
        end1=np.vstack([assembly.end1, ends[:1]]),
        end2=np.vstack([assembly.end2, ends[1:]]),
        face1=np.vstack([assembly.face1, ends[:1]]),
        face2=np.vstack([assembly.face2, ends[1:]]),
        normal=np.vstack([assembly.normal, [[0.0, 1.0]]]),
        friction=np.append(assembly.friction, 0.5),
        dilatancy=np.append(assembly.dilatancy, 0.0),
        constant=np.vstack([assembly.constant, np.zeros(4)]),
        crushing=np.append(assembly.crushing, np.inf),
        bar_stiffness=np.append(assembly.bar_stiffness, 0.0),
        brittle=np.append(assembly.brittle, False),
        joint=(*assembly.joint, "bed"),
    )
