"""Loads that travel, line loads and combinations of load cases: what they are on the blocks, and known multipliers."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.fill import highest_faces
from harness.model.load_cases import named_loads, under_load_case
from harness.model.load_fields import Load
from harness.model.method import Finding
from harness.model.pressure import Outlines
from harness.model.reading import parse_wall
from harness.model.travelling import upward_faces
from harness.model.wall import Wall
from tests.commands import drystone as command
from tests.walls import running_bond, stack, wall_data

DOWN = {"force": [0, -1]}
CROWN = {"block": "2", "at": [0.1, 0.4], "force": [0.0, -5.0]}
SIDE = {"block": "2", "at": [0.0, 0.4], "force": [3.0, 0.0]}


def data(pattern: dict[str, Any], **more: Any) -> dict[str, Any]:
    return wall_data(pattern, **({"loads": {}} | more))


def points(document: dict[str, Any]) -> list[tuple[str, tuple[float, float]]]:
    """Block and place of the force in each load case."""
    found = []
    for each in named_loads(Wall.model_validate(document)).values():
        assert each.own.live is not None
        (point,) = each.own.live.points
        found.append((point.block, point.at))
    return found


def semicircle(thickness: float, **more: Any) -> dict[str, Any]:
    """A semicircle of radius 1, unit weight 1 and 20 voussoirs that do not slide."""
    ring = {"inner_radius": 1.0 - 0.5 * thickness, "outer_radius": 1.0 + 0.5 * thickness}
    pattern = {"type": "ring", "count": 20, "supports": "abutments"} | ring
    return data(pattern, friction=50.0, unit_weight=1.0, **more)


@pytest.mark.parametrize(
    ("method", "accuracy"),
    [("la", {"abs": 1e-6}), ("la-associated", {"abs": 1e-6}), ("fe", {"abs": 1e-6}), ("de", {"rel": 5e-3})],
)
def test_load_on_the_extrados_of_a_semicircle(method: str, accuracy: dict[str, float]):
    """P/(gamma R^2) at the middle of voussoir i, by another programme, to six digits; it is least at i 8 and 11."""
    wall = drystone.build_wall(semicircle(0.2, travelling={"wheel": DOWN | {"along": "extrados"}}), "arch")
    cases = list(wall.load_cases.values())
    assert len(cases) == 20
    values = [None] * 4 + [1.888767, 0.633485, 0.360223, 0.259534, 0.231580, 0.264629, 0.264629, 0.231580]
    asked = range(12) if method == "la-associated" else range(3, 10)
    for place in asked:
        result, value = drystone.analyse(cases[place], method), values[place]
        assert result.judge.accepted, place
        if value is None:
            assert result.finding is Finding.UNBOUNDED
        else:
            assert result.multiplier == pytest.approx(value, **accuracy)


def test_top_is_what_is_seen_from_above_and_the_extrados_all_that_looks_up():
    """A lintel over one of two stones: between them is air. Only the stone beside it and the lintel are seen."""
    stones = [
        {"id": "low", "polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]},
        {"id": "pier", "polygon": [[1, 0], [2, 0], [2, 2], [1, 2]]},
        {"id": "lintel", "polygon": [[0.6, 2], [2, 2], [2, 3], [0.6, 3]]},
        {"id": "ground", "polygon": [[0, -1], [2, -1], [2, 0], [0, 0]], "fixed": True},
    ]
    base = {"format": "wall/1", "friction": 0.5, "unit_weight": 1, "blocks": stones}
    top = points(base | {"travelling": {"p": DOWN}})
    assert top == [("low", pytest.approx((0.3, 1.0))), ("lintel", pytest.approx((1.3, 3.0)))]
    extrados = points(base | {"travelling": {"p": DOWN | {"along": "extrados"}}})
    assert extrados == [("low", pytest.approx((0.5, 1.0))), ("lintel", pytest.approx((1.3, 3.0)))]
    one = points(base | {"travelling": {"p": DOWN | {"blocks": ["lintel"], "per_face": 2}}})
    assert one == [("lintel", pytest.approx((0.95, 3.0))), ("lintel", pytest.approx((1.65, 3.0)))]


def test_top_of_a_bond_is_its_top_course_from_left_to_right():
    found = points(data(running_bond(3, 2), travelling={"p": DOWN}))
    assert [x for _, (x, _) in found] == pytest.approx(sorted(x for _, (x, _) in found))
    assert [y for _, (_, y) in found] == pytest.approx([0.6] * 3)
    assert len({block for block, _ in found}) == len(found) == 3


def test_up_is_against_gravity():
    """On a table that is turned on its side the faces on the right look up."""
    turned = points(data(stack(2), loads={"gravity": [-1, 0]}, travelling={"p": {"force": [-1, 0]}}))
    assert [at for _, at in turned] == [pytest.approx((0.3, 0.3)), pytest.approx((0.3, 0.1))]


def test_upward_faces_leave_out_upright_and_covered_ones():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    beside = square + np.array([1.0, 0.0])
    above = square * [0.5, 1.0] + [0.25, 1.0]
    faces = upward_faces([square, beside, above], [0], from_above=True)
    assert [(a.tolist(), b.tolist()) for _, a, b in faces] == [
        (pytest.approx([0.0, 1.0]), pytest.approx([0.25, 1.0])),
        (pytest.approx([0.75, 1.0]), pytest.approx([1.0, 1.0])),
    ]


SLAB = {"id": "slab", "polygon": [[0, 0], [4, 0], [4, 0.5], [0, 0.5]]}
FEET = [[0, 0.5], [0.5, 0.5], [0.5, 1.5], [3.5, 1.5], [3.5, 0.5], [4, 0.5], [4, 2], [0, 2]]
LIPS = [[0, 0], [4, 0], [4, 2], [2.8, 2], [2.8, 1.8], [3.5, 1.8], [3.5, 0.5], [0.5, 0.5], [0.5, 1.8], [1.2, 1.8]]
WITHIN = {"id": "stone", "polygon": [[0.5, 0.5], [3.5, 0.5], [3.5, 1], [0.5, 1]]}
FRAME = {
    "id": "frame",
    "polygon": [[0, 0], [4, 0], [4, 2], [0, 2]],
    "holes": [[[1, 0.5], [3, 0.5], [3, 1.5], [1, 1.5]]],
}


@pytest.mark.parametrize(
    ("stones", "along", "expected"),
    [
        ([SLAB, {"id": "portal", "polygon": FEET}], "extrados", [("slab", (2, 0.5)), ("portal", (2, 2))]),
        ([SLAB, {"id": "portal", "polygon": FEET}], "top", [("portal", (2, 2))]),
        (
            [{"id": "trough", "polygon": [*LIPS, [1.2, 2], [0, 2]]}, WITHIN],
            "top",
            [("trough", (0.6, 2)), ("stone", (2, 1)), ("trough", (3.4, 2))],
        ),
        ([FRAME], "extrados", [("frame", (2, 0.5)), ("frame", (2, 2))]),
        ([FRAME], "top", [("frame", (2, 2))]),
    ],
)
def test_stones_that_are_not_convex_hide_what_is_under_them_and_no_more(stones: list[Any], along: str, expected: Any):
    """Between the feet of a portal a slab is bare; a trough is open between its lips; no face leads to a hole."""
    ground = {"id": "ground", "polygon": [[0, -1], [4, -1], [4, 0], [0, 0]], "fixed": True}
    wall = {"format": "wall/1", "friction": 0.5, "unit_weight": 1, "blocks": [ground, *stones]}
    found = points(wall | {"travelling": {"p": DOWN | {"along": along}}})
    assert found == [(block, pytest.approx(at)) for block, at in expected]


def test_a_load_that_travels_and_one_of_its_places_add_up():
    document = data(stack(2), travelling={"p": DOWN | {"per_face": 2}}, combinations={"c": {"p": 1.5, "p-2": 0.5}})
    found = named_loads(Wall.model_validate(document))
    forces = {name: [point.force for point in found[name].own.live.points] for name in ("c-1", "c-2")}
    assert forces == {"c-1": [(0.0, -1.5), (0.0, -0.5)], "c-2": [(0.0, -2.0)]}


def test_combination_adds_loads_with_factors_and_one_for_the_dead_load():
    """1.35 (gravity + dead) + 1.5 crane + 0.9 push, dead and live part by part."""
    cases = {
        "crane": {"dead": {"points": [SIDE]}, "live": {"points": [CROWN]}},
        "push": {"live": {"body": [{"per_weight": [0.1, 0]}]}},
    }
    common = {"dead": {"points": [CROWN]}}
    combinations = {"uls": {"dead": 1.35, "crane": 1.5, "push": 0.9}, "sls": {"crane": 1.0}}
    wall = drystone.build_wall(data(stack(2), loads=common, load_cases=cases, combinations=combinations), "pier")
    found = {name: each.assembly for name, each in wall.load_cases.items()}
    assert list(found) == ["crane", "push", "uls", "sls"]

    def alone(**loads: Any) -> np.ndarray:
        return drystone.build_wall(data(stack(2), loads={"gravity": False} | loads)).assembly.dead

    weight, side, crown = alone(gravity=True), alone(dead={"points": [SIDE]}), alone(dead={"points": [CROWN]})
    np.testing.assert_allclose(found["uls"].dead, 1.35 * (weight + crown) + 1.5 * side, rtol=1e-14, atol=1e-14)
    live = 1.5 * found["crane"].live + 0.9 * found["push"].live
    np.testing.assert_allclose(found["uls"].live, live, rtol=1e-14, atol=1e-14)
    np.testing.assert_array_equal(found["sls"].dead, found["crane"].dead)
    np.testing.assert_array_equal(found["sls"].live, found["crane"].live)


def test_combination_of_a_load_that_travels_is_one_for_each_place():
    """With factors d and f a multiplier is d/f times as great: rigid blocks have no scale of force."""
    document = semicircle(0.2, travelling={"wheel": DOWN}, combinations={"uls": {"dead": 1.35, "wheel": 1.5}})
    names = list(named_loads(Wall.model_validate(document)))
    assert names == [f"wheel-{k}" for k in range(1, 21)] + [f"uls-{k}" for k in range(1, 21)]
    wall = drystone.build_wall(document, "arch").load_cases
    for name in ("wheel", "uls"):  # the load itself is no load case: its places are
        words = rf"no load case is called \"{name}\".*at 20 place\(s\).*: give one of {name}-1 to {name}-20$"
        with pytest.raises(InputError, match=words):
            under_load_case(Wall.model_validate(document), name)
    with pytest.raises(InputError, match='Did you mean "wheel-2"'):
        under_load_case(Wall.model_validate(document), "whel-2")
    alone, combined = (drystone.analyse(wall[name], "la-associated").multiplier for name in ("wheel-9", "uls-9"))
    assert alone is not None
    assert combined == pytest.approx(alone * 1.35 / 1.5, rel=1e-9)


def test_combination_scales_pressures_and_line_loads():
    line = {"from": [0, 0.4], "to": [0.3, 0.4], "line_load": [0, -10]}
    water = {"from": [0, 0], "to": [0, 0.4], "water": {"level": 0.4, "unit_weight": 9.81}}
    cases = {"floor": {"live": {"pressures": [line, water]}}}
    wall = drystone.build_wall(data(stack(2), load_cases=cases, combinations={"c": {"floor": 2.0}})).load_cases
    np.testing.assert_allclose(wall["c"].assembly.live, 2.0 * wall["floor"].assembly.live, rtol=1e-14)


def test_line_load_is_its_length_times_itself_whatever_the_thickness():
    """-10 kN/m on the right two thirds of a block 0.3 wide: -2 kN, 0.05 to the right of its centroid."""
    line = {"from": [0.1, 0.4], "to": [0.3, 0.4], "line_load": [1, -10]}
    loads = {"live": {"pressures": [line]}}
    for thickness in (0.2, 1.0):
        live = drystone.build_wall(data(stack(2), loads=loads, thickness=thickness)).assembly.live
        assert live[-1] == pytest.approx([0.2, -2.0, 0.05 * -2.0 - 0.1 * 0.2])
        assert not live[:-1].any()


def test_every_output_of_the_governing_load_case_says_where_the_load_stands(tmp_path: Path):
    """A block on two posts: the force on it is borne by both, beyond them by none, and is furthest out at the right."""
    posts = [
        {"id": name, "polygon": [[x, 0], [x + 0.2, 0], [x + 0.2, 1], [x, 1]], "fixed": True}
        for name, x in (("left", 0.4), ("right", 1.4))
    ]
    lintel = {"id": "lintel", "polygon": [[0, 1], [2.2, 1], [2.2, 1.2], [0, 1.2]]}
    document = {"format": "wall/1", "title": "Lintel", "unit_weight": 20, "friction": 0.65, "blocks": [*posts, lintel]}
    travels = {"travelling": {"axle": DOWN | {"per_face": 5}}, "combinations": {"twice": {"axle": 2}}}
    path = tmp_path / "lintel.json"
    path.write_text(json.dumps(document | travels))
    place = "axle on lintel at (1.98, 1.2) m"
    report = ("--methods", "la", "--report", tmp_path / "r.html", "--store", tmp_path / "s.sqlite")
    done = command("compare", path, *report)
    assert done.returncode == 0, done.stderr
    assert f'la: load case "twice-5" ({place}) governs' in done.stdout
    assert f"in load case twice-5 ({place}), least" in (tmp_path / "r.html").read_text()
    assert f'"twice-5 ({place})"' in (tmp_path / "r-data" / "results.csv").read_text()
    told = json.loads(command("compare", path, *report, "--json").stdout)
    (rows,) = (each["load_cases"] for each in told["envelopes"])
    assert {row["load_case"]: row["load_place"] for row in rows}["twice-5"] == place
    assert f"live load  downwards, {place}" in command("run", "la", path, "--load-case", "twice-5").stdout
    alone = json.loads(command("expand", path, "--load-case", "twice-5").stdout)
    assert alone["title"] == f"Lintel, load case twice-5 ({place})"
    again = command("report", "--report", tmp_path / "r.html", "--store", tmp_path / "s.sqlite")
    assert again.returncode == 0, again.stderr
    assert f"in load case twice-5 ({place}), least" in (tmp_path / "r.html").read_text()


def test_file_round_trip_and_command(tmp_path: Path):
    document = semicircle(0.2, travelling={"wheel": DOWN}, combinations={"uls": {"dead": 1.35, "wheel": 1.5}})
    wall = parse_wall(document, "")
    assert parse_wall(wall.document(), "") == wall
    path = tmp_path / "arch.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    done = command("run", "la-associated", path, "--load-case", "uls-9", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["multiplier"] == pytest.approx(0.231580 * 1.35 / 1.5, abs=1e-6)
    without = command("run", "la-associated", path)
    assert without.returncode == 2
    assert "travelling, combinations: it has the load cases wheel-1, wheel-2" in without.stderr
    alone = parse_wall(semicircle(0.2, travelling={"wheel": DOWN}), "")
    with pytest.raises(InputError, match=r"^travelling: it has the load cases of wheel, each a wall"):
        build(alone)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"travelling": {"p": {"force": [0, 0]}}}, "no force"),
        ({"travelling": {"p": DOWN | {"blocks": ["1"]}}}, "acts on no face"),
        ({"travelling": {"p": DOWN | {"group": "none"}}}, 'no block is in a group "none"'),
        ({"travelling": {"p": DOWN | {"blocks": ["nobody"]}}}, 'no block is called "nobody"'),
        ({"travelling": {"p": DOWN | {"blocks": ["2"], "group": "g"}}}, "either blocks or group"),
        ({"travelling": {"p": DOWN | {"per_face": 0}}}, "per_face"),
        ({"travelling": {"p": DOWN}, "load_cases": {"p-1": {}}}, 'load case "p-1" has the name of another'),
        ({"travelling": {"p": DOWN}, "load_cases": {"p": {}}}, "names two of"),
        ({"travelling": {"p": DOWN}, "loads": {"live": {"body": [{"per_weight": [1, 0]}]}}}, "loads.live beside"),
        ({"combinations": {"c": {}}}, "c"),
        ({"load_cases": {"snow": {}}, "combinations": {"c": {"snwo": 1.0}}}, 'Did you mean "snow"'),
        ({"load_cases": {"dead": {}}, "combinations": {"c": {"dead": 1.0}}}, "another name"),
        ({"load_cases": {"a": {"gravity": False}}, "combinations": {"c": {"a": 1.0}}}, "gravity of its own"),
        ({"travelling": {"Wheel": DOWN}}, "no name of a load case"),
    ],
)
def test_what_cannot_be_is_refused(wrong: dict[str, Any], words: str):
    with pytest.raises(InputError, match=words):
        drystone.build_wall(data(stack(2)) | wrong)


def test_fault_of_a_combination_is_told_at_its_place():
    """The forces of the two load cases cancel, so the combination loads nothing."""
    opposite = SIDE | {"force": [-3.0, 0.0]}
    cases = {name: {"live": {"points": [load]}} for name, load in (("a", SIDE), ("b", opposite))}
    document = data(stack(2), load_cases=cases, combinations={"none": {"a": 1.0, "b": 1.0}})
    with pytest.raises(InputError, match="the live load puts no force") as caught:
        drystone.build_wall(document)
    assert caught.value.element == "combinations.none"


def test_so_many_faces_above_each_other_that_they_take_minutes_are_refused():
    count = 40_000
    shift = np.arange(count) / count
    ends = [np.column_stack([shift + right, shift]) for right in (1.0, 0.0)]
    with pytest.raises(InputError, match="40,000 faces that look up lie above each other"):
        highest_faces(Outlines(ends[0], ends[1], np.arange(count)))


def test_loads_of_a_load_case_stay_as_they_are_without_factors():
    named = named_loads(Wall.model_validate(data(stack(2), load_cases={"a": {"live": {"points": [SIDE]}}})))
    assert named["a"].own.live == Load.model_validate({"points": [SIDE]})
    assert named["a"].common == 1.0
