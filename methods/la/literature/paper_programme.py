"""The programme (8)-(11) of Baggio and Trovalusci (1995) in its reduced unknowns (lambda, r2, m).

The interfaces are split into a kinematically determined system of n joints (B1, square and regular) and the others
(B2). The strains of the first give the velocities, u = A0 q1 with A0 = B1^-1, and the forces of the others give those
of the first, r1 = -(A' r2 + A0' f) with A = B2 A0 and f = f0 + lambda fL. The programme is

    min lambda   s.t.  (A M1 - M2) m = 0,   y = S r(lambda, r2) >= 0,   y.m = 0,   (A0 M1 m).fL = 1,   lambda, m >= 0

with 1 + 3 (m - n) + 4 m unknowns. Gradients are exact; Ipopt solves a sequence of relaxations y.m <= epsilon.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra

from harness.model.assembly import FloatArray, IntArray
from harness.model.joint_law import block_diagonal
from methods.la.core.problem import Problem
from methods.numerics.failures import sparse_lu
from methods.numerics.optional import optional

_FASTEST = 1e3
"""Bound on the rates at a mean live displacement of one; without it Ipopt's tolerances admit rates of any size."""


@dataclass(frozen=True)
class PaperResult:
    """Scaled forces (m, 3), multiplier and rates (m, 4), the number of unknowns, iterations and Ipopt's last word."""

    forces: FloatArray
    multiplier: float
    rates: FloatArray
    unknowns: int
    iterations: int
    message: str


def _determined_system(problem: Problem) -> IntArray:
    """(n,) interfaces of a kinematically determined system: every block hangs on the supports by one chain of joints.

    The chains prefer joints that face gravity over head joints, and of the two halves of a bed joint the one towards
    which the live load pushes, as the paper guesses the statically active joints of a wall pushed sideways.

    Raises:
        ValueError: a block has no chain of joints to a support.
    """
    assembly = problem.assembly
    nodes = np.where(assembly.fixed, 0, np.cumsum(~assembly.fixed))
    tail, head = nodes[assembly.block_a], nodes[assembly.block_b]
    push = assembly.live[:, :2].sum(axis=0)
    push = push / (np.linalg.norm(push) or 1.0)
    middle = 0.5 * (assembly.end1 + assembly.end2)
    upper = np.where(
        assembly.centroid[assembly.block_a][:, 1] > assembly.centroid[assembly.block_b][:, 1],
        assembly.block_a,
        assembly.block_b,
    )
    side = ((middle - assembly.centroid[upper]) @ push) / problem.unit_length
    cost = 1.0 + 4.0 * (1.0 - abs(assembly.normal[:, 1])) - 0.2 * np.tanh(side)
    best: dict[tuple[int, int], int] = {}
    for p in np.argsort(cost, kind="stable").tolist():
        best.setdefault((min(tail[p], head[p]), max(tail[p], head[p])), p)
    keys = [key for key in best if key[0] != key[1]]
    chosen = np.array([best[key] for key in keys])
    first, second = np.array(keys).T
    size = assembly.n_free + 1
    graph = sp.csr_matrix((cost[chosen], (first, second)), shape=(size, size))
    _, before = dijkstra(csgraph=graph, directed=False, indices=np.int64(0), return_predecessors=True)  # type: ignore[call-overload]
    if np.any(before[1:] < 0):
        raise ValueError("a block has no chain of joints to a support")
    return np.array([best[(min(k, int(before[k])), max(k, int(before[k])))] for k in range(1, size)])


def solve_paper_programme(
    problem: Problem, start_forces: FloatArray | None, max_iterations: int, epsilons: tuple[float, ...]
) -> PaperResult:
    """A local solution of the programme.

    Args:
        problem: the scaled wall.
        start_forces: (m, 3) whose r2 starts the programme, or None for the paper's r2 = 0.
        max_iterations: of Ipopt, for each relaxation.
        epsilons: bounds of y.m relative to the live work, decreasing.
    """
    casadi = optional("casadi", "paper", "la-paper")

    m, first = problem.n_interfaces, np.sort(_determined_system(problem))
    second = np.setdiff1d(np.arange(m), first)
    rows1, rows2 = ((3 * part[:, None] + np.arange(3)).ravel() for part in (first, second))
    b1, b2 = problem.kinematic[rows1].tocsc(), problem.kinematic[rows2].tocsc()
    inverse = sparse_lu(b1).solve(np.eye(len(rows1)))
    transfer = np.where(abs(b2 @ inverse) > 1e-13, b2 @ inverse, 0.0)
    flow = block_diagonal(problem.law.flow)
    m1, m2 = flow[rows1].toarray(), flow[rows2].toarray()
    compatibility = transfer @ m1 - m2
    live_row = (inverse.T @ problem.live) @ m1 / problem.live_work

    multiplier = casadi.SX.sym("multiplier")
    second_forces = casadi.SX.sym("r2", len(rows2))
    rates = casadi.SX.sym("m", 4 * m)
    load = _matrix(casadi, inverse.T)
    first_forces = -(_matrix(casadi, transfer.T) @ second_forces) - load @ (problem.dead + multiplier * problem.live)
    forces = casadi.SX.zeros(3 * m)
    forces[rows1.tolist()] = first_forces
    forces[rows2.tolist()] = second_forces
    slack = _matrix(casadi, block_diagonal(problem.law.rows).toarray()) @ forces
    work = casadi.dot(slack, rates) / problem.live_work
    constraints = casadi.vertcat(
        _matrix(casadi, compatibility) @ rates, slack, work, _matrix(casadi, live_row[None, :]) @ rates - 1.0
    )
    unknowns = casadi.vertcat(multiplier, second_forces, rates)
    options: Any = {
        "ipopt.print_level": 0,
        "print_time": 0,
        "ipopt.sb": "yes",
        "ipopt.max_iter": max_iterations,
        "ipopt.tol": 1e-9,
    }
    programme: Any = {"x": unknowns, "f": multiplier, "g": constraints}
    solver = casadi.nlpsol("paper", "ipopt", programme, options)
    lower = np.concatenate([[0.0], np.full(len(rows2), -np.inf), np.zeros(4 * m)])
    upper = np.concatenate([np.full(1 + len(rows2), np.inf), np.full(4 * m, _FASTEST)])
    start = np.concatenate([[0.0], np.zeros(len(rows2)), np.full(4 * m, 0.1)])
    if start_forces is not None:
        start[1 : 1 + len(rows2)] = start_forces.ravel()[rows2]
    evaluate = casadi.Function("forces", [unknowns], [forces])
    iterations, message = 0, ""
    equalities = np.zeros(len(rows2))
    for epsilon in epsilons:
        found = solver(
            x0=start,
            lbx=lower,
            ubx=upper,
            lbg=np.concatenate([equalities, np.zeros(4 * m), [-np.inf, 0.0]]),
            ubg=np.concatenate([equalities, np.full(4 * m, np.inf), [epsilon, 0.0]]),
        )
        start = np.asarray(found["x"]).ravel()
        statistics = solver.stats()
        iterations += int(statistics["iter_count"])
        message = str(statistics["return_status"])
    solved = np.asarray(evaluate(start)).reshape(-1, 3)
    return PaperResult(solved, float(start[0]), start[1 + len(rows2) :].reshape(-1, 4), len(start), iterations, message)


def _matrix(casadi: Any, dense: FloatArray) -> Any:
    return casadi.sparsify(casadi.DM(dense))
