"""Walls whose multiplier is known in closed form or from several independent codes."""

from __future__ import annotations

import math
from typing import Any

import pytest

from benchmarks.walls import arch
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method import Finding
from harness.model.wall import Wall
from methods.fe.gap_springs import GapSprings
from methods.fe.settings import GapSpringsSettings

CLOSED_FORM = 1e-8  # what issue 5 asks of slide, overturn, incline and the arches under acceleration
POINT_LOAD = 1e-6  # of the arch under a point load, whose reference values have seven digits


def multiplier(wall: Assembly) -> float:
    """The plateau under all three histories, which must agree."""
    answer = GapSprings().solve(wall, GapSpringsSettings(histories=(0.0, 0.01, 0.002)))
    assert answer.finding is Finding.COLLAPSES
    assert answer.multiplier is not None
    assert answer.details["spread"] < CLOSED_FORM
    return answer.multiplier


def wall_of(friction: float, loads: dict[str, Any], **blocks: Any) -> Assembly:
    given = {"format": "wall/1", "unit_weight": 1.0, "friction": friction, "loads": loads}
    return build(Wall.model_validate(given | blocks)).assembly


def block_on_ground(friction: float, loads: dict[str, Any]) -> Assembly:
    """A block 2 wide and 3 high on a fixed base."""
    base = {"id": "base", "polygon": [[-1, -1], [3, -1], [3, 0], [-1, 0]], "fixed": True}
    block = {"id": "block", "polygon": [[0, 0], [2, 0], [2, 3], [0, 3]]}
    return wall_of(friction, loads, blocks=[base, block])


HORIZONTAL: dict[str, Any] = {"body": [{"per_weight": [1.0, 0.0]}]}


@pytest.mark.parametrize("friction", [1e-7, 3e-4, 0.1, 0.4, 0.6])
def test_fe_block_slides_at_its_friction(friction: float) -> None:
    wall = block_on_ground(friction, {"live": HORIZONTAL})
    assert multiplier(wall) == pytest.approx(friction, rel=CLOSED_FORM)


@pytest.mark.parametrize("friction", [0.7, 1.0, 3.0])
def test_fe_block_overturns_at_its_width_over_its_height(friction: float) -> None:
    wall = block_on_ground(friction, {"live": HORIZONTAL})
    assert multiplier(wall) == pytest.approx(2.0 / 3.0, rel=CLOSED_FORM)


@pytest.mark.parametrize(("friction", "limit"), [(0.5, 0.5), (0.9, 2.0 / 3.0)])
@pytest.mark.parametrize("degrees", [-10.0, 5.0, 20.0])
def test_fe_block_on_an_incline_under_gravity_that_leans(friction: float, limit: float, degrees: float) -> None:
    angle = math.radians(degrees)
    gravity = [math.sin(angle), -math.cos(angle)]
    wall = block_on_ground(friction, {"gravity": gravity, "live": HORIZONTAL})
    assert multiplier(wall) == pytest.approx(limit * math.cos(angle) - math.sin(angle), rel=CLOSED_FORM)


@pytest.mark.parametrize(("friction", "limit"), [(0.5, 0.5), (0.9, 2.0 / 3.0)])
def test_fe_block_on_an_incline_under_a_load_along_the_slope_and_off_it(friction: float, limit: float) -> None:
    angle = math.radians(10.0)
    gravity = [math.sin(angle), -math.cos(angle)]
    live = {"body": [{"per_weight": [math.cos(angle), math.sin(angle)]}]}
    wall = block_on_ground(friction, {"gravity": gravity, "live": live})
    assert multiplier(wall) == pytest.approx(math.tan(math.atan(limit) - angle), rel=CLOSED_FORM)


@pytest.mark.parametrize(("friction", "value"), [(0.5, 0.183154244724), (0.7, 0.239316002346), (1.0, 0.239316002346)])
def test_fe_arch_under_horizontal_acceleration(friction: float, value: float) -> None:
    assert multiplier(arch(friction)) == pytest.approx(value, rel=CLOSED_FORM)


@pytest.mark.parametrize(("friction", "value"), [(0.5, 0.918185), (0.55, 1.195236), (0.7, 1.430092)])
def test_fe_arch_under_a_point_load_in_weights_of_the_arch(friction: float, value: float) -> None:
    assert multiplier(arch(friction, point_load=True)) == pytest.approx(value, rel=POINT_LOAD)
