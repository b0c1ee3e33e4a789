"""Small walls that several tests share."""

from __future__ import annotations

from typing import Any

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
