"""Cases that are one wall with one parameter varied: friction, or the proportion of its blocks. One plot a family."""

from __future__ import annotations

import hashlib
import itertools
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from harness.model.assembly import Assembly
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Status
from harness.model.result import Result, Verdict
from reports import charts, numbers, shapes, words

SMALLEST_FAMILY = 3


@dataclass(frozen=True)
class Study:
    """A chart with the sentence that introduces it and how to read it."""

    title: str
    sentence: str
    read: str
    drawing: Markup


def solved(result: Result) -> bool:
    """Whether a run counts as solved: it ended, the judge did not reject it, and no reference contradicts it."""
    return (
        result.status is Status.OK
        and result.judge.accepted is not False
        and result.verdict in (Verdict.AGREES, Verdict.NO_REFERENCE)
    )


def methods_of(run: ComparisonRun) -> list[str]:
    """Names of all methods of a comparison, in the paper's order."""
    found = {result.method: words.order(result.method, result.family) for item in run.cases for result in item.results}
    return sorted(found, key=lambda method: found[method])


@dataclass(frozen=True)
class Parameter:
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


def families(run: ComparisonRun) -> list[Study]:
    """Studies of all families of at least three walls, friction first."""
    sound = [item for item in run.cases if not shapes.problem(item.case)]
    return [study for parameter in PARAMETERS for study in _families(run, sound, parameter)]


def _families(run: ComparisonRun, items: list[CaseResults], parameter: Parameter) -> list[Study]:
    groups: dict[str, list[tuple[float, CaseResults]]] = defaultdict(list)
    for item in items:
        value = parameter.value(item.case.assembly)
        if value is not None:
            groups[parameter.key(item.case.assembly)].append((value, item))
    found = []
    for members in groups.values():
        if len({value for value, _ in members}) < SMALLEST_FAMILY:
            continue
        members.sort(key=lambda pair: pair[0])
        series = _series(members, methods_of(run))
        if series:
            found.append(_study(members, series, parameter))
    return found


def _series(members: list[tuple[float, CaseResults]], methods: list[str]) -> list[charts.Series]:
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
            )
        )
    return series


def _study(members: list[tuple[float, CaseResults]], series: list[charts.Series], parameter: Parameter) -> Study:
    title = members[0][1].case.file.title
    chart = charts.Chart(f"Multiplier against {parameter.name}, {title}", parameter.label, "multiplier", series)
    return Study(
        f"Multiplier against {parameter.name}: {title} and its kin",
        f"The same wall with {len({value for value, _ in members})} values of {parameter.name}, all methods in one "
        f"plot. {_changes(members)}",
        "A bar is a bracket. Where a line bends, another mechanism takes over; where the lines part, the answer "
        "depends on the flow rule or on the path, and the least one known is the one to trust.",
        charts.svg(chart),
    )


def _changes(members: list[tuple[float, CaseResults]]) -> str:
    """Between which values the set of slipping, rocking and open interfaces changes, of LA or else of FE."""
    seen: list[tuple[float, str]] = []
    for value, item in members:
        result = item.of("la") or item.of("fe")
        if result is not None and result.states and solved(result):
            seen.append((value, "".join(words.STATE_LETTER.get(state, "k") for state in result.states)))
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


def _friction(assembly: Assembly) -> float | None:
    values = {round(float(mu), 9) for mu in assembly.friction}
    return values.pop() if len(values) == 1 else None


def _same_but_friction(assembly: Assembly) -> str:
    return _digest(*assembly.polygons, assembly.end1, assembly.end2, assembly.dead, assembly.live)


def _proportion(assembly: Assembly) -> float | None:
    """Width over height of the middle block, if the free blocks are upright rectangles."""
    ratios = []
    for block in assembly.free:
        polygon = assembly.polygons[block]
        size = polygon.max(axis=0) - polygon.min(axis=0)
        if len(polygon) != 4 or float(size.min()) <= 0.0:
            return None
        ratios.append(float(size[0] / size[1]))
    return round(float(np.median(ratios)), 6)


def _same_but_proportion(assembly: Assembly) -> str:
    """Polygons stretched to the unit square, who touches whom, and friction; loads as multiples of the weights."""
    extent = shapes.extent(assembly)
    low, size = np.array([extent.left, extent.bottom]), np.array([extent.width, extent.height])
    polygons = [(polygon - low) / size for polygon in assembly.polygons]
    weight = np.where(assembly.weight > 0.0, assembly.weight, 1.0)[:, None]
    loads = [assembly.dead[:, :2] / weight, assembly.live[:, :2] / weight]
    contacts = [np.asarray(assembly.block_a), np.asarray(assembly.block_b), assembly.friction]
    return _digest(*polygons, *contacts, *loads)


PARAMETERS = (
    Parameter("friction", "friction tan φ", _friction, _same_but_friction),
    Parameter("proportion", "width of a block over its height", _proportion, _same_but_proportion),
)
