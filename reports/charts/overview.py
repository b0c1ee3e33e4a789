"""All walls of a comparison at a glance: how far the multiplier of each method lies above the least of its wall."""

from __future__ import annotations

import math

from harness.model.case import ReferenceType
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Status
from harness.model.proof import Standing, least_known, proof_of
from harness.model.ranges import range_of
from harness.model.result import Result
from reports.charts.dots import Above, Dot, DotPlot, DotRow, plain_scale
from reports.charts.styles import mark_of
from reports.geometry import shapes
from reports.labels import labels, numbers
from reports.labels.wall_summary import value_in_words

AGREE = 0.01
"""Multipliers within a hundredth agree, in the words of the paper's comparison."""


def overview_plot(run: ComparisonRun) -> DotPlot:
    """A row a wall: differences from the least collapse state known, a mark a family and one the associated maximum."""
    rows = [_row(number, item) for number, item in enumerate(run.cases)]
    values = [value for row in rows for value in _values(row)]
    title = "Multiplier of each method above the least collapse state known of its wall"
    return DotPlot(title, Above(values), rows, band=(0.0, AGREE))


def wall_plot(item: CaseResults) -> DotPlot:
    """The multipliers of one wall, a row a method."""
    shown = [result for result in plotted(item) if result.multiplier is not None]
    rows = [
        DotRow(r.method, [dot(item, r, 0.0)], value_in_words(r), levels=_levels(item, 0.0, r.method)) for r in shown
    ]
    values = [value for row in rows for value in _values(row)]
    return DotPlot(f"Multipliers of {item.case.id}", plain_scale(values), rows)


def plotted(item: CaseResults) -> list[Result]:
    """The main method of every family, and the associated maximum."""
    return [r for r in labels.in_order(item) if r.status is Status.OK and (r.is_main or r is item.associated)]


def dot(item: CaseResults, result: Result, base: float) -> Dot:
    """The mark of a result, filled where its multiplier is proved to be the minimum.

    Args:
        base: multiplier to which values are relative, as shares above it; 0: the values themselves.
    """
    ends = range_of(result) or (math.nan, math.nan)
    value = _over(math.nan if result.multiplier is None else result.multiplier, base)
    proof = proof_of(item, result)
    text = f"{result.method} {value_in_words(result)}{', ' + proof.label if proof.label else ''}"
    bar = (_over(ends[0], base), _over(ends[1], base)) if ends[0] < ends[1] else None
    name = f"{result.method}, upper bound" if result.traits.bounds_above else result.method
    return Dot(name, value, mark_of(result), text, bar, filled=proof.standing is Standing.MINIMUM)


def _over(value: float, base: float) -> float:
    return value / base - 1.0 if base else value


def _values(row: DotRow) -> list[float]:
    own = [value for dot in row.dots for value in (dot.value, *(dot.ends or ()))]
    return [*own, *(value for value, _ in row.levels)]


def _row(number: int, item: CaseResults) -> DotRow:
    name, href = item.case.id, f"#case-{number}"
    if shapes.problem(item.case):
        return DotRow(name, [], "cannot be built", href)
    found = [result for result in plotted(item) if result.finding.has_multiplier and result.judge.accepted is not False]
    least = least_known(item)
    base = least.multiplier if least is not None else min((r.multiplier or 0.0 for r in found), default=0.0)
    if not base or base < 0.0:
        answers = dict.fromkeys(labels.FINDING[r.finding] for r in item.mains if r.status is Status.OK)
        return DotRow(name, [], ", ".join(answers) or "no answer", href)
    dots = [dot(item, result, base) for result in found]
    return DotRow(name, dots, numbers.multiplier(base), href, _levels(item, base))


def _levels(item: CaseResults, base: float, method: str = "") -> list[tuple[float, str]]:
    """Known multipliers of a wall, or of one method, each once; values of our own earlier releases are not known."""
    found: dict[float, str] = {}
    for reference in item.case.file.references:
        applies = not method or method in reference.applies_to
        if reference.quantity != "multiplier" or reference.type is ReferenceType.REGRESSION or not applies:
            continue
        ends = reference.value if isinstance(reference.value, list | tuple) else (reference.value,)
        for end in ends:
            if isinstance(end, int | float):
                found.setdefault(_over(float(end), base), f"reference {numbers.given(float(end))}, {reference.source}")
    return sorted(found.items())
