"""Requirements on `de-box2d`: the exact cases of `de`, judged forces, states made again, its absence said clearly."""

from __future__ import annotations

import importlib.util
import sys

import numpy as np
import pytest

from harness.engine.residuals import force_residuals
from harness.model.errors import InputError
from harness.model.method import Finding, Status
from methods.de.damped_holds import Box2dHolds
from methods.de.engines.box2d_joints import Box2dJoints
from methods.de.engines.mass_scaling import courses, insertion_orders, tunings
from methods.de.settings import Box2dSettings
from tests.de.answers import run
from tests.de.test_damped_holds import two_friction_block
from tests.walls import assembly, running_bond, stack

needs_box2d = pytest.mark.skipif(importlib.util.find_spec("pyb2d3") is None, reason="the extra box2d is missing")


def run_box2d(wall, **settings):
    return Box2dHolds().solve(wall, Box2dSettings(**settings))


def engine_of(wall) -> Box2dJoints:
    course = courses(wall)
    ((_, blocks, joints),) = insertion_orders(wall, course, 1, 0)
    return Box2dJoints(wall, blocks, joints, 10, tunings(course, None)[0])


@needs_box2d
@pytest.mark.parametrize(
    ("pattern", "friction", "exact"),
    [
        (stack(1, 0.4, 0.2), 0.3, 0.3),
        (stack(1, 0.2, 0.4), 0.7, 0.5),
        (stack(5, 0.4, 0.2), 0.7, 0.4),
        (stack(10, 0.4, 0.2), 0.7, 0.2),
    ],
    ids=["slide", "topple", "5 topple", "10 topple"],
)
def test_blocks_and_stacks_have_the_exact_multiplier_and_forces_the_judge_accepts(pattern, friction, exact):
    wall = assembly(pattern, friction)
    answer = run_box2d(wall, orders=1)
    assert (answer.status, answer.finding) == (Status.OK, Finding.COLLAPSES)
    assert answer.multiplier == pytest.approx(exact, rel=1e-3)
    assert answer.bracket[0] <= exact * (1 + 1e-5)
    residuals = force_residuals(wall, answer.forces, answer.forces_multiplier)
    assert residuals["equilibrium"] < 1e-5
    assert residuals["yield"] < 1e-5


@needs_box2d
def test_answer_is_near_that_of_the_other_engine_on_a_wall():
    # Not the same: the wall has a range of collapse multipliers, and the order of the sweeps chooses among them.
    wall = assembly(running_bond(4, 3), 0.65)
    one, two = run(wall, orders=1), run_box2d(wall, orders=1)
    assert two.multiplier == pytest.approx(one.multiplier, rel=0.05)


@needs_box2d
def test_forces_on_two_frictions_are_those_of_the_interfaces_and_ends_they_act_on():
    wall = two_friction_block()
    low, high = run_box2d(wall, orders=2).bracket
    assert 0.41 < low <= high < 0.56
    engine = engine_of(wall)
    engine.load(0.3)
    engine.advance(500)
    assert force_residuals(wall, engine.contact_forces(), 0.3)["equilibrium"] < 1e-5


@needs_box2d
def test_a_saved_state_is_made_again_to_the_last_bit_after_the_wall_has_moved():
    wall = assembly(running_bond(3, 3), 0.5)
    engine = engine_of(wall)
    for multiplier in (0.0, 0.1):
        engine.load(multiplier)
        engine.advance(100)
    state, forces = engine.save(), engine.contact_forces()
    engine.load(1.0)
    engine.advance(50)
    engine.restore(state)
    assert np.array_equal(engine.contact_forces(), forces)
    assert engine.multiplier == 0.1
    assert engine.steps == 450


@needs_box2d
def test_wall_that_falls_under_its_dead_load_is_said_to():
    wall = assembly(stack(3) | {"offsets": [0.0, 0.0, 0.2]}, 0.7, loads={"live": None})
    assert run_box2d(wall, orders=1).finding is Finding.FALLS


def test_missing_package_is_named_with_the_way_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyb2d3", None)
    with pytest.raises(InputError, match=r"drystone\[box2d\]"):
        run_box2d(assembly(stack(1), 0.5))
