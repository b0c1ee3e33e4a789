"""Curves of one case: load against displacement (FE), holds (DE), the least value known over the search (LA)."""

from __future__ import annotations

import math

import numpy as np
from markupsafe import Markup

from harness.model.assembly import Assembly
from harness.model.breakpoints import Breakpoint, breakpoints
from harness.model.comparison import CaseResults
from harness.model.details import AnswerDetails
from harness.model.displaced import carried, released
from harness.model.result import Result
from reports.charts import charts
from reports.charts.styles import mark_of
from reports.drawing.display_list import Frame
from reports.drawing.svg import inline
from reports.drawing.wall_drawing import displaced_drawing
from reports.labels import labels, numbers
from reports.memo import memo

_TIMES = ("cpu_seconds", "seconds", "search_seconds")
"""Columns of a path that tell when a value was found [s]."""
SAME = 1e-9
"""Relative difference of values that a chart would draw as one: there is nothing to see, and words say it."""
_LEVEL = 0.01
"""Part of the greatest load by which a plateau may rise or fall: a hundredth is not seen in a chart."""
_LENGTHS = ("live_displacement", "displacement")
_STEPS = ("opens", "slides")
"""Changes that are steps; a joint that closes or sticks again is none."""


@memo
def curves(item: CaseResults) -> list[tuple[str, Markup]]:
    """Captions and charts of a case, as far as its results recorded a path; an empty chart where words say it all."""
    found: list[tuple[str, Markup]] = []
    ordered = labels.in_order(item)
    for result in ordered:
        if "time" in result.path:
            found.extend(_release(item, result))
            continue
        loads = result.path.get("multiplier", [])
        if len(loads) < 2:
            continue
        for name in _LENGTHS:
            if name in result.path:
                found.append(_load_displacement(item, result, result.path[name], loads))
                break
        else:
            if "residual" in result.path:
                found.append(_holds(result))
                found.extend(_orders(result))
    found.extend(_starts(result) for result in ordered if len(AnswerDetails(result.details).start_values) > 1)
    history = _history(ordered)
    if history:
        found.append(history)
    return found


def _associated_level(multiplier: float) -> tuple[str, float]:
    return f"associated upper bound {numbers.multiplier(multiplier)}", multiplier


def _load_displacement(item: CaseResults, result: Result, moved: list[float], loads: list[float]) -> tuple[str, Markup]:
    levels = []
    associated = item.associated
    if associated is not None and associated.multiplier is not None:
        levels.append(_associated_level(associated.multiplier))
    details = AnswerDetails(result.details)
    for name, value in (("peak", details.peak), ("plateau", details.plateau)):
        if value is not None and not any(abs(value - level) < 1e-3 * abs(value) for _, level in levels):
            levels.append((f"{name} {numbers.multiplier(value)}", value))
    if (
        loads[0] > 0.0
    ):  # the first point of a path is a breakpoint: up to there the wall is linear, from no live load on
        moved, loads = [0.0, *moved], [0.0, *loads]
    shown, wall = _until_plateau(moved, loads), item.case.assembly
    added = len(loads) - len(result.path["multiplier"])
    changes = first_changes(result, wall, shown - added)
    chart = charts.Chart(
        title=f"Multiplier against live displacement, {result.method}",
        x_label=f"displacement of the live load [{item.case.wall.units.length}]",
        y_label="multiplier",
        series=[charts.Series(result.method, moved[:shown], loads[:shown], marks=False, mark=mark_of(result))],
        zero_y=True,
        levels=levels,
        dots=[(moved[step.place + added], loads[step.place + added]) for step in changes],
    )
    caption = f"{result.method}: the multiplier along the path over the work-conjugate displacement of the live load"
    if shown < len(loads):
        caption += "; the plateau continues beyond the right edge"
    more = Markup(" {}").format(_listed(chart, changes, wall)) if changes else ""
    return Markup("{}.{}").format(caption, more), charts.svg(chart)


