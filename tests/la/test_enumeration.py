"""On tiny walls `la` finds the least multiplier of all mechanisms, each contact point open, sticking or sliding.

The enumeration shares nothing with the method.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.model.assembly import Assembly
from harness.model.method import Finding, Status
from methods.la.associated import AssociatedLimitAnalysis
from methods.la.search import LimitAnalysis
from methods.la.settings import AssociatedSettings, SearchSettings
from tests.enumeration import least_by_enumeration
from tests.la.bodies import column

SIZES = st.lists(st.tuples(st.floats(0.2, 1.5), st.floats(0.1, 1.0)), min_size=1, max_size=2)


@settings(max_examples=12, deadline=None, derandomize=True)
@given(SIZES, st.floats(0.05, 1.5), st.floats(0.0, 1.0))
def test_la_is_the_least_of_all_mechanisms_of_a_column(
    blocks: list[tuple[float, float]], friction: float, roughness: float
) -> None:
    wall = column([width for width, _ in blocks], [height for _, height in blocks], friction)
    graded = friction * (1.0 + roughness * np.arange(wall.n_interfaces))
    _assert_least(replace(wall, friction=graded))


@settings(max_examples=6, deadline=None, derandomize=True)
@given(st.floats(0.3, 1.5), st.floats(0.1, 1.0), st.floats(0.05, 1.5), st.floats(0.05, 1.5), st.floats(0.0, 0.5))
def test_la_is_the_least_of_all_mechanisms_of_a_block_on_halves_of_unequal_friction(
    width: float, height: float, left: float, right: float, lift: float
) -> None:
    wall = column([width], [height], 0.5, halves=2)
    live = wall.live + lift * np.column_stack([np.zeros(2), wall.live[:, 0], np.zeros(2)])
    _assert_least(replace(wall, friction=np.array([left, right]), live=live))


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.3, 0.55, 0.9])
def test_la_is_the_least_of_all_mechanisms_of_three_blocks(friction: float) -> None:
    _assert_least(column([0.5, 0.4, 0.6], [0.3, 0.5, 0.2], friction))


def _assert_least(wall: Assembly) -> None:
    answer = LimitAnalysis().solve(wall, SearchSettings())
    greatest = AssociatedLimitAnalysis().solve(wall, AssociatedSettings()).multiplier
    assert answer.status is Status.OK
    assert answer.finding is Finding.COLLAPSES
    assert answer.details["proved_least"]
    # Two linear solvers with feasibility tolerances of 1e-7 and less.
    assert answer.multiplier == pytest.approx(least_by_enumeration(wall), rel=1e-7, abs=1e-9)
    assert answer.multiplier is not None
    assert greatest is not None
    assert answer.multiplier <= greatest * (1.0 + 1e-9)
