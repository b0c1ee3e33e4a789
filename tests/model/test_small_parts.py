"""Parts of the model that other tests only pass through: units, what is near when a wall is repaired, names, counts."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
import shapely.affinity

from harness.model import geometry, interfaces
from harness.model.build import build
from harness.model.contacts import find_contacts
from harness.model.errors import InputError
from harness.model.inspection import inspect
from harness.model.load_cases import loads_in
from harness.model.load_fields import Loads
from harness.model.method_registry import check_takes, load_method
from harness.model.reading import parse_wall, read_wall
from harness.model.repair import met_points, without_doubles
from harness.model.units import KILONEWTONS, unit_weight_in_kn_m3
from tests.walls import running_bond, stack, wall_data

STANDARD_GRAVITY = 9.80665
POUND = 0.45359237 * STANDARD_GRAVITY
"""Of force [N], by the definition of the pound."""


@pytest.mark.parametrize(
    ("unit", "newtons"),
    [("N", 1.0), ("daN", 10.0), ("kN", 1e3), ("MN", 1e6), ("kg", STANDARD_GRAVITY), ("kgf", STANDARD_GRAVITY),
     ("t", 1e3 * STANDARD_GRAVITY), ("tf", 1e3 * STANDARD_GRAVITY), ("lbf", POUND), ("kip", 1e3 * POUND)],
)  # fmt: skip
def test_units_of_force_by_their_definitions(unit: str, newtons: float):
    assert KILONEWTONS[unit] == pytest.approx(newtons / 1e3, rel=1e-12)
    assert unit_weight_in_kn_m3(f"{unit}/ft3") == pytest.approx(newtons / 1e3 / 0.3048**3, rel=1e-12)
    assert set(KILONEWTONS) == {"N", "daN", "kN", "MN", "kg", "kgf", "t", "tf", "lbf", "kip"}


@pytest.mark.parametrize(("snap", "left"), [(0.006, ["a"]), (0.004, ["a", "b"])])
def test_an_outline_drawn_twice_differs_by_no_more_than_the_snap_along_its_length(snap: float, left: list[str]):
    """Squares of side 1 that lie .01 apart differ by an area of .02; .006 along 4 is more than that, .004 less."""
    squares = [
        {"id": name, "polygon": [[x, 0], [x + 1, 0], [x + 1, 1], [x, 1]], "weight": 1}
        for name, x in (("a", 0.0), ("b", 0.01))
    ]
    wall = parse_wall({"format": "wall/1", "friction": 0.5, "blocks": squares}, "")
    kept, doubles = without_doubles(list(wall.blocks), snap)
    assert [block.id for block in kept] == left
    assert doubles == ([("b", "a")] if left == ["a"] else [])


def test_points_meet_at_their_mean_if_none_moves_farther_than_the_snap():
    row = np.array([[0.0, 0.0], [0.25, 0.0], [0.5, 0.0], [9.0, 0.0]])
    met = [[0.25, 0.0], [0.25, 0.0], [0.25, 0.0], [9.0, 0.0]]  # the outer two move by just the snap
    assert met_points(row, 0.25).tolist() == met
    longer = np.array([[0.0, 0.0], [0.25, 0.0], [0.5, 0.0], [0.75, 0.0]])
    assert met_points(longer, 0.25).tolist() == longer.tolist()


def test_a_wall_is_called_by_its_file_unless_a_name_is_given(tmp_path: Path):
    path = tmp_path / "tower.json"
    path.write_text(json.dumps(wall_data(stack(2))))
    assert read_wall(path).assembly.name == "tower"
    assert read_wall(path, "keep").assembly.name == "keep"


def test_forces_and_pressures_of_a_load_case_are_counted_together():
    pressure = {"from": [0, 0], "to": [1, 0], "uniform": 1.0}
    load = {"points": [{"block": "1", "at": [0, 0], "force": [1, 0]}] * 2, "pressures": [pressure] * 3}
    assert loads_in(Loads.model_validate({"live": load, "dead": {"body": [{"per_weight": [1, 0]}]}})) == 6


def test_the_support_that_moves_is_named():
    blocks = [
        {"id": name, "polygon": [[x, -1], [x + 1, -1], [x + 1, 0], [x, 0]], "fixed": True}
        for name, x in (("west", 0), ("east", 1))
    ]
    stone = {"id": "stone", "polygon": [[0, 0], [2, 0], [2, 1], [0, 1]], "weight": 1.0}
    wall = {"format": "wall/1", "friction": 0.5, "blocks": [*blocks, stone]}
    wall |= {"settlements": [{"blocks": ["east"], "translation": [0, -1]}]}
    with pytest.raises(InputError, match="takes supports at rest only; east moves"):
        check_takes(load_method("la"), build(parse_wall(wall, "")).assembly)


def comb(teeth: int, upright: bool) -> shapely.Polygon:
    """A comb of teeth of width 1 that are 1 apart and as long as it is wide."""
    size, points = 2.0 * teeth, [(0.0, -1.0)]
    for k in range(teeth):
        points += [(2.0 * k, 0.0), (2.0 * k, size), (2.0 * k + 1.0, size), (2.0 * k + 1.0, 0.0)]
    ring = np.array([*points, (size, -1.0)])
    return shapely.Polygon(ring if upright else ring[:, ::-1])


def test_outlines_of_many_vertices_are_refused_only_if_they_cross_at_many_points():
    """Combs of 1000 teeth across each other cross four million times; the same comb far beside it does not."""
    upright, level = comb(1000, True), comb(1000, False)
    beside = shapely.affinity.translate(upright, 1e5)
    pair = np.array([0]), np.array([1])
    geometry._check_crossings(np.array([upright, beside]), *pair)
    with pytest.raises(InputError, match="cross each other at more than"):
        geometry._check_crossings(np.array([upright, level]), *pair)


def test_joints_are_found_once_where_a_wall_is_looked_over(monkeypatch: pytest.MonkeyPatch):
    """Most of the time of a drawing of many stones is that of finding them; what is built is the same."""
    asked: list[int] = []

    def counted(polygons: Any, *more: Any) -> Any:
        asked.append(len(polygons))
        return find_contacts(polygons, *more)

    wall = parse_wall(wall_data(running_bond(3, 2)), "")
    expected = build(wall, "bond").assembly
    monkeypatch.setattr(interfaces, "find_contacts", counted)
    found = inspect(wall, "bond")
    assert asked == [len(expected.block_ids)]
    assert found.built is not None
    for name in ("block_a", "block_b", "end1", "end2", "normal", "dead", "live"):
        np.testing.assert_array_equal(getattr(found.built.assembly, name), getattr(expected, name))
