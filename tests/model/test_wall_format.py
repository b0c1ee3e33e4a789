"""The wall format: what it carries, what it refuses, and that its expansion means the same."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from harness.model.build import build
from harness.model.errors import InputError
from harness.model.json_text import read_json
from harness.model.reading import parse_wall, read_wall, wall_json
from harness.model.wall import Wall

BOND: dict[str, Any] = {
    "format": "wall/1",
    "unit_weight": 20.0,
    "friction": 0.65,
    "pattern": {"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": 6, "bricks": 3},
    "loads": {"live": {"body": [{"per_weight": [1, 0]}]}},
}


PANEL: dict[str, Any] = {"type": "panel", "cell_length": 1, "cell_height": 1, "layout": ["AA", "##"], "fixed": "#"}


def two_blocks(**changes: Any) -> dict[str, Any]:
    wall: dict[str, Any] = {
        "format": "wall/1",
        "friction": 0.5,
        "blocks": [
            {"id": "base", "polygon": [[0, -1], [4, -1], [4, 0], [0, 0]], "fixed": True},
            {"id": "a", "polygon": [[0, 0], [2, 0], [2, 1], [0, 1]], "weight": 2.0},
        ],
    }
    return wall | changes


def assembly_of(data: dict[str, Any]):
    return build(Wall.model_validate(data)).assembly


def test_paper_wall_has_21_blocks_and_49_interfaces():
    assembly = assembly_of(BOND)
    assert assembly.n_free == 21
    assert assembly.n_interfaces == 49
    assert assembly.joint.count("head") == 15


def test_weight_is_unit_weight_times_area_times_thickness():
    data = two_blocks(unit_weight=10.0, thickness=0.5)
    del data["blocks"][1]["weight"]
    assert assembly_of(data).weight[1] == pytest.approx(10.0 * 2.0 * 0.5, rel=1e-15)


def test_friction_by_materials_joint_and_interface():
    friction = {
        "default": 0.5,
        "rules": [
            {"value": 0.4, "materials": ["brick", "stone"]},
            {"value": 0.3, "joint": "head"},
            {"value": 0.2, "between": ["a", "b"]},
        ],
    }
    data = two_blocks(friction=friction)
    data["blocks"][1]["material"] = "brick"
    data["blocks"].append({"id": "b", "polygon": [[2, 0], [4, 0], [4, 1], [2, 1]], "weight": 2.0, "material": "brick"})
    assembly = assembly_of(data)
    by_pair = {
        (assembly.block_ids[a], assembly.block_ids[b]): mu
        for a, b, mu in zip(assembly.block_a, assembly.block_b, assembly.friction, strict=True)
    }
    assert by_pair == {("base", "a"): 0.4, ("base", "b"): 0.4, ("a", "b"): 0.2}


def test_given_interfaces_take_their_normal_from_the_geometry_whatever_their_order():
    interface = {"between": ["a", "base"], "from": [2, 0], "to": [0, 0], "friction": 0.7}
    for between in (["a", "base"], ["base", "a"]):
        for ends in (([0, 0], [2, 0]), ([2, 0], [0, 0])):
            given = interface | {"between": between, "from": ends[0], "to": ends[1]}
            assembly = assembly_of(two_blocks(interfaces=[given]))
            up = 1.0 if between[1] == "a" else -1.0
            np.testing.assert_array_equal(assembly.normal, [[0.0, up]])
            assert assembly.friction.tolist() == [0.7]


@pytest.mark.parametrize(("inset", "expected"), [({"length": 0.02}, 0.02), ({"fraction": 0.25}, 0.5)])
def test_contact_points_are_set_in_from_both_ends(inset: dict[str, float], expected: float):
    assembly = assembly_of(two_blocks(contact_inset=inset))
    assert sorted([assembly.end1[0, 0], assembly.end2[0, 0]]) == pytest.approx([expected, 2.0 - expected], abs=1e-15)
    assert sorted([assembly.face1[0, 0], assembly.face2[0, 0]]) == [0.0, 2.0]


def test_partly_live_load_and_point_force_act_at_the_centroid_with_their_moment():
    data = two_blocks()
    data["blocks"][1]["groups"] = ["vault"]
    data["loads"] = {
        "dead": {"body": [{"per_weight": [0, -0.5], "group": "vault"}]},
        "gravity": True,
        "live": {
            "body": [{"per_weight": [0, -0.25], "blocks": ["a"]}],
            "points": [{"block": "a", "at": [2, 1], "force": [3, 5]}],
        },
    }
    assembly = assembly_of(data)
    assert assembly.dead[1].tolist() == [0.0, -3.0, 0.0]
    # arm (1, 0.5) from the centroid (1, 0.5): moment 1*5 - 0.5*3
    assert assembly.live[1].tolist() == [3.0, 5.0 - 0.5, 1.0 * 5.0 - 0.5 * 3.0]


@pytest.mark.parametrize(
    "pattern",
    [
        BOND["pattern"],
        {"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "courses": [[1, 1], [0.5, -1, 0.5], [2]]},
        {"type": "ring", "inner_radius": 1.0, "outer_radius": 1.2, "count": 9},
        {"type": "ring", "inner_radius": 1.0, "outer_radius": 1.2, "count": 9, "supports": "end_voussoirs"},
        {"type": "stack", "width": 0.3, "height": 0.2, "count": 4, "offsets": [0, 0.05, 0, -0.05]},
        {"type": "panel", "cell_length": 1, "cell_height": 1, "layout": ["AABB", "CDDB", "####"], "fixed": "#"},
    ],
)
def test_expansion_is_deterministic_and_means_the_same(pattern: dict[str, Any], tmp_path: Path):
    data = BOND | {"pattern": pattern}
    first, second = build(Wall.model_validate(data)), build(Wall.model_validate(data))
    assert wall_json(first.wall) == wall_json(second.wall)
    path = tmp_path / "expanded.json"
    path.write_text(wall_json(first.wall))
    again = read_wall(path).assembly
    one = first.assembly
    for name in ("centroid", "weight", "fixed", "block_a", "block_b", "end1", "end2", "normal", "friction", "live"):
        np.testing.assert_array_equal(getattr(one, name), getattr(again, name), err_msg=name)
    assert wall_json(read_wall(path).wall) == wall_json(first.wall)


def block(name: str, polygon: list[list[float]], **more: Any) -> dict[str, Any]:
    return {"id": name, "polygon": polygon, "weight": 1.0} | more


BAD: list[tuple[str, dict[str, Any], list[str]]] = [
    ("wrong version", two_blocks(format="wall/9"), ["wall/9", "wall/1"]),
    ("unknown field", two_blocks(frction=0.4), ["frction", "friction"]),
    ("unknown block field", two_blocks(blocks=[block("a", [[0, 0], [1, 0], [1, 1]], wieght=2)]), ["wieght", '"a"']),
    ("negative weight", two_blocks(blocks=[block("a", [[0, 0], [1, 0], [1, 1]], weight=-1)]), ["weight", '"a"', "-1"]),
    ("negative friction", two_blocks(friction=-0.1), ["friction"]),
    (
        "crossing polygon",
        two_blocks(blocks=[block("bow", [[0, 0], [1, 1], [1, 0], [0, 1]]), block("f", [[0, -1], [1, -1], [1, 0]])]),
        ['"bow"', "crosses"],
    ),
    (
        "flat polygon",
        two_blocks(blocks=[block("flat", [[0, 0], [1, 0], [2, 0]], fixed=True)]),
        ['"flat"'],
    ),
    (
        "overlap",
        two_blocks(blocks=[*two_blocks()["blocks"], block("b", [[1, 0], [3, 0], [3, 1], [1, 1]])]),
        ['"a"', '"b"', "overlap"],
    ),
    (
        "floating",
        two_blocks(blocks=[*two_blocks()["blocks"], block("up", [[0, 5], [1, 5], [1, 6], [0, 6]])]),
        ['"up"', "floating"],
    ),
    (
        "corner only",
        two_blocks(blocks=[*two_blocks()["blocks"], block("tip", [[2, 1], [3, 1], [3, 2], [2, 2]])]),
        ['"tip"', "corner"],
    ),
    (
        "unknown block in a load",
        two_blocks(loads={"live": {"points": [{"block": "zz", "at": [0, 0], "force": [1, 0]}]}}),
        ['"zz"', "loads.live.points[0]"],
    ),
    ("unknown group", two_blocks(loads={"live": {"body": [{"per_weight": [1, 0], "group": "zz"}]}}), ['"zz"']),
    ("live load of nothing", two_blocks(loads={"live": {"body": [{"per_weight": [0, 0]}]}}), ["loads.live", "force"]),
    (
        "load on a list of no blocks",
        two_blocks(loads={"live": {"body": [{"per_weight": [1, 0], "blocks": []}]}}),
        ["loads.live.body[0].blocks", "0 entries"],
    ),
    ("settlement of no blocks", two_blocks(settlements=[{"blocks": [], "translation": [0, -1]}]), ["0 entries"]),
    (
        "stiffness as small as none",
        two_blocks(
            ties=[
                {"from": {"block": "base", "at": [0, 0]}, "to": {"block": "a", "at": [0, 1]}, "yield_force": 1.0}
                | {"stiffness": 1e-320}
            ]
        ),
        ["ties[0].stiffness", "as small as none", "at least 1e-100"],
    ),
    ("thickness as small as none", two_blocks(thickness=5e-324), ["thickness", "at least 1e-100"]),
    ("thickness of none", two_blocks(thickness=0.0), ["thickness", "greater than 0"]),
    ("no fixed block", two_blocks(blocks=[block("a", [[0, 0], [1, 0], [1, 1]])]), ["no block is fixed"]),
    (
        "no weight",
        two_blocks(blocks=[two_blocks()["blocks"][0], {"id": "a", "polygon": [[0, 0], [1, 0], [1, 1]]}]),
        ['"a"'],
    ),
    ("two of one id", two_blocks(blocks=two_blocks()["blocks"] * 2), ['"base"', "id"]),
    ("inset too deep", two_blocks(contact_inset={"length": 1.0}), ["inset", "base"]),
    (
        "interface to nowhere",
        two_blocks(interfaces=[{"between": ["a", "zz"], "from": [0, 0], "to": [1, 0]}]),
        ['"zz"', "interfaces[0]"],
    ),
    (
        "interface far off its blocks",
        two_blocks(interfaces=[{"between": ["base", "a"], "from": [0, 0], "to": [200, 0]}]),
        ["interfaces[0]", "base and a", "198 away", "typical size is 1.41"],
    ),
    ("no blocks", two_blocks(blocks=[]), ["blocks"]),
    ("number in quotes", two_blocks(friction="0.4"), ["friction", "number", "0.4"]),
    ("friction of a rule", two_blocks(friction={"default": -1}), ["friction.default", "-1"]),
    ("point for a polygon", two_blocks(blocks=[{"id": "a", "polygon": 3}]), ['polygon ("a")', "list", "brackets"]),
    ("pattern of no kind", two_blocks(pattern={"type": "dome"}), ["pattern", "dome", "running_bond", "ring"]),
    ("second pattern", two_blocks(pattern=[PANEL, PANEL | {"cell_length": 0}]), ["pattern[1].", "cell_length", "0"]),
    ("tolerance in words", two_blocks(interfaces={"tolerance": "fine"}), ["interfaces.tolerance", "fine"]),
    ("more than a number can be", two_blocks(unit_weight=1e200), ["unit_weight", "1e+200"]),
    (
        "more than a wall can be",
        two_blocks(pattern=BOND["pattern"] | {"count": 1000, "bricks": 1000}),
        ["100000 blocks"],
    ),
    ("not an object", [1, 2], ["object"]),  # type: ignore[list-item]
]


@pytest.mark.parametrize(("data", "words"), [item[1:] for item in BAD], ids=[item[0] for item in BAD])
def test_bad_walls_are_refused_with_the_place_and_the_reason(data: Any, words: list[str], tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(data))
    with pytest.raises(InputError) as caught:
        read_wall(path)
    message = str(caught.value)
    assert str(path) in message
    for word in words:
        assert word in message, message


@pytest.mark.parametrize(
    "text",
    ['{"a": NaN}', '{"a": Infinity}', '{"a": 1e999}', '{"a": 1, "a": 2}', "{", "[" * 100000, "1" * 5000],
)
def test_json_that_python_would_let_pass_is_refused(text: str, tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(text)
    with pytest.raises(InputError, match=r"wall\.json"):
        read_json(path)


def test_files_that_begin_with_a_byte_order_mark_are_read(tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(BOND), encoding="utf-8-sig")
    assert read_json(path) == BOND


def test_points_off_their_block_are_pointed_out():
    wall = two_blocks(
        interfaces=[{"between": ["base", "a"], "from": [0, 0], "to": [2.1, 0]}],
        loads={"live": {"points": [{"block": "a", "at": [1, 0.5], "force": [1, 0]}]}},
    )
    (sentence,) = build(Wall.model_validate(wall)).warnings
    assert "1 interface(s) end up to 0.1 away" in sentence
    assert sentence.endswith("interfaces[0] (base/a)")
    wall = two_blocks(loads={"live": {"points": [{"block": "a", "at": [1, 50], "force": [1, 0]}]}})
    (sentence,) = build(Wall.model_validate(wall)).warnings
    assert sentence.startswith('loads.live.points[0] acts 49 away from block "a"')


@pytest.mark.parametrize("size", [0.01, 1.0, 100.0])
def test_how_far_an_interface_may_end_off_its_blocks_is_a_share_of_their_size(size: float):
    """The block that is free has the area 2: .05 of the square root is .0707, and half of it .707."""
    for off, told in ((0.0707, 0), (0.0708, 1), (0.707, 1), (0.708, None)):
        wall = two_blocks(interfaces=[{"between": ["base", "a"], "from": [0, 0], "to": [size * (2 + off), 0]}])
        for block in wall["blocks"]:
            block["polygon"] = [[x * size, y * size] for x, y in block["polygon"]]
        wall["units"] = {"length": "1", "force": "1"}
        if told is None:
            with pytest.raises(InputError, match="away from one of its blocks"):
                build(Wall.model_validate(wall))
            continue
        sentences = [text for text in build(Wall.model_validate(wall)).warnings if "end up to" in text]
        assert len(sentences) == told, off


@pytest.mark.parametrize(("inset", "left"), [({"length": 0.99}, True), ({"length": 1.0}, False)])
def test_contact_points_set_in_by_half_leave_no_joint(inset: dict[str, float], left: bool):
    if left:
        assert assembly_of(two_blocks(contact_inset=inset)).length == pytest.approx([0.02])
        return
    with pytest.raises(InputError, match="leave nothing of its 2"):
        assembly_of(two_blocks(contact_inset=inset))


def test_a_joint_that_lifts_as_it_slides_gives_its_friction_beside():
    interface = {"between": ["base", "a"], "from": [0, 0], "to": [2, 0]}

    def lift(**given: Any) -> list[float]:
        return assembly_of(two_blocks(interfaces=[interface | given])).dilatancy.tolist()

    assert lift(friction=0.7, dilatancy=0.3) == [0.3]
    assert lift(friction_angle=45.0, dilatancy=0.9) == [0.9]
    for given, words in (
        ({"dilatancy": 0.1}, "beside a friction of its own"),
        ({"friction": 0.7, "friction_angle": 35.0}, "either friction or friction_angle"),
        ({"friction": 0.7, "dilatancy": 0.8}, "dilatancy"),
    ):
        with pytest.raises(ValueError, match=words):
            lift(**given)


def test_a_wall_of_another_format_is_refused_with_what_it_gives():
    for data, words in ((two_blocks(format="wall/2"), 'format is "wall/2"'), ({"blocks": []}, "it has no format")):
        with pytest.raises(InputError, match=words):
            parse_wall(data, "w")
    for data in ([], None, "wall/1"):
        with pytest.raises(InputError, match="a wall is a JSON object"):
            parse_wall(data, "w")


def test_unreadable_files_are_refused(tmp_path: Path):
    with pytest.raises(InputError, match="no such file"):
        read_json(tmp_path / "absent.json")
    (tmp_path / "binary.json").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="text in UTF-16"):
        read_json(tmp_path / "binary.json")
    with pytest.raises(InputError, match="cannot be read"):
        read_json(tmp_path)


def test_published_schema_is_the_one_of_the_code():
    published = json.loads((Path(__file__).parents[2] / "docs" / "wall-1.schema.json").read_text())
    assert published == Wall.model_json_schema(by_alias=True), "run `make schema`"


@pytest.mark.parametrize(
    ("push", "weight", "words"),
    [
        (5e-324, 20.0, "beside the dead load it is too small"),
        (1e-300, 20.0, "beside the dead load it is too small"),
        (1.0, 1e-310, "its loads are too small"),
        (1e-150, 1e-150, "it is too small"),
    ],
)
def test_loads_that_lose_digits_are_refused(push, weight, words):
    wall = BOND | {"unit_weight": weight, "loads": {"live": {"body": [{"per_weight": [push, 0]}]}}}
    with pytest.raises(InputError, match=words):
        build(Wall.model_validate(wall))


def test_small_and_large_loads_that_keep_their_digits_are_taken():
    for push, weight in ((1e-200, 20.0), (1e15, 1e-150), (1.0, 1e-250)):
        wall = BOND | {"unit_weight": weight, "loads": {"live": {"body": [{"per_weight": [push, 0]}]}}}
        assert build(Wall.model_validate(wall)).assembly.has_live_load


def test_wall_without_live_load_is_asked_only_whether_it_stands():
    assert not assembly_of(two_blocks()).has_live_load
    assert parse_wall(two_blocks(), "x").loads.live is None
