"""Line charts as inline SVG, drawn once here: axes with round ticks, series with dashes and markers of their own."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from markupsafe import Markup

from reports.charts.styles import Mark
from reports.labels import numbers

WIDTH, HEIGHT = 560, 330
LEFT, RIGHT, BOTTOM, TOP = 72, 14, 46, 14
ROW, PER_ROW, NAMED = 20, 3, 24
LETTER, NOTE = 10.5, 19
"""Width of a letter, about, and height of a line. On a phone letters are 19 high, which is 11 pixels in a drawing as
wide as the page; on larger screens 12 high in the same places."""
_MARKERS = (
    "M-3.5 0a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0-7 0z",
    "M-3.2-3.2h6.4v6.4h-6.4z",
    "M0-4.2L4 3H-4z",
    "M0-4.6L4.6 0L0 4.6L-4.6 0z",
    "M0 4.2L4-3H-4z",
    "M-1.2-4.2h2.4v3h3v2.4h-3v3h-2.4v-3h-3v-2.4h3z",
)
_DASHES = ("", "7 3", "2 3", "9 3 2 3", "4 2", "12 4")
_COLOURS = 6
_BESIDE = 7.0
"""Distance between bars of two series at one place; a bar is 5 wide."""
_ROUNDING = 1e-9
"""Relative difference of values that are one: an axis of such values is as wide as one of a single value."""
_MOST_POINTS = 300
_SMALLEST = 1.0
"""Least size of a mark: smaller ones cannot be distinguished on a page."""


@dataclass(frozen=True)
class Series:
    """One line of a chart.

    Attributes:
        name: for the legend.
        x, y: its points.
        low, high: ends of a bar at every point, or nothing.
        curve: what is fitted to the points; it is then the line, low and high are its band, and the points stand alone.
        line: whether the points are joined.
        marks: whether every point carries a marker.
        step: whether the line is a staircase (values hold until the next point).
        mark: of the method it is of; None: the place of the series in the chart chooses.
    """

    name: str
    x: list[float]
    y: list[float]
    low: list[float] = field(default_factory=list)
    high: list[float] = field(default_factory=list)
    line: bool = True
    marks: bool = True
    step: bool = False
    mark: Mark | None = None
    curve: list[float] = field(default_factory=list)

    @property
    def bars(self) -> bool:
        """Whether points have bars; low and high of a fitted curve are its band."""
        return bool(self.low) and not self.curve

    @property
    def points(self) -> bool:
        """Whether there is any point; of wide brackets alone there are bars only."""
        return any(math.isfinite(value) for value in self.y)


@dataclass(frozen=True)
class Chart:
    """A chart: what is on its axes and its series.

    Attributes:
        title, x_label, y_label: texts.
        series: its lines.
        log_x, log_y: whether an axis is logarithmic.
        zero_y: whether the upright axis begins at zero.
        levels: names and values of level lines.
        whole: whether the level axis counts, so that only whole numbers stand at it.
        dots: places (x, y) that are marked on the lines.
    """

    title: str
    x_label: str
    y_label: str
    series: list[Series]
    log_x: bool = False
    log_y: bool = False
    zero_y: bool = False
    levels: list[tuple[str, float]] = field(default_factory=list)
    whole: bool = False
    dots: list[tuple[float, float]] = field(default_factory=list)

    def aside(self, number: int) -> float:
        """How far the bars of a series, and its points with them, stand beside their place, so that none hide others.

        In units of the drawing; zero where no other series has bars.
        """
        barred = [k for k, series in enumerate(self.series) if series.bars]
        return _BESIDE * (barred.index(number) - (len(barred) - 1) / 2.0) if number in barred else 0.0

    @property
    def per_row(self) -> int:
        """How many names of series stand beside each other."""
        longest = max((len(series.name) for series in self.series), default=0)
        return max(1, min(PER_ROW, int((WIDTH - LEFT - RIGHT) / (42 + LETTER * longest))))


def ticks(low: float, high: float, wanted: int = 5) -> list[float]:
    """Round numbers within an interval, about so many."""
    if not high > low:
        return [low]
    raw = (high - low) / wanted
    scale = 10.0 ** math.floor(math.log10(raw))
    step = next(step * scale for step in (1.0, 2.0, 2.5, 5.0, 10.0) if step * scale >= raw * (1 - 1e-12))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [k * step for k in range(first, last + 1)]


def _log_ticks(low: float, high: float) -> list[float]:
    """Powers of ten within an interval; with 2 and 5 between them where it spans less than two decades."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    heads = (1.0,) if math.log10(high / low) > 2.0 else (1.0, 2.0, 5.0)
    found = [head * 10.0**k for k in decades for head in heads]
    return [value for value in found if low * (1 - 1e-9) <= value <= high * (1 + 1e-9)]


