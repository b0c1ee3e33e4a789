"""Whether a wall stands under its dead load, from forces that certify it, by the interior point.

Forces r0 of unit compression without shear lie well within yield and balance some loads h = -C' r0. From there the
loads move to the dead load, (1 - t) h + t f0. If the path passes t = 1 within yield, the wall stands, and the forces
between the two ends balance f0 exactly. The start is feasible, so a dozen Newton steps do on walls of any size.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import FloatArray
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.interior.interior_point import PathSettings, follow_path, start_point
from methods.numerics.failures import NumericalFailure


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
