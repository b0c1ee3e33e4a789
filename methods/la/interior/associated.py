"""The greatest multiplier of statics alone: the linear programme of associated limit analysis, with its mechanism.

max lambda s.t. C' r + f0 + lambda fL = 0, S r + s0 >= 0 (Livesley 1978). Its dual gives velocities with dilatant flow,
C u = S' g, fL.u = 1, of value s0.g - f0.u; we compare the two values ourselves. Both are read from one vertex, computed
to rounding (`methods.numerics.vertex`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from harness.model.assembly import FloatArray
from harness.model.errors import optional
from harness.model.joint_law import block_diagonal
from methods.la.core.exact import exact_forces, exact_mechanism
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.core.programmes import KinematicProgramme, StaticSolution
from methods.la.core.state import CollapseState, moving_contacts, polished, residuals, tight_contacts
from methods.la.core.vertex_programmes import force_programme, standing
from methods.la.interior.interior_point import PathSettings, follow_path, start_point
from methods.la.interior.newton_step import Point
from methods.numerics.failures import NumericalFailure


@dataclass(frozen=True)
class EndOfPath:
    """When the own interior point is used for the programme, and what is made of its end.

    Attributes:
        above: interfaces above which it is faster than the simplex method and comes first.
        gap: complementarity y.g relative to the live work at which the path ends; the multiplier is known to that.
        exact: residual of a state, and slack or rate of a contact that has both, up to which one is taken.
        biases: ratios g / y above which a slack counts as zero and below which a rate does, tried in turn. Where a
            contact neither presses nor moves, both fall with the root of the gap: a small ratio, near that root, holds
            its slack at zero and leaves it its rate. A great one leaves the forces freedom where a mechanism is slow.
    """

    above: int = 160
    gap: float = 1e-14
    exact: float = 1e-11
    biases: tuple[float, ...] = (1e-7, 1e-4, 1.0, 1e3, 1e6)


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


def solve_associated(
    problem: Problem, newton: NewtonMatrix, solver: str = "auto", end: EndOfPath = EndOfPath()
) -> AssociatedResult:
    """The greatest statically admissible multiplier.

    There is none where forces within yield bear the live load alone: any multiple of them may be added.

    Args:
        problem: the scaled wall.
        newton: its Newton matrix, for the interior point.
        solver: "highs" (simplex), "interior" (own interior point, and a vertex where its end is not clear) or "auto"
            (by size).
        end: of its own interior point.
    """
    if solver == "interior" or (solver == "auto" and problem.n_interfaces > end.above):
        result = by_interior_point(problem, newton, end)
        if result is not None:
            return result
    found = force_programme(problem).extreme(greatest=True, solver="simplex" if solver == "highs" else "auto")
    if isinstance(found, str):
        if _bears_live_load_alone(problem):
            return AssociatedResult("unbounded")
        return AssociatedResult("unknown" if found == "unbounded" else found)  # HiGHS alone is no proof
    statics, mechanism = found.statics, found.kinematics
    moving = moving_contacts(mechanism.rates)
    state = CollapseState(statics.forces, statics.multiplier, mechanism.velocities, moving, associated=True)
    return AssociatedResult("optimal", state, _duality_gap(problem, state), statics.iterations)


def _bears_live_load_alone(problem: Problem) -> bool:
    """Whether forces bear the live load that may be added to others within yield any number of times."""
    alone = replace(problem, dead=problem.live, law=problem.law.without_constant)
    return isinstance(standing(alone), StaticSolution)


def with_mechanism(problem: Problem, newton: NewtonMatrix, forces: FloatArray, multiplier: float) -> AssociatedResult:
    """The result of optimal forces: a dilatant mechanism in their tight contacts, polished and compared."""
    slack = np.maximum(problem.slacks(forces), 0.0)
    programme = KinematicProgramme(problem, associated=True)
    mechanism = programme.solve(tight_contacts(problem, forces), np.ones_like(slack))
    if mechanism is None:
        mechanism = programme.solve(np.ones(slack.shape, dtype=bool), slack)
    if mechanism is None:
        return AssociatedResult("unknown")
    state = CollapseState(forces, multiplier, mechanism.velocities, moving_contacts(mechanism.rates), associated=True)
    state = polished(problem, newton, state)
    return AssociatedResult("optimal", state, _duality_gap(problem, state))


def _duality_gap(problem: Problem, state: CollapseState) -> float:
    """Distance of the static multiplier from the kinematic one of the same state, relative to max(1, |multiplier|)."""
    rates = problem.rates_of_velocities(state.velocities, associated=True)
    spent = problem.law.dissipation(rates) - float(problem.dead @ state.velocities)
    kinematic = spent / float(problem.live @ state.velocities)
    return abs(state.multiplier - kinematic) / max(1.0, abs(state.multiplier))


def by_interior_point(problem: Problem, newton: NewtonMatrix, end: EndOfPath) -> AssociatedResult | None:
    """The end of the central path made exact, or None where neither it nor its own motion proves the multiplier.

    Where it is not clear which contacts press and which move, exact forces beside the motion of the path do: both are
    feasible to rounding, so that the difference of their multipliers bounds the error of either (weak duality).
    """
    try:
        result = follow_path(problem, newton, start_point(problem), PathSettings(1.0, gap=end.gap, residual=1e-3))
    except NumericalFailure:
        return None
    if not result.gap < 1e-4 or result.statics > 0.1:
        return None
    for bias in end.biases:
        state = _from_path(problem, newton, result.point, bias)
        clear = None if state is None else _at_rest_elsewhere(problem, newton, state)
        for found in (clear, state):
            if found is not None and _unclear(problem, found) <= end.exact:
                return AssociatedResult("optimal", found, _duality_gap(problem, found), result.iterations)
    return None


def _from_path(problem: Problem, newton: NewtonMatrix, point: Point, bias: float) -> CollapseState | None:
    """The end of an associated path with exact forces, whose slacks with g > bias y vanish, and the motion it has."""
    tight = point.rates > bias * point.slack
    work = float(problem.live @ point.velocities)
    if not work > 0.0:
        return None
    try:
        forces, multiplier = exact_forces(
            problem, newton, problem.forces_of_slacks(point.slack), point.multiplier, tight, floor=1e-14
        )
    except NumericalFailure:
        return None
    velocities = point.velocities * (problem.live_work / work)
    return CollapseState(forces, multiplier, velocities, tight, associated=True)


def _at_rest_elsewhere(problem: Problem, newton: NewtonMatrix, state: CollapseState) -> CollapseState | None:
    """The state with exactly no rates but in its moving contacts; None if there is no such mechanism."""
    try:
        return replace(state, velocities=exact_mechanism(problem, newton, state.velocities, state.moving, True))
    except NumericalFailure:
        return None


def _unclear(problem: Problem, state: CollapseState) -> float:
    """The largest residual of a state, and the largest slack or rate, whichever is less, of a contact that has both."""
    slack = problem.slacks(state.forces)
    rates = problem.rates_of_velocities(state.velocities, associated=True)
    both = np.minimum(abs(slack), abs(rates) / float(abs(state.velocities).max(initial=0.0) or 1.0))
    return max(float(both.max(initial=0.0)), *residuals(problem, state).values())


def solve_with_cvxpy(problem: Problem, solver: str) -> tuple[str, FloatArray | None, float]:
    """The same programme written for reading: (outcome, forces (m, 3), multiplier), scaled."""
    cvxpy = optional("cvxpy", "cvxpy", "method la-associated-cvxpy")

    m = problem.n_interfaces
    forces: Any = cvxpy.Variable((m, 3))
    multiplier: Any = cvxpy.Variable()
    flat = cvxpy.vec(forces, order="C")
    programme = cvxpy.Problem(
        cvxpy.Maximize(multiplier),
        [
            problem.statics @ flat + problem.dead + multiplier * problem.live == 0,
            block_diagonal(problem.law.rows) @ flat + problem.law.constant.ravel() >= 0,
        ],
    )
    programme.solve(solver=solver)
    outcome = {"optimal": "optimal", "infeasible": "infeasible", "unbounded": "unbounded"}.get(
        programme.status, "unknown"
    )
    if outcome != "optimal":
        return outcome, None, float("nan")
    return outcome, np.asarray(forces.value, dtype=float), float(multiplier.value)
