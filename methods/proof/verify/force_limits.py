"""What bounds the forces of all states of a window of a certificate, in fractions."""

from __future__ import annotations

import copy
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from methods.proof.verify.exact_wall import (
    ZERO,
    CertificateError,
    ExactWall,
    Form,
    integers,
    listed,
    number,
    paired,
    whole,
    whole_numbers,
)

Sides = Mapping[int, tuple[Fraction, Fraction | None]]
"""{interface: (least, greatest normal force)}; None where there is no limit from above."""


class Forces:
    """Bounds of normal forces in all states of a window, each from virtual velocities.

    Forces in equilibrium do no work, so any virtual velocities may be added to a sum of forces; what is then left at an
    interface is at most a multiple of its normal force. Forces of an interface are sums of `rays`.
    """

    def __init__(
        self,
        wall: ExactWall,
        low: Fraction,
        high: Fraction,
        document: Any,
        tight: Collection[int] = (),
        sides: Sides | None = None,
    ) -> None:
        self.wall, self.low, self.high = wall, low, high
        self.tight, self.rays = frozenset(tight), _rays_of(wall, tight)
        self.sides: Sides = {} if sides is None else sides
        self.unit = 2 ** whole(document["exponent"], 0, 200)
        m = wall.n_interfaces
        self._rows, self._row_unit = integers([dict(row) for row in wall.sparse])
        self._loads, self._load_unit = integers([dict(enumerate(wall.live)), dict(enumerate(wall.dead))])
        friction, self._friction_unit = integers([dict(enumerate(wall.friction))])
        self._friction = {p: friction[0].get(p, 0) for p in range(m)}
        self.total: Fraction | None = None
        base, worst = self._above({p: Fraction(1) for p in range(m)}, document["total"])
        if worst >= 1:
            raise CertificateError("the normal forces of a window are not bounded")
        self.total = max(ZERO, base / (1 - worst))
        alone = [self.greatest({p: Fraction(1)}, v) for p, v in paired(range(m), document["greatest"])]
        self.normal = [min(self.total, max(ZERO, normal)) for normal in alone]

    def within(self, low: Fraction, tight: Collection[int]) -> Forces:
        """The same bounds for the states from `low` on, of them those without slack in these contacts."""
        part = copy.copy(self)
        part.low, part.tight, part.rays = low, frozenset(tight), _rays_of(self.wall, tight)
        return part

    def beside(self, interface: int, normal: Fraction, above: bool) -> Forces:
        """The same bounds for the states whose normal force at an interface is at most, or at least, so much."""
        part = copy.copy(self)
        least, most = self.sides.get(interface, (ZERO, None))
        lower = (least, normal if most is None else min(most, normal))
        part.sides = {**self.sides, interface: (max(least, normal), most) if above else lower}
        return part

    def limits(self) -> list[tuple[int, int, Fraction]]:
        """(interface, side, limit) of normal forces, sorted: side * (N - limit) >= 0."""
        found: list[tuple[int, int, Fraction]] = []
        for p, (least, most) in sorted(self.sides.items()):
            found += [(p, 1, least)] if least > 0 else []
            found += [(p, -1, most)] if most is not None else []
        return found

    def least_multiplier(self, velocities: Any) -> Fraction | None:
        """A lower bound of the multiplier of these states; None if velocities show that there are none."""
        if any(least > 0 and not self.rays[p] for p, (least, _) in self.sides.items()):
            return None
        v = whole_numbers(velocities, len(self.wall.dead))
        live, dead = (
            Fraction(sum([value * v[d] for d, value in load.items()]), self.unit * self._load_unit)
            for load in self._loads
        )
        paid, worst = self._beyond({}, v)
        most = paid + worst * (self.total or ZERO) - dead  # of live times the multiplier
        if live < 0:
            least = most / live
            return least if least <= self.high else None
        return self.low if most >= live * self.low else None

    def greatest(self, weights: Form, velocities: Any) -> Fraction:
        """An upper bound of a weighted sum of normal forces; weights {interface: weight}."""
        base, worst = self._above(weights, velocities)
        return base + worst * (self.total or ZERO)

    def least_slack(self, contact: int, velocities: Any) -> Fraction:
        """A lower bound of a yield slack."""
        p, k = divmod(contact, 4)
        mu = self.wall.friction[p]
        one = Fraction(1)
        slack = ({0: -one}, {1: -one}, {0: -mu, 1: -mu, 2: -one}, {0: -mu, 1: -mu, 2: one})[k]
        base, worst = self._above_form({3 * p + i: v for i, v in slack.items()}, velocities)
        return -(base + worst * (self.total or ZERO))

    def _above(self, weights: Form, velocities: Any) -> tuple[Fraction, Fraction]:
        form = {3 * p + end: weight for p, weight in weights.items() for end in (0, 1)}
        return self._above_form(form, velocities)

    def _above_form(self, form: Form, velocities: Any) -> tuple[Fraction, Fraction]:
        """(a, b) such that the form of forces is at most a + b times the sum of normal forces."""
        v = whole_numbers(velocities, len(self.wall.dead))
        paid, worst = self._beyond(form, v)
        live, dead = (
            Fraction(-sum([value * v[d] for d, value in load.items()]), self.unit * self._load_unit)
            for load in self._loads
        )
        return paid + dead + max(self.low * live, self.high * live), worst

    def _beyond(self, form: Form, v: list[int]) -> tuple[Fraction, Fraction]:
        """(a, b) such that the form less the work of velocities is at most a + b times the sum of normal forces.

        At an interface it is at most a multiple of its normal force, which may have limits of its own.
        """
        scale, mu_unit = self.unit * self._row_unit * self._friction_unit, self._friction_unit
        paid: Fraction = ZERO
        worst = 0
        self.wall.in_time()
        for p, mu in self._friction.items():
            first, second, shear = (
                (int(form[k] * scale) if k in form else 0)
                - mu_unit * sum([value * v[d] for d, value in self._rows[k].items()])
                for k in range(3 * p, 3 * p + 3)
            )
            multiples = [(second if end else first) * mu_unit + side * mu * shear for end, side in self.rays[p]]
            multiple = max(multiples, default=0)
            least, most = self.sides.get(p, (ZERO, None))
            if multiple < 0:
                paid += multiple * least
            elif most is not None:
                paid += multiple * most
            else:
                worst = max(worst, multiple)
        return paid / (scale * mu_unit), Fraction(worst, scale * mu_unit)


