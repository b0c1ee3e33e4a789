"""Interior point with friction bounds that lag behind: the way to collapse states of walls of any size.

With the friction bounds c = mu N held, zero-dilatancy flow is a linear programme and its Newton matrix symmetric and
positive (Gilbert, Casapulla and Ahmed 2006 solve a sequence of them). Here one path does it: at every Newton step the
bounds move a part of the way to mu N of the iterate, and y o g falls as the steps allow. Where Newton's method on the
nonsymmetric complementarity problem stalls at a fold, this does not; the end is approximate and serves to identify
the moving contacts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import FloatArray
from harness.model.joint_law import JointLaw
from methods.la.core.exact import close_tight
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.interior.interior_point import PathResult, PathSettings, follow_path, start_point, step_lengths
from methods.la.interior.newton_step import NewtonStep, Point
from methods.numerics.failures import NumericalFailure


@dataclass(frozen=True)
class TrescaIteration:
    """How the bounds lag behind.

    Attributes:
        least_bound: least friction bound, in mean block weights, where a joint carries nothing.
        shortest: length of a step below which the path is stuck.
        free, fall: length of a step from which it counts as not blocked, and factor on y o g in one.
        start_gap, end_gap: relative gaps of the associated path at which the bounds take over, and at which y o g falls
            no further.
        to_boundary: part of the way to the boundary that a step goes.
        clipped: times the mean product that the second-order term may be.
    """

    least_bound: float = 1e-4
    shortest: float = 1e-4
    free: float = 0.3
    fall: float = 0.8
    start_gap: float = 1e-2
    end_gap: float = 1e-6
    to_boundary: float = 0.95
    clipped: float = 5.0


def _with_bounds(problem: Problem, bound: FloatArray) -> Problem:
    """The problem with fixed bounds (m,) on shear instead of friction and cohesion."""
    none = np.zeros(len(bound))
    constant = np.column_stack([problem.law.constant[:, :2], bound, bound])
    return replace(problem, law=JointLaw(none, none, constant))


def tresca_mechanism(
    problem: Problem, newton: NewtonMatrix, steps: int, follow: float, options: TrescaIteration = TrescaIteration()
) -> tuple[PathResult, int]:
    """The exact mechanism of the programme with the bounds reached, and the Newton steps in all.

    Args:
        problem: the scaled wall.
        newton: its Newton matrix.
        steps: Newton steps with lagged bounds at most.
        follow: part of the way to mu N that a bound moves in a step.
        options: how the bounds lag behind.

    Raises:
        SingularMatrix: a Newton matrix is singular to rounding.
    """
    settings = PathSettings(dilatancy=1.0, gap=options.start_gap, residual=1e-3)
    start = follow_path(problem, newton, start_point(problem), settings)
    point, bound = start.point, _strength(problem, start.point, options.least_bound)
    tight = close_tight(problem)
    mean = float((point.slack * point.rates).mean())
    least = options.end_gap * problem.live_work / point.slack.size
    taken = 0
    for _ in range(steps):
        problem.deadline.ask()
        held = _with_bounds(problem, bound)
        try:
            step = NewtonStep(held, point, 1.0, tight).factorised(newton)
        except (NumericalFailure, FloatingPointError):
            break
        taken += 1
        wanted = bound + follow * (_strength(problem, point, options.least_bound) - bound)
        point, length = _step(step, point, wanted - bound, mean, options)
        bound = 0.5 * point.slack[:, 2:].sum(axis=1)
        if length < options.shortest:
            break
        if length > options.free:
            mean = max(options.fall * mean, least)
    held = _with_bounds(problem, bound)
    sharp = follow_path(held, newton, start_point(held), PathSettings.sharp())
    return sharp, start.iterations + taken + sharp.iterations


def _strength(problem: Problem, point: Point, least: float) -> FloatArray:
    return np.asarray(np.maximum(problem.law.strength(problem.forces_of_slacks(point.slack)), least))


def _step(
    step: NewtonStep, point: Point, shift: FloatArray, mean: float, options: TrescaIteration
) -> tuple[Point, float]:
    """A predictor and corrector to y o g = mean while both shear slacks grow by `shift` (m,); and its length."""
    grown = np.zeros(point.slack.shape)
    grown[:, 2:] = shift[:, None]
    target = mean - point.rates * grown
    predictor = step.direction(target)
    lengths = step_lengths(point, replace(predictor, slack=predictor.slack + grown), step.tight, 1.0, 1.0)
    with np.errstate(over="ignore"):  # A product without bound is clipped below like any large one.
        second = (predictor.slack + grown) * predictor.rates * min(lengths)
    target = target - np.clip(second, -options.clipped * mean, options.clipped * mean)
    corrector = step.refined(step.direction(target), target)
    corrector = replace(corrector, slack=corrector.slack + grown)
    primal, dual = step_lengths(point, corrector, step.tight, options.to_boundary, 1.0)
    return step.advance(corrector, primal, dual), min(primal, dual)
