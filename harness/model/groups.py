"""Which of so many things hang together, if some pairs of them are joined: the components of an undirected graph."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import IntArray


def groups_of(count: int, first: IntArray, second: IntArray) -> IntArray:
    """Number of the group (count,) of every thing, where first[k] is joined to second[k].

    Groups are numbered from zero on in the order of their first members. Each round hangs every root that is joined to
    a lower one below that one and then shortens all ways to the roots, so a handful of rounds does (Shiloach and
    Vishkin 1982). scipy.sparse.csgraph does the same, but commands that solve nothing would take .25 s to load it.

    Args:
        count: how many things there are.
        first, second: (k,) indices of the two of each joined pair.
    """
    root = np.arange(count)
    while True:
        one, other = root[first], root[second]
        if np.array_equal(one, other):
            return np.asarray(np.unique(root, return_inverse=True)[1].reshape(-1), dtype=np.int64)
        np.minimum.at(root, np.maximum(one, other), np.minimum(one, other))
        while not np.array_equal(root, above := root[root]):
            root = above
