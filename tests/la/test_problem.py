"""The scaled problem of limit analysis in the units of the wall, its Newton steps, and what a search may spend."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.model.assembly import FloatArray
from harness.model.joint_law import JointLaw
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.core.programmes import KinematicProgramme, StaticProgramme
from methods.la.interior.interior_point import start_point
from methods.la.interior.newton_step import NewtonStep, Point
from methods.la.settings import SearchSettings
from methods.la.sources.budget import Budget, SearchLimits, Sizes, Work, rounds_of
from tests.la.bodies import block_on_halves, column, running_bond


def dilating(courses: int = 2, bricks: int = 2) -> Problem:
    """A bond whose joints lift by a fifth of a slip."""
    wall = running_bond(courses, bricks, 0.2, 0.5)
    return make_problem(replace(wall, dilatancy=np.full(wall.n_interfaces, 0.2)))


def test_forces_and_motions_of_the_scaled_problem_are_those_of_the_wall() -> None:
    problem = dilating()
    wall, draw = problem.assembly, np.random.default_rng(2)
    forces, motion = draw.normal(size=(problem.n_interfaces, 3)), draw.normal(size=(wall.n_blocks, 3))
    motion[wall.fixed] = 0.0
    velocities = problem.from_mechanism(motion)
    strains = (wall.kinematic_matrix @ motion[wall.free].ravel()).reshape(-1, 3)
    np.testing.assert_allclose(problem.strains(velocities), strains, atol=1e-12)
    np.testing.assert_allclose(problem.velocities_of_blocks(velocities), motion[wall.free], atol=1e-12)
    np.testing.assert_allclose(problem.to_mechanism(velocities), motion / abs(motion).max(), atol=1e-12)
    assert not problem.to_mechanism(0.0 * velocities).any()
    dead, live = wall.free_loads()
    multiplier = problem.to_multiplier(0.75)
    balance = wall.kinematic_matrix.T @ problem.to_forces(forces).ravel() + dead + multiplier * live
    power = float(balance @ motion[wall.free].ravel())
    assert problem.imbalance(forces, 0.75) @ velocities * problem.unit_force == pytest.approx(power)
    assert problem.to_multiplier(1e-15) == 0.0
    assert problem.to_multiplier(-2e-15) < 0.0


def test_loads_of_the_scaled_problem_are_of_order_one() -> None:
    problem = make_problem(column([0.5, 1.0], [0.2, 0.4], 0.5))
    assert abs(problem.dead.reshape(-1, 3)[:, 1]).mean() == pytest.approx(1.0)
    assert abs(problem.live).sum() == pytest.approx(2.0)  # blocks
    assert problem.live_work == 2.0
    assert problem.unit_length == pytest.approx((np.sqrt(0.1) + np.sqrt(0.4)) / 2.0)
    assert make_problem(replace(problem.assembly, live=0.0 * problem.assembly.live)).unit_multiplier == 1.0


@pytest.mark.parametrize(("associated", "lift"), [(False, 0.2), (True, 0.5)])
def test_rates_and_strains_of_a_joint_by_hand(associated: bool, lift: float) -> None:
    problem = dilating()
    rates = np.zeros((problem.n_interfaces, 4))
    rates[0], rates[1], rates[2] = [1.0, 2.0, 3.0, 0.0], [0.25, 0.0, 0.0, 2.0], [0.0, 0.5, 0.0, 0.0]
    strains = problem.strains_of_rates(rates, 1.0 if associated else 0.0)
    expected = [[1 + 3 * lift, 2 + 3 * lift, 3.0], [0.25 + 2 * lift, 2 * lift, -2.0], [0.0, 0.5, 0.0]]
    np.testing.assert_allclose(strains[:3], expected)
    np.testing.assert_allclose(problem.rates_of_strains(strains, associated), rates, atol=1e-15)
    assert problem.dilates
    assert not make_problem(problem.assembly.with_joints([])).dilates


def test_joints_that_press_little_beside_their_blocks_are_unloaded() -> None:
    """Head joints of a bond carry nothing of its weight."""
    problem = make_problem(running_bond(3, 2, 0.2, 0.5))
    kinds = np.array(problem.assembly.joint)
    assert not problem.unloaded_joints[kinds == "bed"].any()
    assert problem.unloaded_joints[kinds == "head"].all()


def inside(problem: Problem) -> Point:
    """A point with slacks of forces within yield and rates above zero, off equilibrium and off compatibility."""
    draw = np.random.default_rng(5)
    m = problem.n_interfaces
    normal = draw.uniform(0.5, 2.0, (m, 2))
    shear = draw.uniform(-0.9, 0.9, m) * problem.friction * normal.sum(axis=1)
    slack = problem.slacks(np.column_stack([normal, shear]))
    return Point(slack, 0.25, draw.normal(size=problem.n_velocities), draw.uniform(0.1, 2.0, (m, 4)))


@pytest.mark.parametrize("dilatancy", [0.0, 1.0])
@pytest.mark.parametrize("problem", [dilating(), dilating(9, 25)], ids=["SuperLU", "supernodes"])
def test_a_newton_step_solves_the_linear_equations_of_the_path(problem: Problem, dilatancy: float) -> None:
    """Equilibrium, compatibility, live work, and the products of slacks and rates to first order."""
    newton, point, m = NewtonMatrix(problem), inside(problem), problem.n_interfaces
    assert newton.large == (problem.assembly.n_free > 200)
    step = NewtonStep(problem, point, dilatancy, np.zeros((m, 4), dtype=bool)).factorised(newton)
    target = np.random.default_rng(6).uniform(0.0, 1.0, (m, 4))
    first = step.direction(target)
    for change in (first, step.refined(first, target)):
        slack, rates = point.slack + change.slack, point.rates + change.rates
        velocities = point.velocities + change.velocities
        assert change.slack == pytest.approx(problem.slacks(change.forces), abs=1e-8)
        forces = problem.forces_of_slacks(slack)
        assert problem.imbalance(forces, point.multiplier + change.multiplier) == pytest.approx(0.0, abs=1e-7)
        gap = problem.strains(velocities) - problem.strains_of_rates(rates, dilatancy)
        assert gap == pytest.approx(0.0, abs=1e-7)
        assert problem.live @ velocities == pytest.approx(problem.live_work)
        product = point.slack * point.rates + point.slack * change.rates + point.rates * change.slack
        assert product == pytest.approx(target, abs=1e-7)
    advanced = step.advance(first, 0.5, 0.25)
    assert advanced.slack == pytest.approx(point.slack + 0.5 * first.slack, abs=1e-8)
    assert advanced.rates == pytest.approx(point.rates + 0.25 * first.rates)
    assert advanced.multiplier == point.multiplier + 0.5 * first.multiplier
    assert advanced.velocities == pytest.approx(point.velocities + 0.25 * first.velocities)


def test_step_on_hyperbolas_keeps_products_where_a_tangent_leaves_the_interior() -> None:
    """The larger of slack and rate takes the step; the forces are those of all four slacks."""
    problem = make_problem(running_bond(3, 2, 0.2, 0.65))
    newton, m = NewtonMatrix(problem), problem.n_interfaces
    point = start_point(problem)
    step = NewtonStep(problem, point, 0.0, np.zeros((m, 4), dtype=bool)).factorised(newton)
    product = point.slack * point.rates
    change = step.direction(product)
    size = 3.0 / max(abs(change.slack / point.slack).max(), abs(change.rates / point.rates).max())
    assert min(step.lengths(change.times(size), 1.0)) < 1.0
    assert step.length_on(change.times(size), 0.9, 100.0) == 1.0
    there = step.advance_on(change.times(size), product)
    assert min(there.slack.min(), there.rates.min()) > 0.0
    assert there.slack * there.rates == pytest.approx(product)
    assert problem.slacks(problem.forces_of_slacks(there.slack)) == pytest.approx(there.slack)
    assert step.length_on(change.times(10.0 * size), 0.9, 3.0) == pytest.approx(0.1, rel=0.3)


def test_slacks_that_are_held_stay_and_points_outside_are_refused() -> None:
    problem = make_problem(block_on_halves())
    newton, point, tight = NewtonMatrix(problem), inside(problem), np.zeros((2, 4), dtype=bool)
    tight[1, 0] = True
    change = NewtonStep(problem, point, 0.0, tight).factorised(newton).direction(np.full((2, 4), 0.5))
    assert change.slack[1, 0] == 0.0
    for name in ("slack", "rates"):
        outside = replace(point, **{name: getattr(point, name).copy()})
        getattr(outside, name)[0, 1] = 0.0
        with pytest.raises(FloatingPointError, match="left the interior"):
            NewtonStep(problem, outside, 0.0, np.zeros((2, 4), dtype=bool))


def test_a_path_starts_pressed_without_shear_at_products_of_one() -> None:
    problem = make_problem(running_bond(2, 2, 0.2, 0.5))
    start = start_point(problem)
    m = problem.n_interfaces
    forces = np.column_stack([np.ones((m, 2)), np.zeros(m)])
    np.testing.assert_allclose(start.slack, problem.slacks(forces))
    np.testing.assert_allclose(start.slack * start.rates, 1.0)
    assert (start.multiplier, start.velocities.any()) == (0.0, False)


@pytest.mark.parametrize(("sense", "most", "sliding"), [(1.0, 6 / 11, 0.4), (-1.0, 0.6, 4 / 9)])
def test_the_programmes_of_a_block_have_its_multipliers(sense: float, most: float, sliding: float) -> None:
    """1 x .5 on a left half of friction .6 and a right one of .4; its weight W bears at a quarter of the push k W.

    To the right at most .6 (1 - k / 2) + .4 k / 2 = k, the left half bearing all it can beside the right edge; while
    both slide at least .4, all on the right half. To the left at most .6, and at least .4 (1 - k / 2) + .6 k / 2 = k.
    """
    wall = block_on_halves()
    problem = make_problem(replace(wall, live=sense * wall.live))
    programme = StaticProgramme(problem)
    greatest = programme.solve(greatest=True)
    least = programme.solve()
    assert not isinstance(greatest, str)
    assert not isinstance(least, str)
    assert problem.to_multiplier(greatest.multiplier) == pytest.approx(most)
    assert least.multiplier == pytest.approx(0.0, abs=1e-12)
    for found in (greatest, least):
        assert problem.imbalance(found.forces, found.multiplier) == pytest.approx(0.0, abs=1e-9)
        assert problem.slacks(found.forces).min() >= -1e-9
    slipping = np.zeros((2, 4), dtype=bool)
    slipping[:, 3 if problem.assembly.tangent[0, 0] * sense < 0 else 2] = True  # both halves at their limits
    held = programme.solve(slipping)
    assert not isinstance(held, str)
    assert problem.to_multiplier(held.multiplier) == pytest.approx(sliding)
    assert problem.slacks(held.forces)[slipping] == pytest.approx(0.0, abs=1e-9)
    assert programme.solve(slipping, below=0.99 * held.multiplier) == "above"
    assert programme.solve(slipping, below=held.multiplier) == "above"
    both = np.ones((2, 4), dtype=bool)
    assert programme.solve(both) == "infeasible"  # joints without forces carry no weight
    again = programme.solve(slipping, below=1.01 * held.multiplier)
    assert not isinstance(again, str)
    assert again.multiplier == pytest.approx(held.multiplier, rel=1e-12)


def test_a_mechanism_of_least_cost_moves_in_the_contacts_allowed_alone() -> None:
    problem = make_problem(block_on_halves())
    programme, cost = KinematicProgramme(problem), np.ones((2, 4))
    assert programme.solve(np.zeros((2, 4), dtype=bool), cost) is None
    way = 2 if problem.assembly.tangent[0, 0] > 0 else 3
    slide = np.zeros((2, 4), dtype=bool)
    slide[:, way] = True
    found = programme.solve(slide, cost)
    assert found is not None
    assert problem.live @ found.velocities == pytest.approx(problem.live_work)
    assert found.rates[~slide] == pytest.approx(0.0, abs=1e-12)
    assert found.rates[slide] == pytest.approx(found.rates[0, way])
    assert problem.rates_of_velocities(found.velocities, False) == pytest.approx(found.rates, abs=1e-12)


class _Capped(JointLaw):
    """Associated Coulomb friction beside a cap on shear whatever N: two more rows, cap + s and cap - s."""

    @property
    def rows(self) -> FloatArray:
        cap = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
        return np.concatenate([super().rows, np.broadcast_to(cap, (len(self.friction), 2, 3))], axis=1)

    @property
    def flow(self) -> FloatArray:
        return np.asarray(self.rows.transpose(0, 2, 1))


@pytest.mark.parametrize(("cap", "multiplier"), [(0.2, 0.2), (0.45, 0.45), (0.55, 0.5), (2.0, 0.5)])
def test_the_least_work_of_a_law_of_six_rows_is_the_multiplier_of_a_block_whose_shear_is_capped(
    cap: float, multiplier: float
) -> None:
    # Weight 1, friction .5: it slides at the least of cap / W and mu; it would topple at 5. The work of the slacks that
    # the dead load leaves, (S r + s0) . g = s0 . g - f0 . u, is the multiplier of the mechanism.
    problem = make_problem(column([1.0], [0.2], 0.5))
    law = _Capped(problem.friction, problem.friction)
    slack = np.einsum("pij,pj->pi", law.rows, [[0.5, 0.5, 0.0]]) + np.array([0.0, 0.0, 0.0, 0.0, cap, cap])
    found = KinematicProgramme(replace(problem, law=law)).solve(np.ones((1, 6), dtype=bool), slack)
    assert found is not None
    assert float((slack * found.rates).sum()) / problem.live_work == pytest.approx(multiplier)
    assert found.rates[:, 4:].any() == (cap < 0.5)


class _Sized:
    """What a budget asks of a problem: how many blocks and joints it has."""

    def __init__(self, blocks: int, interfaces: int) -> None:
        self.n_interfaces = interfaces
        self.assembly: Any = type("Wall", (), {"n_free": blocks})


def limits(blocks: int, interfaces: int, effort: str = "normal") -> SearchLimits:
    sized: Any = _Sized(blocks, interfaces)
    return Sizes().limits(effort, sized)


def test_larger_walls_are_searched_with_fewer_rungs_and_longer_descents() -> None:
    whole, half = Sizes().continuation, Sizes().continuation[::2]
    assert [limits(blocks, 3 * blocks).continuation for blocks in (30, 31, 60, 61)] == [whole, half, half, ()]
    assert [limits(blocks, 3 * blocks).descents for blocks in (30, 60, 61)] == [3, 3, 1]
    assert [limits(400, joints).descents for joints in (1000, 1001)] == [1, 0]
    assert [limits(400, joints, "quick").descents for joints in (1000, 1001)] == [1, 0]


def test_proofs_are_tried_where_joints_are_few_or_hardly_more_than_blocks() -> None:
    def nodes(blocks: int, interfaces: int, effort: str = "normal") -> int:
        return limits(blocks, interfaces, effort).nodes

    assert [nodes(5, joints) for joints in (16, 17)] == [1500, 0]
    assert [nodes(28, joints) for joints in (30, 31)] == [1500, 0]
    assert [nodes(20, joints) for joints in (22, 23)] == [1500, 0]
    assert [nodes(5, joints, "quick") for joints in (16, 17)] == [100, 0]
    assert [nodes(5, joints, "deep") for joints in (32, 33)] == [20000, 0]


def test_settings_take_the_place_of_limits_and_deep_searches_begin_with_a_normal_one() -> None:
    sized: Any = _Sized(400, 1001)
    (plain,) = rounds_of(SearchSettings(), sized)
    assert plain == limits(400, 1001)
    (asked,) = rounds_of(SearchSettings(failures=7), sized)
    assert (asked.failures, asked.descents) == (7, 1)
    first, second = rounds_of(SearchSettings(effort="deep"), sized)
    assert (first, second) == (limits(400, 1001), limits(400, 1001, "deep"))


def test_a_budget_ends_where_it_is_spent_and_lasts_longer_while_nothing_is_known() -> None:
    budget = Budget(SearchLimits(programmes=10, block_steps=100.0, breakpoints=50))
    budget.stepped(5, 20)
    assert (budget.spent.newton_steps, budget.spent.block_steps) == (5, 100.0)
    assert (budget.steps_left(True), budget.steps_left(False)) == (False, True)
    budget.spent.block_steps = 99.0
    assert budget.steps_left(True)
    for spent, known, unknown in ((49, True, True), (50, False, True), (99, False, True), (100, False, False)):
        budget.spent.breakpoints = spent
        assert (budget.breakpoints_left(True), budget.breakpoints_left(False)) == (known, unknown)
    budget.spent.programmes = 4
    assert budget.programmes == 6
    budget.spent.programmes = 11
    assert budget.programmes == 0
    assert Work(5, 7, 9.0, 11).since(Work(1, 2, 3.0, 4)) == Work(4, 5, 6.0, 7)
