"""The search for the next breakpoint along a straight piece of the path.

Inside a cell of states these functions stay positive:
    open: g -+ lift tau (closes);  slip: N (opens), sign tau + mu kn g (sticks);  stick: -mu kn g -+ tau (slips).
The search is Harris' two-pass ratio test (1973): of the breakpoints met within a hair of the first, the one crossed
fastest is taken, which keeps the pivots away from zero.
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.compiled import compiled
from methods.numerics.joint_loops import shear_limit
from methods.numerics.vectors import largest
from methods.springs.model.gap_law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, slip_compression


@compiled
def breakpoint_functions(
    opening: float,
    trial: float,
    opening_rate: float,
    trial_rate: float,
    kn: float,
    mu: float,
    lift: float,
    state: int,
) -> tuple[float, float, float, float]:
    """Values and rates (value 0, rate 0, value 1, rate 1) of both breakpoint functions of a point; rate 1 for none."""
    if state == OPEN:
        lifted, lifted_rate = lift * trial, lift * trial_rate
        return (
            kn * (opening - lifted),
            kn * (opening_rate - lifted_rate),
            kn * (opening + lifted),
            kn * (opening_rate + lifted_rate),
        )
    limit, limit_rate = shear_limit(mu, -kn * opening), shear_limit(mu, -kn * opening_rate)
    if state == STICK:
        return limit - trial, limit_rate - trial_rate, limit + trial, limit_rate + trial_rate
    sign = 1.0 if state == SLIP_PLUS else -1.0
    normal = slip_compression(opening, trial, kn, mu, lift, sign)
    normal_rate = slip_compression(opening_rate, trial_rate, kn, mu, lift, sign)
    if mu == 0.0:
        return normal, normal_rate, 1.0, 1.0
    return normal, normal_rate, sign * trial - limit, sign * trial_rate - limit_rate


@compiled
def target_state(state: int, which: int, trial: float) -> int:
    """The state behind breakpoint function `which`; a point that closes slips the way its trial shear pulls."""
    if state == OPEN:
        return SLIP_PLUS if trial >= 0.0 else SLIP_MINUS
    if state == STICK:
        return SLIP_PLUS if which == 0 else SLIP_MINUS
    return OPEN if which == 0 else STICK


@compiled
def next_breakpoint(
    opening: FloatArray,
    trial: FloatArray,
    opening_rate: FloatArray,
    trial_rate: FloatArray,
    kn: FloatArray,
    mu: FloatArray,
    lift: FloatArray,
    state: IntArray,
    tolerance: float,
    noise: float,
    floor: float,
    barred_point: int,
    barred_state: int,
) -> tuple[float, int, int]:
    """Find the first breakpoint on the way.

    Args:
        opening, trial: (P,) g and tau now; opening_rate, trial_rate: (P,) their rates.
        kn, mu, lift: (P,) of the points; state: (P,) states.
        tolerance: how far (dimensionless force) a breakpoint may be overrun by the choice among near ties.
        noise: rates of breakpoint functions below this share of the fastest gap rate count as zero, if below `floor`.
        barred_point, barred_state: the change just made the other way round, which is not taken back at once.

    Returns:
        (step, point, new state); step is infinite and point -1 when no breakpoint follows.
    """
    count = len(state)
    least = min(noise * max(largest(opening_rate), largest(trial_rate)), floor)
    best = np.inf
    within = np.empty(count, dtype=np.int64)
    found = 0
    for p in range(count):
        v0, r0, v1, r1 = breakpoint_functions(
            opening[p], trial[p], opening_rate[p], trial_rate[p], kn[p], mu[p], lift[p], state[p]
        )
        near = False
        if r0 < -least and max(v0, 0.0) <= -r0 * best:
            near = True
            if max(v0, 0.0) + tolerance < -r0 * best and (
                p != barred_point or target_state(state[p], 0, trial[p]) != barred_state
            ):
                best = (max(v0, 0.0) + tolerance) / -r0
        if r1 < -least and max(v1, 0.0) <= -r1 * best:
            near = True
            if max(v1, 0.0) + tolerance < -r1 * best and (
                p != barred_point or target_state(state[p], 1, trial[p]) != barred_state
            ):
                best = (max(v1, 0.0) + tolerance) / -r1
        if near:
            within[found] = p
            found += 1
    step, point, target, speed = np.inf, -1, 0, 0.0
    if best == np.inf:
        return step, point, target
    best *= 1.0 + 1e-14
    for p in within[:found]:
        v0, r0, v1, r1 = breakpoint_functions(
            opening[p], trial[p], opening_rate[p], trial_rate[p], kn[p], mu[p], lift[p], state[p]
        )
        if r0 < -least and -r0 > speed and max(v0, 0.0) <= -r0 * best:
            at = max(v0, 0.0) / -r0
            new = target_state(state[p], 0, trial[p] + at * trial_rate[p])
            if p != barred_point or new != barred_state:
                step, point, target, speed = at, p, new, -r0
        if r1 < -least and -r1 > speed and max(v1, 0.0) <= -r1 * best:
            at = max(v1, 0.0) / -r1
            new = target_state(state[p], 1, trial[p] + at * trial_rate[p])
            if p != barred_point or new != barred_state:
                step, point, target, speed = at, p, new, -r1
    return step, point, target


@compiled
def coming_breakpoints(
    opening: FloatArray,
    trial: FloatArray,
    opening_rate: FloatArray,
    trial_rate: FloatArray,
    kn: FloatArray,
    mu: FloatArray,
    lift: FloatArray,
    state: IntArray,
    points: IntArray,
    targets: IntArray,
) -> int:
    """The next breakpoints along a piece if no state changed, one a point at most; arguments as in `next_breakpoint`.

    Args:
        points, targets: (k,) receive the points and the states behind their breakpoints, nearest first.

    Returns:
        How many were found, at most k.
    """
    limit, found = len(points), 0
    steps = np.empty(limit)
    for p in range(len(state)):
        v0, r0, v1, r1 = breakpoint_functions(
            opening[p], trial[p], opening_rate[p], trial_rate[p], kn[p], mu[p], lift[p], state[p]
        )
        at, which = np.inf, 0
        if r0 < 0.0:
            at = max(v0, 0.0) / -r0
        if r1 < 0.0 and max(v1, 0.0) < -r1 * at:
            at, which = max(v1, 0.0) / -r1, 1
        if at == np.inf or (found == limit and at >= steps[found - 1]):
            continue
        i = min(found, limit - 1)
        while i > 0 and steps[i - 1] > at:
            steps[i], points[i], targets[i] = steps[i - 1], points[i - 1], targets[i - 1]
            i -= 1
        steps[i], points[i], targets[i] = at, p, target_state(state[p], which, trial[p] + at * trial_rate[p])
        found = min(found + 1, limit)
    return found


@compiled
def advance(
    u: FloatArray,
    velocity: FloatArray,
    opening: FloatArray,
    trial: FloatArray,
    opening_rate: FloatArray,
    trial_rate: FloatArray,
    step: float,
) -> float:
    """Move displacements (N,) and gaps (P,) along their rates; returns the largest displacement."""
    for i in range(len(u)):
        u[i] += step * velocity[i]
    for p in range(len(opening)):
        opening[p] += step * opening_rate[p]
        trial[p] += step * trial_rate[p]
    return largest(u)


@compiled
def live_rate(load: FloatArray, u: FloatArray) -> float:
    """Inner product (N,), spelt out so that small walls do not pay for a library call."""
    total = 0.0
    for i in range(len(u)):
        total += load[i] * u[i]
    return total


@compiled
def strain_rates(
    opening_rate: FloatArray, trial_rate: FloatArray, kt: FloatArray, lift: FloatArray, state: IntArray
) -> tuple[float, float]:
    """The fastest rate of any gap, and the fastest of those that change a force elastically."""
    fastest = elastic = 0.0
    for p in range(len(state)):
        opening, slip = abs(opening_rate[p]), abs(trial_rate[p] / kt[p])
        fastest = max(fastest, opening, slip)
        if state[p] == STICK:
            elastic = max(elastic, opening, slip)
        elif state[p] != OPEN:
            sign = 1.0 if state[p] == SLIP_PLUS else -1.0
            elastic = max(elastic, abs(opening_rate[p] - sign * lift[p] * trial_rate[p]))
    return fastest, elastic
