"""The greatest multiplier of statics in exact fractions: a linear programme that shares nothing with the methods.

Every number of the wall is taken as the fraction that its floating-point number is. The forces of an interface are sums
of the four extreme forces of its cone; a tableau of fractions is turned until no turn raises the multiplier.
"""

from __future__ import annotations

import math
from typing import Any

from flint import fmpq

from harness.model.assembly import Assembly

GREEDY = 300
"""Pivots of the steepest cost, after which Bland's rule takes over, which cannot cycle."""
Row = list[Any]


def fraction(value: float) -> Any:
    """The fraction that a floating-point number is."""
    numerator, denominator = float(value).as_integer_ratio()
    return fmpq(numerator, denominator)


def greatest_multiplier(wall: Assembly) -> Any:
    """The greatest multiplier from zero on as a fraction; None where the wall falls at zero; inf without end."""
    columns = _columns(wall)
    free = [int(i) for i in wall.free]
    dead = [fraction(value) for i in free for value in wall.dead[i]]
    live = [fraction(value) for i in free for value in wall.live[i]]
    programme = _Tableau([*columns, live], [-value for value in dead])
    if programme.minimise(_phase_one(programme)) != 0:
        return None
    programme.drop_artificial()
    costs = [fmpq(0)] * len(columns) + [fmpq(-1)]
    least = programme.minimise(costs)
    return math.inf if least is None else -least


def _columns(wall: Assembly) -> list[Row]:
    """Sums (fx, fy, moment) on the free blocks of the four extreme forces of every interface."""
    place = {int(i): k for k, i in enumerate(wall.free)}
    columns: list[Row] = []
    for p in range(wall.n_interfaces):
        normal = [fraction(value) for value in wall.normal[p]]
        tangent = [fraction(value) for value in wall.tangent[p]]
        mu = fraction(wall.friction[p])
        ends = [[fraction(value) for value in end[p]] for end in (wall.end1, wall.end2)]
        for end in ends:
            for sense in (1, -1):
                column = [fmpq(0)] * (3 * len(place))
                shear = [sense * mu * value for value in tangent]
                for block, sign in ((int(wall.block_b[p]), 1), (int(wall.block_a[p]), -1)):
                    if block not in place:
                        continue
                    centre = [fraction(value) for value in wall.centroid[block]]
                    row = 3 * place[block]
                    pushes = [(end, normal), *((each, [value / 2 for value in shear]) for each in ends)]
                    for point, force in pushes:
                        arm = [point[0] - centre[0], point[1] - centre[1]]
                        column[row] += sign * force[0]
                        column[row + 1] += sign * force[1]
                        column[row + 2] += sign * (arm[0] * force[1] - arm[1] * force[0])
                columns.append(column)
    return columns


class _Tableau:
    """min c.x s.t. A x = b, x >= 0, with an artificial variable in every row at first."""

    def __init__(self, columns: list[Row], right: Row) -> None:
        rows, count = len(right), len(columns)
        self.count = count
        self.rows: list[Row] = []
        for i in range(rows):
            sign = -1 if right[i] < 0 else 1
            unit = [fmpq(1 if k == i else 0) for k in range(rows)]
            self.rows.append([*(sign * columns[j][i] for j in range(count)), *unit, sign * right[i]])
        self.basis = [count + i for i in range(rows)]

    def minimise(self, costs: Row) -> Any:
        """The least cost, or None where there is no end to it."""
        width = len(self.rows[0]) - 1 if self.rows else 0
        reduced = [*costs, fmpq(0)]
        for i, j in enumerate(self.basis):
            if reduced[j] != 0:
                reduced = _minus(reduced, reduced[j], self.rows[i])
        pivots = 0
        while True:
            falling = [j for j in range(width) if reduced[j] < 0]
            if not falling:
                return -reduced[-1]
            entering = min(falling, key=lambda j: reduced[j]) if pivots < GREEDY else falling[0]
            ratios = [
                (row[-1] / row[entering], self.basis[i], i) for i, row in enumerate(self.rows) if row[entering] > 0
            ]
            if not ratios:
                return None
            leaving = min(ratios, key=lambda ratio: (ratio[0], ratio[1]))[2]
            self._turn(leaving, entering)
            reduced = _minus(reduced, reduced[entering], self.rows[leaving])
            pivots += 1

    def _turn(self, leaving: int, entering: int) -> None:
        pivot = self.rows[leaving][entering]
        self.rows[leaving] = [value / pivot if value != 0 else value for value in self.rows[leaving]]
        for i, row in enumerate(self.rows):
            if i != leaving and row[entering] != 0:
                self.rows[i] = _minus(row, row[entering], self.rows[leaving])
        self.basis[leaving] = entering

    def drop_artificial(self) -> None:
        """Leave the artificial variables, which are zero; rows that say nothing go with them."""
        for i in range(len(self.rows)):
            if self.basis[i] >= self.count:
                entering = next((j for j in range(self.count) if self.rows[i][j] != 0), None)
                if entering is not None:
                    self._turn(i, entering)
        kept = [i for i in range(len(self.rows)) if self.basis[i] < self.count]
        self.rows = [[*self.rows[i][: self.count], self.rows[i][-1]] for i in kept]
        self.basis = [self.basis[i] for i in kept]


def _phase_one(programme: _Tableau) -> Row:
    rows = len(programme.rows)
    return [fmpq(0)] * programme.count + [fmpq(1)] * rows


def _minus(row: Row, factor: Any, other: Row) -> Row:
    return [a - factor * b if b != 0 else a for a, b in zip(row, other, strict=True)]
