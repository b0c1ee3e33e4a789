"""The loops of the LU in dense blocks: factors and solutions of a matrix whose supernodes are known.

Arrays are those of `methods.numerics.block_lu.BlockPattern`.
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.compiled import compiled, compiled_loosely

COLUMNS = 8
"""Right-hand sides that are solved for at once: reading the factors from memory costs more than the sums."""
_LIBRARY_ENTRIES = 100
"""Matrices of fewer entries than this are multiplied with COLUMNS columns by our own loops, for the same reason."""
_LIBRARY_PRODUCTS = 4000
"""Products of fewer multiplications than this are spelt out: a library call would cost more."""


@compiled
def _eliminate(d: FloatArray, swapped: IntArray) -> bool:
    """LU of a matrix in place with rows swapped; False if it is singular."""
    n = len(d)
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(d[i, k]) > abs(d[best, k]):
                best = i
        if not abs(d[best, k]) > 0.0:
            return False
        swapped[k] = best
        if best != k:
            for j in range(n):
                d[k, j], d[best, j] = d[best, j], d[k, j]
        for i in range(k + 1, n):
            share = d[i, k] / d[k, k]
            d[i, k] = share
            if share != 0.0:
                for j in range(k + 1, n):
                    d[i, j] -= share * d[k, j]
    return True


@compiled_loosely
def _divide(rows: FloatArray, lu: FloatArray, swapped: IntArray, columns: FloatArray) -> float:
    """Rows (r, w) times the inverse of a matrix given by its LU, in place; the greatest entry.

    The sums run down the columns (w, r), of which there are more than of rows.
    """
    greatest = 0.0
    n = len(lu)
    for i in range(len(rows)):
        for k in range(n):
            columns[k, i] = rows[i, k]
    for k in range(n):
        share = 1.0 / lu[k, k]
        for i in range(len(rows)):
            columns[k, i] *= share
        for j in range(k + 1, n):
            _subtract_times(columns[j], lu[k, j], columns[k])
    for k in range(n - 1, -1, -1):
        for j in range(k):
            _subtract_times(columns[j], lu[k, j], columns[k])
    for k in range(n - 1, -1, -1):
        other = swapped[k]
        if other != k:
            for i in range(len(rows)):
                columns[k, i], columns[other, i] = columns[other, i], columns[k, i]
    for i in range(len(rows)):
        for k in range(n):
            rows[i, k] = columns[k, i]
            greatest = max(greatest, abs(columns[k, i]))
    return greatest


@compiled_loosely
def _subtract_times(x: FloatArray, factor: float, y: FloatArray) -> None:
    """x -= factor y."""
    for i in range(len(x)):
        x[i] -= factor * y[i]


@compiled
def _solve_columns(lu: FloatArray, swapped: IntArray, x: FloatArray) -> None:
    """Solve in place for the columns of x (w, c) with a matrix given by its LU."""
    n, columns = x.shape
    for k in range(n):
        other = swapped[k]
        if other != k:
            for c in range(columns):
                x[k, c], x[other, c] = x[other, c], x[k, c]
    for i in range(n):
        for k in range(i):
            entry = lu[i, k]
            for c in range(columns):
                x[i, c] -= entry * x[k, c]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            entry = lu[i, k]
            for c in range(columns):
                x[i, c] -= entry * x[k, c]
        pivot = lu[i, i]
        for c in range(columns):
            x[i, c] /= pivot


@compiled_loosely
def _product(a: FloatArray, b: FloatArray, out: FloatArray) -> None:
    """out = a b' for row-major a (3 p, q), b (3 s, q)."""
    p, q, s = a.shape[0], a.shape[1], b.shape[0]
    if p * q * s >= _LIBRARY_PRODUCTS:
        np.dot(a, b.T, out)
        return
    for i in range(p):
        for j in range(0, s, 3):
            t0 = t1 = t2 = 0.0
            for k in range(q):
                entry = a[i, k]
                t0 += entry * b[j, k]
                t1 += entry * b[j + 1, k]
                t2 += entry * b[j + 2, k]
            out[i, j], out[i, j + 1], out[i, j + 2] = t0, t1, t2


