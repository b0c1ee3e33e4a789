"""Studies over all cases of a comparison: cost against size, a performance profile, walls that differ in one parameter.

A comparison may bring further studies in `provenance["studies"]`, a list of objects with `title`, `sentence`, `read`,
`x_label`, `y_label`, `series` (each `name`, `x`, `y` and perhaps `low`, `high`) and perhaps `log_x`, `log_y`.
"""

from __future__ import annotations

import hashlib
import itertools
import math
from collections import defaultdict
from dataclasses import dataclass
from typing import Any

import numpy as np
from markupsafe import Markup

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Status
from harness.model.result import Result, Verdict
from reports import charts, numbers, shapes, words


@dataclass(frozen=True)
class Study:
    """A chart with the sentence that introduces it and how to read it."""

    title: str
    sentence: str
    read: str
    drawing: Markup


def studies(run: ComparisonRun) -> list[Study]:
    """All studies the results allow, then those the comparison brought."""
    found = [study for study in (cost_against_size(run), performance_profile(run)) if study is not None]
    found = [*friction_families(run), *found]
    given = run.provenance.get("studies", [])
    return found + [_given(item) for item in given if isinstance(item, dict)]


def solved(result: Result) -> bool:
    """Whether a run counts as solved: it ended, the judge did not reject it, and no reference contradicts it."""
    return (
        result.status is Status.OK
        and result.judge.accepted is not False
        and result.verdict in (Verdict.AGREES, Verdict.NO_REFERENCE)
    )


def _methods(run: ComparisonRun) -> list[str]:
    found = {result.method: words.order(result.method, result.family) for item in run.cases for result in item.results}
    return sorted(found, key=lambda method: found[method])


def cost_against_size(run: ComparisonRun) -> Study | None:
    """CPU time of solved runs against the number of free blocks, log-log, with slopes."""
    series, slopes = [], []
    for method in _methods(run):
        points = sorted(
            (result.blocks, result.cpu_seconds)
            for item in run.cases
            if (result := item.of(method)) is not None and solved(result) and result.cpu_seconds
        )
        if not points:
            continue
        x, y = [float(p[0]) for p in points], [float(p[1]) for p in points]
        series.append(charts.Series(method, x, y, line=False))
        slope = _slope(x, y)
        if slope is not None:
            slopes.append(f"{method} {slope:.2f}")
    if len({x for line in series for x in line.x}) < 2:
        return None
    chart = charts.Chart(
        "CPU time against number of blocks", "free blocks", "CPU time [s]", series, log_x=True, log_y=True
    )
    fitted = f" Fitted slopes over walls of at least 10 blocks: {', '.join(slopes)}." if slopes else ""
    return Study(
        "Cost against size",
        "What a wall costs grows with its number of blocks, differently for every method." + fitted,
        "Both axes are logarithmic: a slope of 1 means that twice the blocks cost twice the time. Only runs that "
        "ended with an accepted answer are drawn; time to start the process is not counted.",
        charts.svg(chart),
    )


def _slope(x: list[float], y: list[float], smallest: float = 10.0) -> float | None:
    """Slope of log y over log x by least squares, if there are at least 3 points that span a factor of 3."""
    pairs = [(math.log(a), math.log(b)) for a, b in zip(x, y, strict=True) if a >= smallest and b > 0.0]
    if len(pairs) < 3 or max(p[0] for p in pairs) - min(p[0] for p in pairs) < math.log(3.0):
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


