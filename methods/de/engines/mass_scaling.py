"""Courses counted from the supports, the tuning chosen from them, and the insertion orders of bodies."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra

from harness.model.assembly import Assembly, FloatArray, IntArray, polygon_area

_CHAIN = 3.0
"""Blocks a course up to which a wall is a chain: stacks have 1, arches 2."""
_DECAY = 0.4
"""Of the masses from one course to the next, at most."""
_SPAN = 14.0
"""Decay of the masses over all courses of a wall."""
_LIGHT_SPAN = 4.0
"""The same where tops are to be light."""
_STRONGEST = 0.95
"""Part of the velocity kept by a time step, at least."""
_WEAKEST = 0.9975
"""The same at most."""
_KEPT = 0.98
"""The same on light tops."""
_LOSS = 0.2
"""Of the velocity in a time step, times the courses."""
_CHAIN_LOSS = 0.5
"""The same of a chain."""


@dataclass(frozen=True)
class MassScaling:
    """Numbers that decide how fast a wall settles, and not what it settles to.

    Attributes:
        mass_decay: logarithmic decay of the masses from one course to the next.
        damping: part of the velocity kept by a time step.
    """

    mass_decay: float
    damping: float


def tunings(course: IntArray, mass_decay: float | None) -> list[MassScaling]:
    """Tunings to choose from at multiplier zero: for walls, and for chains of blocks as arches are.

    Walls: masses fall by exp(-0.4) a course, over at most exp(-14); damping 1 - 0.2 / courses between 0.95 and 0.9975.
    Chains: `lighter_upwards`, with damping 1 - 0.5 / courses where that is weaker, because long arches then come to
    rest in fewer time steps. A chain is offered this tuning first. A mass decay that is given leaves one tuning.
    """
    tallest = number_of_courses(course)
    keep = float(np.clip(1.0 - _LOSS / tallest, _STRONGEST, _WEAKEST))
    if mass_decay is not None:
        return [MassScaling(mass_decay, keep)]
    wall, chain = MassScaling(min(_DECAY, _SPAN / tallest), keep), lighter_upwards(course)
    chain = replace(chain, damping=float(np.clip(1.0 - _CHAIN_LOSS / tallest, chain.damping, _WEAKEST)))
    return [chain, wall] if is_chain(course) else [wall, chain]


def number_of_courses(course: IntArray) -> int:
    """Courses of the tallest part of a wall, at least one."""
    return int(course.max(initial=1))


def lighter_upwards(course: IntArray) -> MassScaling:
    """Masses that fall by exp(-0.4) a course, over at most exp(-4) in all; damping 0.98."""
    return MassScaling(min(_DECAY, _LIGHT_SPAN / number_of_courses(course)), _KEPT)


def is_chain(course: IntArray) -> bool:
    """Whether there are few blocks a course, as in stacks and arches."""
    return bool(np.count_nonzero(course) <= _CHAIN * number_of_courses(course))


def courses(assembly: Assembly) -> IntArray:
    """(n,) number of interfaces between each block and the nearest fixed block; 0 on fixed blocks.

    A block that no chain of interfaces joins to a fixed block gets one more than the largest number found.
    """
    n = assembly.n_blocks
    ones = np.ones(assembly.n_interfaces)
    graph = sp.csr_matrix((ones, (assembly.block_a, assembly.block_b)), shape=(n, n))
    fixed = np.flatnonzero(assembly.fixed)
    if len(fixed) == 0 or assembly.n_interfaces == 0:
        return np.ones(n, dtype=np.int64)
    distance = dijkstra(graph, directed=False, indices=fixed, unweighted=True, min_only=True)
    reached = np.isfinite(distance)
    distance[~reached] = distance[reached].max() + 1
    return distance.astype(np.int64)


def masses(assembly: Assembly, course: IntArray, decay: float) -> FloatArray:
    """(n,) masses area_i / mean area x exp(-decay (course_i - 1))."""
    area = np.array([polygon_area(polygon) for polygon in assembly.polygons])
    scaled: FloatArray = area / area[assembly.free].mean() * np.exp(-decay * (course - 1.0))
    return scaled


def insertion_orders(
    assembly: Assembly, course: IntArray, count: int, seed: int
) -> list[tuple[str, IntArray, IntArray]]:
    """`count` orders: a name, the free blocks in order, the interfaces in order.

    The first goes up the courses, the second down them, the third along the wall; the others are random. The contact
    solver visits contacts in an order that follows from it, and so picks among the admissible states of the wall.
    """
    x, y = assembly.centroid.T
    free = assembly.free
    middle = (assembly.end1 + assembly.end2) / 2.0
    up = free[np.lexsort((x[free], y[free], course[free]))]
    along = free[np.lexsort((y[free], x[free]))]
    depth = np.maximum(course[assembly.block_a], course[assembly.block_b])
    joints_up = np.lexsort((middle[:, 0], middle[:, 1], depth))
    joints_along = np.lexsort((middle[:, 1], middle[:, 0]))
    orders = [("up", up, joints_up), ("down", up[::-1], joints_up[::-1]), ("along", along, joints_along)]
    for k in range(3, count):
        generator = np.random.default_rng([seed, k])
        blocks = generator.permutation(free)
        orders.append((f"random {k - 2}", blocks, generator.permutation(assembly.n_interfaces)))
    return orders[:count]
