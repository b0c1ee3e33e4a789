"""Walls of uneven blocks: corners cut back, the wall settled under its dead load, and the contacts it then has.

The settled wall is an assembly again, with the contacts that distinct elements found closed: finite elements and limit
analysis can take it from there, as C. Baggio and P. Trovalusci (1995) propose. Gaps that would close under the live
load only stay open in it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import Deadline
from methods.de.engines.engine import motion_units
from methods.de.engines.pymunk_blocks import PymunkBlocks
from methods.de.holds.loading import raise_until_it_falls, shown_to_fall
from methods.de.holds.motion import by_travel
from methods.de.settings import REACH, Faces

POINT = 1e-3
"""Length given to a contact at a single point, as a part of the length scale: methods need two contact points."""
_DAMPING = 0.01
"""Part of the velocity kept by a unit of time sqrt(length scale / gravity)."""
_LOOK = 250
"""Time steps from one look at the places to the next."""
_STILL = 1e-5
"""Change of the places [length scales, radians] from look to look below which the wall is at rest."""
_SLOW = 1e-4
"""Velocity [unit lengths per unit time] below which the wall is at rest."""
_SEGMENT = 1e-6
"""Least distance of two contact points, as a part of the length scale, that makes them a segment."""


@dataclass(frozen=True, eq=False)
class _Settled:
    """An uneven wall at rest under its dead load.

    Attributes:
        assembly: the wall with moved blocks and only the contacts that are closed.
        at_rest: whether it came to rest; if not, the contacts are those of the last moment.
        outlines: (n,) outlines of the uneven blocks where they were drawn.
        settlement: (n, 3) displacements [length] and rotations of the blocks.
        single_points: number of contacts at one point only.
    """

    assembly: Assembly
    at_rest: bool
    outlines: tuple[FloatArray, ...]
    settlement: FloatArray
    single_points: int


def _block_height(assembly: Assembly) -> float:
    """Median height of the free blocks [length]: the unit of the size of a defect."""
    heights = [float(np.ptp(assembly.polygons[i][:, 1])) for i in assembly.free]
    return float(np.median(heights))


def uneven_blocks(assembly: Assembly, size: float, faces: Faces = "both", seed: int = 0) -> tuple[FloatArray, ...]:
    """Outlines whose corners are moved into the block by U(0, size x block height).

    Up or down for uneven beds, sideways for uneven heads, towards the side on which the centroid lies. Fixed blocks
    stay as they are.
    """
    generator = np.random.default_rng(seed)
    depth = size * _block_height(assembly)
    which = np.array([faces in ("heads", "both"), faces in ("beds", "both")])
    outlines = []
    for i, polygon in enumerate(assembly.polygons):
        cut = generator.uniform(0.0, depth, polygon.shape) * which
        inward = np.sign(assembly.centroid[i] - polygon)
        outlines.append(polygon if assembly.fixed[i] else polygon + inward * cut)
    return tuple(outlines)


def settle_uneven(
    assembly: Assembly,
    size: float,
    faces: Faces = "both",
    seed: int = 0,
    most_steps: int = 20_000,
) -> _Settled:
    """Let the wall of uneven blocks come to rest under its dead load and take its contacts.

    Args:
        assembly: the perfect wall.
        size: greatest cut as a part of the block height.
        faces: which faces are uneven.
        seed: seed of the cuts.
        most_steps: most time steps of the settling.
    """
    outlines = uneven_blocks(assembly, size, faces, seed)
    space = PymunkBlocks(assembly, outlines, _DAMPING)
    before, at_rest = _come_to_rest(space, most_steps, np.inf)
    settled, single = with_contacts(assembly, space, before)
    return _Settled(settled, at_rest, outlines, before, single)


def _come_to_rest(space: PymunkBlocks, most_steps: int, reach: float) -> tuple[FloatArray, bool]:
    """Advance until nothing moves, a block has moved by `reach` length scales, or the steps are over.

    Returns:
        The places (n, 3) at the end, and whether the wall is at rest there.
    """
    unit, units = space.assembly.length_scale, motion_units(space.assembly)
    start = before = space.places()
    deadline = Deadline.of_run()
    for _ in range(max(1, most_steps // _LOOK)):
        deadline.ask()
        space.advance(_LOOK)
        now = space.places()
        if float(np.abs((now - before) / units).max()) < _STILL and space.speed() < _SLOW:
            return now, True
        before = now
        if float(np.abs(now - start)[:, :2].max()) >= reach * unit:
            break
    return before, False


@dataclass(frozen=True)
class Loading:
    """Loading of an uneven wall, gaps closing as they do.

    Attributes:
        stood: highest multiplier at which it came to rest; None if it did not under its dead load.
        fell: lowest multiplier above it at which it is shown to move; None if there is none.
        undecided: whether the least multiplier at which it did not come to rest is none at which it is shown to move.
        drift: largest displacement of a block at `stood` since the dead load, in length scales.
    """

    stood: float | None
    fell: float | None
    drift: float
    undecided: bool = False


def load_uneven(
    assembly: Assembly,
    size: float,
    faces: Faces = "both",
    seed: int = 0,
    greatest: float = 2.0,
    step: float = 0.02,
    accuracy: float = 0.005,
    reach: float = REACH,
    most_steps: int = 20_000,
) -> Loading:
    """Raise the live load on a wall of uneven blocks, at large displacements, until it no longer comes to rest.

    Args:
        assembly: the perfect wall.
        size: greatest cut as a part of the block height.
        faces: which faces are uneven.
        seed: seed of the cuts.
        greatest: multiplier at which the loading ends.
        step: load step.
        accuracy: the load at which it falls is narrowed to this difference.
        reach: a block that has moved this many length scales in one load step has fallen; and one that moved so far
            while the wall settled, if it did not come to rest.
        most_steps: most time steps of a load step.
    """
    outlines = uneven_blocks(assembly, size, faces, seed)
    space = PymunkBlocks(assembly, outlines, _DAMPING)
    # Gaps that close add up over the courses to more than `reach`, so the settling has none.
    rest, at_rest = _come_to_rest(space, most_steps, np.inf)
    if not at_rest:
        falls = by_travel(assembly, assembly.dead, rest, reach) is not None
        return Loading(None, 0.0 if falls else None, 0.0, not falls)
    first, fallen = rest, False
    moved: list[float] = []

    def rests(trial: float) -> bool:
        nonlocal space, rest, fallen
        if fallen:
            space = PymunkBlocks(assembly, outlines, _DAMPING)
            space.put(rest)
        space.load(trial)
        places, at_rest = _come_to_rest(space, most_steps, reach)
        load = assembly.dead + trial * assembly.live
        if at_rest:
            rest = places
        elif by_travel(assembly, load, places - rest, reach) is not None:
            moved.append(trial)
        fallen = fallen or not at_rest
        return at_rest

    ends = raise_until_it_falls(rests, greatest, step, accuracy)
    stood, fell = shown_to_fall(rests, moved, ends, greatest, accuracy)
    drift = float(np.abs(rest - first)[:, :2].max()) / assembly.length_scale
    return Loading(stood, fell, drift, fell != ends[1])


def with_contacts(assembly: Assembly, space: PymunkBlocks, places: FloatArray) -> tuple[Assembly, int]:
    """The wall at these places (n, 3) with the contacts of the space, and how many of them are single points."""
    unit = assembly.length_scale
    friction = {
        (min(int(a), int(b)), max(int(a), int(b))): float(mu)
        for a, b, mu in zip(assembly.block_a, assembly.block_b, assembly.friction, strict=True)
    }
    least = float(assembly.friction.min(initial=0.0))
    rows: list[tuple[int, int, FloatArray, FloatArray, FloatArray, float]] = []
    single = 0
    for a, b, normal, points in space.contacts():
        if assembly.fixed[a] and assembly.fixed[b]:
            continue
        tangent = np.array([-normal[1], normal[0]])
        if len(points) == 2 and np.linalg.norm(points[1] - points[0]) > _SEGMENT * unit:
            one, two = points
            along = (two - one) / np.linalg.norm(two - one)
            across = np.array([along[1], -along[0]])
            normal = across if across @ normal > 0.0 else -across
        else:
            single += 1
            one, two = (
                points[0] - tangent * POINT * unit / 2.0,
                points[0] + tangent * POINT * unit / 2.0,
            )
        rows.append((a, b, one, two, normal, friction.get((a, b), least)))
    one, two = np.array([row[2] for row in rows]), np.array([row[3] for row in rows])
    level = np.abs((two - one)[:, 0]) > np.abs((two - one)[:, 1])
    moved = replace(
        assembly.with_joints(np.zeros(0, dtype=np.int64)),
        polygons=tuple(_moved_outline(assembly, i, places[i]) for i in range(assembly.n_blocks)),
        centroid=assembly.centroid + places[:, :2],
    )
    return moved.with_further_joints(
        tuple("bed" if flat else "head" for flat in level),
        block_a=np.array([row[0] for row in rows], dtype=np.int64),
        block_b=np.array([row[1] for row in rows], dtype=np.int64),
        end1=one,
        end2=two,
        face1=one,
        face2=two,
        normal=np.array([row[4] for row in rows]),
        friction=np.array([row[5] for row in rows]),
        dilatancy=np.zeros(len(rows)),
    ), single


def _moved_outline(assembly: Assembly, i: int, place: FloatArray) -> FloatArray:
    """Outline (k, 2) of block i after its displacement and rotation."""
    c, s = np.cos(place[2]), np.sin(place[2])
    turned = (assembly.polygons[i] - assembly.centroid[i]) @ np.array([[c, s], [-s, c]])
    outline: FloatArray = turned + assembly.centroid[i] + place[:2]
    return outline
