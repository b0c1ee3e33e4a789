"""How far supports move before a wall falls: closed forms, values of another programme, and wrong answers rejected."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from drystone.settling import SettledCollapse, settled_until_collapse
from harness.engine.settled_judge import judge_settled, judge_settled_fall
from harness.model.errors import InputError
from methods.la.moved_wall import MovedWall, support_places
from methods.la.settings import ClosureTolerances, SettlingSteps
from methods.la.settling import SettledUntil, settle
from tests.commands import drystone as command
from tests.la.test_reaction_command import DOWN, data
from tests.moving_supports import bricks, segmental, semicircle, tilted

DIGITS = 1e-7
"""Of values given with seven digits."""
SHARP = 1e-8
"""Of a displacement bisected to 1e-9 sizes of a block."""
JUDGED = 1e-9


def falls(found: SettledCollapse | str) -> SettledCollapse:
    assert isinstance(found, SettledCollapse), found
    assert found.accepted, found.sentence
    assert found.falls is not None
    assert 0.0 < found.falls - found.stands < 1e-6
    return found


@pytest.mark.parametrize(
    ("thickness", "voussoirs", "spread"),
    [(0.15, 12, 0.1410498), (0.15, 20, 0.1082019), (0.2, 12, 0.2702505), (0.2, 20, 0.3053566)],
)
def test_spread_of_a_semicircle_at_collapse(thickness: float, voussoirs: int, spread: float):
    """By another programme; the three hinges stay where they are."""
    found = falls(settled_until_collapse(semicircle(thickness, voussoirs, 0.65)))
    assert found.stands == pytest.approx(spread, abs=DIGITS)
    assert len(found.pins) == 3
    assert np.all(np.diff(found.reaction) > 0.0)


@pytest.mark.parametrize(("friction", "tangent"), [(0.9, 0.5), (0.3, 0.3)])
def test_block_on_a_base_that_turns(friction: float, tangent: float):
    """A block of 1 x 2 topples at tan(angle) = 1/2, or slides at the friction."""
    found = falls(settled_until_collapse(tilted(1.0, 2.0, friction)))
    assert found.stands == pytest.approx(np.arctan(tangent), abs=SHARP)
    assert found.pins == ()


def test_mirrored_and_scaled_arch_spreads_alike():
    wall = semicircle(0.15, 12, 0.65)
    document = wall.document(explicit=True)
    for block in document["blocks"]:
        block["polygon"] = [[-30.0 * x, 30.0 * y] for x, y in block["polygon"]]
    for interface in document.get("interfaces", []):
        for end in ("from", "to", "end1", "end2"):
            if end in interface:
                x, y = interface[end]
                interface[end] = [-30.0 * x, 30.0 * y]
    document["settlements"] = [{"blocks": ["right"], "translation": [-0.02, 0.0]}]
    found = falls(settled_until_collapse(drystone.build_wall(document)))
    assert found.stands == pytest.approx(30.0 * 0.1410498, abs=30.0 * DIGITS)


def test_arch_in_coordinates_of_a_national_grid():
    """Far from the origin the drawing has nine digits, and the spread as many."""
    spread = {"blocks": ["abutment-2"], "translation": [1, 0]}
    here, there = (falls(settled_until_collapse(segmental(0.8, spread, origin=at))) for at in ((0.0, 0.0), (5e5, 4e6)))
    assert there.stands == pytest.approx(here.stands, rel=1e-8)


@pytest.mark.parametrize("first", [0.02, 0.013, 0.031])
def test_supports_that_move_back_close_the_joints_again(first: float):
    """From a spread of .05 the right springing returns, and the arch is as it was drawn.

    Joints that meet again miss each other by rounding, which differs from one step and one machine to the next.
    """
    drawn = semicircle(0.15, 12, 0.65).assembly
    steps = SettlingSteps(first=first)
    out = settle(MovedWall.at_rest(drawn), steps)
    assert isinstance(out, SettledUntil)
    spread = next(point.wall for point in out.points if point.wall.displacement > 0.05)
    assert not spread.closed.all()
    inwards = replace(drawn, support_motion=-drawn.support_motion)
    back = settle(replace(spread, drawn=inwards, displacement=-spread.displacement), steps)
    assert isinstance(back, SettledUntil)
    returned = min((point.wall for point in back.points), key=lambda wall: abs(wall.displacement))
    assert returned.displacement == pytest.approx(0.0, abs=SHARP)
    np.testing.assert_allclose(returned.places, 0.0, atol=1e-8)
    beyond = [point.wall for point in back.points if point.wall.displacement > SHARP]
    assert beyond
    assert all((wall.gaps > -1e-9).all() for wall in beyond)


def test_supports_turn_about_their_pole():
    motion = np.array([[0.0, -2.0, 1.0], [3.0, 4.0, 0.0]])  # the pole of the first lies 2 to the right
    np.testing.assert_allclose(
        support_places(motion, 0.5 * np.pi), [[2.0, -2.0, 0.5 * np.pi], [1.5 * np.pi, 2.0 * np.pi, 0.0]], atol=1e-12
    )


def row(layout: list[str], way: list[float]) -> drystone.Wall:
    """Stones on two supports, A that stays and B that moves."""
    panel = {"type": "panel", "cell_length": 0.3, "cell_height": 0.25, "layout": layout, "fixed": "AB"}
    moves = [{"blocks": ["B"], "translation": way}]
    return drystone.build_wall(
        {"format": "wall/1", "unit_weight": 20, "friction": 0.4, "pattern": panel, "settlements": moves}
    )


@pytest.mark.parametrize(
    "wall",
    [
        drystone.build_wall(data(DOWN, part=0.6)),
        row(["abbbcd", "AAAABB"], [1.0, 0.0]),
        row(["aaabbc", "dddeee", "fgghhi", "AABBBB"], [0.5, -1.0]),
    ],
    ids=["block", "spreads", "stones behind"],
)
def test_a_wall_in_which_nothing_turns_is_followed_in_one_step(wall: drystone.Wall):
    """It took ten thousand; coordinates of 256 sizes of a block have no digits left for pins that meet to 1e-13."""
    found = settled_until_collapse(wall)
    assert isinstance(found, SettledCollapse)
    assert found.reason == "It stands as far as it was followed."
    speed = np.hypot(*wall.assembly.support_motion[:, :2].T).max()
    assert found.stands * speed == pytest.approx(SettlingSteps().far * wall.assembly.length_scale)
    assert len(found.displacement) == 2
    assert found.reaction[0] == pytest.approx(found.reaction[1])
    assert found.judgements[0].accepted, found.sentence


def test_a_step_in_which_nothing_turns_ends_where_a_joint_closes():
    """Two blocks side by side are drawn apart by .7; their supports return, and they meet."""
    drawn = row(["ab", "AB"], [-1.0, 0.0]).assembly
    start = MovedWall.at_rest(drawn)
    right = [drawn.block_ids.index(name) for name in ("b", "B")]
    places = start.places.copy()
    places[right, 0] = 0.7
    apart = replace(start, displacement=-0.7, places=places)
    found = settle(replace(apart, closed=apart.gaps < 0.5))
    assert isinstance(found, SettledUntil)
    assert [point.wall.displacement for point in found.points] == pytest.approx([-0.7, 0.0], abs=SHARP)


@pytest.mark.parametrize(("wall", "words"), [(bricks(0.65), "slides, which is not followed")])
def test_a_wall_that_slides_is_not_followed(wall: drystone.Wall, words: str):
    found = settled_until_collapse(wall)
    assert isinstance(found, SettledCollapse)
    assert (found.falls, found.accepted) == (None, False)
    assert words in found.reason
    assert found.judgements[0].accepted


def test_block_whose_pins_cannot_meet_without_sliding():
    """One corner stays, the other goes straight down: the distance of the two supports would have to change."""
    found = settled_until_collapse(drystone.build_wall(data(DOWN)))
    assert isinstance(found, SettledCollapse)
    assert found.falls is None
    assert "cannot all meet without sliding" in found.reason


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"cohesion": 10.0}, "cohesion or tensile strength"),
        ({"loads": {"dead": {"points": [{"block": "block", "at": [0.1, 0.2], "force": [0, -1]}]}}}, "at its centroid"),
        ({"compressive_strength": 400.0}, "compressive strength"),
    ],
)
def test_what_is_not_followed_is_refused(more: dict[str, Any], words: str):
    with pytest.raises(InputError, match=words):
        settled_until_collapse(drystone.build_wall(data(DOWN, **more)))


def test_a_step_that_pins_cannot_follow_is_none():
    drawn = semicircle(0.15, 12, 0.65).assembly
    start = MovedWall.at_rest(drawn)
    assert start.moved(np.zeros((drawn.n_blocks, 3)), 0.1, start.closed, ClosureTolerances()) is None


def test_judge_rejects_places_and_forces_that_are_wrong():
    wall = semicircle(0.15, 12, 0.65).assembly
    found = falls(settled_until_collapse(semicircle(0.15, 12, 0.65)))
    right: dict[str, Any] = {
        "displacement": found.stands,
        "places": found.places,
        "reaction": float(found.reaction[-1]),
        "forces": found.forces,
        "tolerance": JUDGED,
    }

    def accepted(**other: Any) -> bool | None:
        return judge_settled(wall, **(right | other)).accepted

    assert accepted()
    assert not accepted(displacement=found.stands * 1.0001)
    assert not accepted(displacement=0.0, places=np.zeros_like(found.places))
    assert not accepted(reaction=right["reaction"] * 1.0001)
    assert not accepted(places=np.nan * found.places)
    assert not accepted(forces=np.full_like(found.forces, np.inf))
    assert not accepted(displacement=np.nan)
    assert not accepted(forces=1.0001 * found.forces)
    moved = found.places.copy()
    moved[3] += [1e-5, -1e-5, 0.0]
    assert not accepted(places=moved)
    parted = found.forces.copy()
    parted[:, :2] = parted[:, :2].sum(axis=1, keepdims=True) / 2.0
    assert not accepted(forces=parted)
    assert "parted" in judge_settled(wall, **(right | {"forces": parted})).sentence


def test_judge_rejects_a_fall_that_is_none():
    wall = semicircle(0.15, 12, 0.65).assembly
    found = falls(settled_until_collapse(semicircle(0.15, 12, 0.65)))
    assert found.falls is not None
    assert found.mechanism is not None

    def accepted(mechanism: np.ndarray, displacement: float, places: np.ndarray) -> bool | None:
        return judge_settled_fall(wall, displacement, places, mechanism, JUDGED, bore=found.forces).accepted

    assert found.fallen is not None
    assert accepted(found.mechanism, found.falls, found.fallen)
    assert not accepted(-found.mechanism, found.falls, found.fallen)
    assert not accepted(np.zeros_like(found.mechanism), found.falls, found.fallen)
    assert not accepted(found.mechanism + np.array([0.0, -0.1, 0.0]), found.falls, found.fallen)
    assert not accepted(found.mechanism, found.stands, found.places)  # there it does no work yet
    assert not accepted(found.mechanism, found.falls, found.fallen + 1e-6)
    assert not accepted(found.mechanism, found.falls, np.nan * found.fallen)


def test_judge_rejects_a_fall_of_blocks_that_are_lifted_off_what_bore_them():
    """Half way to the collapse a block in the air falls as well."""
    wall = tilted(1.0, 2.0, 0.9).assembly
    found = falls(settled_until_collapse(tilted(1.0, 2.0, 0.9)))
    half = 0.5 * found.stands
    base, block = wall.block_ids.index("base"), wall.block_ids.index("block")
    turned = found.places.copy()
    turned[base] = _turned(wall.centroid[base], half)
    turned[block] = _turned(wall.centroid[block], half)
    down = np.zeros_like(turned)
    down[block, 1] = -1.0
    for height in (1e-6, 1.0):
        lifted = turned + [[0.0, height, 0.0] if k == block else [0.0] * 3 for k in range(wall.n_blocks)]
        said = judge_settled_fall(wall, half, lifted, down, JUDGED, bore=found.forces)
        assert said.accepted is False
        assert "not within 1e-09: lifted" in said.sentence


def _turned(point: np.ndarray, angle: float) -> list[float]:
    """Displacement and rotation of a point that turns clockwise about (3, 0)."""
    arm = complex(*point) - 3.0
    way = arm * np.exp(-1j * angle) - arm
    return [way.real, way.imag, -angle]


def test_command(tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(semicircle(0.15, 12, 0.65).document()), encoding="utf-8")
    table, picture = tmp_path / "way.csv", tmp_path / "way.svg"
    done = command("reaction", path, "--until-collapse", "-o", table)
    assert done.returncode == 0, done.stderr
    assert "The wall stands until its supports have moved by 0.1410498" in done.stdout
    assert " m, turning about 3 joints" in done.stdout
    ends = re.findall(r" ([0-9.e-]+) m[, ]", done.stdout)
    assert float(ends[0]) < float(ends[1])
    rows = [line.split(",") for line in table.read_text(encoding="utf-8").splitlines()]
    assert rows[0] == ["displacement [m]", "reaction [kN]"]
    assert float(rows[-1][0]) == pytest.approx(0.1410498, abs=DIGITS)
    done = command("reaction", path, "--until-collapse", "--json", "-o", picture)
    listed = json.loads(done.stdout)
    assert listed["stands"] == pytest.approx(0.1410498, abs=DIGITS)
    assert [each["accepted"] for each in listed["judge"]] == [True, True]
    assert picture.read_text(encoding="utf-8").lstrip().startswith("<?xml")
