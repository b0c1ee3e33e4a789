"""The law of joints in one place: which forces they bear, and how they move when those are at their limit.

Forces r = (n1, n2, s) of an interface are within yield where its slacks y = S r + s0 >= 0: in dry joints (s0 = 0) no
tension at either end, and shear within friction both ways. Tensile strength T of an interface is the constant part T/2
at both ends, cohesion c on an area A the constant part c A both ways of shear. At collapse it moves along the flow
vectors of the rows that are zero, q = E g with rates g = (open1, open2, slip+, slip-) >= 0, y . g = 0 and
q = (open1, open2, slip), as strains are defined in `assembly`. A slip lifts both ends by the dilatancy psi,
0 <= psi <= mu: E = S' for psi = mu (associated flow), and nothing is lifted for psi = 0. The work that the joint takes
is -q . r = s0 . g for associated flow, and (mu - psi) N times the slip more for any other. Sources: Coulomb (1776);
Drucker (1954) for flow with dilatancy; Baggio and Trovalusci (1995); Orduna and Lourenco (2003) for cohesion, tension.

A law of more rows is that of several joints in series (`methods.numerics.joints_in_series`).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import scipy.sparse as sp

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class JointLaw:
    """Coulomb's law of m interfaces.

    Attributes:
        friction: (m,) coefficients mu, zero or more.
        dilatancy: (m,) coefficients psi by which a slip lifts the ends, from zero to mu.
        constant: (m, 4) constant parts s0 of the slacks [force], zero for dry joints; or what broadcasts to it.
    """

    friction: FloatArray
    dilatancy: FloatArray
    constant: FloatArray = field(default_factory=partial(np.zeros, 4))

    def __post_init__(self) -> None:
        """Every interface has its constants.

        Raises:
            ValueError: the constants are of other interfaces.
        """
        object.__setattr__(self, "constant", np.broadcast_to(self.constant, (len(self.friction), 4)))

    @property
    def rows(self) -> FloatArray:
        """(m, 4, 3) rows S of the yield slacks y = S r + s0 = (n1, n2, mu N + s, mu N - s) + s0, N = n1 + n2."""
        return _rows(self.friction)

    @property
    def flow(self) -> FloatArray:
        """(m, 3, 4) flow vectors E, one a column, of the strains q = E g."""
        return np.asarray(_rows(self.dilatancy).transpose(0, 2, 1))

    @cached_property
    def dry(self) -> NDArray[np.bool_]:
        """(m,) interfaces without constant parts, whose yield domain is a cone."""
        return np.asarray(~np.any(self.constant, axis=1))

    @cached_property
    def is_cone(self) -> bool:
        """Whether the yield domain of all joints is a cone: any multiple of forces within yield is within yield."""
        return bool(self.dry.all())

    @property
    def least_normal(self) -> FloatArray:
        """(m, 2) least normal forces at both ends: minus half the tensile strength, zero in dry joints."""
        return np.asarray(0.0 - self.constant[:, :2])  # the negative of zero would have a sign

    def by_friction(self, compression: FloatArray) -> FloatArray:
        """(m,) shear mu N that friction bears at compressions N (m,)."""
        return np.asarray(self.friction * compression)

    def dissipated(self, compression: FloatArray) -> FloatArray:
        """(m,) shear (mu - psi) N at compressions N (m,), whose work on a slip is more than the lift gives back."""
        return np.asarray((self.friction - self.dilatancy) * compression)

    def part_by_friction(self, share: FloatArray, compression: FloatArray) -> FloatArray:
        """(m,) shears that are shares (m,) of what friction bears at compressions N (m,), as those frozen in."""
        return np.asarray(share * self.friction * compression)

    def shear_range(self, forces: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(m,) least and (m,) greatest shear that the normal forces of (m, 3) leave each interface."""
        borne = self.by_friction(forces[:, 0] + forces[:, 1])
        return -(borne + self.constant[:, 2]), borne + self.constant[:, 3]

    @property
    def greatest_compression(self) -> FloatArray:
        """(m,) compression that leaves no shear within yield: infinite but in rows of bars (`with_bars_as_joints`)."""
        cohesion = 0.5 * (self.constant[:, 2] + self.constant[:, 3])
        falls = self.friction < 0.0
        return np.where(falls, cohesion / np.where(falls, -self.friction, 1.0), np.inf)

    def strength(self, forces: FloatArray) -> FloatArray:
        """(m,) shear strength mu (n1 + n2) + c A that forces (m, 3) leave each interface: half its `shear_range`."""
        cohesion = 0.5 * (self.constant[:, 2] + self.constant[:, 3])
        return self.by_friction(forces[:, 0] + forces[:, 1]) + cohesion

    def slacks(self, forces: FloatArray) -> FloatArray:
        """(m, 4) yield slacks S r + s0 of forces (m, 3), negative where they break the law."""
        borne, shear = self.by_friction(forces[:, 0] + forces[:, 1]), forces[:, 2]
        return np.column_stack([forces[:, :2], borne + shear, borne - shear]) + self.constant

    def forces_of_slacks(self, slack: FloatArray) -> FloatArray:
        """(m, 3) forces of slacks (m, 4)."""
        own = slack - self.constant
        return np.column_stack([own[:, :2], 0.5 * (own[:, 2] - own[:, 3])])

    def within(self, forces: FloatArray) -> FloatArray:
        """Forces (m, 3) without the tension and then without the shear that break the law, as rounding leaves them."""
        normal = np.maximum(forces[:, :2], self.least_normal)
        return np.column_stack([normal, np.clip(forces[:, 2], *self.shear_range(normal))])

    def rates(self, strains: FloatArray) -> FloatArray:
        """(m, 4) smallest rates g with q = E g of strains q (m, 3); openings come out negative where joints close."""
        slip = strains[:, 2]
        lift = self.dilatancy * abs(slip)
        return np.column_stack(
            [strains[:, 0] - lift, strains[:, 1] - lift, np.maximum(slip, 0.0), np.maximum(-slip, 0.0)]
        )

    def dissipation(self, rates: FloatArray) -> float:
        """Work s0 . g that the constant parts take on rates (m, 4)."""
        return float((self.constant * rates).sum())

    def lift(self, share: float) -> FloatArray:
        """(m,) coefficients by which a slip lifts: the joints' own for `share` 0, the friction for 1."""
        return np.asarray(self.dilatancy + share * (self.friction - self.dilatancy))

    @property
    def associated(self) -> JointLaw:
        """The same joints with the dilatancy of associated flow."""
        return JointLaw(self.friction, self.friction, self.constant)

    @property
    def without_constant(self) -> JointLaw:
        """The same joints dry: the directions in which forces within yield have no end."""
        return JointLaw(self.friction, self.dilatancy)

    def in_units(self, force: float) -> JointLaw:
        """The law of forces that are measured in this unit [force]."""
        return JointLaw(self.friction, self.dilatancy, self.constant / force)

    def with_friction(self, friction: FloatArray) -> JointLaw:
        """The joints with friction (m,), and the dilatancy that this leaves them."""
        return JointLaw(friction, np.minimum(self.dilatancy, friction), self.constant)


def _rows(slope: FloatArray) -> FloatArray:
    rows = np.zeros((len(slope), 4, 3))
    rows[:, 0, 0] = rows[:, 1, 1] = rows[:, 2, 2] = 1.0
    rows[:, 3, 2] = -1.0
    rows[:, 2:, :2] = slope[:, None, None]
    return rows


def block_diagonal(parts: FloatArray) -> sp.csr_matrix:
    """Sparse (a m, b m) matrix with the m matrices (m, a, b) on its diagonal; zeros within them are left out."""
    import scipy.sparse as sp

    m, a, b = parts.shape
    part, row, column = np.nonzero(parts)
    return sp.csr_matrix((parts[part, row, column], (a * part + row, b * part + column)), shape=(a * m, b * m))