def first_changes(result: Result, assembly: Assembly, shown: int) -> list[Breakpoint]:
    """The breakpoints among the first `shown` points of a path where a joint opens, or slides, for the first time."""
    first: dict[tuple[int, str], Breakpoint] = {}
    for found in breakpoints(result.path, assembly.n_interfaces):
        if found.change in _STEPS and found.place < shown:
            first.setdefault((found.joint, found.change), found)
    return list(first.values())


def _listed(chart: charts.Chart, steps: list[Breakpoint], assembly: Assembly) -> Markup:
    """The steps as a list, each with its place in the chart and the line of its joint in the drawing of the wall.

    Args:
        chart: with a dot for every step.
        steps: in the order of the dots.
        assembly: the wall.
    """
    ends = Frame.of(assembly).place(np.stack([assembly.end1, assembly.end2], axis=1))
    names = assembly.block_ids
    items = Markup("")
    for step, (x, y), (_, multiplier) in zip(steps, charts.Plot.of(chart).dots(chart), chart.dots, strict=True):
        a, b = names[assembly.block_a[step.joint]], names[assembly.block_b[step.joint]]
        line = " ".join(f"{value:.0f}" for value in ends[step.joint].ravel().tolist())
        items += Markup('<li data-at="{:.1f} {:.1f}" data-line="M{}">{}: {} | {} {}</li>').format(
            x, y, line, numbers.given(multiplier, 3), a, b, step.change
        )
    spot = Markup('<svg class="wall spot" aria-hidden="true"><use/><path class="lit" d=""/></svg>')
    text = "Dots: joints that first open or slide (arrow keys)."
    return Markup('{}{}<ol class="steps">{}</ol>').format(spot, text, items)


def _until_plateau(moved: list[float], loads: list[float]) -> int:
    """How many points to draw: a plateau followed to a huge displacement would squeeze the rest into the axis.

    Drawn is three times the displacement from which on the load stays within `_LEVEL` of its end.
    """
    top = max((abs(value) for value in loads), default=0.0)
    last = max((k for k, load in enumerate(loads) if abs(load - loads[-1]) > _LEVEL * top), default=None)
    if last is None:
        return len(loads)
    reached = min(last + 1, len(loads) - 1)
    limit = 3.0 * abs(moved[reached]) or math.inf
    return max(reached + 1, sum(abs(value) <= limit for value in moved))


def _release(item: CaseResults, result: Result) -> list[tuple[str, Markup]]:
    """The collapse after the bracket: displacement over time, and the wall at the end."""
    found = []
    moved = next((result.path[name] for name in _LENGTHS if name in result.path), None)
    release = AnswerDetails(result.details).release
    unit = "" if release is None else release.time_unit
    if moved is not None and len(moved) > 1:
        chart = charts.Chart(
            title=f"Displacement over time of the released wall, {result.method}",
            x_label=f"time [{unit}]" if unit else "time",
            y_label=f"displacement of the live load [{item.case.wall.units.length}]",
            series=[charts.Series(result.method, result.path["time"], moved, marks=False, mark=mark_of(result))],
        )
        found.append((f"{result.method}: the wall released just above its multiplier.", charts.svg(chart)))
    frames = released(result, item.case.assembly.n_blocks)
    if frames is not None:
        found.append(
            (
                f"{result.method}: the wall at the end of the release.",
                inline(displaced_drawing(item.case.assembly, item.case.id, carried(item.case.assembly, frames[-1]))),
            )
        )
    return found


def _holds(result: Result) -> tuple[str, Markup]:
    loads, residuals = result.path["multiplier"], result.path["residual"]
    details = AnswerDetails(result.details)
    held, moving = details.reported_order.held, details.reported_order.moving
    groups: dict[str, tuple[list[float], list[float]]] = {"held": ([], []), "moving": ([], []), "undecided": ([], [])}
    for number, (load, _) in enumerate(zip(loads, residuals, strict=False), start=1):
        if held is not None and load <= held:
            name = "held"
        elif moving is not None and load >= moving:
            name = "moving"
        else:
            name = "undecided"
        groups[name][0].append(float(number))
        groups[name][1].append(load)
    chart = charts.Chart(
        title=f"Load steps of {result.method}: multipliers held and moving",
        x_label="hold number",
        y_label="multiplier",
        series=[charts.Series(name, x, y, line=False) for name, (x, y) in groups.items() if x],
        whole=True,
    )
    orders = details.orders
    count = "" if orders is None else f" ({numbers.count(len(orders), 'sweep order')} tried)"
    return (
        f"{result.method}: the load steps of the reported sweep order narrow the bracket from both sides{count}.",
        charts.svg(chart),
    )


