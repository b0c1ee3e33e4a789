"""Whether a live load brings a wall down at some multiplier: the judge's own answer, written apart from the methods.

Some multiplier does where a dilatant mechanism exists on which the live load does work, because strength of joints and
bars takes a finite power on it (Drucker 1954; Livesley 1978).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import Assembly, FloatArray


def brings_down(assembly: Assembly, shown: float = 1e-6) -> bool:
    """Whether a dilatant mechanism was found on which the live load does work; False: none was, which proves nothing.

    It is sought among motions whose speeds, and rotations times the length scale, are at most one. `shown` is the share
    of the power that live loads would have if nothing cancelled, from which on work is no rounding of a programme that
    keeps its constraints to 1e-10.
    """
    from scipy.optimize import linprog  # which few answers need

    column = np.tile([1.0, 1.0, 1.0 / (assembly.length_scale or 1.0)], assembly.n_blocks)
    moves = np.repeat(~assembly.fixed, 3).astype(float)
    work = moves * assembly.live.ravel() * column / (abs(assembly.live).max(initial=0.0) or 1.0)
    first, second = (_rates(assembly, end, assembly.normal) for end in (assembly.end1, assembly.end2))
    slip = _rates(assembly, 0.5 * (assembly.end1 + assembly.end2), assembly.tangent)
    lift = sp.diags(assembly.friction) @ slip
    closings = sp.vstack([lift - first, -lift - first, lift - second, -lift - second]) @ sp.diags(column)
    found = linprog(
        -work,
        A_ub=closings.tocsr(),
        b_ub=np.zeros(closings.shape[0]),
        bounds=list(zip((-moves).tolist(), moves.tolist(), strict=True)),
        method="highs",
        options={"primal_feasibility_tolerance": 1e-10},
    )
    return bool(found.status == 0 and work @ found.x > shown * abs(work).sum())


def _rates(assembly: Assembly, points: FloatArray, along: FloatArray) -> sp.csr_matrix:
    """(m, 3 n) velocities at points (m, 2) of the second block of every joint relative to the first, along (m, 2)."""
    rows, columns, entries = [], [], []
    for block, sign in ((assembly.block_a, -1.0), (assembly.block_b, 1.0)):
        arm = points - assembly.centroid[block]
        for axis, entry in enumerate((along[:, 0], along[:, 1], arm[:, 0] * along[:, 1] - arm[:, 1] * along[:, 0])):
            rows.append(np.arange(len(block)))
            columns.append(3 * block + axis)
            entries.append(sign * entry)
    places = (np.concatenate(rows), np.concatenate(columns))
    return sp.csr_matrix((np.concatenate(entries), places), shape=(len(points), 3 * assembly.n_blocks))
