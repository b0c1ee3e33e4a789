"""LU in a band: solutions, and pivots that show singular matrices."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from methods.springs.model.factor import BandLU


def banded(n: int, seed: int) -> sp.csc_matrix:
    """A random matrix (n, n) with entries near a diagonal that is found under no order of its rows."""
    generator = np.random.default_rng(seed)
    near = abs(np.subtract.outer(np.arange(n), np.arange(n))) <= 3
    order = generator.permutation(n)
    return sp.csc_matrix((generator.normal(size=(n, n)) * near)[order][:, order])


def test_solves_for_one_right_side_and_for_many():
    matrix = banded(40, 1)
    factors = BandLU(matrix)
    right = np.random.default_rng(2).normal(size=(40, 3))
    assert np.allclose(matrix @ factors.solve(right), right, atol=1e-9)
    assert np.allclose(matrix @ factors.solve(right[:, 0]), right[:, 0], atol=1e-9)


def test_pivots_multiply_to_the_determinant():
    matrix = banded(12, 3)
    assert np.isclose(abs(np.prod(BandLU(matrix).pivots)), abs(np.linalg.det(matrix.toarray())), rtol=1e-10)


def test_a_column_that_no_row_is_left_for_has_a_pivot_of_zero():
    matrix = banded(20, 4).toarray()
    matrix[:, 7] = matrix[7] = 0.0
    pivots = BandLU(sp.csc_matrix(matrix)).pivots
    assert pivots[7] == 0.0
    assert np.count_nonzero(pivots) == 19


def test_singular_matrices_come_to_an_end():
    """SuperLU reads beyond its arrays where no row is left: a wall whose joints crush ended the process."""
    for seed in range(50):
        matrix = banded(30, seed).toarray()
        matrix[:, 5] = matrix[:, 6]
        matrix[11] = 0.0
        assert abs(BandLU(sp.csc_matrix(matrix)).pivots).min() < 1e-12
