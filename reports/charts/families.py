"""Cases that are one wall with one parameter varied: friction, or the proportion of its blocks. One plot a family."""

from __future__ import annotations

import hashlib
import itertools
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from markupsafe import Markup

from harness.model.assembly import Assembly, polygon_area
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Status
from harness.model.result import Result, Verdict
from reports.charts import charts
from reports.charts.styles import mark_of
from reports.geometry import shapes
from reports.labels import labels, numbers

_SMALLEST_FAMILY = 3
_RECTANGLE = 1e-6
"""Share of the rectangle round a block that may be missing from it: coordinates are rounded to micrometres."""

_Members = list[tuple[float, CaseResults]]
"""Cases of one family, each with its value of the parameter."""


@dataclass(frozen=True)
class StudyCurves:
    """Charts or a table with the sentence that introduces them and how to read them.

    Attributes:
        title, sentence, read: heading, what it says, how to read it.
        charts: drawings side by side, each with its caption, which is empty for a single one.
        table: a table in place of charts, or nothing.
    """

    title: str
    sentence: str
    read: str
    charts: list[tuple[str, Markup]] = field(default_factory=list)
    table: Markup = field(default_factory=Markup)


def solved(result: Result) -> bool:
    """Whether a run counts as solved: it ended, the judge accepts it, and no reference contradicts it."""
    return (
        result.status is Status.OK
        and bool(result.judge.accepted)
        and result.verdict in (Verdict.AGREES, Verdict.NO_REFERENCE)
    )


def methods_of(run: ComparisonRun) -> list[str]:
    """Names of all methods of a comparison, in the paper's order."""
    found = {result.method: labels.order(result) for item in run.cases for result in item.results}
    return sorted(found, key=lambda method: found[method])


@dataclass(frozen=True)
class _Parameter:
    """What varies within a family.

    Attributes:
        name, label: for titles and for the axis.
        value: of a wall; None where the wall has no single one.
        key: equal for walls that differ in this parameter alone.
    """

    name: str
    label: str
    value: Callable[[Assembly], float | None]
    key: Callable[[Assembly], str]


def families(run: ComparisonRun) -> list[StudyCurves]:
    """Studies of all families of at least three walls, friction first."""
    sound = [item for item in run.cases if not shapes.problem(item.case)]
    return [study for parameter in _PARAMETERS for study in _families(run, sound, parameter)]


def _families(run: ComparisonRun, items: list[CaseResults], parameter: _Parameter) -> Iterator[StudyCurves]:
    """Families over one parameter; those of one kind of wall, which the other parameter tells apart, stand together."""
    groups: dict[str, _Members] = defaultdict(list)
    for item in items:
        value = parameter.value(item.case.assembly)
        if value is not None:
            groups[parameter.key(item.case.assembly)].append((value, item))
    kinds: dict[str, list[_Members]] = defaultdict(list)
    for members in groups.values():
        if len({value for value, _ in members}) >= _SMALLEST_FAMILY:
            members.sort(key=lambda pair: pair[0])
            kinds[same_but_both(members[0][1].case.assembly)].append(members)
    for kin in kinds.values():
        drawn = [(members, series) for members in kin if (series := _series(members, methods_of(run)))]
        if drawn:
            yield _study(drawn, parameter)


def _series(members: _Members, methods: list[str]) -> list[charts.Series]:
    series = []
    for method in methods:
        points = [
            (value, result)
            for value, item in members
            if (result := item.of(method)) is not None and result.multiplier is not None and solved(result)
        ]
        if not points:
            continue
        brackets = [result.bracket for _, result in points if result.bracket is not None]
        whole = len(brackets) == len(points)
        series.append(
            charts.Series(
                method,
                [value for value, _ in points],
                [result.multiplier or 0.0 for _, result in points],
                low=[pair[0] for pair in brackets] if whole else [],
                high=[pair[1] for pair in brackets] if whole else [],
                mark=mark_of(points[0][1]),
            )
        )
    return series


