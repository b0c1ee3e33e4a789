"""The law of one gap point against its closed form."""

from __future__ import annotations

import numpy as np
import pytest

from harness.model.joint_law import JointLaw
from methods.springs.model.gap_law import (
    OPEN,
    SLIP_MINUS,
    SLIP_PLUS,
    STICK,
    classify,
    equivalent_end_forces,
    flip_vectors,
    frozen_forces,
    gap_forces,
    tangent_coefficients,
)


def forces(
    opening: float, trial: float, mu: float = 0.5, kn: float = 2.0, lift: float = 0.0
) -> tuple[int, float, float]:
    one = [np.array([v]) for v in (opening, trial, kn, mu, lift)]
    state, normal, shear = np.zeros(1, dtype=np.int64), np.zeros(1), np.zeros(1)
    classify(*one, state, False)
    gap_forces(*one, state, normal, shear)
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


@pytest.mark.parametrize("psi", [0.0, 0.2, 0.6])
def test_return_mapping_follows_the_flow_vectors_of_the_joint_law(psi: float) -> None:
    """Elastic trial minus stiffness times E g, with rates g >= 0 of the rows S that are at their limit alone."""
    rng, kn, kt, mu = np.random.default_rng(5), 2.0, 0.7, 0.6
    law = JointLaw(np.array([mu]), np.array([psi]))
    stiffness = np.diag([kn / 2.0, kn / 2.0, kt])  # half the point at each end of a joint that does not turn
    seen = set()
    for opening, trial in rng.uniform(-1.0, 1.0, (400, 2)) * [1.0, 2.0]:
        state, normal, shear = forces(opening, trial, mu, kn, psi / kt)
        seen.add(state)
        slip = (trial - shear) / kt
        rates = law.rates(np.array([[opening + normal / kn, opening + normal / kn, slip]]))
        slacks = law.slacks(np.array([[normal / 2.0, normal / 2.0, -shear]]))
        assert min(slacks.min(), rates.min()) > -1e-14
        assert abs(slacks * rates).max() < 1e-14
        elastic = np.array([-opening, -opening, -trial / kt])
        given = stiffness @ (elastic + law.flow[0] @ rates[0])
        assert given == pytest.approx([normal / 2.0, normal / 2.0, -shear], abs=1e-14)
    assert seen == {OPEN, STICK, SLIP_PLUS, SLIP_MINUS}


@pytest.mark.parametrize("psi", [0.0, 0.2, 0.6])
def test_frozen_law_is_the_law_where_its_limits_are_what_slip_dissipates_and_the_slope_of_an_energy(psi: float) -> None:
    rng, kn, kt, mu = np.random.default_rng(6), np.full(300, 2.0), np.full(300, 0.7), np.full(300, 0.6)
    opening, trial = rng.uniform(-1.0, 1.0, 300), rng.uniform(-2.0, 2.0, 300)
    state, normal, shear = np.zeros(300, dtype=np.int64), np.zeros(300), np.zeros(300)
    lift = np.full(300, psi) / kt
    classify(opening, trial, kn, mu, lift, state, False)
    gap_forces(opening, trial, kn, mu, lift, state, normal, shear)

    def frozen(opening: np.ndarray, trial: np.ndarray, limit: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        own, pressed, held = np.zeros(300, dtype=np.int64), np.zeros(300), np.zeros(300)
        frozen_forces(opening, trial, limit, kn, kt, np.full(300, psi), own, pressed, held)
        return own, -kn * pressed, held

    own, again, held = frozen(opening, trial, (mu - psi) * normal)
    assert again == pytest.approx(normal, abs=1e-14)
    assert held == pytest.approx(shear, abs=1e-14)
    assert np.array_equal(own, state)
    limit = rng.uniform(0.0, 1.0, 300)
    step = 1e-6

    def along_shear(by: float) -> np.ndarray:
        return frozen(opening, trial + kt * by, limit)[1]

    def along_opening(by: float) -> np.ndarray:
        return frozen(opening + by, trial, limit)[2]

    crossed = (along_shear(step) - along_shear(-step)) / (2 * step)
    # d(-N)/ds = dT/dg but on the few points within a step of their breakpoints
    other = (along_opening(step) - along_opening(-step)) / (2 * step)
    assert np.count_nonzero(abs(crossed + other) > 1e-6) < 5


@pytest.mark.parametrize("lift", [0.0, 0.5])
@pytest.mark.parametrize(
    ("old", "new"),
    [(STICK, SLIP_PLUS), (STICK, SLIP_MINUS), (SLIP_PLUS, STICK), (SLIP_MINUS, OPEN), (OPEN, SLIP_PLUS)],
)
def test_every_change_of_state_changes_the_tangent_by_the_rank_one_term_it_claims(
    old: int, new: int, lift: float
) -> None:
    rng = np.random.default_rng(1)
    row_n, row_t = rng.normal(size=6), rng.normal(size=6)
    kn, kt, mu = 2.0, 0.7, 0.6

    def tangent(state: int) -> np.ndarray:
        nn, tt, tn, nt = tangent_coefficients(kn, kt, mu, lift, state)
        own = nn * np.outer(row_n, row_n) + tt * np.outer(row_t, row_t)
        return own + tn * np.outer(row_t, row_n) + nt * np.outer(row_n, row_t)

    a, b = np.zeros(6), np.zeros(6)
    flip_vectors(row_n, row_t, kn, kt, mu, lift, old, new, a, b)
    np.testing.assert_allclose(np.outer(a, b), tangent(new) - tangent(old), atol=1e-14)


def test_any_number_of_points_is_reduced_to_the_two_ends_without_changing_resultants() -> None:
    position = np.array([0.0, 0.25, 0.5, 1.0])
    normal, shear = np.array([1.0, 2.0, 3.0, 4.0]), np.array([0.1, -0.2, 0.3, 0.4])
    n1, n2, s = equivalent_end_forces(position, np.zeros(4, dtype=np.int64), normal, shear, 1)[0]
    assert n1 + n2 == pytest.approx(normal.sum())
    assert n2 == pytest.approx(normal @ position)
    assert s == pytest.approx(-shear.sum())
