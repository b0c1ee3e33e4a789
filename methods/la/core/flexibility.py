"""Inverse of the 3 x 3 interface matrix A = E diag(w) S, in closed form so that infinite weights do no harm."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray
from harness.model.joint_law import JointLaw


class Compliance:
    """A^-1 of every interface, as matrices and as a product without cancellation.

    With N = n1 + n2 the third row of A r = e reads s = e3 / (w3 + w4) - skew N; what remains for (n1, n2) is
    diag(w1, w2) plus a rank-one term of the dilatancy.

    Args:
        law: of the joints, for its rows S.
        weight: (m, 4) weights w > 0 of the slacks; 1e40 holds a slack where it is.
        lift: (m,) coefficients by which a slip lifts: mu for associated flow, 0 for sliding without dilatancy.
    """

    def __init__(self, law: JointLaw, weight: FloatArray, lift: FloatArray) -> None:
        self._law, friction = law, law.friction
        self.total = weight[:, 2] + weight[:, 3]
        self.share = weight[:, 2:] / self.total[:, None]
        tilt = self.share[:, 0] - self.share[:, 1]
        self.skew, self.rise = tilt * friction, tilt * lift
        leftover = lift * friction * 4.0 * weight[:, 2] * self.share[:, 1]
        w1, w2 = weight[:, 0], weight[:, 1]
        determinant = w1 * w2 + leftover * (w1 + w2)
        self.ends = np.column_stack([w2, w1]) / determinant[:, None]
        self.turn = leftover / determinant

    @property
    def matrices(self) -> FloatArray:
        """(m, 3, 3) inverses."""
        inverse = np.zeros((len(self.total), 3, 3))
        inverse[:, 0, 0], inverse[:, 1, 1] = self.ends[:, 0] + self.turn, self.ends[:, 1] + self.turn
        inverse[:, 0, 1] = inverse[:, 1, 0] = -self.turn
        inverse[:, 2, :2] = -self.skew[:, None] * self.ends
        inverse[:, :2, 2] = -self.rise[:, None] * self.ends
        inverse[:, 2, 2] = 1.0 / self.total + self.rise * self.skew * self.ends.sum(axis=1)
        return inverse

    def forces(self, strain: FloatArray) -> FloatArray:
        """(m, 3) forces r = A^-1 e of strains e (m, 3)."""
        return self._both(strain)[0]

    def response(self, strain: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Forces (m, 3) and their slacks S A^-1 e (m, 4): y3 = 2 mu N w4/(w3 + w4) + e3/(w3 + w4) and y4 likewise."""
        forces, normal = self._both(strain)
        strength = 2.0 * self._law.by_friction(normal)
        own = strain[:, 2] / self.total
        ends = forces[:, :2]
        return forces, np.column_stack([ends, strength * self.share[:, 1] + own, strength * self.share[:, 0] - own])

    def _both(self, strain: FloatArray) -> tuple[FloatArray, FloatArray]:
        opening = strain[:, :2] - (self.rise * strain[:, 2])[:, None]
        parts = self.ends * opening
        turned = self.turn * (opening[:, 0] - opening[:, 1])
        normal = parts[:, 0] + parts[:, 1]
        shear = strain[:, 2] / self.total - self.skew * normal
        return np.column_stack([parts[:, 0] + turned, parts[:, 1] - turned, shear]), normal