@compiled
def factorise(
    start: IntArray,
    owner: IntArray,
    row_start: IntArray,
    row: IntArray,
    offset: IntArray,
    values: FloatArray,
    swapped: IntArray,
    growth: float,
    symmetric: bool,
) -> bool:
    """Supernode by supernode: subtract what those before it reach, eliminate its diagonal, divide what lies below.

    Of a symmetric matrix only what lies below the diagonal is used and updated; what lies above is its copy.
    """
    count = len(start) - 1
    head, following = np.full(count, -1), np.full(count, -1)
    reached = np.zeros(count, dtype=np.int64)
    position = np.zeros(start[-1], dtype=np.int64)
    most = 3 * max(1, np.diff(row_start).max())
    widest = 3 * np.diff(start).max()
    buffer = np.empty(most * widest)
    greatest = 0.0
    for s in range(count):
        c0, c1 = start[s], start[s + 1]
        w, r = 3 * (c1 - c0), 3 * (row_start[s + 1] - row_start[s])
        at = offset[s]
        diagonal = values[at : at + w * w].reshape(w, w)
        low = values[at + w * w : at + w * (w + r)].reshape(r, w)
        up = values[at + w * (w + r) : at + w * (w + 2 * r)].reshape(r, w)
        rows = row[row_start[s] : row_start[s + 1]]
        for i in range(len(rows)):
            position[rows[i]] = i
        d = head[s]
        while d >= 0:
            after = following[d]
            their = row[row_start[d] : row_start[d + 1]]
            n = len(their)
            v = 3 * (start[d + 1] - start[d])
            base = offset[d] + v * v
            left = values[base : base + 3 * n * v].reshape(3 * n, v)
            right = values[base + 3 * n * v : base + 6 * n * v].reshape(3 * n, v)
            p1 = reached[d]
            p2 = p1
            while p2 < n and their[p2] < c1:
                p2 += 1
            k = 3 * (p2 - p1)
            work = buffer[: 3 * (n - p1) * k].reshape(3 * (n - p1), k)
            _product(left[3 * p1 :], right[3 * p1 : 3 * p2], work)
            for i in range(p1, n):
                if their[i] < c1:
                    _subtract(diagonal, 3 * (their[i] - c0), work, 3 * (i - p1), their, p1, p2, c0)
                else:
                    _subtract(low, 3 * position[their[i]], work, 3 * (i - p1), their, p1, p2, c0)
            if p2 < n:
                if not symmetric:
                    work = buffer[: 3 * (n - p2) * k].reshape(3 * (n - p2), k)
                    _product(right[3 * p2 :], left[3 * p1 : 3 * p2], work)
                    for i in range(p2, n):
                        _subtract(up, 3 * position[their[i]], work, 3 * (i - p2), their, p1, p2, c0)
                t = owner[their[p2]]
                following[d] = head[t]
                head[t] = d
            reached[d] = p2
            d = after
        if not _eliminate(diagonal, swapped[3 * c0 : 3 * c0 + w]):
            return False
        if r:
            if symmetric:
                up[:] = low
            columns = buffer[: w * r].reshape(w, r)
            greatest = max(greatest, _divide(low, diagonal, swapped[3 * c0 : 3 * c0 + w], columns))
            t = owner[rows[0]]
            following[s] = head[t]
            head[t] = s
    return greatest < growth


@compiled
def _subtract(out: FloatArray, i: int, work: FloatArray, k: int, columns: IntArray, p1: int, p2: int, c0: int) -> None:
    """Subtract three rows of `work`, from k on, from those of `out`, from i on, at the columns of blocks p1 to p2."""
    for p in range(p1, p2):
        j, m = 3 * (columns[p] - c0), 3 * (p - p1)
        for a in range(3):
            out[i + a, j] -= work[k + a, m]
            out[i + a, j + 1] -= work[k + a, m + 1]
            out[i + a, j + 2] -= work[k + a, m + 2]


@compiled_loosely
def substitute(
    start: IntArray,
    row_start: IntArray,
    row: IntArray,
    offset: IntArray,
    values: FloatArray,
    swapped: IntArray,
    x: FloatArray,
) -> None:
    """Forward pass, then the backward pass with the factorised diagonals."""
    count = len(start) - 1
    for s in range(count):
        c0, w = 3 * start[s], 3 * (start[s + 1] - start[s])
        some = False
        for i in range(c0, c0 + w):
            some |= x[i] != 0.0
        if not some:
            continue
        q0, q1 = row_start[s], row_start[s + 1]
        at = offset[s] + w * w
        low = values[at : at + 3 * (q1 - q0) * w].reshape(3 * (q1 - q0), w)
        for q in range(q1 - q0):
            i = 3 * q
            t0 = t1 = t2 = 0.0
            for k in range(w):
                entry = x[c0 + k]
                t0 += low[i, k] * entry
                t1 += low[i + 1, k] * entry
                t2 += low[i + 2, k] * entry
            j = 3 * row[q0 + q]
            x[j] -= t0
            x[j + 1] -= t1
            x[j + 2] -= t2
    part = np.empty(3 * np.diff(start).max())
    for s in range(count - 1, -1, -1):
        c0, w = 3 * start[s], 3 * (start[s + 1] - start[s])
        q0, q1 = row_start[s], row_start[s + 1]
        r = 3 * (q1 - q0)
        at = offset[s]
        lu = values[at : at + w * w].reshape(w, w)
        up = values[at + w * (w + r) : at + w * (w + 2 * r)].reshape(r, w)
        for k in range(w):
            part[k] = x[c0 + k]
        for q in range(q1 - q0):
            i, j = 3 * q, 3 * row[q0 + q]
            y0, y1, y2 = x[j], x[j + 1], x[j + 2]
            for k in range(w):
                part[k] -= up[i, k] * y0 + up[i + 1, k] * y1 + up[i + 2, k] * y2
        for k in range(w):
            other = swapped[c0 + k]
            part[k], part[other] = part[other], part[k]
        for i in range(w):
            total = part[i]
            for k in range(i):
                total -= lu[i, k] * part[k]
            part[i] = total
        for i in range(w - 1, -1, -1):
            total = part[i]
            for k in range(i + 1, w):
                total -= lu[i, k] * x[c0 + k]
            x[c0 + i] = total / lu[i, i]


