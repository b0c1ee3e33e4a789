"""What the tests of the distinct elements share: a run, and checks of its forces that are their own."""

from __future__ import annotations

from typing import Any

import numpy as np

from harness.model.assembly import Assembly
from harness.model.method import Answer
from methods.de.damped_holds import DampedHolds
from methods.de.settings import SweepSettings


def run(wall: Assembly, **settings: Any) -> Answer:
    return DampedHolds().solve(wall, SweepSettings(**settings))


def unbalanced(wall: Assembly, answer: Answer) -> float:
    """Largest force or moment / size out of balance on a free block, as a part of the mean dead load of a block."""
    assert answer.forces is not None
    assert answer.forces_multiplier is not None
    total = wall.dead + answer.forces_multiplier * wall.live
    for p, (n1, n2, s) in enumerate(answer.forces):
        for point, force in (
            (wall.end1[p], n1 * wall.normal[p] + s * wall.tangent[p]),
            (wall.end2[p], n2 * wall.normal[p]),
        ):
            for block, sign in ((wall.block_b[p], 1.0), (wall.block_a[p], -1.0)):
                x, y = point - wall.centroid[block]
                total[block] += sign * np.array([force[0], force[1], x * force[1] - y * force[0]])
    total[:, 2] /= wall.length_scale
    return float(np.abs(total[wall.free]).max()) / (wall.force_scale / wall.n_free)


def unyielding(wall: Assembly, answer: Answer) -> float:
    """Largest violation of n >= 0 and |s| <= mu (n1 + n2), as a part of the mean dead load of a block."""
    assert answer.forces is not None
    n1, n2, s = answer.forces.T
    worst = max(float((-n1).max()), float((-n2).max()), float((np.abs(s) - wall.friction * (n1 + n2)).max()))
    return worst / (wall.force_scale / wall.n_free)