class Axis:
    """One axis: limits, ticks, and the place of a value."""

    def __init__(self, values: list[float], start: float, end: float, *, log: bool, zero: bool = False) -> None:
        values = [value for value in values if math.isfinite(value) and (value > 0.0 or not log)]
        low, high = (min(values), max(values)) if values else (1.0, 10.0)
        self.log, self.start, self.end = log, start, end
        if log:
            low, high = low / 1.25, high * 1.25
        else:
            low = min(low, 0.0) if zero else low
            apart = high - low if high - low > _ROUNDING * max(abs(low), abs(high)) else 0.0
            room = 0.06 * apart or 0.05 * abs(high) or 0.5
            low, high = (low if zero and low == 0.0 else low - room), high + room
        self.low, self.high = low, high
        self.ticks = _log_ticks(low, high) if log else ticks(low, high)

    def place(self, value: float) -> float | None:
        """Where a value is drawn, or None if it has no place on this axis."""
        if not math.isfinite(value) or (self.log and value <= 0.0):
            return None
        if self.log:
            share = math.log(value / self.low) / math.log(self.high / self.low)
        else:
            share = (value - self.low) / (self.high - self.low)
        return self.start + share * (self.end - self.start)

    def text(self, value: float) -> str:
        """A tick's label."""
        if self.log and not 1e-2 <= value < 1e4:
            return numbers.power(value)
        return "0" if value == 0.0 else _short(value, self._digits)

    @property
    def _digits(self) -> int:
        """Significant digits that tell one tick from the next."""
        if self.log or len(self.ticks) < 2:
            return 4
        step = self.ticks[1] - self.ticks[0]
        largest = max(abs(self.ticks[0]), abs(self.ticks[-1]))
        return max(4, math.ceil(math.log10(largest / step) + 1e-9) + 1)


def _short(value: float, digits: int = 4) -> str:
    return f"{value:.{digits}g}".replace("-", "−") if 1e-3 <= abs(value) < 1e5 else numbers.power(value, 2)


def thin(x: list[float], y: list[float], most: int = _MOST_POINTS) -> tuple[list[float], list[float]]:
    """A path with at most about so many points; in every stretch the first, lowest and highest are kept."""
    if len(x) <= most:
        return x, y
    size = math.ceil(3 * len(x) / most)
    kept: list[int] = []
    for start in range(0, len(x), size):
        stretch = range(start, min(start + size, len(x)))
        kept.extend(sorted({start, min(stretch, key=y.__getitem__), max(stretch, key=y.__getitem__)}))
    if kept[-1] != len(x) - 1:
        kept.append(len(x) - 1)
    return [x[k] for k in kept], [y[k] for k in kept]


class DrawnChart(Markup):
    """A chart as an SVG element that still knows what it shows, so that its data can be written beside it."""

    chart: Chart | None = None


