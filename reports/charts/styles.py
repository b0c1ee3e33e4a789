"""One colour, marker and line a method in all charts and figures, from its traits or, where it says none, its name."""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass

from harness.model.method import Traits
from harness.model.result import Result

_COLOURS = ("#14202b", "#6d2077", "#7a5c00", "#00666b", "#8c1d40", "#4a4a8a")
_DASHES = {"solid": "", "dashed": "7 3", "dotted": "2 3", "dashdot": "9 3 2 3"}


def _star(points: int, inner: float, turn: float, size: float = 4.3, wide: float = 1.0) -> str:
    """A star of so many points, or a polygon where `inner` is 1, as SVG path data."""
    steps = points if inner == 1.0 else 2 * points
    text = ""
    for k in range(steps):
        radius = size * (inner if inner != 1.0 and k % 2 else 1.0)
        angle = math.radians(turn) + 2.0 * math.pi * k / steps
        text += f"{'L' if k else 'M'}{wide * radius * math.sin(angle):.2f} {-radius * math.cos(angle):.2f}"
    return text + "z"


SHAPES = {
    "o": "M-3.5 0a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0-7 0z",
    "s": _star(4, 1.0, 45.0),
    "^": _star(3, 1.0, 0.0),
    "v": _star(3, 1.0, 180.0),
    "<": _star(3, 1.0, 270.0),
    ">": _star(3, 1.0, 90.0),
    "D": _star(4, 1.0, 0.0),
    "d": _star(4, 1.0, 0.0, wide=0.6),
    "p": _star(5, 1.0, 0.0),
    "h": _star(6, 1.0, 0.0),
    "8": _star(8, 1.0, 22.5),
    "*": _star(5, 0.4, 0.0, 4.8),
    "P": "M-1.4-4.2h2.8v2.8h2.8v2.8h-2.8v2.8h-2.8v-2.8h-2.8v-2.8h2.8z",
    "+": "M-.6-4.2h1.2v3.6h3.6v1.2h-3.6v3.6h-1.2v-3.6h-3.6v-1.2h3.6z",
    "X": _star(4, 0.45, 45.0, 4.8),
    "x": _star(4, 0.22, 45.0, 4.8),
}
"""Markers by the names matplotlib gives them, as SVG path data about the origin."""


@dataclass(frozen=True)
class Mark:
    """How a method is drawn.

    Attributes:
        colour: as "#rrggbb".
        marker: a key of `SHAPES`.
        line: "solid", "dashed", "dotted" or "dashdot".
    """

    colour: str
    marker: str
    line: str

    @property
    def dashes(self) -> str:
        """The line as an SVG dash array."""
        return _DASHES[self.line]

    @property
    def shape(self) -> str:
        """The marker as SVG path data."""
        return SHAPES[self.marker]


def mark_of(result: Result) -> Mark:
    """How the method of a result is drawn, the same in every chart of every report."""
    return mark_named(result.method, result.traits)


def mark_named(method: str, traits: Traits) -> Mark:
    """How a method is drawn.

    What its traits leave open is taken from its name, so that it does not depend on which other methods were run.
    """
    number = zlib.crc32(method.encode())
    markers, lines = list(SHAPES), list(_DASHES)
    known = traits.marker in SHAPES
    marker = traits.marker if known else markers[number % len(markers)]
    line = traits.line if known else lines[number // len(markers) % len(lines)]
    return Mark(traits.colour or _COLOURS[number // 64 % len(_COLOURS)], marker, line)
