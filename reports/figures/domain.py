"""A figure of the interaction domain of two live loads, through matplotlib."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from harness.model.assembly import FloatArray
from reports.drawing.looks import COLOURS
from reports.figures.figures import COLUMN, style


def domain_figure(names: tuple[str, str], head: str, points: FloatArray, ways: FloatArray, *, exact: bool) -> Figure:
    """The plane of two multipliers with the boundary of the domain.

    Args:
        names: of the loads.
        head: the line above.
        points: (k, 2) of the boundary, counter-clockwise by direction.
        ways: (j, 2) directions in which it is unbounded; the boundary goes off along those of an exact domain.
        exact: whether the points are the vertices of a polygon; otherwise the boundary between them is not known.
    """
    with style():
        page = Figure(figsize=(COLUMN, COLUMN), layout="constrained")
        ax = page.subplots()
        if exact and len(points):
            ring = _closed(points, ways)
            ax.fill(*ring.T, color=COLOURS["ink"], alpha=0.08, linewidth=0.0)
            ax.plot(*np.vstack([ring, ring[:1]]).T, color=COLOURS["ink"], linewidth=0.8)
        ax.plot(*points.T, "o", color=COLOURS["ink"], markersize=2.5)
        ax.plot(0.0, 0.0, "+", color=COLOURS["ink"])
        size = 1.15 * np.abs(points).max(axis=0, initial=1e-300)
        size = np.where(size < 1e-3 * size.max(), size.max(), size)
        ax.set_xlim(-size[0], size[0])
        ax.set_ylim(-size[1], size[1])
        ax.set_xlabel(f"multiplier of {names[0]}")
        ax.set_ylabel(f"multiplier of {names[1]}")
        ax.set_title(head)
        ax.grid(linewidth=0.3)
    return page


def _closed(points: FloatArray, ways: FloatArray) -> FloatArray:
    """The vertices, with those of an unbounded polygon carried on along its open edges beyond the page."""
    if not len(ways):
        return points
    far = 10.0 * float(np.abs(points).max())
    angle = np.arctan2(*points.T[::-1])
    gone = []
    for way in ways:
        turn = (np.arctan2(way[1], way[0]) - angle + np.pi) % (2.0 * np.pi) - np.pi
        gone.append(points[np.argmin(abs(turn))] + far * way)
    every = np.vstack([points, gone])
    return np.asarray(every[np.argsort(np.arctan2(*(every - every.mean(axis=0)).T[::-1]))])
