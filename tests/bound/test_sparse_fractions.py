"""Sparse linear equations in fractions, some of which may hold as inequalities."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from methods.proof.tree.sparse_fractions import solve_sparse

ONE = Fraction(1)
TINY = Fraction(1, 10**20)
"""By what equations contradict each other that agree in floats."""


def test_free_unknowns_take_short_fractions_near_the_guess():
    assert solve_sparse([{0: ONE, 1: ONE}], [ONE], np.array([0.3, 0.7])) in (
        {0: Fraction(3, 10), 1: Fraction(7, 10)},
        {1: Fraction(7, 10), 0: Fraction(3, 10)},
    )


def test_equations_that_contradict_each_other_have_no_solution():
    with pytest.raises(ArithmeticError):
        solve_sparse([{0: ONE}, {0: ONE}], [ONE, ONE + TINY], np.array([1.0]))


def test_one_that_may_hold_as_an_inequality_takes_a_slack_above_zero():
    # x = 1 + TINY and x - s = 1: s = TINY. With x = 1 - TINY no s above zero is one.
    found = solve_sparse([{0: ONE}, {0: ONE, 1: -ONE}], [ONE + TINY, ONE], np.array([1.0]))
    assert found == {0: ONE + TINY, 1: TINY}
    with pytest.raises(ArithmeticError):
        solve_sparse([{0: ONE}, {0: ONE, 1: -ONE}], [ONE - TINY, ONE], np.array([1.0]))


def test_slacks_are_zero_where_all_can_be():
    found = solve_sparse([{0: ONE, 1: -ONE}, {0: ONE, 2: ONE}], [ONE, ONE], np.array([1.0]))
    assert found[0] == ONE
    assert not any(found.get(k) for k in (1, 2))
