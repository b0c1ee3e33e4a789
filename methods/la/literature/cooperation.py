"""Finite elements and limit analysis together, as Baggio and Trovalusci (1995) propose in their conclusion.

The contact forces r_FE and the multiplier of the finite-element collapse state are projected onto equilibrium and yield
by a quadratic programme (OSQP, polished),

    min |r - r_FE|^2 + m (lambda - lambda_FE)^2   s.t.  C' r + f0 + lambda fL = 0,   S r + s0 >= 0,

with m interfaces. The extreme mechanism nearest to these forces starts the ray descent.
"""

from __future__ import annotations

import numpy as np
import osqp
import scipy.sparse as sp

from harness.model.assembly import FloatArray
from harness.model.joint_law import block_diagonal
from methods.la.core.problem import Problem


def project_forces(problem: Problem, forces: FloatArray, multiplier: float) -> tuple[FloatArray, float, bool]:
    """The nearest forces (m, 3) in equilibrium within yield, their multiplier, and whether OSQP solved it.

    Args:
        problem: the scaled wall.
        forces: (m, 3) scaled contact forces.
        multiplier: scaled multiplier they belong to.
    """
    m = problem.n_interfaces
    rows = block_diagonal(problem.law.rows)
    slacks = sp.hstack([rows, sp.csr_matrix((rows.shape[0], 1))])
    equilibrium = sp.hstack([problem.statics, sp.csr_matrix(problem.live[:, None])])
    target = np.append(forces.ravel(), multiplier)
    weight = np.append(np.ones(3 * m), float(m))
    solver = osqp.OSQP()
    solver.setup(
        P=sp.diags(weight).tocsc(),
        q=-weight * target,
        A=sp.csc_matrix(sp.vstack([equilibrium, slacks])),
        l=np.append(-problem.dead, np.zeros(rows.shape[0])),
        u=np.append(-problem.dead, np.full(rows.shape[0], np.inf)),
        eps_abs=1e-8,
        eps_rel=1e-8,
        max_iter=20000,
        polishing=True,
        verbose=False,
    )
    result = solver.solve(raise_error=False)
    value = np.asarray(result.x, dtype=float)
    if result.info.status_val not in (1, 2) or not np.all(np.isfinite(value)):
        return forces, multiplier, False
    return value[:-1].reshape(-1, 3), float(value[-1]), True
