"""Multipliers of several walls and methods in one figure, in the colours and marks that the methods name."""

from __future__ import annotations

from matplotlib.figure import Figure

from harness.model.comparison import ComparisonRun
from reports import words
from reports.figures import COLUMN, GREY, INK, style

TALLEST = 9.2
"""Height of a page [inch]."""


def multipliers_figure(run: ComparisonRun) -> Figure:
    """One row a wall, one point a method; a bracket is a bar. What is not accepted by the judge is hollow."""
    ordered = sorted(
        {result.method: result for item in run.cases for result in item.results}.values(),
        key=lambda result: words.order(result.method, result.family),
    )
    with style():
        page = Figure(figsize=(COLUMN, min(TALLEST, 0.9 + 0.32 * len(run.cases))), layout="constrained")
        axes = page.subplots()
        for place, first in enumerate(ordered):
            shift = 0.6 * ((place + 0.5) / len(ordered) - 0.5)
            colour, marker = first.traits.colour or INK, first.traits.marker or "o"
            axes.plot([], [], marker, color=colour, markersize=4, label=first.method)
            for row, item in enumerate(run.cases):
                result = item.of(first.method)
                if result is None or result.multiplier is None:
                    continue
                fill = colour if result.judge.accepted else "none"
                axes.plot(result.multiplier, row + shift, marker, color=colour, markerfacecolor=fill, markersize=4)
                if result.bracket is not None:
                    axes.plot(result.bracket, (row + shift, row + shift), color=colour, linewidth=0.8)
        axes.set_yticks(range(len(run.cases)), [item.case.id for item in run.cases])
        axes.set_ylim(len(run.cases) - 0.4, -0.6)
        axes.set_xlabel("multiplier of the live load")
        axes.grid(axis="x", color=GREY, linewidth=0.3)
        page.legend(loc="outside upper center", ncols=4, frameon=False)
    return page
