"""The curve of a study, as the report of a comparison draws it: means over seeds and draws, with least and greatest.

A mean is told with its standard error and to the digits that this leaves; that of one wall has none and says so.
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
from harness.model.errors import InputError
from harness.model.method import Finding

_WHAT = {True: "Mean change of the multiplier", False: "Mean multiplier"}


@dataclass
class _Line:
    """Multipliers of one line by what stands on the axis; how many walls fell unloaded, and how many gave no answer."""

    found: dict[float, list[float]] = field(default_factory=lambda: defaultdict(list))
    fallen: int = 0
    lost: int = 0


def curve_of(study: Study, rows: Iterable[Row]) -> dict[str, Any]:
    """What `reports.studies` draws of a study: title, sentence, how to read it, labels, series.

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
        else:
            line.found[float(row[asked.across])].append(float(row["multiplier"]))
    drawn = {name: _points(line, asked) for name, line in lines.items() if line.found}
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
    """Values at one place on the axis."""

    place: float
    values: np.ndarray

    @property
    def mean(self) -> float:
        return float(self.values.mean())

    @property
    def error(self) -> float | None:
        """The standard error of the mean; None of one value."""
        return float(self.values.std(ddof=1)) / math.sqrt(len(self.values)) if len(self.values) > 1 else None


def _points(line: _Line, asked: Curve) -> list[_Point]:
    places = sorted(line.found)
    base = float(np.mean(line.found[places[0]]))
    values = [np.array(line.found[place]) for place in places]
    if asked.relative:
        values = [100.0 * (value / base - 1.0) for value in values]
    return [_Point(place, value) for place, value in zip(places, values, strict=True)]


def _series(name: str, points: Sequence[_Point]) -> dict[str, Any]:
    return {
        "name": name,
        "x": [point.place for point in points],
        "y": [point.mean for point in points],
        "low": [float(point.values.min()) for point in points],
        "high": [float(point.values.max()) for point in points],
    }


def _in_words(name: str, points: Sequence[_Point], line: _Line, asked: Curve) -> str:
    """The end of a line with its scatter, where it passes the level that is asked about, and what is missing."""
    last, unit = points[-1], " %" if asked.relative else ""
    words = f"{name}: {_mean(last, unit, signed=asked.relative)} at {last.place:g} ({_of(last, unit)})"
    if asked.level is not None:
        words += f", {asked.level:g}{unit} {_reached(points, asked.level)}"
    missing = [(line.fallen, "fell under the dead load"), (line.lost, "gave no answer")]
    told = " and ".join(f"{number} {'wall' if number == 1 else 'walls'} {what}" for number, what in missing if number)
    return words + (f"; {told} and {'is' if line.fallen + line.lost == 1 else 'are'} in no mean" if told else "")


def _mean(point: _Point, unit: str, *, signed: bool) -> str:
    """A mean and its standard error, both to the first digit of the error."""
    if not point.error:  # one value, or equal ones
        return f"{point.mean:{'+' if signed else ''}.{2 if signed else 3}g}{unit}"
    decimals = max(0, -math.floor(math.log10(point.error)))
    return f"{point.mean:{'+' if signed else ''}.{decimals}f} ± {point.error:.{decimals}f}{unit}"


def _of(point: _Point, unit: str) -> str:
    """Of how many walls a mean is, and how far apart these lie."""
    number = len(point.values)
    if number == 1:
        return "one wall, scatter unknown"
    ends = f"{float(point.values.min()):.2g} to {float(point.values.max()):.2g}{unit}"
    return f"mean of {number} walls with its standard error; single walls {ends}"


def _reached(points: Sequence[_Point], level: float) -> str:
    """Between which places the mean passes a level, given its standard error."""
    x = [point.place for point in points]
    sooner, later = (
        where(x, [point.mean + sign * (point.error or 0.0) for point in points], level) for sign in (-1.0, 1.0)
    )
    if sooner is None:
        return f"nowhere up to {x[-1]:g}"
    if later is None:
        return f"at {sooner:.2g} or beyond"
    first, last = f"{sooner:.2g}", f"{later:.2g}"
    return f"at about {first}" if first == last else f"between {first} and {last}"


def where(x: Sequence[float], y: Sequence[float], level: float) -> float | None:
    """Where a falling polyline first passes a level, or None."""
    for k in range(len(x) - 1):
        if y[k] > level >= y[k + 1]:
            return x[k] + (x[k + 1] - x[k]) * (y[k] - level) / (y[k] - y[k + 1])
    return None
