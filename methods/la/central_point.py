"""A point on the central path of zero-dilatancy flow, where the path begins.

At a wide gap the central path is single whatever the flow. There the path of associated flow is left, and its dilatancy
is taken away step by step while y o g = tau is held; what remains leads on to complementarity (`methods.la.arc`).
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import BoolArray
from methods.la.exact import close_tight
from methods.la.interior_point import PathSettings, follow_path, start_point, step_lengths
from methods.la.newton_matrix import NewtonMatrix
from methods.la.newton_step import NewtonStep, Point
from methods.la.problem import Problem

WIDE = PathSettings(dilatancy=1.0, gap=1.0, residual=float("inf"))
"""Where the associated path is left."""
FIRST = 0.25
"""Dilatancy taken away at first, in parts of the friction."""
LARGEST = 0.5
"""Dilatancy taken away at once at most."""
SMALLEST = 1e-3
"""Dilatancy taken away at once below which the path has folded, and the point is given up."""
STEPS = 15
"""Newton steps at one dilatancy at most; twice as many at the first."""
EASY = 8
"""Newton steps up to which more dilatancy is taken away the next time."""
EXACT = 1e-8
"""Scaled equilibrium and compatibility residuals of a point on the path."""
CENTRED = 0.5
"""Largest logarithm of y g / tau of a point on the path."""


def central_point(problem: Problem, newton: NewtonMatrix) -> tuple[Point | None, int]:
    """A point of the central path of zero-dilatancy flow, or None where the fading path folds, and the steps spent."""
    wide = follow_path(problem, newton, start_point(problem), WIDE)
    tight = close_tight(problem)
    mean = float((wide.point.slack * wide.point.rates)[~tight].mean())
    point, steps = _centred(problem, newton, wide.point, 1.0, mean, tight, 2 * STEPS)
    spent, dilatancy, less = wide.iterations + steps, 1.0, FIRST
    while point is not None and dilatancy > 0.0:
        lower = max(0.0, dilatancy - less)
        there, steps = _centred(problem, newton, point, lower, mean, tight, STEPS)
        spent += steps
        if there is not None:
            point, dilatancy = there, lower
            less = min(LARGEST, 1.5 * less) if steps <= EASY else less
        elif less < SMALLEST:
            return None, spent
        else:
            less *= 0.5
    return point, spent


def _centred(
    problem: Problem,
    newton: NewtonMatrix,
    point: Point,
    dilatancy: float,
    mean: float,
    tight: BoolArray,
    most: int,
) -> tuple[Point | None, int]:
    """The point with y o g = mean to which Newton's method leads at a dilatancy, or None, and the steps spent."""
    target = np.full(point.slack.shape, mean)
    for count in range(most):
        try:
            step = NewtonStep(problem, newton, point, dilatancy, tight)
        except (RuntimeError, FloatingPointError):
            return None, count
        product = np.where(tight, mean, point.slack * point.rates)
        residual = max(float(abs(step.statics).max()), float(abs(step.kinematics).max()))
        if residual <= EXACT and float(abs(np.log(product / mean)).max()) <= CENTRED:
            return point, count
        change = step.refined(step.direction(target), target)
        length = min(step_lengths(point, change, tight, 0.9, 0.0))
        point = step.advance(change, length, length)
    return None, most
