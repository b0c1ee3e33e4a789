"""Interior point with friction bounds that lag behind: the way to collapse states of walls of any size.

With the friction bounds c = mu N held, zero-dilatancy flow is a linear programme and its Newton matrix symmetric and
positive (Gilbert, Casapulla and Ahmed 2006 solve a sequence of them). Here one path does it: at every Newton step the
bounds move a part of the way to mu N of the iterate, and y o g falls as the steps allow. Where Newton's method on the
nonsymmetric complementarity problem stalls at a fold, this does not; the end is approximate and serves to identify
the moving contacts.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import FloatArray
from harness.model.joint_law import JointLaw
from methods.la.core.exact import close_tight
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.interior.interior_point import PathResult, PathSettings, follow_path, start_point
from methods.la.interior.newton_step import NewtonStep, Point
from methods.numerics.failures import NumericalFailure

_LEAST_BOUND = 1e-4
"""Least friction bound, in mean block weights, where a joint carries nothing."""
_SHORTEST = 1e-4
"""Length of a step below which the path is stuck."""
_FREE = 0.3
"""Length of a step from which it counts as not blocked."""
_FALL = 0.8
"""Factor on y o g in one."""
_START_GAP = 1e-2
"""Relative gap of the associated path at which the bounds take over."""
_END_GAP = 1e-6
"""The same at which y o g falls no further."""
_TO_BOUNDARY = 0.95
"""Part of the way to the boundary that a step goes."""
_CLIPPED = 5.0
"""Times the mean product that the second-order term may be."""


def _with_bounds(problem: Problem, bound: FloatArray) -> Problem:
    """The problem with fixed bounds (m,) on shear instead of friction and cohesion."""
    none = np.zeros(len(bound))
    constant = np.column_stack([problem.law.constant[:, :2], bound, bound])
    return replace(problem, law=JointLaw(none, none, constant))


def tresca_mechanism(problem: Problem, newton: NewtonMatrix, steps: int, follow: float) -> tuple[PathResult, int]:
    """The exact mechanism of the programme with the bounds reached, and the Newton steps in all.

    Args:
        problem: the scaled wall.
        newton: its Newton matrix.
        steps: Newton steps with lagged bounds at most.
        follow: part of the way to mu N that a bound moves in a step.

    Raises:
        SingularMatrix: a Newton matrix is singular to rounding.
    """
    settings = PathSettings(dilatancy=1.0, gap=_START_GAP, residual=1e-3)
    start = follow_path(problem, newton, start_point(problem), settings)
    point, bound = start.point, _strength(problem, start.point, _LEAST_BOUND)
    tight = close_tight(problem)
    mean = float((point.slack * point.rates).mean())
    least = _END_GAP * problem.live_work / point.slack.size
    taken = 0
    for _ in range(steps):
        problem.deadline.ask()
        held = _with_bounds(problem, bound)
        try:
            step = NewtonStep(held, point, 1.0, tight).factorised(newton)
        except (NumericalFailure, FloatingPointError):
            break
        taken += 1
        wanted = bound + follow * (_strength(problem, point, _LEAST_BOUND) - bound)
        point, length = _step(step, point, wanted - bound, mean)
        bound = 0.5 * point.slack[:, 2:].sum(axis=1)
        if length < _SHORTEST:
            break
        if length > _FREE:
            mean = max(_FALL * mean, least)
    held = _with_bounds(problem, bound)
    sharp = follow_path(held, newton, start_point(held), PathSettings.sharp())
    return sharp, start.iterations + taken + sharp.iterations


def _strength(problem: Problem, point: Point, least: float) -> FloatArray:
    return np.asarray(np.maximum(problem.law.strength(problem.forces_of_slacks(point.slack)), least))


def _step(step: NewtonStep, point: Point, shift: FloatArray, mean: float) -> tuple[Point, float]:
    """A predictor and corrector to y o g = mean while both shear slacks grow by `shift` (m,); and its length."""
    grown = np.zeros(point.slack.shape)
    grown[:, 2:] = shift[:, None]
    target = mean - point.rates * grown
    predictor = step.direction(target)
    lengths = step.lengths(replace(predictor, slack=predictor.slack + grown), 1.0)
    with np.errstate(over="ignore"):  # A product without bound is clipped below like any large one.
        second = (predictor.slack + grown) * predictor.rates * min(lengths)
    target = target - np.clip(second, -_CLIPPED * mean, _CLIPPED * mean)
    corrector = step.refined(step.direction(target), target)
    corrector = replace(corrector, slack=corrector.slack + grown)
    primal, dual = step.lengths(corrector, _TO_BOUNDARY)
    return step.advance(corrector, primal, dual), min(primal, dual)
