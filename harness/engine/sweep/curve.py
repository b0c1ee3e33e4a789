"""The curve of a study, as the report of a comparison draws it: means over seeds and draws, with least and greatest."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from harness.engine.sweep.running import Row
from harness.engine.sweep.study import Curve, Study
from harness.model.errors import InputError

_WHAT = {True: "Mean change of the multiplier", False: "Mean multiplier"}


@dataclass
class _Line:
    """Multipliers of one line by what stands on the axis, and how many runs gave none."""

    found: dict[float, list[float]] = field(default_factory=lambda: defaultdict(list))
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
        if row.get("multiplier") is None or row.get("judge_accepted") is False:
            line.lost += 1
        else:
            line.found[float(row[asked.across])].append(float(row["multiplier"]))
    drawn = {name: _series(name, line, asked) for name, line in lines.items() if line.found}
    said = [_in_words(drawn[name], lines[name].lost, asked) for name in drawn]
    return {
        "name": study.name,
        "title": study.title,
        "sentence": f"{_WHAT[asked.relative]}: {'; '.join(said)}.".replace("-", "−"),
        "read": asked.read or "Points are means, bars reach from the least to the greatest.",
        "x_label": asked.x_label or asked.across,
        "y_label": "change of the multiplier [%]" if asked.relative else "multiplier",
        "series": list(drawn.values()),
    }


def _series(name: str, line: _Line, asked: Curve) -> dict[str, Any]:
    places = sorted(line.found)
    base = float(np.mean(line.found[places[0]]))
    values = [np.array(line.found[place]) for place in places]
    if asked.relative:
        values = [100.0 * (value / base - 1.0) for value in values]
    return {
        "name": name,
        "x": places,
        "y": [float(value.mean()) for value in values],
        "low": [float(value.min()) for value in values],
        "high": [float(value.max()) for value in values],
    }


def _in_words(series: dict[str, Any], lost: int, asked: Curve) -> str:
    """The end of a line, and where it passes the level that is asked about."""
    x, y = series["x"], series["y"]
    end = f"{y[-1]:+.1f} %" if asked.relative else f"{y[-1]:.4g}"
    words = f"{series['name']}: {end} at {x[-1]:g}"
    if asked.level is not None:
        reached = where(x, y, asked.level)
        level = f"{asked.level:g}{' %' if asked.relative else ''}"
        words += f", {level} " + (f"at about {reached:.3f}" if reached is not None else "nowhere up to that")
    return words + (f" ({lost} without an answer)" if lost else "")


def where(x: Sequence[float], y: Sequence[float], level: float) -> float | None:
    """Where a falling polyline first passes a level, or None."""
    for k in range(len(x) - 1):
        if y[k] > level >= y[k + 1]:
            return x[k] + (x[k + 1] - x[k]) * (y[k] - level) / (y[k] - y[k + 1])
    return None
