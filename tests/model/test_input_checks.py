"""What people mean and do not write: gravity, units, angles; a slip is told in a warning or refused with the remedy."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import answered
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.method_registry import load_method
from harness.model.reading import parse_wall, wall_json
from harness.model.units import KILONEWTONS, METRES, unit_weight_in_kn_m3
from harness.model.wall import Wall

GROUND = {"id": "ground", "polygon": [[-1, -1], [3, -1], [3, 0], [-1, 0]], "fixed": True}
PUSH = {"body": [{"per_weight": [1, 0]}]}


def data(**changes: Any) -> dict[str, Any]:
    """A block of 2 x 1 on the ground, pushed."""
    block = {"id": "a", "polygon": [[0, 0], [2, 0], [2, 1], [0, 1]]}
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.5, "blocks": [GROUND, block]}
    return {**wall, "loads": {"live": PUSH}, **changes}


def scaled(wall: dict[str, Any], factor: float) -> dict[str, Any]:
    """The same wall with its coordinates in another unit of length."""
    blocks = [block | {"polygon": [[x * factor, y * factor] for x, y in block["polygon"]]} for block in wall["blocks"]]
    return wall | {"blocks": blocks}


def dead_of(**loads: Any) -> list[float]:
    return build(Wall.model_validate(data(loads={"live": PUSH} | loads))).assembly.dead[1].tolist()


def warnings_of(wall: dict[str, Any]) -> list[str]:
    return list(build(parse_wall(wall, "w")).warnings)


def test_a_dead_point_load_leaves_gravity_where_it_is():
    point = {"points": [{"block": "a", "at": [1, 1], "force": [0, -5]}]}
    assert dead_of(dead=point) == [0.0, -45.0, 0.0]
    assert dead_of(dead=point, gravity=True) == [0.0, -45.0, 0.0]


@pytest.mark.parametrize(
    ("gravity", "force"),
    [(None, [0.0, -40.0]), (True, [0.0, -40.0]), (False, [0.0, 0.0]), ([0.5, -0.5], [20.0, -20.0])],
)
def test_gravity_is_there_unless_it_is_switched_off_or_turned(gravity: Any, force: list[float]):
    assert dead_of(**({} if gravity is None else {"gravity": gravity}))[:2] == force


def test_gravity_is_a_switch_or_a_direction_and_nothing_else():
    for wrong in (1, "down", {"x": 0}, [0], [0, -1, 0]):
        with pytest.raises(InputError, match="gravity"):
            parse_wall(data(loads={"gravity": wrong, "live": PUSH}), "w")


@pytest.mark.parametrize(
    "body",
    [
        [{"per_weight": [0, -1]}],
        [{"per_weight": [0.1, -0.99]}],
        [{"per_weight": [0, -1], "blocks": ["a"]}],
        [{"per_weight": [0, -0.5]}, {"per_weight": [0, -0.5], "blocks": ["a"]}],
    ],
)
def test_an_old_file_whose_dead_load_repeats_gravity_is_refused_with_both_ways_to_mend_it(body: list[Any]):
    with pytest.raises(InputError, match=r'"gravity": false.*or true'):
        dead_of(dead={"body": body})
    own = -sum(40.0 * part["per_weight"][1] for part in body)
    assert dead_of(dead={"body": body}, gravity=False)[1] == pytest.approx(-own)
    assert dead_of(dead={"body": body}, gravity=True)[1] == pytest.approx(-own - 40.0)


def test_a_dead_load_on_some_blocks_or_sideways_is_no_gravity():
    block = {"id": "b", "polygon": [[2, 0], [3, 0], [3, 1], [2, 1]]}
    blocks = [*data()["blocks"], block]
    built = build(
        Wall.model_validate(data(blocks=blocks, loads={"dead": {"body": [{"per_weight": [0, -1], "blocks": ["b"]}]}}))
    )
    assert built.assembly.dead[:, 1].tolist() == [0.0, -40.0, -40.0]
    assert dead_of(dead={"body": [{"per_weight": [0.25, 0]}]}) == [10.0, -40.0, 0.0]


def test_an_expanded_wall_keeps_its_gravity_and_its_units():
    dead = {"body": [{"per_weight": [0, -1]}]}
    given = data(loads={"gravity": True, "dead": dead, "live": PUSH}, units={"length": "m", "force": "kN"})
    first = build(parse_wall(given, "w"))
    again = build(parse_wall(json.loads(wall_json(first.wall)), "w"))
    np.testing.assert_array_equal(first.assembly.dead, again.assembly.dead)
    assert again.wall.units_declared
    assert again.wall.units_sentence == "length m, force kN"
    assert "assumed: the file declares none" in build(parse_wall(data(), "w")).wall.units_sentence


@pytest.mark.parametrize("length", METRES)
@pytest.mark.parametrize("force", KILONEWTONS)
def test_one_wall_in_any_units_weighs_the_same_and_collapses_at_the_same_multiplier(length: str, force: str):
    units = {"length": length, "force": force, "unit_weight": "kN/m3"}
    built = build(parse_wall(scaled(data(units=units), 1.0 / METRES[length]), "w"))
    assert built.warnings == ()
    assert built.assembly.weight[1] * KILONEWTONS[force] == pytest.approx(40.0, rel=1e-12)
    if (length, force) in (("mm", "N"), ("ft", "lbf"), ("m", "kN")):
        result, judgement = answered(load_method("la"), built.assembly)
        assert judgement.accepted
        assert result.multiplier == pytest.approx(0.5, rel=1e-9)  # it slides at its friction


@pytest.mark.parametrize(
    ("unit", "value"),
    [("kN/m3", 1.0), ("N/mm3", 1e6), ("kg/m^3", 0.00980665), ("t/m³", 9.80665), ("lbf/ft3", 0.157087)],
)
def test_units_of_weight(unit: str, value: float):
    assert unit_weight_in_kn_m3(unit) == pytest.approx(value, rel=1e-5)


@pytest.mark.parametrize(
    "units", [{"length": "furlong"}, {"unit_weight": "kN"}, {"force": "1", "unit_weight": "kN/m3"}]
)
def test_unknown_units_are_refused(units: dict[str, str]):
    with pytest.raises(InputError, match="units"):
        parse_wall(data(units=units), "w")


def test_density_in_kilograms_is_weight():
    built = build(parse_wall(data(unit_weight=2000.0, units={"unit_weight": "kg/m3"}), "w"))
    assert built.assembly.weight[1] == pytest.approx(2000.0 * 2.0 * 0.00980665)
    assert built.warnings == ()


def test_a_friction_angle_is_an_angle_wherever_friction_may_stand():
    tangent = float(np.tan(np.radians(33.0)))
    plain = {key: value for key, value in data().items() if key != "friction"}
    interface = {"between": ["ground", "a"], "from": [0, 0], "to": [2, 0], "friction_angle": 33.0}
    for wall in (
        plain | {"friction_angle": 33.0},
        plain | {"friction": {"friction_angle": 33.0}},
        plain | {"friction": {"default": 0.1, "rules": [{"joint": "bed", "friction_angle": 33.0}]}},
        data(interfaces=[interface]),
    ):
        assert build(parse_wall(wall, "w")).assembly.friction.tolist() == [tangent]
        assert warnings_of(wall) == []
    for wrong in (plain, data(friction_angle=33.0), plain | {"friction_angle": 90.0}):
        with pytest.raises(InputError, match="friction"):
            parse_wall(wrong, "w")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"friction": 33.0}, ["an angle? 33 degrees is .649", '"friction_angle": 33']),
        ({"friction": {"default": 0.5, "rules": [{"joint": "bed", "value": 31}]}}, ["friction is 31", ".601"]),
        ({"unit_weight": 2000.0}, ["2000 kN/m3", '"unit_weight": "kg/m3"']),
        ({"unit_weight": 0.3}, ["0.3 kN/m3", "5 to 35"]),
        ({"units": {"length": "mm"}}, ["20 kN/mm3", "2e+10 kN/m3", '"unit_weight": "kN/m3"']),
        ({"units": {"length": "km", "unit_weight": "kN/m3"}}, ["2 km across"]),
        (
            {"friction": {"default": 0.5, "rules": [{"joint": "hed", "value": 0.3}]}},
            ["rules[0]", "does nothing", '"head"'],
        ),
        (
            {"loads": {"live": {"points": [{"block": "a", "at": [0, 1], "force": [1e-6, 0]}]}}},
            ["the live load is 2e-08 of the dead load"],
        ),
    ],
)
def test_a_slip_is_told_with_the_remedy(changes: dict[str, Any], words: list[str]):
    told = " / ".join(warnings_of(data(**changes)))
    for word in words:
        assert word in told


@pytest.mark.parametrize(
    ("rule", "idle"),
    [
        ({"joint": "bed"}, False),
        ({"joint": "head"}, True),
        ({"materials": ["stone", "stone"]}, False),
        ({"materials": ["stone", "brick"]}, True),
        ({"between": ["a", "ground"]}, False),
        ({"between": ["b", "ground"]}, False),
        ({"between": ["a", "b"]}, True),
    ],
)
def test_a_rule_that_no_joint_meets_is_told_and_any_other_is_not(rule: dict[str, Any], idle: bool):
    """Stones a and b stand apart on a ground of stone, and a brick on sand."""
    apart = [
        {"id": "b", "polygon": [[5, 0], [6, 0], [6, 1], [5, 1]]},
        {"id": "c", "polygon": [[8, 0], [9, 0], [9, 1], [8, 1]], "material": "brick"},
        {"id": "sand", "polygon": [[7, -1], [10, -1], [10, 0], [7, 0]], "material": "sand", "fixed": True},
    ]
    ground = GROUND | {"polygon": [[-1, -1], [6.5, -1], [6.5, 0], [-1, 0]]}
    wall = data(
        blocks=[ground, data()["blocks"][1], *apart], friction={"default": 0.5, "rules": [rule | {"value": 0.3}]}
    )
    told = [text for text in warnings_of(wall) if "friction.rules[0]" in text]
    assert bool(told) is idle
    assert all("no interface is of this kind, so the rule does nothing" in text for text in told)


def test_a_wall_eight_kilometres_high_and_a_block_too_small_to_see_are_told():
    tall = scaled(data(units={"length": "m"}), 4000.0)
    assert "8 km across (8000 m)" in " ".join(warnings_of(tall))
    crumb = {"id": "crumb", "polygon": [[2.5, 0], [2.501, 0], [2.501, 0.001], [2.5, 0.001]]}
    assert "crumb" in " ".join(warnings_of(data(blocks=[*data()["blocks"], crumb])))


def test_a_thickness_in_another_unit_of_length_is_told():
    told = warnings_of(data(units={"length": "mm", "force": "kN"}, thickness=0.5))
    assert any('block "a": the thickness is 0.5 mm: the unit of length?' in text for text in told)
    assert any("the thickness is 400 m" in text for text in warnings_of(data(thickness=400)))
    assert not any("thickness" in text for text in warnings_of(data(thickness=0.01)))


def test_a_plain_wall_and_one_that_never_slides_and_one_without_units_are_not_doubted():
    assert warnings_of(data()) == []
    assert warnings_of(data(friction=1000.0)) == []
    assert warnings_of(data(unit_weight=1.0, units={"length": "1", "force": "1"})) == []


@pytest.mark.parametrize(
    "pattern",
    [
        {"type": "running_bond", "block_length": 1, "block_height": 1, "courses": []},
        {"type": "panel", "cell_length": 1e-9, "cell_height": 1e15, "layout": ["a", "#"], "fixed": "#"},
        {"type": "stack", "width": 1, "height": 1, "count": 3, "origin": [1e15, 0]},
        {"type": "stack", "width": 1, "height": 1, "count": 1, "prefix": "x" * 200},
        {"type": "ring", "inner_radius": 1e15, "outer_radius": 1.0000001e15, "count": 3},
    ],
)
def test_a_pattern_that_makes_no_block_one_can_have_is_refused(pattern: dict[str, Any]):
    with pytest.raises(InputError, match=r"pattern|prefix|origin|polygon"):
        build(parse_wall({"format": "wall/1", "unit_weight": 20, "friction": 0.5, "pattern": pattern}, "w"))


def test_the_limit_of_blocks_holds_for_the_whole_wall_before_any_is_made():
    """Thousand patterns of 100,000 blocks each: refused at once, where making them would take minutes and gigabytes."""
    pattern = [
        {"type": "stack", "width": 1, "height": 1, "count": 100_000, "prefix": f"{k}-", "origin": [2 * k, 0]}
        for k in range(1000)
    ]
    with pytest.raises(InputError, match="100,001,000 blocks"):
        build(parse_wall({"format": "wall/1", "unit_weight": 20, "friction": 0.5, "pattern": pattern}, "w"))


def test_all_faults_of_blocks_are_told_at_once():
    blocks = [
        GROUND,
        {"id": "a", "polygon": [[0, 0], [1, 1], [1, 0], [0, 1]]},
        {"id": "b", "polygon": [[1, 0], [1, 0], [1, 0]]},
    ]
    with pytest.raises(InputError) as caught:
        build(parse_wall(data(blocks=blocks), "w"))
    assert [fault.element for fault in caught.value.faults] == ['block "a"', 'block "b"']
    loads = {"live": {"points": [{"block": name, "at": [0, 0], "force": [1, 0]} for name in ("y", "z")]}}
    with pytest.raises(InputError) as caught:
        build(parse_wall(data(loads=loads), "w"))
    assert [fault.element for fault in caught.value.faults] == ["loads.live.points[0]", "loads.live.points[1]"]


@pytest.mark.parametrize("gravity", [9.81, "down"])
def test_gravity_that_is_no_vector_is_refused_with_what_it_may_be(gravity: Any):
    with pytest.raises(InputError, match=r"gravity is \[x, y\], a multiple of the weight"):
        parse_wall(data(loads={"gravity": gravity}), "")


@pytest.mark.parametrize("gravity", [[0, -9.81], [0, -9.8], [0.5, -9.81]])
def test_an_acceleration_as_gravity_is_told(gravity: list[float]):
    found = warnings_of(data(loads={"gravity": gravity, "live": PUSH}))
    assert any("loads.gravity is 9.8" in text and "an acceleration?" in text for text in found)
    assert not warnings_of(data(loads={"gravity": [0.1, -1.35], "live": PUSH}))


def test_a_unit_weight_or_an_angle_of_a_load_in_another_unit_is_told():
    face = {"from": [0, 0], "to": [0, 1]}

    def told(**load: Any) -> list[str]:
        return warnings_of(data(loads={"dead": load, "live": PUSH}))

    def earth(**changes: Any) -> dict[str, Any]:
        field = {"level": 1, "unit_weight": 18, "friction_angle": 30, "state": "active"} | changes
        return {"pressures": [face | {"earth": field}]}

    def fill(**changes: Any) -> dict[str, Any]:
        return {"fills": [{"level": 2, "unit_weight": 16} | changes]}

    def water(unit_weight: float) -> dict[str, Any]:
        return {"pressures": [face | {"water": {"level": 1, "unit_weight": unit_weight}}]}

    assert not [*told(**earth()), *told(**fill()), *told(**water(9.81)), *told(**water(0.0))]
    assert told(**water(9810)) == [
        "loads.dead.pressures[0] has a unit weight of 9810 kN/m3, and not 0.1 to 35 kN/m3: the unit?"
    ]
    assert "has a unit weight of 1800 kN/m3" in "".join(told(**earth(unit_weight=1800)))
    assert "loads.dead.fills[0] has a unit weight of 0.016 kN/m3" in "".join(told(**fill(unit_weight=0.016)))
    assert "a friction_angle of 0.52 degrees" in "".join(told(**earth(friction_angle=0.52)))
    passive = {"mobilised": 0.5, "friction_angle": 0.52}
    assert "a friction_angle of 0.52 degrees" in "".join(told(**fill(passive=passive)))


def test_water_or_earth_that_lies_below_its_face_is_told():
    face = {"from": [0, 0.5], "to": [0, 1]}
    water, earth = {"level": 0.5, "unit_weight": 9.81}, {"level": 0.6, "unit_weight": 18, "coefficient": 0.4}
    low, high = [face | {"water": water}], [face | {"earth": earth}]
    told = warnings_of(data(loads={"live": PUSH, "dead": {"pressures": [*low, *high]}}))
    assert told == ["loads.dead.pressures[0] lies nowhere below its level 0.5, so it does nothing"]


@pytest.mark.parametrize(("yield_force", "told"), [(4e5, False), (4e7, True)])
def test_a_tie_that_never_yields_is_told(yield_force: float, told: bool):
    """The block weighs 40: beyond 1e5 times the dead load the judge cannot tell rounding from the work of a tie."""
    tie = {"from": {"block": "ground", "at": [-1, 0]}, "to": {"block": "a", "at": [0, 1]}, "yield_force": yield_force}
    found = warnings_of(data(ties=[tie]))
    assert (
        found
        == [
            "tie 1: bears up to 1e+06 times the dead load, and methods may find no answer beyond 100000 "
            "times: give what it can bear"
        ]
        * told
    )


@pytest.mark.parametrize(
    ("strength", "units", "said"),
    [
        ({"compressive_strength": 5}, {}, "is 5 kN/m2 in 1 of 1 interfaces, and masonry has 100 to 500000 kN/m2: "),
        ({"compressive_strength": 5}, {}, "if it is meant in N/mm2, write 5000"),
        (
            {"compressive_strength": 0.005},
            {"length": "mm", "force": "N"},
            "masonry has 0.1 to 500 N/mm2: the unit?",
        ),
        (
            {"cohesion": 2e5, "tensile_strength": 1e5},
            {},
            "the cohesion is 200000 kN/m2 in 1 of 1 interfaces, and masonry",
        ),
        ({"cohesion": 2e5, "tensile_strength": 1e5}, {}, "the tensile strength is 100000 kN/m2"),
    ],
)
def test_a_strength_that_no_masonry_has_is_told(strength: dict[str, Any], units: dict[str, str], said: str):
    """A wall whose joints crush under its own weight falls, and nothing said that 5 kN/m2 were meant as N/mm2."""
    wall = data(**strength) | ({"units": units, "unit_weight": 2e-5} if units else {})
    assert any(said in sentence for sentence in warnings_of(scaled(wall, 1000.0) if units else wall))


@pytest.mark.parametrize(
    ("strength", "units"),
    [
        ({"compressive_strength": 5000}, {"length": "m", "force": "kN"}),
        ({"compressive_strength": 5}, {"length": "mm", "force": "N", "unit_weight": "kN/m3"}),
        ({"compressive_strength": 5}, {"length": "1", "force": "1"}),
        ({"cohesion": 100, "tensile_strength": 50}, {"length": "m", "force": "kN"}),
    ],
)
def test_a_strength_of_masonry_and_one_without_units_are_not(strength: dict[str, Any], units: dict[str, str]):
    wall = scaled(data(**strength, units=units), 1000.0 if units["length"] == "mm" else 1.0)
    assert not any("strength" in sentence or "cohesion" in sentence for sentence in warnings_of(wall))
