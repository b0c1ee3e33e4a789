"""Reflected Douglas-Rachford splitting, anchored (Halpern) and restarted, on the products of a window.

Source of the anchoring and restarts: Chen, Sun, Yuan, Zhang and Zhao (2024), HPR-LP, section 3.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.bound.dual import DualBound, dual_bound
from methods.bound.relaxation import Relaxation
from methods.bound.tuning import RESTARTS


@dataclass
class Splitting:
    """The state of the splitting on one relaxation and one cost, which can be run on."""

    relaxation: Relaxation
    cost: FloatArray
    step: float
    least_step: float
    iterate: FloatArray = field(default_factory=lambda: np.zeros(0))
    iterations: int = 0

    def run(self, until: float, stop: Callable[[DualBound | None, float], bool]) -> None:
        """Iterate to this CPU time, or until `stop(bound, primal cost)` says so at a check."""
        problem = self.relaxation
        where = np.nonzero(self.cost)
        slope = self.cost[where]
        iterate = self.iterate if self.iterate.size else np.zeros(problem.lower.shape)
        anchor, count, first, before = iterate.copy(), 0, 0.0, np.inf
        start_point = start_dual = iterate
        check = self.iterations + RESTARTS.checked_every
        while True:
            projected = problem.project(iterate)
            reflected = 2.0 * projected - iterate
            reflected[where] -= self.step * slope
            np.clip(reflected, problem.lower, problem.upper, out=reflected)
            gap = reflected - projected
            residual = float(np.linalg.norm(gap))
            if count == 0:
                first, start_point, start_dual = residual, projected, (projected - iterate) / self.step
            self.iterations += 1
            weight = 1.0 / (count + 2)
            iterate = (1.0 - weight) * (iterate + 2.0 * gap) + weight * anchor
            count += 1
            if self.iterations >= check:
                self.iterate = iterate
                check = self.iterations + max(RESTARTS.checked_every, int(RESTARTS.checked_later * self.iterations))
                bound = dual_bound(problem, iterate, self.step, self.cost)
                if stop(bound, float((reflected[where] * slope).sum())) or time.process_time() > until:
                    return
            stale = residual <= RESTARTS.necessary * first and residual > before
            long = count > RESTARTS.long * self.iterations + RESTARTS.patience
            if count > 1 and (residual <= RESTARTS.sufficient * first or stale or long):
                iterate = self._restarted(iterate, start_point, start_dual)
                anchor, count = iterate.copy(), 0
            before = residual

    def _restarted(self, iterate: FloatArray, point: FloatArray, dual: FloatArray) -> FloatArray:
        """The iterate for a new step size, from how far the two parts moved since the last restart."""
        here = self.relaxation.project(iterate)
        own = (here - iterate) / self.step
        moved, turned = float(np.linalg.norm(here - point)), float(np.linalg.norm(own - dual))
        if min(moved, turned) > 1e-14:
            self.step = min(max(float(np.sqrt(moved / turned * self.step)), self.least_step), 1e6)
        return np.asarray(here - self.step * own)


def carried_over(new: Relaxation, old: Relaxation, iterate: FloatArray, step: float) -> FloatArray:
    """The iterate of one window in the coordinates of the next."""
    m, n = new.equations.n_interfaces, len(new.equations.dead)
    point = old.project(iterate)
    inner = old.row_basis.T @ point @ old.column_basis
    weights = np.linalg.lstsq(old.row_factor, inner, rcond=None)[0]
    weights = np.linalg.lstsq(old.column_factor, weights.T, rcond=None)[0].T
    physical = old.statics @ weights @ old.motions[:n].T
    inside = new.statics.T @ physical @ np.linalg.pinv(new.motions[:n]).T
    point_now = new.rows @ inside @ new.columns.T * new.row_scale[:, None] * new.column_scale
    every = np.zeros((6 * m + 3, 5 * m + 2))
    every[np.ix_(*_places(old))] = (old.project(iterate) - iterate) / step * old.row_scale[:, None] * old.column_scale
    every[4 * m] += (new.low - old.low) * every[4 * m + 1] - (new.high - old.high) * every[4 * m + 2]
    dual = every[np.ix_(*_places(new))] / new.row_scale[:, None] / new.column_scale
    return np.asarray(point_now - step * (dual - new.project(dual)))


def _places(relaxation: Relaxation) -> tuple[IntArray, IntArray]:
    """Rows and columns of a relaxation within one that has a row and a column for everything."""
    m, q = relaxation.equations.n_interfaces, relaxation.unloadable
    rows = np.concatenate([np.arange(4 * m + 3), 4 * m + 3 + q, 5 * m + 3 + q])
    return rows, np.concatenate([relaxation.free, [4 * m, 4 * m + 1], 4 * m + 2 + q])
