"""The factors of a block matrix, against numpy."""

from __future__ import annotations

import numpy as np
import pytest

from methods.numerics.block_lu import BlockFactor, BlockPattern

PAIRS = np.array([(0, 1), (1, 2), (0, 3), (1, 4), (2, 5), (3, 4), (4, 5)])
"""Neighbours among six blocks in two rows of three."""


@pytest.mark.parametrize("symmetric", [True, False])
def test_factors_solve_with_the_matrix(symmetric: bool) -> None:
    generator = np.random.default_rng(3)
    joined = np.eye(6, dtype=bool)
    joined[PAIRS[:, 0], PAIRS[:, 1]] = joined[PAIRS[:, 1], PAIRS[:, 0]] = True
    matrix = np.kron(joined, np.ones((3, 3))) * generator.normal(size=(18, 18))
    matrix += 12.0 * np.eye(18)
    if symmetric:
        matrix = 0.5 * (matrix + matrix.T)
    pattern = BlockPattern(PAIRS[:, 0], PAIRS[:, 1], 6)
    row, column = np.nonzero(matrix)
    values = np.zeros(pattern.n_values)
    values[pattern.place(row, column)] = matrix[row, column]
    factor = BlockFactor(pattern, values)
    assert factor.factorise(symmetric=symmetric)
    right = generator.normal(size=18)
    assert factor.solve(right) == pytest.approx(np.linalg.solve(matrix, right), rel=1e-12)
