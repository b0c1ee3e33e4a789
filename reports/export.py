"""The data folder beside the report: every number with all its digits, and every drawing and chart as vector file."""

from __future__ import annotations

import csv
import io
import json
import re
import tempfile
from collections.abc import Iterable, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from harness.model.columns import RESULTS, ResultColumn, ResultRow, types, units, values
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.proof import Proof, proof_of
from harness.model.result import Result
from harness.model.writing import cell, write_whole
from reports import charts, shapes, vectors, words
from reports.curves import curves
from reports.opening import run_in_order
from reports.studies import studies
from reports.tables import reference_of

if TYPE_CHECKING:
    import pandas as pd

FIGURE_BLOCKS, MOST_PANELS = 400, 4
"""Walls with more blocks are drawn on demand only (`drystone figure`), and a strip holds so many methods."""

COMPARISON_COLUMNS = (
    "case",
    "method",
    "reference",
    "type",
    "quantity",
    "relation",
    "value",
    "expected",
    "tolerance",
    "gate",
    "verdict",
    "sentence",
    "requirement",
    "source",
)


def export(run: ComparisonRun, folder: Path, *, drawn: bool = False, columns: Sequence[ResultColumn] = RESULTS) -> None:
    """Write the data of a comparison. Files of an earlier export that are no longer made are removed.

    Args:
        run: the comparison.
        folder: `<stem>-data`; only files named in its own index.json are ever removed from it.
        drawn: whether each case gets a figure as PDF too; a figure takes longer than all the rest of its case.
        columns: of the tables of results.
    """
    folder.mkdir(parents=True, exist_ok=True)
    rows = [values(columns, ResultRow(result, proof_of(item, result))) for item in run.cases for result in item.results]
    contents: dict[str, bytes] = {
        "results.csv": _csv(types(columns), rows),
        "comparisons.csv": _csv(COMPARISON_COLUMNS, _comparison_rows(run)),
    }
    if find_spec("pyarrow") is not None:
        contents["results.parquet"] = _parquet(rows, types(columns))
    for item in run.cases:
        for result in item.results:
            name = f"{_safe(item.case.id)}/{_safe(result.method)}.json"
            contents[name] = _json(
                result.model_dump(mode="json")
                | {
                    "proof": proof_of(item, result).as_json(),
                    "block_ids": [] if shapes.problem(item.case) else list(item.case.assembly.block_ids),
                    "units": item.case.wall.units.model_dump(mode="json", exclude_none=True),
                }
            )
        for what, svg in vectors.drawings(item).items():
            contents[f"{_safe(item.case.id)}/{_safe(what)}.svg"] = svg.encode()
        drawing = comparison_figure(item) if drawn else None
        if drawing is not None:
            contents[f"figures/{_safe(item.case.id)}.pdf"] = drawing
    contents |= _charts(run)
    earlier = _index(folder)
    contents["index.json"] = _json({"files": sorted(contents)})
    for name, content in contents.items():
        if not _holds(folder / name, content):
            write_whole(folder / name, content)
    for name in earlier - set(contents):
        (folder / name).unlink(missing_ok=True)


def _holds(path: Path, content: bytes) -> bool:
    """Whether a file is there already as it would be written: most of an earlier report's are."""
    try:
        return path.stat().st_size == len(content) and path.read_bytes() == content
    except OSError:
        return False


def _charts(run: ComparisonRun) -> dict[str, bytes]:
    """Every chart of the report as a vector file, and its data as CSV beside it."""
    drawings = [
        (f"{_safe(item.case.id)}-{number}", drawing)
        for item in run.cases
        if not shapes.problem(item.case)
        for number, (_, drawing) in enumerate(curves(item), start=1)
    ]
    for place, study in enumerate(studies(run_in_order(run)), start=1):
        drawings += [(f"study-{place}-{number}", drawing) for number, (_, drawing) in enumerate(study.charts, start=1)]
    contents: dict[str, bytes] = {}
    for name, drawing in drawings:
        if isinstance(drawing, charts.Drawing) and drawing.chart is not None:
            contents[f"charts/{name}.csv"] = charts.csv_of(drawing.chart).encode()
            contents[f"charts/{name}.svg"] = vectors.alone(str(drawing)).encode()
    return contents


