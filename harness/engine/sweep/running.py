"""The runs of a study are made or found, judged and kept; each becomes a row."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import closing
from typing import Any

from harness.engine.executors import Executor
from harness.engine.pipeline import executed
from harness.engine.store import Store
from harness.engine.sweep.expand import SweepRun
from harness.model.errors import InputError
from harness.model.method import Finding, Status
from harness.model.result import Result, exceeds_accuracy

Row = dict[str, Any]
"""A run as a row of the study's table: the columns of `harness.engine.sweep.frame.COLUMNS` and what varied."""


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


TAKEN = (
    *("family", "status", "finding", "multiplier", "cpu_seconds", "wall_seconds", "peak_memory_bytes"),
    *("blocks", "interfaces", "iterations", "started", "sentence"),
)
"""Columns that are fields of a result."""


def row_of(run: SweepRun, result: Result) -> Row:
    """The row of a result, as JSON values."""
    low, high = result.bracket or (None, None)
    beyond = None
    if result.bracket is not None and result.flow == "approximate":
        beyond = exceeds_accuracy(result.bracket, result.traits)
    worst = result.judge.worst
    return (
        _place(run)
        | result.model_dump(mode="json", include=set(TAKEN))
        | {"bracket_low": low, "bracket_high": high, "exceeds_accuracy": beyond}
        | {"judge_accepted": result.judge.accepted, "judge_worst_residual": worst[1] if worst else None}
    )


def refused_row(run: SweepRun, sentence: str) -> Row:
    """The row of a wall that cannot be built; nothing is stored of it."""
    return _place(run) | {"status": str(Status.REFUSED), "finding": str(Finding.NONE), "sentence": sentence}


def _place(run: SweepRun) -> Row:
    plain = {name: str(value) if isinstance(value, list | dict) else value for name, value in run.varied.items()}
    place = {"number": run.number, "case": run.variant.source.name, "draw": run.variant.draw}
    return place | {"method": run.method, "key": run.key} | plain
