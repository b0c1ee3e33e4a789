"""Time steps of the engines against the momentum that loads and contacts give, and brackets and checks by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.model.assembly import Assembly, FloatArray
from methods.de.answers import describe, reporting
from methods.de.engines.mass_scaling import courses, insertion_orders, masses, tunings
from methods.de.engines.pymunk_joints import polygon_gyration
from methods.de.engines.sequential_impulses import SequentialImpulses
from methods.de.engines.soft_wall import SoftWall
from methods.de.holds.load_step import ConvergenceMonitor, hold_limit, least_motion, reported_residuals
from methods.de.holds.motion import MotionProof, Trend, by_power, by_travel
from methods.de.holds.order_bracket import LOOSE, OrderBracket
from methods.de.holds.release import even_frames, separated
from methods.de.settings import HoldSettings
from tests.walls import assembly, running_bond, stack

ARCH = {"type": "ring", "inner_radius": 1.0, "outer_radius": 1.15, "count": 11, "angles": [160, 20]}
WALLS = {"bond": assembly(running_bond(3, 2), 0.65), "arch": assembly(ARCH, 0.75)}


def swept(wall: Assembly, order: int = 2) -> SequentialImpulses:
    course = courses(wall)
    _, blocks, joints = insertion_orders(wall, course, 3, 0)[order]
    return SequentialImpulses(wall, blocks, joints, 5, tunings(course, None)[0])


@pytest.mark.parametrize("name", WALLS)
def test_a_step_changes_the_momentum_of_blocks_by_their_loads_and_contact_forces(name: str):
    wall = WALLS[name]
    engine, free = swept(wall), wall.free
    unit = np.array([wall.length_scale, wall.length_scale, 1.0])
    force = wall.force_scale / wall.n_free * np.array([1.0, 1.0, wall.length_scale])
    mass = masses(wall, courses(wall), tunings(courses(wall), None)[0].mass_decay)
    turning = [polygon_gyration((wall.polygons[k] - wall.centroid[k]) / wall.length_scale) for k in free]
    inertia = np.column_stack([mass[free], mass[free], mass[free] * turning])
    damping = 1.0 - 1.0 / engine.relaxation
    engine.load(0.4)
    engine.advance(7)
    assert engine.steps == 7
    before = engine.velocity()[free] / unit * engine.relaxation
    engine.advance(1)
    velocity = engine.velocity()
    after = velocity[free] / unit * engine.relaxation
    forces = engine.contact_forces()
    gained = (wall.kinematic_matrix.T @ forces.ravel()).reshape(-1, 3) + wall.dead[free] + 0.4 * wall.live[free]
    np.testing.assert_allclose(inertia * (after - damping * before), gained / force, atol=1e-12)
    assert engine.unbalance(velocity) == pytest.approx(abs(inertia * after).max() / engine.relaxation)
    assert not velocity[wall.fixed].any()
    assert forces[:, :2].min() >= 0.0
    assert (wall.law.strength(forces) - abs(forces[:, 2])).min() >= -1e-12 * wall.force_scale
    assert abs(forces[:, 2]).max() > 0.0


@pytest.mark.parametrize("name", WALLS)
def test_swept_contacts_close_and_do_not_slip_where_friction_holds_them(name: str):
    """After many sweeps a contact that presses does not open; one that is not at its limit does not slip."""
    wall = WALLS[name]
    course = courses(wall)
    _, blocks, joints = insertion_orders(wall, course, 1, 0)[0]
    engine = SequentialImpulses(wall, blocks, joints, 3000, tunings(course, None)[0])
    engine.load(2.0)
    engine.advance(1)
    motion = engine.velocity()
    rates = (wall.kinematic_matrix @ motion[wall.free].ravel()).reshape(-1, 3)
    fastest, forces = abs(rates).max(), engine.contact_forces()
    assert fastest > 0.0
    assert rates[:, :2].min() >= -1e-6 * fastest
    pressed = forces[:, :2] > 1e-6 * wall.force_scale
    assert pressed.any()
    assert abs(rates[:, :2][pressed]).max() <= 1e-6 * fastest
    held = wall.law.strength(forces) - abs(forces[:, 2]) > 1e-6 * wall.force_scale
    assert held.any()
    assert abs(rates[held, 2]).max() <= 1e-6 * fastest
    slipping = abs(rates[:, 2]) > 1e-3 * fastest
    both = slipping & pressed.any(axis=1)
    assert (forces[both, 2] * rates[both, 2] < 0.0).all()


@pytest.mark.parametrize("name", WALLS)
@pytest.mark.parametrize("turn", [0.0, 0.2, -0.2])
def test_a_step_of_a_soft_wall_from_rest_is_what_its_contacts_and_loads_do(name: str, turn: float):
    """Blocks at any places, turned far: the force on the face's block at the point of contact, and its opposite."""
    wall, draw = WALLS[name], np.random.default_rng(3)
    soft = SoftWall(wall, 1e4, 0.5, 0.01 * wall.length_scale)
    size = np.array([wall.length_scale, wall.length_scale, 1.0])
    soft.places = 0.02 * draw.normal(size=soft.places.shape) * size + np.array([0.0, 0.0, turn])
    soft.shear = 0.2 * wall.force_scale * draw.normal(size=soft.shear.shape)
    soft.load(0.4)
    now = soft.state()
    limit = soft.contacts.friction * np.einsum("kd,kd->k", now.force, now.normal)
    along = np.stack([-now.normal[:, 1], now.normal[:, 0]], axis=1)
    shear = np.einsum("kd,kd->k", now.force, along)
    force = now.force + (np.clip(shear, -limit, limit) - shear)[:, None] * along  # as far as friction holds it
    total = wall.dead + 0.4 * wall.live
    other = np.where(now.onto == wall.block_b[now.interface], wall.block_a[now.interface], wall.block_b[now.interface])
    for block, sign in ((now.onto, 1.0), (other, -1.0)):
        arm = now.point - wall.centroid[block] - now.places[block, :2]
        moment = arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
        np.add.at(total, block, sign * np.column_stack([force, moment]))
    assert (limit > 0.0).any()
    assert (limit == 0.0).any()
    places = soft.places.copy()
    worst = soft.advance(1)
    out = total[wall.free]
    unit = wall.force_scale / wall.n_free
    assert worst == pytest.approx(abs(out / [1.0, 1.0, wall.length_scale]).max() / unit)
    moved = soft.places - places
    assert not moved[wall.fixed].any()
    # Masses are those of each block, of its turning those of its size: the same for both directions.
    pushed = abs(out) > 1e-9 * unit
    assert not moved[wall.free][~pushed].any()
    ratio = moved[wall.free] / np.where(pushed, out, np.nan)
    assert (ratio[pushed] > 0.0).all()
    np.testing.assert_allclose(ratio[:, 0], ratio[:, 1])
    again = SoftWall(wall, 1e4, 0.5, 0.01 * wall.length_scale)
    again.load(-3.0)
    again.advance(1)
    loads = (wall.dead - 3.0 * wall.live)[wall.free]
    acting = pushed & (abs(loads) > 1e-9 * unit)
    np.testing.assert_allclose(again.places[wall.free][acting], (ratio * loads)[acting])


