"""Rows of the report's tables of references: every result that is compared with one."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from harness.model.columns import COMPARISONS, ComparedRow, ComparisonColumn
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.result_texts import settings_text
from reports.labels import labels, numbers
from reports.page.tables import Cell, anchor_of, expected_text, plain_cell, reference_of


@dataclass(frozen=True)
class _HeldRow:
    """One result compared with one reference, ready to print.

    Attributes:
        anchor: of the run in the page.
        row: what columns are functions of.
    """

    anchor: str
    row: ComparedRow

    def cell(self, column: str | ComparisonColumn) -> Cell:
        """What the report prints of a column, which may be named."""
        found = next(item for item in COMPARISONS if item.name == column) if isinstance(column, str) else column
        own = HELD_CELLS.get(found.name)
        return plain_cell(found, self.row) if own is None else own(self.row)

    @property
    def verdict(self) -> str:
        """The name of the verdict."""
        return str(self.row.comparison.verdict)

    @property
    def words(self) -> tuple[str, str]:
        """Glyph and words of the verdict."""
        return labels.VERDICT[self.row.comparison.verdict]

    @property
    def settings(self) -> str:
        """That the reference asks for."""
        return settings_text(self.row.reference.settings) if self.row.reference else ""


def compared_rows(item: CaseResults) -> Iterable[tuple[int, ComparedRow]]:
    """Every comparison of a case with a reference, and the number of its result."""
    for number, result in enumerate(item.results):
        for comparison in result.comparisons:
            yield number, ComparedRow(result, comparison, reference_of(item.case, comparison.reference))


def reference_rows(run: ComparisonRun) -> dict[str, list[_HeldRow]]:
    """Rows of the tables of references, by purpose: verification, benchmark, validation, regression."""
    tables: dict[str, list[_HeldRow]] = {purpose: [] for purpose in labels.PURPOSE}
    for case_number, item in enumerate(run.cases):
        for number, row in compared_rows(item):
            if row.reference is not None:
                kind = row.reference.type
                purpose = next(name for name, entry in labels.PURPOSE.items() if kind in entry[1])
                tables[purpose].append(_HeldRow(anchor_of(case_number, number), row))
    return tables


def _quantity_cell(row: ComparedRow) -> Cell:
    return Cell(row.comparison.quantity.removeprefix("details.").replace("_", " "))


def _value_cell(row: ComparedRow) -> Cell:
    value = row.comparison.value
    if value is None:
        return Cell(numbers.NOTHING)
    if isinstance(value, str):
        return Cell(value)
    if isinstance(value, list):
        return Cell(numbers.interval(value), numbers.every_digit(value))
    return Cell(_count_or_number(value, row.comparison.quantity), repr(value), value)


def _expected_cell(row: ComparedRow) -> Cell:
    expected = row.comparison.expected
    text = expected_text(row.comparison, row.reference.relation if row.reference else "equal")
    if isinstance(expected, float) and row.comparison.quantity in _COUNTS:
        text = f"{expected:.0f}"
    return Cell(text, numbers.every_digit(expected))


def _tolerance_cell(row: ComparedRow) -> Cell:
    words_only = isinstance(row.comparison.expected, str)
    text = numbers.NOTHING if words_only else numbers.given(row.comparison.tolerance, 2)
    return Cell(text, row.reference.tolerance_reason if row.reference else "")


_COUNTS = ("blocks", "interfaces", "unknowns")


HELD_CELLS: dict[str, Callable[[ComparedRow], Cell]] = {
    "quantity": _quantity_cell,
    "value": _value_cell,
    "expected": _expected_cell,
    "tolerance": _tolerance_cell,
}
"""Cells of references whose text in the report is not that of the value alone, by the name of the column."""


def _count_or_number(value: float, quantity: str) -> str:
    return f"{value:.0f}" if quantity in _COUNTS else numbers.plain(value)
