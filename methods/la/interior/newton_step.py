"""One Newton step of the interior point: residuals at a point, one factorisation, directions for any target.

Slacks and rates are both kept as unknowns, and every small one of them is computed without cancellation: a slack
that tends to zero from the compliance of its own pair, a rate that tends to zero from its complementarity.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.core.exact import RIGID
from methods.la.core.flexibility import Compliance
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem

_SOFTEST = 1e-25
"""Least weight g/y in the matrix of a path, far below what any reaches, so that no stiffness overflows."""


@dataclass
class Point:
    """An iterate, scaled: slacks y (m, 4), multiplier, velocities (3n,), rates g (m, 4)."""

    slack: FloatArray
    multiplier: float
    velocities: FloatArray
    rates: FloatArray


@dataclass
class Direction:
    """A change of a point; of the forces (m, 3) too, from which it can be refined."""

    forces: FloatArray
    slack: FloatArray
    multiplier: float
    velocities: FloatArray
    rates: FloatArray

    def times(self, factor: float) -> Direction:
        """`factor` times this change."""
        return Direction(
            factor * self.forces,
            factor * self.slack,
            factor * self.multiplier,
            factor * self.velocities,
            factor * self.rates,
        )

    def plus(self, factor: float, other: Direction) -> Direction:
        """This change and `factor` times another."""
        return Direction(
            self.forces + factor * other.forces,
            self.slack + factor * other.slack,
            self.multiplier + factor * other.multiplier,
            self.velocities + factor * other.velocities,
            self.rates + factor * other.rates,
        )


class NewtonStep:
    """The Newton system at a point: its residuals, and once it is `factorised`, directions.

    Raises:
        FloatingPointError: a slack or rate is not positive.
    """

    def __init__(self, problem: Problem, point: Point, dilatancy: float, tight: BoolArray) -> None:
        self.problem, self.point, self.dilatancy, self.tight = problem, point, dilatancy, tight
        if not (np.all(point.slack[~tight] > 0.0) and np.all(point.rates[~tight] > 0.0)):
            raise FloatingPointError("the iterate left the interior")
        self.slack, self.rates = np.where(tight, np.inf, point.slack), np.where(tight, np.inf, point.rates)
        self.statics = problem.imbalance(problem.forces_of_slacks(point.slack), point.multiplier)
        self.kinematics = problem.strains(point.velocities) - problem.strains_of_rates(point.rates, dilatancy)
        self.work = problem.live_work - float(problem.live @ point.velocities)

    def factorised(self, newton: NewtonMatrix) -> NewtonStep:
        """This step with the factors of its matrix.

        Raises:
            SingularMatrix: the matrix is singular to rounding.
        """
        problem = self.problem
        self.weight = np.where(self.tight, RIGID, np.maximum(self.point.rates / self.slack, _SOFTEST))
        self.lift = problem.law.lift(self.dilatancy)
        self.compliance = Compliance(problem.law, self.weight, self.lift)
        stiff = self.weight > 1.0
        either, ahead = stiff[:, 2] | stiff[:, 3], self.weight[:, 2] >= self.weight[:, 3]
        self._by_strain = stiff[:, :2], either & ahead, either & ~ahead
        self.factor = newton.factorise(self.compliance.matrices, 1e-15)
        self.by_live = self.factor.solve(problem.live)
        self.live_compliance = float(problem.live @ self.by_live)
        return self

    def orientation(self) -> float:
        """The sign of the determinant of the system, but for a sign common to all points of a path."""
        return self.factor.determinant_sign() * float(np.sign(self.live_compliance))

    def _bordered(self, load: FloatArray, work: float) -> tuple[FloatArray, float]:
        by_load = self.factor.solve(load)
        change = (work - float(self.problem.live @ by_load)) / self.live_compliance
        return by_load + change * self.by_live, change

    def direction(self, target: FloatArray, more: float = 0.0) -> Direction:
        """Newton direction towards y o g = target (m, 4), and towards a share of dilatancy greater by `more`."""
        problem, rate_shift = self.problem, self._rate_shift(target)
        kinematics = self.kinematics - more * self._lifting() if more else self.kinematics
        shift = problem.strains_of_rates(rate_shift, self.dilatancy) - kinematics
        load = np.asarray(problem.statics @ self.compliance.forces(shift).ravel()) + self.statics
        velocity, multiplier = self._bordered(load, self.work)
        strain = problem.strains(velocity)
        forces, slack = self.compliance.response(shift - strain)
        return self._with_rates(rate_shift, forces, slack, multiplier, velocity, strain + kinematics)

    def _lifting(self) -> FloatArray:
        """(m, 3) change of the strains of the rates per share of dilatancy."""
        strains, rates = self.problem.strains_of_rates, self.point.rates
        return strains(rates, 1.0) - strains(rates, 0.0)

    def refined(self, change: Direction, target: FloatArray) -> Direction:
        """A direction towards y o g = target (m, 4) with less rounding.

        The refinement adds to forces and slacks, instead of finding them anew from the velocities: the rounding of a
        slip times the stiffness of the pressed ends beside it would be an imbalance that no refinement removes.
        """
        problem = self.problem
        defect = self.statics + np.asarray(problem.statics @ change.forces.ravel()) + change.multiplier * problem.live
        extra, more = self._bordered(defect, self.work - float(problem.live @ change.velocities))
        velocity = change.velocities + extra
        less_forces, less_slack = self.compliance.response(problem.strains(extra))
        forces, slack = change.forces - less_forces, change.slack - less_slack
        multiplier = change.multiplier + more
        return self._with_rates(
            self._rate_shift(target), forces, slack, multiplier, velocity, problem.strains(velocity) + self.kinematics
        )

    def _rate_shift(self, target: FloatArray) -> FloatArray:
        shift: FloatArray = target / self.slack - self.point.rates
        shift[self.tight] = 0.0
        return shift

    def _with_rates(
        self,
        rate_shift: FloatArray,
        forces: FloatArray,
        slack: FloatArray,
        multiplier: float,
        velocity: FloatArray,
        strain: FloatArray,
    ) -> Direction:
        slack[self.tight] = 0.0
        return Direction(forces, slack, multiplier, velocity, self._rates(rate_shift, slack, strain))

    def _rates(self, shift: FloatArray, slack: FloatArray, strain: FloatArray) -> FloatArray:
        """Changes of the rates: from the complementarity where that is accurate, else from compatibility E dg = strain.

        Where w = g/y is large, w dy magnifies rounding; compatibility gives dg there without loss.
        """
        ends, ahead, behind = self._by_strain
        rate = shift - self.weight * slack
        forward, backward = rate[:, 2].copy(), rate[:, 3].copy()
        rate[:, 2] = np.where(ahead, strain[:, 2] + backward, forward)
        rate[:, 3] = np.where(behind, forward - strain[:, 2], backward)
        dilation = self.lift * (rate[:, 2] + rate[:, 3])
        rate[:, :2] = np.where(ends, strain[:, :2] - dilation[:, None], rate[:, :2])
        return rate

    def lengths(self, change: Direction, fraction: float) -> tuple[float, float]:
        """Lengths, 1 at most, that take slacks and rates this part of the way to their boundary.

        One length for both where flow is not associated.
        """
        primal = min(1.0, fraction * _longest(self.slack, change.slack))
        dual = min(1.0, fraction * _longest(self.rates, change.rates))
        if self.dilatancy < 1.0:
            primal = dual = min(primal, dual)
        return primal, dual

    def advance(self, change: Direction, primal: float, dual: float) -> Point:
        """The point after a step; the larger shear slack is set from y3 + y4 = 2 mu N, so that no error builds up."""
        point = self.point
        slack = point.slack + primal * change.slack
        if self.problem.law.is_cone:
            self._agree(slack)
        return Point(
            np.where(self.tight, 0.0, slack),
            point.multiplier + primal * change.multiplier,
            point.velocities + dual * change.velocities,
            point.rates + dual * change.rates,
        )

    def length_on(self, change: Direction, fraction: float, growth: float) -> float:
        """Length, 1 at most, of a step on hyperbolas.

        Args:
            change: the whole step.
            fraction: part of the way to where a slack and its rate both vanish that it goes at most.
            growth: greatest relative growth of a slack or rate.
        """
        grows = np.maximum(change.slack / self.slack, change.rates / self.rates)
        return min(1.0, fraction * _longest(np.ones(grows.shape), grows), growth / max(float(grows.max()), growth))

    def advance_on(self, change: Direction, target: FloatArray) -> Point:
        """The point after a change, with the products y o g = target (m, 4) of contacts that are not tight.

        Of a slack and its rate the one that grows more takes the change, the other follows from the product. A contact
        that is to open or close so stays on its hyperbola, which its tangent leaves at once.
        """
        problem, point, tight = self.problem, self.point, self.tight
        slack, rates = point.slack + change.slack, point.rates + change.rates
        slack_grows = change.slack / self.slack >= change.rates / self.rates
        slack = np.where(tight, 0.0, np.where(slack_grows, slack, target / np.where(slack_grows, 1.0, rates)))
        both = 2.0 * problem.law.strength(problem.forces_of_slacks(slack))
        low, ahead = np.minimum(slack[:, 2:].min(axis=1), 0.5 * both), slack[:, 2] <= slack[:, 3]
        shear = np.column_stack([np.where(ahead, low, both - low), np.where(ahead, both - low, low)])
        held = tight[:, 2] | tight[:, 3]
        slack[:, 2:] = np.where(held[:, None], slack[:, 2:], shear)
        rates = np.where(tight, rates, target / np.where(tight, 1.0, slack))
        return Point(slack, point.multiplier + change.multiplier, point.velocities + change.velocities, rates)

    def _agree(self, slack: FloatArray) -> None:
        strength = 2.0 * self.problem.law.strength(slack)  # whose first columns are the normal forces of dry joints
        low = np.minimum(slack[:, 2], slack[:, 3])
        first = slack[:, 2] <= slack[:, 3]
        safe = strength > 2.0 * low
        slack[:, 2] = np.where(safe & ~first, strength - low, slack[:, 2])
        slack[:, 3] = np.where(safe & first, strength - low, slack[:, 3])


def _longest(value: FloatArray, change: FloatArray) -> float:
    steepest = -float((change / value).min(initial=0.0))
    return 1.0 / steepest if steepest > 0.0 else np.inf