@pytest.mark.parametrize("down", [0.0, 1e-3])
@pytest.mark.parametrize("right", [0.0, 5e-4])
def test_a_block_pressed_into_the_ground_is_borne_by_half_the_joint_at_each_end(down: float, right: float):
    wall = assembly(stack(1, 0.4, 0.2), 0.6)
    soft = SoftWall(wall, 1e4, 0.5, 1e-3)
    block = int(wall.free[0])
    soft.places[block, :2] = right, -down
    now = soft.state()
    kn = 0.5 * 0.4 * 1e4
    sign = np.where(now.onto == block, 1.0, -1.0)
    np.testing.assert_allclose(sign * now.force[:, 1], kn * down, atol=1e-12)
    np.testing.assert_allclose(now.force[:, 0], 0.0, atol=1e-12)
    assert soft.contacts.kt.tolist() == pytest.approx([0.5 * kn] * 2)
    assert soft.contact_forces()[0] == pytest.approx([kn * down, kn * down, 0.0], abs=1e-12)
    if right == 0.0:  # points of contact lie below the centres of both corners
        assert np.ptp(now.point[:, 0]) == pytest.approx(0.4 - 2e-3)
    state = soft.save()
    soft.advance(5)
    soft.restore(state)
    np.testing.assert_array_equal(soft.places[block], [right, -down, 0.0])


