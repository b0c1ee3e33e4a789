"""Ties and props on gap springs: collapse as by limit analysis, forces before it by stiffness, all judged."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import answered
from harness.engine.symmetry import VIEWS
from harness.model.assembly import Assembly
from harness.model.bars import path_column
from harness.model.details import BAR_FORCES
from harness.model.load_steps import LoadSteps
from harness.model.method import Finding
from harness.model.method_registry import load_method
from harness.model.result import Result
from tests.tied_walls import BLOCK, PRINTED, SIDE, arch, bar, block, built, random_wall, tied
from tests.walls import assembly, stack

SOFT = {"stiffness": 1.0}
"""A tie under which the block turns by far more than its joints give."""
EXACT = 1e-9
"""Relative accuracy of a plateau."""
NEWTON = ("fe", "fe-newton")


def found(wall: Assembly, name: str = "fe", **settings: Any) -> Result:
    """The answer of a method, which the judge accepts."""
    result, judgement = answered(load_method(name), wall, **settings)
    assert judgement.accepted, (result.sentence, judgement.sentence)
    return result


@pytest.mark.parametrize("name", NEWTON)
@pytest.mark.parametrize("stiffness", [{}, {"stiffness": 10.0}, {"stiffness": 1e6}])
def test_tied_block_topples_when_its_tie_yields_however_stiff_it_is(name: str, stiffness: dict[str, float]):
    """lambda = b/h + 2 T_y z/(W h) = .425."""
    result = found(tied(2.0, **stiffness), name)
    assert result.multiplier == pytest.approx(0.425, rel=EXACT)
    assert result.details[BAR_FORCES] == pytest.approx([2.0], rel=EXACT)


@pytest.mark.parametrize("name", [*NEWTON, "fe-qp"])
def test_bars_on_the_wrong_side_bear_nothing(name: str):
    near = 1e-3 if name == "fe-qp" else EXACT
    for kind, start, end in (
        ("props", ("left", SIDE), ("block", BLOCK)),
        ("ties", ("right", [1.0, 1.8]), ("block", [0.4, 1.8])),
    ):
        idle = found(built(block(**{kind: [bar(start, end, 2.0)]})), name)
        assert idle.multiplier == pytest.approx(0.2, rel=near)
        assert idle.details[BAR_FORCES] == pytest.approx([0.0], abs=1e-9)
    pushed = found(built(block(props=[bar(("right", [1.0, 1.8]), ("block", [0.4, 1.8]), 2.0)])), name)
    assert pushed.multiplier == pytest.approx(0.425, rel=near)


@pytest.mark.parametrize("prestress", [0.0, 0.5])
def test_path_shows_the_force_of_a_tie_grow_as_moments_say(prestress: float):
    """Once its heel has left the ground the block stands on its toe: T = (lambda - b/h) W h/(2 z) at every point."""
    ties = [bar(("left", [-0.6, z]), ("block", [0.0, z]), 1.0, prestress=prestress, stiffness=5.0) for z in (1.8, 0.9)]
    result = found(built(block(ties=ties)), normal_stiffness=1e7)
    upper, lower = (np.array(result.path[path_column(f"tie {k}")]) for k in (1, 2))
    multiplier = np.array(result.path["multiplier"])
    on_toe = np.array(result.path["open_points"]) > 0.0
    assert on_toe.sum() >= 2
    np.testing.assert_allclose((upper * 1.8 + lower * 0.9)[on_toe], ((multiplier - 0.2) * 16.0)[on_toe], atol=1e-9)
    both = (upper < 1.0 - 1e-9) | (lower < 0.5)
    np.testing.assert_allclose(2.0 * (lower - prestress)[both], (upper - prestress)[both], atol=1e-4)  # stiff joints
    assert np.all(np.diff(upper) >= -1e-12)
    assert upper[0] < prestress + 0.1
    assert result.multiplier == pytest.approx(0.2 + (1.8 + 0.9) / 16.0, rel=EXACT)
    assert result.details[BAR_FORCES] == pytest.approx([1.0, 1.0], rel=EXACT)


def test_ties_side_by_side_share_a_force_as_their_stiffness_is():
    push = {"dead": {"points": [{"block": "block", "at": [0.0, 1.8], "force": [4.0, 0.0]}]}}
    ties = [bar(("left", SIDE), ("block", BLOCK), 9.0, stiffness=k) for k in (30.0, 10.0)]
    result = found(built(block(loads=push, ties=ties)))
    assert result.finding is Finding.STANDS
    first, second = result.details[BAR_FORCES]
    assert first == pytest.approx(3.0 * second, rel=1e-9)
    assert first + second > (4.0 * 1.8 - 16.0 * 0.2) / 1.8 - 1e-9  # at least what the toe leaves them


def test_prestress_presses_a_bed_that_slides():
    """Without dilatancy at mu (W + T0)/W; with that of the friction the block rises until the bar yields."""
    rod = bar(("base", [1.0, -0.5]), ("block", [1.0, 0.2]), 10.0, prestress=4.0)
    wall = built(block(0.5, 2.0, 0.2, ties=[rod]))
    assert found(wall).multiplier == pytest.approx(0.5 * 20.0 / 16.0, rel=EXACT)
    assert found(replace(wall, dilatancy=wall.friction)).multiplier == pytest.approx(0.5 * 26.0 / 16.0, rel=EXACT)


@pytest.mark.parametrize(("thickness", "thrust"), [(0.12, 0.1912256), (0.15, 0.1756349), (0.2, 0.1542448)])
def test_arch_on_rollers_stands_if_its_tie_bears_the_least_thrust(thickness: float, thrust: float):
    """The least thrusts, in weights of the arch, are by another programme, to seven digits; a fall is proved."""
    drawn = arch(thickness, 1.0)
    weight = float(drawn.weight[drawn.free].sum())
    for share, finding in ((1.0 + 1e-4, Finding.STANDS), (1.0 - 1e-4, Finding.FALLS)):
        assert found(arch(thickness, (share + PRINTED) * thrust * weight)).finding is finding


@pytest.mark.parametrize("seed", range(6))
def test_random_ties_and_props(seed: int):
    """With the dilatancy of the friction the associated maximum, without between the least known and that."""
    wall = random_wall(seed)
    greatest = found(wall, "la-associated").multiplier
    assert greatest is not None
    assert found(replace(wall, dilatancy=wall.friction)).multiplier == pytest.approx(greatest, rel=EXACT)
    own, least = found(wall), found(wall, "la").multiplier
    assert least is not None
    assert own.multiplier is not None
    assert least * (1.0 - EXACT) <= own.multiplier <= greatest * (1.0 + EXACT)


@pytest.mark.parametrize("view", VIEWS)
def test_views_of_a_tied_wall(view: str):
    wall = random_wall(2)
    wall = replace(wall, bars=replace(wall.bars, stiffness=np.array([50.0, 500.0, 5.0, 50.0])))
    seen = found(VIEWS[view](wall))
    assert seen.multiplier == pytest.approx(found(wall).multiplier, rel=1e-6)  # ties of the path fall otherwise


def test_load_steps_are_those_of_the_joints():
    wall = tied(2.0, stiffness=20.0)
    result = found(wall, load_steps=5)
    steps = LoadSteps.of(result.details, wall)
    assert steps is not None
    assert steps.forces.shape[1:] == (wall.n_interfaces, 3)


def test_brittle_joint_and_tie():
    """A stiff tie yields while the bond is whole, (b/h)(1 + T/W) + .225 with T = .4; a soft one once it is broken."""
    bond = {"cohesion": 9.0, "tensile_strength": 1.0, "after": "residual"}
    stiff, soft = (built(block(ties=[bar(("left", SIDE), ("block", BLOCK), 2.0, **k)], **bond)) for k in ({}, SOFT))
    together = found(stiff)
    assert (together.details["broken"], together.details["breaking"]) == ([], [0])
    assert together.multiplier == pytest.approx(0.2 * (1.0 + 0.4 / 16.0) + 0.225, rel=EXACT)
    after = found(soft)
    assert after.details["broken"] == [0]
    assert after.details["broken_at"] == pytest.approx([0.205], abs=1e-3)  # the tie bears a little by then
    assert after.multiplier == pytest.approx(0.425, rel=EXACT)


def test_fall_of_joints_with_strength_is_proved():
    """A block that slides down a plane steeper than friction and cohesion hold."""
    slope = {"gravity": [1.0, -1.0]}
    wall = assembly(stack(1, 1.0, 0.2), 0.5, cohesion=0.5, loads=slope)
    assert found(wall).finding is Finding.FALLS
    held = assembly(stack(1, 1.0, 0.2), 0.5, cohesion=2.5, loads=slope)
    assert found(held).finding is Finding.STANDS


@pytest.mark.parametrize("name", ["la", "fe"])
def test_a_tie_that_bears_far_more_than_it_needs_does_no_work_by_the_rounding_of_its_elongation(name: str):
    """Pressed by the tie T the block turns about the end of the tie and slides: W b/2 + mu W z = lambda W (z - h/2)."""
    data = block(0.7, ties=[bar(("left", SIDE), ("block", BLOCK), 1e8)])
    assert found(built(data), name).multiplier == pytest.approx((0.2 + 0.7 * 1.8) / 0.8, rel=EXACT)


def test_a_wall_that_its_prestress_topples_has_no_plateau_beside_a_yield_force_of_millions_of_loads():
    """Statics bears nothing below .033; residuals beside 9e7 kN took gravity for borne, and 3.617 for the collapse."""
    width, height = 0.6221775917008368, 0.7452255215826123
    tie = bar(
        ("base", [-2.975846138213499, -0.34006227896601604]),
        ("2", [0.0, 1.1806571365616412]),
        91642899.57258567,
        prestress=5.921595944948144,
        stiffness=8707.112510382283,
    )
    pattern = stack(2, width, height) | {"base": [-3.0, 5.0]}
    wall = assembly(pattern, 0.8676499600791621, ties=[tie])
    answer, _ = answered(load_method("fe"), wall)
    assert answer.multiplier is None
