"""The wall of a certificate for the second checker, and the reading of its numbers: no import from `methods`."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable
from fractions import Fraction
from itertools import product
from math import ceil, floor, lcm
from typing import Any

Form = dict[Hashable, Fraction]
NIL, ONE = Fraction(0), Fraction(1)


class Refused(Exception):
    """The certificate does not prove what it says."""


def need(condition: bool, reason: str) -> None:
    if not condition:
        raise Refused(reason)


def whole(value: Any, least: int | None = None, most: int | None = None) -> int:
    need(isinstance(value, int) and not isinstance(value, bool), "no whole number")
    need((least is None or value >= least) and (most is None or value <= most), "a whole number out of place")
    need(abs(value) <= 10**1000, "a number too long")
    return int(value)


def rational(value: Any) -> Fraction:
    if isinstance(value, str):
        need(re.fullmatch("-?[0-9]{1,1000}(/[0-9]{1,1000})?", value) is not None, "no fraction")
        return Fraction(value)
    return Fraction(whole(value))


def listed(values: Any, count: int | None = None) -> list[Any]:
    need(isinstance(values, list) and (count is None or len(values) == count), "no list of that length")
    return list(values)


def rationals(values: Any, count: int) -> list[Fraction]:
    found = [rational(v) for v in listed(values, count)]
    need(lcm(*(v.denominator for v in found)).bit_length() <= 100_000, "a common denominator too long")
    return found


def binary(values: Any, count: int, exponent: int) -> list[Fraction]:
    found = [Fraction(whole(v), 2**exponent) for v in listed(values, count)]
    need(all(abs(v.numerator).bit_length() <= 3000 for v in found), "a number too long")
    return found


def up(value: Fraction, places: int) -> Fraction:
    return Fraction(ceil(value * 2**places), 2**places)


def down(value: Fraction, places: int) -> Fraction:
    return Fraction(floor(value * 2**places), 2**places)


def plus(form: Form, other: Form, factor: Fraction = ONE) -> None:
    """Add a multiple of another form."""
    for name, value in other.items():
        form[name] = form.get(name, NIL) + factor * value


def value_of(form: Form, at: list[Fraction]) -> Fraction:
    return sum((value * at[k] for k, value in form.items() if isinstance(k, int)), NIL)


class Wall:
    """Blocks 0 to n - 1 and interfaces 0 to m - 1; strains[p] = (opening at end 1, at end 2, slip), per length."""

    def __init__(self, document: Any) -> None:
        blocks, joints = listed(document["blocks"]), listed(document["interfaces"])
        self.ids = [block["id"] for block in blocks]
        self.centres = [rationals(block["centroid"], 2) for block in blocks]
        self.dead = [v for block in blocks for v in rationals(block["dead"], 3)]
        self.live = [v for block in blocks for v in rationals(block["live"], 3)]
        need(any(self.live), "no live load")
        self.joints = []
        self.strains: list[tuple[Form, Form, Form]] = []
        self.friction: list[Fraction] = []
        for joint in joints:
            a, b = (None if joint[k] is None else whole(joint[k], 0, len(blocks) - 1) for k in "ab")
            need(a != b, "one block, or none, at an interface")
            ends, side = rationals(joint["ends"], 4), whole(joint["side"])
            need(side in (1, -1) and ends[:2] != ends[2:], "a side or a length that is none")
            mu = rational(joint["friction"])
            need(mu >= 0, "friction below zero")
            tangent = ends[2] - ends[0], ends[3] - ends[1]
            normal = -side * tangent[1], side * tangent[0]
            middle = (ends[0] + ends[2]) / 2, (ends[1] + ends[3]) / 2
            points = (ends[0], ends[1]), (ends[2], ends[3]), middle
            three = [self._relative(a, b, x, d) for x, d in zip(points, (normal, normal, tangent), strict=True)]
            self.strains.append((three[0], three[1], three[2]))
            self.friction.append(mu)
            self.joints.append((a, b, ends, side, mu))
        self.n, self.m = 3 * len(blocks), len(joints)

    def _relative(self, a: int | None, b: int | None, point: Any, direction: Any) -> Form:
        """Velocity of b less that of a at a point, in a direction."""
        form: Form = {}
        for block, sign in ((a, -1), (b, 1)):
            if block is not None:
                arm = [x - c for x, c in zip(point, self.centres[block], strict=True)]
                turn = arm[0] * direction[1] - arm[1] * direction[0]
                for k, v in enumerate((direction[0], direction[1], turn)):
                    form[3 * block + k] = sign * v
        return form

    def same_as(self, other: Wall) -> bool:
        mine, theirs = [*self.dead, *self.live], [*other.dead, *other.live]
        k = next(k for k, v in enumerate(theirs) if v)
        unit = mine[k] / theirs[k]
        alike = (self.ids, self.centres, self.joints) == (other.ids, other.centres, other.joints)
        return alike and unit > 0 and mine == [unit * v for v in theirs]

    def equilibrium(self, dof: int) -> Form:
        """The form of forces, multiplier and one that is zero."""
        form: Form = {"load": self.live[dof], "one": self.dead[dof]}
        for p, three in enumerate(self.strains):
            for k, strain in enumerate(three):
                if dof in strain:
                    form[3 * p + k] = strain[dof]
        return form

    def slack(self, contact: int) -> Form:
        p, k = divmod(contact, 4)
        if k < 2:
            return {3 * p + k: ONE}
        return {3 * p: self.friction[p], 3 * p + 1: self.friction[p], 3 * p + 2: ONE if k == 2 else -ONE}

    def rays(self, p: int, tight: Iterable[int]) -> list[tuple[int, Fraction]]:
        """Extreme forces of an interface with these slacks zero, per normal force: (end that presses, shear)."""
        found = []
        for end, side in product((0, 1), (-1, 1)):
            forces: dict[int, Fraction] = {3 * p + end: ONE, 3 * p + 2: side * self.friction[p]}
            slacks = [sum((v * forces.get(k, NIL) for k, v in self.slack(4 * p + c).items()), NIL) for c in range(4)]
            if not any(slacks[c] for c in range(4) if 4 * p + c in tight):
                found.append((end, side * self.friction[p]))
        return found
