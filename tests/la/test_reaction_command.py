"""Settlements in a wall file, and `drystone reaction`: least and greatest reaction, judged by virtual work.

A block of width 1 on [0, a] that rests and [a, 1] that settles: W (1/2 - a)/(1 - a) to W, and from a = 1/2 on 0 to
W / (2 a) (Portioli and Cascini 2016).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from drystone.reactions import reaction_unit, reactions
from harness.engine.reaction_judge import judge_reaction
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.content import content_of
from harness.model.errors import InputError
from harness.model.reading import parse_wall
from harness.model.wall import Wall
from methods.la.core.reaction import ExtremeReaction, extreme_reaction
from tests.commands import drystone as command

DOWN = {"blocks": ["right"], "translation": [0, -1]}
WEIGHT = 20.0 * 0.2


PARTS = (0.1, 0.3, 0.45, 0.5, 0.6, 0.8)
"""Widths of the part of the base that rests; from 1/2 on the block stands on it alone."""


def extremes(part: float) -> list[float]:
    """Least and greatest reaction of the part that settles, by moments about the ends of both parts."""
    return [WEIGHT * max(0.0, (0.5 - part) / (1.0 - part)), WEIGHT * min(1.0, 0.5 / part)]


def data(*settlements: dict[str, Any], part: float = 0.3, **more: Any) -> dict[str, Any]:
    def support(name: str, left: float, right: float) -> dict[str, Any]:
        polygon = [[left, -1], [right, -1], [right, 0], [left, 0]]
        return {"id": name, "polygon": polygon, "fixed": True, "groups": ["ground"]}

    block = {"id": "block", "polygon": [[0, 0], [1, 0], [1, 0.2], [0, 0.2]], "groups": ["free"]}
    blocks = [support("left", 0.0, part), support("right", part, 1.0), block]
    wall = {"format": "wall/1", "unit_weight": 20, "friction": 0.5, "blocks": blocks, "settlements": list(settlements)}
    return wall | more


def built(*settlements: dict[str, Any], **more: Any) -> Assembly:
    return build(Wall.model_validate(data(*settlements, **more))).assembly


@pytest.mark.parametrize("part", PARTS)
def test_block_on_a_base_that_settles(part: float):
    found = reactions(drystone.build_wall(data(DOWN, part=part)))
    assert not isinstance(found, str)
    assert [each.value for each in found] == pytest.approx(extremes(part), abs=1e-9)
    assert all(each.judgement.accepted for each in found)
    assert [each.moving for each in found] == [("block",) if part < 0.5 else (), ("block",)]


def test_command_prints_both_with_their_mechanisms(tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(data(DOWN)), encoding="utf-8")
    done = command("reaction", path)
    assert done.returncode == 0, done.stderr
    assert "The least reaction is 1.142857 kN; in its mechanism move: block." in done.stdout
    assert "The greatest reaction is 4 kN;" in done.stdout
    values = json.loads(command("reaction", path, "--json").stdout)
    assert values["least"]["value"] == pytest.approx(2.0 / 7.0 * WEIGHT, rel=1e-9)
    assert values["greatest"]["judge"]["accepted"] is True


@pytest.mark.parametrize(
    ("settlement", "units", "unit"),
    [
        (DOWN, {"length": "mm", "force": "N"}, "N"),
        ({"blocks": ["right"], "rotation": -1, "about": [2, 0]}, {"length": "m", "force": "lbf"}, "lbf m"),
        ({"blocks": ["right"], "translation": [0, -1], "rotation": 0.1}, {"length": "m", "force": "kN"}, "kN"),
        (DOWN, {"length": "1", "force": "1"}, ""),
    ],
)
def test_reaction_has_the_unit_of_a_force_and_of_rotations_alone_that_of_a_moment(
    settlement: dict[str, Any], units: dict[str, str], unit: str
):
    assert reaction_unit(drystone.build_wall(data(settlement, units=units))) == unit


def test_command_refuses_a_wall_whose_supports_rest(tmp_path: Path):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(data()), encoding="utf-8")
    done = command("reaction", path)
    assert done.returncode == 2
    assert "no support with a joint, a tie or a prop moves" in done.stderr


def test_command_says_that_a_wall_falls(tmp_path: Path):
    falling = data(DOWN, loads={"gravity": [1, -1]})
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(falling), encoding="utf-8")
    done = command("reaction", path)
    assert done.returncode == 1
    assert "No equilibrium within yield exists" in done.stdout


def test_settlements_add_up_and_turn_about_their_centre():
    turn = {"group": "ground", "rotation": 2.0, "about": [0.3, 0.0]}
    wall = built(DOWN, turn)
    expected = [[1.0, 2.0 * (0.15 - 0.3), 2.0], [1.0, -1.0 + 2.0 * (0.65 - 0.3), 2.0], [0.0, 0.0, 0.0]]
    np.testing.assert_allclose(wall.support_motion, expected, atol=1e-15)
    alone = built({"blocks": ["right"], "rotation": 1.0})
    np.testing.assert_allclose(alone.support_motion[1], [0.0, 0.0, 1.0], atol=1e-15)


@pytest.mark.parametrize(
    ("unit_motion", "size"),
    [
        ({"translation": [0, -1]}, 0.01),
        ({"translation": [0.6, -0.8], "rotation": 0.5}, 25.0),
        ({"rotation": -1.0}, 0.02),
    ],
)
def test_a_settlement_is_a_direction_and_the_reaction_a_force(unit_motion: dict[str, Any], size: float):
    """A centimetre down asks what a metre down asks; that the work on a centimetre is a force was said before."""
    scaled = {name: (np.array(value) * size).tolist() for name, value in unit_motion.items()}
    one, other = (built({"blocks": ["right"], **motion}) for motion in (unit_motion, scaled))
    np.testing.assert_allclose(other.support_motion, one.support_motion, atol=1e-15)


def test_a_wall_that_settles_has_a_key_of_its_own():
    assert len({content_of(built()), content_of(built(DOWN)), content_of(built({**DOWN, "translation": [1, 0]}))}) == 3


@pytest.mark.parametrize(
    ("settlement", "words"),
    [
        ({"blocks": ["block"], "translation": [0, -1]}, 'block "block" is not fixed'),
        ({"blocks": ["nobody"], "translation": [0, -1]}, 'no block is called "nobody". Blocks of this wall: '),
        ({"group": "nobody", "translation": [0, -1]}, 'no block is in a group "nobody"'),
        ({"group": "free", "translation": [0, -1]}, 'block "block" is not fixed'),
        ({"blocks": ["right"]}, "moves nothing"),
        ({"translation": [0, -1]}, "names either blocks or a group"),
        ({"blocks": ["right"], "translation": [0, float("nan")]}, "translation"),
        ({"blocks": ["right"], "translation": [0, 1e16]}, "translation"),
    ],
)
def test_settlements_that_cannot_be_are_refused(settlement: dict[str, Any], words: str):
    with pytest.raises(InputError, match=words):
        build(parse_wall(data(settlement), "wall.json"))


@pytest.mark.parametrize("greatest", [False, True])
@pytest.mark.parametrize("strength", [{}, {"cohesion": 10.0, "tensile_strength": 1.0}])
def test_judge_accepts_the_extremes_and_rejects_what_is_wrong(greatest: bool, strength: dict[str, float]):
    wall = built(DOWN, **strength)
    found = extreme_reaction(wall, greatest)
    assert isinstance(found, ExtremeReaction)

    def accepted(reaction: float, forces: np.ndarray, mechanism: np.ndarray, way: bool = greatest) -> bool | None:
        return judge_reaction(wall, reaction, forces, mechanism, greatest=way, tolerance=1e-9).accepted

    right = (found.reaction, found.forces, found.mechanism)
    assert accepted(*right)
    other = extreme_reaction(wall, not greatest)
    assert isinstance(other, ExtremeReaction)
    assert not accepted(*right, way=not greatest)
    assert not accepted(found.reaction * 1.001, found.forces, found.mechanism)
    assert not accepted(found.reaction, other.forces, found.mechanism)
    assert not accepted(found.reaction, found.forces, other.mechanism)
    assert not accepted(found.reaction, found.forces, 2.0 * found.mechanism)
    assert not accepted(found.reaction, found.forces, np.zeros_like(found.mechanism))
