"""Multipliers of several walls and methods in one figure, in the colours and marks that the methods name."""

from __future__ import annotations

from matplotlib.figure import Figure

from harness.model.comparison import ComparisonRun
from harness.model.result import Result
from reports.charts.styles import mark_of
from reports.drawing.looks import COLOURS
from reports.figures.figures import COLUMN, style
from reports.labels import labels

_TALLEST = 9.2
"""Height of a page [inch]."""


def multipliers_figure(run: ComparisonRun) -> Figure:
    """One row a wall, one point a method; a bracket is a bar. What is not accepted by the judge is hollow."""
    ordered = sorted(
        _one_each(run),
        key=labels.order,
    )
    with style():
        page = Figure(figsize=(COLUMN, min(_TALLEST, 0.9 + 0.32 * len(run.cases))), layout="constrained")
        axes = page.subplots()
        for place, first in enumerate(ordered):
            shift = 0.6 * ((place + 0.5) / len(ordered) - 0.5)
            mark = mark_of(first)
            colour, marker = mark.colour, mark.marker
            axes.plot([], [], marker, color=colour, markersize=4, label=first.method)
            for row, item in enumerate(run.cases):
                result = item.of(first.method)
                if result is None or result.multiplier is None:
                    continue
                fill = colour if result.judge.accepted else "none"
                axes.plot(result.multiplier, row + shift, marker, color=colour, markerfacecolor=fill, markersize=4)
                if result.bracket is not None:
                    axes.plot(
                        result.bracket, (row + shift, row + shift), color=colour, linewidth=0.8, linestyle=mark.line
                    )
        axes.set_yticks(range(len(run.cases)), [item.case.id for item in run.cases])
        axes.set_ylim(len(run.cases) - 0.4, -0.6)
        axes.set_xlabel("multiplier of the live load")
        axes.grid(axis="x", color=COLOURS["grey"], linewidth=0.3)
        page.legend(loc="outside upper center", ncols=4, frameon=False)
    return page


def _one_each(run: ComparisonRun) -> list[Result]:
    """A result of every method, one with an answer where there is any: a run without tells no traits."""
    found: dict[str, Result] = {}
    for result in (result for item in run.cases for result in item.results):
        if result.method not in found or result.multiplier is not None:
            found[result.method] = result
    return list(found.values())
