"""Check in fractions of the cases of a certificate: windows whose states are divided, and divided again.

In a collapse state every contact has no slack or no rate, and every normal force is at most so much or at least so
much: what holds of both halves holds of all states. Within a half, virtual velocities and virtual forces show more of
contacts. docs/theory-bound.md holds the proofs.

What each statement of a case stands for:

- contact, interface and normal with two parts: y g = 0 at a contact, and N <= v or N >= v; both halves are needed.
- still, loaded, statics: virtual work with velocities on the forces within yield of the case.
- slow, tight, no mechanism: virtual work with forces on the mechanisms of the case, whose live work is one; a rate
  above zero leaves no slack.
- window: as of all states, with the velocities that these bound already.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from methods.proof.verify.exact_wall import (
    ZERO,
    CertificateError,
    ExactWall,
    Form,
    Vector,
    in_digits,
    listed,
    number,
    paired,
    whole,
    whole_numbers,
)
from methods.proof.verify.force_limits import Forces, KnownLimits
from methods.proof.verify.window_limits import most_of
from methods.proof.verify.windows import WindowLimits


@dataclass(frozen=True)
class States:
    """Collapse states from `low` to `high` of one case, and what is known of all of them.

    Attributes:
        forces: bounds of their forces.
        reach: greatest velocities of their mechanisms, whose live work is one.
        known: of their contacts.
        low: no state of the case has a smaller multiplier; it is `high` where there are none.
    """

    forces: Forces
    reach: Vector
    known: KnownLimits
    low: Fraction

    @property
    def wall(self) -> ExactWall:
        """Of the certificate."""
        return self.forces.wall

    @property
    def high(self) -> Fraction:
        """Upper end of the window of all cases."""
        return self.forces.high

    def half(self, contact: int, tight: bool) -> States:
        """Those without slack at a contact, or those without a rate there."""
        if tight:
            return replace(self, forces=self.forces.within(self.low, self.forces.tight | {contact}))
        return replace(self, known=replace(self.known, still=self.known.still | {contact}))

    def beside(self, interface: int, normal: Fraction, above: bool) -> States:
        """Those whose normal force at an interface is at most, or at least, so much."""
        return replace(self, forces=self.forces.within(self.low, self.forces.tight).beside(interface, normal, above))

    def halves(self, node: Any) -> tuple[States, States]:
        """Both parts of a node: without slack or without a rate at its contact, or below and above a normal force."""
        if "contact" in node:
            contact = self.contact(node)
            return self.half(contact, True), self.half(contact, False)
        interface, normal = whole(node["interface"], 0, self.wall.n_interfaces - 1), number(node["normal"])
        if normal < 0:
            raise CertificateError("a normal force is not below zero")
        return self.beside(interface, normal, False), self.beside(interface, normal, True)

    def after(self, step: Any) -> States:
        """The same states with what a step shows.

        Raises:
            CertificateError: it does not show what it says.
        """
        return STEPS[step["shows"]](self.at(self.low), step)

    def at(self, low: Fraction) -> States:
        """The states from this multiplier on, at most `high`."""
        low = min(low, self.high)
        return replace(self, low=low, forces=self.forces.within(low, self.forces.tight))

    def greatest(self, form: Form, document: Any) -> Fraction:
        """An upper bound of form.u, by virtual forces.

        The lift of mechanisms is not negative, so any multiple of it may be added; forces do the work of their strains.
        """
        wall, unit = self.wall, 2 ** whole(document["exponent"], 0, 400)
        strains = [Fraction(v, unit) for v in whole_numbers(document["strains"], len(wall.sparse))]
        lift, work = (Fraction(v, unit) for v in whole_numbers([document["lift"], document["work"]], 2))
        if lift < 0:
            raise CertificateError("a multiple of the lift is below zero")
        rest = [-work * f + lift * (self.high * f + g) for f, g in zip(wall.live, wall.dead, strict=True)]
        for d, value in form.items():
            rest[d] += value
        for d, value in enumerate(wall.resultant(strains)):
            rest[d] -= value
        paid: Fraction = work + sum((abs(value) * most for value, most in zip(rest, self.reach, strict=True)), ZERO)
        for p, mu in enumerate(wall.friction):
            spent = lift * mu * self.known.least.get(p, ZERO)
            first, second, slip = strains[3 * p : 3 * p + 3]
            for k, value in enumerate((first, second, slip - spent, -slip - spent)):
                if value > 0:
                    paid += value * self.greatest_rate(4 * p + k)
        return paid

    def greatest_rate(self, contact: int) -> Fraction:
        """Of all states."""
        if contact in self.known.still:
            return ZERO
        p, k = divmod(contact, 4)
        if contact in self.known.slow:
            return self.known.slow[contact]
        return most_of(self.wall, 3 * p + min(k, 2), self.reach)

    def rate(self, contact: int, sign: int) -> Form:
        """A form of velocities: an opening, or the slip that is the difference of both rates, times a sign."""
        p, k = divmod(contact, 4)
        return {d: sign * (-value if k == 3 else value) for d, value in self.wall.sparse[3 * p + min(k, 2)]}

    def window(self, document: Any) -> WindowLimits:
        """What a window of these states says of their forces and mechanisms, checked."""
        low = number(document["low"])
        if not low <= self.low:
            raise CertificateError(f"a window begins at {in_digits(low)}, where {in_digits(self.low)} is proved")
        forces = Forces(self.wall, low, self.high, document["forces"], self.forces.tight, self.forces.sides)
        return WindowLimits(self.wall, document, (forces, self.known, self.reach))

    def contact(self, step: Any) -> int:
        """The contact of a step."""
        return whole(step["contact"], 0, 4 * self.wall.n_interfaces - 1)


def states_of(limits: WindowLimits, greatest: Fraction, low: Fraction) -> States:
    """All states of a window from a multiplier on, of the size of whose mechanisms this is the greatest."""
    reach = [-_short(-most * greatest) for most in limits.motions.limits[: limits.columns.n]]
    return States(limits.forces.within(low, ()), reach, limits.columns.known, low)


def case_bound(states: States, node: Any) -> Fraction:
    """The multiplier, at most the upper end of the window, below which a node of the cases leaves no state.

    Raises:
        CertificateError: it proves nothing of the kind.
    """
    least: list[Fraction] = []
    left = [(states, node)]
    while left:
        states, node = left.pop()
        for step in listed(node["steps"]):
            if states.low >= states.high:
                raise CertificateError("a step is of a case that is empty")
            states = states.after(step)
        if "parts" not in node:
            least.append(states.low)
            continue
        left += paired(states.halves(node), node["parts"])
    return min(least)


def _still(states: States, step: Any) -> States:
    contact = states.contact(step)
    if states.forces.least_slack(contact, step["velocities"]) <= 0:
        raise CertificateError("a contact that is held still may move")
    return replace(states, known=replace(states.known, still=states.known.still | {contact}))


def _loaded(states: States, step: Any) -> States:
    p = whole(step["interface"], 0, states.wall.n_interfaces - 1)
    least = number(step["least"])
    if not ZERO <= least <= -states.forces.greatest({p: Fraction(-1)}, step["velocities"]):
        raise CertificateError("a normal force may be less than stated")
    return replace(states, known=replace(states.known, least={**states.known.least, p: least}))


def _slow(states: States, step: Any) -> States:
    contact = states.contact(step)
    most = -_short(-max(ZERO, states.greatest(states.rate(contact, 1), step)))
    return replace(states, known=replace(states.known, slow={**states.known.slow, contact: most}))


def _tight(states: States, step: Any) -> States:
    contact = states.contact(step)
    if states.greatest(states.rate(contact, -1), step) >= 0:
        raise CertificateError("a contact that is held tight may have no rate")
    return replace(states, forces=states.forces.within(states.low, states.forces.tight | {contact}))


def _statics(states: States, step: Any) -> States:
    least = states.forces.least_multiplier(step["velocities"])
    return states.at(states.high if least is None else max(states.low, _short(least)))


def _no_mechanism(states: States, step: Any) -> States:
    if states.greatest({}, step) >= 0:
        raise CertificateError("the forces of a case do not exclude its mechanisms")
    return states.at(states.high)


def _window(states: States, step: Any) -> States:
    limits = states.window(step)
    return states.at(max(states.low, limits.bound(step["multiplier"], limits.greatest_size(step["size"]))))


STEPS: dict[str, Callable[[States, Any], States]] = {
    "still": _still,
    "loaded": _loaded,
    "slow": _slow,
    "tight": _tight,
    "statics": _statics,
    "no mechanism": _no_mechanism,
    "window": _window,
}


def _short(value: Fraction) -> Fraction:
    """A binary fraction that is not above a value, and not longer than a certificate needs."""
    unit = 2**60
    return Fraction(math.floor(value * unit), unit)
