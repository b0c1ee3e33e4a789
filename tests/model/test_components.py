"""A wall of independent components: each analysed alone, the least multiplier, and forces that bear it elsewhere."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import answered
from harness.engine.symmetry import beside, renumbered
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.components import components_of
from harness.model.method import Finding, load_method
from harness.model.wall import Wall
from tests.walls import assembly, stack

METHODS = ("la", "la-associated", "fe")
SHARES = (1e-12, 1e-6, 1e6, 1e12)


def square(name: str, left: float, low: float, width: float, height: float, **more: Any) -> dict[str, Any]:
    right, high = left + width, low + height
    return {"id": name, "polygon": [[left, low], [right, low], [right, high], [left, high]]} | more


def three_columns(*loads: tuple[float, float]) -> Assembly:
    """Three blocks far apart on one fixed base, half as wide as high (.5), as wide (.7: they slide), and twice."""
    blocks = [square("base", -1.0, -1.0, 20.0, 1.0, fixed=True)]
    blocks += [square(f"b{k}", 5.0 * k, 0.0, width, 1.0) for k, width in enumerate((0.5, 1.0, 2.0))]
    live = {"body": [{"blocks": [f"b{k}"], "per_weight": list(load)} for k, load in enumerate(loads)]}
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.7, "blocks": blocks, "loads": {"live": live}}
    return build(Wall.model_validate(wall)).assembly


def test_blocks_that_share_fixed_blocks_only_are_components_of_their_own():
    wall = three_columns((1.0, 0.0), (1.0, 0.0), (1.0, 0.0))
    parts = components_of(wall)
    assert [[part.assembly.block_ids[i] for i in part.assembly.free] for part in parts] == [["b0"], ["b1"], ["b2"]]
    assert sorted(np.concatenate([part.interfaces for part in parts])) == [0, 1, 2]
    for part in parts:
        assert [wall.block_ids[i] for i in part.blocks] == list(part.assembly.block_ids)
        np.testing.assert_array_equal(wall.dead[part.blocks], part.assembly.dead)


def test_wall_of_one_component_is_left_as_it_is():
    wall = assembly(stack(3))
    assert components_of(wall)[0].assembly is wall


@pytest.mark.parametrize("name", METHODS)
def test_least_component_fails_and_is_named(name: str):
    result, judgement = answered(load_method(name), three_columns((1.0, 0.0), (1.0, 0.0), (1.0, 0.0)))
    assert judgement.accepted
    assert result.multiplier == pytest.approx(0.5, rel=1e-9)
    assert "the one that fails is that of b0" in result.sentence
    assert [part["multiplier"] for part in result.details["components"]] == pytest.approx([0.5, 0.7, 0.7], rel=1e-9)
    assert result.mechanism is not None
    moving = np.abs(np.reshape(result.mechanism, (-1, 3))).max(axis=1) > 0.0
    assert list(moving) == [False, True, False, False]


@pytest.mark.parametrize("name", METHODS)
def test_component_that_bears_any_load_bears_that_of_the_one_that_fails(name: str):
    result, judgement = answered(load_method(name), three_columns((0.0, -1.0), (1.0, 0.0), (0.0, 0.0)))
    assert judgement.accepted
    assert result.multiplier == pytest.approx(0.7, rel=1e-9)
    assert [part["finding"] for part in result.details["components"]] == ["unbounded", "collapses", "stands"]


@pytest.mark.parametrize("name", METHODS)
def test_wall_falls_with_any_component(name: str):
    wall = three_columns((1.0, 0.0), (1.0, 0.0), (0.0, 0.0))
    dead = wall.dead.copy()
    dead[3, 2] = 100.0  # a couple that overturns the widest
    result, judgement = answered(load_method(name), replace(wall, dead=dead))
    assert result.finding is Finding.FALLS
    assert judgement.accepted
    assert "that of b2" in result.sentence


@pytest.mark.parametrize("name", METHODS)
def test_wall_none_of_whose_components_can_collapse_is_unbounded(name: str):
    result, _ = answered(load_method(name), three_columns((0.0, -1.0), (0.0, -1.0), (0.0, 0.0)))
    assert result.finding is Finding.UNBOUNDED
    assert "none of them fails" in result.sentence


@pytest.mark.parametrize("share", SHARES)
@pytest.mark.parametrize("name", METHODS)
def test_independent_block_of_any_weight_changes_no_multiplier(name: str, share: float):
    for wall in (assembly(stack(3)), three_columns((1.0, 0.0), (1.0, 0.1), (1.0, 0.0))):
        alone, _ = answered(load_method(name), wall)
        result, judgement = answered(load_method(name), renumbered(beside(wall, share)))
        assert judgement.accepted
        assert result.multiplier == pytest.approx(alone.multiplier, rel=1e-9)
