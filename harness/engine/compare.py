"""What results of a comparison are together: rows by case, the gates of theory, and what the store remembers of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

from harness.engine.pipeline import judged
from harness.engine.provenance import machine, versions
from harness.engine.run import Limits, Run
from harness.engine.verdict import overall, theory_gates
from harness.model.case import Case, CaseFile, Reference
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.details import AnswerDetails
from harness.model.errors import InputError
from harness.model.method import Status, none_above
from harness.model.reading import parse_wall, validate
from harness.model.result import Result

if TYPE_CHECKING:
    from harness.engine.store import Store


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
        found = _with_upper_bound(CaseResults(case, list(rows.values())))
        gathered.append(CaseResults(case, found.results, theory_gates(found)))
    return gathered


def _with_upper_bound(found: CaseResults) -> CaseResults:
    """The results of a case; those without an answer end with the upper bound that another method has found."""
    bound = found.associated
    if bound is None or bound.multiplier is None:
        return found
    upper = AnswerDetails(bound.details).upper_bound or bound.multiplier
    said = f"{none_above(upper)}, by {bound.method}"
    return replace(
        found,
        results=[
            result.model_copy(update={"sentence": f"{result.sentence.rstrip('.')}; {said}"})
            if result.status not in (Status.OK, Status.REFUSED) and AnswerDetails(result.details).upper_bound is None
            else result
            for result in found.results
        ],
    )


def _settings_text(run: Run) -> str:
    return ", ".join(f"{name} = {value}" for name, value in sorted(run.settings.items()))


def comparison_run(
    title: str,
    command: str,
    cases: Sequence[Case],
    runs: Sequence[Run],
    results: Sequence[Result],
    *,
    created: str = "",
    provenance: Mapping[str, Any] | None = None,
) -> ComparisonRun:
    """What the report is made of, before certificates are looked at: `drystone.comparing` does both.

    Args:
        title, command: what was compared, and how to repeat it.
        cases: in the order of the report.
        runs, results: in one order.
        created: ISO time [UTC]; empty: now.
        provenance: of the comparison; None: that of this process.
    """
    return ComparisonRun(
        title=title,
        command=command,
        created=created or datetime.now(UTC).isoformat(timespec="seconds"),
        cases=gather(cases, runs, results),
        provenance={"versions": versions(), "machine": machine()} if provenance is None else dict(provenance),
    )


def remember(store: Store, compared: ComparisonRun, runs: Sequence[Run]) -> None:
    """Keep in the store what a comparison consisted of, so that `drystone report` can build its report again."""
    cases = {
        item.case.id: {
            "file": item.case.file.model_dump(mode="json"),
            "wall": item.case.wall.document(),
            "origin": item.case.origin,
            "wall_id": item.case.wall_id,
            "load_case": item.case.load_case,
            "load_place": item.case.load_place,
        }
        for item in compared.cases
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
    wall_id: str = ""
    load_case: str = ""
    load_place: str = ""


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
    content = store.last_comparison()
    if content is None:
        return None
    kept = validate(_Kept, content, f"{store.path}: the last comparison in it")
    cases = {
        name: Case(
            item.file,
            parse_wall(item.wall, item.origin),
            item.origin,
            wall_id=item.wall_id,
            load_case=item.load_case,
            load_place=item.load_place,
        )
        for name, item in kept.cases.items()
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
    head = kept.title, kept.command, list(cases.values())
    return comparison_run(*head, runs, results, created=kept.created, provenance=kept.provenance)
