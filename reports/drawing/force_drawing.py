"""Contact forces as a display list: resultants at their centres of pressure, or their way through the blocks."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Sequence

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.bar_forces import BarForce, bar_forces_of
from harness.model.case import Case
from harness.model.result import Result
from reports.drawing.display_list import (
    BELOW,
    LETTERS,
    Circles,
    DisplayList,
    Frame,
    Group,
    Lines,
    Polygons,
    Shape,
    Text,
    chosen,
)
from reports.drawing.wall_drawing import length_scale
from reports.geometry import shapes, thrust_lines
from reports.geometry.shapes import Thrusts
from reports.labels import numbers
from reports.memo import memo

WIDEST, THINNEST = 0.16, 0.02
"""Width of the largest and of the smallest force, in block sizes."""
_LAYERS = ("forces", "thrust")
CLEAR = 12.0
"""Least distance of a number from an arrow, in drawing units."""
_WORTH = 0.05
"""Share of the largest force from which a force has a number."""


@memo
def force_drawing(case: Case, result: Result, layers: Collection[str] = _LAYERS) -> DisplayList:
    """Contact forces (m, 3) of a result with their sizes and scales; a force at the limit of friction is circled.

    Args:
        case: the case.
        result: one of its results, with forces.
        layers: "forces" for the resultants, "thrust" for lines through the blocks; a page shows one of both.
    """
    assembly, frame = case.assembly, Frame.of(case.assembly)
    drawn = DisplayList(frame, f"Contact forces of {result.case} by {result.method}")
    placed = frame.place_all(assembly.polygons)
    drawn.parts.append(Polygons("ground", chosen(placed, assembly.fixed)))
    drawn.parts.append(Polygons("outline", chosen(placed, ~assembly.fixed)))
    drawn.parts.extend(length_scale(frame, case.wall.units.length))
    forces = np.asarray(result.forces, dtype=float)
    found = shapes.thrusts(assembly, forces, smallest=thrust_lines.SMALLEST)
    listed = bar_forces_of(case, result)
    if listed:
        drawn.parts.extend(_bar_forces(frame, assembly, listed))
    if len(found.size):
        drawn.parts.extend(_groups(frame, assembly, found, forces, layers))
        drawn.parts.extend(_force_scale(frame, float(found.size.max()), case.wall.units.force))
    return drawn


def _width(frame: Frame, share: float) -> float:
    """Width of the line of a force that is a share of the largest."""
    return max(THINNEST, WIDEST * share) * frame.block


def _groups(
    frame: Frame, assembly: Assembly, found: shapes.Thrusts, forces: FloatArray, layers: Collection[str]
) -> list[Group | Text]:
    """A group for each interface that carries force, and the sizes of forces over all of them."""
    full, used = thrust_lines.at_friction_limit(assembly, forces), percent_used(assembly, forces)
    points, width = frame.place(found.point), [_width(frame, share) for share in (found.size / found.size.max())]
    ends = frame.place(thrust_lines.drawn_ends(assembly, found))
    heads = _heads(frame, ends, np.array(width))
    arrows = _arrows(ends, np.array(width), heads)
    lines = _through_blocks(frame, assembly, found)
    drawn: list[Group | Text] = []
    for k, p in enumerate(found.interface.tolist()):
        parts: list[Shape] = []
        if "forces" in layers:
            parts.append(Polygons("full" if full[p] else "force", (arrows[k],)))
            if full[p]:
                parts.append(Circles("ring", points[k][None], max(0.05 * frame.block, 0.5 * width[k] + 9)))
        if "thrust" in layers:
            parts.append(Lines("thrust", (lines[k],), width[k]))
        share = used[p] if used[p] >= 0 else None
        drawn.append(Group(tuple(parts), joint=p, values=(*forces[p].tolist(), share)))
    if "forces" in layers:
        drawn.extend(_sizes(ends, np.array(width), heads, found.size))
    return drawn


def percent_used(assembly: Assembly, forces: FloatArray) -> list[int]:
    """Friction used at every interface in whole percent: 100 exactly where it is at its limit, -1 without friction."""
    used = thrust_lines.friction_used(assembly, forces)
    below = np.minimum(99, np.rint(100.0 * np.nan_to_num(used, nan=-0.01)))
    return [int(percent) for percent in np.where(thrust_lines.at_friction_limit(assembly, forces), 100, below)]


def _heads(frame: Frame, ends: FloatArray, width: FloatArray) -> FloatArray:
    """Lengths (p,) of the heads of arrows of a width (p,) from tails to tips (p, 2, 2), half of the arrow at most."""
    half = 0.5 * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    return np.asarray(np.minimum(np.maximum(0.2 * frame.block, 1.7 * width), half))


def _arrows(ends: FloatArray, width: FloatArray, heads: FloatArray) -> FloatArray:
    """Outlines (p, 7, 2) of arrows of a width (p,) with heads of a length (p,) from tails to tips, the tips first."""
    tail, tip = ends[:, 0], ends[:, 1]
    way = (tip - tail) / np.linalg.norm(tip - tail, axis=1)[:, None]
    across = np.column_stack([-way[:, 1], way[:, 0]])
    head = heads[:, None]
    neck, wide, half = tip - head * way, 0.4 * head * across, 0.5 * width[:, None] * across
    return np.stack([tip, neck + wide, neck + half, tail + half, tail - half, neck - half, neck - wide], axis=1)


def _through_blocks(frame: Frame, assembly: Assembly, found: shapes.Thrusts) -> FloatArray:
    """Lines (p, 3, 2) from where the forces of one block meet through each centre of pressure to those of the other."""
    meet, point = _junctions(assembly, found), found.point
    first, second = (
        np.where(assembly.fixed[block][:, None], point, meet[block])
        for block in (assembly.block_a[found.interface], assembly.block_b[found.interface])
    )
    return frame.place(np.stack([first, point, second], axis=1))


def _sizes(ends: FloatArray, width: FloatArray, heads: FloatArray, sizes: FloatArray) -> list[Text]:
    """The sizes of the largest forces beside their arrows (p, 2, 2), where one covers no arrow and no other.

    A number stands on either side of the middle of its arrow, or of its upper or lower part, as near as it can.
    """
    share = np.linspace(0.0, 1.0, 25)[:, None, None]
    drawn = ((1.0 - share) * ends[:, 0] + share * ends[:, 1]).reshape(-1, 2)  # points of all arrows
    to_tip = (1.0 - share[:, :, 0]) * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    beside = CLEAR + np.where(to_tip < heads, 0.4 * to_tip, 0.5 * width).ravel()
    placed: list[Text] = []
    centres, halves = np.empty((0, 2)), np.empty((0, 2))
    for k in np.argsort(-sizes, kind="stable")[: thrust_lines.LABELLED].tolist():
        if sizes[k] < _WORTH * sizes.max():
            break
        text = numbers.given(float(sizes[k]), 3)
        half = np.array([0.3 * len(text), 0.4]) * LETTERS  # of figures of the widest of our fonts
        step = ends[k, 1] - ends[k, 0]
        across = np.array([-step[1], step[0]]) / np.linalg.norm(step)
        away = across * (0.5 * width[k] + 2.0 * CLEAR + float(abs(across) @ half))
        for part, side in itertools.product((0.5, 0.2, 0.8), (-1.0, 1.0)):
            centre = ends[k, 0] + part * step + side * away
            covers = np.linalg.norm(np.maximum(abs(drawn - centre) - half, 0.0), axis=1) < beside
            if not covers.any() and not (abs(centres - centre) < halves + half).all(axis=1).any():
                centres, halves = np.vstack([centres, centre]), np.vstack([halves, half])
                placed.append(Text("said", (float(centre[0]), float(centre[1] + half[1])), text, LETTERS))
                break
    return placed


def _force_scale(frame: Frame, largest: float, unit: str) -> list[Shape]:
    """A line as wide as a round force is drawn, below the wall on the right, and no wider than there is room."""
    room = 0.6 * BELOW
    force = thrust_lines.round_number(largest * min(1.0, room / _width(frame, 1.0)))
    x, y = frame.extent.width * frame.scale, frame.extent.height * frame.scale + frame.below - BELOW // 2
    line = np.array([(x - 330, y), (x, y)])
    text = Text("", (x + 60, y + 0.35 * LETTERS), numbers.quantity(force, unit), LETTERS, "start")
    return [Lines("force-scale", (line,), _width(frame, force / largest)), text]


def _bar_forces(frame: Frame, assembly: Assembly, forces: Sequence[BarForce]) -> list[Shape]:
    """The bars with their tensions beside them, dashed where they bear nothing; compression is negative."""
    placed = frame.place(np.stack([assembly.bars.end1, assembly.bars.end2], axis=1))
    drawn: list[Shape] = []
    for bar, line in zip(forces, placed, strict=True):
        if bar.state == "slack":
            drawn.append(Lines("idle", (line,)))
            continue
        drawn.append(Lines(bar.kind, (line,)))
        x, y = line.mean(axis=0).tolist()
        across, along = abs(np.ptp(line, axis=0)).tolist()
        beside, above, anchor = (0.09, 0.0, "start") if along > across else (0.0, 0.05, "middle")
        at, size = (x + beside * frame.block, y - above * frame.block), min(110.0, 0.17 * frame.block)
        drawn.append(Text("said", at, numbers.given(bar.tension, 3), size, anchor))
    return drawn


def _junctions(assembly: Assembly, found: Thrusts) -> FloatArray:
    """Points (n, 2) where the thrust lines of a block meet: its centroid, or on the straight line between two forces.

    A block with exactly two contact forces passes the thrust straight from one centre of pressure to the other.
    """
    places = assembly.centroid.copy()
    touching: list[list[int]] = [[] for _ in range(assembly.n_blocks)]
    for k, p in enumerate(found.interface):
        touching[assembly.block_a[p]].append(k)
        touching[assembly.block_b[p]].append(k)
    for block, forces in enumerate(touching):
        if len(forces) == 2:
            places[block] = found.point[forces].mean(axis=0)
    return places
