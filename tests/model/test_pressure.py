"""Pressure on faces of blocks: exact resultants, the gravity wall under water in closed form, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import drystone
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.live_load import is_horizontal, reversed_live
from harness.model.reading import parse_wall
from tests.walls import running_bond, wall_data

WATER = {"water": {"level": 3.0, "unit_weight": 9.81}}
DAM = {
    "format": "wall/1",
    "unit_weight": 22,
    "friction": 0.6,
    "blocks": [
        {"id": "rock", "polygon": [[-1, -1], [2, -1], [2, 0], [-1, 0]], "fixed": True},
        {"id": "dam", "polygon": [[0, 0], [1, 0], [1, 3], [0, 3]]},
    ],
}


def dam(*pressures: dict[str, Any], kind: str = "live", **more: Any) -> dict[str, Any]:
    upstream = [{"from": [0, 0], "to": [0, 3]} | pressure for pressure in pressures]
    return DAM | {"loads": {kind: {"pressures": upstream}}} | more


def forces(data: dict[str, Any], kind: str = "live") -> np.ndarray:
    """Force and moment about the centroid of the last block under the pressures alone."""
    loads = data["loads"] | {"gravity": False}
    return np.asarray(getattr(build(parse_wall(data | {"loads": loads}, "")).assembly, kind)[-1])


@pytest.mark.parametrize(
    ("friction", "multiplier"),
    [(0.6, 3 * 22 / (9.81 * 9)), (0.4, 2 * 0.4 * 22 / (9.81 * 3))],
    ids=["overturns", "slides"],
)
def test_gravity_wall_under_water_overturns_or_slides_as_in_closed_form(friction: float, multiplier: float):
    """3 gamma b^2/(gw h^2) and 2 mu gamma b/(gw h), b 1 and h 3."""
    result = drystone.analyse(drystone.build_wall(dam(WATER, friction=friction)), "la-associated")
    assert result.multiplier == pytest.approx(multiplier, rel=1e-9)
    assert result.judge.accepted


def test_water_above_the_wall_adds_its_pressure_at_the_top():
    higher = {"water": {"level": 5.0, "unit_weight": 9.81}}
    total, moment = 9.81 * (5**2 - 2**2) / 2, 9.81 * 3**3 / 12
    np.testing.assert_allclose(forces(dam(higher)), [total, 0.0, moment], rtol=1e-13)


def test_only_the_part_below_the_level_is_loaded_and_its_end_is_exact():
    lower = {"water": {"level": 1.7, "unit_weight": 9.81}}
    total = 9.81 * 1.7**2 / 2
    np.testing.assert_allclose(forces(dam(lower)), [total, 0.0, total * (1.5 - 1.7 / 3)], rtol=1e-13)
    upside_down = dam(lower | {"from": [0, 3], "to": [0, 0]})
    np.testing.assert_allclose(forces(upside_down), forces(dam(lower)), rtol=1e-13)
    above = dam(lower, {"uniform": 1.0}, {"water": {"level": 0.0, "unit_weight": 9.81}})
    np.testing.assert_allclose(forces(above), forces(dam(lower)) + np.array([3.0, 0.0, 0.0]), rtol=1e-13)


@pytest.mark.parametrize(
    "kind",
    [
        {"uniform": 2.0},
        {"water": {"level": 2.2, "unit_weight": 9.81}},
        {"earth": {"level": 2.5, "unit_weight": 18, "coefficient": 0.4, "surcharge": 7}},
    ],
    ids=lambda kind: next(iter(kind)),
)
def test_two_faces_have_the_resultant_of_the_one_they_are_halves_of(kind: dict[str, Any]):
    """Also where a vertex of the block splits the face, and where the segment itself is split."""
    whole = forces(dam(kind))
    halves = dam(kind | {"from": [0, 0], "to": [0, 1.5]}, kind | {"from": [0, 1.5], "to": [0, 3]})
    np.testing.assert_allclose(forces(halves), whole, rtol=1e-13, atol=1e-13)
    split = {"id": "dam", "polygon": [[0, 0], [1, 0], [1, 3], [0, 3], [0, 1.5]]}
    np.testing.assert_allclose(forces(dam(kind, blocks=[DAM["blocks"][0], split])), whole, rtol=1e-13, atol=1e-13)


def test_linear_pressure_has_its_values_at_both_ends_however_many_blocks_it_crosses():
    np.testing.assert_allclose(forces(dam({"linear": [4.0, 1.0]})), [7.5, 0.0, 3 * 9 / 12], rtol=1e-13)
    np.testing.assert_allclose(forces(dam({"linear": [3 * 9.81, 0.0]})), forces(dam(WATER)), rtol=1e-13)
    halves = [
        DAM["blocks"][0],
        {"id": "low", "polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]},
        {"id": "top", "polygon": [[0, 1], [1, 1], [1, 3], [0, 3]]},
    ]
    wall = build(parse_wall(dam({"linear": [4.0, 1.0]}, blocks=halves), "")).assembly
    np.testing.assert_allclose(wall.live[1:, 0], [3.5, 4.0], rtol=1e-13)
    about_middle = wall.live[:, 2] - (wall.centroid[:, 1] - 1.5) * wall.live[:, 0]
    assert about_middle.sum() == pytest.approx(3 * 9 / 12, rel=1e-12)


@pytest.mark.parametrize(
    ("earth", "coefficient"),
    [
        ({"friction_angle": 30.0, "state": "active"}, 1 / 3),
        ({"friction_angle": 30.0, "state": "at_rest"}, 0.5),
        ({"coefficient": 0.4}, 0.4),
    ],
)
def test_earth_presses_with_its_coefficient_and_the_surcharge_with_it_too(earth: dict[str, Any], coefficient: float):
    given = {"earth": {"level": 3.0, "unit_weight": 18.0, "surcharge": 10.0} | earth}
    total = coefficient * (18 * 3**2 / 2 + 10 * 3)
    moment = coefficient * (18 * 3**2 / 2 * 0.5)
    np.testing.assert_allclose(forces(dam(given)), [total, 0.0, moment], rtol=1e-12)


def test_earth_on_a_face_that_looks_up_rests_on_it_and_under_one_that_overhangs_does_not_lift():
    """The horizontal thrust is that on the vertical projection; the vertical one the weight above the face."""
    earth = {"earth": {"level": 3.0, "unit_weight": 18.0, "coefficient": 0.4}}
    thrust = 0.4 * 18 * 3**2 / 2
    looks_up = {"id": "dam", "polygon": [[-1, 0], [1, 0], [1, 3], [0, 3]]}
    found = forces(dam(earth | {"from": [-1, 0]}, blocks=[DAM["blocks"][0], looks_up]))
    np.testing.assert_allclose(found[:2], [thrust, -18 * 3 / 2], rtol=1e-13)
    overhangs = {"id": "dam", "polygon": [[0, 0], [1, 0], [1, 3], [-0.5, 3]]}
    found = forces(dam(earth | {"to": [-0.5, 3]}, blocks=[DAM["blocks"][0], overhangs]))
    np.testing.assert_allclose(found[:2], [thrust, 0.0], rtol=1e-13)


def test_pressure_of_all_sides_is_in_equilibrium_with_the_weight_of_the_water():
    """Archimedes: water round a block lifts it by the weight of the water in its place, at its centroid."""
    slanted = [[0.0, 0.0], [1.2, 0.3], [1.0, 2.0], [0.2, 1.7]]
    sides = [
        {"from": a, "to": b, "blocks": ["dam"]} | WATER for a, b in zip(slanted, slanted[1:] + slanted[:1], strict=True)
    ]
    data = dam(*sides, blocks=[DAM["blocks"][0], {"id": "dam", "polygon": slanted}], interfaces=[
        {"between": ["rock", "dam"], "from": [0, 0], "to": [0.4, 0.1]}
    ])  # fmt: skip
    assembly = build(parse_wall(data, "")).assembly
    lift = 9.81 / 22 * assembly.weight[1]
    np.testing.assert_allclose(assembly.live[1], [0.0, lift, 0.0], atol=1e-12 * lift)


def test_dead_pressure_adds_to_gravity_and_counts_thickness_units_and_factor():
    data = dam({"uniform": 2.0, "factor": -1.5}, kind="dead", thickness=0.5)
    assembly = build(parse_wall(data, "")).assembly
    np.testing.assert_allclose(assembly.dead[1], [-1.5 * 2 * 3 * 0.5, -22 * 3 * 0.5, 0.0], rtol=1e-13, atol=1e-12)
    kilograms = {"units": {"unit_weight": "kg/m3"}, "unit_weight": 2200}
    by_mass = dam({"water": {"level": 3.0, "unit_weight": 1000}}, **kilograms)
    np.testing.assert_allclose(forces(by_mass), forces(dam(WATER)) * 9.80665 / 9.81, rtol=1e-12)


def test_the_explicit_form_has_the_same_loads():
    """It keeps the thickness of blocks, which the pressure on their faces depends on."""
    thick = {"id": "dam", "polygon": [[0, 0], [1, 0], [1, 3], [0, 3]], "thickness": 2.5}
    built = build(parse_wall(dam(WATER, blocks=[DAM["blocks"][0], thick]), ""))
    again = build(parse_wall(built.wall.document(), ""))
    np.testing.assert_array_equal(again.assembly.live, built.assembly.live)


def test_reversed_pressure_acts_the_other_way_and_is_no_earthquake():
    case = drystone.build_wall(dam(WATER)).case
    assert not is_horizontal(case)
    np.testing.assert_array_equal(reversed_live(case).assembly.live, -case.assembly.live)


def test_a_line_of_water_loads_the_whole_side_of_a_bonded_wall():
    data = wall_data(running_bond(4, 3, 0.5, 0.25), loads={
        "live": {"pressures": [{"from": [0, 0], "to": [0, 1], "water": {"level": 1, "unit_weight": 9.81}}]}
    })  # fmt: skip
    live = build(parse_wall(data, "")).assembly.live
    assert np.count_nonzero(live[:, 0]) == 4
    np.testing.assert_allclose(live[:, 0].sum(), 9.81 / 2, rtol=1e-13)


@pytest.mark.parametrize(
    ("pressure", "said"),
    [
        ({"uniform": 1, "to": [0, 4]}, "loads.live.pressures[0]: from (0, 3) to (0, 4) it lies on no face"),
        ({"uniform": 1, "from": [0.2, 0]}, "from (0.2, 0) to (0, 3) it lies on no face"),
        ({"uniform": 1, "blocks": ["damn"]}, 'loads.live.pressures[0]: no block is called "damn"'),
        ({"uniform": 1, "blocks": ["rock"]}, 'loads.live.pressures[0]: block "rock" is fixed'),
        ({"uniform": 1, "group": "dams"}, 'loads.live.pressures[0]: no block is in a group "dams"'),
        ({"uniform": 1, "group": "a", "blocks": ["dam"]}, "either blocks or group"),
        ({"uniform": 1, "linear": [1, 2]}, "exactly one of uniform, linear, water, earth"),
        ({}, "exactly one of uniform, linear, water, earth"),
        ({"uniform": 1, "to": [0, 0]}, "different from and to"),
        ({"earth": {"level": 3, "unit_weight": 18}}, "friction_angle and state"),
        ({"earth": {"level": 3, "unit_weight": 18, "coefficient": 0.3, "state": "active"}}, "either coefficient, or"),
    ],
)
def test_what_is_wrong_with_a_pressure_is_said(pressure: dict[str, Any], said: str):
    with pytest.raises(InputError) as raised:
        build(parse_wall(dam(pressure), "dam.json"))
    assert said in str(raised.value)


def test_a_line_between_two_blocks_asks_which_one_is_meant():
    pair = [
        {"id": "rock", "polygon": [[0, -1], [2, -1], [2, 0], [0, 0]], "fixed": True},
        {"id": "left", "polygon": [[0, 0], [1, 0], [1, 1], [0, 1]]},
        {"id": "right", "polygon": [[1, 0], [2, 0], [2, 1], [1, 1]]},
    ]
    crack = {"from": [1, 0], "to": [1, 1], "uniform": 1.0}
    with pytest.raises(InputError, match=r"from \(1, 0\) to \(1, 1\) it lies on faces of two blocks"):
        build(parse_wall(dam(crack, blocks=pair), ""))
    both = dam(crack | {"blocks": ["left"]}, crack | {"blocks": ["right"]}, blocks=pair)
    assert build(parse_wall(both, "")).assembly.live[:, 0].tolist() == [0.0, -1.0, 1.0]
