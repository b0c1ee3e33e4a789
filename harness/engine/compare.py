"""The main path: planned runs are made or found, judged, held against references and theory, and kept."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

from harness.engine.executors import Executor, LocalExecutor
from harness.engine.judge import judge
from harness.engine.provenance import machine, versions
from harness.engine.run import Run
from harness.engine.verdict import compare, overall, theory_gates
from harness.model.case import Case, CaseFile, Reference
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.errors import InputError
from harness.model.reading import parse_wall, validate
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


def gather(cases: Sequence[Case], runs: Sequence[Run], results: Sequence[Result]) -> list[CaseResults]:
    """Results by case. A run with settings of a reference adds its comparisons to the method's row."""
    gathered = []
    for case in cases:
        rows: dict[str, Result] = {}
        for run, result in zip(runs, results, strict=True):
            if run.case is not case:
                continue
            row = rows.get(run.method)
            if row is None:
                rows[run.method] = result
                continue
            named = [
                comparison.model_copy(update={"sentence": f"{comparison.sentence} (with {_settings_text(run)})"})
                for comparison in result.comparisons
            ]
            comparisons = [*row.comparisons, *named]
            rows[run.method] = row.model_copy(update={"comparisons": comparisons, "verdict": overall(comparisons)})
        found = CaseResults(case, list(rows.values()))
        gathered.append(CaseResults(case, found.results, theory_gates(found)))
    return gathered


def _settings_text(run: Run) -> str:
    return ", ".join(f"{name} = {value}" for name, value in sorted(run.settings.items()))


def comparison_run(
    title: str,
    command: str,
    cases: Sequence[Case],
    runs: Sequence[Run],
    results: Sequence[Result],
) -> ComparisonRun:
    """What the report is made of."""
    return ComparisonRun(
        title=title,
        command=command,
        created=datetime.now(UTC).isoformat(timespec="seconds"),
        cases=gather(cases, runs, results),
        provenance={"versions": versions(), "machine": machine()},
    )


def remember(store: Store, compared: ComparisonRun, runs: Sequence[Run]) -> None:
    """Keep in the store what a comparison consisted of, so that `drystone report` can build its report again."""
    cases = {
        run.case.id: {
            "file": run.case.file.model_dump(mode="json"),
            "wall": run.case.wall.document(),
            "origin": run.case.origin,
        }
        for run in runs
    }
    store.remember(
        compared.created,
        {
            "title": compared.title,
            "command": compared.command,
            "created": compared.created,
            "provenance": compared.provenance,
            "cases": cases,
            "runs": [
                {
                    "case": run.case.id,
                    "method": run.method,
                    "settings": run.settings,
                    "key": run.key,
                    "references": [reference.model_dump(mode="json") for reference in run.references],
                }
                for run in runs
            ],
        },
    )


class _KeptCase(BaseModel, defer_build=True):
    file: CaseFile
    wall: dict[str, Any]
    origin: str


class _KeptRun(BaseModel, defer_build=True):
    case: str
    method: str
    settings: dict[str, Any]
    key: str
    references: list[Reference]


class _Kept(BaseModel, defer_build=True):
    """What `remember` leaves in a store."""

    title: str
    command: str
    created: str
    provenance: dict[str, Any]
    cases: dict[str, _KeptCase]
    runs: list[_KeptRun]


def recall(store: Store) -> ComparisonRun | None:
    """The comparison made last, rebuilt from the store without running anything; None if there is none.

    Results are judged again.

    Raises:
        InputError: the store or what it keeps is damaged, or a run of the comparison is not in it any more.
    """
    from harness.engine.run import Limits

    content = store.last_comparison()
    if content is None:
        return None
    kept = validate(_Kept, content, f"{store.path}: the last comparison in it")
    cases = {
        name: Case(item.file, parse_wall(item.wall, item.origin), item.origin) for name, item in kept.cases.items()
    }
    runs: list[Run] = []
    results: list[Result] = []
    for item in kept.runs:
        found = store.get(item.key)
        if found is None:
            raise store.missing(f"the result of {item.method} on {item.case}")
        if item.case not in cases:
            raise InputError(f'the last comparison in it has no wall "{item.case}"', source=str(store.path))
        run = Run(cases[item.case], item.method, item.settings, Limits(), tuple(item.references))
        runs.append(run)
        results.append(judged(run, found[0].model_copy(update={"case": run.case.id}), found[1]))
    return ComparisonRun(
        title=kept.title,
        command=kept.command,
        created=kept.created,
        cases=gather(list(cases.values()), runs, results),
        provenance=kept.provenance,
    )
