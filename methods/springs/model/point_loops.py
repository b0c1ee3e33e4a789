"""Compiled loops over the gap points of a wall: their strains, their tangents and changes of these."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.compiled import compiled
from methods.springs.model.gap_law import OPEN, flip_vectors, tangent_coefficients


@compiled
def point_strains(
    unknown: IntArray,
    rows: FloatArray,
    interface: IntArray,
    position: FloatArray,
    u: FloatArray,
    opening: FloatArray,
    slip: FloatArray,
) -> None:
    """Openings and slips (P,) at displacements u (N,), into `opening` and `slip`."""
    previous = -1
    e0 = e1 = e2 = 0.0
    for p in range(len(interface)):
        k = interface[p]
        if k != previous:
            e0 = e1 = e2 = 0.0
            for j in range(6):
                value = u[unknown[k, j]]
                e0 += rows[k, 0, j] * value
                e1 += rows[k, 1, j] * value
                e2 += rows[k, 2, j] * value
            previous = k
        opening[p] = (1.0 - position[p]) * e0 + position[p] * e1
        slip[p] = e2


@compiled
def add_tangent(
    slot: IntArray,
    rows: FloatArray,
    interface: IntArray,
    position: FloatArray,
    kn: FloatArray,
    kt: FloatArray,
    mu: FloatArray,
    lift: FloatArray,
    state: IntArray,
    values: FloatArray,
) -> None:
    """Add the tangents of all points in their states to the CSC values of the stiffness."""
    row_n = np.empty(6)
    for p in range(len(interface)):
        if state[p] == OPEN:
            continue
        k = interface[p]
        nn, tt, tn, nt = tangent_coefficients(kn[p], kt[p], mu[p], lift[p], state[p])
        for j in range(6):
            row_n[j] = (1.0 - position[p]) * rows[k, 0, j] + position[p] * rows[k, 1, j]
        for i in range(6):
            left_n = row_n[i] * nn + rows[k, 2, i] * tn
            left_t = rows[k, 2, i] * tt + row_n[i] * nt
            for j in range(6):
                values[slot[k, 6 * i + j]] += left_n * row_n[j] + left_t * rows[k, 2, j]


@compiled
def rank_one_change(
    rows: FloatArray,
    interface: IntArray,
    position: FloatArray,
    kn: FloatArray,
    kt: FloatArray,
    mu: FloatArray,
    lift: FloatArray,
    point: int,
    old: int,
    new: int,
    a: FloatArray,
    b: FloatArray,
) -> None:
    """The change a b' of the tangent when a point changes its state, into a and b (6,)."""
    k, x = interface[point], position[point]
    row_n = (1.0 - x) * rows[k, 0] + x * rows[k, 1]
    flip_vectors(row_n, rows[k, 2], kn[point], kt[point], mu[point], lift[point], old, new, a, b)


@compiled
def add_changes(
    unknown: IntArray,
    rows: FloatArray,
    interface: IntArray,
    position: FloatArray,
    kn: FloatArray,
    kt: FloatArray,
    mu: FloatArray,
    lift: FloatArray,
    changes: IntArray,
    columns: FloatArray,
) -> int:
    """Add the vectors a of changes (k, 3) to the columns of (N, k); returns the first row concerned."""
    a, b = np.empty(6), np.empty(6)
    first = len(columns)
    for c in range(len(changes)):
        point, old, new = changes[c]
        rank_one_change(rows, interface, position, kn, kt, mu, lift, point, old, new, a, b)
        index = unknown[interface[point]]
        for j in range(6):
            columns[index[j], c] += a[j]
            first = min(first, index[j])
    return first
