"""The law of joints by hand, and the matrices that carry it to blocks: velocities of points, virtual work."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.joint_law import JointLaw, block_diagonal
from tests.walls import assembly, running_bond

LAW = JointLaw(np.array([0.5, 0.25]), np.array([0.2, 0.0]))
FORCES = np.array([[3.0, 1.0, 1.5], [1.0, 7.0, -2.0]])


def test_slacks_by_hand():
    # Strengths .5 x 4 and .25 x 8; the second joint is at its limit against s < 0.
    assert LAW.strength(FORCES).tolist() == [2.0, 2.0]
    assert LAW.slacks(FORCES).tolist() == [[3.0, 1.0, 3.5, 0.5], [1.0, 7.0, 0.0, 4.0]]
    np.testing.assert_array_equal(np.einsum("pij,pj->pi", LAW.rows, FORCES), LAW.slacks(FORCES))


@pytest.mark.parametrize(
    ("rate", "strains"),
    [
        (0, [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
        (1, [[0.0, 1.0, 0.0], [0.0, 1.0, 0.0]]),
        (2, [[0.2, 0.2, 1.0], [0.0, 0.0, 1.0]]),
        (3, [[0.2, 0.2, -1.0], [0.0, 0.0, -1.0]]),
    ],
)
def test_an_end_opens_alone_and_a_slip_lifts_both_ends_by_the_dilatancy(rate: int, strains: list[list[float]]):
    assert LAW.flow[:, :, rate].tolist() == strains


def test_flow_of_the_associated_law_is_normal_to_yield():
    law = LAW.associated
    np.testing.assert_array_equal(law.flow, law.rows.transpose(0, 2, 1))
    np.testing.assert_array_equal(law.rows, LAW.rows)


def test_what_a_joint_at_its_limit_dissipates_is_friction_less_what_lifting_gives_back():
    # Slip 1 against s = -2 under N = 4: work of the joint 2 - .2 x 4 on a joint that lifts by .2.
    work = np.array([3.0, 1.0, -2.0]) @ LAW.flow[0] @ np.array([0.0, 0.0, 1.0, 0.0])
    assert -work == pytest.approx(2.0 - 0.2 * 4.0)


def test_matrices_on_a_diagonal_keep_their_places_and_not_their_zeros():
    found = block_diagonal(np.array([[[1.0, 0.0, 2.0]], [[0.0, 3.0, 4.0]]]))
    assert found.toarray().tolist() == [[1.0, 0.0, 2.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 3.0, 4.0]]
    assert found.nnz == 4
    tall = block_diagonal(np.array([[[1.0], [2.0]], [[3.0], [4.0]]]))
    assert tall.toarray().tolist() == [[1.0, 0.0], [2.0, 0.0], [0.0, 3.0], [0.0, 4.0]]


def test_strains_are_the_velocities_of_the_points_of_b_beside_those_of_a():
    wall = assembly(running_bond(2, 2))
    velocity = np.zeros((wall.n_blocks, 3))
    velocity[wall.free] = np.random.default_rng(4).normal(size=(wall.n_free, 3))

    def of_point(block: int, point: np.ndarray) -> np.ndarray:
        x, y = point - wall.centroid[block]
        return velocity[block, :2] + velocity[block, 2] * np.array([-y, x])

    by_matrix = (wall.kinematic_matrix @ velocity[wall.free].ravel()).reshape(-1, 3)
    for p, (a, b) in enumerate(zip(wall.block_a, wall.block_b, strict=True)):
        first, second = (of_point(b, point) - of_point(a, point) for point in (wall.end1[p], wall.end2[p]))
        expected = [first @ wall.normal[p], second @ wall.normal[p], first @ wall.tangent[p]]
        assert by_matrix[p] == pytest.approx(expected, abs=1e-12)
