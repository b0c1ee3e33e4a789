"""Where the states of a window that has no more to give are divided: at a normal force, or at a contact."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray
from methods.proof.search.halpern import Splitting
from methods.proof.search.options import NARROW
from methods.proof.search.relaxation import Relaxation
from methods.proof.search.subproblem import AtContact, AtNormalForce, Division

_INSIDE = 0.1
"""Part of the range of a normal force that either half of a division has at least, so that none is divided next to the
end of its range."""


def division_of(run: Splitting, vain: Division | None = None) -> Division | None:
    """The division of a window's states that its present iterate violates most; None if all contacts are decided.

    A half cuts off columns of the products. It is measured by their rates, each times the share of the range of a force
    by which the column lies beyond; the half that cuts off less counts.

    Args:
        run: on the products of the window.
        vain: a division whose half these states are, where it gained nothing: the next is then of the other kind.
    """
    relaxation = run.relaxation
    products = np.zeros(relaxation.lower.shape)
    if run.iterate.size:
        products = relaxation.project(run.iterate) / relaxation.row_scale[:, None] / relaxation.column_scale
    contact, by_contact = _at_contact(relaxation, products)
    normal, by_normal = _at_normal_force(relaxation, products)
    if isinstance(vain, AtNormalForce) or contact is None:
        return contact
    narrow = relaxation.high - relaxation.low < NARROW * relaxation.high
    return normal if isinstance(vain, AtContact) or (by_normal > max(by_contact, 0.0) and not narrow) else contact


def _at_normal_force(relaxation: Relaxation, products: FloatArray) -> tuple[Division, float]:
    """The interface and the normal force on both sides of which columns lie farthest, and what is cut off.

    A column of the products over its rate is a state of forces of its own; those of a single state are the same in all
    columns. Forces are chosen by the root of their range: wide ranges that columns disagree on say more than narrow
    ones, and less than they are wide.
    """
    slacks = products[: 4 * relaxation.equations.n_interfaces, : relaxation.work_column]
    rates = np.maximum(products[relaxation.unit_row, : relaxation.work_column], 0.0)
    normals = slacks[0::4] + slacks[1::4]
    least, greatest = relaxation.bounds.normal_least, relaxation.bounds.normal_greatest
    options = relaxation.options
    width = np.maximum(greatest - least, options.rounding.margin)
    inside = _INSIDE * width
    middle = np.clip(
        _balanced(normals, rates, least, greatest, options.rounding.halvings), least + inside, greatest - inside
    )
    apart = normals - middle[:, None] * rates
    beyond = np.minimum(np.maximum(apart, 0.0).sum(axis=1), np.maximum(-apart, 0.0).sum(axis=1))
    p = int((beyond / np.sqrt(width)).argmax())
    return AtNormalForce(p, float(middle[p])), float(beyond[p] / width[p])


def _balanced(
    normals: FloatArray, rates: FloatArray, least: FloatArray, greatest: FloatArray, halvings: int
) -> FloatArray:
    """(m,) normal forces between limits beyond which columns (m, f) lie as much to the one side as to the other.

    Args:
        normals: (m, f) normal forces times rates; rates: (f,); least, greatest: (m,) limits.
    """
    below, above = least.copy(), greatest.copy()
    for _ in range(halvings):
        middle = 0.5 * (below + above)
        apart = normals - middle[:, None] * rates
        more = np.maximum(apart, 0.0).sum(axis=1) > np.maximum(-apart, 0.0).sum(axis=1)
        below, above = np.where(more, middle, below), np.where(more, above, middle)
    return np.asarray(0.5 * (below + above))


def _at_contact(relaxation: Relaxation, products: FloatArray) -> tuple[Division | None, float]:
    """The contact whose slack and rate are both large, and what is cut off; None if all are decided."""
    m, f, margin = relaxation.equations.n_interfaces, len(relaxation.free), relaxation.options.rounding.margin
    greatest, rate = relaxation.bounds.greatest, np.zeros(4 * m)
    slack = products[: 4 * m, :f].sum(axis=1) / np.maximum(greatest, margin)
    slip = products[relaxation.unit_row, relaxation.lift_column + 1 :]
    rate[relaxation.free] = products[relaxation.unit_row, :f]
    rate[4 * relaxation.unloadable + 2], rate[4 * relaxation.unloadable + 3] = slip, -slip
    decided = (relaxation.bounds.least > margin) | (greatest <= margin)
    decided[list(relaxation.case.tight | relaxation.case.still)] = True
    part = np.where(decided, -np.inf, np.minimum(slack, rate))
    contact = int(part.argmax())
    return (None, -np.inf) if decided.all() else (AtContact(contact), float(part[contact]))
