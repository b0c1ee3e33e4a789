"""A bound that holds at any iterate: what a dual matrix proves, whatever the solver left undone."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from harness.model.assembly import FloatArray
from methods.proof.search.relaxation import Relaxation


@dataclass(frozen=True)
class DualBound:
    """cost >= value - constant - per_size * G for every collapse state of the window, G the size of its mechanism.

    Attributes:
        prices: (m,) greatest price of a rate of each interface; lift_price: of the lift.
        products: multipliers of the unscaled products, as `Relaxation` orders them.
    """

    value: float
    constant: float
    per_size: float
    products: FloatArray = field(repr=False)
    prices: FloatArray = field(repr=False)
    lift_price: float

    def of(self, size: float) -> float:
        """The least cost of collapse states whose mechanism is of this size or smaller."""
        return self.value - self.constant - (self.per_size * size if self.per_size > 0.0 else 0.0)

    def greatest_size(self) -> float:
        """The greatest G, where the cost is -G; inf if this dual proves none."""
        return (self.constant - self.value) / (1.0 - self.per_size) if self.per_size < 0.9 else np.inf


def dual_bound(relaxation: Relaxation, iterate: FloatArray, step: float, cost: FloatArray) -> DualBound | None:
    """What the dual matrix of an iterate of the splitting proves; None where it uses products it must not use.

    Negative reduced costs are paid with the greatest slack in the window times the greatest size of the mechanism.
    """
    matrix = _repaired(relaxation, (relaxation.project(iterate) - iterate) / step)
    left = float(abs(relaxation.row_basis.T @ matrix @ relaxation.column_basis).max())
    reduced = cost - matrix
    if left > relaxation.options.rounding.tolerance * max(1.0, float(abs(reduced).max())):
        return None
    f, columns = len(relaxation.free), relaxation.lift_column + 1
    value = float(reduced[relaxation.unit_row, relaxation.work_column] * relaxation.unit)
    true = reduced * relaxation.row_scale[:, None] * relaxation.column_scale
    paid = np.maximum(-true[: relaxation.n_rows, :columns], 0.0)
    paid[relaxation.free, np.arange(f)] = 0.0
    paid[relaxation.unit_row, relaxation.work_column] = 0.0
    limit = np.where(paid > 0.0, relaxation.row_limit[:, None], 0.0)
    price = (limit * paid).sum(axis=0)
    weights, lift_weight = relaxation.weights[relaxation.free // 4], relaxation.weights[-1]
    lift_price = float(price[-1])
    per_size = max(float((price[:f] / weights).max(initial=0.0)), lift_price / float(lift_weight))
    per_size += _paid_for_signed_slips(relaxation, true)
    prices = np.zeros(relaxation.equations.n_interfaces)
    np.maximum.at(prices, relaxation.free // 4, price[:f])
    return DualBound(value, float(price[f]), per_size, true, prices, lift_price)


def _paid_for_signed_slips(relaxation: Relaxation, true: FloatArray) -> float:
    """Price per size of the mechanism of slips of unloadable interfaces, whose friction work the lift bounds."""
    q = relaxation.unloadable
    if not len(q):
        return 0.0
    equations = relaxation.equations
    column = relaxation.lift_column + 1 + np.arange(len(q))
    local = relaxation.n_rows + np.arange(len(q))
    minus, plus = -true[4 * q + 2, column], true[4 * q + 3, column]
    first, second = true[local, column], true[local + len(q), column]
    worst = max(0.0, -float(np.min([plus + first, plus + second, minus + second, minus + first])))
    strength = relaxation.friction_work() / relaxation.weights[relaxation.free // 4]
    most = 1.0 / float(relaxation.weights[-1]) + float(strength.max(initial=0.0))
    return 2.0 * worst * equations.n_blocks * most


def _repaired(relaxation: Relaxation, matrix: FloatArray) -> FloatArray:
    """The matrix made zero on unused products, and orthogonal to all A Z B' by the least change of free ones.

    What rates, work and lift cannot take is first taken by the products of signed slips with their own interface.
    """
    matrix = np.where(relaxation.unused, 0.0, matrix)
    for _ in range(relaxation.options.rounding.repairs):
        if relaxation.alone.shape[1]:
            rest = relaxation.row_basis.T @ matrix @ relaxation.column_basis @ relaxation.alone
            matrix[relaxation.own] -= relaxation.own_inverse @ rest.ravel()
        rest = relaxation.row_basis.T @ matrix @ relaxation.column_basis
        rows, columns = relaxation.n_rows, relaxation.lift_column + 1
        matrix[:rows, :columns] -= relaxation.row_inverse.T @ rest @ relaxation.column_inverse
    return matrix
