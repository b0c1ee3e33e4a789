"""Figures of supports that move: the reaction against the displacement, and the wall that they have carried along."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from harness.model.assembly import Assembly, FloatArray
from harness.model.displaced import carried
from reports.drawing.looks import COLOURS
from reports.drawing.wall_drawing import displaced_drawing
from reports.figures.figures import COLUMN, PAGE, style
from reports.figures.plot import plot
from reports.labels.numbers import labelled

_BEYOND = 1.5
"""Multiple of the displacement from which the last reaction is constant, up to which paths are drawn."""

Curve = tuple[str, FloatArray, FloatArray, float | None]
"""A name, displacements (k,), reactions (k,), and the displacement from which the reaction is constant."""


def reaction_figure(
    curves: Sequence[Curve], extremes: tuple[float, float], head: str, units: tuple[str, str] = ("", "")
) -> Figure:
    """Reactions against displacements [length] of supports, between the extremes of associated flow.

    Args:
        curves: one or more.
        extremes: least and greatest reaction.
        head: the line above; units: of displacements and of reactions, empty where there are none.
    """
    with style():
        page = Figure(figsize=(COLUMN, 0.8 * COLUMN), layout="constrained")
        ax = page.subplots()
        ends = [float(x[-1]) if constant is None else constant for _, x, _, constant in curves]
        furthest = _BEYOND * max(ends) or 1.0
        for (name, displacement, reaction, _), line in zip(curves, ("-", "--"), strict=False):
            drawn = np.append(displacement, max(furthest, float(displacement[-1])))
            ax.plot(drawn, np.append(reaction, reaction[-1]), line, color=COLOURS["ink"], linewidth=0.9, label=name)
        for value in extremes:
            ax.axhline(value, color=COLOURS["ink"], linewidth=0.5, linestyle=":")
        ax.set_xlim(0.0, furthest)
        ax.set_xlabel(labelled("displacement of the support", units[0]))
        ax.set_ylabel(labelled("reaction", units[1]))
        ax.set_title(head)
        ax.legend(frameon=False)
        ax.grid(linewidth=0.3)
    return page


def settled_figure(
    assembly: Assembly,
    places: FloatArray,
    curve_of: tuple[FloatArray, FloatArray],
    labels: tuple[str, str],
) -> Figure:
    """A quantity against the displacement of a wall, and the wall where it last stands.

    Args:
        assembly: the wall as drawn; places: (n, 3) displacements [length] and rotations of its blocks at the end.
        curve_of: displacements and values (k,) on the way; labels: of the two axes.
    """
    displacement, value = curve_of
    with style():
        page = Figure(figsize=(PAGE, 0.4 * PAGE), layout="constrained")
        curve, wall = page.subplots(1, 2)
        curve.plot(displacement, value, color=COLOURS["ink"], linewidth=0.9)
        curve.plot(displacement[-1:], value[-1:], "o", color=COLOURS["ink"], markersize=3)
        curve.set_xlabel(labels[0])
        curve.set_ylabel(labels[1])
        curve.grid(linewidth=0.3)
        polygons = carried(assembly, places)
        corners, room = np.concatenate(polygons), 0.02 * assembly.length_scale
        wall.update_datalim([corners.min(axis=0) - room, corners.max(axis=0) + room])
        wall.autoscale_view()
        wall.set_aspect("equal")
        plot(wall, displaced_drawing(assembly, "the wall", polygons))
        wall.set_axis_off()
        wall.set_title(f"the wall at {displacement[-1]:.5g}")
    return page
