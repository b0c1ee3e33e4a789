"""Gap rates with twice the working precision, for the pieces on which the wall moves almost freely.

Close to a plateau displacements are 1e10 times the elastic ones. The elastic part of a gap rate is then the small
difference of large terms, and double precision would leave noise in the contact forces. The rounding of
each product (a fused multiply and add gives it) and of each sum is carried along (Ogita, Rump and Oishi, 2005).
"""

from __future__ import annotations

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.compiled import compiled, fused
from methods.springs.model.gap_law import point_forces


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
    lift: FloatArray,
    state: IntArray,
    opening: FloatArray,
    trial: FloatArray,
    out: FloatArray,
) -> None:
    """Subtract from `out` (N,) the generalised internal forces of gaps g, tau (P,), or their rates likewise."""
    total = len(interface)
    p = 0
    while p < total:
        k = interface[p]
        end1 = end2 = slip = 0.0
        while p < total and interface[p] == k:
            normal, shear = point_forces(opening[p], trial[p], kn[p], mu[p], lift[p], state[p])
            end1 -= (1.0 - position[p]) * normal
            end2 -= position[p] * normal
            slip += shear
            p += 1
        if end1 != 0.0 or end2 != 0.0 or slip != 0.0:
            for j in range(6):
                out[unknown[k, j]] -= rows[k, 0, j] * end1 + rows[k, 1, j] * end2 + rows[k, 2, j] * slip
