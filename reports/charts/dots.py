"""Dot plots as HTML: a row a wall, a mark a method. Marks stand at shares of the width, so that text keeps its size."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

from markupsafe import Markup

from reports.charts.charts import Axis
from reports.charts.styles import SHAPES, Mark

LANE, MARK = 8, 0.95
"""Height of the line that one method's marks stand on [px], and size of a mark against that of line charts."""
ROOM = 3.1
"""Room of a letter in the labels of ticks [%], 7 px where an axis is 220 px long; narrow screens show every other."""
REFERENCE = Mark("", "|", "solid")


class _Scale(Protocol):
    """An axis from 0 to 100 % of the width."""

    ticks: list[float]

    def place(self, value: float) -> float | None:
        """Where a value stands [%]; None if it has no place."""

    def text(self, value: float) -> str:
        """The label of a tick."""


@dataclass(frozen=True)
class Dot:
    """One value of a row.

    Attributes:
        name: whose, for the legend.
        value: where its mark stands.
        mark: its colour and shape.
        text: what is shown on hovering, and read out.
        ends: of its bar, or None.
        filled: whether the mark is filled.
    """

    name: str
    value: float
    mark: Mark
    text: str
    ends: tuple[float, float] | None = None
    filled: bool = False


@dataclass(frozen=True)
class DotRow:
    """One row.

    Attributes:
        name, href: of the row, and where it leads; no link if empty.
        dots: its marks.
        said: a value or a few words at its end.
        levels: values marked by an upright line, with what they are.
    """

    name: str
    dots: list[Dot]
    said: str = ""
    href: str = ""
    levels: list[tuple[float, str]] = field(default_factory=list)

    @property
    def spread(self) -> float:
        """From its least mark to its greatest, in the unit of the axis."""
        values = [dot.value for dot in self.dots]
        return max(values) - min(values) if values else 0.0


@dataclass(frozen=True)
class DotPlot:
    """Rows over one axis.

    Attributes:
        title: what is shown.
        scale: the axis.
        rows: from top to bottom.
        band: values between which all counts as equal, or None.
    """

    title: str
    scale: _Scale
    rows: list[DotRow]
    band: tuple[float, float] | None = None

    @property
    def names(self) -> dict[str, Mark]:
        """The methods with their marks, in the order of their lanes."""
        return {dot.name: dot.mark for row in self.rows for dot in row.dots}


class Above:
    """An axis of relative differences, level up to a thousandth and logarithmic beyond: log10(1 + 1000 |d|).

    Args:
        values: differences, as shares; those that are not finite have no place.
    """

    unit = 1e-3

    def __init__(self, values: Sequence[float]) -> None:
        known = [value for value in values if math.isfinite(value)]
        self.low, self.high = self._bend(min([*known, -self.unit])), self._bend(max([*known, 0.01]))
        steps = [step * sign for step in (0.001, 0.01, 0.1, 1.0, 10.0, 100.0) for sign in (-1.0, 1.0)]
        self.ticks = sorted([0.0, *(step for step in steps if self.low <= self._bend(step) <= self.high)])

    def _bend(self, value: float) -> float:
        return math.copysign(math.log10(1.0 + abs(value) / self.unit), value)

    def place(self, value: float) -> float | None:
        """Where a difference stands [%]."""
        if not math.isfinite(value):
            return None
        return 3.0 + 94.0 * (self._bend(value) - self.low) / (self.high - self.low)

    def text(self, value: float) -> str:
        """A tick in percent."""
        return "least" if value == 0.0 else f"{100.0 * value:+g} %".replace("-", "−")


def plain_scale(values: list[float], *, log: bool = False) -> _Scale:
    """An axis of the values themselves."""
    return Axis(values, 3.0, 97.0, log=log)


def html(plot: DotPlot) -> Markup:
    """The plot as an element of a page: a list of rows, the axis below, and a legend."""
    crowded = any(len(row.dots) > 1 for row in plot.rows)
    lanes = {name: number if crowded else 0 for number, name in enumerate(plot.names)}
    rows = Markup("").join(_row(plot, row, lanes, number) for number, row in enumerate(plot.rows))
    ticks = Markup("").join(
        Markup('<span style="left:{:.2f}%">{}</span>').format(place, text) for place, text in _labels(plot.scale)
    )
    return Markup(
        '<div class="dots" role="group" aria-label="{}">{}<ol>{}</ol><div class="ticks" aria-hidden="true"><b></b>'
        "<span>{}</span><b></b></div></div>"
    ).format(plot.title, _grid(plot), rows, ticks)


