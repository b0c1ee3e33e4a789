"""Studies over all cases of a comparison: cost against size, a performance profile, walls of one kind.

A comparison may bring further studies in `provenance["studies"]`, a list of objects with `title`, `sentence`, `read`,
`x_label`, `y_label`, `series` (each `name`, `x`, `y` and perhaps `low`, `high`) and perhaps `log_x`, `log_y`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.result import Result
from reports.charts import charts
from reports.charts.families import StudyCurves, families, methods_of, solved
from reports.charts.grid import grids
from reports.charts.styles import Mark, mark_of
from reports.labels import numbers
from reports.labels.wall_summary import friction_text
from reports.memo import memo


@memo
def studies(run: ComparisonRun) -> list[StudyCurves]:
    """All studies the results allow, then those the comparison brought."""
    found = [study for study in (cost_against_size(run), performance_profile(run)) if study is not None]
    found = [*grids(run), *families(run), *found]
    given = run.provenance.get("studies", [])
    marks = {result.method: mark_of(result) for item in run.cases for result in item.results if solved(result)}
    return found + [_given(item, marks) for item in given if isinstance(item, dict)]


def cost_against_size(run: ComparisonRun) -> StudyCurves | None:
    """CPU time of collapses found against the number of free blocks and of interfaces, log-log, with slopes."""
    by_blocks = _costs(run, lambda item, result: result.blocks)
    by_interfaces = _costs(run, lambda item, result: item.case.assembly.n_interfaces)
    if len({x for line in by_blocks for x in line.x}) < 2:
        return None
    drawings = []
    for what, series in (("free blocks", by_blocks), ("interfaces", by_interfaces)):
        title = f"CPU time against number of {what}"
        chart = charts.Chart(title, what, "CPU time [s]", series, log_x=True, log_y=True)
        drawings.append((f"Against {what}", charts.svg(chart)))
    return StudyCurves(
        "Cost against size",
        _slopes(run),
        "Both axes are logarithmic: a slope of 1 means that twice the blocks cost twice the time. Only runs "
        "that found a collapse and were accepted are drawn; time to start the process is not counted. Limit "
        "analysis counts the whole search, which reaches its value much earlier.",
        drawings,
    )


def _costs(run: ComparisonRun, size: Callable[[CaseResults, Result], int]) -> list[charts.Series]:
    """CPU time of each method's collapses over the size of the wall."""
    series = []
    for method in methods_of(run):
        points = sorted((float(size(item, result)), seconds) for item, result, seconds in _collapses(run, method))
        if points:
            series.append(
                charts.Series(
                    method, [p[0] for p in points], [p[1] for p in points], line=False, mark=_mark(run, method)
                )
            )
    return series


def _collapses(run: ComparisonRun, method: str) -> Iterator[tuple[CaseResults, Result, float]]:
    for item in run.cases:
        result = item.of(method)
        if result is not None and solved(result) and result.finding.has_multiplier and result.cpu_seconds:
            yield item, result, result.cpu_seconds


def _slopes(run: ComparisonRun) -> str:
    """Slopes fitted over walls of one pattern and friction that differ in size, of which there must be four sizes."""
    found = []
    for method in methods_of(run):
        families: dict[tuple[str, str, str], list[tuple[float, float]]] = {}
        for item, result, seconds in _collapses(run, method):
            pattern = item.case.wall.pattern
            if pattern is not None and not isinstance(pattern, list):
                names = (pattern.type.replace("_", " "), friction_text(item.case.assembly))
                families.setdefault((*names, _all_but_size(item)), []).append((float(result.blocks), seconds))
        for (pattern_name, friction, _), points in families.items():
            slope = _slope([x for x, _ in points], [y for _, y in points])
            if slope is not None:
                sizes = len({x for x, _ in points})
                found.append(f"{method} {slope:.2f} ({pattern_name}, friction {friction}, {sizes} sizes)")
    if not found:
        return "There are fewer than four sizes of any one kind of wall, so no slope is fitted."
    return f"Slopes fitted over one kind of wall each: {'; '.join(found)}."


def _all_but_size(item: CaseResults) -> str:
    """What walls of one family share: the blocks of their pattern and how they are loaded, whatever their number."""
    pattern = item.case.wall.pattern
    assert pattern is not None
    assert not isinstance(pattern, list)
    blocks = pattern.model_dump(mode="json", exclude={"count", "bricks", "courses", "offsets", "prefix"})
    return json.dumps([blocks, item.case.wall.loads.model_dump(mode="json")], sort_keys=True)


