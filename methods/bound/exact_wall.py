"""The wall of a certificate in fractions, built from its blocks and interfaces alone."""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction
from typing import Any

Vector = list[Fraction]
Form = dict[int, Fraction]
ZERO = Fraction(0)


class CertificateError(ValueError):
    """The certificate does not show what it says."""


def fractions_of(values: Any, count: int) -> Vector:
    """A list of so many fractions.

    Raises:
        CertificateError: it is none.
    """
    if not isinstance(values, list) or len(values) != count:
        raise CertificateError(f"{count} numbers are needed")
    return [Fraction(str(value)) for value in values]


def dot(a: Vector, b: Vector) -> Fraction:
    """The inner product of two vectors."""
    return sum((x * y for x, y in zip(a, b, strict=True) if x and y), Fraction(0))


class ExactWall:
    """Strain rows (3m of 3n), loads (3n) and friction (m) from blocks and interfaces given in fractions.

    Normals keep the length of their interface: forces are then per length, the same for normal and shear.
    """

    def __init__(self, document: Any) -> None:
        blocks, interfaces = document["blocks"], document["interfaces"]
        n = len(blocks)
        centroid = [fractions_of(block["centroid"], 2) for block in blocks]
        self.dead = [x for block in blocks for x in fractions_of(block["dead"], 3)]
        self.live = [x for block in blocks for x in fractions_of(block["live"], 3)]
        self.friction = [Fraction(str(item["friction"])) for item in interfaces]
        if any(mu < 0 for mu in self.friction):
            raise CertificateError("friction is zero or more")
        self.rows: list[Vector] = []
        for item in interfaces:
            x1, y1, x2, y2 = fractions_of(item["ends"], 4)
            sign = Fraction(str(item["side"]))
            if (x1, y1) == (x2, y2) or abs(sign) != 1:
                raise CertificateError("an interface has two ends and a side of 1 or -1")
            tangent = (x2 - x1, y2 - y1)
            normal = (-sign * tangent[1], sign * tangent[0])
            for x, y, along in ((x1, y1, normal), (x2, y2, normal), ((x1 + x2) / 2, (y1 + y2) / 2, tangent)):
                row = [Fraction(0)] * (3 * n)
                for block, sense in ((item["a"], -1), (item["b"], 1)):
                    if block is None:
                        continue
                    if not 0 <= block < n:
                        raise CertificateError("an interface names a block that is not there")
                    dx, dy = x - centroid[block][0], y - centroid[block][1]
                    turning = dx * along[1] - dy * along[0]
                    for k, value in enumerate((along[0], along[1], turning)):
                        row[3 * block + k] += sense * value
                self.rows.append(row)
        self.n_interfaces = len(interfaces)
        self.sparse = [[(k, value) for k, value in enumerate(row) if value] for row in self.rows]

    def resultant(self, forces: Vector) -> Vector:
        """C' r of forces (3m,)."""
        total = [Fraction(0)] * len(self.dead)
        for row, force in zip(self.sparse, forces, strict=True):
            if force:
                for k, value in row:
                    total[k] += value * force
        return total


def integers(forms: list[Form]) -> tuple[list[dict[int, int]], int]:
    """Forms times their common denominator, and that denominator."""
    unit = math.lcm(*(value.denominator for form in forms for value in form.values()))
    return [{k: int(value * unit) for k, value in form.items() if value} for form in forms], unit


def paired(first: Iterable[Any], second: Any) -> list[tuple[Any, Any]]:
    """Pairs of two lists of the same length.

    Raises:
        CertificateError: they are not.
    """
    first = list(first)
    if not isinstance(second, list) or len(first) != len(second):
        raise CertificateError(f"{len(first)} entries are needed")
    return list(zip(first, second, strict=True))


def whole(value: Any, least: int, most: int | None = None) -> int:
    """A whole number within limits.

    Raises:
        CertificateError: it is none.
    """
    if type(value) is not int or value < least or (most is not None and value > most):
        raise CertificateError(f"{value!r} is not a whole number from {least} on")
    return value


def whole_numbers(values: Any, count: int) -> list[int]:
    """A list of so many whole numbers.

    Raises:
        CertificateError: it is none.
    """
    if not isinstance(values, list) or len(values) != count or any(type(v) is not int for v in values):
        raise CertificateError(f"{count} whole numbers are needed")
    return values
