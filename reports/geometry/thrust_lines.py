"""How contact forces are drawn: which way a resultant points, where it begins and ends, round scales."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from reports.geometry.shapes import Thrusts

HEAD_JOINT = 0.5
"""An interface whose normal has a horizontal part above this (60 degrees from the vertical or more) is a head joint."""


_AT_LIMIT = 0.999
"""Share of the limit of friction from which a force is drawn as at it: forces of any method are known better."""


SMALLEST = 2e-3
"""Share of the largest force below which one is not drawn."""

_REACH = 0.36
"""Half of the length of a resultant that is drawn, in block sizes: two in neighbouring joints do not run into each
other."""

SHORTEST = 0.4
"""Share of its length that an arrow keeps at least where it is shortened because a greater force crosses it."""

LABELLED = 45
"""So many of the largest forces carry their size where it has room: more in one drawing are not read."""


def has_line_of_thrust(assembly: Assembly, found: Thrusts) -> bool:
    """Whether each free block passes its thrust on from one joint to one other, as in an arch or a column.

    Where a block has more contact forces, they meet in no point, and lines through the blocks are a graph of how
    forces flow, not a line of thrust.
    """
    touching = np.zeros(assembly.n_blocks, dtype=int)
    np.add.at(touching, assembly.block_a[found.interface], 1)
    np.add.at(touching, assembly.block_b[found.interface], 1)
    return len(found.size) > 0 and bool((touching[assembly.free] <= 2).all())


def _towards_ground(found: Thrusts) -> FloatArray:
    """Unit vectors (p, 2) of the resultants in the way they pass downwards, or to the right where they are level."""
    way = found.force / found.size[:, None]
    turned = (way[:, 1] > 1e-9) | ((abs(way[:, 1]) <= 1e-9) & (way[:, 0] < 0.0))
    return np.where(turned[:, None], -way, way)


def drawn_ends(assembly: Assembly, found: Thrusts) -> FloatArray:
    """Tail and tip (p, 2, 2) of each resultant as an arrow, half on either side of its joint.

    One that a support takes stands on the free block alone and ends at the joint, so that nothing leaves the support.
    """
    way = _towards_ground(found)
    length = _REACH * assembly.length_scale
    a, b = assembly.block_a[found.interface], assembly.block_b[found.interface]
    normal = assembly.normal[found.interface]  # from a to b
    held = assembly.fixed[a] | assembly.fixed[b]
    to_free = np.where(assembly.fixed[a][:, None], normal, -normal)
    leaves = (way * to_free).sum(axis=1) > 0.0  # the arrow starts at the joint, as that of a block which is held down
    before = np.where(held, np.where(leaves, 0.0, 2.0 * length), length)[:, None]
    after = np.where(held, np.where(leaves, 2.0 * length, 0.0), length)[:, None]
    ends = np.stack([found.point - before * way, found.point + after * way], axis=1)
    share = _shares_without_crossing(assembly, found, ends)[:, None, None]
    return found.point[:, None] + share * (ends - found.point[:, None])


def _shares_without_crossing(assembly: Assembly, found: Thrusts, ends: FloatArray) -> FloatArray:
    """Shares (p,) of their length that arrows (p, 2, 2) are drawn with: of two that cross, the smaller stops short."""
    first, second = _neighbours(assembly, found)
    smaller = np.where(found.size[first] <= found.size[second], first, second)
    greater = first + second - smaller
    step, other = (ends[k, 1] - ends[k, 0] for k in (smaller, greater))
    apart = ends[greater, 0] - ends[smaller, 0]
    turn = step[:, 0] * other[:, 1] - step[:, 1] * other[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        on_smaller = (apart[:, 0] * other[:, 1] - apart[:, 1] * other[:, 0]) / turn
        on_greater = (apart[:, 0] * step[:, 1] - apart[:, 1] * step[:, 0]) / turn
    cross = (abs(on_smaller - 0.5) < 0.5) & (abs(on_greater - 0.5) < 0.5)
    place = ends[smaller, 0] + np.where(cross, on_smaller, 0.0)[:, None] * step
    centre = found.point[smaller]
    reach = np.linalg.norm(ends[smaller] - centre[:, None], axis=2).max(axis=1)
    share = np.clip(0.8 * np.linalg.norm(place - centre, axis=1) / reach, SHORTEST, 1.0)
    shares = np.ones(len(found.size))
    np.minimum.at(shares, smaller[cross], share[cross])
    return shares


def _neighbours(assembly: Assembly, found: Thrusts) -> tuple[np.ndarray, np.ndarray]:
    """Pairs (q,), (q,) of forces that act on one block."""
    touching: list[list[int]] = [[] for _ in range(assembly.n_blocks)]
    for k, p in enumerate(found.interface.tolist()):
        touching[assembly.block_a[p]].append(k)
        touching[assembly.block_b[p]].append(k)
    pairs = [pair for forces in touching for pair in itertools.combinations(forces, 2)]
    listed = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    return listed[:, 0], listed[:, 1]


def friction_used(assembly: Assembly, forces: FloatArray) -> FloatArray:
    """Shear of every interface over its shear strength (m,), from forces (m, 3); NaN where that limit is 0."""
    limit = assembly.law.strength(forces)
    return np.asarray(np.divide(abs(forces[:, 2]), limit, out=np.full(len(limit), np.nan), where=limit > 0.0))


def at_friction_limit(assembly: Assembly, forces: FloatArray) -> np.ndarray:
    """Which interfaces (m,) carry a shear at the limit of friction: for screen, print and figures alike."""
    return np.asarray(friction_used(assembly, forces) >= _AT_LIMIT)


def round_number(largest: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that does not exceed a positive number."""
    power = 10.0 ** math.floor(math.log10(largest))
    return max(head * power for head in (1.0, 2.0, 5.0) if head * power <= largest * (1.0 + 1e-12))


def head_thrust(assembly: Assembly, forces: Sequence[Sequence[float]] | None) -> float | None:
    """The sum of the normal forces (m, 3) in head joints over the weight of the free blocks; None without either.

    Friction on the beds carries what does not press there, so that the thrust is free within bounds: a self-stress.
    """
    weight = float(assembly.weight[assembly.free].sum())
    head = np.abs(assembly.normal[:, 0]) > HEAD_JOINT
    if forces is None or not head.any() or weight <= 0.0:
        return None
    return float(np.asarray(forces, dtype=float)[head, :2].sum()) / weight
