"""What the judge finds in answers of walls with ties and props."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import judge
from harness.model.assembly import Assembly
from harness.model.details import BAR_FORCES
from harness.model.method import Finding
from harness.model.result import Judgement, Result
from tests.tied_walls import BLOCK, EXACT, SIDE, asked, bar, block, built, tied


def said_of(wall: Assembly, result: Result, **details: Any) -> Judgement:
    """What the judge says of a result with other details."""
    changed = {name: value for name, value in (result.details | details).items() if value is not None}
    return judge(wall, result.model_copy(update={"details": changed}), EXACT)


def test_judge_asks_for_the_tensions():
    wall = tied(2.0)
    result = asked("la", wall)
    for wrong in (None, [], [2.0, 2.0], [float("nan")], "much"):
        assert said_of(wall, result, **{BAR_FORCES: wrong}).accepted is False


def test_judge_finds_tensions_out_of_balance_and_beyond_yield():
    wall = tied(2.0)
    result = asked("la", wall)
    lower = said_of(wall, result, **{BAR_FORCES: [1.9]})
    assert lower.residuals["equilibrium"] > 1e-3
    assert lower.residuals["bars"] > 1e-3
    weaker = replace(wall, bars=replace(wall.bars, greatest=np.array([1.9])))
    beyond = judge(weaker, result, EXACT)
    assert beyond.residuals["equilibrium"] < EXACT
    assert beyond.residuals["bars"] == pytest.approx(0.1 / 16.0, rel=0.5)  # over what acts on the block
    stronger = replace(wall, bars=replace(wall.bars, greatest=np.array([3.0])))
    early = judge(stronger, result, EXACT)
    assert early.residuals["bars"] > 1e-2  # it lengthens below its yield force
    assert early.residuals["virtual_work"] > 1e-2


def test_judge_refuses_tensions_whose_sums_are_lost():
    """Beyond 1e100, as of forces: sums of products of greater numbers need not be finite."""
    wall = tied(1.0)
    said = said_of(wall, asked("la", wall), bar_forces=[1e308])
    assert said.accepted is False
    assert "larger than 1e+100" in said.sentence


def test_judge_counts_what_ties_take_of_a_fall():
    """The dead load pushes the block over unless the tie bears it: a fall at T_y = 1, none at 3."""
    push = {"dead": {"points": [{"block": "block", "at": [0.0, 1.8], "force": [4.0, 0.0]}]}}
    for force, finding in ((1.0, Finding.FALLS), (3.0, Finding.STANDS)):
        wall = built(block(loads=push, ties=[bar(("left", SIDE), ("block", BLOCK), force)]))
        assert asked("la", wall).finding is finding
    weak = built(block(loads=push, ties=[bar(("left", SIDE), ("block", BLOCK), 1.0)]))
    fallen = asked("la", weak)
    strong = replace(weak, bars=replace(weak.bars, greatest=np.array([3.0])))
    assert judge(strong, fallen, EXACT).accepted is False
