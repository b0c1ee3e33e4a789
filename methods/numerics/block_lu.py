"""LU of a wall's matrix in dense blocks, in a pattern that is found once for the wall.

The pattern of a tangent or a Newton matrix is that of the contact graph, so the fill of its factors is known from the
wall alone (George and Liu, 1981). Neighbouring columns with nearly the same fill form supernodes, which are
kept and multiplied as dense matrices (Ng and Peyton, 1993). Rows are exchanged inside a supernode only. That cannot
fail while the matrix is symmetric and definite; sliding makes it unsymmetric, and where the multipliers of L then grow,
`factorise` says so.
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.block_kernels import eliminated_into, factorise, substitute, substitute_many
from methods.numerics.elimination import dissection_order, minimum_degree_order, neighbours

_WIDEST = 8
"""Blocks of unknowns in a supernode at most: wider ones spend their time inside the diagonal."""
_PADDING = 0.3
"""Share of zeros that one may hold for the sake of being wider."""


class BlockPattern:
    """Where the supernodes lie; each has w blocks of unknowns, three unknowns a block, and r blocks below them.

    Its values are D (3w, 3w), whose own LU replaces it, then L below it (3r, 3w), then U right of it, transposed
    (3r, 3w).

    Attributes:
        n: blocks of unknowns; n_values: numbers to keep for the factors.
        start: (k + 1,) first block of each supernode; owner: (n,) the supernode of each block.
        row_start: (k + 1,) where the rows of each supernode start in `row`; row: blocks below it, ascending.
        offset: (k + 1,) where its values start; diagonal: (3 n,) where the entries of the diagonal are.
    """

    def __init__(self, first: IntArray, second: IntArray, n: int) -> None:
        """Find the fill of n blocks of unknowns in contact in the pairs (first, second), each (m,), in _postorder."""
        start, rows = _supernodes(_fill(first, second, n))
        self.n = n
        self.start = np.array(start)
        width = np.diff(self.start)
        self.owner = np.repeat(np.arange(len(width)), width)
        self.row_start = np.cumsum([0, *map(len, rows)])
        self.row = np.array([i for below in rows for i in below], dtype=np.int64)
        self.offset = np.cumsum(np.concatenate([[0], 9 * width * (width + 2 * np.diff(self.row_start))]))
        self.n_values = int(self.offset[-1])
        self._keys = np.repeat(np.arange(len(width)), np.diff(self.row_start)) * n + self.row
        self.diagonal = self.place(np.arange(3 * n), np.arange(3 * n))

    def slot(self, unknown: IntArray) -> IntArray:
        """(m, 36) places in the values of the products of two rows of each interface.

        Args:
            unknown: (m, 6) of each interface, those of its first block and those of its second.
        """
        own = unknown[:, ::3]
        row, column = np.repeat(own, 2, axis=1), np.tile(own, (1, 2))
        first = self.place(row, column)
        down, right = self.place(row + 1, column) - first, self.place(row, column + 1) - first
        step = np.arange(3)
        places = (first[:, :, None, None] + step[:, None] * down[:, :, None, None]) + step * right[:, :, None, None]
        out: IntArray = places.reshape(-1, 2, 2, 3, 3).swapaxes(2, 3).reshape(-1, 36)
        return out

    def place(self, row: IntArray, column: IntArray) -> IntArray:
        """Places in the values of entries (row, column) of the tangent, which must lie in its pattern."""
        first = np.minimum(row, column) // 3
        owner = self.owner[first]
        start, width = self.start[owner], self.start[owner + 1] - self.start[owner]
        inside = np.maximum(row, column) // 3 < start + width
        count = self.row_start[owner + 1] - self.row_start[owner]
        below = np.searchsorted(self._keys, owner * self.n + np.maximum(row, column) // 3) - self.row_start[owner]
        lower = 9 * width**2 + (3 * below + row % 3) * 3 * width + column - 3 * start
        upper = 9 * width * (width + count) + (3 * below + column % 3) * 3 * width + row - 3 * start
        diagonal = (row - 3 * start) * 3 * width + column - 3 * start
        out: IntArray = self.offset[owner] + np.where(inside, diagonal, np.where(row > column, lower, upper))
        return out


class BlockFactor:
    """The factors of one matrix in a pattern.

    Attributes:
        values: (n_values,) the entries of the matrix at their places, which `factorise` replaces by the factors.
    """

    def __init__(self, pattern: BlockPattern, values: FloatArray | None = None) -> None:
        self.pattern = pattern
        self.values = np.zeros(pattern.n_values) if values is None else values
        self._swapped = np.zeros(3 * pattern.n, dtype=np.int64)

    def factorise(self, growth: float = np.inf, symmetric: bool = False) -> bool:
        """Factorise the values in place; False when a pivot is zero or entries of L grow beyond `growth`.

        A symmetric matrix takes half the work.
        """
        p = self.pattern
        return factorise(p.start, p.owner, p.row_start, p.row, p.offset, self.values, self._swapped, growth, symmetric)

    def determinant_sign(self) -> float:
        """The sign of the determinant of the factorised matrix."""
        p = self.pattern
        first = 3 * np.repeat(p.start[:-1], 3 * np.diff(p.start))
        swaps = np.count_nonzero(self._swapped != np.arange(3 * p.n) - first)
        negative = np.count_nonzero(self.values[p.diagonal] < 0.0)
        return -1.0 if (swaps + negative) % 2 else 1.0

    def solve(self, right: FloatArray) -> FloatArray:
        """The solution (3 n,) for a right-hand side (3 n,)."""
        p, x = self.pattern, right.copy()
        substitute(p.start, p.row_start, p.row, p.offset, self.values, self._swapped, x)
        return x

    def solve_many(self, first: int, x: FloatArray) -> None:
        """Solve for right-hand sides x (3 n, COLUMNS) at once, in place, zero in rows before block `first`."""
        p = self.pattern
        begin = int(p.owner[first])
        substitute_many(p.start, p.row_start, p.row, p.offset, self.values, self._swapped, begin, x)


def elimination_order(centroid: FloatArray, first: IntArray, second: IntArray) -> IntArray:
    """Order of n blocks by minimum degree or nested dissection, whichever takes fewer operations; see _postorder.

    Args:
        centroid: (n, 2) places of the blocks [length].
        first, second: (k,) pairs of blocks in contact.
    """
    n = len(centroid)
    graph = neighbours(first, second, n)
    least, best = np.inf, np.arange(n)
    for order in (minimum_degree_order(first, second, n), dissection_order(centroid, first, second)):
        ordered = graph[order][:, order]
        parent, count = eliminated_into(ordered.indptr.astype(np.int64), ordered.indices.astype(np.int64))
        operations = float(((count + 1.0) ** 2).sum())
        if operations < least:
            least, best = operations, order[_postorder(parent, count)]
    return best


def _postorder(parent: IntArray, count: IntArray) -> IntArray:
    """Blocks in an order with the same fill in which those that are eliminated into each other stand together.

    Args:
        parent: (n,) block that each is eliminated into; count: (n,) blocks below it, as of `eliminated_into`.
    """
    n = len(parent)
    children: list[list[int]] = [[] for _ in range(n)]
    for j in np.argsort(count, kind="stable").tolist():
        if parent[j] >= 0:
            children[parent[j]].append(j)
    order: list[int] = []
    stack = np.flatnonzero(parent < 0).tolist()
    while stack:
        j = stack.pop()
        order.append(j)
        stack.extend(children[j])
    return np.array(order[::-1])


def _fill(first: IntArray, second: IntArray, n: int) -> list[set[int]]:
    """Rows below the diagonal of each column of L."""
    below: list[set[int]] = [set() for _ in range(n)]
    for i, j in zip(np.minimum(first, second).tolist(), np.maximum(first, second).tolist(), strict=True):
        if i != j:
            below[i].add(j)
    for rows in below:
        if rows:
            parent = min(rows)
            below[parent] |= rows - {parent}
    return below


def _supernodes(below: list[set[int]]) -> tuple[list[int], list[list[int]]]:
    """Gather columns (whose rows are given) into supernodes: the first column of each and its end, and its rows."""
    start, rows, true = [0], [below[0]], [len(below[0])]
    for j in range(1, len(below)):
        width = j - start[-1]
        merged = (rows[-1] | below[j]) - {j}
        entries = true[-1] + len(below[j]) + width
        size = (width + 1) * len(merged) + width * (width + 1) // 2
        if j in rows[-1] and width < _WIDEST and size <= (1.0 + _PADDING) * entries:
            rows[-1] = merged
            true[-1] = entries
        else:
            start.append(j)
            rows.append(below[j])
            true.append(len(below[j]))
    return [*start, len(below)], [sorted(r) for r in rows]
