"""Walls led from rest to rest by slow motion, and under a load that is raised in finite steps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.walls import drawn, running_bond
from harness.model.assembly import Assembly
from methods.springs.model.factor import make_factor
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import build_model
from methods.springs.rest.newton import newton
from methods.springs.rest.pseudo_transient import PseudoTransient


def standing(wall: Assembly, commits: bool = True) -> PseudoTransient:
    """The wall come to rest under its dead load by slow motion."""
    model = build_model(wall, GapSettings())
    factor = make_factor(model)
    virgin = newton(model, factor, np.zeros(model.n_unknowns), 0.0, model.history, 0)
    motion = PseudoTransient(model, factor, virgin, commits)
    assert motion.move(0.0).found
    return motion


@pytest.mark.parametrize("commits", [True, False])
@pytest.mark.parametrize(("wall", "multiplier"), [(running_bond(10, 5, 0.65), 0.45), (drawn(2, 9, 16), 0.02)])
def test_at_rest_the_law_of_the_gap_points_and_equilibrium_hold(
    wall: Assembly, multiplier: float, commits: bool
) -> None:
    motion = standing(wall, commits)
    rest, model = motion.move(multiplier), motion.model
    assert rest.found
    assert rest.multiplier == multiplier
    assert np.any(rest.history != model.history) == commits
    opening, slip = model.strains(rest.u)
    normal, shear = model.forces(rest.u, rest.history, rest.state)
    limit = model.mu * normal
    assert normal == pytest.approx(np.maximum(-model.kn * opening, 0.0), abs=1e-8)
    assert shear == pytest.approx(np.clip(model.kt * slip + rest.history, -limit, limit), abs=1e-8)
    left = np.abs(model.residual(rest.u, multiplier, rest.history, rest.state)).max()
    assert left < 1e-8
    loads = np.abs(model.dead).max() + multiplier * np.abs(model.live).max()
    assert rest.residual == pytest.approx(left / loads, rel=1e-9, abs=0.0)


def test_a_step_to_a_multiplier_that_no_forces_bear_leaves_the_wall_where_it_was() -> None:
    motion = standing(running_bond(10, 5, 0.65))
    before = motion.move(0.45)
    fall = motion.move(0.6)
    assert not fall.found
    assert (motion.model.dead + 0.6 * motion.model.live) @ fall.rate > 0.0
    assert motion.move(0.45).u == pytest.approx(before.u, rel=1e-6)


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
