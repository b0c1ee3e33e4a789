"""The sequence of linear programmes with the friction bound of the previous iterate (Gilbert, Casapulla, Ahmed 2006).

With the bound c of shear held, iterate k solves

    max lambda   s.t.  C' r + f0 + lambda fL = 0,   n1, n2 >= 0,   -c <= s <= c,

whose mechanism slips without dilatancy, and c moves towards mu (n1 + n2) of its forces by a given weight. A fixed point
is a collapse state of zero dilatancy, but seldom a low one: a baseline of the literature.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import FloatArray
from methods.la.core.problem import Problem
from methods.numerics.linear_programme import INFINITY, Programme


@dataclass(frozen=True)
class TrescaResult:
    """Scaled forces (m, 3) and multiplier of the last iterate, the multipliers of all, and how it ended."""

    forces: FloatArray | None
    multiplier: float
    history: list[float]
    change: float
    outcome: str


def tresca_sequence(
    problem: Problem, forces: FloatArray, max_iterations: int, weight: float, tolerance: float
) -> TrescaResult:
    """The sequence from given forces.

    Args:
        problem: the scaled wall.
        forces: (m, 3) whose normal forces give the first bound.
        max_iterations: programmes at most.
        weight: part of the new normal force in the next bound, in (0, 1].
        tolerance: largest change of a normal force, in mean block weights, that counts as settled.
    """
    m = problem.n_interfaces
    lower = np.append(np.tile([0.0, 0.0, -INFINITY], m), -INFINITY)
    cost = np.append(np.zeros(3 * m), -1.0)
    matrix = sp.csc_matrix(sp.hstack([problem.statics, sp.csr_matrix(problem.live[:, None])]))
    programme = Programme(matrix, cost, (lower, np.full(3 * m + 1, INFINITY)), (-problem.dead, -problem.dead))
    law = problem.law
    bound = law.strength(forces)
    history: list[float] = []
    change, multiplier = float("inf"), float("nan")
    for _ in range(max_iterations):
        programme.set_columns(
            0,
            np.column_stack([np.zeros((m, 2)), -bound]).ravel(),
            np.column_stack([np.full((m, 2), INFINITY), bound]).ravel(),
        )
        status, value, _ = programme.run()
        if status != "optimal":
            return TrescaResult(None, float("nan"), history, change, status)
        forces, multiplier = value[:-1].reshape(-1, 3), float(value[-1])
        history.append(multiplier)
        wanted = law.strength(np.maximum(forces, 0.0))
        change = float(abs(wanted - bound).max(initial=0.0))
        if change <= tolerance:
            return TrescaResult(forces, multiplier, history, change, "settled")
        bound = (1.0 - weight) * bound + weight * wanted
    return TrescaResult(forces, multiplier, history, change, "not settled")
