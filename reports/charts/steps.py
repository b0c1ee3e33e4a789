"""The steps of a load path: which joint opens or slides where, as a list that the script of the page brings to life."""

from __future__ import annotations

import numpy as np
from markupsafe import Markup

from harness.model.assembly import Assembly
from harness.model.breakpoints import Breakpoint, breakpoints
from harness.model.result import Result
from reports.charts.charts import Chart, Plot
from reports.drawing.display_list import Frame
from reports.labels import numbers

_NAMED = ("opens", "slides")
"""Changes that are steps; a joint that closes or sticks again is none."""


def first_changes(result: Result, assembly: Assembly, shown: int) -> list[Breakpoint]:
    """The breakpoints among the first `shown` points of a path where a joint opens, or slides, for the first time."""
    first: dict[tuple[int, str], Breakpoint] = {}
    for found in breakpoints(result.path, assembly.n_interfaces):
        if found.change in _NAMED and found.place < shown:
            first.setdefault((found.joint, found.change), found)
    return list(first.values())


def listed(chart: Chart, steps: list[Breakpoint], assembly: Assembly) -> Markup:
    """The steps as a list, each with its place in the chart and the line of its joint in the drawing of the wall.

    Args:
        chart: with a dot for every step.
        steps: in the order of the dots.
        assembly: the wall.
    """
    ends = Frame.of(assembly).place(np.stack([assembly.end1, assembly.end2], axis=1))
    names = assembly.block_ids
    items = Markup("")
    for step, (x, y), (_, multiplier) in zip(steps, Plot.of(chart).dots(chart), chart.dots, strict=True):
        a, b = names[assembly.block_a[step.joint]], names[assembly.block_b[step.joint]]
        line = " ".join(f"{value:.0f}" for value in ends[step.joint].ravel().tolist())
        items += Markup('<li data-at="{:.1f} {:.1f}" data-line="M{}">{}: {} | {} {}</li>').format(
            x, y, line, numbers.given(multiplier, 3), a, b, step.change
        )
    spot = Markup('<svg class="wall spot" aria-hidden="true"><use/><path class="lit" d=""/></svg>')
    text = "Dots: joints that first open or slide (arrow keys)."
    return Markup('{}{}<ol class="steps">{}</ol>').format(spot, text, items)