def watch(residuals: Any = (), fields: Any = (), held: float = 1e-3, moving: float = 2e-3) -> ConvergenceMonitor:
    found = ConvergenceMonitor(held, moving, np.array([2.0, 2.0, 1.0]))
    for k, residual in enumerate(residuals):
        found.note(np.full((1, 3), float(fields[k]) if len(fields) else 1.0), float(residual))
    return found


@pytest.mark.parametrize(
    ("residuals", "rests"),
    [
        ([1e-4], False),
        ([2e-4, 1e-4], True),
        ([1e-4, 1e-4], True),
        ([1e-4, 2e-4], False),  # it grew
        ([1e-6, 1e-5], True),  # by less than a hundredth of what is small enough
        ([1e-6, 1.1e-5], False),
        ([1e-3, 1e-4], False),  # the limit itself is too much
        ([1e-2, 1e-4, 1e-4], True),
    ],
)
def test_a_wall_rests_after_two_small_residuals_that_do_not_grow(residuals: list[float], rests: bool):
    assert watch(residuals).rests is rests


def test_a_field_is_steady_every_fourth_check_where_it_changed_by_little():
    checks = Trend().checks
    seen = []
    for count in range(1, 3 * checks + 1):
        seen.append(watch(np.ones(count)).steady)
    assert [k + 1 for k, steady in enumerate(seen) if steady] == [2 * checks, 3 * checks]
    little = 0.99 * Trend().steady * checks
    for change, steady in ((little, True), (1.1 * little, False)):
        fields = np.ones(2 * checks)
        fields[-2] = 1.0 + change
        assert watch(np.ones(2 * checks), fields).steady is steady
        fields = np.ones(2 * checks)
        fields[-checks - 1] = 1.0 + change
        assert watch(np.ones(2 * checks), fields).steady is steady
        fields[-checks - 1], fields[0] = 1.0, 9.0  # longer ago
        assert watch(np.ones(2 * checks), fields).steady


def test_motions_are_asked_for_at_16_checks_and_each_doubling():
    assert [count for count in range(1, 140) if watch(np.ones(count)).doubled] == [16, 32, 64, 128]


def test_quarters_are_means_of_equal_times_without_the_first():
    found = watch(np.ones(9), np.arange(9.0))  # the first of nine belongs to none
    half = np.array([0.5, 0.5, 1.0])
    for quarter, mean in zip(found.quarters, (3.5, 5.5, 7.5), strict=True):
        np.testing.assert_allclose(quarter, [mean * half])


@pytest.mark.parametrize(("count", "over"), [(9, False), (10, True), (11, True)])
def test_a_hold_that_does_not_fall_to_rest_has_its_usual_time(count: int, over: bool):
    assert watch(np.ones(count)).over(10, 100, 3.0) is over


@pytest.mark.parametrize(("count", "over"), [(20, False), (59, False), (60, True), (61, True)])
def test_a_hold_that_falls_evenly_is_followed_for_relaxations_of_the_wall(count: int, over: bool):
    falling = 1e-1 * np.exp(-0.05 * np.arange(count))
    assert watch(falling).decay == pytest.approx(0.05)
    assert watch(falling).over(10, 1000, 3.0 - 1e-9) is over
    assert watch(falling).over(10, count, 1000.0)  # no more can be afforded
    assert watch(falling).over(10, count + 1, 1000.0) is False


