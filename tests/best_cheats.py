"""Programmes that find the best an answer can do which is false: motions that gain, forces that nearly bear a load.

Written from the definitions, on the kinematic matrix of the model and scipy; nothing is shared with the judge.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog

from harness.model.assembly import Assembly, FloatArray

Rng = np.random.Generator


def rates(wall: Assembly) -> FloatArray:
    """Rows (4m, 3n) of opening less lift of a slip, for each end and sense, of the velocities of all blocks."""
    whole = strains(wall)
    return np.vstack(
        [whole[end::3] - sense * wall.friction[:, None] * whole[2::3] for end in (0, 1) for sense in (1.0, -1.0)]
    )


def gaining(wall: Assembly, load: FloatArray, closing: float, size: float = 1.0) -> FloatArray | None:
    """The motion (n, 3) of speeds up to `size` on which a load does most work, of closings up to so much."""
    bounds = [(0.0, 0.0) if wall.fixed[block] else (-size, size) for block in range(wall.n_blocks) for _ in range(3)]
    scale = abs(load).max() or 1.0
    answer = linprog(
        -load.ravel() / scale, A_ub=-rates(wall), b_ub=np.full(4 * wall.n_interfaces, closing), bounds=bounds
    )
    return answer.x.reshape(-1, 3) if answer.status == 0 else None


def excesses(wall: Assembly) -> FloatArray:
    """Rows (2m, 3m) of the shear beyond friction, in each sense, of contact forces."""
    rows = np.zeros((2 * wall.n_interfaces, 3 * wall.n_interfaces))
    for p in range(wall.n_interfaces):
        for k, sense in enumerate((1.0, -1.0)):
            rows[2 * p + k, 3 * p : 3 * p + 3] = [-wall.friction[p], -wall.friction[p], sense]
    return rows


def strains(wall: Assembly) -> FloatArray:
    """Rows (3m, 3n) of opening at both ends and slip, of the velocities of all blocks."""
    rows = np.zeros((3 * wall.n_interfaces, 3 * wall.n_blocks))
    rows[:, (3 * wall.free[:, None] + np.arange(3)).ravel()] = wall.kinematic_matrix.toarray()
    return rows


def bearing(rng: Rng, wall: Assembly, load: FloatArray, most: float, tension: float = 0.0) -> FloatArray | None:
    """Forces (m, 3) that balance a load (n, 3) as they can, of compressions up to `most` and some tension."""
    m, statics = wall.n_interfaces, wall.kinematic_matrix.toarray().T
    unit = abs(load[wall.free]).max() or 1.0
    rows, count = len(statics), 3 * wall.n_interfaces
    # Variables: forces, and what is out of balance, up and down.
    equal = np.hstack([statics, np.eye(rows), -np.eye(rows)])
    yields = np.hstack([excesses(wall), np.zeros((2 * m, 2 * rows))])
    bounds = [*([(-tension, most / unit), (-tension, most / unit), (None, None)] * m), *([(0.0, None)] * (2 * rows))]
    cost = np.concatenate([rng.uniform(-1e-3, 0.0, count) / (most / unit), np.ones(2 * rows)])
    answer = linprog(
        cost, A_ub=yields, b_ub=np.full(2 * m, tension), A_eq=equal, b_eq=-load[wall.free].ravel() / unit, bounds=bounds
    )
    return unit * answer.x[:count].reshape(-1, 3) if answer.status == 0 else None


def self_stress(rng: Rng, wall: Assembly) -> FloatArray:
    """Forces (m, 3) within yield that balance each other, of sum 1; zero where there are none."""
    m, statics = wall.n_interfaces, wall.kinematic_matrix.toarray().T
    answer = linprog(
        -rng.uniform(0.1, 1.0, 3 * m),
        A_ub=np.vstack([excesses(wall), np.tile([1.0, 1.0, 0.0], m)]),
        b_ub=np.append(np.zeros(2 * m), 1.0),
        A_eq=statics,
        b_eq=np.zeros(len(statics)),
        bounds=[(0.0, 1.0), (0.0, 1.0), (-1.0, 1.0)] * m,
    )
    return answer.x.reshape(-1, 3) if answer.status == 0 else np.zeros((m, 3))
