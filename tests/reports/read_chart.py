"""Values read off a drawn chart, as a reader does, by the numbers at its axes; and the corners of paths."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

Points = list[tuple[float, float]]
NUMBER = r"-?\d*\.?\d+"
PLACE = re.compile(r"(-?[\d.]+) (-?[\d.]+)")


def points_of(path: str) -> np.ndarray:
    """All corners (k, 2) of path data with the letters M, L, l, h, H, v and z."""
    found: list[tuple[float, float]] = []
    for letter, words in re.findall(r"([MLlhHv])([^MLlhHvz]*)", path):
        values = [float(value) for value in re.findall(NUMBER, words)]
        x, y = found[-1] if found else (0.0, 0.0)
        if letter in "hHv":
            dx, dy = (values[0], 0.0) if letter == "h" else (0.0, values[0])
            found.append((values[0], y) if letter == "H" else (x + dx, y + dy))
        else:
            found.append((values[0], values[1]) if letter in "ML" else (x + values[0], y + values[1]))
    return np.array(found)


def _scale(texts: list[tuple[str, str]], *, log: bool) -> Callable[[float], float]:
    """The value at a place of an axis, by its first and last tick; the other ticks lie on the same line."""
    places = np.array([float(place) for place, _ in texts])
    values = np.array([float(value.replace("−", "-")) for _, value in texts])
    values = np.log(values) if log else values
    slope = (values[-1] - values[0]) / (places[-1] - places[0])
    np.testing.assert_allclose(values[0] + slope * (places - places[0]), values, atol=0.2 * abs(slope))  # of .1 pixel

    def value(place: float) -> float:
        read = float(values[0] + slope * (place - places[0]))
        return float(np.exp(read)) if log else read

    return value


class Read:
    """What the first chart of a text shows.

    Attributes:
        lines: the points of each line; of a staircase its corners.
        bars: (x, low, high) of every bar.
        marks: the points that carry a mark.
        at: the values at a place of the drawing.
    """

    def __init__(self, text: str, *, log_x: bool = False, log_y: bool = False) -> None:
        svg = text.partition('<svg class="chart"')[2].partition("</svg>")[0]
        across = _scale(re.findall(r'<text x="([\d.]+)" y="[\d.]+" class="mid">([^<]*)<', svg), log=log_x)
        heights = re.findall(r'<text x="[\d.]+" y="([\d.]+)" class="end">([^<]*)<', svg)
        up = _scale([(str(float(base) - 4.0), label) for base, label in heights], log=log_y)  # half a digit below

        self.at = lambda x, y: (across(x), up(y))

        def points(path: str) -> Points:
            corners = re.sub(r"H([\d.]+)V([\d.]+)", r"L\1 \2", path)
            return [(across(float(x)), up(float(y))) for x, y in PLACE.findall(corners)]

        drawn = re.findall(r'<path class="(line|bar)[^>]* d="([^"]*)"', svg)
        self.lines = [points(path) for kind, path in drawn if kind == "line" and "h26" not in path]
        ends = [re.fullmatch(r"M([\d.]+) ([\d.]+)V([\d.]+)", path) for kind, path in drawn if kind == "bar"]
        self.bars = [(across(float(end[1])), up(float(end[2])), up(float(end[3]))) for end in ends if end]
        placed = re.findall(r'<path class="mark[^>]*translate\(([\d.]+ [\d.]+)\) scale', svg)
        self.marks = [points(place)[0] for place in placed]
