"""The table of a study: a tidy pandas frame, one row a run, units in its metadata; CSV always, Parquet with pyarrow."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from importlib.util import find_spec
from pathlib import Path

import pandas as pd

from harness.engine.sweep.running import STUDY, Row, StudyColumn
from harness.model.table import types
from harness.model.writing import cell, replacing

_UNITS = {
    "friction": "1 (tangent of the angle of friction)",
    "proportion": "1 (block length over height)",
    "inset": "1 (fraction of the interface)",
    "direction": "degree, counter-clockwise",
    "imperfection": "1 (of the block height)",
    "seed": "1",
}
"""Units of quantities with a short name; others have the unit of the wall's file."""


def tidy(rows: Iterable[Row], varied: Sequence[str], columns: Sequence[StudyColumn] = STUDY) -> pd.DataFrame:
    """The table of a study in the order of its runs.

    Args:
        rows: of `sweep`, in any order.
        varied: names of the quantities that vary, in the study's order.
        columns: of the table; what varies comes after the second of them.

    Returns:
        one row a run; `attrs["units"]` holds the unit of every column, "1" for numbers without.
    """
    names = list(types(columns))
    names[2:2] = varied
    ordered: list[Row] = sorted(rows, key=_number)
    table = pd.DataFrame(ordered, columns=names)
    # Numbers without a value are NaN here, as statistics take them.
    table = table.astype({name: dtype.replace("Float64", "float64") for name, dtype in types(columns).items()})
    declared = {column.name: column.unit for column in columns}
    table.attrs["units"] = {name: declared.get(name, _UNITS.get(name, "as in the wall's file")) for name in names}
    return table


def _number(row: Row) -> int:
    return int(row["number"])


def write(table: pd.DataFrame, folder: Path, name: str) -> list[Path]:
    """Write a table as NAME.csv, its units as NAME.units.json and, where pyarrow is installed, NAME.parquet.

    Returns:
        the files, each either whole or as it was.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for suffix in ("csv", "units.json", *(["parquet"] if find_spec("pyarrow") is not None else [])):
        path = folder / f"{name}.{suffix}"
        with replacing(path) as part:
            if suffix == "csv":
                texts = table.select_dtypes(["object", "string"])
                table.assign(**{str(column): texts[column].map(cell) for column in texts}).to_csv(part, index=False)
            elif suffix == "parquet":
                table.to_parquet(part, index=False)
            else:
                part.write_text(json.dumps(table.attrs.get("units", {}), indent=1) + "\n", encoding="utf-8")
        written.append(path)
    return written
