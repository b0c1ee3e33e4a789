"""The columns of results, each with its value and text: for files, pandas, studies, terminal, report and docs."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any, Generic, TypeVar

from harness.model.proof import Proof
from harness.model.result import Result, exceeds_accuracy
from harness.model.result_texts import VERDICT_TEXTS, multiplier_text, references_text, residual_text, settings_text

Row = TypeVar("Row")


@dataclass(frozen=True)
class TableColumn(Generic[Row]):
    """One column of a table.

    Attributes:
        name: in files.
        dtype: in pandas: string, Float64, Int64 or boolean.
        unit: "1" where it is dimensionless, empty where it is no quantity.
        meaning: what it holds.
        value: of a row, as a JSON value; None where it is missing.
        title: how people read its name, where that is more than its words.
        words: the text of a row for people; None: that of the value.
    """

    name: str
    dtype: str
    unit: str
    meaning: str
    value: Callable[[Row], Any]
    title: str = ""
    words: Callable[[Row], str] | None = None

    @property
    def label(self) -> str:
        """The head of the column for people."""
        return self.title or self.name.replace("_", " ")

    @property
    def head(self) -> str:
        """The head with the unit, where there is one to tell."""
        return self.label if self.unit in ("", "1") else f"{self.label} [{self.unit}]"

    @property
    def numeric(self) -> bool:
        """Whether its values are numbers, which stand on the right."""
        return self.dtype in ("Float64", "Int64")

    def text(self, row: Row) -> str:
        """What people read in plain text: seconds to hundredths, other numbers to six digits, "-" for no value."""
        if self.words is not None:
            return self.words(row)
        value = self.value(row)
        if value is None:
            return "-"
        if isinstance(value, bool):
            return "yes" if value else "no"
        if isinstance(value, float):
            return f"{value:.2f}" if self.unit == "s" else f"{value:.6g}"
        return str(value)


@dataclass(frozen=True)
class ResultRow:
    """What a column of results is a function of: a result, and what is proved of it."""

    result: Result
    proof: Proof = field(default_factory=Proof)


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


def _exceeds(row: ResultRow) -> bool | None:
    bracket = row.result.bracket if row.result.flow == "approximate" else None
    return None if bracket is None else exceeds_accuracy(bracket, row.result.traits)


RESULTS: tuple[ResultColumn, ...] = (
    _text("case", "id of the wall"),
    _text("method", "name of the method"),
    _text("family", "kind of method, by which the report groups"),
    _text("status", "how the run ended"),
    _text("finding", "what the answer says about the wall"),
    _text("sentence", "the answer in a sentence"),
    ResultColumn(
        "multiplier",
        "Float64",
        "1",
        "of the live load at collapse",
        attrgetter("result.multiplier"),
        words=lambda row: multiplier_text(row.result, row.proof),
    ),
    ResultColumn("bracket_low", "Float64", "1", "lower end of the bracket", _end(0)),
    ResultColumn("bracket_high", "Float64", "1", "upper end of the bracket", _end(1)),
    _text("bracket_meaning", "what the ends of the bracket are"),
    _field("bracket_width", "Float64", "1", "of a measured bracket, as a share of its upper end"),
    _field("bracket_wide", "boolean", "", "whether a measured bracket is so wide that its middle says little"),
    _text(
        "proof",
        "how the multiplier stands to the minimum: minimum, minimum_to_rounding, least_known or none",
        lambda row: str(row.proof.standing),
    ),
    _text("proof_sentence", "what is known of lower collapse states", attrgetter("proof.sentence")),
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
        "how the value stands to its references",
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
        lambda row: residual_text(row.result),
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

IN_TABLES: tuple[ResultColumn, ...] = (
    ResultColumn(
        "bracket",
        "Float64",
        "1",
        "the pair of values that the method vouches for",
        lambda row: None if row.result.bracket is None else list(row.result.bracket),
    ),
    _text(
        "reference",
        "the value of another source that matters most; all are in comparisons.csv",
        lambda row: references_text(row.result),
    ),
    ResultColumn(
        "exceeds_accuracy",
        "boolean",
        "",
        "whether the multiplier is only known to lie in the bracket, which is wider than the method's stated accuracy; "
        "missing: it is not measured between two loads",
        _exceeds,
    ),
)
"""What tables for people and tables of studies show of several columns, or of other tables, in one."""


def chosen(*names: str) -> tuple[ResultColumn, ...]:
    """Columns of results by their names, in this order."""
    by_name = {column.name: column for column in (*RESULTS, *IN_TABLES)}
    return tuple(by_name[name] for name in names)


def types(columns: Sequence[TableColumn[Any]]) -> dict[str, str]:
    """The pandas type of each column by its name."""
    return {column.name: column.dtype for column in columns}


def units(columns: Sequence[TableColumn[Any]]) -> dict[str, str]:
    """The unit of each column that is a quantity, by its name."""
    return {column.name: column.unit for column in columns if column.unit}


def values(columns: Sequence[TableColumn[Row]], row: Row) -> dict[str, Any]:
    """A row of a table of data: the value of each column by its name."""
    return {column.name: column.value(row) for column in columns}


PRINTED = chosen("case", "method", "multiplier", "reference", "verdict", "judge_worst_residual", "cpu_seconds")
"""Columns of a comparison in a terminal, and in the report."""
LISTED = (*PRINTED[:3], *chosen("bracket"), *PRINTED[3:5], *chosen("finding"), *PRINTED[5:])
"""Columns of every run in the report: those of the terminal and two more."""
REPEATED = chosen("settings", "limits", "started", "peak_memory_bytes", "iterations", "unknowns", "key")
"""Columns beside the command that repeats a run, in the report."""
