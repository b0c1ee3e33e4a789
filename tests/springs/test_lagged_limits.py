"""Walls led from rest to rest under a load that is raised in finite steps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from harness.model.assembly import Assembly
from methods.la.irregular_walls import drawn
from methods.springs.equilibrium import gravity_state
from methods.springs.factor import make_factor
from methods.springs.gap_law import gap_forces
from methods.springs.lagged_limits import SlowMotion
from methods.springs.patterns import running_bond
from methods.springs.settings import GapSettings
from methods.springs.wall_model import build_model


def standing(wall: Assembly) -> SlowMotion:
    """The wall under its dead load."""
    model = build_model(wall, GapSettings())
    gravity = gravity_state(model, make_factor(model))
    assert gravity.found
    return SlowMotion(model, gravity.u, 0.0, model.history)


@pytest.mark.parametrize(("wall", "multiplier"), [(running_bond(10, 5, 0.65), 0.45), (drawn(2, 9, 16), 0.02)])
def test_at_rest_the_law_of_the_gap_points_and_equilibrium_hold(wall: Assembly, multiplier: float) -> None:
    motion = standing(wall)
    assert motion.move(multiplier)
    model, rest, history = motion.model, motion.rest, motion.history()
    opening, slip = model.strains(rest.u)
    state = model.states(rest.u, history)
    normal, shear = np.empty(model.n_points), np.empty(model.n_points)
    gap_forces(opening, model.kt * slip + history, model.kn, model.mu, state, normal, shear)
    assert rest.multiplier == multiplier
    assert np.abs(opening - rest.opening).max() < 1e-9
    assert np.abs(shear - rest.shear).max() < 1e-8
    assert np.abs(model.residual(rest.u, multiplier, history, state)).max() < 1e-8


def test_a_step_to_a_multiplier_that_no_forces_bear_leaves_the_wall_where_it_was() -> None:
    motion = standing(running_bond(10, 5, 0.65))
    before = motion.rest
    assert not motion.move(0.6)
    assert motion.rest is before


def test_the_load_is_raised_to_near_the_plateau_and_no_further() -> None:
    """55 bricks end at .505615, after a peak of .50574."""
    motion = standing(running_bond(10, 5, 0.65))
    raised = [rest.multiplier for rest in motion.raise_load(1.0)]
    assert raised == sorted(raised)
    assert 0.9 * 0.505615 < raised[-1] < 0.50575


def test_a_load_that_is_far_too_large_at_once_is_given_up() -> None:
    """The least multiplier tried of this scale is 1,000 and more, where 55 bricks bear .5."""
    assert not list(standing(running_bond(10, 5, 0.65)).raise_load(1e6))


def test_a_load_that_presses_down_is_raised_no_further_than_to_a_million_times_its_scale() -> None:
    wall = running_bond(4, 2, 0.65)
    raised = [rest.multiplier for rest in standing(replace(wall, live=wall.dead)).raise_load(1.0)]
    assert 1e5 < raised[-1] <= 1e6
