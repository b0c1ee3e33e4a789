"""Contact forces and scales in figures for papers, drawn through matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.path import Path as Line

from harness.model.assembly import Assembly, FloatArray
from harness.model.rings import rings_of
from harness.model.wall import Units
from reports import flow, numbers, shapes
from reports.drawing import stroke_factor

INK, GREY, BLUE, RUST, PLUM = "#14202b", "#8a96a1", "#17508c", "#a63c06", "#6d2077"
THIN, WIDE = 0.3, 3.2
"""Width of the line of a force [pt]: of none, and what the largest adds to it."""


def stones(polygons: Sequence[FloatArray], **looks: Any) -> PathCollection:
    """Polygons, those with holes too, as one collection of paths."""
    rings = [[np.vstack([ring, ring[:1]]) for ring in rings_of(polygon)] for polygon in polygons]
    paths = [Line.make_compound_path(*(Line(ring, closed=True) for ring in part)) for part in rings]
    return PathCollection(paths, **looks)


def draw_forces(ax: Axes, assembly: Assembly, forces: FloatArray, *, thrust: bool, units: Units | None = None) -> None:
    """Contact forces (m, 3): resultants at their centres of pressure, or their way through the blocks.

    The width of a line is proportional to the force; a force at the limit of friction is circled. An arrow points to
    where the force is passed on downwards.

    Args:
        ax: where.
        assembly: the wall.
        forces: the forces.
        thrust: lines through the blocks: the line of thrust where there is one, else how forces flow.
        units: of the wall, for the sizes beside the arrows and the scale of forces; None: neither.
    """
    for still, hatch in ((False, None), (True, "/////")):
        polygons = [p for p, fixed in zip(assembly.polygons, assembly.fixed, strict=True) if bool(fixed) is still]
        ax.add_collection(stones(polygons, facecolor="none", edgecolor=GREY, linewidth=0.4, hatch=hatch))
    found = shapes.thrusts(assembly, forces, smallest=flow.STYLE.smallest)
    if not len(found.size):
        return
    widths = (THIN + WIDE * found.size / found.size.max()) * stroke_factor(assembly)
    if thrust:
        _through_blocks(ax, assembly, found, widths)
    else:
        _resultants(ax, assembly, found, forces, widths)
        if units is not None:
            _sizes(ax, assembly, found, units)
    if units is not None:
        force_scale(ax, assembly, float(found.size.max()), units)


def _through_blocks(ax: Axes, assembly: Assembly, found: shapes.Thrusts, widths: FloatArray) -> None:
    lines = []
    places = shapes.junctions(assembly, found)
    for k, p in enumerate(found.interface):
        a, b = assembly.block_a[p], assembly.block_b[p]
        start = found.point[k] if assembly.fixed[a] else places[a]
        end = found.point[k] if assembly.fixed[b] else places[b]
        lines.append(np.array([start, found.point[k], end]))
    ax.add_collection(LineCollection(lines, colors=BLUE, linewidths=widths, capstyle="butt", joinstyle="round"))


def _resultants(ax: Axes, assembly: Assembly, found: shapes.Thrusts, forces: FloatArray, widths: FloatArray) -> None:
    full = flow.at_friction_limit(assembly, forces)[found.interface]
    ends, way = flow.drawn_ends(assembly, found), flow.towards_ground(found)
    head = 0.2 * assembly.length_scale
    tips, neck = ends[:, 1], ends[:, 1] - head * way
    colours = [RUST if at_limit else BLUE for at_limit in full]
    bars = np.stack([ends[:, 0], tips - 0.7 * head * way], axis=1)
    ax.add_collection(LineCollection(list(bars), colors=colours, linewidths=widths))
    side = 0.38 * head * np.stack([-way[:, 1], way[:, 0]], axis=1)
    heads = np.stack([tips, neck + side, neck - side], axis=1)
    ax.add_collection(PolyCollection(list(heads), facecolor=colours, edgecolor="none"))
    ax.plot(
        found.point[full, 0],
        found.point[full, 1],
        "o",
        mfc="none",
        mec=RUST,
        mew=0.6 * stroke_factor(assembly),
        markersize=4.0 * stroke_factor(assembly),
    )


def _sizes(ax: Axes, assembly: Assembly, found: shapes.Thrusts, units: Units) -> None:
    """The size of each force beside it, where there is room for all of them."""
    if len(found.size) > flow.STYLE.labelled:
        return
    for point, size, p in zip(found.point, found.size, found.interface, strict=True):
        level = abs(float(assembly.normal[p, 1])) > 0.5
        ax.annotate(
            numbers.given(float(size), 3), point, xytext=(3.0, 1.5) if level else (0.0, 3.5),
            textcoords="offset points", color=INK, fontsize=4.5, ha="left" if level else "center",
        )  # fmt: skip


def length_scale(ax: Axes, assembly: Assembly, units: Units) -> None:
    """A bar of a round length below the wall."""
    extent = shapes.extent(assembly)
    length = flow.round_number(0.3 * extent.longest)
    y = extent.bottom - 0.085 * extent.longest
    ax.plot([extent.left, extent.left + length], [y, y], "-|", color=INK, linewidth=0.8, markersize=4)
    _word(ax, extent.left + length, y, numbers.quantity(length, units.length), "left")


def force_scale(ax: Axes, assembly: Assembly, largest: float, units: Units) -> None:
    """A line as wide as a round force is drawn, below the wall on the right."""
    extent = shapes.extent(assembly)
    force = flow.round_number(largest)
    y = extent.bottom - 0.085 * extent.longest
    width = (THIN + WIDE * force / largest) * stroke_factor(assembly)
    end = extent.right - 0.17 * extent.longest
    ax.plot(
        [end - 0.12 * extent.longest, end], [y, y], "-", color=BLUE, linewidth=width,
        solid_capstyle="butt",
    )  # fmt: skip
    _word(ax, end, y, numbers.quantity(force, units.force), "left")


def _word(ax: Axes, x: float, y: float, text: str, side: str) -> None:
    ax.annotate(
        text, (x, y), xytext=(3.0, 0.0), textcoords="offset points", color=INK, fontsize=5.5, ha=side, va="center"
    )
