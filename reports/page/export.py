"""The data folder beside the report: every number with all its digits, and every drawing and chart as vector file."""

from __future__ import annotations

import csv
import io
import itertools
import json
import re
import tempfile
from collections.abc import Iterable, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from harness.model.bar_forces import BARS, bar_forces_of
from harness.model.case import Case
from harness.model.columns import COMPARISONS, RESULTS, ResultColumn, ResultRow
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.joint_margins import ANSWERED, joint_rows
from harness.model.proof import proof_of
from harness.model.result import Result
from harness.model.support_reactions import REACTIONS, reactions_of
from harness.model.table import Row, TableColumn, in_units, types, units, values
from harness.model.writing import cell, write_whole
from reports.charts import charts
from reports.charts.charts import Chart
from reports.charts.curves import curves
from reports.charts.studies import studies
from reports.geometry import shapes
from reports.labels import labels
from reports.page import vectors
from reports.page.reference_tables import compared_rows
from reports.page.summary import run_in_order

if TYPE_CHECKING:
    import pandas as pd

FIGURE_BLOCKS, MOST_PANELS = 400, 4
"""Walls with more blocks are drawn on demand only (`drystone figure`), and a strip holds so many methods."""


def export(run: ComparisonRun, folder: Path, *, drawn: bool = False, columns: Sequence[ResultColumn] = RESULTS) -> None:
    """Write the data of a comparison. Files of an earlier export that are no longer made are removed.

    Args:
        run: the comparison.
        folder: `<stem>-data`; only files named in its own index.json are ever removed from it.
        drawn: whether each case gets a figure as PDF too; a figure takes longer than all the rest of its case.
        columns: of the tables of results.
    """
    folder.mkdir(parents=True, exist_ok=True)
    rows = (ResultRow(r, proof_of(item, r), item.case.load_in_words) for item in run.cases for r in item.results)
    results = result_frame(rows, columns)
    contents: dict[str, bytes] = {"results.csv": _csv(results).encode()}
    contents["comparisons.csv"] = _csv(_comparison_frame(run)).encode()
    contents["joints.csv"] = _joints_csv(run).encode()
    if any(len(item.case.assembly.bars) for item in run.cases if not shapes.problem(item.case)):
        contents["bars.csv"] = _bars_csv(run).encode()
    if find_spec("pyarrow") is not None:
        contents["results.parquet"] = results.to_parquet(index=False)
    for item in run.cases:
        for result in item.results:
            name = f"{_safe(item.case.id)}/{_safe(result.method)}.json"
            contents[name] = _json(
                result.model_dump(mode="json")
                | {
                    "proof": proof_of(item, result).as_json(),
                    "block_ids": [] if shapes.problem(item.case) else list(item.case.assembly.block_ids),
                    "bars": [values(BARS, bar) for bar in bar_forces_of(item.case, result)],
                    "reactions": [values(REACTIONS, reaction) for reaction in reactions_of(item.case, result)],
                    "units": item.case.wall.units.model_dump(mode="json", exclude_none=True),
                }
            )
        for what, svg in vectors.drawings(item).items():
            contents[f"{_safe(item.case.id)}/{_safe(what)}.svg"] = svg.encode()
        drawing = _comparison_figure(item) if drawn else None
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
        if isinstance(drawing, charts.DrawnChart) and drawing.chart is not None:
            contents[f"charts/{name}.csv"] = _csv_of(drawing.chart).encode()
            contents[f"charts/{name}.svg"] = vectors.alone(str(drawing)).encode()
    return contents


def _comparison_figure(item: CaseResults) -> bytes | None:
    """A PDF of the families' main results side by side, or None where there is nothing to draw or too much."""
    usable = [
        result
        for result in labels.in_order(item)
        if (result.is_main or result is item.associated) and result.mechanism is not None
    ]
    if not usable or shapes.problem(item.case) or item.case.assembly.n_blocks > FIGURE_BLOCKS:
        return None
    from reports.figures import figures

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


