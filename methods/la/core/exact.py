"""Approximate collapse states made exact to rounding: forces on their active set, mechanisms on their contacts.

Forces: y_k is set to zero where it is tight, and equilibrium restored by the smallest change relative to the other
slacks. Mechanisms: strains are removed from all contacts that do not move, by the smallest change of velocities.
Both are one factorisation of the matrix of the interior point with repeated refinement.
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.core.flexibility import Compliance
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.numerics.failures import NumericalFailure, SingularMatrix

RIGID = 1e40
"""Weight of a slack that may not change."""

_PENALTY = 1e13
"""Stiffness of contacts that may not move, against a unit stiffness of the velocities; near-singular sets need it."""

_DIVERGED = 1e100
"""Velocities above this come from a matrix singular to rounding; their products would overflow."""


def close_tight(problem: Problem, tight: BoolArray | None = None) -> BoolArray:
    """Tight slacks (m, 4), by default none, with those that follow.

    In a dry joint no normal force means no shear, and both shear limits mean no force; without friction and cohesion
    there is no shear.
    """
    closed = np.zeros((problem.n_interfaces, 4), dtype=bool) if tight is None else tight.copy()
    closed[problem.rigid_in_shear, 2:] = True
    both = closed[:, 2] & closed[:, 3] & ~problem.rigid_in_shear
    closed[both & problem.law.dry] = True
    closed[closed[:, 0] & closed[:, 1] & problem.law.dry] = True
    return closed


def _snap(problem: Problem, forces: FloatArray, tight: BoolArray) -> FloatArray:
    """Forces (m, 3) with the tight slacks exactly zero and no slack negative."""
    law = problem.law
    normal = np.where(tight[:, :2], law.least_normal, np.maximum(forces[:, :2], law.least_normal))
    least, greatest = law.shear_range(normal)
    shear = np.clip(forces[:, 2], least, greatest)
    shear = np.where(tight[:, 2], least, np.where(tight[:, 3], greatest, shear))
    return np.column_stack([normal, shear])


def exact_forces(
    problem: Problem,
    newton: NewtonMatrix,
    forces: FloatArray,
    multiplier: float,
    tight: BoolArray,
    rounds: int = 6,
    floor: float = 1e-9,
) -> tuple[FloatArray, float]:
    """Forces (m, 3) and multiplier in equilibrium to rounding with the tight slacks (m, 4) zero, near the given ones.

    Args:
        problem: the scaled wall.
        newton: its Newton matrix.
        forces: (m, 3) approximate forces.
        multiplier: approximate multiplier.
        tight: (m, 4) slacks to hold at zero.
        rounds: refinements of each of two passes.
        floor: least size of a slack in the measure of change, relative to the largest.

    Raises:
        SingularMatrix: the equilibrium matrix is singular to rounding.
    """
    tight = close_tight(problem, tight)
    best: tuple[float, FloatArray, float] | None = None
    for _ in range(2):
        current = _snap(problem, forces, tight)
        slack = problem.slacks(current)
        least = floor * max(float(slack.max(initial=0.0)), 1e-9)
        weight = np.where(tight, RIGID, 1.0 / np.maximum(slack, least) ** 2)
        compliance = Compliance(problem.law, weight, problem.friction)
        factor = newton.factorise(compliance.matrices, 1e-13)
        by_live = factor.solve(problem.live)
        stiffness = float(problem.live @ by_live)
        for _ in range(rounds):
            residual = problem.imbalance(current, multiplier)
            size = float(abs(residual).max())
            if best is None or size < best[0]:
                best = (size, current, multiplier)
            velocity = factor.solve(residual)
            change = -float(problem.live @ velocity) / stiffness if stiffness > 0.0 else 0.0
            velocity = velocity + change * by_live
            if not float(abs(velocity).max(initial=0.0)) < _DIVERGED:
                break
            shift = -compliance.forces(problem.strains(velocity))
            current, multiplier = _snap(problem, current + shift, tight), multiplier + change
        forces = current
        del factor  # of a large wall, memory that the next one takes
    assert best is not None
    return best[1], best[2]


def exact_mechanism(
    problem: Problem, newton: NewtonMatrix, velocities: FloatArray, moving: BoolArray, associated: bool
) -> FloatArray:
    """Velocities (3n,) whose strains vanish to rounding wherever no contact (m, 4) moves, near the given ones.

    Raises:
        SingularMatrix: the kinematic matrix is singular to rounding.
        NumericalFailure: no mechanism with live work moves in these contacts only.
    """
    still = np.column_stack([~moving[:, 0], ~moving[:, 1], ~(moving[:, 2] | moving[:, 3])]).astype(float)
    transform = np.tile(np.eye(3), (problem.n_interfaces, 1, 1))
    sense = np.where(moving[:, 2], 1.0, np.where(moving[:, 3], -1.0, 0.0)) * problem.flow_law(associated).dilatancy
    transform[:, 0, 2] = transform[:, 1, 2] = -sense
    stiff = np.einsum("pki,pk,pkj->pij", transform, still, transform)
    factor = newton.factorise(stiff * _PENALTY, 0.0, shift=1.0)
    least = np.inf
    for _ in range(30):
        if not float(abs(velocities).max(initial=0.0)) < _DIVERGED:
            raise SingularMatrix("the kinematic matrix is singular to rounding")
        strain = np.einsum("pij,pj->pi", stiff, problem.strains(velocities))
        size = float(abs(strain).max(initial=0.0))
        if size > 0.5 * least and size < 1e-14 * float(abs(velocities).max(initial=0.0)):
            break
        least = min(least, size)
        velocities = velocities - factor.solve(_PENALTY * np.asarray(problem.statics @ strain.ravel()))
    if not float(abs(velocities).max(initial=0.0)) < _DIVERGED:
        raise SingularMatrix("the kinematic matrix is singular to rounding")
    work = float(problem.live @ velocities)
    if work <= 1e-6 * problem.live_work:
        raise NumericalFailure("no mechanism with live work moves in these contacts only")
    return velocities * (problem.live_work / work)
