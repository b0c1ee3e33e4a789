"""Rows of the report's tables, made from results as they are: failed runs stay in."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from harness.model.case import Case, Reference
from harness.model.columns import ResultColumn, ResultRow, chosen
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.library import library
from harness.model.method import Status
from harness.model.proof import Standing, proof_of
from harness.model.result import Comparison, Result, Verdict
from harness.model.table import Row, TableColumn
from reports.labels import labels, numbers


@dataclass(frozen=True)
class Cell:
    """A table cell: what is printed, all digits for the hover text, and a number to sort by."""

    text: str
    title: str = ""
    sort: float | None = None


@dataclass(frozen=True)
class RunRow:
    """One run of one method on one case, ready to print.

    Attributes:
        anchor: its id in the page.
        item: the case with all of its results.
        result: the run.
    """

    anchor: str
    item: CaseResults
    result: Result

    @cached_property
    def row(self) -> ResultRow:
        """What columns are functions of."""
        return ResultRow(self.result, proof_of(self.item, self.result), self.item.case.load_in_words)

    def cell(self, column: str | ResultColumn) -> Cell:
        """What the report prints of a column, which may be named."""
        (found,) = chosen(column) if isinstance(column, str) else (column,)
        own = _CELLS.get(found.name)
        return plain_cell(found, self.row) if own is None else own(self)

    @property
    def failed(self) -> bool:
        """Whether it ended without an answer."""
        return self.result.status is not Status.OK

    @property
    def trouble(self) -> bool:
        """Whether it failed, disagrees, or was not accepted."""
        disagrees = self.result.verdict in (Verdict.OUTSIDE_TOLERANCE, Verdict.VIOLATES_BOUND)
        return self.failed or not self.result.judge.accepted or disagrees

    @property
    def proved(self) -> bool:
        """Whether its multiplier is the minimum, proved."""
        return self.row.proof.standing is Standing.MINIMUM

    @property
    def verdict(self) -> tuple[str, str]:
        """Glyph and words."""
        return labels.VERDICT[self.result.verdict]

    @property
    def status(self) -> tuple[str, str]:
        """Glyph and words."""
        return labels.STATUS[self.result.status]

    @property
    def finding(self) -> str:
        """In words."""
        return labels.FINDING[self.result.finding]

    @property
    def judged(self) -> str:
        """The judge's word."""
        return self.result.judge.outcome.replace("_", " ")

    @property
    def command(self) -> str:
        """How to repeat it."""
        return f"drystone run {self.result.method} {self.result.case}"


def anchor_of(case_number: int, result_number: int) -> str:
    """The id of a run in the page; numbers, so that no name from a file becomes part of it."""
    return f"run-{case_number}-{result_number}"


def reference_of(case: Case, identifier: str) -> Reference | None:
    """The reference of this id, or None."""
    return next((reference for reference in case.file.references if reference.id == identifier), None)


def expected_text(comparison: Comparison, relation: str) -> str:
    """A reference's value with its relation, e.g. "≤ 0.641" or "0.47619"."""
    expected = comparison.expected
    if isinstance(expected, str):
        return expected
    if isinstance(expected, list):
        return f"in [{numbers.given(expected[0])}, {numbers.given(expected[1])}]"
    sign = {"at_most": "≤ ", "at_least": "≥ ", "contains": "∋ "}.get(relation, "")
    return sign + numbers.given(expected)


def _reference_cell(row: RunRow) -> Cell:
    """The reference that matters most: the worst verdict, gated before not, multiplier before others."""
    severity = [
        Verdict.VIOLATES_BOUND,
        Verdict.OUTSIDE_TOLERANCE,
        Verdict.AGREES,
        Verdict.NOT_TESTED,
        Verdict.NO_REFERENCE,
    ]
    ranked = sorted(
        row.result.comparisons,
        key=lambda item: (severity.index(item.verdict), item.quantity != "multiplier", not item.gate),
    )
    if not ranked:
        return Cell(numbers.NOTHING)
    first = ranked[0]
    reference = reference_of(row.item.case, first.reference)
    text = expected_text(first, reference.relation if reference else "equal")
    if first.quantity != "multiplier" and not isinstance(first.expected, str):
        text = f"{first.quantity.removeprefix('details.').replace('_', ' ')} {text}"
    more = f" +{len(ranked) - 1}" if len(ranked) > 1 else ""
    source = f"; {reference.source}" if reference else ""
    title = f"{first.sentence}{source}"
    return Cell(text + more, title, first.expected if isinstance(first.expected, float) else None)


def _multiplier_cell(row: RunRow) -> Cell:
    result = row.result
    if result.status is not Status.OK and result.multiplier is None:
        return Cell(labels.STATUS[result.status][1])
    if result.multiplier is None:
        return Cell(labels.FINDING[result.finding])
    if result.flow == "approximate" and result.bracket is not None:
        text = numbers.interval(result.bracket) + result.width_in_words
        return Cell(text, numbers.every_digit(result.bracket), result.multiplier)
    return Cell(
        numbers.multiplier(result.multiplier, result.judge.decimals), repr(result.multiplier), result.multiplier
    )


def _bracket_cell(row: RunRow) -> Cell:
    bracket = row.result.bracket
    if bracket is None:
        return Cell(numbers.NOTHING)
    return Cell(numbers.interval(bracket), numbers.every_digit(bracket), bracket[0])


def _residual_cell(row: RunRow) -> Cell:
    worst = row.result.judge.worst
    return (
        Cell(numbers.NOTHING)
        if worst is None
        else Cell(numbers.residual(worst[1]), f"{worst[0]} {worst[1]!r}", worst[1])
    )


