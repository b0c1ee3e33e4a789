"""Solves with a tangent that changes by one rank-one term at a time.

Small walls keep the dense inverse and correct it by Sherman-Morrison (1950). Larger ones keep a block LU of an
earlier tangent and the product form of the changes since then: with K_{j+1} = K_j + a_j b_j', y_j = K_j^-1 a_j,

    K_k^-1 x = K_0^-1 x - sum_j y_j alpha_j,   alpha_j = (b_j' K_0^-1 x - sum_{i<j} (b_j' y_i) alpha_i) / (1 + b_j' y_j)
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp
from scipy.linalg import lapack
from scipy.sparse.csgraph import reverse_cuthill_mckee

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.block_kernels import COLUMNS
from methods.numerics.block_lu import BlockFactor, BlockPattern
from methods.numerics.compiled import compiled
from methods.numerics.failures import SingularMatrix
from methods.numerics.vectors import largest
from methods.springs.model.point_loops import add_tangent
from methods.springs.model.wall_model import WallModel

_LEAST_STIFFNESS = 1e-4
"""Share of the stiffness of blocks against the ground below which a motion has none of its own: rounding of the tangent
leaves 1e-8 of it."""
_DENSE = 70
"""Unknowns up to which the dense inverse is faster than the sparse product form."""
_UPDATES = 64
"""Rank-one changes of one factor at most, for which the product form has room."""

Change = tuple[int, int, int]
"""A point, its state and the state that it turns to."""


class SingularTangent(SingularMatrix):
    """The tangent has no usable inverse in these states."""


class Factor(Protocol):
    """What the continuation needs of a factorised tangent.

    Attributes:
        count: changes since the last factorisation; capacity: how many there may be.
        factorisations: in all; careful: whether the last one chose its pivots among all rows.
        is_regularised: whether the last one had the regularisation added, so that solutions are to be refined.
    """

    count: int
    capacity: int
    factorisations: int
    careful: bool
    is_regularised: bool

    def refactor(
        self,
        state: IntArray,
        shift: float = 0.0,
        careful: bool = False,
        bordered: Sequence[int] = (),
        regularised: bool = False,
    ) -> None:
        """Factorise the tangent in these states afresh.

        Args:
            state: (P,) states; shift: times the inertia, which is added.
            careful: asks for pivots among all rows, which keep more digits near a limit point and cost more.
            bordered: displacements that springs of unit stiffness are added to.
            regularised: whether the regularisation is added.

        Raises:
            SingularTangent: a motion has no stiffness beyond rounding, nor by shift or regularisation.
        """

    def solve(self, right: FloatArray) -> FloatArray:
        """K^-1 right (N,)."""

    def foresees(self, change: Change) -> bool:
        """Whether `solve_change` costs little."""

    def foresee(self, changes: list[Change]) -> None:
        """Solve for up to COLUMNS changes at once, which `solve_change` is likely to be asked for."""

    def solve_change(self, change: Change) -> FloatArray:
        """K^-1 a (N,) for a change a b' of the tangent that is foreseen."""

    def update(self, y: FloatArray, index: IntArray, b: FloatArray, denominator: float) -> None:
        """Turn K into K + a b' where y = K^-1 a and denominator = 1 + b'y."""


def make_factor(model: WallModel) -> Factor:
    """The form that suits the size of the wall."""
    return DenseFactor(model) if model.n_unknowns <= _DENSE else SparseFactor(model)


def refactor_any(factor: Factor, state: IntArray, careful: bool = False, bordered: Sequence[int] = ()) -> None:
    """Factorise the tangent in these states afresh, with the regularisation where it is singular.

    A block that nothing touches, or that balances on an edge, takes no stiffness from its joints. Loads that do no work
    on such a motion leave the wall in equilibrium all the same, and the regularisation keeps it where it is: solutions
    that are refined until the tangent without it is met have none of its force (proximal point; Rockafellar, 1976).
    """
    try:
        factor.refactor(state, careful=careful, bordered=bordered)
    except SingularTangent:
        factor.refactor(state, careful=careful, bordered=bordered, regularised=True)


