"""The law of one gap point against its closed form."""

from __future__ import annotations

import numpy as np
import pytest

from methods.springs.model.gap_law import (
    OPEN,
    SLIP_MINUS,
    SLIP_PLUS,
    STICK,
    classify,
    equivalent_end_forces,
    flip_vectors,
    gap_forces,
    tangent_coefficients,
)


def forces(opening: float, trial: float, mu: float = 0.5, kn: float = 2.0) -> tuple[int, float, float]:
    one = [np.array([v]) for v in (opening, trial, kn, mu)]
    state, normal, shear = np.zeros(1, dtype=np.int64), np.zeros(1), np.zeros(1)
    classify(one[0], one[1], one[2], one[3], state, False)
    gap_forces(one[0], one[1], one[2], one[3], state, normal, shear)
    return int(state[0]), float(normal[0]), float(shear[0])


@pytest.mark.parametrize(
    ("opening", "trial", "expected"),
    [
        (0.1, 3.0, (OPEN, 0.0, 0.0)),
        (-1.0, 0.9, (STICK, 2.0, 0.9)),
        (-1.0, 1.2, (SLIP_PLUS, 2.0, 1.0)),
        (-1.0, -1.2, (SLIP_MINUS, 2.0, -1.0)),
    ],
)
def test_a_gap_point_is_open_sticks_or_slips(opening: float, trial: float, expected: tuple[int, float, float]) -> None:
    assert forces(opening, trial) == pytest.approx(expected)


def test_without_friction_a_closed_point_slips_and_carries_no_shear() -> None:
    state, normal, shear = forces(-1.0, 0.0, mu=0.0)
    assert state in (SLIP_PLUS, SLIP_MINUS)
    assert (normal, shear) == (2.0, 0.0)


@pytest.mark.parametrize(
    ("old", "new"),
    [(STICK, SLIP_PLUS), (STICK, SLIP_MINUS), (SLIP_PLUS, STICK), (SLIP_MINUS, OPEN), (OPEN, SLIP_PLUS)],
)
def test_every_change_of_state_changes_the_tangent_by_the_rank_one_term_it_claims(old: int, new: int) -> None:
    rng = np.random.default_rng(1)
    row_n, row_t = rng.normal(size=6), rng.normal(size=6)
    kn, kt, mu = 2.0, 0.7, 0.6

    def tangent(state: int) -> np.ndarray:
        nn, tt, tn = tangent_coefficients(kn, kt, mu, state)
        return nn * np.outer(row_n, row_n) + tt * np.outer(row_t, row_t) + tn * np.outer(row_t, row_n)

    a, b = np.zeros(6), np.zeros(6)
    flip_vectors(row_n, row_t, kn, kt, mu, old, new, a, b)
    np.testing.assert_allclose(np.outer(a, b), tangent(new) - tangent(old), atol=1e-14)


def test_any_number_of_points_is_reduced_to_the_two_ends_without_changing_resultants() -> None:
    position = np.array([0.0, 0.25, 0.5, 1.0])
    normal, shear = np.array([1.0, 2.0, 3.0, 4.0]), np.array([0.1, -0.2, 0.3, 0.4])
    n1, n2, s = equivalent_end_forces(position, np.zeros(4, dtype=np.int64), normal, shear, 1)[0]
    assert n1 + n2 == pytest.approx(normal.sum())
    assert n2 == pytest.approx(normal @ position)
    assert s == pytest.approx(-shear.sum())
