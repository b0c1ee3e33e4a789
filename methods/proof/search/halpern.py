"""Reflected Douglas-Rachford splitting, anchored (Halpern) and restarted, on the products of a window.

Source of the anchoring and restarts: Chen, Sun, Yuan, Zhang and Zhao (2024), HPR-LP, section 3. The step balances what
the safe bound loses to the dual with the distance of primal and dual cost, and the movements of both parts as the
weight of Applegate et al. (2021), PDLP, section 3.3, does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from harness.model.assembly import FloatArray, IntArray
from methods.proof.search.dual import DualBound, dual_bound
from methods.proof.search.relaxation import Relaxation

_CHECKED_EVERY = 200
"""Iterations between two safe bounds, each of which may cost hundreds of iterations."""
_CHECKED_LATER = 0.1
"""The same as a share of those made."""
_SUFFICIENT = 0.2
"""A restart where the residual fell to this share of that at the last."""
_NECESSARY = 0.8
"""A restart where it fell to this share and rises."""
_LONG = 0.36
"""A restart where the round is longer than this share of the run."""
_PATIENCE = 200
"""Iterations that such a round has at least."""
_STEP_CHANGE = 2.0
"""Factor by which a check changes the step at most."""
_STEP_KEPT = 1.2
"""Factor below which a check leaves the step. A larger change may let the step diverge."""
_TINY = 1e-9
"""Losses and distances below this, relative and absolute, are rounding."""
_ROUNDING = 16.0
"""Units of rounding of the iterate's norm below which a residual in single precision says nothing more."""

_Products = npt.NDArray[np.floating[Any]]
"""(a, c) products of a relaxation in the precision of a sweep."""


@dataclass
class Splitting:
    """The state of the splitting on one relaxation and one cost, which can be run on.

    Attributes:
        step: step size of the primal part, which every check balances; steps: the least and the greatest.
        size: of mechanisms, for which the bound is to be good; None for that of the dual itself.
        iterate: (a, c) what it stands at, empty at first; iterations: made so far.
        single: whether it sweeps in single precision, as long as that can tell the residual from rounding.
    """

    relaxation: Relaxation
    cost: FloatArray
    step: float
    steps: tuple[float, float] = (0.0, np.inf)
    size: float | None = None
    iterate: FloatArray = field(default_factory=lambda: np.zeros(0))
    iterations: int = 0
    single: bool = True
    _checked: tuple[FloatArray, FloatArray] | None = field(default=None, repr=False)

    def run(self, until: float, stop: Callable[[DualBound | None, float], bool]) -> None:
        """Iterate to this time, or until `stop(bound, primal cost)` says so at a check. Raises OutOfTime."""
        iterates, clock = self._iterates(), self.relaxation.options.clock
        check = self.iterations + _CHECKED_EVERY
        first, before = 0.0, np.inf
        while True:
            self.relaxation.equations.deadline.ask()
            residual = iterates.advance(self.step)
            self.iterations += 1
            first = residual if iterates.count == 1 else first
            if self.iterations >= check:
                check = self.iterations + max(_CHECKED_EVERY, int(_CHECKED_LATER * self.iterations))
                self.iterate = iterates.iterate.astype(np.float64)
                bound, primal = dual_bound(self.relaxation, self.iterate, self.step, self.cost), iterates.primal
                if stop(bound, primal) or clock() > until:
                    return
                if self.single and iterates.rounds(residual):
                    self.single = False
                    iterates = self._iterates()
                if bound is not None:
                    self._balance(iterates, bound, primal)
            stale = residual <= _NECESSARY * first and residual > before
            long = iterates.count > _LONG * self.iterations + _PATIENCE
            if iterates.count > 1 and (residual <= _SUFFICIENT * first or stale or long):
                iterates.restart()
            before = residual

    def _iterates(self) -> _Iterates:
        return _Iterates(self.relaxation, self.cost, self.iterate, np.float32 if self.single else np.float64)

    def _balance(self, iterates: _Iterates, bound: DualBound, primal: float) -> None:
        """Change the step by what the bound loses to the dual over the distance of primal and dual cost, and by how far
        the primal part moved since the last check over how far the dual part did.

        A larger step lets the dual change less from one iterate to the next, so less of it is left to be paid. Either
        ratio alone runs away where its terms answer late; their mean does not.
        """
        size = abs(bound.value) if self.size is None else self.size
        tiny = _TINY * (1.0 + abs(bound.value))
        lost, apart = max(bound.value - bound.of(size), tiny), max(abs(primal - bound.value), tiny)
        point = self.relaxation.project(self.iterate)
        dual = (point - self.iterate) / self.step
        before = self._checked or (np.zeros_like(point), np.zeros_like(dual))
        self._checked = point, dual
        moved, turned = (float(np.linalg.norm(a - b)) for a, b in zip((point, dual), before, strict=True))
        ratio = (lost / apart * max(moved, tiny) / max(turned * self.step, tiny)) ** 0.25
        ratio = min(max(ratio, 1.0 / _STEP_CHANGE), _STEP_CHANGE)
        step = min(max(ratio * self.step, self.steps[0]), self.steps[1])
        if abs(np.log(step / self.step)) > np.log(_STEP_KEPT):
            iterates.restart(step / self.step)
            self.step = step