class DenseFactor:
    """The inverse itself."""

    def __init__(self, model: WallModel) -> None:
        self.model = model
        self.capacity = _UPDATES
        self.count = 0
        self.factorisations = 0
        self.careful = True
        self.is_regularised = False
        self.inverse = np.empty((0, 0))
        self._size = np.sqrt(model.regularised)

    def refactor(
        self,
        state: IntArray,
        shift: float = 0.0,
        careful: bool = True,
        bordered: Sequence[int] = (),
        regularised: bool = False,
    ) -> None:
        """Invert afresh. Raises SingularTangent."""
        self.count = 0
        self.factorisations += 1
        self.is_regularised = regularised
        matrix = self.model.tangent(state, shift, regularised).toarray()
        for border in bordered:
            matrix[border, border] += 1.0
        lu, pivots, info = sla.lapack.dgetrf(matrix, overwrite_a=True)
        if info == 0:
            self.inverse, info = sla.lapack.dgetri(lu, pivots, overwrite_lu=True)
        if info != 0 or not np.isfinite(self.inverse).all():
            raise SingularTangent("the tangent is singular in these states")
        if not (shift or regularised) and _LEAST_STIFFNESS * largest((self.inverse * self._size).T @ self._size) > 1.0:
            raise SingularTangent("the tangent is singular to rounding in these states")

    def solve(self, right: FloatArray) -> FloatArray:
        """K^-1 right (N,)."""
        out: FloatArray = self.inverse @ right
        return out

    def foresees(self, change: Change) -> bool:
        """The inverse is at hand."""
        return True

    def foresee(self, changes: list[Change]) -> None:
        """Nothing to do."""

    def solve_change(self, change: Change) -> FloatArray:
        """K^-1 a (N,)."""
        index, a, _ = self.model.change(*change)
        out: FloatArray = self.inverse[:, index] @ a
        return out

    def update(self, y: FloatArray, index: IntArray, b: FloatArray, denominator: float) -> None:
        """Sherman-Morrison."""
        row = b @ self.inverse[index]
        self.inverse = sla.blas.dger(-1.0 / denominator, y, row, a=self.inverse, overwrite_a=1)
        self.count += 1


