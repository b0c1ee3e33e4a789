"""On tiny walls `la` finds the least multiplier of all mechanisms, each contact point open, sticking or sliding.

The enumeration is written from the definitions alone and shares nothing with the method: its matrices come from the
harness, its programmes go to scipy.
"""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from harness.model.assembly import Assembly
from harness.model.method import Finding, Status
from methods.la.adapter import AssociatedLimitAnalysis, LimitAnalysis
from methods.la.settings import AssociatedSettings, SearchSettings
from tests.la.bodies import column

ENDS = ((False, False), (True, False), (False, True), (True, True))
"""Which of the two ends of an interface are open."""
SLIPS = (0, 1, -1)
STATES = tuple(itertools.product(ENDS, SLIPS))
"""All states of an interface: a closed end may carry compression, an open one carries none."""


def least_by_enumeration(wall: Assembly) -> float:
    """The least multiplier of all combinations of states for which a mechanism and forces exist."""
    values = (_multiplier(wall, states) for states in itertools.product(STATES, repeat=wall.n_interfaces))
    return min((value for value in values if value is not None), default=np.inf)


def _multiplier(wall: Assembly, states: tuple[tuple[tuple[bool, bool], int], ...]) -> float | None:
    return _least_multiplier(wall, states) if _moves(wall, states) else None


def _moves(wall: Assembly, states: tuple[tuple[tuple[bool, bool], int], ...]) -> bool:
    """Whether a mechanism with live work moves in these states: closed ends stay closed, open ends may open."""
    rows = wall.kinematic_matrix.toarray()
    closed, signed = [], []
    for p, (ends, slip) in enumerate(states):
        for row, free in ((3 * p, ends[0]), (3 * p + 1, ends[1])):
            (signed if free else closed).append(rows[row])
        (signed if slip else closed).append((slip or 1) * rows[3 * p + 2])
    live = wall.free_loads()[1]
    none = np.zeros((0, rows.shape[1]))
    answer = linprog(
        np.zeros(rows.shape[1]),
        A_ub=-np.array(signed) if signed else none,
        b_ub=np.zeros(len(signed)),
        A_eq=np.vstack([*closed, live]),
        b_eq=np.append(np.zeros(len(closed)), 1.0),
        bounds=(None, None),
    )
    return bool(answer.status == 0)


def _least_multiplier(wall: Assembly, states: tuple[tuple[tuple[bool, bool], int], ...]) -> float | None:
    """The least multiplier of forces without compression at open ends, at the friction limit against each slip."""
    dead, live = wall.free_loads()
    m = wall.n_interfaces
    cone, limit, bounds = [], [], []
    for p, (ends, slip) in enumerate(states):
        bounds += [(0.0, 0.0 if free else None) for free in ends] + [(None, None)]
        for sense in (1, -1):
            row = np.zeros(3 * m + 1)
            row[3 * p : 3 * p + 2] = -wall.friction[p]
            row[3 * p + 2] = -sense
            (limit if slip == sense else cone).append(row)
    answer = linprog(
        np.append(np.zeros(3 * m), 1.0),
        A_ub=np.array(cone),
        b_ub=np.zeros(len(cone)),
        A_eq=np.vstack([np.column_stack([wall.kinematic_matrix.toarray().T, live]), *limit]),
        b_eq=np.append(-dead, np.zeros(len(limit))),
        bounds=[*bounds, (0.0, None)],
    )
    return float(answer.fun) if answer.status == 0 else None


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
