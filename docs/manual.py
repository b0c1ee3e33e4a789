"""The verification manual: every case with its references and what each method found when the baseline was recorded."""

from __future__ import annotations

from pathlib import Path

from harness.engine.baseline import Baseline, Value, read_baseline
from harness.engine.verdict import compare
from harness.model.case import Case, Reference, ReferenceType, case_folders, read_case, shipped_cases
from harness.model.result import Judgement, Result, Verdict
from reports.labels import numbers

KINDS = {
    ReferenceType.EXACT: "Verification: a closed form, or proved",
    ReferenceType.BOUND: "Verification: a bound no right answer may pass",
    ReferenceType.PUBLISHED: "Benchmark: computed by others",
    ReferenceType.MEASURED: "Validation: an experiment",
    ReferenceType.REGRESSION: "Regression: our own value of an earlier release",
}
"""What a disagreement with each type of reference would mean."""
RELATIONS = {"equal": "", "at_most": "at most ", "at_least": "at least ", "inside": "within ", "contains": "around "}
SIGNS = {Verdict.AGREES: "✓", Verdict.OUTSIDE_TOLERANCE: "≠", Verdict.VIOLATES_BOUND: "▲"}
RECORDED = ("multiplier", "finding")
"""Quantities that the baseline keeps."""


def manual_page(folder: Path) -> None:
    """All cases of the library, in alphabetical order."""
    baseline = read_baseline(shipped_cases() / "baseline.json")
    cases = [read_case(path) for path in case_folders([shipped_cases()]).values()]
    parts = ["# Verification manual", "", *_head(cases, baseline)]
    for case in cases:
        parts += _section(case, baseline.values.get(case.id, {}))
    (folder / "verification.md").write_text("\n".join(parts) + "\n", encoding="utf-8")


def _head(cases: list[Case], baseline: Baseline) -> list[str]:
    last = baseline.history[-1]
    rows = [line for case in cases for line in _held(case, baseline.values.get(case.id, {}))]
    count = {sign: sum(line[2] == sign for line in rows) for sign in SIGNS.values()}
    return [
        f"{len(cases)} cases with what is known of each, where it comes from, and what every method found when the",
        f"values were last recorded ({last.date}, release {last.release}). Only answers that the judge",
        "accepted are recorded.",
        "",
        f"Of {len(rows)} values held against a reference here, {count['✓']} agree (✓), {count['≠']} lie outside the",
        f"tolerance (≠) and {count['▲']} pass a bound (▲). References that ask for settings of their own, and counts",
        "of blocks or unknowns, are not in the record; `drystone check --tier full` runs them as well.",
        "",
        "Repeat one case with `drystone compare CASE`, all of them with `drystone compare --suite all`.",
        "",
    ]


def _section(case: Case, values: dict[str, Value]) -> list[str]:
    file = case.file
    parts = [f"## {file.id}", "", f"**{_plain(file.title)}**", ""]
    parts += [_plain(file.summary), ""] if file.summary else []
    parts += [f"Wall: {_plain(file.source)}.", ""]
    if file.references:
        parts += [
            "| kind | requirement | reference | tolerance, and why | source | found |",
            "|---|---|---|---|---|---|",
        ]
        parts += [_row(case, reference, values) for reference in file.references]
        parts.append("")
    if values:
        parts += ["| method | found |", "|---|---|"]
        parts += [f"| `{name}` | {_found(value)} |" for name, value in sorted(values.items())]
        parts.append("")
    parts += [f"- *Left open by the source:* {_plain(item.text)}" for item in file.errata]
    return [*parts, ""]


def _row(case: Case, reference: Reference, values: dict[str, Value]) -> str:
    value = reference.value
    known = (
        numbers.interval(value)
        if isinstance(value, tuple)
        else value
        if isinstance(value, str)
        else numbers.given(value, 10)
    )
    reason = (
        f"{reference.tolerance:.2g}: {_plain(reference.tolerance_reason)}" if reference.tolerance_reason else "none"
    )
    found = "<br>".join(f"`{name}` {text} {sign}" for name, text, sign in _of(case, reference, values))
    cells = [
        KINDS[reference.type],
        _plain(reference.requirement),
        RELATIONS[reference.relation] + known,
        reason,
        _plain(reference.source),
        found or "see `drystone check`",
    ]
    return "| " + " | ".join(cells) + " |"


def _held(case: Case, values: dict[str, Value]) -> list[tuple[str, str, str]]:
    return [line for reference in case.file.references for line in _of(case, reference, values)]


def _of(case: Case, reference: Reference, values: dict[str, Value]) -> list[tuple[str, str, str]]:
    """Method, value and sign of every recorded answer that a reference applies to."""
    if reference.settings or reference.quantity not in RECORDED:
        return []
    return [
        (name, _found(values[name]), SIGNS[compare(reference, _result(case, name, values[name])).verdict])
        for name in reference.applies_to
        if name in values
    ]


def _result(case: Case, method: str, value: Value) -> Result:
    """The result that a recorded value was taken from, as far as it is kept: only accepted answers are."""
    fields = value.model_dump()
    accepted = Judgement(accepted=True)
    return Result(case=case.id, method=method, family="", sentence="", blocks=0, interfaces=0, judge=accepted, **fields)


def _found(value: Value) -> str:
    if value.bracket is not None:
        return numbers.interval(value.bracket)
    return value.finding if value.multiplier is None else numbers.plain(value.multiplier, 8)


def _plain(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|").replace("$", "\\$").replace("<", "&lt;")
