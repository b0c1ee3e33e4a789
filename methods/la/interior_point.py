"""Primal-dual interior point on the complementarity system of collapse, for associated and zero-dilatancy flow.

Unknowns are forces r, multiplier, velocities u and rates g with y = S r, C u = E g, C' r + f0 + lambda fL = 0,
fL.u = const and y o g = tau, tau -> 0. Elimination of r and g leaves one sparse 3n x 3n system a step,
K = C' (E diag(g/y) S)^-1 C bordered by fL. With E = S' this is the primal-dual method of linear programming
(Mehrotra 1992); with zero dilatancy the same steps follow the central path of a nonsymmetric complementarity
problem, which need not lead to its least multiplier.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.exact import RIGID, close_tight
from methods.la.flexibility import flexibility
from methods.la.newton_matrix import Factor, NewtonMatrix
from methods.la.problem import Problem


@dataclass
class Point:
    """An iterate: forces (m, 3), multiplier, velocities (3n,), rates (m, 4); all scaled."""

    forces: FloatArray
    multiplier: float
    velocities: FloatArray
    rates: FloatArray


@dataclass(frozen=True)
class PathSettings:
    """How the central path is followed.

    Attributes:
        associated: dilatant flow, the linear programme, instead of zero dilatancy.
        gap: complementarity y.g relative to the live work at which it stops.
        residual: scaled equilibrium and compatibility residuals at which it stops.
        max_iterations: Newton steps at most.
        pivoting: threshold of the LU pivoting.
        patience: steps without progress after which it gives the best point it had.
    """

    associated: bool = False
    gap: float = 1e-10
    residual: float = 1e-9
    max_iterations: int = 200
    pivoting: float = 0.0
    patience: int = 12


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


def start_point(
    problem: Problem,
    spread: float = 0.0,
    generator: np.random.Generator | None = None,
    tight: BoolArray | None = None,
) -> Point:
    """A centred point off equilibrium: unit compression, no shear; `spread` > 0 randomises it by factors exp(+-).

    Slacks of `tight` (m, 4) start at zero and stay there.
    """
    m = problem.n_interfaces
    normal, tilt, target = np.ones((m, 2)), np.zeros(m), np.ones((m, 4))
    if spread > 0.0 and generator is not None:
        normal = np.exp(generator.uniform(-spread, spread, (m, 2)))
        tilt = generator.uniform(-0.5, 0.5, m)
        target = np.exp(generator.uniform(-spread, spread, (m, 4)))
    tight = close_tight(problem, np.zeros((m, 4), dtype=bool)) if tight is None else tight
    normal = np.where(tight[:, :2], 0.0, normal)
    tilt = np.where(tight[:, 2], -1.0, np.where(tight[:, 3], 1.0, tilt))
    forces = np.column_stack([normal, tilt * problem.friction * normal.sum(axis=1)])
    slack = np.where(tight, 1.0, problem.slacks(forces))
    return Point(forces, 0.0, np.zeros(problem.n_velocities), np.where(tight, 0.0, target / slack))


class _Step:
    """One factorised Newton system at a point; solves for any right-hand side of the complementarity."""

    def __init__(
        self, problem: Problem, newton: NewtonMatrix, point: Point, settings: PathSettings, tight: BoolArray
    ) -> None:
        self.problem, self.point, self.associated, self.tight = problem, point, settings.associated, tight
        self.slack = problem.slacks(point.forces)
        if not (np.all(self.slack[~tight] > 0.0) and np.all(point.rates[~tight] > 0.0)):
            raise FloatingPointError("the iterate left the interior")
        self.slack[tight] = 1.0
        self.weight = np.where(tight, RIGID, point.rates / self.slack)
        self.flexibility = flexibility(problem.friction, self.weight, self.associated)
        self.statics = problem.imbalance(point.forces, point.multiplier)
        self.kinematics = problem.strains(point.velocities) - problem.strains_of_rates(point.rates, self.associated)
        self.work = problem.live_work - float(problem.live @ point.velocities)
        self.factor: Factor = newton.factorise(self.flexibility, settings.pivoting, 1e-15)
        self.by_live = self.factor.solve(problem.live)
        self.live_compliance = float(problem.live @ self.by_live)

    def _bordered(self, load: FloatArray, work: float) -> tuple[FloatArray, float]:
        by_load = self.factor.solve(load)
        change = (work - float(self.problem.live @ by_load)) / self.live_compliance
        return by_load + change * self.by_live, change

    def direction(self, target: FloatArray) -> Point:
        """Newton direction towards y o g = target (m, 4)."""
        problem = self.problem
        rate_shift = np.where(self.tight, 0.0, target / self.slack - self.point.rates)
        strain_shift = problem.strains_of_rates(rate_shift, self.associated) - self.kinematics
        lagged = np.einsum("pij,pj->pi", self.flexibility, strain_shift)
        load = np.asarray(problem.statics @ lagged.ravel()) + self.statics
        velocity, multiplier = self._bordered(load, self.work)
        for _ in range(2):
            change = np.einsum("pij,pj->pi", self.flexibility, problem.strains(velocity))
            defect = load - np.asarray(problem.statics @ change.ravel()) + multiplier * problem.live
            extra, more = self._bordered(defect, self.work - float(problem.live @ velocity))
            velocity, multiplier = velocity + extra, multiplier + more
        force = lagged - np.einsum("pij,pj->pi", self.flexibility, problem.strains(velocity))
        return Point(force, multiplier, velocity, self._rate_change(rate_shift, force, velocity))

    def _rate_change(self, shift: FloatArray, force: FloatArray, velocity: FloatArray) -> FloatArray:
        """Change of the rates: from the complementarity where that is accurate, else from compatibility.

        Where w = g/y is large, w dy magnifies rounding; there E dg = C du + residual gives dg without loss.
        """
        rate = shift - np.where(self.tight, 0.0, self.weight * self.problem.slacks(force))
        strain = self.problem.strains(velocity) + self.kinematics
        forward, backward = rate[:, 2].copy(), rate[:, 3].copy()
        tight = np.maximum(self.weight[:, 2], self.weight[:, 3]) > 1.0
        ahead = self.weight[:, 2] >= self.weight[:, 3]
        rate[:, 2] = np.where(tight & ahead, strain[:, 2] + backward, forward)
        rate[:, 3] = np.where(tight & ~ahead, forward - strain[:, 2], backward)
        dilation = self.problem.friction * (rate[:, 2] + rate[:, 3]) if self.associated else np.zeros(len(rate))
        for end in (0, 1):
            rate[:, end] = np.where(self.weight[:, end] > 1.0, strain[:, end] - dilation, rate[:, end])
        return rate


def _longest(value: FloatArray, change: FloatArray) -> float:
    ratio = np.where(change < 0.0, -value / np.where(change < 0.0, change, -1.0), np.inf)
    return float(ratio.min(initial=np.inf))


def _advance(point: Point, change: Point, primal: float, dual: float) -> Point:
    return Point(
        point.forces + primal * change.forces,
        point.multiplier + primal * change.multiplier,
        point.velocities + dual * change.velocities,
        point.rates + dual * change.rates,
    )


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
        RuntimeError: the Newton matrix is singular to rounding.
    """
    point = start
    tight = close_tight(problem, np.zeros((problem.n_interfaces, 4), dtype=bool)) if tight is None else tight
    active = ~tight
    pairs = max(int(active.sum()), 1)
    history: list[float] = []
    best: PathResult | None = None
    best_merit, best_at = np.inf, 0
    for iteration in range(settings.max_iterations + 1):
        try:
            step = _Step(problem, newton, point, settings, tight)
        except (RuntimeError, FloatingPointError):
            break
        product = np.where(active, step.slack * point.rates, 0.0)
        gap = float(product.sum()) / problem.live_work
        statics, kinematics = float(abs(step.statics).max()), float(abs(step.kinematics).max())
        history.append(point.multiplier)
        residual = max(statics, kinematics, abs(step.work) / problem.live_work)
        merit = max(gap / settings.gap, residual / settings.residual)
        if best is None or merit < best_merit:
            best = PathResult(point, merit <= 1.0, iteration, gap, statics, kinematics, history)
            best_merit, best_at = merit, iteration
        if merit <= 1.0 or iteration - best_at > settings.patience or not np.isfinite(merit):
            break
        mean = float(product.sum()) / pairs
        predictor = step.direction(np.zeros((problem.n_interfaces, 4)))
        primal, dual = _step_lengths(problem, step, point, predictor, active, settings, 1.0)
        ahead = _advance(point, predictor, primal, dual)
        mean_ahead = float(np.where(active, problem.slacks(ahead.forces) * ahead.rates, 0.0).sum()) / pairs
        centring = float(np.clip((mean_ahead / mean) ** 3, 1e-6, 1.0))
        second_order = problem.slacks(predictor.forces) * predictor.rates * min(primal, dual) ** 2
        limit = 10.0 * mean
        target = np.where(active, np.clip(centring * mean - second_order, -limit, limit), 0.0)
        corrector = step.direction(target)
        primal, dual = _step_lengths(problem, step, point, corrector, active, settings, 0.995)
        point = _advance(point, corrector, primal, dual)
    if best is None:
        raise RuntimeError("the interior point could not factorise its first system")
    return best


def _step_lengths(
    problem: Problem,
    step: _Step,
    point: Point,
    change: Point,
    active: BoolArray,
    settings: PathSettings,
    fraction: float,
) -> tuple[float, float]:
    primal = _longest(step.slack[active], problem.slacks(change.forces)[active])
    dual = _longest(point.rates[active], change.rates[active])
    primal, dual = min(1.0, fraction * primal), min(1.0, fraction * dual)
    if not settings.associated:
        primal = dual = min(primal, dual)
    return primal, dual
