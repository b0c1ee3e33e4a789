"""The Newton matrix K = C' D C of the interior point, assembled block by block and factorised in a fixed order.

D holds one 3 x 3 flexibility per interface. The pattern of K is the adjacency of the blocks, so the order of
elimination is found once, by nested dissection of the block centroids (George 1973), and kept.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import SuperLU, splu

from harness.model.assembly import FloatArray, IntArray
from methods.la.problem import Problem

LEAF = 24
"""Blocks below which a part is not divided further."""


def dissection_order(centroid: FloatArray, first: IntArray, second: IntArray) -> IntArray:
    """(n,) order of elimination of n blocks by recursive bisection, separators last.

    Args:
        centroid: (n, 2) places of the blocks [length].
        first, second: (k,) pairs of neighbouring blocks.
    """
    n = len(centroid)
    ones = np.ones(len(first))
    graph = sp.csr_matrix((ones, (first, second)), shape=(n, n))
    graph = (graph + graph.T).tocsr()
    pieces: list[IntArray] = []
    _dissect(np.arange(n), centroid, graph, pieces)
    return np.concatenate(pieces) if pieces else np.zeros(0, dtype=np.int64)


def _dissect(part: IntArray, centroid: FloatArray, graph: sp.csr_matrix, pieces: list[IntArray]) -> None:
    if len(part) <= LEAF:
        pieces.append(part)
        return
    place = centroid[part]
    axis = int(np.argmax(np.ptp(place, axis=0)))
    rank = np.lexsort((part, place[:, 1 - axis], place[:, axis]))
    half = len(part) // 2
    low, high = part[rank[:half]], part[rank[half:]]
    touched = np.zeros(graph.shape[0], dtype=bool)
    touched[graph[low].indices] = True
    border = touched[high]
    _dissect(low, centroid, graph, pieces)
    _dissect(high[~border], centroid, graph, pieces)
    pieces.append(high[border])


class NewtonMatrix:
    """Assembles and factorises K = C' D C for one problem and any flexibilities D."""

    def __init__(self, problem: Problem) -> None:
        assembly = problem.assembly
        n = assembly.n_free
        column = np.full(assembly.n_blocks, -1, dtype=np.int64)
        column[assembly.free] = np.arange(n)
        block_a, block_b = column[assembly.block_a], column[assembly.block_b]
        both = (block_a >= 0) & (block_b >= 0)
        order = dissection_order(assembly.centroid[assembly.free], block_a[both], block_b[both])
        place = np.empty(n, dtype=np.int64)
        place[order] = np.arange(n)
        self.order = (3 * order[:, None] + np.arange(3)).ravel()
        self.size = 3 * n
        self._gather(problem, np.where(block_a >= 0, place[block_a], -1), np.where(block_b >= 0, place[block_b], -1))

    def _gather(self, problem: Problem, place_a: IntArray, place_b: IntArray) -> None:
        m = problem.n_interfaces
        permuted = problem.kinematic.tocsc()[:, self.order].tocsr()
        self.rows = np.zeros((m, 3, 6))
        index = np.full((m, 6), -1, dtype=np.int64)
        dense_rows = permuted.tocoo()
        p, k = dense_rows.row // 3, dense_rows.row % 3
        block, component = dense_rows.col // 3, dense_rows.col % 3
        side = np.where(block == place_a[p], 0, 3)
        self.rows[p, k, side + component] = dense_rows.data
        for start, place in ((0, place_a), (3, place_b)):
            for j in range(3):
                index[:, start + j] = np.where(place >= 0, 3 * place + j, -1)
        row = np.repeat(index[:, :, None], 6, axis=2)
        col = np.repeat(index[:, None, :], 6, axis=1)
        self._used = ((row >= 0) & (col >= 0)).ravel()
        key = col.ravel()[self._used] * self.size + row.ravel()[self._used]
        unique, self._slot = np.unique(key, return_inverse=True)
        self._indices = (unique % self.size).astype(np.int32)
        counts = np.bincount(unique // self.size, minlength=self.size)
        self._pointers = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)

    def assemble(self, flexibility: FloatArray) -> sp.csc_matrix:
        """K in the order of elimination, from flexibilities (m, 3, 3)."""
        products = np.matmul(self.rows.transpose(0, 2, 1), np.matmul(flexibility, self.rows))
        data = np.bincount(self._slot, weights=products.ravel()[self._used], minlength=len(self._indices))
        return sp.csc_matrix((data, self._indices, self._pointers), shape=(self.size, self.size))

    def factorise(self, flexibility: FloatArray, pivoting: float, relative: float, shift: float = 0.0) -> Factor:
        """LU factors of K + relative * diag(K) + shift * I.

        Args:
            flexibility: (m, 3, 3).
            pivoting: from 0 (diagonal) to 1 (partial pivoting).
            relative: regularisation relative to the diagonal.
            shift: regularisation by the unit matrix.

        Raises:
            RuntimeError: K is singular to rounding.
        """
        matrix = self.assemble(flexibility)
        diagonal = matrix.diagonal()
        matrix = matrix + sp.diags(relative * np.maximum(abs(diagonal), 1e-30) + shift, format="csc")
        factors = splu(
            matrix,
            permc_spec="NATURAL",
            diag_pivot_thresh=pivoting,
            options={"SymmetricMode": True},
        )
        return Factor(factors, self.order)


class Factor:
    """Factors of K that solve in the numbering of the problem."""

    def __init__(self, factors: SuperLU, order: IntArray) -> None:
        self._factors = factors
        self._order = order

    def solve(self, right: FloatArray) -> FloatArray:
        """K^-1 b for b (3n,) or (3n, k)."""
        solution = np.empty_like(right)
        solution[self._order] = self._factors.solve(np.ascontiguousarray(right[self._order]))
        return solution
