"""The table of docs/scope.md states what `check_takes` decides for each feature of a wall and each method."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from harness.model.build import build
from harness.model.errors import InputError
from harness.model.load_cases import named_loads
from harness.model.method_registry import check_takes, listed_methods, load_method
from harness.model.wall import Wall
from tests.walls import built_load_case

PAGE = Path(__file__).resolve().parents[2] / "docs" / "scope.md"
HEAD = "| feature of the wall |"

PLAIN: dict[str, Any] = {
    "format": "wall/1",
    "unit_weight": 20,
    "friction": 0.5,
    "blocks": [
        {"id": "ground", "polygon": [[0, -1], [2, -1], [2, 0], [0, 0]], "fixed": True},
        {"id": "a", "polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]},
    ],
}
PUSH = {"live": {"body": [{"per_weight": [1, 0]}]}}
ENDS = {"from": {"block": "ground", "at": [1.5, 0]}, "to": {"block": "a", "at": [1, 0.5]}, "yield_force": 1}
FACE = {"from": [0, 0], "to": [0, 1], "uniform": 3}
SOIL = {"level": 2, "unit_weight": 18}
FEATURES: dict[str, tuple[dict[str, Any], ...]] = {
    "friction": ({},),
    "dilatancy": ({"friction": {"default": 0.5, "dilatancy": 0.2}},),
    "cohesion, tensile strength": ({"cohesion": 2}, {"cohesion": 2, "tensile_strength": 1}),
    "brittle joints": ({"cohesion": 2, "after": "residual"},),
    "compressive strength": ({"compressive_strength": 400},),
    "ties, props": ({"ties": [ENDS]}, {"props": [ENDS]}),
    "settlements": ({"settlements": [{"blocks": ["ground"], "translation": [0, -1]}]},),
    "pressures": ({"loads": {"live": {"pressures": [FACE]}}},),
    "fills": ({"loads": {"dead": {"fills": [SOIL]}, **PUSH}},),
    "passive fill": (
        {"loads": {"dead": {"fills": [SOIL | {"passive": {"mobilised": 0.5, "coefficient": 3}}]}, **PUSH}},
    ),
    "load cases, combinations": ({"load_cases": {"push": PUSH}, "combinations": {"sum": {"dead": 1.35, "push": 1.5}}},),
    "travelling loads": ({"travelling": {"axle": {"force": [0, -10]}}},),
}


def _cell(feature: str, name: str) -> str:
    """What the table says of a feature and a method: refused, or how the method's multiplier is to be read."""
    method = load_method(name)
    for fields in FEATURES[feature]:
        wall = Wall.model_validate(PLAIN | fields)
        cases = named_loads(wall)
        for built in [built_load_case(wall, case) for case in cases] or [build(wall)]:
            try:
                check_takes(method, built.assembly)
            except InputError:
                return "refused"
    if method.traits.bounds_above:
        return "upper bound"
    return f"to {method.traits.accuracy:.1%}".replace("%", " %") if method.traits.brackets else "yes"


def _table() -> tuple[list[str], dict[str, list[str]]]:
    """The methods at the head of the columns, and the cells of each row."""
    lines = PAGE.read_text(encoding="utf-8").splitlines()
    start = next(place for place, line in enumerate(lines) if line.startswith(HEAD))
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[start:]]
    end = next(place for place, row in enumerate(rows) if row == [""])
    return rows[0][1:], {row[0]: row[1:] for row in rows[2:end]}


@pytest.mark.parametrize("feature", FEATURES)
def test_the_table_of_scope_states_what_each_method_takes(feature: str) -> None:
    heads, rows = _table()
    assert set(rows) == set(FEATURES)
    named = {word.strip("`,") for head in heads for word in head.split() if word.startswith("`")}
    expected = []
    for head in heads:
        names = [word.strip("`,") for word in head.split() if word.startswith("`")] or [
            name for name in listed_methods() if name not in named
        ]
        expected.append(" or ".join(sorted({_cell(feature, name) for name in names}, key=lambda cell: cell != "yes")))
    assert rows[feature] == expected