def comparison_figure(item: CaseResults) -> bytes | None:
    """A PDF of the families' main results side by side, or None where there is nothing to draw or too much."""
    usable = [
        result
        for result in words.in_order(item)
        if (result.is_main or result is item.associated) and result.mechanism is not None
    ]
    if not usable or shapes.problem(item.case) or item.case.assembly.n_blocks > FIGURE_BLOCKS:
        return None
    from reports import figures

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "figure.pdf"
        figures.figure(item.case, usable[:MOST_PANELS], "comparison", path)
        return path.read_bytes()


def _safe(name: str) -> str:
    """A name that is one plain file name, whatever a third party called its method."""
    return re.sub(r"[^A-Za-z0-9._-]", "-", name).lstrip(".") or "unnamed"


def _index(folder: Path) -> set[str]:
    """Names an earlier export wrote, those that lead out of the folder left out."""
    try:
        names = json.loads((folder / "index.json").read_text(encoding="utf-8"))["files"]
    except (OSError, ValueError, KeyError, TypeError):
        return set()
    plain = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9._-]*(/[A-Za-z0-9_-][A-Za-z0-9._-]*)?")
    return {name for name in names if isinstance(name, str) and plain.fullmatch(name)}


def _json(data: Any) -> bytes:
    return (json.dumps(data, indent=1, ensure_ascii=False, default=str) + "\n").encode()


def _comparison_rows(run: ComparisonRun) -> list[dict[str, Any]]:
    rows = []
    for item in run.cases:
        for result in item.results:
            for comparison in result.comparisons:
                reference = reference_of(item.case, comparison.reference)
                rows.append(
                    {"case": result.case, "method": result.method}
                    | comparison.model_dump(mode="json")
                    | {
                        "type": str(reference.type) if reference else None,
                        "relation": reference.relation if reference else None,
                        "requirement": reference.requirement if reference else None,
                        "source": reference.source if reference else None,
                    }
                )
    return rows


def _csv(names: Iterable[str], rows: list[dict[str, Any]]) -> bytes:
    """CSV with texts quoted and numbers not, so that a reader does not turn an id of digits into a number."""
    stream = io.StringIO()
    writer = csv.writer(stream, quoting=csv.QUOTE_NONNUMERIC, lineterminator="\n")
    names = list(names)
    writer.writerow(names)
    for row in rows:
        writer.writerow([cell(_field(row.get(name))) for name in names])
    return stream.getvalue().encode()


def _field(value: Any) -> Any:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return json.dumps(value) if isinstance(value, list | dict) else value


ARROW = {"string": "large_string", "Float64": "float64", "Int64": "int64", "boolean": "bool_"}
"""Types of columns in Parquet, by those in pandas."""


def _parquet(rows: list[dict[str, Any]], columns: dict[str, str]) -> bytes:
    """The results as Parquet, with the types of their columns; what is missing is null.

    The file is as pandas writes it, and tells pandas its types, but pandas is not loaded, which takes longer than all
    of the table.
    """
    import pyarrow as pa
    from pyarrow import parquet

    arrays = [pa.array([row[name] for row in rows], getattr(pa, ARROW[t])()) for name, t in columns.items()]
    told = [
        {"name": name, "field_name": name, "pandas_type": "object", "numpy_type": dtype, "metadata": None}
        for name, dtype in columns.items()
    ]
    about = {"index_columns": [], "column_indexes": [], "columns": told, "pandas_version": "3.0"}
    table = pa.table(arrays, names=list(columns), metadata={"pandas": json.dumps(about)})
    sink = io.BytesIO()
    parquet.write_table(table, sink)
    return sink.getvalue()


def result_frame(results: Iterable[tuple[Result, Proof]], columns: Sequence[ResultColumn] = RESULTS) -> pd.DataFrame:
    """Results, each with what is proved of it, with the columns of results.csv; units in `attrs["units"]`."""
    import pandas as pd

    rows = [values(columns, ResultRow(result, proof)) for result, proof in results]
    table = pd.DataFrame(rows, columns=list(types(columns))).astype(types(columns))
    table.attrs["units"] = units(columns)
    return table
