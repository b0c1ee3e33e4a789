"""Check in integers of one window of a certificate: no collapse state lies between its lower end and what it proves.

A window holds dual multipliers in binary fractions. The bilinear identity between them and the cost is evaluated
exactly; what is left of it, since the multipliers are rounded, is paid with bounds of the forces and of the mechanism
that the window proves too. Only the standard library is used. docs/theory-bound.md holds the proofs.

What each statement of a window stands for:

- low, high: the multipliers of the states that are spoken of, 0 <= lambda - low <= high - low.
- forces: virtual work with the virtual velocities given (`force_limits.Forces`).
- still, loaded: a slack or normal force that is positive in all states, by the same; a slack above zero leaves no rate.
- weights: definition of the size of a mechanism; any above zero will do.
- motions: velocities are a matrix times strains, with a remainder that is paid (`window_limits.Motions`); courses:
  friction work is at most the lift.
- size, multiplier: the bilinear identity of products, each of which is at least zero (or zero: complementarity), with
  everything that is negative or left over paid by the bounds above. No sign, multiple or remainder is taken on trust.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

from methods.proof.verify.exact_wall import (
    ZERO,
    CertificateError,
    ExactWall,
    Form,
    Vector,
    integers,
    listed,
    number,
    paired,
    whole,
    whole_numbers,
)
from methods.proof.verify.force_limits import Forces, KnownLimits, known_of
from methods.proof.verify.window_limits import Columns, Motions, Reach


class WindowLimits:
    """What a window says of forces and mechanisms, checked, and what multipliers of products then prove.

    Attributes:
        forces, columns, motions: its limits.
    """

    def __init__(self, wall: ExactWall, document: Any, case: tuple[Forces, KnownLimits, Vector] | None = None) -> None:
        """A window of all states.

        Args:
            wall: of the certificate.
            document: of the window.
            case: bounds of forces, what is known of contacts and greatest velocities, where states of a case only are
                considered; a window of all states proves these itself.
        """
        if case is None:
            low, high = number(document["low"]), number(document["high"])
            if not low < high:
                raise CertificateError("a window has no width")
            self.forces = Forces(wall, low, high, document["forces"])
            self.columns = Columns(self.forces, known_of(self.forces, document), document)
            self.motions: Motions | Reach = Motions(self.columns, document["motions"])
        else:
            self.forces, known, reach = case
            self.columns = Columns(self.forces, known, document)
            self.motions = Reach(self.columns, reach)

    def greatest_size(self, document: Any) -> Fraction:
        """The size that no mechanism exceeds, by these multipliers of products.

        Raises:
            CertificateError: they bound none.
        """
        size = _Products(self.columns, self.motions, document, True)
        if size.price >= 1:
            raise CertificateError("a window does not bound its mechanisms")
        return max(ZERO, (size.lost - size.value) / (1 - size.price))

    def bound(self, document: Any, greatest: Fraction) -> Fraction:
        """The multiplier below which there is none in the window, by these multipliers of products.

        Args:
            document: the multipliers of products.
            greatest: size that no mechanism exceeds.
        """
        gain = _Products(self.columns, self.motions, document, False)
        return min(self.forces.high, self.forces.low + gain.value - gain.lost - gain.price * greatest)


class _Products:
    """What the multipliers of products prove: cost >= value - lost - price * size of the mechanism.

    Attributes:
        value, lost, price: numbers of the inequality.
    """

    value: Fraction
    lost: Fraction
    price: Fraction

    def __init__(self, columns: Columns, motions: Motions | Reach, document: Any, of_size: bool) -> None:
        self.columns, self.wall, self.forces = columns, columns.wall, columns.forces
        self.tight = sorted(self.forces.tight)
        m = self.wall.n_interfaces
        self.unit = 2 ** whole(document["exponent"], 0, 400)
        names = [*columns.rates, "work", "lift"]
        self.limits = self.forces.limits()
        rows = 4 * m + 3 + len(self.limits)
        multipliers = dict(paired(names, [whole_numbers(c, rows) for c in listed(document["columns"])]))
        signed = [whole_numbers(three, 3) for three in listed(document["signed"])]
        still = [whole_numbers(form, 3 * m + 2) for form in listed(document["still"])]
        balance = [whole_numbers(row, columns.n + len(self.tight)) for row in listed(document["balance"])]
        self.value = Fraction(multipliers["work"][4 * m], self.unit)
        self._pay(multipliers, signed, still)
        left = self._left(multipliers, signed, still, of_size)
        rounding = self._paid_for_rounding(left, balance, motions)
        if motions.of_size:
            self.price += rounding
        else:
            self.lost += rounding

    def _rows(self) -> list[Form]:
        """The static inequalities as forms of the forces, the multiplier and one."""
        m, low, high = self.wall.n_interfaces, self.forces.low, self.forces.high
        one = Fraction(1)
        rows: list[Form] = []
        for p, mu in enumerate(self.wall.friction):
            a, b, s = 3 * p, 3 * p + 1, 3 * p + 2
            rows += [{a: one}, {b: one}, {a: mu, b: mu, s: one}, {a: mu, b: mu, s: -one}]
        load, unit = 3 * m, 3 * m + 1
        within: list[Form] = [
            {3 * p: side * one, 3 * p + 1: side * one, unit: -side * limit} for p, side, limit in self.limits
        ]
        return [*rows, {unit: one}, {load: one, unit: -low}, {load: -one, unit: high}, *within]

    def _pay(self, multipliers: dict[Any, list[int]], signed: list[list[int]], still: list[list[int]]) -> None:
        """Lost and price for negative multipliers: each product is at most the greatest slack times the column."""
        m, width = self.wall.n_interfaces, self.forces.high - self.forces.low
        limit = []
        for mu, normal in zip(self.wall.friction, self.forces.normal, strict=True):
            limit += [normal, normal, 2 * mu * normal, 2 * mu * normal]
        limit += [Fraction(1), width, width]
        limit += [max(ZERO, self.forces.normal[p] - v) if side > 0 else v for p, side, v in self.limits]
        for k in self.tight:
            limit[k] = ZERO
        whole_limit, grain = _not_below(limit)
        loss: dict[Any, Fraction] = {}
        for name, column in multipliers.items():
            free = name if isinstance(name, int) else 4 * m if name == "work" else -1
            parts = [-v * whole_limit[j] for j, v in enumerate(column) if v < 0 and j != free]
            loss[name] = Fraction(sum(parts), self.unit * grain)
        worst = ZERO
        for p, (first, second, shear) in paired(self.columns.signed, signed):
            mu = self.wall.friction[p]
            rays = self.forces.rays[p]
            violated = max((mu * shear + side * (second if end else first) for end, side in rays), default=ZERO)
            violated = max(ZERO, violated)
            if violated and not mu:
                raise CertificateError("a slip without friction has no bound")
            worst = max(worst, Fraction(violated) / mu if mu else ZERO)
        columns = self.columns
        self.lost = loss["work"] + self._paid_for_slow(still)
        lift = (loss["lift"] + worst / self.unit) / columns.lift_weight
        self.price = max([lift, *(loss[k] / columns.weights[k] for k in columns.rates)])

    def _left(
        self, multipliers: dict[Any, list[int]], signed: list[list[int]], still: list[list[int]], of_size: bool
    ) -> tuple[list[list[int]], int]:
        """Cost minus all products, by velocity, as integers over the denominator that comes with them."""
        columns, wall, m = self.columns, self.wall, self.wall.n_interfaces
        rows, row_unit = integers(self._rows())
        slips = [dict(wall.sparse[3 * p + 2]) for p in columns.signed]
        forms = [*columns.rates.values(), columns.work, columns.lift, *slips, *(form for form, _ in columns.still)]
        kinematic, unit = integers(forms)
        statics = [self._combined(column, rows) for column in multipliers.values()]
        for k, value in self._cost(of_size).items():
            place = list(multipliers).index(k)
            scaled = value * self.unit
            if scaled.denominator != 1:
                raise CertificateError("the exponent is too small for the weights")
            row = rows[4 * m] if of_size else rows[4 * m + 1]
            for i, entry in row.items():
                statics[place][i] -= int(scaled) * entry
        for p, three in paired(columns.signed, signed):
            own = [0] * (3 * m + 2)
            own[3 * p : 3 * p + 3] = [row_unit * v for v in three]
            statics.append(own)
        statics += [[row_unit * v for v in form] for form in still]
        left = [[0] * (3 * m + 2) for _ in range(columns.width)]
        for form, static in paired(kinematic, statics):
            for d, value in form.items():
                left[d] = [a - value * b for a, b in zip(left[d], static, strict=True)]
        return left, row_unit * unit

    def _cost(self, of_size: bool) -> dict[Any, Fraction]:
        if not of_size:
            return {"work": Fraction(1)}
        columns = self.columns
        return {k: -weight for k, weight in columns.weights.items()} | {"lift": -columns.lift_weight}

    def _combined(self, column: list[int], rows: list[dict[int, int]]) -> list[int]:
        self.wall.in_time()
        total = [0] * (3 * self.wall.n_interfaces + 2)
        for value, row in zip(column, rows, strict=True):
            if value:
                for i, entry in row.items():
                    total[i] += value * entry
        return total

    def _sizes(self) -> list[Fraction]:
        """The greatest forces, multiplier and one."""
        sizes = []
        for mu, normal in zip(self.wall.friction, self.forces.normal, strict=True):
            sizes += [normal, normal, mu * normal]
        return [*sizes, max(abs(self.forces.low), abs(self.forces.high)), Fraction(1)]

    def _paid_for_slow(self, still: list[list[int]]) -> Fraction:
        """The greatest sum of static forms times rates that are next to nothing."""
        paid: Fraction = ZERO
        for form, (_, most) in paired(still, self.columns.still):
            if most:
                paid += most * sum((abs(v) * size for v, size in zip(form, self._sizes(), strict=True)), ZERO)
        return paid / Fraction(self.unit)

    def _paid_for_rounding(
        self, left: tuple[list[list[int]], int], balance: list[list[int]], motions: Motions | Reach
    ) -> Fraction:
        """Greatest value of what is left, after multiples of equations of statics, for mechanisms within limits."""
        wall, m, n = self.wall, self.wall.n_interfaces, self.columns.n
        loads = [dict(enumerate(wall.live)), dict(enumerate(wall.dead))]
        equations = [*(dict(wall.sparse[k]) for k in range(3 * m)), *loads]
        slacks = self._rows()
        for j, k in enumerate(self.tight):
            for i, value in slacks[k].items():
                equations[i][n + j] = value
        rows, unit = integers(equations)
        whole_sizes, grain = _not_below(self._sizes())
        matrix, left_unit = left
        price: Fraction = ZERO
        for (static, multiples), limit in paired(paired(matrix, balance), motions.limits):
            self.wall.in_time()
            rest = 0
            for value, row, size in zip(static, rows, whole_sizes, strict=True):
                vanishing = sum(entry * multiples[d] for d, entry in row.items())
                rest += abs(value * unit - vanishing * left_unit) * size
            price += rest * limit
        return price / Fraction(self.unit * left_unit * unit * grain)


def _not_below(values: list[Fraction]) -> tuple[list[int], int]:
    """Whole numbers no less than the values times a unit, and that unit: their sums are quicker than of fractions."""
    unit = 2**20
    return [math.ceil(value * unit) for value in values], unit
