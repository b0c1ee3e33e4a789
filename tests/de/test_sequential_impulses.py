"""Requirements on the engine of `de`: it solves the wall that pymunk solves, and finds its contact forces."""

from __future__ import annotations

import numpy as np
import pytest

from methods.de.engines.mass_scaling import courses, insertion_orders, tunings
from methods.de.engines.pymunk_joints import PymunkJoints
from methods.de.engines.sequential_impulses import SequentialImpulses
from methods.de.settings import HoldSettings
from tests.de.answers import run, unbalanced, unyielding
from tests.walls import assembly, running_bond, stack

ARCH = {"type": "ring", "inner_radius": 1.0, "outer_radius": 1.15, "count": 11, "angles": [160, 20]}


@pytest.mark.parametrize("pattern", [stack(3), ARCH], ids=["stack", "arch"])
def test_both_engines_come_to_one_multiplier(pattern):
    # Nothing is left open by statics at the collapse of these, so that no order of the sweeps matters.
    wall = assembly(pattern, 0.75)
    own, other = (run(wall, orders=1, engine=engine) for engine in ("sweeps", "pymunk"))
    assert own.multiplier == pytest.approx(other.multiplier, rel=1e-3)
    for answer in (own, other):
        assert unbalanced(wall, answer) < 1e-6
        assert unyielding(wall, answer) < 1e-12


def test_first_step_is_that_of_pymunk():
    """One block on the ground: one sweep over one interface has no order, and both engines make the same step."""
    wall = assembly(stack(1, 0.4, 0.2), 0.6)
    course = courses(wall)
    tuning = tunings(course, None)[0]
    _, blocks, joints = insertion_orders(wall, course, 1, 0)[0]
    engines = [make(wall, blocks, joints, 20, tuning) for make in (PymunkJoints, SequentialImpulses)]
    for engine in engines:
        engine.restore(np.zeros_like(engine.save()))
        engine.load(0.5)
        engine.advance(3)
    one, two = (engine.contact_forces() for engine in engines)
    # The strips of pymunk lie a few 1e-7 lengths apart.
    assert one == pytest.approx(two, rel=1e-5, abs=1e-5 * wall.force_scale)
    assert engines[0].velocity() == pytest.approx(engines[1].velocity(), abs=1e-5)


def in_given_order(wall, blocks, joints, sweeps, tuning, multiplier):
    """Velocities (n_free, 3) after one time step from rest, contact after contact in the order given, as formulas."""
    engine = SequentialImpulses(wall, blocks, joints, sweeps, tuning)
    engine.load(multiplier)
    place = {(int(p) // 2, int(p) % 2): k for k, p in enumerate(engine._points)}
    rows, inverse, velocity = engine._rows, engine._inverse, engine._push.copy()
    impulse = np.zeros((len(place), 2))
    for _ in range(sweeps):
        for joint in joints:
            for end in (0, 1):
                q = place[int(joint), end]
                a, b, (nx, ny) = rows.first[q], rows.second[q], rows.normal[q]
                n1, n2, t1, t2 = rows.arms[q]
                (vx, vy, _), va, vb = velocity[b] - velocity[a], velocity[a, 2], velocity[b, 2]
                opening, slip = vx * nx + vy * ny + vb * n2 - va * n1, vy * nx - vx * ny + vb * t2 - va * t1
                normal = max(impulse[q, 0] - opening * rows.across[q], 0.0)
                limit = rows.friction[q] * normal
                shear = min(max(impulse[q, 1] - slip * rows.along[q], -limit), limit)
                dn, ds = normal - impulse[q, 0], shear - impulse[q, 1]
                impulse[q] = normal, shear
                force = np.array([dn * nx - ds * ny, dn * ny + ds * nx])
                for body, sign, moment in ((a, -1.0, dn * n1 + ds * t1), (b, 1.0, dn * n2 + ds * t2)):
                    velocity[body, :2] += sign * (force * inverse[body, 0])
                    velocity[body, 2] += sign * (moment * inverse[body, 2])
    return velocity[:-1]


@pytest.mark.parametrize("order", range(4))
def test_sweeps_by_level_are_those_of_the_given_order_to_the_bit(order):
    wall = assembly(running_bond(5, 3), 0.65)
    course = courses(wall)
    _, blocks, joints = insertion_orders(wall, course, 4, 0)[order]
    tuning = tunings(course, None)[0]
    engine = SequentialImpulses(wall, blocks, joints, 7, tuning)
    engine.load(0.3)
    engine.advance(1)
    assert len(np.unique(engine._points)) == 2 * wall.n_interfaces
    assert np.array_equal(engine._velocity[:-1], in_given_order(wall, blocks, joints, 7, tuning, 0.3))


def test_restored_state_is_at_rest_with_the_forces_it_had():
    wall = assembly(running_bond(4, 2), 0.65)
    course = courses(wall)
    _, blocks, joints = insertion_orders(wall, course, 3, 0)[2]
    engine = SequentialImpulses(wall, blocks, joints, HoldSettings().iterations, tunings(course, None)[0])
    engine.advance(40)
    state, forces = engine.save(), engine.contact_forces()
    engine.load(0.4)
    engine.advance(40)
    assert np.abs(engine.contact_forces() - forces).max() > 1e-3 * wall.force_scale
    engine.restore(state)
    assert np.array_equal(engine.contact_forces(), forces)
    assert not engine.velocity().any()
