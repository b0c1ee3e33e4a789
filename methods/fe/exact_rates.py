"""Gap rates with twice the working precision, for the pieces on which the wall moves almost freely.

Close to a plateau displacements are 1e10 times the elastic ones. The elastic part of a gap rate is then the small
difference of large terms, and double precision would leave noise in the contact forces. The rounding of
each product (a fused multiply and add gives it) and of each sum is carried along (Ogita, Rump and Oishi, 2005).
"""

from __future__ import annotations

from harness.model.assembly import FloatArray, IntArray
from methods.fe.gap_law import OPEN, SLIP_PLUS, STICK
from methods.numerics.compiled import compiled, fused


@compiled
def add_product(high: float, low: float, a: float, b: float) -> tuple[float, float]:
    """(high + low) + a b, as a leading part and its error."""
    product = a * b
    error = fused(a, b, -product)
    total = high + product
    part = total - high
    error += (high - (total - part)) + (product - part)
    return total, low + error


@compiled
def exact_gap_rates(
    unknown: IntArray,
    rows: FloatArray,
    interface: IntArray,
    position: FloatArray,
    kt: FloatArray,
    velocity: FloatArray,
    tail: FloatArray,
    opening_rate: FloatArray,
    trial_rate: FloatArray,
) -> None:
    """Rates of g and tau (P,) along velocity + tail (N,), as if computed in doubled precision."""
    previous = -1
    e0 = e1 = e2 = 0.0
    for p in range(len(interface)):
        k = interface[p]
        if k != previous:
            e0 = e1 = e2 = 0.0
            f0 = f1 = f2 = 0.0
            for j in range(6):
                value = velocity[unknown[k, j]]
                e0, f0 = add_product(e0, f0, rows[k, 0, j], value)
                e1, f1 = add_product(e1, f1, rows[k, 1, j], value)
                e2, f2 = add_product(e2, f2, rows[k, 2, j], value)
            for j in range(6):
                value = tail[unknown[k, j]]
                f0 += rows[k, 0, j] * value
                f1 += rows[k, 1, j] * value
                f2 += rows[k, 2, j] * value
            e0, e1, e2 = e0 + f0, e1 + f1, e2 + f2
            previous = k
        opening_rate[p] = (1.0 - position[p]) * e0 + position[p] * e1
        trial_rate[p] = kt[p] * e2


@compiled
def tangent_defect(
    unknown: IntArray,
    rows: FloatArray,
    interface: IntArray,
    position: FloatArray,
    kn: FloatArray,
    mu: FloatArray,
    state: IntArray,
    opening: FloatArray,
    trial: FloatArray,
    out: FloatArray,
) -> None:
    """Subtract from `out` (N,) the generalised internal forces of gaps g, tau (P,), or their rates likewise."""
    for p in range(len(interface)):
        if state[p] == OPEN:
            continue
        normal = kn[p] * opening[p]
        shear = trial[p]
        if state[p] == SLIP_PLUS:
            shear = -mu[p] * normal
        elif state[p] != STICK:
            shear = mu[p] * normal
        k = interface[p]
        x = position[p]
        for j in range(6):
            row_n = (1.0 - x) * rows[k, 0, j] + x * rows[k, 1, j]
            out[unknown[k, j]] -= row_n * normal + rows[k, 2, j] * shear