@dataclass(frozen=True)
class Plot:
    """Where a chart draws: rows of its legend, upper edge and height of the plot, and its axes."""

    rows: int
    top: int
    height: int
    across: Axis
    up: Axis

    @classmethod
    def of(cls, chart: Chart) -> Plot:
        """The plot of a chart, as wide as its values."""
        rows = math.ceil(len(chart.series) / chart.per_row) if len(chart.series) > 1 else 0
        above = rows * ROW + NAMED
        top, height = TOP + above, HEIGHT + above
        xs = [value for series in chart.series for value in series.x]
        ys = [value for series in chart.series for value in [*series.y, *series.low, *series.high]]
        ys += [value for _, value in chart.levels]
        across = Axis(xs, LEFT, WIDTH - RIGHT, log=chart.log_x)
        if chart.whole:
            across.ticks = [value for value in across.ticks if value == round(value)]
        return cls(rows, top, height, across, Axis(ys, height - BOTTOM, top, log=chart.log_y, zero=chart.zero_y))

    def dots(self, chart: Chart) -> list[tuple[float, float]]:
        """Where the dots of the chart stand, in units of its drawing."""
        places = [(self.across.place(x), self.up.place(y)) for x, y in chart.dots]
        return [(x, y) for x, y in places if x is not None and y is not None]


def svg(chart: Chart) -> Markup:
    """The chart as an inline SVG element, a `Drawing`."""
    frame = Plot.of(chart)
    rows, top, height, across, up = frame.rows, frame.top, frame.height, frame.across, frame.up
    parts = [
        Markup('<svg class="chart" viewBox="0 0 {} {}" role="img" aria-label="{}">').format(WIDTH, height, chart.title),
        _axes(chart, across, up, height, top),
    ]
    parts.append(_levels(chart, up))
    for number, series in enumerate(chart.series):
        parts.append(_series(series, number, across, up, chart.aside(number)))
        if rows:
            parts.append(_legend(series, number, chart.per_row))
    if chart.dots:
        dots = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in frame.dots(chart))
        parts.append(Markup('<path class="dots-on" d="{}"/><path class="here" d=""/>').format(dots))
    parts.append(Markup("</svg>"))
    drawing = DrawnChart(Markup("").join(parts))
    drawing.chart = chart
    return drawing


def _levels(chart: Chart, up: Axis) -> Markup:
    """Levels with their names above them, the next one's on the other side, below its line where it is taken too."""
    drawn, taken = Markup(""), {"start": -math.inf, "end": -math.inf}
    for name, y in sorted(((name, up.place(value)) for name, value in chart.levels), key=lambda pair: pair[1] or 0.0):
        if y is None:
            continue
        anchor = "start" if y - 4 - taken["start"] >= NOTE or taken["end"] > taken["start"] else "end"
        base = max(y - 4, taken[anchor] + NOTE)
        taken[anchor] = base
        drawn += Markup(
            '<path class="level" d="M{} {:.1f}H{}"/><text class="note {}" x="{}" y="{:.1f}">{}</text>'
        ).format(LEFT, y, WIDTH - RIGHT, anchor, LEFT + 6 if anchor == "start" else WIDTH - RIGHT - 4, base, name)
    return drawn


def _axes(chart: Chart, across: Axis, up: Axis, height: float, top: float) -> Markup:
    grid, base = "", height - BOTTOM
    texts = Markup("")
    for value in across.ticks:
        x = across.place(value)
        if x is not None:
            grid += f"M{x:.1f} {top}V{base}"
            texts += Markup('<text x="{:.1f}" y="{}" class="mid">{}</text>').format(x, base + 16, across.text(value))
    for value in up.ticks:
        y = up.place(value)
        if y is not None:
            grid += f"M{LEFT} {y:.1f}H{WIDTH - RIGHT}"
            texts += Markup('<text x="{}" y="{:.1f}" class="end">{}</text>').format(LEFT - 7, y + 4, up.text(value))
    texts += Markup('<text x="{:.0f}" y="{}" class="mid axis">{}</text>').format(
        (LEFT + WIDTH - RIGHT) / 2, height - 8, chart.x_label
    )
    texts += Markup('<text x="4" y="{}" class="axis">{}</text>').format(top - 12, chart.y_label)
    frame = f"M{LEFT} {top}V{base}H{WIDTH - RIGHT}"
    return Markup('<path class="grid" d="{}"/><path class="frame" d="{}"/>').format(grid, frame) + texts


