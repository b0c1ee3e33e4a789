"""Orders in which the blocks of a wall are eliminated, so that little fill arises."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from harness.model.assembly import BoolArray, FloatArray, IntArray

_LEAF = 8
"""Blocks up to which a part is not divided further by nested dissection."""


def dissection_order(centroid: FloatArray, first: IntArray, second: IntArray) -> IntArray:
    """(n,) order of elimination of n blocks by recursive bisection, separators last (George 1973).

    Args:
        centroid: (n, 2) places of the blocks [length].
        first, second: (k,) pairs of neighbouring blocks.
    """
    n = len(centroid)
    pieces: list[IntArray] = []
    _dissect(np.arange(n), first, second, centroid, np.zeros(n, dtype=bool), pieces)
    return np.concatenate(pieces)


def _dissect(
    part: IntArray, first: IntArray, second: IntArray, centroid: FloatArray, inside: BoolArray, pieces: list[IntArray]
) -> None:
    """Append the pieces of a part (p,) of neighbours (first, second), both (q,); `inside` (n,) is room to mark blocks.

    It is divided in the direction in which fewer blocks lie between its halves.
    """
    if len(part) <= _LEAF:
        pieces.append(part)
        return
    cuts = [_cut(part, first, second, centroid, inside, axis) for axis in (0, 1)]
    *halves, between = min(cuts, key=lambda cut: len(cut[2]))
    parts = []
    for half in halves:
        inside[part] = False
        inside[half] = True
        joined = inside[first] & inside[second]
        parts.append((half, first[joined], second[joined]))
    for half, one, other in parts:
        _dissect(half, one, other, centroid, inside, pieces)
    pieces.append(between)


def _cut(
    part: IntArray, first: IntArray, second: IntArray, centroid: FloatArray, inside: BoolArray, axis: int
) -> tuple[IntArray, IntArray, IntArray]:
    """The half of a part that lies low along an axis, the rest, and between them the blocks that touch the first."""
    place = centroid[part]
    rank = part[np.lexsort((part, place[:, 1 - axis], place[:, axis]))]
    low, high = rank[: len(part) // 2], rank[len(part) // 2 :]
    inside[part] = False
    inside[low] = True
    touching = np.concatenate([second[inside[first]], first[inside[second]]])
    inside[part] = False
    inside[touching] = True
    return low, high[~inside[high]], high[inside[high]]


def minimum_degree_order(first: IntArray, second: IntArray, n: int) -> IntArray:
    """(n,) order of elimination of n blocks that takes, one after the other, the block with fewest neighbours left.

    Args:
        first, second: (k,) pairs of neighbouring blocks; n: blocks.
    """
    graph = neighbours(first, second, n)
    degree = np.asarray(graph.sum(axis=1)).ravel()
    lu = splu((graph + sp.diags(degree + 1.0)).tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    order: IntArray = np.argsort(lu.perm_c)
    return order


def neighbours(first: IntArray, second: IntArray, n: int) -> sp.csr_matrix:
    """(n, n) matrix with the number of times two of n blocks are neighbours in the pairs (first, second), each (k,)."""
    graph = sp.csr_matrix((np.ones(len(first)), (first, second)), shape=(n, n))
    return (graph + graph.T).tocsr()