def _orders(result: Result) -> list[tuple[str, Markup]]:
    """The bracket of every sweep order, which shows the spread that rigid contacts leave."""
    orders = AnswerDetails(result.details).orders or ()
    ends = [
        (float(number), order.held, order.moving)
        for number, order in enumerate(orders, start=1)
        if order.held is not None and order.moving is not None
    ]
    if len(ends) < 2:
        return []
    x = [number for number, _, _ in ends]
    held = charts.Series("held", x, [low for _, low, _ in ends], line=False)
    moving = charts.Series(
        "moving",
        x,
        [high for _, _, high in ends],
        low=[low for _, low, _ in ends],
        high=[high for _, _, high in ends],
        line=False,
    )
    chart = charts.Chart(
        title=f"Brackets of {result.method} over sweep orders",
        x_label="sweep order",
        y_label="multiplier",
        series=[held, moving],
        whole=True,
    )
    names = ", ".join(f"{number} {order.name}" for number, order in enumerate(orders, start=1))
    return [(f"{result.method}: held and moving for every sweep order ({names}).", charts.svg(chart))]


def _starts(result: Result) -> tuple[str, Markup]:
    """The collapse states that the starts of a search lead to, and the least state found by each of them."""
    details = AnswerDetails(result.details)
    values = details.start_values
    if max(values) - min(values) <= SAME * abs(min(values)):
        every = f"each of {len(values)} starts of the search leads to {numbers.multiplier(min(values))}"
        return f"{result.method}: {every}.", Markup("")
    number = [float(k) for k in range(1, len(values) + 1)]
    least = [min(values[:k]) for k in range(1, len(values) + 1)]
    levels = []
    if details.associated is not None:
        levels.append(_associated_level(details.associated))
    if result.multiplier is not None and result.multiplier < min(values) * (1.0 - 1e-9):
        levels.append((f"least known, by descent {numbers.multiplier(result.multiplier)}", result.multiplier))
    chart = charts.Chart(
        title=f"Least known multiplier over the starts of {result.method}",
        x_label="start",
        y_label="multiplier",
        series=[
            charts.Series("least known so far", number, least, step=True, marks=False),
            charts.Series("found by this start", number, list(values), line=False),
        ],
        levels=levels,
        whole=True,
    )
    return f"{result.method}: the collapse state each start of the search leads to.", charts.svg(chart)


def _history(results: list[Result]) -> tuple[str, Markup] | None:
    """The least value known over search time, of every method that recorded when it found what."""
    series = []
    for result in results:
        column = next((name for name in _TIMES if name in result.path), None)
        values = result.path.get("least_known") or result.path.get("multiplier") or []
        if column is None or not values or len(values) != len(result.path[column]):
            continue
        least, seen = [], math.inf
        for value in values:
            seen = min(seen, value)
            least.append(seen)
        series.append(
            charts.Series(
                result.method, result.path[column], least, step=True, marks=len(least) <= 40, mark=mark_of(result)
            )
        )
    if not series:
        return None
    if all(len(line.x) == 1 for line in series):
        searches = [
            f"that of {line.name} reached {numbers.multiplier(line.y[0])} after {numbers.seconds(line.x[0])}"
            for line in series
        ]
        return f"Searches: {', '.join(searches)} of CPU time, and found nothing lower.", Markup("")
    levels = [
        _associated_level(result.multiplier)
        for result in results
        if result.traits.bounds_above and result.multiplier is not None
    ]
    chart = charts.Chart(
        title="Least known multiplier over search time",
        x_label="CPU time of the search [s]",
        y_label="least known multiplier",
        series=series,
        levels=levels,
    )
    return "The least collapse state known, over the time of the search.", charts.svg(chart)
