"""A wall as a display list: blocks with numbers, interfaces, contact points, loads and a scale."""

from __future__ import annotations

import math

import numpy as np

from harness.model.assembly import Assembly, FloatArray, polygon_area
from harness.model.case import Case
from harness.model.result import vertex_velocities
from harness.model.wall import Units
from reports.drawing.display_list import (
    BELOW,
    LETTERS,
    Arrows,
    DisplayList,
    Frame,
    Lines,
    Polygons,
    Shape,
    Text,
    chosen,
)
from reports.geometry import shapes, thrust_lines
from reports.labels import numbers
from reports.memo import memo

_LABELLED_BLOCKS = 160
_DOTTED_INTERFACES = 240
DRAWN_INTERFACES = 4000
_READ = 130.0
"""Size of ids that are 11 px in half of a page; smaller ones are for files, which can be zoomed."""


@memo
def wall_drawing(case: Case) -> DisplayList:
    """The wall of a case before anything is run."""
    return plain_wall(case.assembly, case.wall.units, case.id)


def plain_wall(assembly: Assembly, units: Units, name: str) -> DisplayList:
    """A wall before anything is run.

    Args:
        assembly: the wall.
        units: of its lengths and forces.
        name: what it is called.
    """
    free = numbers.count(assembly.n_free, "free block")
    label = f"The wall {name}: {free}, {numbers.count(assembly.n_interfaces, 'interface')}, with its loads"
    drawn = DisplayList(Frame.of(assembly), label)
    drawn.parts.extend(_stones(drawn.frame, assembly, list(assembly.polygons), "stone"))
    drawn.parts.extend(joint_lines(drawn.frame, assembly))
    drawn.parts.extend(bar_lines(drawn.frame, assembly))
    drawn.parts.extend(_labels(drawn.frame, assembly))
    drawn.parts.extend(load_arrows(drawn.frame, assembly))
    drawn.parts.extend(length_scale(drawn.frame, units.length))
    return drawn


def displaced_drawing(assembly: Assembly, name: str, polygons: list[FloatArray]) -> DisplayList:
    """Blocks of a wall of this name at other places (k, 2) [length]."""
    drawn = DisplayList(Frame.of(assembly), f"Displaced blocks of {name}")
    drawn.parts.extend(_stones(drawn.frame, assembly, polygons, "moves"))
    return drawn


def _stones(frame: Frame, assembly: Assembly, polygons: list[FloatArray], free: str) -> list[Shape]:
    placed = frame.place_all(polygons)
    return [Polygons("held", chosen(placed, assembly.fixed)), Polygons(free, chosen(placed, ~assembly.fixed))]


def joint_lines(frame: Frame, assembly: Assembly) -> list[Shape]:
    """Interfaces as heavier lines, with dots at their contact points where there are few."""
    if assembly.n_interfaces > DRAWN_INTERFACES:
        return []
    ends = frame.place(np.stack([assembly.end1, assembly.end2], axis=1))
    drawn: list[Shape] = [Lines("joint", tuple(ends))]
    if assembly.n_interfaces <= _DOTTED_INTERFACES:
        points = np.unique(np.rint(ends.reshape(-1, 2)), axis=0)
        drawn.append(Lines("contact", tuple(np.stack([point, point]) for point in points)))
    return drawn


def _labels(frame: Frame, assembly: Assembly) -> list[Shape]:
    """In each block its id where that is short, and its number where no id is, as large as it fits.

    A number beside ids would be taken for one.
    """
    if assembly.n_blocks > _LABELLED_BLOCKS:
        return []
    names = [name if len(name) <= 5 else "" for name in assembly.block_ids]
    if not any(names):
        names = [str(k + 1) for k in range(assembly.n_blocks)]
    sizes = [
        _letters(polygon * frame.scale, len(name)) if name else 0.0
        for name, polygon in zip(names, assembly.polygons, strict=True)
    ]
    read = np.median([size for size in sizes if size]) >= _READ  # most or none, not those of blocks that lie level
    drawn: list[Shape] = []
    for k, (name, size) in enumerate(zip(names, sizes, strict=True)):
        if size >= 44.0:
            x, y = frame.place(assembly.centroid[k]).tolist()
            below = (0.35 if assembly.fixed[k] else -0.22) * size
            role = "" if read and size >= _READ else "fine"
            drawn.append(Text(role, (x, y + below), name, size, title=f"block {assembly.block_ids[k]}"))
    return drawn


def _letters(polygon: FloatArray, letters: int) -> float:
    """The size at which a text of so many letters fits into a block, (k, 2) in units of the drawing."""
    height = float(np.ptp(polygon[:, 1]))
    round_it = float(np.linalg.norm(polygon - np.roll(polygon, -1, axis=0), axis=1).sum())
    slender = 2.0 * polygon_area(polygon) / round_it
    return min(170.0, 0.38 * height, 1.2 * slender / max(1.0, 0.55 * letters))


def load_arrows(frame: Frame, assembly: Assembly, head: float = 90.0) -> list[Shape]:
    """Dead load beyond the weights, and the live load, as arrows whose heads have a length at most."""
    loads = (("dead", shapes.extra_dead_load(assembly)), ("live", assembly.live))
    return [drawn for role, load in loads for drawn in _arrows(frame, assembly, load, role, head)]


def _arrows(frame: Frame, assembly: Assembly, load: FloatArray, role: str, head: float) -> list[Shape]:
    arrows = shapes.load_arrows(assembly, load)
    arrows = arrows[:: shapes.drawn_every(len(arrows))]
    if not arrows:
        return []
    force = np.array([arrow.force for arrow in arrows]) * [1.0, -1.0]
    size = np.linalg.norm(force, axis=1)
    longest = min(420.0, max(90.0, 0.8 * frame.block))
    length = longest * (0.35 + 0.65 * np.sqrt(size / size.max()))
    tails = frame.place(np.array([arrow.point for arrow in arrows]))
    tips = tails + (length / size)[:, None] * force
    return [Arrows(role, tails, tips, np.minimum(head, 0.4 * length))]


def length_scale(frame: Frame, unit: str) -> list[Shape]:
    """A bar of a round length below the wall, no longer than the wall is wide."""
    length = thrust_lines.round_number(min(0.3 * frame.extent.longest, frame.extent.width))
    x, y = length * frame.scale, math.floor(frame.extent.height * frame.scale) + BELOW // 2
    bar = [[(0, y), (x, y)], *([(end, y - 40), (end, y + 40)] for end in (0, x))]
    text = numbers.quantity(length, unit)
    lines = tuple(np.array(line) for line in bar)
    return [Lines("scale", lines), Text("", (x + 60, y + 0.35 * LETTERS), text, LETTERS, "start")]


def bar_lines(frame: Frame, assembly: Assembly, shift: FloatArray | None = None) -> list[Shape]:
    """A line a bar between its ends, props wider; moved along displacements (n, 3) of the blocks, if any."""
    bars, ends = assembly.bars, []
    for block, point in ((assembly.bars.block_a, bars.end1), (assembly.bars.block_b, bars.end2)):
        moved = 0.0 if shift is None else vertex_velocities(point, assembly.centroid[block], shift[block])
        ends.append(point + moved)
    placed = frame.place(np.stack(ends, axis=1))
    return [Lines(kind, (line,)) for kind, line in zip(bars.kinds, placed, strict=True)]
