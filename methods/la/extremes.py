"""The extreme multipliers of statics, each with its forces and the dilatant mechanism dual to them, to rounding.

min or max lambda s.t. C' r + f0 + lambda fL = 0, S r >= 0. Both sides are read from one vertex
(`methods.numerics.vertex`), so that neither is nearer to the truth than the other.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from methods.la.problem import Problem
from methods.la.programmes import KinematicSolution, StaticSolution
from methods.numerics.linear_programme import INFINITY, Programme
from methods.numerics.statics import rows_of_blocks, shear_limits, within_yield

SIMPLEX_INTERFACES = 400
"""Interfaces above which the interior point with crossover is quicker than the simplex method."""
COST = 1e4
"""Cost of the multiplier: speeds of the dual mechanism are of this order, far above what HiGHS rounds off."""


@dataclass(frozen=True)
class ExtremeSolution:
    """Forces of the greatest or least multiplier, and the dilatant mechanism dual to them: with or against the load."""

    statics: StaticSolution
    kinematics: KinematicSolution


def extreme(problem: Problem, greatest: bool, solver: str = "auto") -> ExtremeSolution | str:
    """The greatest or, from zero on, the least multiplier of statics; or how the programme ended without one.

    Args:
        problem: the scaled wall.
        greatest: which of the two.
        solver: "simplex", "ipm" (with crossover) or "auto" (by size).
    """
    m, n = problem.n_interfaces, problem.n_velocities
    if solver == "auto":
        solver = "simplex" if m <= SIMPLEX_INTERFACES else "ipm"
    equilibrium = sp.hstack([problem.statics, sp.csr_matrix(problem.live[:, None])])
    limits = sp.hstack([shear_limits(problem.friction), sp.csr_matrix((2 * m, 1))])
    cost = COST * problem.live_work
    programme = Programme(
        sp.csc_matrix(sp.vstack([equilibrium, limits])),
        np.append(np.zeros(3 * m), -cost if greatest else cost),
        (np.append(np.tile([0.0, 0.0, -INFINITY], m), -INFINITY if greatest else 0.0), np.full(3 * m + 1, INFINITY)),
        (np.append(-problem.dead, np.zeros(2 * m)), np.append(-problem.dead, np.full(2 * m, INFINITY))),
    )
    programme.highs.setOptionValue("solver", solver)
    status, _, _ = programme.run()
    if status != "optimal":
        return status
    iterations = programme.iterations()
    vertex = programme.vertex(rows_of_blocks(n // 3, m))
    if vertex is None or not vertex.optimal:
        return "unknown"
    velocities = -vertex.dual[:n]
    slips = vertex.dual[n:].reshape(-1, 2) / np.maximum(problem.friction, 1.0)[:, None]
    rates = np.column_stack([vertex.reduced[:-1].reshape(-1, 3)[:, :2], slips])
    work = abs(float(problem.live @ velocities))
    scale = problem.live_work / work if work > 0.0 else 1.0
    return ExtremeSolution(
        StaticSolution(
            within_yield(vertex.value[:-1].reshape(-1, 3), problem.friction), float(vertex.value[-1]), iterations
        ),
        KinematicSolution(scale * velocities, scale * rates),
    )


def standing(problem: Problem) -> StaticSolution | KinematicSolution | str:
    """Forces that carry the dead load within yield, or the dilatant mechanism that proves that none do; or the end.

    The part of the dead load that need not be carried is least: zero or, because yield is a cone, all of it.
    """
    found = extreme(replace(problem, live=-problem.dead), greatest=False)
    if isinstance(found, str):
        return found
    return found.statics if found.statics.multiplier < 0.5 else found.kinematics
