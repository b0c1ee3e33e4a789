"""The law of one gap point: a no-tension normal spring and a Coulomb-limited tangential spring that may dilate.

A plastic slip of size e beyond the elastic one lifts the point by psi e. With the opening g, the slip s, the trial
shear tau = kt s + h, where h = T0 - kt s0 holds the friction history, and the lift psi / kt of a unit of shear beyond
friction:

    open   g > lift |tau|       N = T = 0
    stick  |tau| <= -mu kn g    N = -kn g,                                        T = tau
    slip   otherwise            N = kn (lift |tau| - g) / (1 + mu kn lift),       T = sign(tau) mu N

It is the return mapping along the flow vector of `harness.model.joint_law`: from tau and -kn g at once, so that a slip
that goes back takes the lift back, as teeth on the faces of a joint do. Without dilatancy N = -kn g where it slips.
T is the shear as an internal force, positive with s; the contact force of the project's convention is -T.
Every change between neighbouring states is a rank-one change of the tangent, because the law is continuous:
K_new - K_old = a b' where b is the gradient of the breakpoint function that is crossed (Katzenelson, 1965).
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.compiled import compiled
from methods.numerics.joint_loops import shear_limit

OPEN, STICK, SLIP_PLUS, SLIP_MINUS = 0, 1, 2, 3
"""The states of a gap point, as compiled loops take them."""


@compiled
def slip_compression(opening: float, trial: float, kn: float, mu: float, lift: float, sign: float) -> float:
    """Compression N of a point that slips with the sign of its trial shear; its rate for rates of g and tau."""
    return kn * (lift * sign * trial - opening) / (1.0 + mu * kn * lift)


@compiled
def classify(
    opening: FloatArray,
    trial: FloatArray,
    kn: FloatArray,
    mu: FloatArray,
    lift: FloatArray,
    state: IntArray,
    virgin: bool,
) -> None:
    """States of the gap points from openings and trial shears, all (P,), into `state`; `virgin` lets g = 0 stick."""
    for p in range(len(opening)):
        lifted = lift[p] * abs(trial[p])
        if opening[p] > lifted or (opening[p] == lifted and not virgin):
            state[p] = OPEN
            continue
        limit = -mu[p] * kn[p] * opening[p]
        if mu[p] > 0.0 and abs(trial[p]) <= limit:
            state[p] = STICK
        else:
            state[p] = SLIP_PLUS if trial[p] >= 0.0 else SLIP_MINUS


@compiled
def point_forces(opening: float, trial: float, kn: float, mu: float, lift: float, state: int) -> tuple[float, float]:
    """Compression N and internal shear T of one point held in a state."""
    if state == OPEN:
        return 0.0, 0.0
    if state == STICK:
        return -kn * opening, trial
    sign = 1.0 if state == SLIP_PLUS else -1.0
    normal = slip_compression(opening, trial, kn, mu, lift, sign)
    return normal, sign * shear_limit(mu, normal)


@compiled
def gap_forces(
    opening: FloatArray,
    trial: FloatArray,
    kn: FloatArray,
    mu: FloatArray,
    lift: FloatArray,
    state: IntArray,
    normal: FloatArray,
    shear: FloatArray,
) -> None:
    """Compression N and internal shear T of points held in the given states, all (P,), into `normal` and `shear`."""
    for p in range(len(opening)):
        normal[p], shear[p] = point_forces(opening[p], trial[p], kn[p], mu[p], lift[p], state[p])


@compiled
def same_forces(
    opening: FloatArray,
    trial: FloatArray,
    kn: FloatArray,
    mu: FloatArray,
    lift: FloatArray,
    state: IntArray,
    other: IntArray,
    tolerance: float,
) -> bool:
    """Whether two sets of states (P,) give the same forces: they differ at most at points on their breakpoint."""
    for p in range(len(opening)):
        if state[p] != other[p]:
            ours = point_forces(opening[p], trial[p], kn[p], mu[p], lift[p], state[p])
            theirs = point_forces(opening[p], trial[p], kn[p], mu[p], lift[p], other[p])
            if not max(abs(ours[0] - theirs[0]), abs(ours[1] - theirs[1])) < tolerance:
                return False
    return True


@compiled
def frozen_forces(
    opening: FloatArray,
    trial: FloatArray,
    limit: FloatArray,
    kn: FloatArray,
    kt: FloatArray,
    psi: FloatArray,
    state: IntArray,
    pressed: FloatArray,
    shear: FloatArray,
) -> None:
    """The law with the shear c that slip dissipates frozen (Tresca), which is the derivative of a convex energy.

    A point that slips by e bears T = c + psi N at N = kn (psi e - g); with c = (mu - psi) N it is the law itself.

    Args:
        opening, trial: (P,) g and tau; limit: (P,) c; kn, kt, psi: (P,) of the points.
        state, pressed, shear: (P,) receive the states, the openings -N / kn of the normal springs, and T. A point that
            bears no compression is OPEN where its shear has reached c.
    """
    for p in range(len(opening)):
        beyond = max(abs(trial[p]) - limit[p], 0.0)
        slip = beyond / kt[p]
        if psi[p] * slip > opening[p]:
            slip = max(abs(trial[p]) - limit[p] + psi[p] * kn[p] * opening[p], 0.0) / (kt[p] + psi[p] ** 2 * kn[p])
        pressed[p] = min(opening[p] - psi[p] * slip, 0.0)
        borne = limit[p] - psi[p] * kn[p] * pressed[p]
        shear[p] = min(max(trial[p], -borne), borne)
        if abs(trial[p]) < borne:
            state[p] = STICK
        elif pressed[p] < 0.0:
            state[p] = SLIP_PLUS if trial[p] >= 0.0 else SLIP_MINUS
        else:
            state[p] = OPEN


@compiled
def tangent_coefficients(kn: float, kt: float, mu: float, lift: float, state: int) -> tuple[float, float, float, float]:
    """(dFn/dg, dT/ds, dT/dg, dFn/ds) of one point in its state, Fn = -N being the internal normal force."""
    if state == OPEN:
        return 0.0, 0.0, 0.0, 0.0
    if state == STICK:
        return kn, kt, 0.0, 0.0
    sign = 1.0 if state == SLIP_PLUS else -1.0
    soft = kn / (1.0 + mu * kn * lift)
    return soft, mu * soft * lift * kt, -sign * mu * soft, -sign * soft * lift * kt


@compiled
def flip_vectors(
    row_n: FloatArray,
    row_t: FloatArray,
    kn: float,
    kt: float,
    mu: float,
    lift: float,
    old: int,
    new: int,
    a: FloatArray,
    b: FloatArray,
) -> None:
    """The rank-one change a b' of one point's tangent between neighbouring states, all vectors (6,), into a and b."""
    slip = old if new in (OPEN, STICK) else new
    sign = 1.0 if slip == SLIP_PLUS else -1.0
    share = 1.0 / (1.0 + mu * kn * lift)
    if old == OPEN or new == OPEN:
        direction = 1.0 if old == OPEN else -1.0
        for j in range(6):
            a[j] = direction * (row_n[j] - sign * mu * row_t[j])
            b[j] = kn * share * (row_n[j] - sign * lift * kt * row_t[j])
    else:
        direction = -1.0 if old == STICK else 1.0
        for j in range(6):
            a[j] = direction * share * (row_t[j] + sign * kn * lift * row_n[j])
            b[j] = kt * row_t[j] + sign * mu * kn * row_n[j]


def neighbour_states(state: int) -> tuple[int, ...]:
    """The states a point can reach across one breakpoint; a point passes through slip before it opens."""
    if state in (OPEN, STICK):
        return (SLIP_PLUS, SLIP_MINUS)
    return (OPEN, STICK)


def equivalent_end_forces(
    position: FloatArray, interface: IntArray, normal: FloatArray, shear: FloatArray, n_interfaces: int
) -> FloatArray:
    """The forces (n1, n2, s) on the two ends of every interface that are statically equivalent to the gap forces.

    Args:
        position: (P,) in [0, 1] from end 1.
        interface: (P,) index of the interface of each point.
        normal, shear: (P,) compression N and internal shear T [force].
        n_interfaces: m.

    Returns:
        (m, 3): n1 = sum N (1 - xi), n2 = sum N xi, s = -sum T.
    """
    ends = np.empty((n_interfaces, 3))
    ends[:, 0] = np.bincount(interface, normal * (1.0 - position), n_interfaces)
    ends[:, 1] = np.bincount(interface, normal * position, n_interfaces)
    ends[:, 2] = -np.bincount(interface, shear, n_interfaces)
    return ends