def _rays_of(wall: ExactWall, tight: Collection[int]) -> list[list[tuple[int, int]]]:
    """The extreme forces of every interface without slack in `tight`: the end that presses, the side of friction."""
    rays: list[list[tuple[int, int]]] = []
    for p, mu in enumerate(wall.friction):
        rays.append([])
        for end, side in ((0, -1), (0, 1), (1, -1), (1, 1)):
            slacks = {4 * p + end, 4 * p + (2 if side > 0 else 3)} if mu else {4 * p + end}
            if slacks.isdisjoint(tight):
                rays[p].append((end, side))
    return rays


@dataclass(frozen=True)
class KnownLimits:
    """What is known of the contacts of all states of a window.

    Attributes:
        still: contacts without a rate; slow: contacts with a rate of at most so much.
        least: least normal forces of the interfaces that are loaded.
    """

    still: frozenset[int]
    least: Mapping[int, Fraction]
    slow: Mapping[int, Fraction]


def known_of(forces: Forces, document: Any) -> KnownLimits:
    """What virtual velocities show of contacts.

    Raises:
        CertificateError: they do not show what is said.
    """
    m = forces.wall.n_interfaces
    still = [whole(k, 0, 4 * m - 1) for k in listed(document["still"])]
    for k, velocities in paired(still, document["still_velocities"]):
        if forces.least_slack(k, velocities) <= 0:
            raise CertificateError("a contact that is held still may move")
    loaded = [whole(p, 0, m - 1) for p in listed(document["loaded"])]
    least: Form = {}
    for (p, claimed), velocities in paired(list(paired(loaded, document["least"])), document["least_velocities"]):
        least[p] = number(claimed)
        if least[p] < 0 or -forces.greatest({p: Fraction(-1)}, velocities) < least[p]:
            raise CertificateError("a normal force may be less than stated")
    return KnownLimits(frozenset(still), least, {})