_CELLS: dict[str, Callable[[RunRow], Cell]] = {
    "multiplier": _multiplier_cell,
    "bracket": _bracket_cell,
    "reference": _reference_cell,
    "judge_worst_residual": _residual_cell,
}
"""Cells of columns whose text in the report is not that of the value alone, by the name of the column."""

_QUANTITIES: dict[str, tuple[Callable[[float], str], str]] = {
    "s": (numbers.seconds, "s"),
    "B": (numbers.memory, "bytes"),
}
"""How numbers of a unit are written, and the unit in full."""


def plain_cell(column: TableColumn[Row], row: Row) -> Cell:
    """A cell of any column: a number with its digits for hovering and sorting, a text as it is, a dash for nothing."""
    value = column.value(row)
    if value is None or value == "":
        return Cell(numbers.NOTHING)
    if not column.numeric:
        return Cell(column.text(row) or numbers.NOTHING)
    if column.unit in _QUANTITIES:
        text, unit = _QUANTITIES[column.unit]
        return Cell(text(value), f"{value!r} {unit}", float(value))
    if isinstance(value, int):
        return Cell(str(value), "", float(value))
    return Cell(numbers.plain(value), repr(value), value)


def machine_text(values: dict[str, Any]) -> str:
    """Where a run was made, its memory in units that people read."""
    size = values.get("memory_bytes")
    known = values if not isinstance(size, int) else values | {"memory_bytes": numbers.memory(size)}
    return ", ".join(f"{name.removesuffix('_bytes')} {value}" for name, value in known.items())


def run_row(case_number: int, result_number: int, item: CaseResults) -> RunRow:
    """The row of one result."""
    return RunRow(anchor_of(case_number, result_number), item, item.results[result_number])


def run_rows(run: ComparisonRun) -> list[list[RunRow]]:
    """The rows of every case, in the order of the cases, methods in the paper's order."""
    return [
        [
            run_row(case_number, number, item)
            for number in sorted(range(len(item.results)), key=lambda n: labels.order(item.results[n]))
        ]
        for case_number, item in enumerate(run.cases)
    ]


@dataclass(frozen=True)
class Column:
    """A method as the head of a column."""

    method: str
    family: str
    number_is: str


def columns(run: ComparisonRun) -> list[Column]:
    """The methods of a comparison, in the paper's order."""
    found = {(result.method, result.family): labels.order(result) for item in run.cases for result in item.results}
    captions = {
        result.method: f"{result.traits.caption}{', an upper bound' if result.traits.bounds_above else ''}"
        for item in run.cases
        for result in item.results
        if result.traits.caption  # a run without an answer of its method tells none
    }
    return [
        Column(method, library().family_title(family, method), captions.get(method, ""))
        for method, family in sorted(found, key=lambda pair: found[pair])
    ]


def overview_columns(run: ComparisonRun) -> list[Column]:
    """The methods that were run on at least a third of the cases: the others would be columns of blanks."""
    runs = Counter(result.method for item in run.cases for result in item.results)
    return [column for column in columns(run) if 3 * runs[column.method] >= len(run.cases)]


@dataclass(frozen=True)
class Failure:
    """Runs of one method that failed in the same way."""

    method: str
    glyph: str
    word: str
    sentence: str
    runs: list[RunRow]


def failures(rows: Iterable[RunRow]) -> list[Failure]:
    """Failed and rejected runs, those of one method with the same sentence together, in the order they appear."""
    groups: dict[tuple[str, str, str, str], list[RunRow]] = {}
    for row in rows:
        if row.failed:
            groups.setdefault((row.result.method, *row.status, row.result.sentence), []).append(row)
        elif row.judged == "rejected":
            rejected = (row.result.method, "✗", "rejected by the judge", row.result.judge.sentence)
            groups.setdefault(rejected, []).append(row)
    return [Failure(*words_of, runs) for words_of, runs in groups.items()]


def findings(run: ComparisonRun) -> str:
    """What the comparison found, in sentences computed from the results."""
    results = [result for item in run.cases for result in item.results]
    ended = [result for result in results if result.status is Status.OK]
    comparisons = [comparison for result in results for comparison in result.comparisons]
    gated = [comparison for comparison in comparisons if comparison.gate]
    held = sum(comparison.verdict is Verdict.AGREES for comparison in gated)
    rejected = sum(result.judge.accepted is False for result in results)
    accepted = sum(result.judge.accepted is True for result in results)
    unjudged = len(ended) - accepted - rejected
    sentences = [
        f"Of {numbers.count(len(results), 'run')} on {numbers.count(len(run.cases), 'case')}, "
        f"{len(ended)} ended with an answer; the judge accepted {accepted} and rejected {rejected}"
        + (f", and {unjudged} {_are(unjudged)} not judged." if unjudged else ".")
    ]
    if gated:
        sentences.append(f"Of {numbers.count(len(gated), 'checked reference value')}, {held} {_are(held)} met.")
    gates = [gate for item in run.cases for gate in item.gates if gate.passed is not None]
    if gates:
        passed = sum(bool(gate.passed) for gate in gates)
        hold = "holds" if passed == 1 else "hold"
        sentences.append(
            f"Of {numbers.count(len(gates), 'statement')} of theory that could be tested, {passed} {hold}."
        )
    return " ".join(sentences)


def _are(number: int) -> str:
    return "is" if number == 1 else "are"
