"""`la` under limits of seconds, in a process of its own as users run it: what it holds then is judged and told."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from harness.engine.isolate import run_isolated
from harness.engine.judge import judge
from harness.engine.worker import Task
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from harness.model.result import result_of
from harness.model.wall import Wall
from tests.walls import PUSH, assembly, running_bond

MEMORY = 4 << 30


def perturbed_bond(courses: int, bricks: int, amount: float = 0.03, seed: int = 1) -> Assembly:
    """Running bond whose corners are off by up to a part of the brick, with coordinates in whole millimetres."""
    length, height = 0.4, 0.2
    generator = np.random.default_rng(seed)
    x, y = np.meshgrid(0.5 * length * np.arange(2 * bricks + 1), height * np.arange(courses + 1))
    nodes = np.stack([x, y], axis=2)
    nodes[1:] += generator.uniform(-amount, amount, nodes[1:].shape) * np.array([length, height])
    nodes = nodes.round(3)
    width = bricks * length
    ground = [[-0.5, -0.3], [width + 0.5, -0.3], [width + 0.5, 0.0], [-0.5, 0.0]]
    blocks: list[dict[str, Any]] = [{"id": "ground", "polygon": ground, "fixed": True}]
    for j in range(courses):
        ends = [*range(0, 2 * bricks + 1, 2)] if j % 2 == 0 else [0, *range(1, 2 * bricks, 2), 2 * bricks]
        for a, b in pairwise(ends):
            polygon = [*nodes[j, a : b + 1].tolist(), *nodes[j + 1, a : b + 1][::-1].tolist()]
            blocks.append({"id": f"{j}.{a}", "polygon": polygon})
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.65, "blocks": blocks, "loads": PUSH}
    return build(Wall.model_validate(data), "perturbed bond").assembly


def answered_within(wall: Assembly, name: str, seconds: float) -> float:
    """The multiplier that a method has within the limit; judged, and no more said than is known."""
    result = run_isolated(Task(name, wall, {}, seconds, MEMORY), "limits").result
    assert result.status is Status.OK, result.sentence
    assert result.finding is Finding.COLLAPSES
    assert judge(wall, result, load_method(name).tolerance).accepted
    if result.details.get("stopped_by_limit"):
        assert "stopped by the time limit" in result.sentence
    assert result.multiplier is not None
    return result.multiplier


def test_associated_maximum_whose_contacts_are_not_told_apart_is_judged():
    """Slack and rate of hundreds of contacts vanish together on 462 blocks; no vertex is asked for."""
    wall, method = assembly(running_bond(28, 16, height=0.175), 0.65), load_method("la-associated")
    answer = method.solve(wall, method.Settings(solver="interior"))
    assert answer.multiplier == pytest.approx(0.474130607429087, rel=1e-12)  # of a vertex in HiGHS
    assert judge(wall, result_of(answer, wall, case="x", method="la-associated", family="la"), 1e-10).accepted


def test_230_blocks_within_four_seconds():
    # Without dilatancy no state is above the associated maximum .5032177; descents lead below .4826 in some seconds.
    assert 0.45 < answered_within(assembly(running_bond(20, 11, height=0.175), 0.65), "la", 4.0) < 0.503218


@pytest.mark.slow
@pytest.mark.parametrize("name", ["la", "la-associated"])
@pytest.mark.parametrize(
    ("wall", "seconds"),
    [
        (lambda: assembly(running_bond(30, 30, height=0.175), 0.65), 10.0),
        (lambda: assembly(running_bond(66, 55, height=0.175), 0.65), 30.0),
        (lambda: perturbed_bond(35, 20), 10.0),
        (lambda: perturbed_bond(50, 29), 10.0),
    ],
    ids=["915 blocks", "3,663 blocks", "717 perturbed", "1,475 perturbed"],
)
def test_large_walls_within_seconds(wall: Any, seconds: float, name: str):
    assert 0.0 < answered_within(wall(), name, seconds) < 0.65
