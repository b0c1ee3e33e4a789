"""The breakpoints of gap points by hand: where they are met, which is taken, and what lies behind."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from methods.springs.model.gap_law import (
    OPEN,
    SLIP_MINUS,
    SLIP_PLUS,
    STICK,
    classify,
    neighbour_states,
    point_forces,
    same_forces,
)
from methods.springs.path.breakpoints import (
    advance,
    breakpoint_functions,
    coming_breakpoints,
    live_rate,
    next_breakpoint,
    strain_rates,
    target_state,
)

KN, MU, LIFT = 2.0, 0.5, 0.0
NONE = (1.0, 1.0)
"""A second breakpoint function that is never met."""


@pytest.mark.parametrize(
    ("state", "opening", "trial", "lift", "values"),
    [
        (OPEN, 0.25, 9.0, 0.0, (0.5, 0.5)),
        (OPEN, 0.25, 0.25, 0.5, (0.25, 0.75)),
        (STICK, -1.0, 0.25, 0.0, (0.75, 1.25)),  # mu N = 1, from either side
        (STICK, -1.0, 0.25, 0.5, (0.75, 1.25)),
        (SLIP_PLUS, -1.0, 1.5, 0.0, (2.0, 0.5)),
        (SLIP_MINUS, -1.0, -1.5, 0.0, (2.0, 0.5)),
        (SLIP_PLUS, -1.0, 2.0, 1.0, (3.0, 1.0)),  # N = 2 (2 + 1) / (1 + 1)
        (SLIP_MINUS, -1.0, -2.0, 1.0, (3.0, 1.0)),
    ],
)
def test_breakpoint_functions_and_their_rates_by_hand(
    state: int, opening: float, trial: float, lift: float, values: tuple[float, float]
) -> None:
    v0, _, v1, _ = breakpoint_functions(opening, trial, 0.0, 0.0, KN, MU, lift, state)
    assert (v0, v1) == values
    # They are linear in opening and trial shear: their rates are what they change by.
    for change, shift in ((0.125, 0.0), (0.0, 0.25), (-0.5, 0.75)):
        _, r0, _, r1 = breakpoint_functions(opening, trial, change, shift, KN, MU, lift, state)
        w0, _, w1, _ = breakpoint_functions(opening + change, trial + shift, 0.0, 0.0, KN, MU, lift, state)
        assert r0 == w0 - v0
        assert r1 == w1 - v1


@pytest.mark.parametrize("state", [SLIP_PLUS, SLIP_MINUS])
def test_a_smooth_point_that_slips_can_only_open(state: int) -> None:
    assert breakpoint_functions(-1.0, 0.75, 0.25, 0.5, KN, 0.0, LIFT, state) == (2.0, -0.5, *NONE)


@pytest.mark.parametrize(
    ("state", "which", "trial", "behind"),
    [
        (OPEN, 0, 1.0, SLIP_PLUS),
        (OPEN, 0, 0.0, SLIP_PLUS),
        (OPEN, 0, -1.0, SLIP_MINUS),
        (STICK, 0, -1.0, SLIP_PLUS),
        (STICK, 1, 1.0, SLIP_MINUS),
        (SLIP_PLUS, 0, 1.0, OPEN),
        (SLIP_PLUS, 1, 1.0, STICK),
        (SLIP_MINUS, 0, 1.0, OPEN),
        (SLIP_MINUS, 1, 1.0, STICK),
    ],
)
def test_states_behind_breakpoints(state: int, which: int, trial: float, behind: int) -> None:
    assert target_state(state, which, trial) == behind
    assert behind in neighbour_states(state)


def test_a_point_passes_through_slip_before_it_opens_or_sticks() -> None:
    assert neighbour_states(OPEN) == neighbour_states(STICK) == (SLIP_PLUS, SLIP_MINUS)
    assert neighbour_states(SLIP_PLUS) == neighbour_states(SLIP_MINUS) == (OPEN, STICK)


Points = list[tuple[int, float, float, float, float]]
"""(state, opening, trial, rate of opening, rate of trial) of each."""


def arrays(points: Points) -> list[Any]:
    columns = [np.array([point[k] for point in points], dtype=float) for k in range(1, 5)]
    springs = [np.full(len(points), value) for value in (KN, MU, LIFT)]
    return [*columns, *springs, np.array([point[0] for point in points])]


def following(points: Points, **limits: Any) -> tuple[float, int, int]:
    given = {"tolerance": 0.0, "noise": 0.0, "floor": np.inf, "barred_point": -1, "barred_state": OPEN} | limits
    return next_breakpoint(*arrays(points), *given.values())


CLOSING = (OPEN, 0.5, -1.0, -0.25, 0.0)
"""Closes after two steps, its shear pulling backwards."""
SLIPPING = (STICK, -1.0, 0.0, 0.0, 0.25)
"""Slips after four steps."""


def test_the_first_breakpoint_is_taken_whatever_the_order_of_points() -> None:
    assert following([CLOSING, SLIPPING]) == (2.0, 0, SLIP_MINUS)
    assert following([SLIPPING, CLOSING]) == (2.0, 1, SLIP_MINUS)
    assert following([SLIPPING]) == (4.0, 0, SLIP_PLUS)


@pytest.mark.parametrize(
    ("point", "step", "behind"),
    [
        ((STICK, -1.0, 0.0, 0.0, -0.25), 4.0, SLIP_MINUS),
        ((STICK, -1.0, 0.5, 0.25, 0.0), 2.0, SLIP_PLUS),  # its compression falls until friction is used up
        ((SLIP_PLUS, -1.0, 1.5, 0.125, 0.0), 8.0, OPEN),
        ((SLIP_PLUS, -1.0, 1.5, 0.0, -0.25), 2.0, STICK),
        ((SLIP_MINUS, -1.0, -1.5, 0.0, 0.25), 2.0, STICK),
        ((OPEN, 0.5, -1.0, -0.25, 0.75), 2.0, SLIP_PLUS),  # by its shear when it closes, 1/2
        ((OPEN, 0.0, 1.0, -0.25, 0.0), 0.0, SLIP_PLUS),
        ((SLIP_PLUS, -1.0, 1.0, 0.0, -0.25), 0.0, STICK),
    ],
)
def test_step_to_the_breakpoint_of_one_point(point: Any, step: float, behind: int) -> None:
    assert following([point]) == (step, 0, behind)


@pytest.mark.parametrize(
    "point", [(OPEN, 0.5, 1.0, 0.25, 9.0), (STICK, -1.0, 0.5, -1.0, 0.0), (SLIP_PLUS, -1.0, 1.5, -1.0, 2.0)]
)
def test_a_point_that_moves_away_from_its_breakpoints_meets_none(point: Any) -> None:
    step, number, _ = following([point])
    assert (step, number) == (np.inf, -1)


def test_of_breakpoints_within_the_tolerance_the_one_crossed_fastest_is_taken() -> None:
    """The slow point would be met at 2; the fast one, at 2.25, is passed by less than the tolerance."""
    slow, fast = CLOSING, (OPEN, 2.25, -1.0, -1.0, 0.0)
    assert following([slow, fast]) == (2.0, 0, SLIP_MINUS)
    for points in ([slow, fast], [fast, slow]):
        step, number, _ = following(points, tolerance=0.25)  # 2 kn (.25 + .125) / .25 > 2.25
        assert (step, points[number]) == (2.25, fast)
    step, number, _ = following([slow, (OPEN, 2.75, -1.0, -1.0, 0.0)], tolerance=0.25)
    assert (step, number) == (2.0, 0)


def test_of_breakpoints_met_together_and_equally_fast_the_first_point_changes() -> None:
    """Symmetric walls meet such ties, and their path must not depend on rounding."""
    assert following([SLIPPING, CLOSING, CLOSING]) == (2.0, 1, SLIP_MINUS)
    sticking = (SLIP_PLUS, -1.0, 1.5, 0.0, -0.25)
    assert following([sticking, sticking]) == (2.0, 0, STICK)


def test_a_change_just_made_is_not_taken_back_and_any_other_is() -> None:
    assert following([CLOSING, SLIPPING], barred_point=0, barred_state=SLIP_MINUS) == (4.0, 1, SLIP_PLUS)
    assert following([CLOSING, SLIPPING], barred_point=0, barred_state=SLIP_PLUS) == (2.0, 0, SLIP_MINUS)
    assert following([CLOSING, SLIPPING], barred_point=1, barred_state=SLIP_MINUS) == (2.0, 0, SLIP_MINUS)
    sticking = (SLIP_PLUS, -1.0, 1.5, 0.0, -0.25)
    assert following([sticking, SLIPPING], barred_point=0, barred_state=STICK) == (4.0, 1, SLIP_PLUS)
    assert following([sticking, SLIPPING], barred_point=0, barred_state=OPEN) == (2.0, 0, STICK)


def test_rates_below_the_noise_meet_no_breakpoint_unless_they_are_above_the_floor() -> None:
    points = [CLOSING, (STICK, -1.0, 0.0, -4.0, 0.0)]  # the fastest rate is 4; CLOSING changes its function by .5
    assert following(points, noise=0.1)[1] == 0
    assert following(points, noise=0.2)[1] == -1
    assert following(points, noise=0.2, floor=0.25)[1] == 0
    shear = [CLOSING, (STICK, -1.0, 0.0, -4.0, 8.0 / 3.0)]
    assert following(shear, noise=0.2)[1] == -1


def test_coming_breakpoints_are_listed_nearest_first_as_many_as_there_is_room_for() -> None:
    late, away = (OPEN, 2.0, 1.0, -0.25, 0.0), (OPEN, 0.5, 1.0, 0.25, 0.0)
    order = [late, SLIPPING, away, CLOSING]
    for room, expected in ((1, [3]), (2, [3, 1]), (3, [3, 1, 0]), (4, [3, 1, 0])):
        points, targets = np.full(room, -1), np.full(room, -1)
        assert coming_breakpoints(*arrays(order), points, targets) == len(expected)
        assert points[: len(expected)].tolist() == expected
        states = {3: SLIP_MINUS, 1: SLIP_PLUS, 0: SLIP_PLUS}
        assert targets[: len(expected)].tolist() == [states[k] for k in expected]


def test_of_both_breakpoints_of_a_point_the_nearer_is_coming() -> None:
    point = (STICK, -1.0, 0.5, 0.0, -0.75)  # mu N = 1: backwards after 1.5 / .75
    points, targets = np.full(2, -1), np.full(2, -1)
    assert coming_breakpoints(*arrays([point]), points, targets) == 1
    assert (points[0], targets[0]) == (0, SLIP_MINUS)
    sooner = (OPEN, 0.25, 1.0, -0.25, 0.0)  # closes after one step, before the other slips
    assert coming_breakpoints(*arrays([point, sooner]), points, targets) == 2
    assert points.tolist() == [1, 0]
    slower = (STICK, -1.0, 0.0, 0.0, -0.25)  # slips after four
    assert coming_breakpoints(*arrays([slower, point]), points, targets) == 2
    assert points.tolist() == [1, 0]
    both = (SLIP_PLUS, -1.0, 1.5, 0.25, -0.125)  # opens after 4; shear 1.5 - t/8 meets 1 - t/4 nowhere
    assert coming_breakpoints(*arrays([both]), points, targets) == 1
    assert targets[0] == OPEN


@pytest.mark.parametrize(("virgin", "expected"), [(True, STICK), (False, OPEN)])
def test_a_point_that_just_touches_sticks_only_before_anything_moved(virgin: bool, expected: int) -> None:
    state = np.full(3, -1)
    opening = np.array([0.0, 1e-300, -1e-300])
    classify(opening, np.array([0.0, 0.0, 1.0]), np.full(3, KN), np.full(3, MU), np.zeros(3), state, virgin)
    assert state.tolist() == [expected, OPEN, SLIP_PLUS]


def test_a_point_at_the_limit_of_friction_sticks() -> None:
    state = np.full(3, -1)
    classify(
        np.full(3, -1.0), np.array([1.0, -1.0, 1.0]), np.full(3, KN), np.array([MU, MU, 0.0]), np.zeros(3), state, False
    )
    assert state.tolist() == [STICK, STICK, SLIP_PLUS]


def test_states_give_the_same_forces_at_their_breakpoint_only() -> None:
    def same(state: int, other: int, opening: float, trial: float, tolerance: float = 1e-9) -> bool:
        one = [np.array([value]) for value in (opening, trial, KN, MU, LIFT)]
        return same_forces(*one, np.array([state]), np.array([other]), tolerance)

    assert same(STICK, STICK, -1.0, 9.0)
    assert same(STICK, SLIP_PLUS, -1.0, 1.0)  # mu N = 1
    assert not same(STICK, SLIP_MINUS, -1.0, 1.0)
    assert not same(STICK, SLIP_PLUS, -1.0, 1.25)
    assert same(STICK, SLIP_PLUS, -1.0, 1.25, tolerance=0.26)
    assert not same(STICK, SLIP_PLUS, -1.0, 1.25, tolerance=0.25)
    assert same(OPEN, SLIP_PLUS, 0.0, 1.0)
    assert not same(OPEN, SLIP_PLUS, -0.25, 1.0, tolerance=0.5)
    assert point_forces(-0.25, 1.0, KN, MU, LIFT, SLIP_PLUS) == (0.5, 0.25)
    assert point_forces(-0.25, 1.0, KN, MU, LIFT, SLIP_MINUS) == (0.5, -0.25)


def test_displacements_and_gaps_advance_along_their_rates() -> None:
    u, opening, trial = np.array([1.0, -2.0]), np.array([0.5]), np.array([0.25])
    largest = advance(u, np.array([0.5, -4.0]), opening, trial, np.array([2.0]), np.array([-1.0]), 0.5)
    assert (u.tolist(), opening.tolist(), trial.tolist(), largest) == ([1.25, -4.0], [1.5], [-0.25], 4.0)
    assert live_rate(np.array([2.0, -3.0]), np.array([5.0, 7.0])) == -11.0


def test_fastest_rates_of_all_gaps_and_of_those_whose_forces_change_elastically() -> None:
    state = np.array([OPEN, SLIP_PLUS, STICK])
    kt = np.array([0.5, 0.5, 0.5])

    def rates(opening: list[float], trial: list[float], lift: float = 0.0) -> tuple[float, float]:
        return strain_rates(np.array(opening), np.array(trial), kt, np.full(3, lift), state)

    assert rates([8.0, -2.0, 1.0], [0.0, 0.0, 0.0]) == (8.0, 2.0)  # an open gap carries nothing
    assert rates([0.0, 1.0, 0.0], [3.0, -4.0, 1.0]) == (8.0, 2.0)  # slips are trials over kt; one that slips is free
    assert rates([0.0, 0.0, 0.0], [0.0, 0.0, -3.0]) == (6.0, 6.0)
    assert rates([0.0, 2.0, 0.0], [0.0, 4.0, 0.0], lift=0.5) == (8.0, 0.0)  # one that lifts as it slips is free
