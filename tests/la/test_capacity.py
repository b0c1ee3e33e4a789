"""Capacity curves on updated geometry: closed forms of a block and a portal, views, and wrong answers rejected."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from drystone.capacity_curve import CapacityCurve, capacity
from harness.engine.settled_judge import judge_moved_collapse
from harness.model.errors import InputError
from methods.la.moved_wall import MovedWall
from methods.la.settings import SettlingSteps
from methods.la.settling import SettledUntil, settle, with_multiplier
from tests.commands import drystone as command
from tests.moving_supports import semicircle
from tests.walls import PUSH, stack, wall_data

SHARP = 1e-6
"""Of multipliers and displacements: the last step is bisected to 1e-9 sizes of a block."""


def followed(wall: drystone.Wall, **further: Any) -> CapacityCurve:
    """The curve of a wall, to zero and accepted."""
    found = capacity(wall, **further)
    assert isinstance(found, CapacityCurve), found
    assert found.accepted, found.sentence
    assert found.multiplier[-1] == pytest.approx(0.0, abs=SHARP)
    assert np.all(np.diff(found.displacement) > 0.0)
    return found


def block(width: float = 0.4, height: float = 2.0, **more: Any) -> drystone.Wall:
    return drystone.build_wall(wall_data(stack(1, width, height), 0.7, **more))


@pytest.mark.parametrize(
    ("width", "height", "way"),
    [
        (0.2814953490244013, 0.3365215900360706, -1.0),
        (1.769951842443803, 0.2518482094765901, 1.0),
        (1.2672938325877112, 0.9282728536642249, 1.0),
        (0.5443830669029606, 0.4283473286178356, -1.0),
    ],
)
def test_fall_is_proved_where_rounding_leaves_the_judge_larger_closings(width: float, height: float, way: float):
    """The judge rejected the fall of 5 of 120 random blocks: its closings took .1 to 1.1 times what the load gained."""
    push = {"live": {"body": [{"per_weight": [way, 0.0]}]}}
    wall = drystone.build_wall(wall_data(stack(1, width, height), 3.0 * width / height, loads=push))
    assert followed(wall).ultimate == pytest.approx(0.5 * width, rel=SHARP)


def portal(lintel: float) -> drystone.Wall:
    """Two columns of .4 x 2 with a lintel of this unit weight across them."""

    def box(name: str, left: float, bottom: float, right: float, top: float, **more: Any) -> dict[str, Any]:
        return {"id": name, "polygon": [[left, bottom], [right, bottom], [right, top], [left, top]], **more}

    blocks = [
        box("ground", -0.5, -0.5, 2.9, 0.0, fixed=True),
        box("left", 0.0, 0.0, 0.4, 2.0),
        box("right", 2.0, 0.0, 2.4, 2.0),
        box("lintel", 0.0, 2.0, 2.4, 2.3, unit_weight=lintel),
    ]
    content = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.9, "blocks": blocks, "loads": PUSH}
    return drystone.build_wall(content)


def test_block_follows_its_closed_form():
    """lambda = tan(alpha - theta) at u = R (sin alpha - sin(alpha - theta)), zero at u = b/2 (Heyman 1995)."""
    found = followed(block(), steps=SettlingSteps(first=0.01, longest=0.01))
    alpha, radius = np.arctan(0.2), 0.5 * np.hypot(0.4, 2.0)
    theta = abs(found.places[:, -1, 2])
    assert len(theta) > 35
    np.testing.assert_allclose(found.multiplier, np.tan(alpha - theta), atol=1e-12)
    np.testing.assert_allclose(found.displacement, radius * (np.sin(alpha) - np.sin(alpha - theta)), atol=1e-12)
    assert found.ultimate == pytest.approx(0.2, abs=SHARP)
    for share, multiplier, place in (
        (0.25, 0.149138, 0.049572),
        (0.5, 0.099020, 0.099511),
        (0.75, 0.049389, 0.149694),
    ):
        assert np.tan(alpha * (1.0 - share)) == pytest.approx(multiplier, abs=5e-7)
        assert np.interp(place, found.displacement, found.multiplier) == pytest.approx(multiplier, abs=1e-5)


@pytest.mark.parametrize("lintel", [1.0, 20.0, 400.0])
def test_portal_rocks_as_its_columns_do_whatever_its_lintel_weighs(lintel: float):
    """lambda = tan(alpha - theta), the rotation of the columns (Makris and Vassiliou 2013)."""
    found = followed(portal(lintel), block="left")
    theta = abs(found.places[:, 1, 2])
    np.testing.assert_allclose(found.places[:, 1, 2], found.places[:, 2, 2], atol=1e-12)
    np.testing.assert_allclose(found.places[:, 3, 2], 0.0, atol=1e-12)
    np.testing.assert_allclose(found.multiplier, np.tan(np.arctan(0.2) - theta), atol=1e-9)
    assert theta[-1] == pytest.approx(np.arctan(0.2), abs=SHARP)


def test_column_of_several_stones_rocks_as_one():
    one, three = (followed(drystone.build_wall(wall_data(stack(k, 0.3, 1.0 / k), 0.7))) for k in (1, 3))
    assert three.ultimate == pytest.approx(one.ultimate, abs=SHARP)
    for share in (0.3, 0.8):
        place = share * 0.15
        assert np.interp(place, *curve(three)) == pytest.approx(np.interp(place, *curve(one)), abs=1e-3)


def curve(found: CapacityCurve) -> tuple[np.ndarray, np.ndarray]:
    return found.displacement, found.multiplier


@pytest.mark.parametrize(("scale", "sign"), [(10.0, 1.0), (1.0, -1.0)])
def test_scaled_and_mirrored_walls_move_alike(scale: float, sign: float):
    push = {"live": {"body": [{"per_weight": [sign, 0]}]}}
    own, seen = followed(block()), followed(block(scale * 0.4, scale * 2.0, loads=push))
    np.testing.assert_allclose(seen.multiplier, own.multiplier, atol=1e-7)  # steps before a bisected one are rounded
    np.testing.assert_allclose(seen.displacement, scale * own.displacement, atol=1e-7 * scale)


def test_what_is_followed_no_further_is_said():
    slides = capacity(drystone.build_wall(wall_data(stack(1, 1.0, 0.2), 0.3)))
    assert isinstance(slides, CapacityCurve)
    assert "slides, which is not followed" in slides.sentence
    assert (slides.ultimate, slides.accepted) == (None, False)
    assert all(each.accepted for each in slides.judgements)
    falls = capacity(block(loads=PUSH | {"gravity": [0.3, -1.0]}))
    assert falls == "The wall falls under its dead load as drawn."
    held = capacity(block(loads={"live": {"body": [{"per_weight": [0, -1]}]}}))
    assert held == "The live load cannot make the wall collapse."


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"loads": {}}, "no live load"),
        ({"cohesion": 2.0}, "joints with cohesion"),
        ({"loads": {"live": {"points": [{"block": "1", "at": [0, 1.8], "force": [1, 0]}]}}}, "beside|not act at its"),
    ],
)
def test_walls_that_are_not_followed_are_refused(more: dict[str, Any], words: str):
    with pytest.raises(InputError, match=words):
        capacity(block(**more))


def test_walls_with_settlements_and_unknown_blocks_are_refused():
    with pytest.raises(InputError, match="settlements"):
        capacity(with_push(semicircle(0.15, 12, 0.65)))
    with pytest.raises(InputError, match='no block is called "x"'):
        capacity(block(), "x")


def with_push(wall: drystone.Wall) -> drystone.Wall:
    return drystone.build_wall(wall.document() | {"loads": PUSH})


def test_judge_rejects_what_is_no_state_of_the_way():
    wall = portal(20.0).assembly
    found = settle(MovedWall.at_rest(wall), state_of=with_multiplier)
    assert isinstance(found, SettledUntil)
    one, other = found.points[1], found.points[2]
    right: dict[str, Any] = {
        "places": one.wall.places,
        "multiplier": one.value,
        "forces": one.forces,
        "mechanism": one.mechanism,
        "tolerance": 1e-9,
    }

    def accepted(**wrong: Any) -> bool | None:
        return judge_moved_collapse(wall, **(right | wrong)).accepted

    assert accepted()
    assert accepted(mechanism=3.0 * one.mechanism)
    assert not accepted(multiplier=one.value * 1.001)
    assert not accepted(places=other.wall.places)
    assert not accepted(places=np.zeros_like(one.wall.places))
    assert not accepted(forces=other.forces)
    assert not accepted(forces=one.forces * 1.001)
    assert not accepted(mechanism=-one.mechanism)
    assert not accepted(mechanism=np.where(wall.fixed[:, None], 1.0, one.mechanism))
    slid = one.wall.places.copy()
    slid[3, 0] += 1e-3
    assert not accepted(places=slid)
    heavier = replace(wall, live=1.01 * wall.live)
    assert not judge_moved_collapse(heavier, **right).accepted


def test_command(tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(wall_data(stack(1, 0.4, 2.0), 0.7)), encoding="utf-8")
    table, chart = tmp_path / "curve.csv", tmp_path / "curve.svg"
    done = command("capacity", path, "-o", table)
    assert done.returncode == 0, done.stderr
    assert "falls to zero at the displacement 0.2 m of the live load" in done.stdout
    assert done.stdout.startswith("The multiplier, an upper bound, is 0.2 as drawn")
    assert table.read_text(encoding="utf-8") == followed(block()).as_csv()
    assert table.read_text(encoding="utf-8").startswith("displacement [m],multiplier\n0.0,")
    done = command("capacity", path, "--block", "1", "--json", "-o", chart)
    listed = json.loads(done.stdout)
    assert listed["multiplier"][0] == pytest.approx(0.2, abs=SHARP)
    assert listed["control"] == "block 1"
    assert listed["bounds_above"] is True
    assert chart.read_text(encoding="utf-8").lstrip().startswith("<?xml")
