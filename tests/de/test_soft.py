"""Requirements on `de-soft`: closed forms of soft joints, the limit of stiff ones, and a state that can be judged."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from harness.engine.judge import judge
from harness.engine.residuals import displaced_residuals
from harness.model.displaced import DisplacedState
from harness.model.method import Finding, Status
from harness.model.result import result_of
from methods.de.holds.loading import raise_until_it_falls
from methods.de.methods import DE_SOFT
from methods.de.settings import SoftSettings
from methods.de.soft import DeformableJoints
from tests.walls import assembly, running_bond, stack


def soft(wall, **settings):
    return DeformableJoints().solve(wall, SoftSettings(**settings))


@pytest.mark.parametrize("radius", [1e-5, 0.01])
@pytest.mark.parametrize("lean", [0.001, 0.005, 0.02])
def test_a_block_on_soft_joints_topples_as_it_leans(lean, radius):
    # b = 0.2, h = 0.4, contacts b' = b - 2 r apart, stiffness K at each. One end lifts when the other carries the
    # weight W: the block has sunk there by W / K, leans by W / (K b'), rolls on a corner of the ground, and has slid
    # by lambda W / K over it. About that corner: lambda (h / 2 + W / K) = b' / 2 - (h / 2 - r) W / (K b').
    wall = assembly(stack(1, 0.2, 0.4), 0.9)
    end = wall.force_scale / (0.2 * lean)
    answer = soft(wall, stiffness=2.0 * end / 0.2, rounding=radius, accuracy=1e-4)
    apart, sunk = 0.2 - 2.0 * radius, 0.2 * lean
    expected = (apart / 2.0 - (0.2 - radius) * sunk / apart) / (0.2 + sunk)
    # The bracket is 1e-4 wide; beyond it there are terms of the order of lean^2.
    assert answer.multiplier == pytest.approx(expected, abs=1e-4 + lean**2)


def test_with_stiff_joints_rounded_corners_are_contact_points_set_in():
    # Block of 0.2 x 0.4 with corners of 0.01: (b / 2 - r) / (h / 2), and the bracket is 5e-4 wide.
    wall = assembly(stack(1, 0.2, 0.4), 0.9, contact_inset={"length": 0.01})
    answer = soft(wall)
    assert answer.multiplier == pytest.approx(0.45, abs=5e-4)
    assert "rounded by 0.01" in answer.sentence


def test_softer_joints_make_a_wall_weaker_and_stiff_ones_come_to_the_plateau_of_unloaded_head_joints():
    wall = assembly(running_bond(6, 3), 0.65)
    unit = wall.force_scale / wall.n_free / wall.length_scale**2
    found = [soft(wall, stiffness=k * unit).multiplier for k in (1e3, 1e4, 1e6)]
    assert found == sorted(found)
    # 13/23; the bracket is 0.001 wide, and corners rounded by 2e-4 length scales take 0.1 %.
    assert found[-1] == pytest.approx(13 / 23, rel=2e-3)
    assert found[0] < 0.9 * found[-1]


def test_joints_are_made_stiff_enough_for_an_arch_that_leaning_would_bring_down():
    # Nothing slides, so that the associated maximum 0.0566761 (linear programme) is the multiplier of rigid joints.
    wall = assembly({"type": "ring", "inner_radius": 1.0, "outer_radius": 1.13, "count": 21, "angles": [180, 0]}, 0.8)
    answer = soft(wall)
    assert answer.multiplier == pytest.approx(0.0566761, rel=5e-3)
    assert not answer.details["soft_joints"]
    # Softer ones that are given say by how much the wall leans itself down, to a tenth of that.
    given = soft(wall, stiffness=3e5 * wall.force_scale / wall.n_free / wall.length_scale**2)
    assert given.details["soft_joints"]
    assert "its joints are soft" in given.sentence
    assert given.multiplier * (1.0 + given.details["lean"]) == pytest.approx(0.0566761, rel=3e-3)
    assert given.multiplier < 0.99 * 0.0566761


def test_the_state_at_rest_is_judged_where_the_blocks_have_moved_to():
    wall = assembly(running_bond(6, 3), 0.65)
    unit = wall.force_scale / wall.n_free / wall.length_scale**2
    answer = soft(wall, stiffness=1e3 * unit)
    result = result_of(answer, wall, case="wall", method="de-soft", family="de")
    judgement = judge(wall, result, DE_SOFT.tolerance)
    # In equilibrium where they are; joints so soft have moved them by more than the accuracy of a multiplier.
    assert max(judgement.residuals[name] for name in ("equilibrium", "yield", "multiplier")) <= DE_SOFT.tolerance
    assert judgement.accepted is None
    assert judge(wall, result_of(soft(wall), wall, case="wall", method="de-soft", family="de"), 1e-5).accepted is True
    state = DisplacedState.of(answer.details)
    # The blocks have moved so far that the state is none where they were: the judge would see that.
    assert np.abs(state.places[:, 0]).max() > 1e-3
    back = replace(state, places=np.zeros_like(state.places))
    assert displaced_residuals(wall, back, answer.forces_multiplier)["equilibrium"] > 1e-4
    more = replace(state, force=1.001 * state.force)
    assert displaced_residuals(wall, more, answer.forces_multiplier)["equilibrium"] > 1e-5
    sheared = state.force[:, ::-1] * np.array([-1.0, 1.0])
    assert displaced_residuals(wall, replace(state, force=sheared), answer.forces_multiplier)["yield"] > 1e-3


def test_a_small_multiplier_has_a_narrow_bracket():
    # b = 0.01, h = 0.5, corners of r = 2e-4 sqrt(b h):
    # (b - 2 r) / h less the lean W / (K b), with K = k b / 2 and k = 1e6 W / (b h).
    wall = assembly(stack(1, 0.01, 0.5), 0.9)
    answer = soft(wall, stiffness=1e6 * wall.force_scale / wall.n_free / wall.length_scale**2)
    radius, lean = 2e-4 * np.sqrt(0.01 * 0.5), 2.0 * 0.5 / (1e6 * 0.01)
    assert answer.status is Status.OK
    assert answer.bracket[1] - answer.bracket[0] <= 2e-3 * 0.02
    assert answer.multiplier == pytest.approx((0.01 - 2.0 * radius) / 0.5 - lean, rel=2e-3)
    # Joints that nobody set are made stiff enough for b / h.
    assert soft(wall).multiplier == pytest.approx(0.02, rel=2.5e-3)


def test_the_end_says_what_was_not_found():
    wall = assembly(stack(2), 0.5)
    short = soft(assembly(running_bond(6, 3), 0.65), hold_steps=500, held_residual=1e-12)
    assert (short.status, short.finding, short.multiplier) == (Status.NOT_CONVERGED, Finding.NONE, None)
    very_soft = soft(wall, stiffness=1e-2 * wall.force_scale / wall.length_scale**2)
    assert (very_soft.status, very_soft.finding, very_soft.multiplier) == (Status.OK, Finding.FALLS, None)
    assert "stiffness" in very_soft.sentence


def test_repeats_are_bit_identical():
    wall = assembly(running_bond(4, 2), 0.65)
    one, two = soft(wall), soft(wall)
    assert one.bracket == two.bracket
    assert one.details == two.details


@pytest.mark.parametrize("critical", [0.237, 0.5, 1.03])
def test_the_load_is_raised_until_the_wall_falls_and_the_bracket_narrowed(critical):
    tried = []

    def rests(multiplier):
        tried.append(multiplier)
        return multiplier < critical

    stood, fell = raise_until_it_falls(rests, 1.0, 0.02, 1e-3)
    if critical > 1.0:
        assert fell is None
        assert stood == pytest.approx(1.0)
    else:
        assert stood < critical <= fell <= stood + 1e-3
    assert len(tried) < 60


def test_a_slow_slide_is_followed_until_its_joints_have_settled():
    # One load step of 5e-4 above sliding at 0.5 the wall slides so slowly that at first its joints' own give shows in
    # the motion: interpenetration 0.11 of the fastest point where the fall is shown (0.07 with local damping alone).
    wall = assembly(running_bond(6, 3), 0.5)
    answer = soft(wall)
    closing = -(wall.kinematic_matrix @ answer.mechanism[wall.free].ravel()).reshape(-1, 3)[:, :2]
    assert closing.max() <= 0.01 * np.abs(answer.mechanism[:, :2]).max()


def test_vibration_is_damped_in_blocks_that_drift():
    # 9 courses of 2:1 bricks. Damping by the sign of the velocity alone leaves three holds undecided near collapse.
    answer = soft(assembly(running_bond(10, 5), 0.65))
    assert answer.details["undecided"] == 0
    # 0.503653: the greatest multiplier whose head joints carry nothing (linear programme); joints may take 0.25 %.
    assert answer.multiplier == pytest.approx(0.503653, rel=2.5e-3)
