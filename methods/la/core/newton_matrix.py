"""The Newton matrix K = C' D C of the interior point, assembled block by block and factorised in a fixed order.

D holds one 3 x 3 flexibility per interface. The pattern of K is the adjacency of the blocks, so the order of
elimination is found once. SuperLU factorises small walls, by nested dissection; larger ones have factors in dense
supernodes, which is faster but loads the compiled code.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from harness.model.assembly import FloatArray, IntArray
from harness.model.groups import groups_of
from methods.la.core.problem import Problem
from methods.numerics.failures import SingularMatrix, sparse_lu

if TYPE_CHECKING:
    from scipy.sparse.linalg import SuperLU

    from methods.numerics.block_lu import BlockFactor


_FEW = 200
"""Blocks up to which SuperLU factorises."""


class NewtonMatrix:
    """Assembles and factorises K = C' D C for one problem and any flexibilities D."""

    def __init__(self, problem: Problem) -> None:
        assembly = problem.assembly
        n = assembly.n_free
        column = np.full(assembly.n_blocks, -1, dtype=np.int64)
        column[assembly.free] = np.arange(n)
        block_a, block_b = column[assembly.block_a], column[assembly.block_b]
        both = (block_a >= 0) & (block_b >= 0)
        self.large = n > _FEW
        if self.large:
            from methods.numerics.block_lu import elimination_order as found
        else:
            from methods.numerics.elimination import dissection_order as found
        order = found(assembly.centroid[assembly.free], block_a[both], block_b[both])
        place = np.empty(n, dtype=np.int64)
        place[order] = np.arange(n)
        self.order = (3 * order[:, None] + np.arange(3)).ravel()
        self.size = 3 * n
        index = self._gather(
            problem, np.where(block_a >= 0, place[block_a], -1), np.where(block_b >= 0, place[block_b], -1)
        )
        if self.large:
            self._place_in_blocks(index)
        else:
            self._place_in_columns(index)

    def _gather(self, problem: Problem, place_a: IntArray, place_b: IntArray) -> IntArray:
        """Find the rows (m, 3, 6) of C of each interface; their columns (m, 6) in K, -1 for those of a fixed block."""
        m = problem.n_interfaces
        entries, column = problem.kinematic.tocoo(), np.argsort(self.order)[problem.kinematic.indices]
        self.rows = np.zeros((m, 3, 6))
        index = np.full((m, 6), -1, dtype=np.int64)
        p, k = entries.row // 3, entries.row % 3
        block, component = column // 3, column % 3
        side = np.where(block == place_a[p], 0, 3)
        self.rows[p, k, side + component] = entries.data
        for start, place in ((0, place_a), (3, place_b)):
            for j in range(3):
                index[:, start + j] = np.where(place >= 0, 3 * place + j, -1)
        return index

    def _place_in_blocks(self, index: IntArray) -> None:
        """Where the products of two rows go in the supernodes; a fixed block's are zero and go where the other's do."""
        from methods.numerics.block_lu import BlockPattern

        unknown = np.where(index >= 0, index, np.roll(index, 3, axis=1))
        self.pattern = BlockPattern(unknown[:, 0] // 3, unknown[:, 3] // 3, self.size // 3)
        self._slot = self.pattern.slot(unknown)
        self._diagonal = self.pattern.diagonal
        self._n_values = self.pattern.n_values

    def _place_in_columns(self, index: IntArray) -> None:
        """Where the products of two rows go in a matrix by columns."""
        row = np.repeat(index[:, :, None], 6, axis=2)
        col = np.repeat(index[:, None, :], 6, axis=1)
        self._used = ((row >= 0) & (col >= 0)).ravel()
        key = col.ravel()[self._used] * self.size + row.ravel()[self._used]
        unique, self._slot = np.unique(key, return_inverse=True)
        self._indices = (unique % self.size).astype(np.int32)
        counts = np.bincount(unique // self.size, minlength=self.size)
        self._pointers = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
        self._diagonal = np.flatnonzero(unique % self.size == unique // self.size)
        self._n_values = len(unique)

    def factorise(self, flexibility: FloatArray, relative: float, shift: float = 0.0) -> _NewtonFactor:
        """LU factors of K + relative * diag(K) + shift * I, with pivots from the diagonal.

        Args:
            flexibility: (m, 3, 3).
            relative: regularisation relative to the diagonal.
            shift: regularisation by the unit matrix.

        Raises:
            SingularMatrix: K is singular to rounding.
        """
        values = self._assembled(flexibility)
        values[self._diagonal] += relative * np.maximum(abs(values[self._diagonal]), 1e-30) + shift
        if self.large:
            from methods.numerics.block_lu import BlockFactor

            factors = BlockFactor(self.pattern, values)
            if not factors.factorise(symmetric=bool((flexibility == flexibility.transpose(0, 2, 1)).all())):
                raise SingularMatrix("the Newton matrix is singular")
            return _NewtonFactor(factors, self.order)
        return self._by_columns(values, self._indices, self._pointers, self.order)

    def factorise_copies(self, flexibility: FloatArray, relative: float) -> _NewtonFactor:
        """LU factors of K of copies of a wall, as of one matrix; of a single copy if that is `large`.

        Args:
            flexibility: (k, m, 3, 3).
            relative: regularisation relative to the diagonal.

        Raises:
            SingularMatrix: one of them is singular to rounding.
        """
        if len(flexibility) == 1:
            return self.factorise(flexibility[0], relative)
        copy = np.arange(len(flexibility))[:, None]
        products = np.matmul(self.rows.transpose(0, 2, 1), np.matmul(flexibility, self.rows)).reshape(len(copy), -1)
        slot = (self._slot + self._n_values * copy).ravel()
        values = cast(FloatArray, np.bincount(slot, products[:, self._used].ravel(), len(copy) * self._n_values))
        diagonal = (self._diagonal + self._n_values * copy).ravel()
        values[diagonal] += relative * np.maximum(abs(values[diagonal]), 1e-30)
        indices = (self._indices + self.size * copy).ravel()
        pointers = np.append((self._pointers[:-1] + self._n_values * copy).ravel(), len(values))
        return self._by_columns(
            values, indices.astype(np.int32), pointers.astype(np.int32), (self.order + self.size * copy).ravel()
        )

    def _by_columns(
        self, values: FloatArray, indices: NDArray[np.int32], pointers: NDArray[np.int32], order: IntArray
    ) -> _NewtonFactor:
        matrix = sp.csc_matrix((values, indices, pointers), shape=(len(order), len(order)))
        options = {"SymmetricMode": True}
        return _NewtonFactor(sparse_lu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options), order)

    def _assembled(self, flexibility: FloatArray) -> FloatArray:
        """The entries of K for flexibilities (m, 3, 3), where they stand in the factor."""
        if self.large:
            from methods.numerics.block_kernels import add_congruences

            values = np.zeros(self._n_values)
            add_congruences(self._slot, self.rows, flexibility, values)
            return values
        products = np.matmul(self.rows.transpose(0, 2, 1), np.matmul(flexibility, self.rows)).ravel()
        return cast(FloatArray, np.bincount(self._slot, products[self._used], self._n_values))


class _NewtonFactor:
    """Factors of K that solve in the numbering of the problem."""

    def __init__(self, factors: SuperLU | BlockFactor, order: IntArray) -> None:
        self._factors = factors
        self._order = order

    def determinant_sign(self) -> float:
        """The sign of the determinant of K."""
        from scipy.sparse.linalg import SuperLU

        if isinstance(self._factors, SuperLU):
            negative = np.count_nonzero(self._factors.U.diagonal() < 0.0)
            odd = negative + sum(map(_exchanges, (self._factors.perm_r, self._factors.perm_c)))
            return -1.0 if odd % 2 else 1.0
        return self._factors.determinant_sign()

    def solve(self, right: FloatArray) -> FloatArray:
        """K^-1 b for b (3n,)."""
        solution = np.empty_like(right)
        solution[self._order] = self._factors.solve(right[self._order])
        return solution


def _exchanges(order: IntArray) -> int:
    """How many exchanges of two make this permutation: its length less its number of cycles."""
    n = len(order)
    return n - len(np.unique(groups_of(n, np.arange(n), order)))