class _Iterates:
    """The arrays of the splitting in one precision, changed in place: large new ones cost as much as the arithmetic.

    Attributes:
        iterate: (a, c) present iterate; count: iterations since the last restart; primal: cost of the products.
    """

    def __init__(
        self, relaxation: Relaxation, cost: FloatArray, iterate: FloatArray, kind: type[np.float32] | type[np.float64]
    ) -> None:
        self._rows, self._columns = relaxation.row_basis.astype(kind), relaxation.column_basis.astype(kind)
        self._lower, self._upper = relaxation.lower.astype(kind), relaxation.upper.astype(kind)
        self._where = np.nonzero(cost)
        self._slope: _Products = cost[self._where].astype(kind)
        self.iterate: _Products = iterate.astype(kind) if iterate.size else np.zeros(cost.shape, dtype=kind)
        self._anchor, self._projected, self._gap = (self.iterate.copy() for _ in range(3))
        self._half = np.empty((len(self._rows), self._columns.shape[1]), dtype=kind)
        self._inner = np.empty((self._rows.shape[1], self._columns.shape[1]), dtype=kind)
        self._noise = float(np.finfo(kind).eps) * _ROUNDING
        self.count, self.primal = 0, 0.0

    def _project(self) -> None:
        np.matmul(self.iterate, self._columns, out=self._half)
        np.matmul(self._rows.T, self._half, out=self._inner)
        np.matmul(self._rows, self._inner, out=self._half)
        np.matmul(self._half, self._columns.T, out=self._projected)

    def advance(self, step: float) -> float:
        """One anchored iteration; the norm of the difference of both projections."""
        self._project()
        gap, where = self._gap, self._where
        np.multiply(self._projected, 2.0, out=gap)
        gap -= self.iterate
        gap[where] -= step * self._slope
        np.clip(gap, self._lower, self._upper, out=gap)
        self.primal = float((gap[where] * self._slope).sum())
        gap -= self._projected
        residual = float(np.linalg.norm(gap))
        weight = 1.0 / (self.count + 2)
        gap *= 2.0
        self.iterate += gap
        self.iterate *= 1.0 - weight
        np.multiply(self._anchor, weight, out=gap)
        self.iterate += gap
        self.count += 1
        return residual

    def restart(self, factor: float = 1.0) -> None:
        """Anchor at the present iterate, with its dual part times a factor: that of the step, which keeps the dual."""
        if factor != 1.0:
            self._project()
            self.iterate -= self._projected
            self.iterate *= factor
            self.iterate += self._projected
        self._anchor[...] = self.iterate
        self.count = 0

    def rounds(self, residual: float) -> bool:
        """Whether a residual is next to the rounding of the iterate in this precision."""
        return residual < self._noise * float(np.linalg.norm(self.iterate))


def carried_over(new: Relaxation, step: float, before: Splitting) -> FloatArray:
    """The iterate of one window in the coordinates of the next, for this step there."""
    old, iterate = before.relaxation, before.iterate
    m, n = new.equations.n_interfaces, len(new.equations.dead)
    point = old.project(iterate)
    inner = old.row_basis.T @ point @ old.column_basis
    weights = np.linalg.lstsq(old.row_factor, inner, rcond=None)[0]
    weights = np.linalg.lstsq(old.column_factor, weights.T, rcond=None)[0].T
    physical = old.statics @ weights @ old.motions[:n].T
    inside = new.statics.T @ physical @ np.linalg.pinv(new.motions[:n]).T
    point_now = new.rows @ inside @ new.columns.T * new.row_scale[:, None] * new.column_scale
    every = np.zeros((8 * m + 3, 5 * m + 2))
    dual = (point - iterate) / before.step * old.row_scale[:, None] * old.column_scale
    every[np.ix_(*_places(old))] = dual
    every[4 * m] += (new.low - old.low) * every[4 * m + 1] - (new.high - old.high) * every[4 * m + 2]
    limits = {(p, side): limit for p, side, limit in new.limits}
    for (p, side, limit), place in zip(old.limits, _limit_places(old), strict=True):
        every[4 * m] += side * (limits[p, side] - limit) * every[place]
    dual = every[np.ix_(*_places(new))] / new.row_scale[:, None] / new.column_scale
    return np.asarray(point_now - step * (dual - new.project(dual)))


def _places(relaxation: Relaxation) -> tuple[IntArray, IntArray]:
    """Rows and columns of a relaxation within one that has a row and a column for everything."""
    m, q = relaxation.equations.n_interfaces, relaxation.unloadable
    rows = np.concatenate([np.arange(4 * m + 3), _limit_places(relaxation), 4 * m + 3 + q, 5 * m + 3 + q])
    return rows, np.concatenate([relaxation.free, [4 * m, 4 * m + 1], 4 * m + 2 + q])


def _limit_places(relaxation: Relaxation) -> IntArray:
    """Rows of limits of normal forces: those from below, then those from above."""
    m = relaxation.equations.n_interfaces
    return np.array([(6 if side > 0 else 7) * m + 3 + p for p, side, _ in relaxation.limits], dtype=np.int64)
