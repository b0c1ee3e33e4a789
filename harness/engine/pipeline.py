"""Runs are found in the store or made, judged, held against references, and kept."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from typing import TYPE_CHECKING

from harness.engine.executors import Executor, LocalExecutor
from harness.engine.judge import judge
from harness.engine.run import Run
from harness.engine.verdict import compare, overall
from harness.model.errors import InputError
from harness.model.result import Result

if TYPE_CHECKING:
    from harness.engine.store import Store

Told = Callable[[Run, Result, bool], None]
"""Called after every run with the run, its result and whether it came from the store."""


def judged(run: Run, result: Result, tolerance: float) -> Result:
    """A result with the judge's word, its comparisons and the doubts about its wall, made anew from what is stored."""
    _fits(run, result)
    known = {"judge": judge(run.case.assembly, result, tolerance), "warnings": list(run.case.warnings)}
    result = result.model_copy(update=known)
    comparisons = [compare(reference, result) for reference in run.references]
    return result.model_copy(update={"comparisons": comparisons, "verdict": overall(comparisons)})


def _fits(run: Run, result: Result) -> None:
    """Refuse a result whose arrays are not of the size of its wall, as of a store that another hand has changed.

    Raises:
        InputError: naming the run and the array.
    """
    blocks, interfaces = run.case.assembly.n_blocks, run.case.assembly.n_interfaces
    for name, rows in (("forces", interfaces), ("states", interfaces), ("mechanism", blocks)):
        listed = getattr(result, name)
        if listed is not None and len(listed) != rows:
            raise InputError(
                f"its {name} have {len(listed)} entries and its wall needs {rows}: it was not made for this wall",
                "Run with --fresh to make it again",
                f"the stored result of {run.method} on {run.case.id}",
            )


def execute(
    runs: Sequence[Run],
    store: Store | None,
    jobs: int,
    *,
    fresh: bool = False,
    told: Told | None = None,
    executor: Executor | None = None,
) -> list[Result]:
    """Results of runs, in their order. Each is stored as soon as it is there.

    Args:
        runs: what to run.
        store: where results are looked for and kept; None: nowhere.
        jobs: number of child processes at a time.
        fresh: run what is in the store as well.
        told: called after each run.
        executor: where runs are made; None: in child processes of this machine.
    """
    results: dict[int, Result] = {}
    with closing(executed(runs, store, executor or LocalExecutor(jobs), fresh=fresh)) as ended:
        for number, result, stored in ended:
            results[number] = result
            if told:
                told(runs[number], result, stored)
    return [results[number] for number in range(len(runs))]


def executed(
    runs: Sequence[Run], store: Store | None, executor: Executor, *, fresh: bool = False
) -> Generator[tuple[int, Result, bool]]:
    """Numbers and results of runs as they end, and whether the result came from the store: those first.

    A run that is planned twice is made once. Closing the generator stops what is under way; what ended is stored.
    """
    waiting: dict[str, list[int]] = {}
    for number, run in enumerate(runs):
        found = None if store is None or fresh else store.get(run.key)
        if found is None:
            waiting.setdefault(run.key, []).append(number)
        else:
            yield number, _of_run(run, *found), True
    firsts = [runs[numbers[0]] for numbers in waiting.values()]
    jobs = (run.job(place) for place, run in enumerate(firsts))
    with closing(executor.map(jobs, {run.method for run in firsts})) as made:
        for place, measured in made:
            run = firsts[place]
            kept = measured.result.model_copy(update={"key": run.key})
            if store is not None:
                store.put(run.key, kept, measured.tolerance)
            for number in waiting[run.key]:
                yield number, _of_run(runs[number], kept, measured.tolerance), False


def _of_run(run: Run, result: Result, tolerance: float) -> Result:
    return judged(run, result.model_copy(update={"case": run.case.id}), tolerance)