def legend(plot: DotPlot, more: Sequence[tuple[str, Markup]] = ()) -> Markup:
    """The marks of the plot with the names of their methods, and further signs."""
    own = [(name, sign(mark)) for name, mark in plot.names.items()]
    items = Markup("").join(Markup("<li>{}{}</li>").format(drawn, name) for name, drawn in [*own, *more])
    return Markup('<ul class="legend">{}</ul>').format(items)


def sign(mark: Mark, *, filled: bool = False) -> Markup:
    """A mark in a line of text."""
    return Markup('<svg class="sign" width="14" height="14" viewBox="-7 -7 14 14" aria-hidden="true">{}</svg>').format(
        _mark(mark, filled=filled)
    )


def _mark(mark: Mark, *, filled: bool, text: str = "") -> Markup:
    if mark.marker == REFERENCE.marker:
        return Markup('<path class="level" d="M0-6V6"/>')
    fill = mark.colour if filled else "var(--paper)"
    title = Markup("<title>{}</title>").format(text) if text else ""
    return Markup('<path class="dot" transform="scale({})" style="stroke:{};fill:{}" d="{}">{}</path>').format(
        MARK, mark.colour, fill, SHAPES[mark.marker], title
    )


def _row(plot: DotPlot, row: DotRow, lanes: dict[str, int], number: int) -> Markup:
    place, height = plot.scale.place, max(2 * LANE, LANE * (max(lanes.values(), default=0) + 2))
    drawn = Markup('<use href="#{}"/>').format(_grid_id(plot))
    for value, what in row.levels:
        drawn += _upright("level", place(value), what)
    for dot in row.dots:
        y, x = LANE * (lanes[dot.name] + 1), place(dot.value)
        bar = [place(end) for end in dot.ends or ()]
        if len(bar) == 2 and bar[0] is not None and bar[1] is not None:
            drawn += Markup('<line class="bar" style="stroke:{}" x1="{:.2f}%" x2="{:.2f}%" y1="{y}" y2="{y}"/>').format(
                dot.mark.colour, bar[0], bar[1], y=y
            )
        if x is not None:
            drawn += Markup('<svg x="{:.2f}%" y="{}">{}</svg>').format(
                x, y, _mark(dot.mark, filled=dot.filled, text=dot.text)
            )
    said = "; ".join([*(dot.text for dot in row.dots), *(what for _, what in row.levels)]) or row.said
    name = (
        Markup('<a href="{}">{}</a>').format(row.href, row.name) if row.href else Markup("<b>{}</b>").format(row.name)
    )
    return Markup(
        '<li data-place="{}" data-spread="{}">{}<svg class="track" height="{}" role="img" aria-label="{}">{}</svg>'
        "<span>{}</span></li>"
    ).format(number, f"{row.spread:.9g}", name, height, said, drawn, row.said)


def _labels(scale: _Scale) -> list[tuple[float, str]]:
    """Places and texts of ticks, those left out that have no room beside others.

    What the axis counts from comes first: it has its label on every axis, and on a phone, which shows every other one.
    """
    kept: list[tuple[float, str]] = []
    for value in sorted(scale.ticks, key=lambda value: value != 0.0):
        place, text = scale.place(value), scale.text(value)
        if place is not None and all(
            abs(place - other) >= ROOM * (len(text) + len(said)) / 2.0 for other, said in kept
        ):
            kept.append((place, text))
    return kept


def _grid_id(plot: DotPlot) -> str:
    return f"grid-{zlib.crc32(plot.title.encode()):x}"


def _grid(plot: DotPlot) -> Markup:
    """The band and the lines at the ticks, drawn once and used by every row."""
    ends = [plot.scale.place(end) for end in plot.band or ()]
    drawn = Markup("")
    if len(ends) == 2 and ends[0] is not None and ends[1] is not None:
        drawn += Markup('<rect class="within" x="{:.2f}%" width="{:.2f}%" height="100%"/>').format(
            ends[0], ends[1] - ends[0]
        )
    for value in plot.scale.ticks:
        drawn += _upright("tick", plot.scale.place(value))
    return Markup('<svg class="sr" aria-hidden="true"><defs><g id="{}">{}</g></defs></svg>').format(
        _grid_id(plot), drawn
    )


def _upright(role: str, place: float | None, what: str = "") -> Markup:
    if place is None:
        return Markup("")
    title = Markup("<title>{}</title>").format(what) if what else ""
    return Markup('<line class="{0}" x1="{1:.2f}%" x2="{1:.2f}%" y1="0" y2="100%">{2}</line>').format(
        role, place, title
    )
