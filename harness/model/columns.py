"""The columns of results, declared once: for CSV, Parquet, pandas, tables of studies, terminal, report and docs."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ResultColumn:
    """One column.

    Attributes:
        name: in files.
        dtype: in pandas.
        unit: "1" where it is dimensionless, empty where it is no quantity.
        meaning: what it holds.
        title: how people read its name, where that is more than its words.
    """

    name: str
    dtype: str
    unit: str
    meaning: str
    title: str = ""

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


def _text(name: str, meaning: str, title: str = "") -> ResultColumn:
    return ResultColumn(name, "string", "", meaning, title)


RESULTS: tuple[ResultColumn, ...] = (
    _text("case", "id of the wall"),
    _text("method", "name of the method"),
    _text("family", "kind of method, by which the report groups"),
    _text("status", "how the run ended"),
    _text("finding", "what the answer says about the wall"),
    _text("sentence", "the answer in a sentence"),
    ResultColumn("multiplier", "Float64", "1", "of the live load at collapse"),
    ResultColumn("bracket_low", "Float64", "1", "lower end of the bracket"),
    ResultColumn("bracket_high", "Float64", "1", "upper end of the bracket"),
    _text("bracket_meaning", "what the ends of the bracket are"),
    ResultColumn("bracket_width", "Float64", "1", "of a measured bracket, as a share of its upper end"),
    ResultColumn("bracket_wide", "boolean", "", "whether a measured bracket is so wide that its middle says little"),
    ResultColumn("residual_multiplier", "Float64", "1", "of the same wall without cohesion and tensile strength"),
    _text("residual_finding", "what the answer says about the wall without cohesion and tensile strength"),
    _text("proof", "how the multiplier stands to the minimum: minimum, minimum_to_rounding, least_known or none"),
    _text("proof_sentence", "what is known of lower collapse states"),
    ResultColumn("proved_bound", "Float64", "1", "no collapse state lies from zero to below it, proved in fractions"),
    _text("verdict", "how the value stands to its references"),
    ResultColumn("judge_accepted", "boolean", "", "whether the judge accepts the answer; missing: not judged"),
    ResultColumn("judge_tolerance", "Float64", "1", "the largest relative residual that was acceptable"),
    ResultColumn("judge_worst_residual", "Float64", "1", "the worst relative residual found", "judge residual"),
    _text("judge_worst_residual_name", "which residual that is"),
    _text("judge_sentence", "what was judged, and what failed"),
    ResultColumn("cpu_seconds", "Float64", "s", "processor time of the method alone", "CPU time"),
    ResultColumn("wall_seconds", "Float64", "s", "time on the clock"),
    ResultColumn("peak_memory_bytes", "Int64", "B", "largest resident memory", "peak memory"),
    ResultColumn("blocks", "Int64", "1", "free blocks"),
    ResultColumn("interfaces", "Int64", "1", "interfaces"),
    ResultColumn("iterations", "Int64", "1", "of the method's main loop"),
    ResultColumn("unknowns", "Int64", "1", "of the method's largest problem"),
    _text("flow", "flow rule of the mechanism"),
    _text("started", "when the run began"),
    _text("key", "under which the result is stored", "key in the store"),
    _text("settings", "of the method, as JSON"),
    _text("limits", "of the run, as JSON"),
    _text("versions", "of the programme and its libraries, as JSON"),
    _text("machine", "on which the run was made, as JSON"),
)
"""Columns of results.csv, results.parquet and `Comparison.to_pandas`, in their order."""

NUMBERED = (
    ResultColumn("number", "Int64", "1", "of the run in its study"),
    ResultColumn("draw", "Int64", "1", "of a distribution; missing on a grid"),
    ResultColumn(
        "from_neighbour", "boolean", "", "whether a mechanism of a neighbouring wall led to it; missing: none given"
    ),
    ResultColumn(
        "exceeds_accuracy",
        "boolean",
        "",
        "whether the multiplier is only known to lie in the bracket, which is wider than the method's stated accuracy; "
        "missing: it is not measured between two loads",
    ),
    ResultColumn("multiplier_alone", "Float64", "1", "what the run had found by itself, where a neighbour led lower"),
)
"""What tables of studies have besides."""

IN_TABLES = (
    ResultColumn("bracket", "Float64", "1", "the pair of values that the method vouches for"),
    _text("reference", "the value of another source that matters most; all are in comparisons.csv"),
)
"""What tables for people show of several columns, or of other tables, in one."""

BY_NAME = {column.name: column for column in (*RESULTS, *NUMBERED, *IN_TABLES)}
TYPES = {column.name: column.dtype for column in RESULTS}
UNITS = {column.name: column.unit for column in RESULTS if column.unit}

PRINTED = ("case", "method", "multiplier", "reference", "verdict", "judge_worst_residual", "cpu_seconds")
"""Columns of a comparison in a terminal."""
LISTED = (*PRINTED[:3], "bracket", "reference", "verdict", "finding", "judge_worst_residual", "cpu_seconds")
"""Columns of every run in the report."""
REPEATED = ("settings", "limits", "started", "peak_memory_bytes", "iterations", "unknowns", "key")
"""Columns beside the command that repeats a run, in the report."""
