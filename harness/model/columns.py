"""The columns of results and of comparisons with references: for files, pandas, studies, terminal, report and docs."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any

from harness.model.case import Reference
from harness.model.method import Status
from harness.model.proof import Proof, Standing
from harness.model.result import Comparison, Result, plastic_and_residual_of
from harness.model.result_texts import PROVED, VERDICT_TEXTS, answer_text, references_text, settings_text
from harness.model.table import TableColumn


@dataclass(frozen=True)
class ResultRow:
    """What a column of results is a function of: a result, what is proved of it, and its load case in words."""

    result: Result
    proof: Proof = field(default_factory=Proof)
    load: str = ""


ResultColumn = TableColumn[ResultRow]


def _field(name: str, dtype: str, unit: str, meaning: str, title: str = "") -> ResultColumn:
    """A column that is a field of the result."""
    return ResultColumn(name, dtype, unit, meaning, attrgetter(f"result.{name}"), title)


def _text(name: str, meaning: str, value: Callable[[ResultRow], Any] | None = None, title: str = "") -> ResultColumn:
    """A column of texts; without `value` it is a field of the result."""

    def named(row: ResultRow) -> str:
        return str(getattr(row.result, name))

    return ResultColumn(name, "string", "", meaning, value or named, title)


def _facts(name: str, meaning: str) -> ResultColumn:
    """A column of names with values, as JSON in files."""

    def compact(row: ResultRow) -> str:
        return json.dumps(getattr(row.result, name), sort_keys=True, ensure_ascii=False, default=str)

    def words(row: ResultRow) -> str:
        return settings_text(getattr(row.result, name))

    return ResultColumn(name, "string", "", meaning, compact, words=words)


def _end(number: int) -> Callable[[ResultRow], float | None]:
    """The lower (0) or upper (1) end of the bracket."""
    return lambda row: row.result.bracket[number] if row.result.bracket else None


def _worst(number: int) -> Callable[[ResultRow], Any]:
    """The name (0) or the value (1) of the worst residual."""

    def worst(row: ResultRow) -> Any:
        found = row.result.judge.worst
        return None if found is None else found[number]

    return worst


RESULTS: tuple[ResultColumn, ...] = (
    _text("case", "id of the wall"),
    _text("method", "name of the method"),
    _text("family", "kind of method, by which the report groups"),
    _text("load_case", "of the wall, and where loads that travel stand in it", attrgetter("load")),
    _text("status", "how the run ended"),
    _text("finding", "finding on the wall"),
    _text("sentence", "the answer in a sentence"),
    ResultColumn(
        "multiplier",
        "Float64",
        "1",
        "of the live load at collapse",
        attrgetter("result.multiplier"),
        words=lambda row: _multiplier_text(row.result, row.proof),
    ),
    ResultColumn("bracket_low", "Float64", "1", "lower end of the bracket", _end(0)),
    ResultColumn("bracket_high", "Float64", "1", "upper end of the bracket", _end(1)),
    _text("bracket_meaning", "what the ends of the bracket are"),
    _field("bracket_width", "Float64", "1", "of a measured bracket, as a share of its upper end"),
    _field(
        "bracket_wide",
        "boolean",
        "",
        "whether a measured bracket is wider than the stated accuracy of its method: it is no value",
    ),
    ResultColumn(
        "residual_multiplier",
        "Float64",
        "1",
        "of the same wall without cohesion and tensile strength",
        lambda row: None if (pair := plastic_and_residual_of(row.result)) is None else pair[1].multiplier,
    ),
    _text(
        "residual_finding",
        "finding on the wall without cohesion and tensile strength",
        lambda row: None if (pair := plastic_and_residual_of(row.result)) is None else str(pair[1].finding),
    ),
    _text(
        "proof",
        "relation of the multiplier to the minimum: minimum, minimum_to_rounding, least_known or none",
        lambda row: str(row.proof.standing),
    ),
    _text("proof_sentence", "bounds on lower collapse states", attrgetter("proof.sentence")),
    ResultColumn(
        "proved_bound",
        "Float64",
        "1",
        "no collapse state lies from zero to below it, proved in fractions",
        attrgetter("proof.bound"),
    ),
    ResultColumn(
        "verdict",
        "string",
        "",
        "comparison with its references",
        lambda row: str(row.result.verdict),
        words=lambda row: VERDICT_TEXTS[row.result.verdict],
    ),
    ResultColumn(
        "judge_accepted",
        "boolean",
        "",
        "whether the judge accepts the answer; missing: not judged",
        attrgetter("result.judge.accepted"),
    ),
    ResultColumn(
        "judge_tolerance",
        "Float64",
        "1",
        "the largest relative residual that was acceptable",
        attrgetter("result.judge.tolerance"),
    ),
    ResultColumn(
        "judge_worst_residual",
        "Float64",
        "1",
        "the worst relative residual found",
        _worst(1),
        "judge residual",
        lambda row: _residual_text(row.result),
    ),
    _text("judge_worst_residual_name", "which residual that is", _worst(0)),
    _text("judge_sentence", "what was judged, and what failed", attrgetter("result.judge.sentence")),
    _field("cpu_seconds", "Float64", "s", "processor time of the method alone", "CPU time"),
    _field("wall_seconds", "Float64", "s", "time on the clock"),
    _field("peak_memory_bytes", "Int64", "B", "largest resident memory", "peak memory"),
    _field("blocks", "Int64", "1", "free blocks"),
    _field("interfaces", "Int64", "1", "interfaces"),
    _field("iterations", "Int64", "1", "of the method's main loop"),
    _field("unknowns", "Int64", "1", "of the method's largest problem"),
    _text("flow", "flow rule of the mechanism"),
    _text("started", "when the run began"),
    _text("key", "under which the result is stored", title="key in the store"),
    _facts("settings", "of the method, as JSON"),
    _facts("limits", "of the run, as JSON"),
    _facts("versions", "of the programme and its libraries, as JSON"),
    _facts("machine", "on which the run was made, as JSON"),
)
"""Columns of results.csv, results.parquet and `Comparison.to_pandas`, in their order."""

_IN_TABLES: tuple[ResultColumn, ...] = (
    ResultColumn(
        "bracket",
        "Float64",
        "1",
        "the pair of values that enclose the multiplier",
        lambda row: None if row.result.bracket is None else list(row.result.bracket),
    ),
    _text(
        "reference",
        "the most relevant value of another source; comparisons.csv has all",
        lambda row: references_text(row.result),
    ),
)
"""What tables for people and tables of studies show of several columns, or of other tables, in one."""


def chosen(*names: str) -> tuple[ResultColumn, ...]:
    """Columns of results by their names, in this order."""
    by_name = {column.name: column for column in (*RESULTS, *_IN_TABLES)}
    return tuple(by_name[name] for name in names)


PRINTED = chosen("case", "method", "multiplier", "reference", "verdict", "judge_worst_residual", "cpu_seconds")
"""Columns of a comparison in a terminal, and in the report."""
LISTED = (*PRINTED[:3], *chosen("bracket"), *PRINTED[3:5], *chosen("finding"), *PRINTED[5:])
"""Columns of every run in the report: those of the terminal and two more."""
REPEATED = chosen("settings", "limits", "started", "peak_memory_bytes", "iterations", "unknowns", "key")
"""Columns beside the command that repeats a run, in the report."""


@dataclass(frozen=True)
class ComparedRow:
    """A result with one of its comparisons, and the reference; None where the case has it no more."""

    result: Result
    comparison: Comparison
    reference: Reference | None


ComparisonColumn = TableColumn[ComparedRow]


def _of_reference(name: str, meaning: str, title: str = "") -> ComparisonColumn:
    def value(row: ComparedRow) -> str | None:
        return None if row.reference is None else str(getattr(row.reference, name))

    return ComparisonColumn(name, "string", "", meaning, value, title)


COMPARISONS: tuple[ComparisonColumn, ...] = (
    ComparisonColumn("case", "string", "", "id of the wall", attrgetter("result.case")),
    ComparisonColumn("method", "string", "", "name of the method", attrgetter("result.method")),
    ComparisonColumn("reference", "string", "", "id of the reference in its case", attrgetter("comparison.reference")),
    _of_reference("type", "exact, bound, published, measured or regression"),
    ComparisonColumn("quantity", "string", "", "what is compared", attrgetter("comparison.quantity")),
    _of_reference("relation", "required relation of the value to the reference"),
    ComparisonColumn("value", "object", "of the quantity", "of the result", attrgetter("comparison.value")),
    ComparisonColumn(
        "expected", "object", "of the quantity", "of the reference", attrgetter("comparison.expected"), "reference"
    ),
    ComparisonColumn("tolerance", "Float64", "1", "relative difference allowed", attrgetter("comparison.tolerance")),
    ComparisonColumn(
        "gate", "boolean", "", "whether `drystone check` fails if it is not met", attrgetter("comparison.gate")
    ),
    ComparisonColumn("verdict", "string", "", "comparison with the reference", lambda row: str(row.comparison.verdict)),
    ComparisonColumn("sentence", "string", "", "the difference in a sentence", attrgetter("comparison.sentence")),
    _of_reference("requirement", "the settings of the reference", "source and requirement"),
    _of_reference("source", "of the reference"),
)
"""Columns of comparisons.csv, in their order."""

_COMPARED = ("case", "method", "quantity", "value", "expected", "tolerance", "verdict", "requirement")
COMPARED = tuple(column for column in COMPARISONS if column.name in _COMPARED)
"""Columns of the tables of references in the report."""


def _multiplier_text(result: Result, proof: Proof) -> str:
    """The answer with the sign of a proved minimum before it."""
    answer = answer_text(result)
    return f"{PROVED} {answer}" if proof.standing is Standing.MINIMUM else answer


def _residual_text(result: Result) -> str:
    """The worst residual, and a mark unless the judge accepts the answer."""
    worst = result.judge.worst
    mark = {True: "", False: " ✗", None: " not judged" if result.status is Status.OK else ""}[result.judge.accepted]
    return ("-" if worst is None and not mark else "" if worst is None else f"{worst[1]:.1e}") + mark
