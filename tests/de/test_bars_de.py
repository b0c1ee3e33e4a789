"""`de` on walls with ties, props and passive fill: closed forms, the range of a bar, and who refuses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from harness.engine.judge import answered
from harness.model.assembly import Assembly
from harness.model.bars import bar_tensions, with_bars_as_joints
from harness.model.case import case_folders, read_case, shipped_cases
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method
from harness.model.result import Result
from methods.de.engines.mass_scaling import courses, insertion_orders, tunings
from methods.de.engines.sequential_impulses import SequentialImpulses
from methods.de.holds.motion import by_power
from methods.de.settings import HoldSettings
from tests.tied_walls import BLOCK, SIDE, bar, block, built, tied

STATED = 5e-3
FORCES = 1e-6
"""Tolerance of the judge for forces held."""


def found(wall: Assembly, **settings: Any) -> Result:
    """The answer of `de`, which the judge accepts."""
    result, judgement = answered(load_method("de"), wall, **settings)
    assert judgement.accepted, (result.sentence, judgement.sentence)
    return result


def library(name: str) -> Assembly:
    return read_case(case_folders([shipped_cases()])[name]).assembly


def holds(result: Result, exact: float) -> bool:
    """Whether a closed form lies in the bracket, whose middle is as near as `de` states."""
    assert result.bracket is not None
    assert result.multiplier == pytest.approx(exact, rel=STATED)
    return result.bracket[0] <= exact * (1.0 + FORCES) and exact * (1.0 - FORCES) <= result.bracket[1]


@pytest.mark.parametrize("prestress", [0.0, 1.0])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_block_held_by_a_tie_topples_at_its_yield_force(prestress: float, side: float):
    """b/h + 2 T_y z / (W h) = .425 (moments about the edge), pushed to either side by a tie on the other."""
    if side > 0.0:
        ties = [bar(("left", SIDE), ("block", BLOCK), 2.0, prestress=prestress)]
    else:
        ties = [bar(("block", [0.4, 1.8]), ("right", [1.0, 1.8]), 2.0, prestress=prestress)]
    push = {"live": {"body": [{"per_weight": [side, 0]}]}}
    wall = built(block(ties=ties, loads=push))
    result = found(wall)
    assert holds(result, 0.425)
    tensions = bar_tensions(wall, result)
    assert tensions is not None
    assert tensions[0] == pytest.approx(2.0, rel=STATED)


def test_block_held_by_a_prop():
    wall = built(block(props=[bar(("right", [1.0, 1.8]), ("block", [0.4, 1.8]), 2.0)]))
    assert holds(found(wall), 0.425)


def test_tie_on_the_side_that_shortens_goes_slack():
    wall = built(block(ties=[bar(("block", [0.4, 1.8]), ("right", [1.0, 1.8]), 2.0)]))
    assert holds(found(wall), 0.2)


def test_passive_fill():
    """mu + m K_p gamma h^2 / (2 W) = .50375 (Rankine)."""
    assert holds(found(library("passive-block")), 0.50375)


@pytest.mark.parametrize(("name", "finding"), [("tied-arch-stands", "stands"), ("tied-arch-falls", "falls")])
def test_arch_on_rollers_stands_where_its_tie_bears_the_least_thrust(name: str, finding: str):
    assert found(library(name)).finding == Finding(finding)


def test_bars_bear_their_range_and_no_more():
    """A tie whose block is pulled off and let go again: its tension stays from its prestress on to its yield force."""
    wall = tied(2.0, prestress=0.5)
    rows = with_bars_as_joints(wall)
    course = courses(rows)
    _, blocks, joints = insertion_orders(rows, course, 1, 0)[0]
    engine = SequentialImpulses(rows, blocks, joints, HoldSettings().iterations, tunings(course, None)[0])
    seen = []
    for multiplier in (0.0, 0.3, 5.0, -0.3):
        engine.load(multiplier)
        engine.advance(300)
        forces = engine.contact_forces()
        assert rows.law.slacks(forces).min() > -1e-12 * rows.force_scale
        assert not forces[-1, :2].any()  # no normal force in a bar
        seen.append(float(wall.bars.prestress[0] - forces[-1, 2]))
    assert max(seen) == pytest.approx(2.0, rel=1e-12)
    assert min(seen) == pytest.approx(float(wall.bars.prestress[0] + wall.bars.least[0]), abs=1e-12)
    assert np.ptp(seen) > 0.0


def test_pymunk_has_no_bars_and_says_so():
    result, _ = answered(load_method("de"), tied(2.0), engine="pymunk")
    assert result.status is Status.REFUSED
    assert "take the engine 'sweeps'" in result.sentence


@pytest.mark.parametrize(("beyond", "moves"), [(1.0, False), (1.9, False), (2.1, True)])
@pytest.mark.parametrize("tension", [0.0, 1.0, 2.0])
def test_tie_that_does_not_yield_yet_may_bear_more(beyond: float, moves: bool, tension: float):
    """Measured at less than its yield force 2, a tie still bears up to it: the loads must beat friction and 2."""
    wall = with_bars_as_joints(built(block(ties=[bar(("left", SIDE), ("block", BLOCK), 2.0)])))
    own, slide = int(wall.free[0]), np.zeros((wall.n_blocks, 3))
    slide[own, 0] = 1.0
    forces = np.zeros((len(wall.is_bar), 3))
    forces[~wall.is_bar, :2] = 0.5 * float(wall.weight[own]) / np.count_nonzero(~wall.is_bar)
    forces[wall.is_bar, 2] = -tension
    load = wall.dead.copy()
    load[own, 0] += float(wall.friction[0] * wall.weight[own]) + beyond
    assert (by_power(wall, load, slide, forces) is not None) == moves
