"""Our own values of an earlier release, and whether today's are better, the same or worse.

A lower collapse state of a method that seeks the least one is better; a higher one is worse. For a method that measures
with a bracket the two brackets must meet. For every other method any change beyond rounding is worse until it is
recorded with a reason.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, model_validator

from harness.engine.run import Run
from harness.model.errors import InputError
from harness.model.json_text import format_in_words, read_json
from harness.model.method import Finding, Status
from harness.model.reading import validate
from harness.model.result import Result
from harness.model.writing import write_whole

_ROUNDING = 1e-8
"""Relative change of a multiplier that counts as none: what differs between processors and library builds."""


class Change(StrEnum):
    """How a value stands to the baseline."""

    SAME = "same"
    BETTER = "better"
    WORSE = "worse"
    NEW = "new"


_Multiplier = Annotated[float, Field(ge=0.0, strict=True)]
"""As the judge accepts it: no live load brings a collapse at a negative one about."""


class Value(BaseModel):
    """What one method found on one case: an answer that the judge accepts, or that there was none."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)
    status: Status
    finding: Finding
    multiplier: _Multiplier | None = None
    bracket: tuple[_Multiplier, _Multiplier] | None = None

    @model_validator(mode="after")
    def _bracket_has_an_order(self) -> Value:
        if self.bracket is not None and self.bracket[0] > self.bracket[1]:
            raise ValueError("the bracket ends below its begin: give the lower end first")
        return self


class Entry(BaseModel):
    """One update of the baseline: when, by which release, why."""

    model_config = ConfigDict(extra="forbid")
    date: str
    release: str
    reason: str


class Baseline(BaseModel):
    """The recorded values, by case and method, and the history of their updates."""

    model_config = ConfigDict(extra="forbid")
    history: list[Entry] = Field(default_factory=list)
    values: dict[str, dict[str, Value]] = Field(default_factory=dict)


def read_baseline(path: Path) -> Baseline:
    """The baseline of a file; an empty one if there is none.

    Raises:
        InputError: a file that is no baseline.
    """
    if not path.exists():
        return Baseline()
    data = read_json(path)
    if not isinstance(data, dict) or "values" not in data:
        given = format_in_words(data) if isinstance(data, dict) and "format" in data else 'it has no "values"'
        remedy = "Give one as `drystone baseline update` writes it"
        raise InputError(f"it is not a baseline: {given}", remedy, source=str(path))
    return validate(Baseline, data, str(path))


def write_baseline(path: Path, baseline: Baseline) -> None:
    """Write the baseline, sorted, in place of the file."""
    data = baseline.model_dump(mode="json", exclude_none=True)
    data["values"] = {case: dict(sorted(rows.items())) for case, rows in sorted(data["values"].items())}
    write_whole(path, json.dumps(data, indent=1, allow_nan=False) + "\n")


def value_of(result: Result) -> Value:
    """What of a result the baseline keeps. An answer that the judge does not accept counts as not converged."""
    if result.status is not Status.OK or not result.judge.accepted:
        status = Status.NOT_CONVERGED if result.status is Status.OK else result.status
        return Value(status=status, finding=result.finding)
    return Value(status=result.status, finding=result.finding, multiplier=result.multiplier, bracket=result.bracket)


def change(old: Value | None, new: Value, *, seeks_least: bool) -> tuple[Change, str]:
    """How a value stands to the recorded one, with the figures."""
    if old is None:
        return Change.NEW, text_of(new)
    if new.status is not old.status or new.finding != old.finding:
        better = old.status is not Status.OK and new.status is Status.OK
        return (Change.BETTER if better else Change.WORSE), f"{text_of(old)} -> {text_of(new)}"
    if new.bracket is not None and old.bracket is not None:
        meets = new.bracket[0] <= old.bracket[1] and old.bracket[0] <= new.bracket[1]
        return (Change.SAME if meets else Change.WORSE), f"{text_of(old)} -> {text_of(new)}"
    if new.multiplier is None or old.multiplier is None:
        same = new.multiplier == old.multiplier
        return (Change.SAME if same else Change.WORSE), f"{text_of(old)} -> {text_of(new)}"
    difference = new.multiplier - old.multiplier
    if abs(difference) <= _ROUNDING * max(1.0, abs(old.multiplier)):
        return Change.SAME, text_of(new)
    better = seeks_least and difference < 0.0
    return (Change.BETTER if better else Change.WORSE), f"{text_of(old)} -> {text_of(new)} ({difference:+.2g})"


def text_of(value: Value) -> str:
    """A recorded value for a reader: the number, the bracket, or how the run ended."""
    if value.status is not Status.OK:
        return str(value.status).replace("_", " ")
    if value.bracket is not None:
        return f"[{value.bracket[0]:.7g}, {value.bracket[1]:.7g}]"
    return value.finding if value.multiplier is None else f"{value.multiplier:.10g}"


def compare_with(baseline: Baseline, runs: Sequence[Run], results: Sequence[Result]) -> list[dict[str, Any]]:
    """One row a run with default settings: case, method, change, figures."""
    rows = []
    for run, result in zip(runs, results, strict=True):
        if run.settings:
            continue
        old = baseline.values.get(run.case.id, {}).get(run.method)
        kind, figures = change(old, value_of(result), seeks_least=result.traits.seeks_least)
        rows.append({"case": run.case.id, "method": run.method, "change": str(kind), "figures": figures})
    return rows


def updated(baseline: Baseline, runs: Sequence[Run], results: Sequence[Result], entry: Entry) -> Baseline:
    """The baseline with the values of these results, and the reason on record."""
    values = {case: dict(rows) for case, rows in baseline.values.items()}
    for run, result in zip(runs, results, strict=True):
        if not run.settings:
            values.setdefault(run.case.id, {})[run.method] = value_of(result)
    return Baseline(history=[*baseline.history, entry], values=values)
