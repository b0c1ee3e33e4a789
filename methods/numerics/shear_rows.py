"""The law of joints as rows of linear programmes: shears within friction and cohesion, and the units of unknowns."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import FloatArray, IntArray
from harness.model.joint_law import JointLaw

COST = 1e4
"""Of the multiplier in a programme for the greatest one: speeds of the dual mechanism are of this order, far above what
HiGHS rounds off. Programmes that count weights in those of all blocks take it a block."""

Entries = tuple[FloatArray, IntArray, IntArray]
"""Values, rows and columns of a sparse matrix."""


def shear_limits(law: JointLaw) -> sp.csr_matrix:
    """The sparse (2m, 3m) matrix of `entries_of_shear_limits` of a law's rows."""
    m = len(law.friction)
    values, rows, columns = entries_of_shear_limits(law.rows)
    return sp.csr_matrix((values, (rows, columns)), shape=(2 * m, 3 * m))


def entries_of_shear_limits(rows: FloatArray) -> Entries:
    """Entries of the (2m, 3m) shear rows mu (n1 + n2) +- s of the rows (m, 4, 3) of a law, over `shear_unit`.

    Shears themselves are the unknowns, because their difference from a large strength would cost digits.
    """
    m = len(rows)
    values = rows[:, 2:] / shear_unit(rows[:, 2, 0])[:, None, None]
    row = np.arange(2 * m).reshape(m, 2, 1)
    column = 3 * np.arange(m).reshape(m, 1, 1) + np.arange(3)
    return values.ravel(), np.broadcast_to(row, values.shape).ravel(), np.broadcast_to(column, values.shape).ravel()


def shear_unit(slope: FloatArray) -> FloatArray:
    """(m,) what one unit of a shear slack is worth in a programme: the slope mu (m,) where that is above one."""
    return np.asarray(np.maximum(slope, 1.0))


def least_shear_slacks(law: JointLaw) -> FloatArray:
    """(2m,) least values of the rows of `shear_limits`: minus the cohesion, zero in dry joints."""
    return np.asarray((0.0 - law.constant[:, 2:] / shear_unit(law.friction)[:, None]).ravel())


def rows_of_blocks(n_free: int, m: int) -> IntArray:
    """(3 n_free + 2 m,) block behind each row of equilibrium, and a number of its own for each of 2 m further rows."""
    return np.append(np.repeat(np.arange(n_free), 3), n_free + np.arange(2 * m))
