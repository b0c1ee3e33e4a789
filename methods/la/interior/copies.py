"""Central paths of copies of a wall under other dead loads, all at once.

On walls of some ten blocks a Newton step takes a millisecond, nearly all of it the overhead of a hundred operations on
small arrays. Steps of many copies together take the same operations on longer arrays, and one factorisation. Every copy
has a multiplier, a centring and a step length of its own. The steps are those of `methods.la.interior.interior_point`
without further correctors and refinement: the end only tells a mechanism.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from harness.model.joint_law import JointLaw
from methods.la.core.exact import RIGID, close_tight
from methods.la.core.flexibility import Compliance
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.interior.interior_point import Centring, start_point
from methods.numerics.failures import NumericalFailure


@dataclass
class _Points:
    """Points of k paths, scaled, or changes of them: slacks and rates (k, m, 4), multipliers (k,), velocities (k, 3n).

    Attributes:
        slack, multiplier, velocities, rates: as of `methods.la.interior.newton_step.Point`.
    """

    slack: FloatArray
    multiplier: FloatArray
    velocities: FloatArray
    rates: FloatArray

    def of(self, chosen: BoolArray) -> _Points:
        """The points of some of the paths."""
        return _Points(self.slack[chosen], self.multiplier[chosen], self.velocities[chosen], self.rates[chosen])

    def plus(self, lengths: FloatArray, change: _Points) -> _Points:
        """The points after steps of these lengths (k,)."""
        each = lengths[:, None, None]
        return _Points(
            self.slack + each * change.slack,
            self.multiplier + lengths * change.multiplier,
            self.velocities + lengths[:, None] * change.velocities,
            self.rates + each * change.rates,
        )


class _NewtonSteps:
    """The Newton systems of k paths: residuals, and once they are `factorised`, directions for any targets."""

    def __init__(self, problem: Problem, dead: FloatArray, points: _Points, tight: BoolArray) -> None:
        self.problem, self.points, self.tight = problem, points, tight
        self.inside = np.where(tight, np.inf, points.slack), np.where(tight, np.inf, points.rates)
        count, law = len(dead), problem.law
        self.law = JointLaw(
            np.tile(law.friction, count), np.tile(law.dilatancy, count), np.tile(law.constant, (count, 1))
        )
        forces = self.law.forces_of_slacks(points.slack.reshape(-1, 4))
        self.statics = self._loads(forces) + dead + points.multiplier[:, None] * problem.live
        self.kinematics = self._strains(points.velocities) - self._strains_of_rates(points.rates)
        self.work = problem.live_work - points.velocities @ problem.live
        self.product = np.where(tight, 0.0, points.slack * points.rates)

    def factorised(self, newton: NewtonMatrix) -> None:
        """Factorise the matrices of the steps.

        Raises:
            SingularMatrix: one of them is singular to rounding.
        """
        count = len(self.work)
        self.weight = np.where(self.tight, RIGID, self.points.rates / self.inside[0])
        self.compliance = Compliance(self.law, self.weight.reshape(-1, 4), self.law.lift(0.0))
        self.factor = newton.factorise_copies(self.compliance.matrices.reshape(count, -1, 3, 3), 1e-15)
        self.by_live = self._solve(np.tile(self.problem.live, (count, 1)))

    @property
    def residual(self) -> FloatArray:
        """(k,) greatest residuals of equilibrium and compatibility, scaled."""
        return np.asarray(np.maximum(abs(self.statics).max(axis=1), abs(self.kinematics).max(axis=(1, 2))))

    def direction(self, target: FloatArray) -> _Points:
        """Newton directions towards y o g = target (k, m, 4)."""
        rate_shift = np.where(self.tight, 0.0, target / self.inside[0] - self.points.rates)
        shift = self._strains_of_rates(rate_shift) - self.kinematics
        by_load = self._solve(self._loads(self.compliance.forces(shift.reshape(-1, 3))) + self.statics)
        multiplier = (self.work - by_load @ self.problem.live) / (self.by_live @ self.problem.live)
        velocities = by_load + multiplier[:, None] * self.by_live
        slack = self.compliance.response((shift - self._strains(velocities)).reshape(-1, 3))[1]
        slack = np.where(self.tight, 0.0, slack.reshape(target.shape))
        return _Points(slack, multiplier, velocities, rate_shift - np.where(self.tight, 0.0, self.weight * slack))

    def lengths(self, change: _Points, fraction: float) -> FloatArray:
        """(k,) step lengths of at most 1 that go this part of the way to the boundary."""
        slack, rates = self.inside
        steepest = -np.minimum((change.slack / slack).min(axis=(1, 2)), (change.rates / rates).min(axis=(1, 2)))
        return np.asarray(fraction / np.maximum(steepest, fraction))

    def _solve(self, loads: FloatArray) -> FloatArray:
        return np.asarray(self.factor.solve(loads.ravel()).reshape(loads.shape))

    def _loads(self, forces: FloatArray) -> FloatArray:
        return np.asarray((self.problem.statics @ forces.reshape(len(self.points.slack), -1).T).T)

    def _strains(self, velocities: FloatArray) -> FloatArray:
        return np.asarray((self.problem.kinematic @ velocities.T).T.reshape(len(velocities), -1, 3))

    def _strains_of_rates(self, rates: FloatArray) -> FloatArray:
        dilation = self.problem.law.lift(0.0) * (rates[:, :, 2] + rates[:, :, 3])
        slip = rates[:, :, 2] - rates[:, :, 3]
        return np.stack([rates[:, :, 0] + dilation, rates[:, :, 1] + dilation, slip], axis=2)


def path_ends(
    problem: Problem,
    newton: NewtonMatrix,
    dead: FloatArray,
    gap: float,
    most: int = 25,
    options: Centring = Centring(),
) -> tuple[FloatArray, FloatArray, int]:
    """Slacks and rates (k, m, 4) at the ends of the central paths that arrive, and the Newton steps of all.

    Args:
        problem: the scaled wall; newton: its Newton matrix.
        dead: (k, 3n) dead loads of its copies; of one, if the matrix is `large`.
        gap: complementarity y.g relative to the live work at which a path ends, once its residuals are below ten times
            as much.
        most: Newton steps of a path; nearly all that arrive take half as many.
        options: how steps are kept central.

    Raises:
        OutOfTime: the time of the run is over.
    """
    tight = close_tight(problem)
    pairs, first, count = max(int((~tight).sum()), 1), start_point(problem, tight), len(dead)
    here = _Points(
        *(np.repeat(part[None], count, axis=0) for part in (first.slack, np.zeros(()), first.velocities, first.rates))
    )
    slack, rates, steps = [], [], 0
    for _ in range(most):
        problem.deadline.ask()
        step = _NewtonSteps(problem, dead, here, tight)
        ended = (step.product.sum(axis=(1, 2)) <= gap * problem.live_work) & (step.residual <= 10.0 * gap)
        slack += list(here.slack[ended])
        rates += list(here.rates[ended])
        if ended.all():
            break
        if ended.any():
            here, dead = here.of(~ended), dead[~ended]
            step = _NewtonSteps(problem, dead, here, tight)
        try:
            step.factorised(newton)
        except NumericalFailure:
            break
        steps += len(dead)
        here = here.plus(*_centred(step, pairs, options))
        inside = np.all(tight | ((here.slack > 0.0) & (here.rates > 0.0)), axis=(1, 2))
        here, dead = here.of(inside), dead[inside]
        if not len(dead):
            break
    shape = (-1, *tight.shape)
    return np.reshape(slack, shape), np.reshape(rates, shape), steps


def _centred(step: _NewtonSteps, pairs: int, options: Centring) -> tuple[FloatArray, _Points]:
    """The lengths of Mehrotra's predictor-corrector steps (1992), and their directions."""
    predictor = step.direction(np.zeros(step.product.shape))
    lengths = step.lengths(predictor, 1.0)
    ahead = step.points.plus(lengths, predictor)
    product_ahead = np.where(step.tight, 0.0, ahead.slack * ahead.rates)
    total = step.product.sum(axis=(1, 2), keepdims=True)
    mean = total / pairs
    centring = np.clip((product_ahead.sum(axis=(1, 2), keepdims=True) / total) ** 3, options.least, 1.0)
    second_order = predictor.slack * predictor.rates * lengths[:, None, None]
    corrector = step.direction(np.clip(centring * mean - second_order, -options.spread * mean, options.spread * mean))
    return step.lengths(corrector, options.to_boundary), corrector
