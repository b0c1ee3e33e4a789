"""Display lists on the axes of a matplotlib figure, in the lengths of the wall."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.path import Path

from harness.model.assembly import FloatArray
from harness.model.rings import rings_of
from reports.drawing.display_list import Arrows, Circles, DisplayList, Frame, Lines, Polygons, Shape, Text
from reports.drawing.looks import COLOURS, LOOKS, Look

_HATCH = "/////"
LEAST, MOST = 0.3, 0.05
"""Least width of a line [pt] that prints; most points of it in a drawing unit, as in a column of a journal."""


def plot(ax: Axes, drawing: DisplayList, *, least: float = 4.5) -> None:
    """Draw a display list.

    Args:
        ax: axes in the lengths of the wall, whose limits and place on the page are set.
        drawing: the display list.
        least: least size of letters [pt].
    """
    frame = drawing.frame
    point = _points(ax) / frame.scale
    for number, shape in enumerate(drawing.flat()):
        _Pen(ax, frame, point, 1.0 + 1e-3 * number, least).draw(shape)


def _points(ax: Axes) -> float:
    """Points of the page [pt] in a length of the wall."""
    page: Any = ax.get_figure()
    place, (wide, high) = ax.get_position(), page.get_size_inches().tolist()
    (left, right), (low, top) = ax.get_xlim(), ax.get_ylim()
    return 72.0 * float(min(place.width * wide / (right - left), place.height * high / (top - low)))


class _Pen:
    """Draws shapes of one depth on axes; `point` are the points of the page in a drawing unit."""

    def __init__(self, ax: Axes, frame: Frame, point: float, depth: float, least: float) -> None:
        self.ax, self.frame, self.point, self.depth, self.least = ax, frame, point, depth, least

    def draw(self, shape: Shape) -> None:
        match shape:
            case Polygons():
                rings = [[self._closed(ring) for ring in rings_of(outline)] for outline in shape.outlines]
                paths = [Path.make_compound_path(*(Path(ring, closed=True) for ring in part)) for part in rings]
                self.ax.add_collection(PathCollection(paths, **self._filled(LOOKS[shape.role])))
            case Lines():
                self._lines(shape.points, LOOKS[shape.role], shape.width, shape.dash)
            case Circles():
                self._circles(shape.centres, shape.radius, self._filled(LOOKS[shape.role]))
            case Arrows():
                look = LOOKS[shape.role]
                shafts, heads = shape.outlines()
                self._lines(shafts, look, None, None)
                solid = {**self._filled(look), "linestyle": "-"}
                self.ax.add_collection(PolyCollection([self.frame.back(head) for head in heads], **solid))
            case Text():
                x, y = self.frame.back(np.array(shape.at))
                side = {"start": "left", "middle": "center", "end": "right"}[shape.anchor]
                size = max(self.least, shape.size * self.point)
                self.ax.text(
                    x, y, shape.text, fontsize=size, color=COLOURS["ink"], ha=side, va="baseline", zorder=self.depth
                )

    def _closed(self, ring: FloatArray) -> FloatArray:
        return self.frame.back(np.vstack([ring, ring[:1]]))

    def _circles(self, centres: FloatArray, radius: float, looks: dict[str, Any]) -> None:
        angle = np.linspace(0.0, 2.0 * np.pi, 25)
        circle = radius * np.column_stack([np.cos(angle), np.sin(angle)])
        self.ax.add_collection(PolyCollection(list(self.frame.back(centres[:, None] + circle)), **looks))

    def _width(self, look: Look) -> float:
        return (
            max(LEAST, look.width * min(self.point, MOST) * (self.frame.thinner if look.thin else 1.0))
            if look.width
            else 0.0
        )

    def _filled(self, look: Look) -> dict[str, Any]:
        return {
            "facecolor": COLOURS[look.fill] if look.fill else "none",
            "edgecolor": COLOURS[look.stroke] if look.stroke else "none",
            "linewidth": self._width(look),
            "linestyle": self._dashes(look.dash, self._width(look)),
            "hatch": _HATCH if look.hatched else None,
            "alpha": look.opacity if look.opacity < 1.0 else None,
            "zorder": self.depth,
        }

    def _lines(self, points: tuple[FloatArray, ...], look: Look, width: float | None, dash: float | None) -> None:
        dots = np.array([line[0] for line in points if look.round and not np.ptp(line, axis=0).any()])
        if len(dots):  # a line of no length with round ends
            radius = 0.5 * self._width(look) / self.point
            self._circles(dots, radius, {"facecolor": COLOURS[look.stroke], "edgecolor": "none", "zorder": self.depth})
            return
        wide = self._width(look) if width is None else max(LEAST, width * self.point)
        dashes = (dash, dash) if dash is not None else look.dash
        self.ax.add_collection(
            LineCollection(
                [self.frame.back(line) for line in points],
                colors=COLOURS[look.stroke],
                linewidths=wide,
                linestyles=[self._dashes(dashes, wide)],
                capstyle="round" if look.round else "butt",
                joinstyle="round",
                zorder=self.depth,
            )
        )

    def _dashes(self, dash: tuple[float, float] | None, width: float) -> Any:
        """A dash in widths of its line, as matplotlib counts it."""
        return "-" if dash is None else (0, tuple(length * self.point / max(width, 1e-9) for length in dash))
