"""A path that starts from given contact forces stands in equilibrium with them."""

from __future__ import annotations

import numpy as np

from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import make_problem
from methods.la.interior.interior_point import PathSettings, follow_path, start_point
from methods.springs.model.factor import make_factor
from methods.springs.model.gap_law import gap_forces
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import build_model
from methods.springs.path.continuation import PathFollower
from tests.la.bodies import running_bond


def test_springs_carry_the_given_forces_before_anything_moves() -> None:
    wall = running_bond(6, 3, 0.2, 0.65)
    problem = make_problem(wall)
    safe = follow_path(problem, NewtonMatrix(problem), start_point(problem), PathSettings(dilatancy=1.0, gap=0.1))
    forces = problem.to_forces(problem.forces_of_slacks(safe.point.slack))
    model = build_model(wall, GapSettings())
    follower = PathFollower.from_forces(
        model, make_factor(model), safe.point.multiplier * problem.unit_multiplier, forces
    )
    normal, shear = np.empty(model.n_points), np.empty(model.n_points)
    gap_forces(follower.opening, follower.trial, model.kn, model.mu, model.lift, follower.state, normal, shear)
    carried = model.end_forces(normal, shear)
    assert np.abs(carried - forces).max() <= 1e-9 * wall.force_scale
    assert (normal > 0.0).all()
    assert (np.abs(shear) <= model.mu * normal).all()
    assert follower.worst_residual <= 1e-8
