"""The search for the next kink along a straight piece of the path, and the record of gaps along it.

Inside a cell of states these functions stay positive:
    open: g (closes into slip);  slip: N (opens), sign tau - mu N (sticks);  stick: mu N -+ tau (slips).
The search is Harris' two-pass ratio test (1973): of the kinks met within a hair of the first, the one crossed
fastest is taken, which keeps the pivots away from zero.
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.fe.compiled import compiled
from methods.fe.gap_law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK


@compiled
def next_kink(
    opening: FloatArray,
    trial: FloatArray,
    opening_rate: FloatArray,
    trial_rate: FloatArray,
    kn: FloatArray,
    mu: FloatArray,
    state: IntArray,
    tolerance: float,
    least_rate: float,
    barred_point: int,
    barred_state: int,
) -> tuple[float, int, int]:
    """First kink along a direction.

    Args:
        opening, trial: (P,) g and tau now; opening_rate, trial_rate: (P,) along the direction.
        kn, mu: (P,) of the points; state: (P,) states.
        tolerance: how far (dimensionless force) a kink may be overrun by the choice among near ties.
        least_rate: rates of kink functions below this count as zero.
        barred_point, barred_state: the change just made the other way round, which is not taken back at once.

    Returns:
        (step, point, new state); step is infinite and point -1 when no kink follows.
    """
    best = np.inf
    for p in range(len(state)):
        for which in range(2):
            value, rate, new = kink_function(opening, trial, opening_rate, trial_rate, kn, mu, state, p, which)
            if rate < -least_rate and not (p == barred_point and new == barred_state):
                limit = (max(value, 0.0) + tolerance) / -rate
                if limit < best:
                    best = limit
    step, point, target, fastest = np.inf, -1, 0, 0.0
    if best == np.inf:
        return step, point, target
    for p in range(len(state)):
        for which in range(2):
            value, rate, new = kink_function(opening, trial, opening_rate, trial_rate, kn, mu, state, p, which)
            if rate < -least_rate and not (p == barred_point and new == barred_state):
                at = max(value, 0.0) / -rate
                if at <= best and -rate > fastest:
                    step, point, target, fastest = at, p, new, -rate
    return step, point, target


@compiled
def kink_function(
    opening: FloatArray,
    trial: FloatArray,
    opening_rate: FloatArray,
    trial_rate: FloatArray,
    kn: FloatArray,
    mu: FloatArray,
    state: IntArray,
    p: int,
    which: int,
) -> tuple[float, float, int]:
    """Value, rate and target state of kink function number `which` (0 or 1) of point p; rate 1 where there is none."""
    here = state[p]
    if here == OPEN:
        if which == 1:
            return 1.0, 1.0, OPEN
        return kn[p] * opening[p], kn[p] * opening_rate[p], SLIP_PLUS if trial[p] >= 0.0 else SLIP_MINUS
    normal, normal_rate = -kn[p] * opening[p], -kn[p] * opening_rate[p]
    if here == STICK:
        sign = 1.0 if which == 0 else -1.0
        value = mu[p] * normal - sign * trial[p]
        return value, mu[p] * normal_rate - sign * trial_rate[p], SLIP_PLUS if which == 0 else SLIP_MINUS
    if which == 0:
        return normal, normal_rate, OPEN
    if mu[p] == 0.0:
        return 1.0, 1.0, STICK
    sign = 1.0 if here == SLIP_PLUS else -1.0
    return sign * trial[p] - mu[p] * normal, sign * trial_rate[p] - mu[p] * normal_rate, STICK