@pytest.mark.parametrize(
    ("speeds", "rate"),
    [([4.0, 4.0, 3.0, 3.0, 1.0, 1.0], 0.0), ([8.0, 8.0, 4.0, 4.0, 2.0, 2.0, 1.0, 1.0], 0.5 * math.log(2.0))],
)
def test_a_decay_is_told_from_quarters_of_two_checks_at_least(speeds: list[float], rate: float):
    assert watch(speeds).decay == pytest.approx(rate)


def test_a_decay_that_slows_down_is_none():
    old, middle = 8.0, 4.0
    for last, rate in ((2.83, 0.0), (2.82, 0.5 * math.log(4.0 / 2.82)), (4.1, 0.0)):
        found = watch([9.0] * 2 + [old] * 2 + [middle] * 2 + [last] * 2)
        assert found.decay == pytest.approx(rate)


def bracket(**fields: Any) -> OrderBracket:
    return replace(OrderBracket("up", held=0.4, moving=0.5), **fields)


@pytest.mark.parametrize(
    ("fields", "middle", "width"),
    [
        ({}, 0.45, 0.2),
        ({"moving": None}, None, None),
        ({"held": None}, None, None),
        ({"held": 0.0, "nothing": True}, 0.0, 0.0),
        ({"held": 0.0}, 0.25, 1.0),
        ({"held": 0.0, "moving": 0.0}, 0.0, None),
    ],
)
def test_middle_and_width_of_what_an_order_found(fields: Any, middle: float | None, width: float | None):
    found = bracket(**fields)
    assert found.middle == (None if middle is None else pytest.approx(middle))
    assert found.width == (None if width is None else pytest.approx(width))


@pytest.mark.parametrize(
    ("fields", "asked", "told"),
    [
        ({}, True, False),  # a fifth wide
        ({"held": 0.4951}, True, True),
        ({"held": 0.4949}, True, False),
        ({"moving": None}, True, False),
        ({"moving": None}, False, True),
        ({"moving": None, "capped": True}, True, True),
        ({"held": None, "moving": None}, True, False),
        ({"held": None, "moving": None}, False, False),
        ({"held": None}, True, True),
        ({"held": 0.0, "nothing": True}, True, True),
    ],
)
def test_a_search_says_something_where_its_bracket_is_narrow_or_the_wall_falls(fields: Any, asked: bool, told: bool):
    assert LOOSE == 0.01
    assert bracket(**fields).shows(asked) is told


def test_the_order_that_is_reported_is_the_median_of_brackets():
    low, mid, high = (bracket(order=name, held=held, moving=0.8) for name, held in (("a", 0.2), ("b", 0.4), ("c", 0.6)))
    lost = bracket(order="d", held=0.7, moving=None)
    assert reporting([high, lost, low, mid]) is mid
    assert reporting([high, low]) is low
    assert reporting([bracket(held=0.1, moving=None), lost]) is lost
    assert reporting([bracket(held=None)]) is None
    told = describe(WALLS["bond"], [high, lost, low, mid])
    assert (told["lowest_moving"], told["reporting_order"]) == (0.8, "b")
    assert told["spread"] == pytest.approx(0.2 / 0.6)
    nothing = describe(WALLS["bond"], [bracket(held=None, moving=None)])
    assert (nothing["lowest_moving"], nothing["reporting_order"], nothing["spread"]) == (None, None, None)
    assert [row["proof"] for row in describe(WALLS["bond"], [bracket(proof=MotionProof.POWER)])["orders"]] == ["power"]


def test_paths_and_counts_of_orders_are_those_of_their_holds():
    found = bracket(trials=[(0.0, 1e-6), (0.4, 1e-5)], holds=2, steps=30, undecided=[0.45])
    assert found.path == {"multiplier": [0.0, 0.4], "residual": [1e-6, 1e-5]}
    told = describe(WALLS["bond"], [found, bracket(steps=12)])
    assert (told["undecided"], told["contact_updates"]) == (1, 42 * WALLS["bond"].n_interfaces)


