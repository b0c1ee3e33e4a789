"""LU of a sparse matrix in a band, with row exchanges: LAPACK's, which factors singular matrices too and shows them.

Blocks of a wall touch few others, so that a band of about three unknowns a block of its longest front holds the whole
factor (reverse Cuthill-McKee order; George and Liu, 1981).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lapack
from scipy.sparse.csgraph import reverse_cuthill_mckee

from harness.model.assembly import FloatArray


class BandLU:
    """The factors of a square sparse matrix (N, N), of symmetric pattern.

    Attributes:
        pivots: (N,) of the columns; zero where no row is left that a column could take.
    """

    def __init__(self, matrix: sp.csc_matrix) -> None:
        self._order = reverse_cuthill_mckee(matrix, symmetric_mode=True)
        place = np.empty(len(self._order), dtype=np.int64)
        place[self._order] = np.arange(len(place))
        entries = matrix.tocoo()
        row, column = place[entries.row], place[entries.col]
        self._width = int(abs(row - column).max(initial=0))
        band = np.zeros((3 * self._width + 1, len(place)), order="F")
        band[2 * self._width + row - column, column] = entries.data
        self._band, self._exchanged, _ = lapack.dgbtrf(band, self._width, self._width, overwrite_ab=True)
        self.pivots = np.empty(len(place))
        self.pivots[self._order] = self._band[2 * self._width]

    def solve(self, right: FloatArray) -> FloatArray:
        """The solution (N,) or (N, k) for right sides; not finite where a pivot is zero."""
        solution, _ = lapack.dgbtrs(self._band, self._width, self._width, right[self._order], self._exchanged)
        out: FloatArray = np.empty_like(solution)
        out[self._order] = solution
        return out
