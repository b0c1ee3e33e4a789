"""Orders of elimination: what they part, what fill they leave, and which of them a wall takes."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.block_kernels import eliminated_into
from methods.numerics.block_lu import elimination_order
from methods.numerics.elimination import dissection_order, minimum_degree_order, neighbours


def grid(rows: int, columns: int) -> tuple[FloatArray, IntArray, IntArray]:
    """Places of blocks in a running bond, and pairs of neighbours: beside and above each other."""
    number = np.arange(rows * columns).reshape(rows, columns)
    row, column = np.divmod(number.ravel(), columns)
    pairs = [(number[:, :-1], number[:, 1:]), (number[:-1], number[1:])]
    pairs += [(number[:-1:2, 1:], number[1::2, :-1]), (number[1:-1:2, :-1], number[2::2, 1:])]
    first, second = (np.concatenate([pair[k].ravel() for pair in pairs]) for k in (0, 1))
    return np.column_stack([column + 0.5 * (row % 2), row]), first, second


def fill(order: IntArray, first: IntArray, second: IntArray) -> tuple[IntArray, IntArray]:
    """The block that each is eliminated into and the rows below it, both (n,), by elimination of a dense pattern."""
    n = len(order)
    joined = (neighbours(first, second, n)[order][:, order]).toarray() > 0.0
    parent, count = np.full(n, -1), np.zeros(n, dtype=np.int64)
    for j in range(n):
        below = j + 1 + np.flatnonzero(joined[j + 1 :, j])
        joined[np.ix_(below, below)] = True
        parent[j], count[j] = min(below, default=-1), len(below)
    return parent, count


@pytest.mark.parametrize("count", [1, 8, 9, 60])
def test_an_order_of_elimination_has_every_block_once_and_separators_last(count: int) -> None:
    place = np.column_stack([np.arange(count, dtype=float), np.zeros(count)])
    first = np.arange(count - 1)
    order = dissection_order(place, first, first + 1)
    assert sorted(order.tolist()) == list(range(count))
    if count > 8:  # a chain in two: the first block of the second half parts them
        assert order[-1] == count // 2


def test_a_part_is_divided_where_fewer_blocks_lie_between_its_halves() -> None:
    place, first, second = grid(8, 4)
    place[:, 0] *= 10.0  # the longer side, along which eight blocks would lie between
    assert sorted(dissection_order(place, first, second)[-4:].tolist()) == [16, 17, 18, 19]


@pytest.mark.parametrize("order", [np.arange(20), np.random.default_rng(4).permutation(20)])
def test_the_tree_of_an_elimination_and_its_fill_are_those_of_the_pattern(order: IntArray) -> None:
    _, first, second = grid(4, 5)
    ordered = neighbours(first, second, 20)[order][:, order]
    parent, count = eliminated_into(ordered.indptr.astype(np.int64), ordered.indices.astype(np.int64))
    expected = fill(order, first, second)
    assert parent.tolist() == expected[0].tolist()
    assert count.tolist() == expected[1].tolist()


@pytest.mark.parametrize("shape", [(3, 60), (56, 28)])
def test_a_wall_takes_the_order_of_fewer_operations(shape: tuple[int, int]) -> None:
    def operations(order: IntArray) -> int:
        return int(((fill(order, first, second)[1] + 1) ** 2).sum())

    place, first, second = grid(*shape)
    tried = (minimum_degree_order(first, second, len(place)), dissection_order(place, first, second))
    least = min(map(operations, tried))
    assert least < max(map(operations, tried))
    assert operations(elimination_order(place, first, second)) == least
