"""Requirements on what a hold may claim: shaking in place is no motion, and what one tuning holds does not fall."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.method import Finding, Status
from methods.de.answer import solve_by_holds
from methods.de.courses import Tuning, courses, insertion_orders
from methods.de.hold import lasting
from methods.de.settings import HoldSettings
from methods.de.space import StripSpace
from tests.walls import assembly, stack

SETTINGS = HoldSettings()
MECHANISM = np.random.default_rng(0).normal(size=(12, 3))


def lasts(speeds, shaking, surplus=0.01):
    """What `lasting` says of velocity fields along one mechanism at these speeds, with random ones on top."""
    generator = np.random.default_rng(1)
    fields = [speed * MECHANISM + shaking * generator.normal(size=MECHANISM.shape) for speed in speeds]
    return lasting(fields, [float(np.abs(field).max()) for field in fields], [surplus] * len(fields), SETTINGS)


def test_a_mechanism_at_one_speed_moves_however_it_shakes_and_its_mean_is_the_mechanism():
    motion = lasts(np.full(60, 0.1), 0.05)
    assert motion is not None
    assert np.sum(motion * MECHANISM) > 0.95 * np.linalg.norm(motion) * np.linalg.norm(MECHANISM)
    assert np.linalg.norm(motion) == pytest.approx(0.1 * np.linalg.norm(MECHANISM), rel=0.1)


def test_a_motion_that_the_loads_do_not_drive_is_none():
    assert lasts(np.full(60, 0.1), 0.0, surplus=-1e-3) is None


@pytest.mark.parametrize(
    ("speeds", "shaking"),
    [
        (np.zeros(60), 0.1),
        (0.1 * np.cos(np.pi * np.arange(60)), 0.0),
        (0.1 * 0.97 ** np.arange(60), 0.0),
        (np.where(np.arange(60) == 50, 1e-9, 0.1), 0.0),
        (np.full(12, 0.1), 0.0),
    ],
    ids=["shakes", "to and fro", "slows down", "rested once", "too short a hold"],
)
def test_what_shakes_slows_down_or_rested_once_is_not_moving(speeds, shaking):
    assert lasts(speeds, shaking) is None


@pytest.mark.parametrize(("load", "driven"), [(0.0, False), (0.5, True)])
def test_the_loads_drive_what_they_can_move(load, driven):
    """One block 0.4 x 0.2 at friction 0.3 slides to the right at 0.5 of its weight, and not at 0."""
    wall = assembly(stack(1, 0.4, 0.2), 0.3)
    engine = StripSpace(wall, *insertion_orders(wall, courses(wall), 1, 0)[0][1:], 10, Tuning(0.0, 0.95))
    engine.load(load)
    velocity = np.zeros((wall.n_blocks, 3))
    velocity[~wall.fixed] = 0.1, 0.0, 0.0
    assert (engine.surplus(velocity) > 0.0) == driven
    assert engine.surplus(velocity) == pytest.approx(0.1 * load - 0.1**2)


@pytest.mark.parametrize("quick", [True, False])
def test_a_wall_falls_only_where_it_moves_with_every_tuning(quick):
    wall, falling = assembly(stack(3), 0.7), assembly(stack(3) | {"offsets": [0.0, 0.0, 0.2]}, 0.7)
    settings = HoldSettings(orders=1, work=10**8 if quick else 1)
    holds, falls = Tuning(0.4, 0.98), Tuning(0.0, 0.95)

    def engine(blocks, joints, tuning):
        return StripSpace(wall if tuning == holds else falling, blocks, joints, settings.iterations, tuning)

    for candidates in ([holds, falls], [falls, holds]):
        answer = solve_by_holds(wall, settings, engine, candidates)
        # Out of work after the dead load, the bracket is not found: that is all there is to say.
        found = (Status.OK, Finding.COLLAPSES) if quick else (Status.NOT_CONVERGED, Finding.NONE)
        assert (answer.status, answer.finding) == found
    assert solve_by_holds(falling, settings, engine, [falls]).finding is Finding.FALLS
