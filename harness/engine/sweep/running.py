"""The runs of a study are made or found, judged and kept; each becomes a row."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import closing
from typing import Any

from harness.engine.executors import Executor, Job
from harness.engine.judge import judge
from harness.engine.store import Store
from harness.engine.sweep.expand import SweepRun, Walls
from harness.model.assembly import Assembly
from harness.model.errors import InputError
from harness.model.method import Finding, Status, Traits
from harness.model.result import Judgement, exceeds_accuracy

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
    waiting: dict[str, list[SweepRun]] = {}
    stored = {} if fresh else store.summaries({run.key for run in runs})
    for run in runs:
        if run.key in stored:
            yield run, row_of(run, stored[run.key]), True
        else:
            waiting.setdefault(run.key, []).append(run)
    firsts = {same[0].number: same[0] for same in waiting.values()}
    walls, assemblies, refused = Walls(), dict[int, Assembly](), list[tuple[SweepRun, InputError]]()

    def jobs() -> Iterator[Job]:
        for run in firsts.values():
            try:
                assemblies[run.number] = walls.assembly(run.variant)
            except InputError as error:
                refused.append((run, error))
                continue
            yield Job(run.number, run.variant.source.name, run.task(assemblies[run.number]))

    with closing(executor.map(jobs(), {run.method for run in firsts.values()})) as made:
        for number, measured in made:
            run, assembly = firsts[number], assemblies.pop(number)
            result = measured.result.model_copy(
                update={
                    "key": run.key,
                    "judge": judge(assembly, measured.result, measured.tolerance),
                    "given": [motion.found_by for motion in run.given],
                }
            )
            store.put(run.key, result, measured.tolerance)
            summary = result.summary()
            for same in waiting[run.key]:
                yield same, row_of(same, summary), False
    for run, error in refused:
        for same in waiting[run.key]:
            yield same, refused_row(same, str(error)), False


TAKEN = (
    *("family", "status", "finding", "multiplier", "cpu_seconds", "wall_seconds", "peak_memory_bytes"),
    *("blocks", "interfaces", "iterations", "started", "sentence"),
)
"""Columns that are fields of a result."""


def row_of(run: SweepRun, summary: Mapping[str, Any]) -> Row:
    """The row of a result, given as JSON values."""
    low, high = summary.get("bracket") or (None, None)
    judgement = Judgement.model_validate(summary.get("judge") or {})
    beyond = None
    if low is not None and high is not None and summary.get("flow") == "approximate":
        beyond = exceeds_accuracy((low, high), Traits.model_validate(summary.get("traits") or {}))
    return (
        _place(run)
        | {name: summary.get(name) for name in TAKEN}
        | {"bracket_low": low, "bracket_high": high, "exceeds_accuracy": beyond, "judge_accepted": judgement.accepted}
        | {"judge_worst_residual": judgement.worst[1] if judgement.worst else None}
    )


def refused_row(run: SweepRun, sentence: str) -> Row:
    """The row of a wall that cannot be built; nothing is stored of it."""
    return _place(run) | {"status": str(Status.REFUSED), "finding": str(Finding.NONE), "sentence": sentence}


def _place(run: SweepRun) -> Row:
    plain = {name: str(value) if isinstance(value, list | dict) else value for name, value in run.varied.items()}
    place = {"number": run.number, "case": run.variant.source.name, "draw": run.variant.draw}
    return place | {"method": run.method, "key": run.key} | plain
