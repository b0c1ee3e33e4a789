"""The central path of zero-dilatancy flow followed by its arc length, past the folds at which Newton's path stalls.

Where the path y o g = tau folds, tau must rise before it falls again. The tangent d/d(log tau) still exists; its
sense is kept by the angle to the tangent before, and a Newton step across it leads back to the path (Keller 1977).
Lengths are relative changes of slacks and rates, so that contacts that fade weigh no less than others.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.exact import close_tight
from methods.la.interior_point import PathResult, step_lengths
from methods.la.newton_matrix import NewtonMatrix
from methods.la.newton_step import Direction, NewtonStep, Point
from methods.la.problem import Problem

STRIDE = 4.0
"""Largest relative change of a slack or rate that a step along the tangent aims at."""
FAR = 4.0
"""Largest logarithm of y g / tau at which a step goes along the path; beyond, it only leads back to it."""
ASTRAY = 0.5
"""Root mean square of the relative changes back to the path beyond which a step only leads back."""
SHORT = 0.9
"""Part of the way to the boundary that a step goes."""


@dataclass(frozen=True)
class ArcSettings:
    """How far the path is followed.

    Attributes:
        gap: complementarity y.g relative to the live work at which it stops.
        residual: scaled equilibrium and compatibility residuals at which it may stop.
        max_iterations: Newton steps at most.
    """

    gap: float = 1e-7
    residual: float = 1e-3
    max_iterations: int = 1000


def follow_arc(problem: Problem, newton: NewtonMatrix, start: Point, settings: ArcSettings) -> PathResult:
    """Follow the central path of zero-dilatancy flow by arc length from a point near it.

    Args:
        problem: the scaled wall.
        newton: its Newton matrix.
        start: a point with positive slacks and rates, as where `follow_path` stalls.
        settings: where it ends.

    Raises:
        RuntimeError: the first Newton matrix is singular to rounding.
    """
    tight = close_tight(problem, np.zeros(start.slack.shape, dtype=bool))
    point, mean = start, _mean(start, tight)
    before: tuple[FloatArray, float] | None = None
    result: PathResult | None = None
    history: list[float] = []
    for iteration in range(settings.max_iterations + 1):
        try:
            step = NewtonStep(problem, newton, point, 0.0, tight)
        except (RuntimeError, FloatingPointError):
            break
        history.append(point.multiplier)
        gap = float((point.slack * point.rates).sum()) / problem.live_work
        statics, kinematics = float(abs(step.statics).max()), float(abs(step.kinematics).max())
        converged = gap <= settings.gap and max(statics, kinematics) <= settings.residual
        result = PathResult(point, converged, iteration, gap, statics, kinematics, history)
        if converged:
            break
        change, growth, before = _change(step, point, mean, before, tight)
        length = min(step_lengths(point, change, tight, SHORT, 0.0))
        point, mean = step.advance(change, length, length), mean * float(np.exp(length * growth))
    if result is None:
        raise RuntimeError("the path could not factorise its first system")
    return result


def _change(
    step: NewtonStep, point: Point, mean: float, before: tuple[FloatArray, float] | None, tight: BoolArray
) -> tuple[Direction, float, tuple[FloatArray, float] | None]:
    """The change of the point, that of log tau, and the unit tangent to compare the next with."""
    target = np.full(point.slack.shape, mean)
    back = step.direction(target, refinements=0)
    tangent = step.direction(2.0 * target, refinements=0).plus(-1.0, back)
    along, across = _relative(point, tangent, tight), _relative(point, back, tight)
    square = float((along**2).mean())
    growth = -float((along * across).mean()) / (square + 1.0)
    astray = float(np.sqrt(((across + growth * along) ** 2).mean()))
    product = np.where(tight, mean, point.slack * point.rates)
    if astray > ASTRAY or float(abs(np.log(product / mean)).max()) > FAR:
        return back.plus(growth, tangent), growth, before
    norm = float(np.sqrt(square + 1.0))
    sense = -1.0 if before is None else float(np.sign((along * before[0]).mean() + before[1]))
    stride = sense * min(STRIDE / max(float(abs(along).max()), 1e-30), 1.0)
    return back.plus(growth + stride, tangent), growth + stride, (sense * along / norm, sense / norm)


def _mean(point: Point, tight: BoolArray) -> float:
    return float((point.slack * point.rates)[~tight].mean())


def _relative(point: Point, change: Direction, tight: BoolArray) -> FloatArray:
    """(2, m, 4) changes of slacks and rates relative to their size."""
    slack, rates = np.where(tight, 1.0, point.slack), np.where(tight, 1.0, point.rates)
    return np.where(tight, 0.0, np.stack([change.slack / slack, change.rates / rates]))
