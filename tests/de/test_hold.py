"""Requirements on what a hold may claim: shaking in place is no motion, and what one tuning holds does not fall."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.method import Finding, Status
from methods.de.answers import solve_by_holds
from methods.de.engines.mass_scaling import MassScaling
from methods.de.engines.pymunk_joints import PymunkJoints
from methods.de.holds.load_step import ConvergenceMonitor
from methods.de.holds.motion import StaticLimit, Trend, by_power, by_travel, by_virtual_work
from methods.de.settings import HoldSettings
from methods.numerics.statics import admissible_forces
from tests.walls import assembly, stack

MECHANISM = np.random.default_rng(0).normal(size=(12, 3))


def goes_on(speeds, shaking):
    """What `Trend` says of a motion along one mechanism at these speeds, with random ones on top."""
    generator = np.random.default_rng(1)
    watch = ConvergenceMonitor(1e-6, 2e-5, np.ones(3))
    for speed in speeds:
        watch.note(speed * MECHANISM + shaking * generator.normal(size=MECHANISM.shape), 1.0)
    return Trend().goes_on(watch.quarters)


def test_a_mechanism_at_one_speed_goes_on_however_it_shakes():
    assert goes_on(np.full(60, 0.1), 0.05)


# A wall just above its multiplier slows down to a tenth of its first speed and keeps that.
@pytest.mark.parametrize("speeds", [0.1 * (1 - 0.9 ** np.arange(60)), 0.1 + 0.9 * 0.9 ** np.arange(60)])
def test_what_tends_to_a_speed_goes_on(speeds):
    assert goes_on(speeds, 0.0)


@pytest.mark.parametrize(
    ("speeds", "shaking"),
    [
        (np.zeros(60), 0.1),
        (0.1 * 0.97 ** np.arange(60), 0.0),
        (0.1 * 0.999 ** np.arange(60), 0.0),
        (0.01 + 0.1 * 0.97 ** np.arange(60), 0.0),
        (np.where(np.arange(60) < 50, 0.1, 1e-9), 0.0),
    ],
    ids=["shakes", "slows down", "slows down for long", "a tenth would be left", "came to rest"],
)
def test_what_shakes_or_slows_down_is_not_moving(speeds, shaking):
    assert not goes_on(speeds, shaking)


def test_a_hold_follows_a_slow_relaxation_and_not_a_residual_that_stays():
    falling, staying = (ConvergenceMonitor(1e-6, 2e-5, np.ones(3)) for _ in range(2))
    for k in range(60):
        falling.note(MECHANISM, 1e-3 * np.exp(-0.05 * k))
        staying.note(MECHANISM, 1e-3 + 0.1 * np.exp(-0.5 * k))
    assert falling.decay == pytest.approx(0.05)
    assert staying.decay == 0.0


def block(friction):
    """One block 0.4 x 0.2, its unit slide to the right, and its contact forces under a load."""
    wall = assembly(stack(1, 0.4, 0.2), friction)
    slide = np.zeros((wall.n_blocks, 3))
    slide[wall.free[0], 0] = 1.0
    return wall, slide, wall.weight[wall.free[0]]


@pytest.mark.parametrize(("multiplier", "moves"), [(0.29, False), (0.31, True)])
def test_loads_move_a_block_by_what_friction_does_not_take(multiplier, moves):
    wall, slide, weight = block(0.3)
    forces = np.array([[0.5 * weight, 0.5 * weight, 0.0]])
    load = wall.dead + multiplier * wall.live
    assert (by_power(wall, load, slide, forces) is not None) == moves
    assert (by_virtual_work(wall, load, slide) is not None) == moves
    # Under normal forces so large friction takes more than the loads give.
    assert by_power(wall, load, slide, forces * 0.35 / 0.3) is None
    # A joint that opens under force is no motion that the loads drive: its forces are not those of the motion.
    lifted = slide.copy()
    lifted[wall.free[0], 1] = 1.0
    assert by_power(wall, load, lifted, forces) is None


@pytest.mark.parametrize(("rises", "moves"), [(0.305, True), (0.35, False)])
def test_a_field_on_which_the_loads_lose_work_is_no_fall_however_near_to_a_mechanism(rises, moves):
    wall, slide, _ = block(0.3)
    slide[wall.free[0], 1] = rises
    # The slide gains 0.31 times the weight, the rise loses what it is; both lie near the dilatant mechanism.
    assert (by_virtual_work(wall, wall.dead + 0.31 * wall.live, slide) is not None) == moves


@pytest.mark.parametrize("multiplier", [0.0, 0.1, 0.2999999, 0.3000001, 0.31, -0.1])
def test_statics_bears_what_virtual_work_cannot_move(multiplier):
    wall, slide, _ = block(0.3)
    # A block that slides at its friction: what it bears to either side is known from zero on only.
    assert StaticLimit(wall).bears(multiplier) == (0.0 <= multiplier < 0.3)
    if StaticLimit(wall).bears(multiplier):
        assert by_virtual_work(wall, wall.dead + multiplier * wall.live, slide) is None


def test_statics_bears_nothing_where_the_dead_load_is_not_borne():
    # The centroid of the top block lies 0.03 outside: the live load, 0.1 above the joint, turns it back from 0.3 on.
    wall = assembly(stack(3) | {"offsets": [0.0, 0.0, -0.18]}, 0.7)
    borne = [admissible_forces(wall, wall.dead + multiplier * wall.live) is not None for multiplier in (0.0, 0.2, 0.4)]
    assert borne == [False, False, True]
    assert not any(StaticLimit(wall).bears(multiplier) for multiplier in (0.0, 0.2))


def test_travel_against_the_loads_or_too_short_shows_nothing():
    wall, slide, _ = block(0.3)
    far = 0.25 * wall.length_scale
    assert by_travel(wall, wall.live, far * slide, 0.25) is not None
    assert by_travel(wall, wall.live, 0.9 * far * slide, 0.25) is None
    assert by_travel(wall, wall.live, -far * slide, 0.25) is None


@pytest.mark.parametrize("quick", [True, False])
def test_a_wall_falls_only_where_it_moves_with_every_tuning(quick):
    wall, falling = assembly(stack(3), 0.7), assembly(stack(3) | {"offsets": [0.0, 0.0, 0.2]}, 0.7)
    settings = HoldSettings(orders=1, work=10**8 if quick else 1)
    holds, falls = MassScaling(0.4, 0.98), MassScaling(0.0, 0.95)

    def engine(blocks, joints, tuning):
        return PymunkJoints(wall if tuning == holds else falling, blocks, joints, settings.iterations, tuning)

    for candidates in ([holds, falls], [falls, holds]):
        answer = solve_by_holds(wall, settings, engine, 1e-6, candidates)
        # Out of work after the dead load, the bracket is not found: that is all there is to say.
        found = (Status.OK, Finding.COLLAPSES) if quick else (Status.NOT_CONVERGED, Finding.NONE)
        assert (answer.status, answer.finding) == found
    assert solve_by_holds(falling, settings, engine, 1e-6, [falls]).finding is Finding.FALLS