def _mark(run: ComparisonRun, method: str) -> Mark:
    """How a method that solved some case of a run is drawn: from such a case, as a failed run knows no traits."""
    return next(mark_of(r) for item in run.cases for r in item.results if r.method == method and solved(r))


def _slope(x: list[float], y: list[float]) -> float | None:
    """Slope of log y over log x by least squares, if there are at least 4 sizes that span a factor of 3."""
    pairs = [(math.log(a), math.log(b)) for a, b in zip(x, y, strict=True) if a > 0.0 and b > 0.0]
    sizes = {first for first, _ in pairs}
    if len(sizes) < 4 or max(sizes) - min(sizes) < math.log(3.0):
        return None
    return float(np.polyfit([p[0] for p in pairs], [p[1] for p in pairs], 1)[0])


def profile(run: ComparisonRun, methods: list[str]) -> dict[str, list[float]]:
    """Per method the ratios of its time to the fastest method's, sorted, over the cases it solved.

    A case nobody solved counts for nobody but stays in the number of cases (Dolan and More 2002, with failures).
    """
    ratios: dict[str, list[float]] = {method: [] for method in methods}
    for item in run.cases:
        times = {
            method: result.cpu_seconds
            for method in methods
            if (result := item.of(method)) is not None and solved(result) and result.cpu_seconds
        }
        if not times:
            continue
        best = min(times.values())
        for method, seconds in times.items():
            ratios[method].append(seconds / best)
    return {method: sorted(values) for method, values in ratios.items()}


def performance_profile(run: ComparisonRun) -> StudyCurves | None:
    """Share of all cases solved within a multiple of the fastest method's time."""
    bounds = {r.method for item in run.cases for r in item.results if r.traits.bounds_above}
    methods = [method for method in methods_of(run) if method not in bounds]
    if len(run.cases) < 2 or len(methods) < 2:
        return None
    ratios = profile(run, methods)
    largest = max((values[-1] for values in ratios.values() if values), default=1.0) * 1.3
    series = []
    for method, values in ratios.items():
        if not values:
            continue
        x = [*values, max(largest, 10.0)]
        y = [(k + 1) / len(run.cases) for k in range(len(values))]
        series.append(charts.Series(method, x, [*y, y[-1]], marks=False, step=True, mark=_mark(run, method)))
    if len(series) < 2:
        return None
    unsolved = sum(not any(solved(result) for result in item.results) for item in run.cases)
    left = f"; {numbers.count(unsolved, 'case')} no method solved" if unsolved else ""
    chart = charts.Chart(
        "Performance profile",
        "CPU time over that of the fastest method",
        "share of all cases solved",
        series,
        log_x=True,
        zero_y=True,
    )
    return StudyCurves(
        "Performance profile",
        f"How much of the {numbers.count(len(run.cases), 'case')} each method solved within a multiple of the "
        f"fastest method's time{left}.",
        "Higher: more cases solved. Further left: faster. A run that failed, was rejected by the judge or "
        "contradicts a reference is not solved, however fast it was; a case that no method solved counts for "
        "none. A method does not solve a case on which it was not run. The associated maximum is excluded, "
        "because it solves an easier problem.",
        [("", charts.svg(chart))],
    )


def _given(item: dict[str, Any], marks: dict[str, Mark]) -> StudyCurves:
    """A study the comparison brought with it; a line that bears the name of a method has its mark."""
    series = [
        charts.Series(
            str(line.get("name", "")),
            [float(value) for value in line.get("x", [])],
            [math.nan if value is None else float(value) for value in line.get("y", [])],
            low=[float(value) for value in line.get("low", [])],
            high=[float(value) for value in line.get("high", [])],
            mark=marks.get(str(line.get("name", ""))),
        )
        for line in item.get("series", [])
    ]
    title = str(item.get("title", "Study"))
    chart = charts.Chart(
        title,
        str(item.get("x_label", "")),
        str(item.get("y_label", "")),
        series,
        log_x=bool(item.get("log_x", False)),
        log_y=bool(item.get("log_y", False)),
    )
    return StudyCurves(title, str(item.get("sentence", "")), str(item.get("read", "")), [("", charts.svg(chart))])
