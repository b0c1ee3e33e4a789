"""What can fail in numerics, as exceptions of their own: catching them hides no other fault."""

from __future__ import annotations

from typing import Any

import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu


class NumericalFailure(ArithmeticError):
    """A computation cannot go on in floating-point numbers."""


class SingularMatrix(NumericalFailure):
    """A matrix is singular to rounding."""


def sparse_lu(matrix: sp.csc_matrix, **options: Any) -> SuperLU:
    """The sparse LU factors of a square matrix, with the options of `scipy.sparse.linalg.splu`.

    Raises:
        SingularMatrix: it has no factors.
    """
    try:
        return splu(matrix, **options)
    except RuntimeError as error:
        raise SingularMatrix(str(error)) from error
