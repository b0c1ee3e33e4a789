"""The law of dry joints in one place: which forces they bear and how they move when those are at their limit.

Forces r = (n1, n2, s) of an interface lie in a cone of four rows, y = S r >= 0: no tension at either end, and shear
within friction both ways. At collapse it moves along the flow vectors of the rows that are zero, q = E g with
rates g = (open1, open2, slip+, slip-) >= 0 and q = (open1, open2, slip), as strains are defined in `assembly`.
A slip lifts both ends by the dilatancy psi, 0 <= psi <= mu: E = S' for psi = mu (associated flow), and nothing is
lifted for psi = 0. Sources: Coulomb (1776); Drucker (1954) for flow with dilatancy; Baggio and Trovalusci (1995).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import scipy.sparse as sp

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class JointLaw:
    """Coulomb's law of m interfaces.

    Attributes:
        friction: (m,) coefficients mu, zero or more.
        dilatancy: (m,) coefficients psi by which a slip lifts the ends, from zero to mu.
    """

    friction: FloatArray
    dilatancy: FloatArray

    @property
    def rows(self) -> FloatArray:
        """(m, 4, 3) rows S of the yield slacks y = S r = (n1, n2, mu N + s, mu N - s), N = n1 + n2."""
        return _rows(self.friction)

    @property
    def flow(self) -> FloatArray:
        """(m, 3, 4) flow vectors E, one a column, of the strains q = E g."""
        return np.asarray(_rows(self.dilatancy).transpose(0, 2, 1))

    def strength(self, forces: FloatArray) -> FloatArray:
        """(m,) greatest shear mu (n1 + n2) that forces (m, 3) leave each interface."""
        return np.asarray(self.friction * (forces[:, 0] + forces[:, 1]))

    def slacks(self, forces: FloatArray) -> FloatArray:
        """(m, 4) yield slacks S r of forces (m, 3), negative where they break the law."""
        strength, shear = self.strength(forces), forces[:, 2]
        return np.column_stack([forces[:, :2], strength + shear, strength - shear])

    @property
    def associated(self) -> JointLaw:
        """The same joints with the dilatancy of associated flow."""
        return JointLaw(self.friction, self.friction)


def _rows(slope: FloatArray) -> FloatArray:
    rows = np.zeros((len(slope), 4, 3))
    rows[:, 0, 0] = rows[:, 1, 1] = rows[:, 2, 2] = 1.0
    rows[:, 3, 2] = -1.0
    rows[:, 2:, :2] = slope[:, None, None]
    return rows


def block_diagonal(parts: FloatArray) -> sp.csr_matrix:
    """Sparse (a m, b m) matrix with the m matrices (m, a, b) on its diagonal; zeros within them are left out."""
    import scipy.sparse as sp

    m, a, b = parts.shape
    part, row, column = np.nonzero(parts)
    return sp.csr_matrix((parts[part, row, column], (a * part + row, b * part + column)), shape=(a * m, b * m))
