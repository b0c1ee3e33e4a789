"""Continuation in friction: mechanisms found at lower friction are carried up a ladder to the friction of the wall.

The mechanisms of zero-dilatancy flow do not depend on friction, only the forces that fit them do. At high friction
the low collapse states have small basins; at lower friction the same mechanisms are found at once.

Best of all is to lower it in the joints alone that the dead load leaves unloaded, the head joints of a wall: without
the shear that self-stress gives them, little of the non-associated problem is left that is not convex, and the
interior point ends low on walls of any size.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg

from harness.model.assembly import BoolArray
from methods.la.newton_matrix import NewtonMatrix
from methods.la.problem import Problem
from methods.la.search import Effort, Search
from methods.la.state import CollapseState

POOL = 24
"""Mechanisms carried from one rung to the next."""
UNLOADED = 0.05
"""Share of the largest normal force on both its blocks below which a joint counts as unloaded."""


def climb(
    problem: Problem, newton: NewtonMatrix, seed: int, ladder: tuple[float, ...], effort: Effort, descents: int
) -> Search:
    """The search at the last rung of the ladder below the wall's own friction, with all it knows.

    Args:
        problem: the scaled wall.
        newton: its Newton matrix, which does not depend on friction.
        seed: of the random draws.
        ladder: factors on all friction coefficients, in order.
        effort: of each ray descent.
        descents: lowest states a rung descends from.
    """
    search: Search | None = None
    for factor in ladder:
        rung = Search(replace(problem, friction=problem.friction * factor), newton, seed, search)
        states = [rung.interior()]
        if search is not None:
            states += rung.adopt(search, POOL)
        descend_from([state for state in states if state is not None], rung, effort, descents)
        search = rung
    assert search is not None
    return search


def descend_from(states: list[CollapseState], search: Search, effort: Effort, most: int) -> list[CollapseState]:
    """Where ray descent leads from the lowest of the states that differ in multiplier."""
    reached: list[CollapseState] = []
    seen: set[int] = set()
    for state in sorted(states, key=lambda s: s.multiplier):
        place = round(state.multiplier * 1e9)
        if place in seen or len(reached) >= most:
            continue
        seen.add(place)
        reached.append(search.descend(state, effort))
    return reached


def smooth_joints_search(
    problem: Problem, newton: NewtonMatrix, seed: int, factor: float, parent: Search | None
) -> Search | None:
    """The search of the wall whose unloaded joints have `factor` times their friction; None if all are loaded."""
    unloaded = unloaded_joints(problem)
    if not unloaded.any():
        return None
    friction = np.where(unloaded, factor * problem.friction, problem.friction)
    search = Search(replace(problem, friction=friction), newton, seed, parent)
    search.interior()
    return search


def unloaded_joints(problem: Problem) -> BoolArray:
    """Interfaces (m,) that hardly press under dead load, by the forces of least norm that balance it.

    What counts is the largest normal force on either block, so that the light beds of a top course are not among them.
    """
    matrix = sparse.csc_matrix(problem.statics)
    stiffness = (matrix @ matrix.T + 1e-12 * sparse.eye(matrix.shape[0])).tocsc()
    forces = -matrix.T @ linalg.spsolve(stiffness, problem.dead)
    normal = forces.reshape(-1, 3)[:, :2].sum(axis=1)
    assembly = problem.assembly
    largest = np.zeros(assembly.n_blocks)
    for blocks in (assembly.block_a, assembly.block_b):
        np.maximum.at(largest, blocks, normal)
    largest[assembly.fixed] = np.inf
    return np.asarray(normal < UNLOADED * np.minimum(largest[assembly.block_a], largest[assembly.block_b]))