def _look(series: Series, number: int) -> tuple[Markup, Markup, str, str]:
    """Attributes of a line and of a marker of a series, its dash array and the path data of its marker."""
    if series.mark is None:
        name = f"s{number % _COLOURS}"
        line, marker = Markup('class="line {}"').format(name), Markup('class="mark {}"').format(name)
        return line, marker, _DASHES[number % len(_DASHES)], _MARKERS[number % len(_MARKERS)]
    line = Markup('class="line" style="color:{}"').format(series.mark.colour)
    marker = Markup('class="mark" style="color:{}"').format(series.mark.colour)
    return line, marker, series.mark.dashes, series.mark.shape


def _series(series: Series, number: int, across: Axis, up: Axis, aside: float) -> Markup:
    def place_of(x: float) -> float | None:
        place = across.place(x)
        return None if place is None else place + aside

    x_values, y_values = thin(series.x, series.y) if not series.low else (series.x, series.y)
    places = [(place_of(x), up.place(y), x, y) for x, y in zip(x_values, y_values, strict=True)]
    points = [(px, py, x, y) for px, py, x, y in places if px is not None and py is not None]
    drawn = Markup("")
    line, marker, dashes, shape = _look(series, number)
    if series.curve:
        drawn += _fitted(series, number, across, up)
    elif series.line and len(points) > 1:
        path, joined = "", False
        for px, py, _, _ in places:
            if px is None or py is None:  # no value here: the line has a gap
                joined = False
                continue
            on = f"H{px:.1f}V{py:.1f}" if series.step else f"L{px:.1f} {py:.1f}"
            path, joined = path + (on if joined else f"M{px:.1f} {py:.1f}"), True
        drawn += Markup('<path {} stroke-dasharray="{}" d="{}"/>').format(line, dashes, path)
    bar = _as_bar(line)
    for x, low, high in zip(series.x, series.low, series.high, strict=False) if series.bars else ():
        place, bottom, top = place_of(x), up.place(low), up.place(high)
        if place is not None and bottom is not None and top is not None:
            drawn += Markup('<path {} d="M{:.1f} {:.1f}V{:.1f}"/>').format(bar, place, bottom, top)
    # Later series are smaller, so that points on one place show as rings.
    size = max(_SMALLEST, 1.35 - 0.15 * number)
    if series.marks or len(points) == 1:
        for px, py, x, y in points:
            drawn += Markup(
                '<path {} transform="translate({:.1f} {:.1f}) scale({:.3g})" d="{}"><title>{}</title></path>'
            ).format(marker, px, py, size, shape, f"{series.name}: {x:.6g}, {y:.6g}")
    return drawn


def _fitted(series: Series, number: int, across: Axis, up: Axis) -> Markup:
    """The curve of a series with its band behind it."""
    line, _, dashes, _ = _look(series, number)

    def path(values: list[float]) -> list[str]:
        places = [(across.place(x), up.place(y)) for x, y in zip(series.x, values, strict=True)]
        return [f"{px:.1f} {py:.1f}" for px, py in places if px is not None and py is not None]

    band = "L".join([*path(series.low), *reversed(path(series.high))])
    style = Markup(str(line).replace('class="line', 'class="band'))
    return Markup('<path {} d="M{}Z"/><path {} stroke-dasharray="{}" d="M{}"/>').format(
        style, band, line, dashes, "L".join(path(series.curve))
    )


def _legend(series: Series, number: int, per_row: int) -> Markup:
    width = (WIDTH - LEFT - RIGHT) / per_row
    x = LEFT + (number % per_row) * width
    y = TOP + (number // per_row) * ROW - 2
    line, marker, dashes, shape = _look(series, number)
    sample = Markup("")
    if series.bars and not series.points:
        sample = Markup('<path {} d="M{:.0f} {}v10"/>').format(_as_bar(line), x + 13, y - 5)
    elif series.line:
        sample = Markup('<path {} stroke-dasharray="{}" d="M{:.0f} {}h26"/>').format(line, dashes, x, y)
    if series.marks and series.points:
        sample += Markup('<path {} transform="translate({:.0f} {})" d="{}"/>').format(marker, x + 13, y, shape)
    return sample + Markup('<text x="{:.0f}" y="{}">{}</text>').format(x + 32, y + 4, series.name)


def _as_bar(line: Markup) -> Markup:
    """Attributes of the bars of a series from those of its line."""
    return Markup(str(line).replace('class="line', 'class="bar'))
