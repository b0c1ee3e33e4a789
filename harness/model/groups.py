"""Connected components of an undirected graph."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from harness.model.assembly import IntArray


def groups_of(count: int, first: IntArray, second: IntArray) -> IntArray:
    """Number of the component (count,) of every node, where first[k] is joined to second[k].

    Components are numbered from zero on in the order of their first members.

    Args:
        count: number of nodes.
        first, second: (k,) indices of the two nodes of each edge.
    """
    graph = sp.coo_array((np.ones(len(first)), (first, second)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)