class _Loaded:
    """What residuals depend on of an engine: its wall and the multiplier that acts."""

    def __init__(self, wall: Assembly, multiplier: float) -> None:
        self.assembly, self.multiplier = wall, multiplier

    def contact_forces(self) -> FloatArray:
        raise NotImplementedError


def test_residuals_that_are_told_are_shares_of_a_small_live_load():
    settings = HoldSettings(held_residual=1e-3, moving_residual=4e-3, force_residual=1e-8)
    wall = WALLS["bond"]

    def told(live: float) -> tuple[float, float]:
        return reported_residuals(_Loaded(wall, live * wall.load_unit), settings)

    assert told(0.0) == (1e-3, 2e-3)
    assert told(0.01) == told(5.0) == told(-5.0) == (1e-3, 4e-3)
    assert told(0.005) == pytest.approx((5e-4, 2e-3))
    assert least_motion(settings) == 4e-8
    assert told(1e-12) == pytest.approx((2e-8, 4e-8))


@pytest.mark.parametrize(("relaxation", "courses_up", "most"), [(50.0, 3, 600), (150.0, 3, 900), (50.0, 40, 720)])
def test_longest_holds_last_relaxations_or_the_way_through_the_courses(relaxation: float, courses_up: int, most: int):
    engine: Any = type("Engine", (), {"relaxation": relaxation, "courses": courses_up})
    assert hold_limit(engine, HoldSettings(hold_steps=6)) == most


def test_frames_of_a_travel_are_its_first_and_last_and_as_many_as_asked_for():
    assert even_frames(np.arange(11.0), 3) == [0, 5, 10]
    assert even_frames(np.array([0.0, 4.0, 1.0, 2.0]), 2) == [0, 1, 3]  # it went back in between
    assert even_frames(np.zeros(4), 5) == [0, 3]


@pytest.mark.parametrize("turned", [0.0, 0.5 * math.pi])
def test_joints_part_where_both_their_ends_have(turned: float):
    """The upper block rises by .02, or tilts by a thousandth about its left lower corner; the whole may be turned."""
    wall = assembly(stack(2, 0.4, 0.2), 0.6)
    upper, joint = 2, int(np.flatnonzero((wall.block_a == 2) | (wall.block_b == 2))[0])
    cosine, sine = math.cos(turned), math.sin(turned)

    def placed(rise: float) -> FloatArray:
        """All blocks turned about the origin, the upper one first raised."""
        at = wall.centroid + np.array([[0.0, rise * (k == upper)] for k in range(wall.n_blocks)])
        moved = np.column_stack([cosine * at[:, 0] - sine * at[:, 1], sine * at[:, 0] + cosine * at[:, 1]])
        return np.column_stack([moved - wall.centroid, np.full(wall.n_blocks, turned)])

    assert separated(wall, placed(0.02), 0.019) == [joint]
    assert separated(wall, placed(0.02), 0.021) == []
    tilted = placed(0.0)
    tilted[upper, 2] += 0.05  # about its centroid: one end rises by .01, the other sinks
    assert separated(wall, tilted, 0.001) == []


def test_travel_and_power_at_their_limits_show_nothing():
    wall = assembly(stack(1, 0.4, 0.2), 0.3)
    block = int(wall.free[0])
    aside, up = np.zeros((wall.n_blocks, 3)), np.zeros((wall.n_blocks, 3))
    aside[block, 0], up[block, 1] = 1.0, 1.0
    assert by_travel(wall, wall.live, wall.length_scale * up, 0.5) is None  # no work either way
    weight = float(wall.weight[block])
    forces = np.array([[0.5 * weight, 0.5 * weight, 0.0]])
    half = 0.25 * wall.live / wall.live[block, 0] * weight  # a quarter of the weight, exactly
    smooth = replace(wall, friction=np.array([0.25]))
    assert by_power(smooth, half, aside, forces) is None
    assert by_power(replace(wall, friction=np.array([0.249])), half, aside, forces) is not None
