"""The wall of a certificate in fractions, built from its blocks and interfaces alone, and the reading of its numbers.

What a certificate may cost is limited: digits of a number, of the common denominator of a list and of the wall, and
CPU seconds. A certificate beyond is refused, whatever it would prove.
"""

from __future__ import annotations

import math
import re
import time
from collections.abc import Iterable
from decimal import MAX_EMAX, MIN_EMIN, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from typing import Any

Vector = list[Fraction]
Form = dict[int, Fraction]
ZERO = Fraction(0)

MOST_DIGITS = 1000
"""Digits of a numerator or denominator. Certificates of the library have 137 at most."""
MOST_BITS = 20_000
"""Bits of a common denominator, so that no sum of fractions grows beyond. Certificates of the library have 2,813."""
_NUMBER = re.compile(rf"-?[0-9]{{1,{MOST_DIGITS}}}(/0*[1-9][0-9]{{0,{MOST_DIGITS - 1}}})?", re.ASCII)


class CertificateError(ValueError):
    """The certificate does not show what it says."""


def refusal_of(error: Exception) -> CertificateError:
    """The refusal of a certificate that an error stopped the reading of."""
    if isinstance(error, CertificateError):
        return error
    if isinstance(error, KeyError):
        return CertificateError(f"it has no {error}")
    return CertificateError(f"a part of it is not of the form of a certificate ({error})")


def number(value: Any) -> Fraction:
    """A number of a certificate: a whole one, or text of a whole number or a fraction, "-7/11".

    Raises:
        CertificateError: it is another thing (a float, a power of ten, true or false), or has too many digits.
    """
    if type(value) is int:
        return Fraction(whole(value))
    if not isinstance(value, str) or not _NUMBER.fullmatch(value):
        raise CertificateError(f"{repr(value)[:40]} is not a fraction of at most {MOST_DIGITS} digits")
    return Fraction(value)


def in_digits(value: Fraction) -> str:
    """A fraction of any size as a decimal of nine digits that is not above it."""
    context = Context(prec=9, rounding=ROUND_FLOOR, Emax=MAX_EMAX, Emin=MIN_EMIN)
    return f"{context.divide(Decimal(value.numerator), Decimal(value.denominator)).normalize(context):g}"


def fractions_of(values: Any, count: int) -> Vector:
    """A list of so many fractions.

    Raises:
        CertificateError: it is none.
    """
    if len(listed(values)) != count:
        raise CertificateError(f"{count} numbers are needed")
    found = [number(value) for value in values]
    common_denominator(found)
    return found


def common_denominator(values: Iterable[Fraction]) -> int:
    """The least common denominator.

    Raises:
        CertificateError: it has more than `MOST_BITS`.
    """
    unit = 1
    for value in values:
        if unit % value.denominator:
            unit = math.lcm(unit, value.denominator)
            if unit.bit_length() > MOST_BITS:
                raise CertificateError(f"the common denominator of its numbers has more than {MOST_BITS:,} bits")
    return unit


