"""How far families differ on a wall, as the shade of a cell: one scale for the report and for pages of studies."""

from __future__ import annotations

import math

from markupsafe import Markup

WITHIN = 0.01
"""Methods whose multipliers lie within a hundredth of the lowest agree, as in the other sentences of the report."""
_STEPS = (0.05, 0.2)
"""Least differences at which the shade changes: readers see three shades apart, not more."""
_WORDS = {
    "agree": "agree within 1 %",
    "open": "brackets do not decide",
    "differ-1": "differ by more than 1 %",
    "differ-2": "by more than 5 %",
    "differ-3": "by more than 20 %",
    "lost": "an answer is missing",
}
"""What each shade means, in the order of the legend."""


def shade(least: float, most: float) -> str:
    """The shade of a wall on which families differ by a share between two; NaN where an answer is missing."""
    if math.isnan(least) or math.isnan(most):
        return "lost"
    if most <= WITHIN:
        return "agree"
    if least <= WITHIN:
        return "open"
    return f"differ-{1 + sum(least > step for step in _STEPS)}"


def legend(used: set[str]) -> Markup:
    """The shades that a map has, in words."""
    items = Markup("").join(
        Markup('<li><span class="shade {}"></span>{}</li>').format(name, words)
        for name, words in _WORDS.items()
        if name in used
    )
    return Markup('<ul class="legend">{}</ul>').format(items)