class SparseFactor:
    """A block LU, with row exchanges where its pivots cannot be trusted, and the product form of the changes since."""

    def __init__(self, model: WallModel) -> None:
        self.model = model
        self.capacity = _UPDATES
        self.count = 0
        self.factorisations = 0
        n = model.n_unknowns
        pattern = BlockPattern(model.unknown[:, 0] // 3, model.unknown[:, 3] // 3, n // 3)
        self._slot = pattern.slot(model.unknown)
        self._diagonal = pattern.diagonal
        self._lu = BlockFactor(pattern)
        self.careful = False
        self.is_regularised = False
        self._exchanged: BandLU | None = None
        self._foreseen: dict[Change, FloatArray] = {}
        self._y = np.empty((self.capacity, n))
        self._coupling = np.zeros((self.capacity, self.capacity))
        self._denominator = np.empty(self.capacity)
        self._index = np.empty((self.capacity, 6), dtype=np.int64)
        self._b = np.empty((self.capacity, 6))

    def refactor(
        self,
        state: IntArray,
        shift: float = 0.0,
        careful: bool = False,
        bordered: Sequence[int] = (),
        regularised: bool = False,
    ) -> None:
        """Factorise afresh. Raises SingularTangent."""
        self.count = 0
        self.factorisations += 1
        self.is_regularised = regularised
        self._exchanged = None
        self._foreseen.clear()
        added = self.model.added(shift, regularised)
        if careful or not self._factorise_blocks(state, added, bordered):
            self._exchanged = self._with_row_exchanges(self.model.tangent(state, shift, regularised), added, bordered)
        self.careful = self._exchanged is not None

    def _factorise_blocks(self, state: IntArray, added: FloatArray, bordered: Sequence[int]) -> bool:
        model = self.model
        self._lu.values[:] = 0.0
        springs = model.interface, model.position, model.kn, model.kt, model.mu, model.lift
        add_tangent(self._slot, model.rows, *springs, state, self._lu.values)
        self._lu.values[self._diagonal] += added
        for border in bordered:
            self._lu.values[self._diagonal[border]] += 1.0
        return self._lu.factorise(model.options.growth) and self._stiff(self._lu.values[self._diagonal], added)

    def _stiff(self, pivots: FloatArray, added: FloatArray) -> bool:
        """Whether every pivot (N,) is beyond rounding, be it by what was added to the tangent."""
        return bool((abs(pivots) >= _LEAST_STIFFNESS * np.where(added == 0.0, self.model.regularised, 0.0)).all())

    def _with_row_exchanges(self, matrix: sp.csc_matrix, added: FloatArray, bordered: Sequence[int]) -> BandLU:
        for border in bordered:
            matrix[border, border] += 1.0
        lu = BandLU(matrix)
        if not lu.pivots.all() or not self._stiff(lu.pivots, added):
            raise SingularTangent("the tangent is singular to rounding in these states")
        return lu

    def solve(self, right: FloatArray) -> FloatArray:
        """K^-1 right (N,). Raises SingularTangent when the result is not finite."""
        return self._corrected((self._exchanged or self._lu).solve(right))

    def foresees(self, change: Change) -> bool:
        """Whether the factorised tangent has been solved for this change."""
        return change in self._foreseen

    def foresee(self, changes: list[Change]) -> None:
        """Solve the factorised tangent for up to COLUMNS changes at once."""
        right = np.zeros((self.model.n_unknowns, COLUMNS))
        first = self.model.add_changes(changes[:COLUMNS], right)
        if self._exchanged is not None:
            right = self._exchanged.solve(right)
        else:
            self._lu.solve_many(first // 3, right)
        for change, x in zip(changes, np.ascontiguousarray(right.T), strict=False):
            self._foreseen[change] = x

    def solve_change(self, change: Change) -> FloatArray:
        """K^-1 a (N,) from what was foreseen."""
        return self._corrected(self._foreseen[change].copy())

    def _corrected(self, x: FloatArray) -> FloatArray:
        """K^-1 right from the solution x (N,) of the factorised tangent, which is overwritten."""
        if not _product_form(x, self.count, self._y, self._coupling, self._denominator, self._index, self._b):
            raise SingularTangent("the tangent is singular in these states")
        return x

    def update(self, y: FloatArray, index: IntArray, b: FloatArray, denominator: float) -> None:
        """Append one term to the product form."""
        form = self._y, self._coupling, self._denominator, self._index, self._b
        _append(y, index, b, denominator, self.count, *form)
        self.count += 1


@compiled
def _product_form(
    x: FloatArray,
    count: int,
    y: FloatArray,
    coupling: FloatArray,
    denominator: FloatArray,
    index: IntArray,
    b: FloatArray,
) -> bool:
    """Correct x (N,) in place for the first `count` changes; whether all of it is finite."""
    alpha = np.empty(count)
    for j in range(count):
        total = 0.0
        for i in range(6):
            total += b[j, i] * x[index[j, i]]
        for i in range(j):
            total -= coupling[j, i] * alpha[i]
        alpha[j] = total / denominator[j]
    for j in range(count):
        for i in range(len(x)):
            x[i] -= alpha[j] * y[j, i]
    return largest(x) < np.inf


@compiled
def _append(
    new: FloatArray,
    new_index: IntArray,
    new_b: FloatArray,
    new_denominator: float,
    count: int,
    y: FloatArray,
    coupling: FloatArray,
    denominator: FloatArray,
    index: IntArray,
    b: FloatArray,
) -> None:
    """Write a change behind the first `count` ones."""
    for i in range(count):
        total = 0.0
        for j in range(6):
            total += new_b[j] * y[i, new_index[j]]
        coupling[count, i] = total
    y[count] = new
    index[count] = new_index
    b[count] = new_b
    denominator[count] = new_denominator


class BandLU:
    """LAPACK's LU in a band, with row exchanges, of a sparse matrix (N, N) of symmetric pattern, which may be singular.

    Blocks of a wall touch few others, so that a band of about three unknowns a block of its longest front holds the
    whole factor (reverse Cuthill-McKee order; George and Liu, 1981).

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