class ExactWall:
    """Strain rows (3m of 3n), loads (3n) and friction (m) from blocks and interfaces given in fractions.

    Normals keep the length of their interface: forces are then per length, the same for normal and shear.

    What is assumed of the wall, and checked here: it has free blocks and a live load; every interface has a length and
    a friction of zero or more, and joins two blocks of which one is free.

    Args:
        document: the certificate.
        seconds: of CPU time after which what is checked of the wall is refused.
    """

    def __init__(self, document: Any, seconds: float = math.inf) -> None:
        self._until = time.process_time() + seconds
        blocks, interfaces = listed(document["blocks"]), listed(document["interfaces"])
        if not blocks:
            raise CertificateError("a wall has free blocks")
        n = len(blocks)
        centroid = [fractions_of(block["centroid"], 2) for block in blocks]
        self.dead = [x for block in blocks for x in fractions_of(block["dead"], 3)]
        self.live = [x for block in blocks for x in fractions_of(block["live"], 3)]
        if not any(self.live):
            raise CertificateError("a wall without live load has no collapse state of any multiplier")
        self.friction = [number(item["friction"]) for item in interfaces]
        if any(mu < 0 for mu in self.friction):
            raise CertificateError("friction is zero or more")
        self.sparse: list[list[tuple[int, Fraction]]] = []
        for item in interfaces:
            self.in_time()
            x1, y1, x2, y2 = fractions_of(item["ends"], 4)
            sign = whole(item["side"])
            if (x1, y1) == (x2, y2) or abs(sign) != 1:
                raise CertificateError("an interface has two ends and a side of 1 or -1")
            joined = [(block, sense) for block, sense in ((item["a"], -1), (item["b"], 1)) if block is not None]
            if not joined or item["a"] == item["b"]:
                raise CertificateError("an interface joins two blocks, one of them free")
            tangent = (x2 - x1, y2 - y1)
            normal = (-sign * tangent[1], sign * tangent[0])
            for x, y, along in ((x1, y1, normal), (x2, y2, normal), ((x1 + x2) / 2, (y1 + y2) / 2, tangent)):
                row: Form = {}
                for block, sense in joined:
                    dx, dy = x - centroid[whole(block, 0, n - 1)][0], y - centroid[block][1]
                    turning = dx * along[1] - dy * along[0]
                    row |= {3 * block + k: sense * v for k, v in enumerate((along[0], along[1], turning)) if v}
                self.sparse.append(sorted(row.items()))
        self.n_interfaces = len(interfaces)
        numbers = [*self.dead, *self.live, *self.friction]
        common_denominator([*numbers, *(value for row in self.sparse for _, value in row)])

    def in_time(self) -> None:
        """Nothing, within the seconds.

        Raises:
            CertificateError: they are over.
        """
        if time.process_time() > self._until:
            raise CertificateError("the check exceeds its time limit")

    @property
    def rows(self) -> list[Vector]:
        """The strain rows with their zeros."""
        dense = [[ZERO] * len(self.dead) for _ in self.sparse]
        for full, row in zip(dense, self.sparse, strict=True):
            for k, value in row:
                full[k] = value
        return dense

    def strains(self, interface: int, velocities: Vector) -> tuple[Fraction, Fraction, Fraction]:
        """Opening at both ends and slip of an interface, times its length."""
        self.in_time()
        first, second, slip = (
            sum((value * velocities[k] for k, value in row), ZERO)
            for row in self.sparse[3 * interface : 3 * interface + 3]
        )
        return first, second, slip

    def work(self, loads: Vector, velocities: Vector) -> Fraction:
        """Work of loads (3n,) on velocities (3n,)."""
        total = ZERO
        for load, velocity in zip(loads, velocities, strict=True):
            if load and velocity:
                self.in_time()
                total += load * velocity
        return total

    def resultant(self, forces: Vector) -> Vector:
        """C' r of forces (3m,)."""
        self.in_time()
        total = [Fraction(0)] * len(self.dead)
        for row, force in zip(self.sparse, forces, strict=True):
            if force:
                self.in_time()
                for k, value in row:
                    total[k] += value * force
        return total


def integers(forms: list[Form]) -> tuple[list[dict[int, int]], int]:
    """Forms times their common denominator, and that denominator."""
    unit = common_denominator(value for form in forms for value in form.values())
    return [{k: int(value * unit) for k, value in form.items() if value} for form in forms], unit


def paired(first: Iterable[Any], second: Any) -> list[tuple[Any, Any]]:
    """Pairs of two lists of the same length.

    Raises:
        CertificateError: they are not.
    """
    first = list(first)
    if len(first) != len(listed(second)):
        raise CertificateError(f"{len(first)} entries are needed")
    return list(zip(first, second, strict=True))


def listed(values: Any) -> list[Any]:
    """A list, no object or text that might be gone through like one.

    Raises:
        CertificateError: it is none.
    """
    if not isinstance(values, list):
        raise CertificateError(f"{repr(values)[:40]} is not a list")
    return values


def whole(value: Any, least: int = -(10**MOST_DIGITS), most: int = 10**MOST_DIGITS) -> int:
    """A whole number within limits; true and false are none.

    Raises:
        CertificateError: it is none.
    """
    if type(value) is not int or not least <= value <= most:
        raise CertificateError(f"{repr(value)[:40]} is not a whole number that may stand here")
    return value


def whole_numbers(values: Any, count: int) -> list[int]:
    """A list of so many whole numbers.

    Raises:
        CertificateError: it is none.
    """
    found = listed(values)
    if len(found) != count or any(type(v) is not int for v in found):
        raise CertificateError(f"{count} whole numbers are needed")
    if any(v.bit_length() > 3 * MOST_DIGITS for v in found):
        raise CertificateError(f"a whole number has more than {3 * MOST_DIGITS} bits")
    return found


def contacts(values: Any, count: int) -> frozenset[int]:
    """A set of contacts 4 p + k of so many interfaces, given as a list.

    Raises:
        CertificateError: it is none.
    """
    return frozenset(whole(k, 0, 4 * count - 1) for k in listed(values))