def _csv(table: pd.DataFrame) -> str:
    known = table.astype(object)
    return _csv_text(table.columns, known.where(known.notna(), None).to_numpy().tolist())


def _joints_csv(run: ComparisonRun) -> str:
    """The joints of all answers, without a frame: they are many."""
    rows = (row for item in run.cases for result in item.results for row in joint_rows(item.case, result))
    return _csv_text([column.name for column in ANSWERED], ([column.value(row) for column in ANSWERED] for row in rows))


def _bars_csv(run: ComparisonRun) -> str:
    """The forces of ties and props in all answers: the columns of `BARS` after case and method, the unit of force."""
    rows = (
        (item.case.id, result.method, *(column.value(bar) for column in BARS), item.case.wall.units.force)
        for item in run.cases
        for result in item.results
        for bar in bar_forces_of(item.case, result)
    )
    return _csv_text(["case", "method", *(column.name for column in BARS), "units"], rows)


def _comparison_frame(run: ComparisonRun) -> pd.DataFrame:
    """Every result compared with a reference, with the columns of comparisons.csv; units in `attrs["units"]`."""
    return _frame(COMPARISONS, [row for item in run.cases for _, row in compared_rows(item)])


def result_frame(rows: Iterable[ResultRow], columns: Sequence[ResultColumn] = RESULTS) -> pd.DataFrame:
    """Results with the columns of results.csv; units in `attrs["units"]`."""
    return _frame(columns, rows)


def joint_frame(case: Case, results: Iterable[Result]) -> pd.DataFrame:
    """Margins of the joints of answers for one wall, with the columns of joints.csv; units in `attrs["units"]`."""
    wall = case.wall.units
    rows = [row for result in results for row in joint_rows(case, result)]
    return _frame(in_units(ANSWERED, wall.force, wall.length), rows)


def reaction_frame(case: Case, result: Result) -> pd.DataFrame:
    """Reactions of the supports in an answer; units in `attrs["units"]`."""
    wall = case.wall.units
    return _frame(in_units(REACTIONS, wall.force, wall.length), reactions_of(case, result))


def bar_frame(case: Case, result: Result) -> pd.DataFrame:
    """Forces of the ties and props in an answer; units in `attrs["units"]`."""
    wall = case.wall.units
    return _frame(in_units(BARS, wall.force, wall.length), bar_forces_of(case, result))


def _frame(columns: Sequence[TableColumn[Row]], rows: Iterable[Row]) -> pd.DataFrame:
    import pandas as pd

    listed = [values(columns, row) for row in rows]
    table = pd.DataFrame(listed, columns=list(types(columns)), dtype=object).astype(types(columns))
    table.attrs["units"] = units(columns)
    return table


def _csv_of(chart: Chart) -> str:
    """The data of a chart: one row a point, with the ends of its bar where it has one."""
    fitted = ("fitted",) if any(series.curve for series in chart.series) else ()
    rows: list[tuple[object, ...]] = []
    for series in chart.series:
        columns = (series.x, series.y, series.low, series.high, *((series.curve,) if fitted else ()))
        rows += [(series.name, *values) for values in itertools.zip_longest(*columns)]
    rows += [(name, None, value, None, None) for name, value in chart.levels]
    return _csv_text(("series", chart.x_label, chart.y_label, "low", "high", *fitted), rows)


def _csv_text(heads: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """A CSV file with texts quoted and numbers not, so that a reader does not turn an id of digits into a number.

    None is an empty cell, true and false are words, and lists and objects are JSON.
    """
    stream = io.StringIO()
    writer = csv.writer(stream, quoting=csv.QUOTE_NONNUMERIC, lineterminator="\n")
    writer.writerow(list(heads))
    writer.writerows([_field(value) for value in row] for row in rows)
    return stream.getvalue()


def _field(value: Any) -> Any:
    if isinstance(value, list | dict):
        return json.dumps(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    return "" if value is None else cell(value)
