"""Groups of joined things are those that scipy finds, numbered as there."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from harness.model.groups import groups_of


def by_scipy(count: int, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    graph = sp.coo_matrix((np.ones(len(first)), (first, second)), shape=(count, count))
    return connected_components(graph, directed=False)[1]


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 0.8, 3.0])
def test_groups_of_random_pairs_are_those_of_scipy(share: float):
    drawn = np.random.default_rng(5)
    for count in (1, 2, 7, 300):
        first, second = drawn.integers(0, count, (2, int(share * count)))
        assert np.array_equal(groups_of(count, first, second), by_scipy(count, first, second))


@pytest.mark.parametrize("seed", range(4))
def test_a_chain_in_any_order_is_one_group(seed: int):
    order = np.random.default_rng(seed).permutation(5000)
    assert not groups_of(5000, order[:-1], order[1:]).any()


def test_a_star_whose_centre_is_the_last_is_one_group():
    leaves = np.arange(99)
    assert not groups_of(100, leaves, np.full(99, 99)).any()


def test_nothing_is_in_no_group():
    none = np.empty(0, dtype=np.int64)
    assert len(groups_of(0, none, none)) == 0
