"""The columns of a table: each knows its name, unit, meaning, value and text."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

Row = TypeVar("Row")


@dataclass(frozen=True)
class TableColumn(Generic[Row]):
    """One column of a table.

    Attributes:
        name: in files.
        dtype: in pandas: string, Float64, Int64, boolean, or object where numbers and texts stand in one column.
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
        """Whether its values are quantities, which stand on the right."""
        return self.unit != ""

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


def types(columns: Sequence[TableColumn[Any]]) -> dict[str, str]:
    """The pandas type of each column by its name."""
    return {column.name: column.dtype for column in columns}


def units(columns: Sequence[TableColumn[Any]]) -> dict[str, str]:
    """The unit of each column that is a quantity, by its name."""
    return {column.name: column.unit for column in columns if column.unit}


def values(columns: Sequence[TableColumn[Row]], row: Row) -> dict[str, Any]:
    """A row of a table of data: the value of each column by its name."""
    return {column.name: column.value(row) for column in columns}


def in_units(columns: Sequence[TableColumn[Row]], force: str, length: str) -> tuple[TableColumn[Row], ...]:
    """Columns whose units are kinds of quantity (force, length, force length, force/length2), in the units of a wall.

    Args:
        columns: any; units of other kinds stay.
        force, length: names of the units, "1" for none.
    """
    area = "" if length == "1" else f"/{length}2"
    kinds = {
        "force": force,
        "length": length,
        "force length": " ".join(unit for unit in (force, length) if unit != "1") or "1",
        "force/length2": f"{force}{area}",
    }
    return tuple(replace(column, unit=kinds.get(column.unit, column.unit)) for column in columns)
