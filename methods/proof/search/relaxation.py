"""The relaxation of one window of multipliers: products of static with kinematic inequalities.

A row of A is an inequality of statics (homogenised by s = 1), a row of B one of kinematics. In a collapse state every
product of the two is at least zero, and y_k g_k = 0. The matrix of products is T = A Z B'; with Z free this is the
first-level reformulation-linearisation of Sherali and Adams (1990). The slip of an interface that the window may
unload is one signed column, multiplied with slacks of its own interface only (facial reduction): without that the dual
has no interior. docs/theory-bound.md holds the proofs.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy.linalg

from harness.model.assembly import FloatArray, IntArray
from methods.proof.search.equations import Equations
from methods.proof.search.slack_bounds import SlackBounds
from methods.proof.search.subproblem import Subproblem


class Relaxation:
    """Spaces, inequalities and bounds of the products of one window.

    m = interfaces, f = openings and slips that may move (`free`), q = interfaces that may be unloaded.
    Rows: 4m slacks, s, multiplier - low s, high s - multiplier, one per limit of a normal force of the case, and two
    local rows per unloadable interface.
    Columns: f rates, live work b, the lift, and q signed slips.

    Attributes:
        rows, columns: (a, .) and (c, .) matrices A and B over orthonormal bases of statics and mechanisms.
        lower, upper: (a, c) bounds of the scaled products; -inf and inf where a product is not used.
        row_scale, column_scale: (a,), (c,) factors that make rows of A and B unit vectors.
        n_rows: rows that are not local.
        options: of the search.
        free: (f,) contacts; unloadable: (q,) interfaces that slip either way; normal: (m,) least normal forces.
        weights: (m + 1,) of the rates of each interface, and of the lift, in the size of a mechanism.
    """

    def __init__(
        self,
        equations: Equations,
        low: float,
        high: float,
        bounds: SlackBounds,
        case: Subproblem = Subproblem(),
        weights: FloatArray | None = None,
    ) -> None:
        self.options = equations.options
        self.equations, self.low, self.high, self.bounds, self.case = equations, low, high, bounds, case
        m = equations.n_interfaces
        self.weights = np.ones(m + 1) if weights is None else weights
        margin = self.options.rounding.margin
        positive = bounds.least > margin
        self.normal = bounds.normal_least
        loaded = (self.normal > margin) | positive.reshape(-1, 4)[:, 2:].any(axis=1)
        self.loaded: IntArray = np.flatnonzero(loaded)
        held = np.zeros(4 * m, dtype=bool)
        held[list(case.still)] = True
        may = ~(positive | held).reshape(-1, 4)
        self.unloadable: IntArray = np.flatnonzero(~loaded & may[:, 2:].all(axis=1))
        may[self.unloadable, 2:] = False
        self.free: IntArray = np.flatnonzero(may.ravel())
        self.limits = case.limits()
        self.unit_row, self.multiplier_row, self.n_rows = 4 * m, 4 * m + 1, 4 * m + 3 + len(self.limits)
        self.work_column, self.lift_column = len(self.free), len(self.free) + 1
        self.rows, self.columns = self._static_rows(), self._kinematic_columns()
        self.row_scale, self.column_scale = (_scales(part, self._tolerance) for part in (self.rows, self.columns))
        self.row_basis, self.row_factor = np.linalg.qr(self.rows * self.row_scale[:, None])
        self.column_basis, self.column_factor = np.linalg.qr(self.columns * self.column_scale[:, None])
        self.unit = float(self.row_scale[self.unit_row] * self.column_scale[self.work_column])
        self.lower, self.upper = self._product_bounds()
        self.unused = np.isneginf(self.lower) & np.isposinf(self.upper)
        within = [bounds.normal_greatest[p] - v if side > 0 else v for p, side, v in self.limits]
        self.row_limit = np.concatenate([bounds.greatest, [1.0, high - low, high - low], within])

    def _static_rows(self) -> FloatArray:
        equations, m, q = self.equations, self.equations.n_interfaces, self.unloadable
        balance = np.hstack([equations.kinematic.T.toarray(), equations.live[:, None], equations.dead[:, None]])
        tight = equations.slack[sorted(self.case.tight)]
        self.statics = scipy.linalg.null_space(np.vstack([balance, np.pad(tight, ((0, 0), (0, 2)))]))
        forces, multiplier, unit = self.statics[: 3 * m], self.statics[3 * m], self.statics[3 * m + 1]
        window = [unit, multiplier - self.low * unit, self.high * unit - multiplier]
        window += [side * (forces[3 * p] + forces[3 * p + 1] - limit * unit) for p, side, limit in self.limits]
        difference = equations.friction[q, None] * (forces[3 * q] - forces[3 * q + 1])
        shear = forces[3 * q + 2]
        return np.vstack([equations.slack @ forces, *window, difference - shear, -difference - shear])

    def _kinematic_columns(self) -> FloatArray:
        equations, m, q = self.equations, self.equations.n_interfaces, self.unloadable
        slips = np.zeros((3 * m, len(q)))
        slips[3 * q + 2, np.arange(len(q))] = 1.0
        strains = [equations.kinematic.toarray(), -equations.flow[:, self.free], -slips]
        self.motions = scipy.linalg.null_space(np.hstack(strains))
        velocities, rest = np.split(self.motions, [len(equations.dead)])
        rates, signed = np.split(rest, [len(self.free)])
        work = equations.live @ velocities / equations.n_blocks
        dead = equations.dead @ velocities / equations.n_blocks
        lift = self.high * work + dead - self.friction_work() @ rates
        return np.vstack([rates, work, lift, signed])

    def friction_work(self) -> FloatArray:
        """(f,) least friction work of unit rates, over the live work n: mu N_min / n of slips, zero of openings."""
        interface = self.free // 4
        strength = self.equations.law.by_friction(self.normal)[interface] / self.equations.n_blocks
        return np.where(self.free % 4 >= 2, strength, 0.0)

    def _product_bounds(self) -> tuple[FloatArray, FloatArray]:
        q, f = self.unloadable, len(self.free)
        lower = np.zeros((len(self.rows), len(self.columns)))
        upper = np.full(lower.shape, np.inf)
        upper[self.free, np.arange(f)] = 0.0
        lower[self.n_rows :] = -np.inf
        lower[:, f + 2 :] = -np.inf
        column = f + 2 + np.arange(len(q))
        upper[4 * q + 2, column] = 0.0
        lower[4 * q + 3, column] = 0.0
        for first in (0, len(q)):
            lower[self.n_rows + first + np.arange(len(q)), column] = 0.0
        lower[self.unit_row, self.work_column] = upper[self.unit_row, self.work_column] = self.unit
        return lower, upper

    @property
    def _tolerance(self) -> float:
        return self.options.rounding.tolerance

    @cached_property
    def row_inverse(self) -> FloatArray:
        """Pseudo-inverse of the part of the basis of A that multiplies rates, work and lift."""
        return np.linalg.pinv(self.row_basis[: self.n_rows])

    @cached_property
    def column_inverse(self) -> FloatArray:
        """Pseudo-inverse of the part of the basis of B of rates, work and lift."""
        return np.linalg.pinv(self.column_basis[: self.lift_column + 1], rcond=self._tolerance)

    @cached_property
    def alone(self) -> FloatArray:
        """Directions of the basis of B in which signed slips move alone."""
        return scipy.linalg.null_space(self.column_basis[: self.lift_column + 1], rcond=self._tolerance)

    @cached_property
    def own(self) -> tuple[IntArray, IntArray]:
        """Rows and columns of the products of signed slips with their own interface."""
        rows, columns = np.nonzero(~self.unused[:, self.lift_column + 1 :])
        return rows, columns + self.lift_column + 1

    @cached_property
    def own_inverse(self) -> FloatArray:
        """What of `own` has a part in `alone` by least change."""
        rows, columns = self.own
        image = np.einsum("ka,ke->aek", self.row_basis[rows], self.column_basis[columns] @ self.alone)
        return np.linalg.pinv(image.reshape(-1, len(rows)), rcond=self._tolerance)

    def project(self, products: FloatArray) -> FloatArray:
        """The nearest matrix of the form A Z B'."""
        inner = self.row_basis.T @ products @ self.column_basis
        return np.asarray(self.row_basis @ inner @ self.column_basis.T)

    def multiplier_cost(self) -> FloatArray:
        """Cost of (multiplier - low) b, which is multiplier - low for b = 1."""
        cost = np.zeros(self.lower.shape)
        row, column = self.multiplier_row, self.work_column
        cost[row, column] = 1.0 / (self.row_scale[row] * self.column_scale[column])
        return cost

    def size_cost(self) -> FloatArray:
        """Cost of minus the size of a mechanism, G = weighted sum of free rates and lift."""
        cost = np.zeros(self.lower.shape)
        columns = np.append(np.arange(len(self.free)), self.lift_column)
        weights = np.append(self.weights[self.free // 4], self.weights[-1])
        cost[self.unit_row, columns] = -weights / (self.row_scale[self.unit_row] * self.column_scale[columns])
        return cost


def _scales(matrix: FloatArray, tolerance: float) -> FloatArray:
    norms = np.linalg.norm(matrix, axis=1)
    return np.where(norms < tolerance, 1.0, 1.0 / np.maximum(norms, tolerance))
