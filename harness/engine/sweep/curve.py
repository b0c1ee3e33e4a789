"""The curve of a study, as the report of a comparison draws it: means over seeds and draws, with least and greatest.

A mean is stated with its standard error and to the digits that this leaves; that of one wall has none and says so.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from harness.engine.sweep.running import Row
from harness.engine.sweep.study import Curve, Study
from harness.model.assembly import FloatArray
from harness.model.errors import InputError
from harness.model.method import Finding

_WHAT = {True: "Mean change of the multiplier", False: "Mean multiplier"}


@dataclass
class _Line:
    """What is known of one line, by what stands on the axis.

    Attributes:
        found: multipliers.
        brackets: the ends of wide brackets, which are in no mean.
        fallen, lost: how many walls fell unloaded, and how many gave no answer.
    """

    found: dict[float, list[float]] = field(default_factory=lambda: defaultdict(list))
    brackets: dict[float, list[tuple[float, float]]] = field(default_factory=lambda: defaultdict(list))
    fallen: int = 0
    lost: int = 0


def curve_of(study: Study, rows: Iterable[Row]) -> dict[str, Any]:
    """What `reports.charts.studies` draws of a study: title, sentence, how to read it, labels, series.

    Args:
        study: one that says how it is drawn (`curve`).
        rows: of all its runs; those without an accepted multiplier are counted as lost.

    Raises:
        InputError: the study says nothing of a curve.
    """
    asked = study.curve
    if asked is None:
        raise InputError("it says nothing of a curve", "Give it a table [curve], or use `drystone sweep`", study.name)
    lines: dict[str, _Line] = defaultdict(_Line)
    for row in rows:
        line = lines[asked.labels.get(str(row.get(asked.apart)), str(row.get(asked.apart) or row["method"]))]
        if row.get("judge_accepted") is not False and row.get("finding") == Finding.FALLS:
            line.fallen += 1
        elif row.get("multiplier") is None or row.get("judge_accepted") is False:
            line.lost += 1
        elif row.get("bracket_wide"):
            line.brackets[float(row[asked.across])].append((float(row["bracket_low"]), float(row["bracket_high"])))
        else:
            line.found[float(row[asked.across])].append(float(row["multiplier"]))
    drawn = {name: points for name, line in lines.items() if (points := _points(line, asked))}
    said = [_in_words(name, points, lines[name], asked) for name, points in drawn.items()]
    return {
        "name": study.name,
        "title": study.title,
        "sentence": f"{_WHAT[asked.relative]}: {'; '.join(said)}.".replace("-", "−"),
        "read": asked.read or "Points are means, bars reach from the least to the greatest.",
        "x_label": asked.x_label or asked.across,
        "y_label": "change of the multiplier [%]" if asked.relative else "multiplier",
        "series": [_series(name, points) for name, points in drawn.items()],
    }


@dataclass(frozen=True)
class _Point:
    """Walls at one place on the axis: values (k,), and the ends of all walls, of which a value has two equal ones."""

    place: float
    values: FloatArray
    lows: FloatArray
    highs: FloatArray

    @property
    def brackets(self) -> int:
        """How many walls have a wide bracket instead of a value."""
        return len(self.lows) - len(self.values)

    @property
    def mean(self) -> float | None:
        """Of the values; None where there are brackets alone."""
        return float(self.values.mean()) if len(self.values) else None

    @property
    def means(self) -> tuple[float, float]:
        """The mean over all walls, if those with brackets collapse at the lower ends, and at the upper ones."""
        return float(self.lows.mean()), float(self.highs.mean())

    @property
    def errors(self) -> tuple[float, float]:
        """The standard errors of the two; zero of one wall."""
        return _standard_error(self.lows), _standard_error(self.highs)


def _standard_error(values: FloatArray) -> float:
    return float(values.std(ddof=1)) / math.sqrt(len(values)) if len(values) > 1 else 0.0


def _points(line: _Line, asked: Curve) -> list[_Point]:
    points = []
    for place in sorted({*line.found, *line.brackets}):
        values, brackets = line.found.get(place, []), line.brackets.get(place, [])
        ends = np.array([*zip(values, values, strict=True), *brackets], dtype=float)
        points.append(_Point(place, np.array(values), ends[:, 0], ends[:, 1]))
    return points if not asked.relative else [_change(point, points[0]) for point in points]


def _change(point: _Point, first: _Point) -> _Point:
    """Percent of change from the mean at the first place; as small and as large as brackets allow."""
    lower, upper = first.means
    values = point.values if first.mean is not None else point.values[:0]
    return _Point(
        point.place,
        100.0 * (values / (first.mean or 1.0) - 1.0),
        100.0 * (point.lows / upper - 1.0),
        100.0 * (point.highs / lower - 1.0),
    )


def _series(name: str, points: Sequence[_Point]) -> dict[str, Any]:
    return {
        "name": name,
        "x": [point.place for point in points],
        "y": [point.mean for point in points],
        "low": [float(point.lows.min()) for point in points],
        "high": [float(point.highs.max()) for point in points],
    }


def _in_words(name: str, points: Sequence[_Point], line: _Line, asked: Curve) -> str:
    """The end of a line with its scatter, where it passes the level that is asked about, and what is missing."""
    last, unit = points[-1], " %" if asked.relative else ""
    words = f"{name}: {_mean(last, unit, signed=asked.relative)} at {last.place:g} ({_of(last, unit)})"
    if asked.level is not None:
        words += f", {asked.level:g}{unit} {_reached(points, asked.level)}"
    brackets = sum(map(len, line.brackets.values()))
    missing = [
        (line.fallen, "fell under the dead load"),
        (line.lost, "gave no answer"),
        (brackets, "gave a wide bracket"),
    ]
    absent = " and ".join(f"{number} {'wall' if number == 1 else 'walls'} {what}" for number, what in missing if number)
    number = line.fallen + line.lost + brackets
    return words + (f"; {absent} and {'is' if number == 1 else 'are'} in no mean drawn" if absent else "")


def _mean(point: _Point, unit: str, *, signed: bool) -> str:
    """A mean and its standard error, both to the first digit of the error; between two ends where brackets leave it."""
    sign, (low, high), (error, _) = "+" if signed else "", point.means, point.errors
    if low < high:
        return f"between {low:{sign}.3g} and {high:{sign}.3g}{unit}"
    if not error:  # one value, or equal ones
        return f"{low:{sign}.{2 if signed else 3}g}{unit}"
    decimals = max(0, -math.floor(math.log10(error)))
    return f"{low:{sign}.{decimals}f} ± {error:.{decimals}f}{unit}"


def _of(point: _Point, unit: str) -> str:
    """Of how many walls a mean is, and how far apart these lie."""
    number = len(point.lows)
    if number == 1:
        return "one wall, scatter unknown"
    ends = f"single walls {float(point.lows.min()):.2g} to {float(point.highs.max()):.2g}{unit}"
    if point.brackets:
        return f"mean of {number} walls, {point.brackets} of them wide brackets; {ends}"
    return f"mean of {number} walls with its standard error; {ends}"


def _reached(points: Sequence[_Point], level: float) -> str:
    """Between which places the mean falls to a level, as far as brackets and standard error say."""
    x = [point.place for point in points]
    sooner = _where(x, [point.means[0] - point.errors[0] for point in points], level)
    middle = _where(x, [0.5 * sum(point.means) for point in points], level)
    later = _where(x, [point.means[1] + point.errors[1] for point in points], level)
    if sooner is None:
        return f"nowhere up to {x[-1]:g}"
    first = f"{sooner:.2g}"
    if later is None:
        by_mean = f"at about {middle:.2g}" if middle is not None else f"not up to {x[-1]:g}"
        return f"{by_mean} by the mean, within its uncertainty from {first} to beyond {x[-1]:g}"
    last = f"{later:.2g}"
    return f"at about {first}" if first == last else f"between {first} and {last}"


def _where(x: Sequence[float], y: Sequence[float], level: float) -> float | None:
    """Where a falling polyline first passes a level, or None."""
    for k in range(len(x) - 1):
        if y[k] > level >= y[k + 1]:
            return x[k] + (x[k + 1] - x[k]) * (y[k] - level) / (y[k] - y[k + 1])
    return None
