"""The path of zero-dilatancy flow followed by its arc length, past the folds at which Newton's path stalls.

The path goes through its start: y o g = tau w with the weights w that the start has. Where it folds, tau must rise
before it falls again. The tangent d/d(log tau) still exists, and a Newton step across it leads back to the path (Keller
1977). At a fold the determinant of the Newton system changes its sign, and so tells the sense of the path however
sharply it bends. Lengths are relative changes of slacks and rates, so that contacts that fade weigh no less than
others. A step keeps every product: where a contact opens or closes, slack and rate go along their hyperbola, so that
the step is bounded by how much the larger of them grows, not by the smaller one's way to zero. Where steps across do
not lead back, the path is taken up again at the last good point with half the stride.

A path may also begin in associated flow, a linear programme: the dilatancy then falls with log tau from the friction
to that of the joints. The associated path with these weights has one point for every tau, so no other point has the
tau of the start: the path cannot come back to it, and leads to tau = 0 unless it has no bound (Eaves 1972; Allgower
and Georg 1990). One of zero dilatancy from its start on may be a closed curve.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.core.exact import close_tight
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.interior.interior_point import PathResult
from methods.la.interior.newton_step import Direction, NewtonStep, Point
from methods.numerics.failures import NumericalFailure, SingularMatrix

_SHORTEST = 2.0**-8
"""Stride below which it is not halved again."""
_FAR = 4.0
"""Largest logarithm of y g / (tau w) at which a step goes along the path; beyond, it only leads back to it."""
_ASTRAY = 0.1
"""Root mean square of the relative changes back to the path beyond which a step only leads back."""
_PATIENCE = 8
"""Steps back in turn after which the path is taken up again with a shorter stride."""
_APART = 10.0
"""Factor by which a step changes the product of a slack and its rate at most, to lead it back to the path."""
_TO_BOUNDARY = 0.9
"""Part of the way to where a slack and its rate both vanish that a step goes."""
_GROWTH = 100.0
"""Relative growth of a slack or rate beyond which a step is shortened; steps along the path are far from it."""
_GONE = 10.0
"""Relative gap above which the path has turned away for good."""


@dataclass(frozen=True)
class Stepping:
    """How the path is followed.

    Attributes:
        stride: largest relative change of a slack or rate that a step along the tangent aims at.
        trial, left: steps after which a path must have left its beginning, and the root mean square of the changes of
            the logarithms of slacks and rates that this asks for; many that have not are closed.
        back: the same mean at which a path that had left has come back: it is closed.
        residual: scaled equilibrium and compatibility residuals at which a stretch of the path may stop.
    """

    stride: float = 8.0
    trial: int = 200
    left: float = 0.3
    back: float = 0.1
    residual: float = 1e-3


@dataclass(frozen=True)
class _Place:
    """A point with its tau."""

    point: Point
    tau: float


@dataclass(frozen=True)
class _Way:
    """How the path goes on from a place: across leads back to it, along is its tangent per unit of log tau.

    Both are of the products (m, 4) there and those that back aims at, one where a slack is tight.
    """

    product: FloatArray
    target: FloatArray
    back: Direction
    tangent: Direction
    growth: float
    steepest: float
    on_path: bool


class ArcPath:
    """The path from a point on, followed in stretches; its sense is kept from one to the next.

    Args:
        problem: the scaled wall.
        newton: its Newton matrix.
        start: a point with positive slacks and rates.
        spread: how many times greater or less than the mean a weight may be; beyond, the path passes beside the start.
        faded: share of the tau of the start at which the dilatancy has faded to that of the joints, from the friction
            at the start; 1 if it is that of the joints throughout.
        stepping: how it is followed.
    """

    def __init__(
        self,
        problem: Problem,
        newton: NewtonMatrix,
        start: Point,
        spread: float = np.inf,
        faded: float = 1.0,
        stepping: Stepping = Stepping(),
    ) -> None:
        self._problem, self._newton, self._stepping = problem, newton, stepping
        self._tight = close_tight(problem)
        self._stride = self._stepping.stride
        product = np.where(self._tight, 1.0, start.slack * start.rates)
        self._weights = np.clip(product / product[~self._tight].mean(), 1.0 / spread, spread)
        self._first, self._fall = float((product / self._weights)[~self._tight].mean()), -float(np.log(faded))
        self._here = _Place(start, self._first)
        self._good: _Place | None = None
        self._begun: tuple[Point, float] | None = None
        self._steps = 0
        self._has_left = False
        self._again = False
        self._astray = 0

    def follow(self, gap: float, max_iterations: int) -> PathResult:
        """Follow the path until complementarity y.g is at most `gap` of the live work.

        Args:
            gap: at which it stops; max_iterations: Newton steps at most.

        Raises:
            SingularMatrix: the first Newton matrix is singular to rounding.
        """
        result: PathResult | None = None
        history: list[float] = []
        for iteration in range(max_iterations + 1):
            self._problem.deadline.ask()
            point, share = self._here.point, self._share()
            try:
                step = NewtonStep(self._problem, point, share, self._tight).factorised(self._newton)
            except (NumericalFailure, FloatingPointError):
                break
            history.append(point.multiplier)
            present = float((point.slack * point.rates).sum()) / self._problem.live_work
            statics, kinematics = float(abs(step.statics).max()), float(abs(step.kinematics).max())
            converged = present <= gap and share == 0.0 and max(statics, kinematics) <= self._stepping.residual
            result = PathResult(point, converged, iteration, present, statics, kinematics, history)
            if converged or present > _GONE or (not self._fall and self._is_closed()):
                break
            try:
                self._go_on(step, ends=present <= gap and share == 0.0)
            except FloatingPointError:
                break
            self._steps += 1
        if result is None:
            raise SingularMatrix("the path could not factorise its first system")
        return result

    def _share(self) -> float:
        """How far slips lift here: from 1, by the friction, to 0, by the dilatancy of the joints."""
        if not self._fall:
            return 0.0
        return float(np.clip(1.0 + np.log(self._here.tau / self._first) / self._fall, 0.0, 1.0))

    def _go_on(self, step: NewtonStep, ends: bool) -> None:
        """One step back to the path, or along it, or back to the last good point.

        Args:
            step: the system here; ends: whether the path is to end here, so that a step only leads back to it.

        Raises:
            FloatingPointError: the system is singular to rounding, so that its solutions have no bound.
        """
        with np.errstate(over="raise", invalid="raise"):
            way = self._way(step)
        if not (way.on_path or self._again):
            self._astray += 1
            if self._astray <= _PATIENCE or not self._take_up_again():
                self._advance(step, way, 0.0)
            return
        if ends:
            self._advance(step, way, 0.0)
            return
        if not self._again and self._astray <= 1:
            self._stride = min(self._stepping.stride, 2.0 * self._stride)
        if self._begun is None:
            self._begun = self._here.point, step.orientation()
        self._good, self._astray, self._again = self._here, 0, False
        sense = -step.orientation() * self._begun[1]
        self._advance(step, way, sense * min(self._stride / max(way.steepest, 1e-30), 1.0))

    def _is_closed(self) -> bool:
        """Whether the path stays where it began, has come back there, or was not found in as many steps."""
        distance = self._distance()
        stays = self._steps == self._stepping.trial and distance <= self._stepping.left
        closed = stays or (self._has_left and distance <= self._stepping.back)
        self._has_left = self._has_left or distance > self._stepping.left
        return closed

    def _distance(self) -> float:
        """Root mean square of the changes of the logarithms of slacks and rates since the path was found."""
        if self._begun is None:
            return 0.0
        before, now = self._begun[0], self._here.point
        pairs = ((before.slack, now.slack), (before.rates, now.rates))
        change = [np.log(new[~self._tight] / old[~self._tight]) for old, new in pairs]
        return float(np.sqrt((np.concatenate(change) ** 2).mean()))

    def _take_up_again(self) -> bool:
        """Return to the last good point with half the stride, if there is one and the stride can be halved."""
        if self._good is None or self._stride <= _SHORTEST:
            return False
        self._here, self._stride = self._good, 0.5 * self._stride
        self._astray, self._again = 0, True
        return True

    def _advance(self, step: NewtonStep, way: _Way, stride: float) -> None:
        change, growth = way.back.plus(way.growth + stride, way.tangent), way.growth + stride
        length = min(step.length_on(change, _TO_BOUNDARY, _GROWTH), 1.0 / max(abs(growth), 1.0))
        product = (1.0 - length) * np.log(way.product) + length * (np.log(way.target) + growth)
        tau = self._here.tau * float(np.exp(length * growth))
        self._here = _Place(step.advance_on(change.times(length), np.exp(product)), tau)

    def _way(self, step: NewtonStep) -> _Way:
        point, tau = self._here.point, self._here.tau
        product = np.where(self._tight, 1.0, point.slack * point.rates)
        aim = np.where(self._tight, 1.0, tau * self._weights)
        target = np.clip(aim, product / _APART, _APART * product)
        back = step.direction(target)
        growing = 1.0 / self._fall if 0.0 < step.dilatancy < 1.0 else 0.0
        tangent = step.direction(2.0 * target, growing).plus(-1.0, back)
        along, across = _relative(point, tangent, self._tight), _relative(point, back, self._tight)
        square = float((along**2).mean())
        growth = -float((along * across).mean()) / (square + 1.0)
        astray = float(np.sqrt(((across + growth * along) ** 2).mean()))
        on_path = astray <= _ASTRAY and float(abs(np.log(product / aim)).max()) <= _FAR
        return _Way(product, target, back, tangent, growth, float(abs(along).max()), on_path)


def _relative(point: Point, change: Direction, tight: BoolArray) -> FloatArray:
    """(2, m, 4) changes of slacks and rates relative to their size."""
    slack, rates = np.where(tight, 1.0, point.slack), np.where(tight, 1.0, point.rates)
    return np.where(tight, 0.0, np.stack([change.slack / slack, change.rates / rates]))
