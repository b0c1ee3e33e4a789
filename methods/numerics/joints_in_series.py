"""Further limits of joints, as joints in series: a law of any number of rows, of which the law of a joint has four.

Two joints with a weightless block between them bear the same forces, since that block is in equilibrium, and their
strains add up. So the pair bears what both laws allow, and moves along the flow vectors of either:

    S r + s0 >= 0 and S' r + s0' >= 0,   q = E g + E' g',   g, g' >= 0,

which is a law of eight rows. Further limits stand at contact points of their own, anywhere along the joint or beyond
it, so that a row may be any limit on the moment about a point, or on the shear. Whatever solves for joints of four rows
solves for these.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.breakpoints import of_whole_wall
from harness.model.details import MOVING_FORCES
from harness.model.load_steps import without_series
from harness.model.method import Answer


@dataclass(frozen=True, eq=False)
class FurtherLimits:
    """k laws of four rows, each of a joint that has its own.

    Attributes:
        joint: (k,) indices of the joints; one may come several times.
        end1, end2: (k, 2) contact points of the further law, in the order of the ends of the joint [length].
        friction, dilatancy: (k,) coefficients as of `Assembly`.
        constant: (k, 4) constant parts of the slacks [force].
    """

    joint: IntArray
    end1: FloatArray
    end2: FloatArray
    friction: FloatArray
    dilatancy: FloatArray
    constant: FloatArray


def in_series(assembly: Assembly, limits: FurtherLimits) -> Assembly:
    """The wall of n + k blocks and m + k joints in which the joints have further limits too.

    The first m joints bear the forces of the joints of the wall, and the first n blocks are its blocks; block n + i and
    joint m + i belong to limit i.
    """
    joint, k = limits.joint, len(limits.joint)
    layer = assembly.n_blocks + np.arange(k)
    beyond, second = assembly.block_b.copy(), np.empty(k, dtype=np.int64)
    for i, p in enumerate(joint):
        second[i], beyond[p] = beyond[p], layer[i]
    first = assembly.block_a[joint]
    like = np.where(assembly.fixed[first], assembly.block_b[joint], first)  # which the typical size of blocks counts
    of_blocks: dict[str, Any] = {
        "centroid": 0.5 * (assembly.end1 + assembly.end2)[joint],
        "weight": np.zeros(k),
        "fixed": np.zeros(k, dtype=bool),
        **dict.fromkeys(("dead", "live", "support_motion"), np.zeros((k, 3))),
    }
    arrays: dict[str, Any] = {name: np.concatenate([getattr(assembly, name), more]) for name, more in of_blocks.items()}
    wall = replace(
        assembly,
        block_ids=assembly.block_ids + tuple(f"{assembly.block_ids[like[i]]} (limit {i + 1})" for i in range(k)),
        polygons=assembly.polygons + tuple(assembly.polygons[block] for block in like),
        block_b=beyond,
        **arrays,
    )
    return wall.with_further_joints(
        tuple(assembly.joint[p] for p in joint),
        block_a=layer,
        block_b=second,
        end1=limits.end1,
        end2=limits.end2,
        face1=limits.end1,
        face2=limits.end2,
        normal=assembly.normal[joint],
        friction=limits.friction,
        dilatancy=limits.dilatancy,
        constant=limits.constant,
    )


def without_limits(answer: Answer, assembly: Assembly, limits: FurtherLimits) -> Answer:
    """The answer for a wall whose joints have further limits, of its own n blocks and m joints alone.

    What a further joint does on a path, its joint does.
    """
    n, m = assembly.n_blocks, assembly.n_interfaces
    details = without_series(answer.details, n, limits.joint)
    if "moving_blocks" in details:
        details = details | {"moving_blocks": [b for b in details["moving_blocks"] if b in assembly.block_ids]}
    if MOVING_FORCES in details:
        details = details | {MOVING_FORCES: details[MOVING_FORCES][:m]}
    return replace(
        answer,
        forces=None if answer.forces is None else answer.forces[:m],
        mechanism=None if answer.mechanism is None else answer.mechanism[:n],
        path=of_whole_wall(answer.path, np.append(np.arange(m), limits.joint)),
        details=details,
    )
