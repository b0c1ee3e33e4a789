"""Two sets of answers side by side: what became better or worse, what slower, what came and what went.

A set is the last comparison of a result store, judged again, or a baseline. Times are compared in pairs, of one case
and method each, and only where both were measured on the same machine; a baseline keeps none.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Any

from harness.engine import baseline as recording
from harness.engine.baseline import Value, text_of, value_of
from harness.engine.compare import recall
from harness.engine.store import open_store
from harness.model.comparison import ComparisonRun
from harness.model.difference import Difference, Kind, Pairs, Row, Slower
from harness.model.errors import InputError
from harness.model.json_text import near
from harness.model.method_registry import load_method, method_names


@dataclass(frozen=True)
class Answered:
    """What one method answered on one case.

    Attributes:
        value: as a baseline keeps it.
        seeks_least: whether a lower value is a better one; None where that is not known.
        cpu_seconds: None where it was not measured.
        machine: what it was measured on; empty where that is not known.
    """

    value: Value
    seeks_least: bool | None = None
    cpu_seconds: float | None = None
    machine: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Answers:
    """A set of answers.

    Attributes:
        name: for the reader.
        rows: by case and method.
        walls: by case the wall in explicit form; none of a baseline.
        is_baseline: whether it holds more than anyone runs at a time, so that what is missing beside it is not gone.
    """

    name: str
    rows: dict[tuple[str, str], Answered]
    walls: dict[str, dict[str, Any]] = field(default_factory=dict)
    is_baseline: bool = False


def read_answers(path: Path) -> Answers:
    """The answers of a file: the last comparison of a store, or a baseline.

    Raises:
        InputError: a file that is neither, or a store without a comparison.
    """
    if not path.exists():
        raise InputError("there is no such file", near(path) or _RIGHT, "", str(path))
    if not path.is_file():
        raise InputError("it is not a regular file", _RIGHT, "", str(path))
    with path.open("rb") as stream:
        begins = stream.read(len(_SQLITE))
    if not begins:
        raise InputError("it is empty", _RIGHT, source=str(path))
    if begins != _SQLITE:
        recorded = recording.read_baseline(path).values
        rows = {(case, method): Answered(value) for case, kept in recorded.items() for method, value in kept.items()}
        return Answers(str(path), rows, is_baseline=True)
    with open_store(path, read_only=True) as store:
        compared = recall(store)
    if compared is None:
        raise InputError("no comparison is in the store", "Run `drystone compare` with it first", source=str(path))
    return _answers_of(compared, str(path))


_SQLITE = b"SQLite format 3\0"
_RIGHT = "Give a result store (.sqlite) or a baseline (.json)"


def _answers_of(compared: ComparisonRun, name: str) -> Answers:
    """The answers of a comparison."""
    rows = {
        (item.case.id, result.method): Answered(
            value_of(result), result.traits.seeks_least, result.cpu_seconds, result.machine
        )
        for item in compared.cases
        for result in item.results
    }
    return Answers(name, rows, {item.case.id: item.case.wall.document() for item in compared.cases})


def difference(old: Answers, new: Answers, slower: Slower | None = None) -> Difference:
    """How the new answers stand to the old ones.

    Args:
        old, new: the two sets.
        slower: when a run counts as slower; None: `Slower()`.
    """
    limit = slower or Slower()
    rows, not_run = [], 0
    for case, method in sorted(old.rows.keys() | new.rows.keys()):
        before, after = old.rows.get((case, method)), new.rows.get((case, method))
        if after is None and old.is_baseline:
            not_run += 1
            continue
        rows.append(_row(case, method, before, after, limit))
    order = list(Kind)
    rows.sort(key=lambda row: (order.index(row.kind), row.case, row.method))
    return Difference(old.name, new.name, rows, list(_pairs(rows)), not_run, list(_remarks(old, new)), limit)


def _row(case: str, method: str, old: Answered | None, new: Answered | None, limit: Slower) -> Row:
    if new is None:
        assert old is not None
        return Row(case, method, Kind.GONE, text_of(old.value), old.cpu_seconds)
    if old is None:
        return Row(case, method, Kind.NEW, text_of(new.value), None, new.cpu_seconds)
    change, figures = recording.change(old.value, new.value, seeks_least=_seeks_least(method, old, new))
    kind, ratio = Kind(str(change)), _ratio(old, new)
    longer = (new.cpu_seconds or 0.0) - (old.cpu_seconds or 0.0) > limit.floor
    if kind is Kind.SAME and longer and ratio is not None and ratio > 1.0 + limit.share:
        kind = Kind.SLOWER
    return Row(case, method, kind, figures, old.cpu_seconds, new.cpu_seconds, ratio)


def _seeks_least(method: str, old: Answered, new: Answered) -> bool:
    """Whether a method looks for the least state: as its results say, or the method where there are values only."""
    for said in (new.seeks_least, old.seeks_least):
        if said is not None:
            return said
    return load_method(method).traits.seeks_least if method in method_names() else False


def _ratio(old: Answered, new: Answered) -> float | None:
    if not old.cpu_seconds or new.cpu_seconds is None or not old.machine or old.machine != new.machine:
        return None
    return new.cpu_seconds / old.cpu_seconds


def _pairs(rows: list[Row]) -> Iterator[Pairs]:
    ratios: dict[str, list[float]] = {}
    for row in rows:
        if row.ratio is not None:
            ratios.setdefault(row.method, []).append(row.ratio)
    for method, found in sorted(ratios.items()):
        yield Pairs(method, len(found), median(found), sum(ratio > 1.0 for ratio in found))


def _remarks(old: Answers, new: Answers) -> Iterator[str]:
    changed = sorted(case for case in old.walls.keys() & new.walls.keys() if old.walls[case] != new.walls[case])
    if changed:
        yield f"The wall itself is another one in: {', '.join(changed)}."
    both = [(old.rows[pair], new.rows[pair]) for pair in old.rows.keys() & new.rows.keys()]
    if not both:
        yield "The two have no case and method in common."
    elif old.is_baseline or new.is_baseline:
        yield "A baseline keeps no times."
    elif any(before.machine != after.machine for before, after in both):
        yield "Runs measured on different machines are not compared in time."
