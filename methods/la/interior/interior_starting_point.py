"""Where interior paths begin: forces that certify the dead load, and a pair of forces and mechanism with a margin.

Forces well within yield come from the path of associated flow, some way before its end. The mechanism of zero-dilatancy
flow that does least work on their slacks is a linear programme; its path is left early too, where every rate is still
positive. Together they meet equilibrium and compatibility, but not y o g = tau: the path goes on with the weights that
they have (Jansen, Roos, Terlaky and Vial 1996), from a far smaller gap than that at which the central path is single.

Forces that certify the dead load come from forces r0 of unit compression without shear, which lie well within yield and
balance some loads h = -C' r0. From there the loads move to the dead load, (1 - t) h + t f0. If the path passes t = 1
within yield, the wall stands, and the forces between the two ends balance f0 exactly.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import FloatArray
from harness.model.joint_law import JointLaw
from methods.la.core.exact import close_tight
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.interior.interior_point import PathSettings, follow_path, start_point
from methods.la.interior.newton_step import Point
from methods.numerics.failures import NumericalFailure

FEASIBLE = 1e-6
"""Scaled residuals of equilibrium and of compatibility at which the paths end."""
_EARLY = 1e-2
"""Relative gap of the kinematic programme at which its path is left; full steps may end below it."""
_LEAST_COST = 1e-9
"""Of a rate, so that none is free to grow."""


def interior_starting_point(problem: Problem, newton: NewtonMatrix, gap: float) -> tuple[Point | None, int]:
    """The pair as one point, or None where either path does not get there, and the Newton steps spent.

    Args:
        problem: the scaled wall.
        newton: its Newton matrix.
        gap: relative gap of the associated path at which its forces are taken; full steps may end below it.
    """
    settings = PathSettings(dilatancy=1.0, gap=gap, residual=FEASIBLE)
    forces = follow_path(problem, newton, start_point(problem), settings)
    if not forces.converged:
        return None, forces.iterations
    slack = forces.point.slack
    cost = slack / float(np.median(slack)) + _LEAST_COST
    programme = kinematic_programme(problem, np.where(close_tight(problem), 0.0, cost))
    settings = PathSettings(dilatancy=1.0, gap=_EARLY, residual=FEASIBLE)
    mechanism = follow_path(programme, newton, start_point(programme), settings)
    steps = forces.iterations + mechanism.iterations
    if not mechanism.converged:
        return None, steps
    return Point(slack, forces.point.multiplier, mechanism.point.velocities, mechanism.point.rates), steps


def kinematic_programme(problem: Problem, cost: FloatArray) -> Problem:
    """The programme min c.g, C u = E g, fL.u = const for costs c (m, 4), as a problem of associated flow.

    It is the dual of max lambda s.t. C' r + lambda fL = 0, E' r + c >= 0: the same wall without dead load, with
    the dilatancy in place of the friction and with the constant parts c.
    """
    dilatancy = problem.law.dilatancy
    return replace(problem, dead=np.zeros_like(problem.dead), law=JointLaw(dilatancy, dilatancy, cost))


def phase_one_forces(problem: Problem, newton: NewtonMatrix, imbalance: float = 1e-9) -> FloatArray | None:
    """Forces (m, 3) in equilibrium with the dead load within yield, or None if the path does not find any.

    Args:
        problem: the scaled wall; newton: its Newton matrix.
        imbalance: largest one, and largest excess over yield, of forces that certify, in mean block weights.
    """
    start = start_point(problem)
    first = problem.forces_of_slacks(start.slack)
    easy = -np.asarray(problem.statics @ first.ravel())
    towards = problem.dead - easy
    if not np.any(towards):
        return first
    moved = replace(problem, dead=easy, live=towards)
    settings = PathSettings(dilatancy=1.0, gap=1e-9, max_iterations=60, above=1.0)
    try:
        result = follow_path(moved, newton, start, settings)
    except NumericalFailure:
        return None
    if not result.point.multiplier >= 1.0:
        return None
    forces = first + (problem.forces_of_slacks(result.point.slack) - first) / result.point.multiplier
    within = float(problem.slacks(forces).min(initial=0.0)) >= -imbalance
    balanced = float(abs(problem.imbalance(forces, 0.0)).max(initial=0.0)) <= imbalance
    return forces if within and balanced else None
