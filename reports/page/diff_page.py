"""The page of two sets of answers side by side: what is worse, gone, slower, better or new, and times by method."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files

from markupsafe import Markup

from harness.model.difference import DIFFERENCE, Difference, DifferenceColumn, Row
from reports.environment import environment
from reports.labels import numbers
from reports.page.tables import Cell

_GLYPH = {"worse": "✗", "gone": "∅", "slower": "…", "better": "✓", "new": "+", "same": "="}


@dataclass(frozen=True)
class _DiffRow:
    """One case and method in both sets, ready to print."""

    row: Row

    def cell(self, column: DifferenceColumn) -> Cell:
        """What the page prints of a column."""
        own = _DIFF_TEXTS.get(column.name)
        return Cell(column.text(self.row) if own is None else own(self.row))

    @property
    def kind(self) -> str:
        """How the answer stands, in a word."""
        return str(self.row.kind)


_DIFF_TEXTS: dict[str, Callable[[Row], str]] = {
    "figures": lambda row: row.figures.replace("->", "→"),
    "old_seconds": lambda row: numbers.seconds(row.old_seconds),
    "new_seconds": lambda row: numbers.seconds(row.new_seconds),
    "ratio": lambda row: numbers.NOTHING if row.ratio is None else f"{row.ratio:.2f}",
}
"""Texts of columns that are not that of the value alone, by the name of the column."""


def render(found: Difference) -> str:
    """The page as text."""
    rows = [_DiffRow(row) for row in found.rows]
    return (
        environment()
        .get_template("diff.html.j2")
        .render(
            found=found,
            style=Markup(files("reports").joinpath("static/report.css").read_text(encoding="utf-8")),
            columns=DIFFERENCE,
            changed=[row for row in rows if row.kind != "same"],
            same=[row for row in rows if row.kind == "same"],
            counts=[(str(kind), number) for kind, number in found.counts.items() if number],
            glyph=_GLYPH,
            numbers=numbers,
        )
    )
