"""Inverse of the 3 x 3 interface matrix A = E diag(w) S, in closed form so that infinite weights do no harm."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray


def flexibility(friction: FloatArray, weight: FloatArray, associated: bool) -> FloatArray:
    """(m, 3, 3) inverses of A = E diag(w) S.

    Args:
        friction: (m,) friction coefficients mu.
        weight: (m, 4) weights w > 0 of the slacks; 1e40 holds a slack where it is.
        associated: E = S'; otherwise E without dilatancy.
    """
    mu = friction
    inverse = np.zeros((len(mu), 3, 3))
    total = weight[:, 2] + weight[:, 3]
    skew = (weight[:, 2] - weight[:, 3]) / total * mu
    if associated:
        # A = [[w1 + a, a, b], [a, w2 + a, b], [b, b, c]] with a = mu^2 c, b = mu d; eliminate the shear first.
        leftover = mu**2 * 4.0 * weight[:, 2] * weight[:, 3] / total
        w1, w2 = weight[:, 0], weight[:, 1]
        determinant = w1 * w2 + leftover * (w1 + w2)
        n11, n22, n12 = (w2 + leftover) / determinant, (w1 + leftover) / determinant, -leftover / determinant
        inverse[:, 0, 0], inverse[:, 1, 1] = n11, n22
        inverse[:, 0, 1] = inverse[:, 1, 0] = n12
        inverse[:, 0, 2] = inverse[:, 2, 0] = -skew * (n11 + n12)
        inverse[:, 1, 2] = inverse[:, 2, 1] = -skew * (n22 + n12)
        inverse[:, 2, 2] = 1.0 / total + skew**2 * (n11 + 2.0 * n12 + n22)
    else:
        inverse[:, 0, 0], inverse[:, 1, 1] = 1.0 / weight[:, 0], 1.0 / weight[:, 1]
        inverse[:, 2, 0], inverse[:, 2, 1] = -skew / weight[:, 0], -skew / weight[:, 1]
        inverse[:, 2, 2] = 1.0 / total
    return inverse
