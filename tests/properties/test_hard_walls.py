"""Walls on which methods lost digits or their way: what is right, in every view of the wall, and accepted."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from harness.engine.judge import answered
from harness.engine.symmetry import VIEWS, renumbered, turned
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method_registry import load_method
from harness.model.wall import Wall
from tests.walls import assembly, running_bond

DATA = Path(__file__).parents[1] / "data" / "walls"
ZERO = 1e-12
"""Largest multiplier that is zero to rounding; a tilt has the load unit one."""


def read(name: str) -> Assembly:
    return build(Wall.model_validate(json.loads((DATA / f"{name}.json").read_text(encoding="utf-8")))).assembly


def holds(method: str, wall: Assembly, expected: float) -> None:
    result, judgement = answered(load_method(method), wall)
    assert result.finding.has_multiplier, result.sentence
    assert judgement.accepted, judgement.sentence
    assert result.multiplier == pytest.approx(expected, rel=1e-9, abs=ZERO)


@pytest.mark.parametrize("view", ["mirrored", "renumbered", "rotated"])
@pytest.mark.parametrize(("name", "greatest"), [("friction-1-9", 3.0), ("friction-1-26", 75 / 22)])
def test_associated_maximum_of_rough_joints_is_exact_in_every_view(name: str, greatest: float, view: str):
    # Friction 1e4: a difference of shear and strength would cost four digits.
    holds("la-associated", read(name), greatest)
    holds("la-associated", VIEWS[view](read(name)), greatest)


@pytest.mark.parametrize(
    ("courses", "bricks", "friction"), [(14, 10, 0.4), (14, 10, 0.65), (15, 11, 1.0), (20, 14, 0.65)]
)
def test_associated_maximum_of_hundreds_of_joints_is_accepted(courses: int, bricks: int, friction: float):
    wall = assembly(running_bond(courses, bricks), friction)
    assert wall.n_interfaces > 400
    result, judgement = answered(load_method("la-associated"), wall)
    assert judgement.accepted, judgement.sentence
    # Dilatancy and sliding were 1e-8 to 1e-7 and the multiplier 5e-8 off.
    worst = max(value for name, value in judgement.residuals.items() if name not in ("live_work", "error"))
    assert worst <= 1e-11, result.sentence


@pytest.mark.parametrize("view", ["mirrored", "renumbered", "rotated", "scaled"])
@pytest.mark.parametrize(("name", "multiplier"), [("zero-1-8", 0.45), ("dovetail-1-21", 1.0)])
@pytest.mark.parametrize("method", ["fe", "fe-newton"])
def test_springs_reach_the_plateau_in_every_view(method: str, name: str, multiplier: float, view: str):
    holds(method, read(name), multiplier)
    holds(method, VIEWS[view](read(name)), multiplier)


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize(("name", "multiplier"), [("zero-1-8", 0.45), ("dovetail-1-21", 1.0)])
def test_springs_reach_the_plateau_in_any_numbering_at_any_angle(name: str, multiplier: float, seed: int):
    # A block without weight and one that balances on an edge: the path hung on the rounding of a pivot that is zero.
    angle = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi)
    wall = renumbered(turned(read(name), angle), seed)
    holds("fe", wall, multiplier)
    holds("fe-newton", wall, multiplier)


@pytest.mark.parametrize("name", ["leaning-live-01", "press-cube-049", "stack-smooth", "p01-overhang-6-mu010"])
@pytest.mark.parametrize("method", ["la", "fe"])
def test_wall_that_stands_and_moves_at_any_load_has_the_multiplier_zero(method: str, name: str):
    holds(method, read(name), 0.0)


@pytest.mark.parametrize(
    ("name", "greatest"),
    [
        ("p01-overhang-6-mu010", 2 / 119),
        ("p01-overhang-6-mu100", 1.0),
        ("leaning-live-0099", 1 / 900),
        ("press-cube", 51 / 49),
        ("p02-heavy-top", 0.09093387866394),
    ],
)
def test_associated_maximum_near_a_limit_is_exact(name: str, greatest: float):
    holds("la-associated", read(name), greatest)


@pytest.mark.parametrize(
    ("name", "method", "multiplier"),
    [
        ("heavy1e+10", "la", 0.5),
        ("ratio-10-9", "la", 0.375),
        ("ratio-10-9", "la-associated", 0.40625),
        ("ratio-8-34", "la", 0.375),
        ("ratio-8-34", "la-associated", 0.40625),
        ("ratio-8-34", "fe", 0.375),
    ],
)
def test_heavy_block_beside_a_wall_hides_nothing(name: str, method: str, multiplier: float):
    holds(method, read(name), multiplier)
