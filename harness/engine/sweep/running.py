"""The runs of a study are made or found, judged and kept; each becomes a row."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

from harness.engine.executors import Executor
from harness.engine.pipeline import executed
from harness.engine.store import Store
from harness.engine.sweep.expand import SweepRun
from harness.model.columns import ResultColumn, ResultRow, chosen
from harness.model.errors import InputError
from harness.model.method import Finding, Status
from harness.model.result import Result
from harness.model.table import TableColumn, values

Row = dict[str, Any]
"""A run as a row of the study's table: the columns of `STUDY` and what varied."""


def sweep(
    runs: Sequence[SweepRun], store: Store, executor: Executor, *, fresh: bool = False
) -> Generator[tuple[SweepRun, Row, bool]]:
    """Every run of a study with its row, as they end, and whether it came from the store: those first.

    Args:
        runs: of `expand`.
        store: where results are looked for and kept; only this process writes it.
        executor: where runs are made.
        fresh: make again what is in the store as well.

    Closing the generator stops what is under way; what has ended is in the store.
    """
    refused: list[tuple[int, InputError]] = []
    with closing(executed(runs, store, executor, fresh=fresh, whole=False, refused=refused)) as ended:
        for place, result, stored in ended:
            yield runs[place], row_of(runs[place], result), stored
    for place, error in refused:
        yield runs[place], refused_row(runs[place], str(error)), False


@dataclass(frozen=True)
class _StudyRow:
    """What a column of a study is a function of: a run, and its result; None where the wall cannot be built."""

    run: SweepRun
    result: Result | None = None


StudyColumn = TableColumn[_StudyRow]


def _from_result(*names: str) -> tuple[StudyColumn, ...]:
    """Columns of results, for the results of a study."""

    def of_result(column: ResultColumn) -> StudyColumn:
        def value(row: _StudyRow) -> Any:
            return None if row.result is None else column.value(ResultRow(row.result))

        return StudyColumn(column.name, column.dtype, column.unit, column.meaning, value, column.title)

    return tuple(of_result(column) for column in chosen(*names))


def _status(row: _StudyRow) -> str:
    return str(Status.REFUSED if row.result is None else row.result.status)


def _finding(row: _StudyRow) -> str:
    return str(Finding.NONE if row.result is None else row.result.finding)


def _later(row: _StudyRow) -> None:
    """No value: `handed_on` fills it in."""


STUDY: tuple[StudyColumn, ...] = (
    StudyColumn("number", "Int64", "1", "of the run in its study", attrgetter("run.number")),
    StudyColumn("case", "string", "", "id of the wall", attrgetter("run.variant.source.name")),
    StudyColumn("draw", "Int64", "1", "of a distribution; missing on a grid", attrgetter("run.variant.draw")),
    StudyColumn("method", "string", "", "name of the method", attrgetter("run.method")),
    *_from_result("family"),
    StudyColumn("status", "string", "", "how the run ended", _status),
    StudyColumn("finding", "string", "", "finding on the wall", _finding),
    *_from_result("multiplier"),
    StudyColumn(
        "from_neighbour",
        "boolean",
        "",
        "whether a mechanism of a neighbouring wall led to it; missing: none given, or not all were tried",
        _later,
    ),
    StudyColumn(
        "multiplier_alone", "Float64", "1", "what the run had found by itself, where a neighbour led lower", _later
    ),
    StudyColumn(
        "neighbour_failure",
        "string",
        "",
        "how a run with mechanisms of neighbours ended that did not try them all; missing: none, or all were tried",
        _later,
    ),
    *_from_result("bracket_low", "bracket_high", "bracket_wide", "judge_accepted", "judge_worst_residual"),
    *_from_result("cpu_seconds", "wall_seconds", "peak_memory_bytes", "blocks", "interfaces", "iterations", "started"),
    StudyColumn("key", "string", "", "under which the result is stored", attrgetter("run.key"), "key in the store"),
    *_from_result("sentence"),
)
"""Columns of every study. What the study varies comes after `case`."""


def row_of(run: SweepRun, result: Result, columns: Sequence[StudyColumn] = STUDY) -> Row:
    """The row of a result, as JSON values."""
    return _varied(run) | values(columns, _StudyRow(run, result))


def refused_row(run: SweepRun, sentence: str, columns: Sequence[StudyColumn] = STUDY) -> Row:
    """The row of a wall that cannot be built; nothing is stored of it."""
    return _varied(run) | values(columns, _StudyRow(run)) | {"sentence": sentence}


def _varied(run: SweepRun) -> Row:
    return {name: str(value) if isinstance(value, list | dict) else value for name, value in run.varied.items()}
