"""The greatest multiplier of statics alone: the linear programme of associated limit analysis, with its mechanism.

max lambda s.t. C' r + f0 + lambda fL = 0, S r >= 0 (Livesley 1978). Its dual gives velocities with dilatant flow,
C u = S' g, fL.u = 1, of value -f0.u; we compare the two values ourselves.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from harness.model.assembly import FloatArray
from methods.la.exact import exact_forces
from methods.la.interior_point import PathSettings, follow_path, start_point
from methods.la.newton_matrix import NewtonMatrix
from methods.la.newton_step import Point
from methods.la.problem import Problem
from methods.la.programmes import KinematicProgramme, StaticProgramme, StaticSolution
from methods.la.state import CollapseState, moving_contacts, polished, residuals, tight_contacts

SIMPLEX_INTERFACES = 400
"""Interfaces above which the interior point is quicker, and closes a gap that simplex leaves at 5e-9."""
MOST_SIMPLEX_INTERFACES = 8000
"""Interfaces above which simplex is not tried either where the interior point ends early."""
GAP = 1e-12
"""Complementarity y.g relative to the live work at which the path ends."""


@dataclass(frozen=True)
class AssociatedResult:
    """The outcome: "optimal" with a state, or "infeasible" (no equilibrium at any multiplier), "unbounded", "unknown".

    Attributes:
        outcome: as above.
        state: forces and dilatant mechanism, scaled; or None.
        gap: |static - kinematic| / max(1, |static|), scaled multipliers.
        iterations: of the solver.
    """

    outcome: str
    state: CollapseState | None = None
    gap: float = float("inf")
    iterations: int = 0

    @property
    def greatest(self) -> float:
        """The multiplier (scaled) that no collapse state is above; infinite if none is known."""
        return float("inf") if self.state is None else self.state.multiplier


def solve_associated(problem: Problem, newton: NewtonMatrix, solver: str = "auto") -> AssociatedResult:
    """The greatest statically admissible multiplier.

    There is none where forces within yield bear the live load alone: any multiple of them may be added.

    Args:
        problem: the scaled wall.
        newton: its Newton matrix, used to polish and by the interior point.
        solver: "highs", "interior" or "auto" (by size).
    """
    if solver == "interior" or (solver == "auto" and problem.n_interfaces > SIMPLEX_INTERFACES):
        result = _by_interior_point(problem, newton)
        if result.outcome == "optimal" and result.gap <= 1e-9:
            return result
        if result.outcome != "optimal" and _bears_live_load_alone(problem):
            return AssociatedResult("unbounded", iterations=result.iterations)
        if solver == "interior" or problem.n_interfaces > MOST_SIMPLEX_INTERFACES:
            return result
    return _by_highs(problem, newton)


def _bears_live_load_alone(problem: Problem) -> bool:
    with suppress(RuntimeError):
        return isinstance(StaticProgramme(replace(problem, dead=problem.live)).stands_at(0.0), StaticSolution)
    return False


def _by_highs(problem: Problem, newton: NewtonMatrix) -> AssociatedResult:
    programme = StaticProgramme(problem)
    solution = programme.solve(greatest=True)
    if isinstance(solution, str):
        return AssociatedResult(solution)
    return with_mechanism(problem, newton, solution.forces, solution.multiplier, solution.iterations)


def with_mechanism(
    problem: Problem, newton: NewtonMatrix, forces: FloatArray, multiplier: float, iterations: int
) -> AssociatedResult:
    """The result of optimal forces: a dilatant mechanism in their tight contacts, polished and compared."""
    slack = np.maximum(problem.slacks(forces), 0.0)
    programme = KinematicProgramme(problem, associated=True)
    mechanism = programme.solve(tight_contacts(problem, forces), np.ones_like(slack))
    if mechanism is None:
        mechanism = programme.solve(np.ones(slack.shape, dtype=bool), slack)
    if mechanism is None:
        return AssociatedResult("unknown", iterations=iterations)
    state = CollapseState(forces, multiplier, mechanism.velocities, moving_contacts(mechanism.rates), associated=True)
    state = polished(problem, newton, state)
    return AssociatedResult("optimal", state, duality_gap(problem, state), iterations)


def duality_gap(problem: Problem, state: CollapseState) -> float:
    """Distance of the static multiplier from the kinematic one of the same state, relative to max(1, |multiplier|)."""
    kinematic = -float(problem.dead @ state.velocities) / float(problem.live @ state.velocities)
    return abs(state.multiplier - kinematic) / max(1.0, abs(state.multiplier))


def _by_interior_point(problem: Problem, newton: NewtonMatrix) -> AssociatedResult:
    result = follow_path(problem, newton, start_point(problem), PathSettings(dilatancy=1.0, gap=GAP, residual=1e-3))
    if not result.gap < 1e-4 or result.statics > 0.1:
        return AssociatedResult("unknown", iterations=result.iterations)
    point = result.point
    best: CollapseState | None = None
    merit = float("inf")
    for bias in (1e6, 1e3, 1.0, 1e9):
        state = from_path(problem, newton, point, bias)
        if state is None:
            continue
        size = max(residuals(problem, state).values())
        if size < merit:
            best, merit = state, size
        if merit < GAP:
            break
    if best is None:
        return AssociatedResult("unknown", iterations=result.iterations)
    return AssociatedResult("optimal", best, duality_gap(problem, best), result.iterations)


def from_path(problem: Problem, newton: NewtonMatrix, point: Point, bias: float) -> CollapseState | None:
    """The end of an associated path with its forces brought into equilibrium; its mechanism is exact as it is.

    Slacks with g > bias y are set to zero; the others change in proportion to their size.
    """
    try:
        forces, multiplier = exact_forces(
            problem,
            newton,
            problem.forces_of_slacks(point.slack),
            point.multiplier,
            point.rates > bias * point.slack,
            floor=1e-14,
        )
    except RuntimeError:
        return None
    return CollapseState(forces, multiplier, point.velocities, point.rates > point.slack, associated=True)


def solve_with_cvxpy(problem: Problem, solver: str) -> tuple[str, FloatArray | None, float]:
    """The same programme written for reading: (outcome, forces (m, 3), multiplier), scaled."""
    import cvxpy

    m = problem.n_interfaces
    forces: Any = cvxpy.Variable((m, 3))
    multiplier: Any = cvxpy.Variable()
    normal, shear = forces[:, 0:2], forces[:, 2]
    strength = cvxpy.multiply(problem.friction, normal[:, 0] + normal[:, 1])
    flat = cvxpy.vec(forces, order="C")
    programme = cvxpy.Problem(
        cvxpy.Maximize(multiplier),
        [
            problem.statics @ flat + problem.dead + multiplier * problem.live == 0,
            normal >= 0,
            strength + shear >= 0,
            strength - shear >= 0,
        ],
    )
    programme.solve(solver=solver)
    outcome = {"optimal": "optimal", "infeasible": "infeasible", "unbounded": "unbounded"}.get(
        programme.status, "unknown"
    )
    if outcome != "optimal":
        return outcome, None, float("nan")
    return outcome, np.asarray(forces.value, dtype=float), float(multiplier.value)
