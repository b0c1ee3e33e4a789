"""The method `la-associated`: max lambda s.t. C' r + f0 + lambda fL = 0, S r + s0 >= 0 (Livesley 1978).

`methods.la.interior.associated` solves it with its dual. This module loads no compiled code.
"""

from __future__ import annotations

import warnings
from functools import partial
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.errors import optional
from harness.model.joint_law import block_diagonal
from harness.model.method import Answer
from methods.la.answers import collapse_answer, not_converged, unbounded_answer
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.family import LimitAnalysisFamily
from methods.la.interior.associated import (
    AssociatedResult,
    EndOfPath,
    solve_associated,
    solve_with_cvxpy,
    with_mechanism,
)
from methods.numerics.stress_blocks import (
    BlockLimit,
    Greatest,
    crushing_force,
    greatest_by_chords,
    kinematic_multiplier,
)

_TOLERANCE = 1e-9
"""Greatest relative difference of the static and the kinematic multiplier, and residual, of an answer."""


class AssociatedLimitAnalysis(LimitAnalysisFamily):
    """Greatest multiplier of statics, the linear programme of associated limit analysis (`la-associated`).

    Args:
        end: of its own interior point.
    """

    gives_most = True

    def __init__(self, end: EndOfPath = EndOfPath()) -> None:
        self._end = end

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The linear programme by simplex or interior point."""
        return _associated_answer(problem, solve_associated(problem, newton, settings.solver, self._end))

    def greatest(self, settings: Any) -> Greatest:
        """Linear programmes with chords and tangents of the stress blocks."""
        return greatest_by_chords


class AssociatedLimitAnalysisCvxpy(LimitAnalysisFamily):
    """The same linear programme written in cvxpy, to be read beside the formulas (`la-associated-cvxpy`)."""

    gives_most = True

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """The linear programme through cvxpy; its mechanism is found as for `la-associated`."""
        outcome, forces, multiplier = solve_with_cvxpy(problem, settings.solver)
        if forces is None:
            return _associated_answer(problem, AssociatedResult(outcome))
        return _associated_answer(problem, with_mechanism(problem, newton, forces, multiplier))

    def greatest(self, settings: Any) -> Greatest:
        """The programme of cones."""
        return partial(_greatest_by_cones, solver=settings.cone_solver)


def _associated_answer(problem: Problem, result: AssociatedResult) -> Answer:
    """The answer that belongs to the outcome of the associated programme."""
    if result.outcome == "unbounded":
        return unbounded_answer(
            "Statically the live load can grow without limit: it cannot make the wall collapse under associated flow.",
            result.iterations,
        )
    if result.state is None:
        return not_converged(f"The linear programme ended as {result.outcome}.", result.iterations)
    if not result.gap <= _TOLERANCE:
        return not_converged(
            f"The static and the kinematic multiplier differ by {result.gap:.2g}, more than {_TOLERANCE:.2g}.",
            result.iterations,
        )
    multiplier = problem.to_multiplier(result.state.multiplier)
    return collapse_answer(
        problem,
        result.state,
        f"The greatest multiplier within statics and yield is {multiplier:.7g}, an upper bound whatever the flow.",
        _TOLERANCE,
        result.iterations,
        {"duality_gap": result.gap, "unknowns": 3 * problem.n_interfaces + 1},
    )


def _greatest_by_cones(
    assembly: Assembly, dead: FloatArray, live: FloatArray, most: float = np.inf, solver: str = "CLARABEL"
) -> BlockLimit:
    """The greatest multiplier up to `most` of live (n, 3) beside dead (n, 3), by a solver of cone programmes."""
    cvxpy = optional("cvxpy", "cvxpy", "method la-associated-cvxpy")
    m, n = assembly.n_interfaces, assembly.n_free
    column = assembly.velocity_units()
    own, acting = dead[assembly.free].ravel() * column, live[assembly.free].ravel() * column
    unit = (float(abs(own).sum()) or float(abs(acting).sum())) / n
    per_unit = unit * n / float(abs(acting).sum())
    law = assembly.law.in_units(unit)
    joints, full = crushing_force(assembly)
    tension = 2.0 * law.constant[joints, 0]
    forces: Any = cvxpy.Variable((m, 3))
    multiplier: Any = cvxpy.Variable()
    flat = cvxpy.vec(forces, order="C")
    statics = (assembly.kinematic_matrix.toarray() * column).T
    balance = statics @ flat + own / unit + multiplier * (acting * (per_unit / unit)) == 0
    pressed = cvxpy.multiply(forces[joints, 0] + forces[joints, 1] + tension, np.sqrt(unit / (2.0 * full)))
    blocks = [cvxpy.square(pressed) <= forces[joints, end] + 0.5 * tension for end in (0, 1)]
    yields = block_diagonal(law.rows) @ flat + law.constant.ravel() >= 0
    limit = [multiplier <= most / per_unit] if most < np.inf else []
    programme = cvxpy.Problem(cvxpy.Maximize(multiplier), [balance, yields, *blocks, *limit])
    with warnings.catch_warnings():  # cvxpy warns of a status that is looked at here
        warnings.filterwarnings("ignore", message="Solution may be inaccurate", category=UserWarning)
        # the judge holds the forces to 1e-9
        fine = {"tol_gap_abs": 1e-12, "tol_gap_rel": 1e-12, "tol_feas": 1e-12, "tol_ktratio": 1e-9}
        programme.solve(solver=solver, **(fine if solver == "CLARABEL" else {}))
    outcome = {"optimal": "optimal", "optimal_inaccurate": "optimal"}.get(programme.status, programme.status)
    if outcome != "optimal":
        return BlockLimit(outcome if outcome in ("infeasible", "unbounded") else "unknown")
    motion = np.zeros((assembly.n_blocks, 3))
    motion[assembly.free] = (np.asarray(balance.dual_value) * column).reshape(-1, 3)
    motion *= np.sign((live * motion).sum()) or 1.0
    above = kinematic_multiplier(assembly, motion, dead, live)
    found = np.asarray(forces.value, dtype=float) * unit
    rough = programme.status != "optimal"
    return BlockLimit("optimal", float(multiplier.value) * per_unit, found, motion, above, inaccurate=rough)
