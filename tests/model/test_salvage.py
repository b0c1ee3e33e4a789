"""What can be looked at of a faulty wall file: just the part at fault is left out."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import pytest

from harness.model.salvage import salvaged

WALL: dict[str, Any] = {
    "format": "wall/1",
    "unit_weight": 20.0,
    "friction": {"default": 0.5, "rules": [{"joint": "bed", "value": 0.4}, {"joint": "head", "value": 0.3}]},
    "blocks": [
        {"id": "g", "polygon": [[0, -1], [4, -1], [4, 0], [0, 0]], "fixed": True},
        {"id": "a", "polygon": [[0, 0], [2, 0], [2, 1], [0, 1]], "thickness": 2.0, "weight": 3.0},
        {"id": "b", "polygon": [[2, 0], [4, 0], [4, 1], [2, 1]]},
    ],
    "interfaces": [
        {"between": ["g", "a"], "from": [0, 0], "to": [2, 0]},
        {"between": ["g", "b"], "from": [2, 0], "to": [4, 0]},
    ],
    "loads": {"live": {"body": [{"per_weight": [1, 0], "blocks": ["a"]}, {"per_weight": [0, 1], "blocks": ["b"]}]}},
}

Change = Callable[[dict[str, Any]], Any]
FAULTS: dict[str, tuple[Change, Change, int]] = {
    "none": (lambda w: None, lambda w: None, 0),
    "a field of a block": (
        lambda w: w["blocks"][1].update(thickness=-1),
        lambda w: w["blocks"][1].pop("thickness"),
        1,
    ),
    "two fields of two blocks": (
        lambda w: (w["blocks"][1].update(weight="much"), w["blocks"][2].update(fixed="so")),
        lambda w: w["blocks"][1].pop("weight"),
        2,
    ),
    "a field that is unknown": (lambda w: w["blocks"][2].update(colour="red"), lambda w: None, 1),
    "a coordinate": (lambda w: w["blocks"][1]["polygon"][0].__setitem__(0, "x"), lambda w: w["blocks"].pop(1), 1),
    "no outline": (lambda w: w["blocks"][1].pop("polygon"), lambda w: w["blocks"].pop(1), 1),
    "two blocks without": (
        lambda w: (w["blocks"][1].pop("polygon"), w["blocks"][2].pop("id")),
        lambda w: (w["blocks"].pop(2), w["blocks"].pop(1)),
        2,
    ),
    "an interface": (
        lambda w: w["interfaces"][0].update({"from": [0]}),
        lambda w: w["interfaces"].pop(0),
        1,
    ),
    "a load": (
        lambda w: w["loads"]["live"]["body"][0].update(per_weight=[1, "y"]),
        lambda w: w["loads"]["live"]["body"].pop(0),
        1,
    ),
    "a rule": (
        lambda w: w["friction"]["rules"][0].update(value=-1),
        lambda w: w["friction"]["rules"].pop(0),
        1,
    ),
    "a field of the wall": (lambda w: w.update(thickness="thick"), lambda w: None, 1),
    "no friction": (lambda w: w.pop("friction"), lambda w: w.update(friction=1.0), 1),
    "two frictions": (
        lambda w: w.update(friction=0.5, friction_angle=30.0),
        lambda w: w.update(friction=0.5),
        1,
    ),
}
"""(what is done to the file, what is left of it, number of faults)."""


@pytest.mark.parametrize("name", FAULTS)
def test_the_part_at_fault_alone_is_left_out(name: str):
    spoil, left_out, count = FAULTS[name]
    data, rest = copy.deepcopy(WALL), copy.deepcopy(WALL)
    spoil(data)
    left_out(rest)
    given = copy.deepcopy(data)
    wall, faults = salvaged(data, "wall.json")
    right, none = salvaged(rest, "wall.json")
    assert data == given  # the file itself is left as it is
    assert none == ()
    assert len(faults) == count
    assert wall is not None
    assert wall == right


@pytest.mark.parametrize(
    "data", [[], "wall", {}, {"format": "wall/2"}, {"format": "wall/1"}, WALL | {"blocks": [], "thickness": -1.0}]
)
def test_what_is_no_wall_or_has_no_block_gives_none(data: Any):
    wall, faults = salvaged(data, "wall.json")
    assert wall is None
    assert faults


def test_a_pattern_is_something_to_look_at():
    pattern = {"type": "stack", "width": 1.0, "height": 1.0, "count": 2}
    data = {name: value for name, value in WALL.items() if name not in ("blocks", "interfaces", "loads")}
    wall, faults = salvaged(data | {"pattern": pattern, "thickness": -1.0}, "wall.json")
    assert wall is not None
    assert wall.pattern is not None
    assert len(faults) == 1