def performance_profile(run: ComparisonRun) -> Study | None:
    """Share of all cases solved within a multiple of the fastest method's time."""
    methods = [method for method in _methods(run) if not method.startswith("la-associated")]
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
        series.append(charts.Series(method, x, [*y, y[-1]], marks=False, step=True))
    if len(series) < 2:
        return None
    unsolved = sum(not any(solved(result) for result in item.results) for item in run.cases)
    chart = charts.Chart(
        "Performance profile",
        "CPU time over that of the fastest method",
        "share of all cases solved",
        series,
        log_x=True,
        zero_y=True,
    )
    return Study(
        "Performance profile",
        f"How much of the {numbers.count(len(run.cases), 'case')} each method solved within a multiple of the "
        f"fastest method's time; {numbers.count(unsolved, 'case')} nobody solved.",
        "Higher is more often right, further left is faster. A run that failed, was rejected by the judge or "
        "contradicts a reference is not solved, however fast it was; a case that nobody solved counts for nobody. "
        "The associated maximum is left out: it answers an easier question.",
        charts.svg(chart),
    )


def _geometry_key(item: CaseResults) -> str:
    """What two walls that differ only in friction share: polygons, interfaces, weights and loads."""
    assembly = item.case.assembly
    digest = hashlib.sha256()
    arrays = [*assembly.polygons, assembly.end1, assembly.end2, assembly.dead, assembly.live]
    for array in arrays:
        digest.update(np.round(array, 9).tobytes())
        digest.update(str(array.shape).encode())
    return digest.hexdigest()


def friction_families(run: ComparisonRun) -> list[Study]:
    """Cases on the same wall with another friction each, as one plot a wall."""
    families: dict[str, list[tuple[float, CaseResults]]] = defaultdict(list)
    for item in run.cases:
        if shapes.problem(item.case):
            continue
        frictions = {round(float(mu), 9) for mu in item.case.assembly.friction}
        if len(frictions) == 1:
            families[_geometry_key(item)].append((frictions.pop(), item))
    found = []
    for members in families.values():
        if len({friction for friction, _ in members}) < 3:
            continue
        members.sort(key=lambda pair: pair[0])
        series = []
        for method in _methods(run):
            points = [
                (friction, result)
                for friction, item in members
                if (result := item.of(method)) is not None and result.multiplier is not None and solved(result)
            ]
            if points:
                brackets = [result.bracket for _, result in points] if method == "de" else []
                whole = bool(brackets) and all(brackets)
                series.append(
                    charts.Series(
                        method,
                        [friction for friction, _ in points],
                        [result.multiplier or 0.0 for _, result in points],
                        low=[pair[0] for pair in brackets if pair] if whole else [],
                        high=[pair[1] for pair in brackets if pair] if whole else [],
                    )
                )
        if not series:
            continue
        title = members[0][1].case.file.title
        chart = charts.Chart(f"Multiplier against friction, {title}", "friction tan φ", "multiplier", series)
        found.append(
            Study(
                f"Multiplier against friction: {title} and its kin",
                f"The same wall with {len(members)} values of friction, all methods in one plot. " + _changes(members),
                "A bar is a bracket. Where a line bends, another mechanism takes over; where the lines part, the "
                "answer depends on the flow rule or on the path, and only the least one is safe.",
                charts.svg(chart),
            )
        )
    return found


def _changes(members: list[tuple[float, CaseResults]]) -> str:
    """Between which frictions the set of slipping, rocking and open interfaces of limit analysis changes."""
    seen: list[tuple[float, str]] = []
    for friction, item in members:
        result = item.of("la") or item.of("fe")
        if result is not None and result.states and solved(result):
            seen.append((friction, "".join(words.STATE_LETTER.get(state, "k") for state in result.states)))
    changes = [
        f"{numbers.plain(a[0], 3)} and {numbers.plain(b[0], 3)}" for a, b in itertools.pairwise(seen) if a[1] != b[1]
    ]
    return f"The mechanism changes between {', '.join(changes)}." if changes else ""


def _given(item: dict[str, Any]) -> Study:
    """A study the comparison brought with it."""
    series = [
        charts.Series(
            str(line.get("name", "")),
            [float(value) for value in line.get("x", [])],
            [float(value) for value in line.get("y", [])],
            low=[float(value) for value in line.get("low", [])],
            high=[float(value) for value in line.get("high", [])],
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
    return Study(title, str(item.get("sentence", "")), str(item.get("read", "")), charts.svg(chart))
