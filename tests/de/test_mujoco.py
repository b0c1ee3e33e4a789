"""Requirements on `de-mujoco`: the exact cases of `de` on a second engine, judged forces, its absence said clearly."""

from __future__ import annotations

import importlib.util
import sys

import numpy as np
import pytest

from harness.engine.residuals import force_residuals
from harness.model.errors import InputError
from harness.model.method import Finding, Status
from methods.de.damped_holds import MujocoHolds
from methods.de.engines.mujoco_wall import MujocoTuning, MujocoWall, SoftContacts, SolverFailed
from methods.de.methods import DE_MUJOCO
from methods.de.settings import MujocoSettings
from tests.de.answers import run
from tests.de.test_damped_holds import two_friction_block
from tests.walls import assembly, running_bond, stack

needs_mujoco = pytest.mark.skipif(importlib.util.find_spec("mujoco") is None, reason="the extra mujoco is missing")


def run_mujoco(wall, **settings):
    return MujocoHolds().solve(wall, MujocoSettings(**settings))


@needs_mujoco
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
    answer = run_mujoco(wall, orders=1)
    assert (answer.status, answer.finding) == (Status.OK, Finding.COLLAPSES)
    assert answer.multiplier == pytest.approx(exact, rel=1e-3)
    assert answer.bracket[0] <= exact * (1 + 1e-4)
    assert force_residuals(wall, answer.forces, answer.forces_multiplier)["equilibrium"] < 1e-5
    assert force_residuals(wall, answer.forces, answer.forces_multiplier)["yield"] < 1e-8


@needs_mujoco
def test_forces_are_those_of_the_other_engine_where_statics_leaves_no_choice():
    # A single block has three unknown forces and three equations: both engines must find the same ones.
    wall = assembly(stack(1, 0.2, 0.4), 0.7)
    one, two = run(wall, orders=1, accuracy=1e-3), run_mujoco(wall, orders=1, accuracy=1e-3)
    assert two.forces_multiplier == pytest.approx(one.forces_multiplier, rel=2e-3)
    assert np.allclose(two.forces, one.forces, atol=4e-3 * wall.force_scale)


@needs_mujoco
def test_block_on_two_frictions_lies_inside_what_statics_allows():
    low, high = run_mujoco(two_friction_block(), orders=2).bracket
    assert 0.4 <= low <= high <= 0.6 / 1.1 * (1 + 5e-4)


@needs_mujoco
def test_wall_without_live_load_stands_or_falls_and_repeats_are_bit_identical():
    still = {"loads": {"live": None}}
    wall = assembly(running_bond(4, 2), 0.7, **still)
    one, two = run_mujoco(wall, orders=1), run_mujoco(wall, orders=1)
    assert one.finding is Finding.STANDS
    assert np.array_equal(one.forces, two.forces)
    assert force_residuals(wall, one.forces, 0.0)["equilibrium"] < 1e-5
    falls = run_mujoco(assembly(stack(3) | {"offsets": [0.0, 0.0, 0.2]}, 0.7, **still), orders=1)
    assert falls.finding is Finding.FALLS


@needs_mujoco
@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.4, 0.65, 0.75])
def test_wall_of_21_bricks_agrees_with_the_other_engine(friction):
    wall = assembly(running_bond(6, 3), friction)
    answer = run_mujoco(wall, orders=1)
    assert answer.multiplier == pytest.approx(min(friction, 13 / 23), rel=5e-3)
    assert force_residuals(wall, answer.forces, answer.forces_multiplier)["equilibrium"] < DE_MUJOCO.tolerance


@pytest.mark.slow
@needs_mujoco
def test_a_wall_of_105_bricks_comes_to_rest_under_its_dead_load():
    # With stiffer contacts its end bricks rocked for ever, and it counted as falling.
    answer = run_mujoco(assembly(running_bond(10, 10), 0.65, loads={"live": None}), orders=1)
    assert answer.finding is Finding.STANDS
    assert answer.details["contact_updates"] < 500 * assembly(running_bond(10, 10), 0.65).n_interfaces


@needs_mujoco
@pytest.mark.parametrize("iterations", [1, 2, 5])
def test_a_contact_solver_cut_short_is_undecided_and_never_a_number(iterations):
    # So few Newton iterations throw the blocks apart.
    answer = run_mujoco(assembly(running_bond(6, 3), 0.65), orders=1, iterations=iterations)
    assert (answer.status, answer.finding, answer.multiplier) == (Status.NOT_CONVERGED, Finding.NONE, None)
    assert "did not converge" in answer.sentence


@needs_mujoco
def test_mujoco_starting_again_by_itself_is_not_taken_for_rest():
    wall = assembly(stack(1, 0.2, 0.4), 0.7)
    engine = MujocoWall(
        wall, wall.free, np.arange(wall.n_interfaces), 100, MujocoTuning().uniform, SoftContacts().wall_impedance, 1e3
    )
    engine.restore(np.concatenate([np.full(3, 1e12), np.zeros(6)]))
    with pytest.raises(SolverFailed):
        engine.advance(100)


@needs_mujoco
def test_a_block_at_rest_has_sunk_as_far_as_the_stiffness_and_impedance_of_its_contacts_say():
    """MuJoCo bears a force f a unit mass by d (d k) r = (1 - d) f: penetration r, impedance d, stiffness k."""
    wall = assembly(stack(1, 0.4, 0.2), 0.7)

    def penetration(impedance: float) -> float:
        tuning = MujocoTuning().uniform
        engine = MujocoWall(wall, wall.free, np.arange(wall.n_interfaces), 100, tuning, impedance, 1e3)
        engine.advance(1500)
        engine.velocity()
        engine.advance(10)
        assert engine.unbalance(engine.velocity()) < 1e-6  # of the weight
        return SoftContacts().overlap - float(engine.save()[1])

    # Rest is reached to the 1e-6 above.
    assert penetration(0.5) / penetration(0.8) == pytest.approx((0.5 / 0.5**2) / (0.2 / 0.8**2), rel=1e-6)


def test_without_the_extra_the_user_is_told_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(InputError, match=r"drystone\[mujoco\]"):
        run_mujoco(assembly(stack(1), 0.5))