def _study(drawn: list[tuple[_Members, list[charts.Series]]], parameter: _Parameter) -> StudyCurves:
    first = drawn[0][0]
    found = []
    for members, series in drawn:
        title = members[0][1].case.file.title
        chart = charts.Chart(f"Multiplier against {parameter.name}, {title}", parameter.label, "multiplier", series)
        found.append(
            (
                f"{title}, and the same with other {parameter.name}. {_changes(members)}" if len(drawn) > 1 else "",
                charts.svg(chart),
            )
        )
    how_many = (
        f"The same wall with {len({value for value, _ in first})} values of {parameter.name}, all methods in one plot"
    )
    return StudyCurves(
        f"Multiplier against {parameter.name}: walls that differ in it alone",
        f"{how_many}. {_changes(first)}" if len(drawn) == 1 else f"{how_many}; {len(drawn)} walls side by side.",
        "A bar is a bracket. Where a line bends, another mechanism takes over; where the lines differ, the "
        "answer depends on the flow rule or on the path, and the least known value is the safe one.",
        found,
    )


def _changes(members: _Members) -> str:
    """Between which values the set of slipping, rocking and open interfaces changes, of the least state or another."""
    seen: list[tuple[float, str]] = []
    for value, item in members:
        states = [r for r in item.mains if r.states and solved(r) and not r.traits.brackets]
        for result in sorted(states, key=lambda r: not r.traits.seeks_least)[:1]:
            seen.append((value, "".join(labels.STATE_LETTER.get(state, "k") for state in result.states or ())))
    changes = [
        f"{numbers.given(a[0], 3)} and {numbers.given(b[0], 3)}" for a, b in itertools.pairwise(seen) if a[1] != b[1]
    ]
    return f"The mechanism changes between {', between '.join(changes)}." if changes else ""


def _digest(*arrays: np.ndarray) -> str:
    digest = hashlib.sha256()
    for array in arrays:
        # Nine decimals: walls that a generator made twice are the same wall; adding 0.0 turns -0.0 into 0.0.
        digest.update(str(array.shape).encode())
        digest.update((np.round(np.asarray(array, dtype=float), 9) + 0.0).tobytes())
    return digest.hexdigest()


def friction_of(assembly: Assembly) -> float | None:
    """The friction of all interfaces, if they have one."""
    values = {round(float(mu), 9) for mu in assembly.friction}
    return values.pop() if len(values) == 1 else None


def _same_but_friction(assembly: Assembly) -> str:
    return _digest(*assembly.polygons, assembly.end1, assembly.end2, assembly.dead, assembly.live)


def proportion_of(assembly: Assembly) -> float | None:
    """Width over height of most blocks, if the free blocks are upright rectangles: bricks, not the halves at ends."""
    ratios = []
    for block in assembly.free:
        polygon = assembly.polygons[block]
        size = polygon.max(axis=0) - polygon.min(axis=0)
        if polygon_area(polygon) < (1.0 - _RECTANGLE) * float(size.prod()):
            return None
        ratios.append(float(size[0] / size[1]))
    counts = Counter(round(ratio, 6) for ratio in ratios)
    return max(counts, key=lambda ratio: (counts[ratio], ratio), default=None)


def _same_but_proportion(assembly: Assembly) -> str:
    return _digest(*_stretched(assembly), assembly.friction)


def same_but_both(assembly: Assembly) -> str:
    """A key that is equal for walls which differ in friction and proportion alone."""
    return _digest(*_stretched(assembly))


def _stretched(assembly: Assembly) -> list[np.ndarray]:
    """Polygons stretched to the unit square, who touches whom, and loads as multiples of the weights."""
    extent = shapes.extent(assembly)
    low, size = np.array([extent.left, extent.bottom]), np.array([extent.width, extent.height])
    polygons = [(polygon - low) / size for polygon in assembly.polygons]
    weight = np.where(assembly.weight > 0.0, assembly.weight, 1.0)[:, None]
    loads = [assembly.dead[:, :2] / weight, assembly.live[:, :2] / weight]
    return [*polygons, np.asarray(assembly.block_a), np.asarray(assembly.block_b), *loads]


_PARAMETERS = (
    _Parameter("friction", "friction tan φ", friction_of, _same_but_friction),
    _Parameter("proportion", "width of a block over its height", proportion_of, _same_but_proportion),
)
