"""Contact forces within yield that balance given loads, whatever the method that asks for them."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.method import Answer
from methods.numerics.linear_programme import INFINITY, Programme


def forces_of_cone(friction: FloatArray) -> sp.csr_matrix:
    """Sparse (3m, 3m) matrix of the forces (n1, n2, s) of columns (n1, n2, y3 >= 0), with s = y3 - mu (n1 + n2)."""
    m = len(friction)
    base = 3 * np.arange(m)
    rows = np.concatenate([base, base + 1, base + 2, base + 2, base + 2])
    columns = np.concatenate([base, base + 1, base, base + 1, base + 2])
    values = np.concatenate([np.ones(2 * m), -friction, -friction, np.ones(m)])
    return sp.csr_matrix((values, (rows, columns)), shape=(3 * m, 3 * m))


def upper_limits(friction: FloatArray) -> sp.csr_matrix:
    """Sparse (m, 3m) matrix of the slacks y4 = 2 mu (n1 + n2) - y3 of columns (n1, n2, y3)."""
    m = len(friction)
    base = 3 * np.arange(m)
    columns = np.concatenate([base, base + 1, base + 2])
    values = np.concatenate([2 * friction, 2 * friction, -np.ones(m)])
    return sp.csr_matrix((values, (np.tile(np.arange(m), 3), columns)), shape=(m, 3 * m))


def rows_of_blocks(n_free: int, m: int) -> IntArray:
    """(3 n_free + m,) block behind each row of equilibrium, and a number of its own for each of m further rows."""
    return np.append(np.repeat(np.arange(n_free), 3), n_free + np.arange(m))


def admissible_forces(assembly: Assembly, load: FloatArray) -> FloatArray | None:
    """Contact forces (m, 3) within yield in equilibrium with a load, every block to rounding of its own; None if none.

    Args:
        assembly: the wall.
        load: (n, 3) generalised loads on the blocks [force, force, moment].
    """
    length = assembly.length_scale or 1.0
    column = np.tile([1.0, 1.0, 1.0 / length], assembly.n_free)
    own = load[assembly.free].ravel() * column
    unit = float(abs(own).sum()) / max(assembly.n_free, 1)
    m = assembly.n_interfaces
    if unit == 0.0:
        return np.zeros((m, 3))
    if m == 0:
        return None
    cone = forces_of_cone(assembly.friction)
    statics = (assembly.kinematic_matrix @ sp.diags(column)).T @ cone
    programme = Programme(
        sp.csc_matrix(sp.vstack([statics, upper_limits(assembly.friction)])),
        np.zeros(3 * m),
        (np.zeros(3 * m), np.full(3 * m, INFINITY)),
        (np.append(-own / unit, np.zeros(m)), np.append(-own / unit, np.full(m, INFINITY))),
    )
    status, _, _ = programme.run()
    vertex = programme.vertex(rows_of_blocks(assembly.n_free, m)) if status == "optimal" else None
    if vertex is None or not vertex.optimal:
        return None
    return np.asarray(cone @ np.maximum(vertex.value, 0.0)).reshape(-1, 3) * unit


def bear(assembly: Assembly, answer: Answer, multiplier: float) -> FloatArray | None:
    """Forces (m, 3) with which a component bears its dead load and `multiplier` times the live load; None if none.

    Where the answer holds forces at a higher multiplier, those between it and the dead load do: the cone is convex.
    """
    highest = answer.forces_multiplier
    if answer.forces is not None and highest is not None and highest > multiplier >= 0.0:
        dead = admissible_forces(assembly, assembly.dead)
        if dead is not None:
            share = multiplier / highest
            return (1.0 - share) * dead + share * answer.forces
    return admissible_forces(assembly, assembly.dead + multiplier * assembly.live)