@compiled_loosely
def substitute_many(
    start: IntArray,
    row_start: IntArray,
    row: IntArray,
    offset: IntArray,
    values: FloatArray,
    swapped: IntArray,
    first: int,
    x: FloatArray,
) -> None:
    """As `substitute`, for COLUMNS columns at once."""
    count = len(start) - 1
    pieces = np.empty((3 * np.diff(row_start).max() + 3, COLUMNS))
    products = np.empty((3 * np.diff(start).max(), COLUMNS))
    for s in range(first, count):
        c0, w = 3 * start[s], 3 * (start[s + 1] - start[s])
        ours = x[c0 : c0 + w]
        some = False
        for i in range(w):
            for c in range(COLUMNS):
                some |= ours[i, c] != 0.0
        q0, r = row_start[s], 3 * (row_start[s + 1] - row_start[s])
        if not some or not r:
            continue
        at = offset[s] + w * w
        low = values[at : at + r * w].reshape(r, w)
        part = pieces[:r]
        _times(low, ours, part)
        for i in range(r):
            j = 3 * row[q0 + i // 3] + i % 3
            for c in range(COLUMNS):
                x[j, c] -= part[i, c]
    for s in range(count - 1, -1, -1):
        c0, w = 3 * start[s], 3 * (start[s + 1] - start[s])
        q0, r = row_start[s], 3 * (row_start[s + 1] - row_start[s])
        at = offset[s]
        lu = values[at : at + w * w].reshape(w, w)
        up = values[at + w * (w + r) : at + w * (w + 2 * r)].reshape(r, w)
        ours, product = x[c0 : c0 + w], products[:w]
        if r:
            part = pieces[:r]
            for i in range(r):
                j = 3 * row[q0 + i // 3] + i % 3
                for c in range(COLUMNS):
                    part[i, c] = x[j, c]
            if r * w >= _LIBRARY_ENTRIES:
                np.dot(up.T, part, product)
                for i in range(w):
                    for c in range(COLUMNS):
                        ours[i, c] -= product[i, c]
            else:
                for i in range(r):
                    for k in range(w):
                        entry = up[i, k]
                        for c in range(COLUMNS):
                            ours[k, c] -= entry * part[i, c]
        _solve_columns(lu, swapped[c0 : c0 + w], ours)


@compiled_loosely
def _times(a: FloatArray, x: FloatArray, out: FloatArray) -> None:
    """out = a x for x (q, COLUMNS)."""
    if a.size >= _LIBRARY_ENTRIES:
        np.dot(a, x, out)
        return
    for i in range(a.shape[0]):
        for c in range(COLUMNS):
            out[i, c] = 0.0
        for k in range(a.shape[1]):
            entry = a[i, k]
            for c in range(COLUMNS):
                out[i, c] += entry * x[k, c]


@compiled
def eliminated_into(start: IntArray, neighbour: IntArray) -> tuple[IntArray, IntArray]:
    """The block that each of n is eliminated into, -1 for none, and how many rows its column of L has: both (n,).

    From every block one climbs the tree that is known so far, beginning at its earlier neighbours (Liu 1986).

    Args:
        start: (n + 1,) where the neighbours of each block start in `neighbour`, which holds each pair both ways.
    """
    n = len(start) - 1
    parent, seen, count = np.full(n, -1), np.full(n, -1), np.zeros(n, dtype=np.int64)
    for i in range(n):
        seen[i] = i
        for p in range(start[i], start[i + 1]):
            j = neighbour[p]
            while j < i and seen[j] != i:
                seen[j] = i
                count[j] += 1
                if parent[j] < 0:
                    parent[j] = i
                j = parent[j]
    return parent, count


@compiled
def add_congruences(slot: IntArray, rows: FloatArray, middle: FloatArray, values: FloatArray) -> None:
    """Add the products rows' middle rows (6, 6) of every interface to the values at its slots.

    Args:
        slot: (m, 36) places of the products; rows: (m, 3, 6); middle: (m, 3, 3); values: (n_values,).
    """
    half = np.empty((3, 6))
    for p in range(len(rows)):
        for k in range(3):
            for j in range(6):
                half[k, j] = middle[p, k, 0] * rows[p, 0, j] + middle[p, k, 1] * rows[p, 1, j]
                half[k, j] += middle[p, k, 2] * rows[p, 2, j]
        for i in range(6):
            for j in range(6):
                total = rows[p, 0, i] * half[0, j] + rows[p, 1, i] * half[1, j] + rows[p, 2, i] * half[2, j]
                values[slot[p, 6 * i + j]] += total
