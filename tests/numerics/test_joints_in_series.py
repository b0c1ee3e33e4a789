"""Further limits of joints, as joints in series: laws of more rows than four, by methods that know of four alone."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.optimize import linprog

from harness.model.assembly import Assembly
from harness.model.joint_law import block_diagonal
from methods.numerics.joints_in_series import FurtherLimits, in_series
from tests.pressed_walls import found
from tests.walls import assembly, running_bond, stack

METHODS = ("la", "la-associated", "fe")


def capped(wall: Assembly, cap: float) -> Assembly:
    """The wall whose joints bear no shear above `cap`, whatever presses: two rows more, cap + s and cap - s."""
    m = wall.n_interfaces
    constant = np.column_stack([np.full((m, 2), wall.force_scale), np.full((m, 2), cap)])
    return in_series(wall, FurtherLimits(np.arange(m), wall.end1, wall.end2, np.zeros(m), np.zeros(m), constant))


def greatest_by_rows(wall: Assembly, cap: float) -> float:
    """The greatest multiplier of forces within six rows a joint, as one linear programme of scipy."""
    m = wall.n_interfaces
    dead, live = wall.free_loads()
    cap_rows = np.broadcast_to(np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]), (m, 2, 3))
    rows = block_diagonal(np.concatenate([wall.law.rows, cap_rows], axis=1))
    constant = np.column_stack([wall.constant, np.full((m, 2), cap)]).ravel()
    cost = np.append(np.zeros(3 * m), -1.0)
    solved = linprog(
        cost,
        A_ub=sp.hstack([-rows, sp.csr_matrix((6 * m, 1))]),
        b_ub=constant,
        A_eq=sp.hstack([wall.kinematic_matrix.T, live[:, None]]),
        b_eq=-dead,
        bounds=(None, None),
    )
    assert solved.status == 0
    return float(-solved.fun)


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize(("cap", "value"), [(0.2, 0.2), (0.45, 0.45), (0.55, 0.5), (2.0, 0.5)])
def test_a_block_whose_shear_is_capped_slides_at_the_lesser_of_its_two_limits(name: str, cap: float, value: float):
    """min(mu, cap / W): a law of six rows."""
    wall = assembly(stack(1, 1.0, 0.2), 0.5)
    assert found(name, capped(wall, cap * wall.force_scale)).multiplier == pytest.approx(value, rel=1e-9)


@pytest.mark.parametrize("cap", [0.3, 1.0, 3.0])
def test_joints_in_series_are_a_law_of_six_rows(cap: float):
    wall = assembly(running_bond(3, 3), 0.65)
    cap *= wall.force_scale / wall.n_free
    assert found("la-associated", capped(wall, cap)).multiplier == pytest.approx(greatest_by_rows(wall, cap), rel=1e-8)


def test_several_limits_of_one_joint_all_hold():
    wall = assembly(stack(1, 1.0, 0.2), 0.5)
    twice = in_series(
        wall,
        FurtherLimits(
            np.array([0, 0]),
            np.repeat(wall.end1, 2, axis=0),
            np.repeat(wall.end2, 2, axis=0),
            np.zeros(2),
            np.zeros(2),
            wall.force_scale * np.array([[1.0, 1.0, 0.4, 0.4], [1.0, 1.0, 0.3, 0.3]]),
        ),
    )
    assert twice.n_blocks == wall.n_blocks + 2
    assert found("la", twice).multiplier == pytest.approx(0.3, rel=1e-9)
