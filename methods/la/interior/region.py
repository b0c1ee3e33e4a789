"""The part of a large wall that collapses, as a wall of its own; the rest is fixed and must only stand.

A mechanism of the part is one of the whole wall, and the static programme of the whole decides whether forces fit it.
The search is nonconvex in the part alone, which is why it succeeds where the whole wall is too large.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import Assembly, BoolArray, FloatArray
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.interior.interior_point import PathResult
from methods.la.interior.newton_step import Point

_MOVES = 1e-4
"""Speed relative to the fastest block from which a block belongs to the part."""
_BED = 0.5
"""Part of the normal of a joint along the dead load from which one of its blocks rests on the other: a bed."""


@dataclass(frozen=True, eq=False)
class Region:
    """The part as a problem of its own, with its Newton matrix and the interfaces (m,) of the whole it keeps."""

    problem: Problem
    newton: NewtonMatrix
    kept: BoolArray


def moving_region(problem: Problem, velocities: FloatArray) -> Region:
    """The blocks that a mechanism with velocities (3n,) moves, and all that rest on them.

    A fixed block that rests on a moving one would lock it, for without dilatancy it cannot be lifted.
    """
    assembly = problem.assembly
    motion = problem.to_mechanism(velocities) * np.array([1.0, 1.0, problem.unit_length])
    speed = abs(motion).max(axis=1)
    fixed = ~with_all_above(assembly, speed > _MOVES * speed.max())
    kept = ~(fixed[assembly.block_a] & fixed[assembly.block_b])
    part = replace(
        assembly.with_joints(kept),
        fixed=fixed,
        dead=np.where(fixed[:, None], 0.0, assembly.dead),
        live=np.where(fixed[:, None], 0.0, assembly.live),
    )
    scaled = make_problem(part)
    return Region(scaled, NewtonMatrix(scaled), kept)


def with_all_above(assembly: Assembly, moves: BoolArray) -> BoolArray:
    """The moving blocks (n,) and those that rest on them, directly or not, on joints that are beds."""
    down = assembly.dead[:, :2].sum(axis=0)
    rests = assembly.normal @ down / (np.linalg.norm(down) or 1.0)
    lower = np.concatenate([assembly.block_a[rests < -_BED], assembly.block_b[rests > _BED]])
    upper = np.concatenate([assembly.block_b[rests < -_BED], assembly.block_a[rests > _BED]])
    moves, count = moves & ~assembly.fixed, -1
    while moves.sum() != count:
        count = moves.sum()
        moves[upper[moves[lower]]] = True
    return moves


def in_whole(problem: Problem, region: Region, path: PathResult) -> PathResult:
    """A mechanism of the part, at the end of a path, as one of the whole wall, at rest elsewhere."""
    part = region.problem
    motion = np.zeros((problem.assembly.n_blocks, 3))
    motion[part.assembly.free] = path.point.velocities.reshape(-1, 3) / [1.0, 1.0, part.unit_length]
    velocities = problem.from_mechanism(motion)
    scale = problem.live_work / float(problem.live @ velocities)
    rates, slack = np.zeros((problem.n_interfaces, 4)), np.ones((problem.n_interfaces, 4))
    rates[region.kept], slack[region.kept] = scale * path.point.rates, path.point.slack
    return replace(path, point=Point(slack, 0.0, scale * velocities, rates))
