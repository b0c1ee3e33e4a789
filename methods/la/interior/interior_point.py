"""Primal-dual interior point on the complementarity system of collapse, for associated and zero-dilatancy flow.

Unknowns are slacks y = S r, multiplier, velocities u and rates g with C u = E g, C' r + f0 + lambda fL = 0,
fL.u = const and y o g = tau, tau -> 0. Elimination of y and g leaves one sparse 3n x 3n system a step,
K = C' (E diag(g/y) S)^-1 C bordered by fL. With E = S' this is the primal-dual method of linear programming
(Mehrotra 1992); with zero dilatancy the same steps follow the central path of a nonsymmetric complementarity
problem, which need not lead to its least multiplier.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.core.exact import close_tight
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.interior.newton_step import Direction, NewtonStep, Point
from methods.numerics.failures import NumericalFailure, SingularMatrix


@dataclass(frozen=True)
class Centring:
    """How a step is made longer and kept central.

    Attributes:
        to_boundary: part of the way to the boundary that a step goes.
        correctors: corrections for centrality, each one more solution with the factors of the step.
        ahead, worth: how much longer a step a correction aims at, and the share of that which it must gain.
        long, blocked: length from which a step needs no correction, and below which one that mostly centres is tried.
        spread: times greater or less than the mean that a correction leaves a product, and clips its targets at.
        least: least share of the mean product that a step aims at; halved: that of one that mostly centres.
    """

    to_boundary: float = 0.995
    correctors: int = 3
    ahead: float = 0.3
    worth: float = 0.1
    long: float = 0.9
    blocked: float = 0.1
    spread: float = 10.0
    least: float = 1e-6
    halved: float = 0.5


@dataclass(frozen=True)
class PathSettings:
    """How the central path is followed.

    Attributes:
        dilatancy: 1 for associated flow, the linear programme; 0 for sliding without dilatancy.
        gap: complementarity y.g relative to the live work at which it stops.
        residual: scaled equilibrium and compatibility residuals at which it stops.
        max_iterations: Newton steps at most.
        patience: steps without progress after which it gives the best point it had.
        above: None, or a multiplier at which the path ends if the forces are in equilibrium.
        centring: how its steps are made longer and kept central.
    """

    dilatancy: float = 0.0
    gap: float = 1e-10
    residual: float = 1e-9
    max_iterations: int = 200
    patience: int = 12
    above: float | None = None
    centring: Centring = Centring()

    @classmethod
    def sharp(cls) -> PathSettings:
        """Of associated flow to a gap so small that rates of contacts at rest vanish against forces of any size."""
        return cls(dilatancy=1.0, gap=1e-17, residual=1e-3, max_iterations=150, patience=5)


@dataclass(frozen=True)
class PathResult:
    """Where the path ended. `converged` says whether gap and residuals were reached."""

    point: Point
    converged: bool
    iterations: int
    gap: float
    statics: float
    kinematics: float
    history: list[float]


def start_point(problem: Problem, tight: BoolArray | None = None) -> Point:
    """A centred point off equilibrium: unit compression, no shear. Slacks of `tight` (m, 4) are zero and stay there."""
    tight = close_tight(problem) if tight is None else tight
    normal = np.minimum(np.ones((problem.n_interfaces, 2)), 0.25 * problem.law.greatest_compression[:, None])
    normal = np.where(tight[:, :2], 0.0, normal)
    tilt = np.where(tight[:, 2], -1.0, np.where(tight[:, 3], 1.0, 0.0))
    forces = np.column_stack([normal, tilt * problem.law.strength(normal)])
    slack = np.where(tight, 0.0, problem.slacks(forces))
    if not problem.law.is_cone:
        slack = np.where(tight, 0.0, np.maximum(slack, 1e-3))
    rates = np.where(tight, 0.0, 1.0 / np.where(tight, 1.0, slack))
    return Point(slack, 0.0, np.zeros(problem.n_velocities), rates)


def follow_path(
    problem: Problem, newton: NewtonMatrix, start: Point, settings: PathSettings, tight: BoolArray | None = None
) -> PathResult:
    """Follow the central path from a strictly positive start to complementarity.

    Args:
        problem: the scaled wall.
        newton: its Newton matrix.
        start: a point with positive slacks and rates outside `tight`.
        settings: flow, accuracy, limits.
        tight: (m, 4) slacks held at zero, whose rates have no sign; closed as by `close_tight`.

    Raises:
        SingularMatrix: the first Newton matrix is singular to rounding.
        OutOfTime: the time of the run is over.
    """
    point = start
    tight = close_tight(problem) if tight is None else tight
    pairs = max(int((~tight).sum()), 1)
    history: list[float] = []
    best: PathResult | None = None
    best_merit, best_at = np.inf, 0
    for iteration in range(settings.max_iterations + 1):
        problem.deadline.ask()
        product = point.slack * np.where(tight, 0.0, point.rates)
        gap = float(product.sum()) / problem.live_work
        try:
            step = NewtonStep(problem, point, settings.dilatancy, tight)
        except FloatingPointError:
            break
        statics, kinematics = float(abs(step.statics).max()), float(abs(step.kinematics).max())
        history.append(point.multiplier)
        residual = max(statics, kinematics, abs(step.work) / problem.live_work)
        if settings.above is not None and point.multiplier >= settings.above and statics <= settings.residual:
            return PathResult(point, True, iteration, gap, statics, kinematics, history)
        merit = max(gap / settings.gap, residual / settings.residual)
        if merit > 1.0:
            try:
                step.factorised(newton)
            except NumericalFailure:
                break
        if best is None or merit < best_merit:
            if merit < 0.9 * best_merit:
                best_at = iteration
            best = PathResult(point, merit <= 1.0, iteration, gap, statics, kinematics, history)
            best_merit = merit
        if not product.any() or merit <= 1.0 or iteration - best_at > settings.patience or not np.isfinite(merit):
            break
        point = _centred_step(step, product, pairs, settings.centring)
    if best is None:
        raise SingularMatrix("the interior point could not factorise its first system")
    return best


def _centred_step(step: NewtonStep, product: FloatArray, pairs: int, options: Centring) -> Point:
    """Mehrotra's predictor and corrector; where that is blocked, a step that mostly centres."""
    point = step.point
    mean = float(product.sum()) / pairs
    predictor = step.direction(np.zeros(product.shape))
    primal, dual = step.lengths(predictor, 1.0)
    ahead = (point.slack + primal * predictor.slack) * (point.rates + dual * predictor.rates)
    mean_ahead = float(np.where(step.tight, 0.0, ahead).sum()) / pairs
    centring = float(np.clip((mean_ahead / mean) ** 3, options.least, 1.0))
    second_order = predictor.slack * predictor.rates * min(primal, dual)
    target = np.clip(centring * mean - second_order, -options.spread * mean, options.spread * mean)
    corrector, target, lengths = _longer_step(step, target, centring * mean, options)
    if min(lengths) < options.blocked:
        safe = np.clip(options.halved * mean, product / options.spread, None)
        centred = step.direction(safe)
        if min(step.lengths(centred, options.to_boundary)) > min(lengths):
            corrector, target = centred, safe
    corrector = step.refined(corrector, target)
    return step.advance(corrector, *step.lengths(corrector, options.to_boundary))


def _longer_step(
    step: NewtonStep, target: FloatArray, mean: float, options: Centring
) -> tuple[Direction, FloatArray, tuple[float, float]]:
    """The step to a target, its target and lengths.

    Correctors bring the products of a longer step back to the middle (Gondzio 1996), while they lengthen it.
    """
    point, change = step.point, step.direction(target)
    primal, dual = step.lengths(change, options.to_boundary)
    for _ in range(options.correctors):
        if min(primal, dual) > options.long:
            break
        reach = (min(1.0, primal + options.ahead), min(1.0, dual + options.ahead))
        product = (point.slack + reach[0] * change.slack) * (point.rates + reach[1] * change.rates)
        shift = np.clip(
            np.clip(product, mean / options.spread, options.spread * mean) - product, -options.spread * mean, None
        )
        other = step.direction(target + shift)
        lengths = step.lengths(other, options.to_boundary)
        if sum(lengths) < primal + dual + options.worth * options.ahead:
            break
        change, target, (primal, dual) = other, target + shift, lengths
    return change, target, (primal, dual)
