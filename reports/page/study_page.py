"""The page of a study: what was asked, charts over its grid, fragility curves and tables of statistics."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from typing import Any

import pandas as pd
from markupsafe import Markup

from harness.model.ranges import percent_text
from reports.charts import charts
from reports.charts.grid import legend, shade
from reports.charts.study_findings import answer, findings
from reports.charts.styles import Mark
from reports.environment import environment
from reports.labels import numbers

MOST_SERIES, MOST_CHARTS, MOST_ROWS, FOLDED = 12, 40, 400, 20
"""Lines in one chart, charts over one quantity and rows in one table of the page, the files beside it hold all; a
longer table is folded."""
MAP_COLUMNS, MAP_ROWS = 16, 40
"""Largest map of where families agree that is seen at a glance."""

_READ = {
    "failure": "Share of walls that collapse at or below a multiplier, with Wilson's score interval at 95 %. A wall "
    "whose wide bracket holds the multiplier counts in `probability_at_most` only.",
    "sensitivity": "Borgonovo's delta: 0 for a quantity without influence, 1 for the only one with influence; and "
    "its share of the variance.",
    "quantiles": "One line a group of walls: number of answers, number of wide brackets, mean and "
    "standard deviation without these, the mean and quantiles of all as low and as high as the brackets allow.",
    "neighbours": "Runs with a lower value from the mechanism of a neighbouring wall, and their value without it. A "
    "search may miss a state at one point of a study and find it at the next.",
    "fragility": "Probability of collapse counted over walls (95 % by Greenwood, log-log) beside a lognormal curve "
    "(95 % by bootstrap).",
}
"""How each table is read, in the order of the page: answers to questions first, long lists last."""


@dataclass(frozen=True)
class StudyPage:
    """What the page shows.

    Attributes:
        title, question: the study's.
        command, created: how and when it was made.
        rows: one row a run.
        grid: names of the quantities on the grid.
        tables: statistics by name.
        remarks: sentences for the reader.
        data: paths of files, from the folder of the page.
        marks: how methods are drawn; the place in a chart chooses for others.
    """

    title: str
    question: str
    command: str
    created: str
    rows: pd.DataFrame
    grid: list[str]
    tables: dict[str, pd.DataFrame]
    remarks: list[str] = field(default_factory=list)
    data: list[str] = field(default_factory=list)
    marks: Mapping[str, Mark] = field(default_factory=dict)


@dataclass(frozen=True)
class _StudyCharts:
    """Charts of one kind, side by side.

    Attributes:
        title, read: heading, and how to read them.
        drawn: captions and drawings; the caption of an only one is empty.
        left: what is not drawn, in words; empty where all is.
    """

    title: str
    read: str
    drawn: list[tuple[str, Markup]]
    left: str


@dataclass(frozen=True)
class _AgreementMap:
    """Where the families agree: a row a point of the other quantities, a column a value of the axis.

    Attributes:
        axis: the quantity across.
        columns: its values.
        rows: names of rows with the shade and the text of each cell; None where there is no wall.
        legend: what the shades mean.
        left: what is left out, in words; empty where all is shown.
    """

    axis: str
    columns: list[str]
    rows: list[tuple[str, list[tuple[str, str] | None]]]
    legend: Markup
    left: str


def render(page: StudyPage) -> str:
    """The page as text."""
    counts = page.rows["status"].value_counts()
    return (
        environment()
        .get_template("study.html.j2")
        .render(
            page=page,
            style=Markup(files("reports").joinpath("static/report.css").read_text(encoding="utf-8")),
            statuses=[(str(name), int(count)) for name, count in counts.items()],
            seconds=numbers.seconds(float(page.rows["cpu_seconds"].sum())),
            charts=list(_charts(page)),
            map=_agreement_map(page),
            answer=answer(page.tables),
            found=findings(page.tables, page.grid),
            tables=[(name, _READ[name], *_cells(shown)) for name, shown in _shown(page) if len(shown)],
            folded=FOLDED,
        )
    )


def _shown(page: StudyPage) -> Iterator[tuple[str, pd.DataFrame]]:
    """The tables of the page, in its order; where families agree is a map of its own."""
    for name in _READ:
        table = page.tables.get(name)
        if table is not None:
            yield name, table


def _agreement_map(page: StudyPage) -> _AgreementMap | None:
    """Where families agree; None where it is known of fewer than two walls."""
    table = page.tables.get("agreement")
    if table is None or not len(table):
        return None
    axis = _main_axis(table, page.grid)
    others = _others(table, ("case", *page.grid), axis)
    values = [] if axis is None else sorted(table[axis].dropna().unique())
    rows: list[tuple[str, list[tuple[str, str] | None]]] = []
    for name, group in _groups(table, others) if others else [("", table)]:
        if axis is None:
            rows.extend((name, [_agreement(row)]) for row in group.to_dict("records"))
            continue
        at = {row[axis]: _agreement(row) for row in group.to_dict("records")}
        rows.append((name, [at.get(value) for value in values[:MAP_COLUMNS]]))
    cut = max(0, len(rows) - MAP_ROWS), max(0, len(values) - MAP_COLUMNS)
    left = [numbers.count(number, what) for number, what in zip(cut, ("row", "column"), strict=True) if number]
    return _AgreementMap(
        axis or "",
        [_cell(value) for value in values[:MAP_COLUMNS]],
        rows[:MAP_ROWS],
        legend({cell[0] for _, cells in rows for cell in cells if cell is not None}),
        f"{' and '.join(left)} more are in agreement.csv." if left else "",
    )


def _agreement(row: Mapping[Hashable, Any]) -> tuple[str, str]:
    """The shade of a wall and its text: nothing where all agree, otherwise by how much they differ."""
    if row["agree"] == "":
        return "lost", "–"
    least, most = 0.01 * float(row["least_percent"]), 0.01 * float(row["most_percent"])
    return shade(least, most), "" if row["agree"] == "yes" else percent_text(least, most)


def _cells(table: pd.DataFrame) -> tuple[list[str], list[list[str]], int]:
    """Heads, rows and the number of rows left out of a table; the least and the most of a value stand in one cell."""
    shown = table.head(MOST_ROWS)
    columns: dict[str, list[str]] = {}
    for name in map(str, table.columns):
        texts, value = [_cell(value) for value in shown[name]], name.removesuffix("_high")
        if name.endswith("_low") and f"{name.removesuffix('_low')}_high" in table:
            continue
        if value != name and f"{value}_low" in table:
            least = [_cell(value) for value in shown[f"{value}_low"]]
            name = "mean of all" if value == "mean" else value
            texts = [low if low == high else f"{low} to {high}" for low, high in zip(least, texts, strict=True)]
        columns[name] = texts
    return list(columns), [list(row) for row in zip(*columns.values(), strict=True)], len(table) - len(shown)


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return "" if value != value else f"{value:.6g}"
    return "" if value is None or value is pd.NA else str(value)


_POINTS = (
    "Points are medians; bars, where there are any, reach from the 5 % to the 95 % quantile over seeds and draws, as "
    "low and as high as measured brackets allow. A bar without a point is a bracket."
)
_COUNTED = (
    "Points are counted, one a wall; the line is the lognormal curve fitted to them, in its band of 95 %. Where a wall "
    "falls under its dead load there is no such curve, and the share counted is a staircase with its interval."
)


def _charts(page: StudyPage) -> Iterator[_StudyCharts]:
    """Multipliers over the main axis, then fragility curves."""
    spread = page.tables["quantiles"]
    axis = _main_axis(spread, page.grid)
    if axis is not None:
        others = _others(spread, ("case", *page.grid), axis)
        parts = [("", spread)]
        if others and (spread["method"].nunique() > 1 or _over_axis(spread, axis, page)[1]):
            parts = list(_groups(spread, others))  # one chart for each of the other quantities' values
        drawn = [(name, *_over_axis(part, axis, page, name)) for name, part in parts[:MOST_CHARTS]]
        yield _StudyCharts(
            f"Multiplier over {axis}",
            _POINTS,
            [(name, charts.svg(chart)) for name, chart, _ in drawn],
            _left(sum(left for _, _, left in drawn), len(parts) - len(drawn)),
        )
    curves = page.tables.get("fragility")
    if curves is not None and len(curves):
        chart, left = _fragility(curves, page)
        yield _StudyCharts("Fragility", _COUNTED, [("", charts.svg(chart))], _left(left, 0))


def _left(lines: int, whole: int) -> str:
    """What is not drawn, in words."""
    counts = [numbers.count(number, what) for number, what in ((lines, "line"), (whole, "chart")) if number]
    if not counts:
        return ""
    return f"{' and '.join(counts)} more {'is' if lines + whole == 1 else 'are'} not drawn; the files have them."


def _others(table: pd.DataFrame, names: Sequence[str], axis: str | None) -> list[str]:
    """The quantities that vary beside an axis, those left out that go along with it."""
    varied = [name for name in names if name != axis and table[name].nunique(dropna=False) > 1]
    if axis is None:
        return varied
    return [name for name in varied if table.groupby(axis)[name].nunique(dropna=False).max() > 1]


def _main_axis(table: pd.DataFrame, grid: Sequence[str]) -> str | None:
    """The numeric quantity of the grid with most values, or None."""
    numeric = [name for name in grid if pd.api.types.is_numeric_dtype(table[name]) and table[name].nunique() > 1]
    return max(numeric, key=lambda name: table[name].nunique(), default=None)


def _over_axis(table: pd.DataFrame, axis: str, page: StudyPage, of: str = "") -> tuple[charts.Chart, int]:
    """Medians and quantiles over a quantity, and how many lines are left out; wide brackets are bars alone."""
    series = []
    table = _by_method(table[table[axis].notna()], page)
    for name, group in _groups(table, ["method", *_others(table, ("case", *page.grid), axis)]):
        line = group[group["answered"] > 0].sort_values(axis)
        barred = bool((line["q05_low"] < line["q95_high"]).any())
        exact = line["q50_low"] == line["q50_high"]
        series.append(
            charts.Series(
                name,
                line[axis].astype(float).tolist(),
                line["q50_low"].where(exact).astype(float).tolist(),
                low=line["q05_low"].astype(float).tolist() if barred else [],
                high=line["q95_high"].astype(float).tolist() if barred else [],
                mark=page.marks.get(name),
            )
        )
    series = [line for line in series if line.x]
    title = f"Multiplier over {axis}" + (f": {of}" if of else "")
    return charts.Chart(title, axis, "collapse multiplier", series[:MOST_SERIES]), max(0, len(series) - MOST_SERIES)


def _by_method(table: pd.DataFrame, page: StudyPage) -> pd.DataFrame:
    """Rows in the order of the methods of the study."""
    places = {name: number for number, name in enumerate(page.marks)}
    return table.sort_values("method", key=lambda names: names.map(lambda name: places.get(name, 0)), kind="stable")


def _fragility(table: pd.DataFrame, page: StudyPage) -> tuple[charts.Chart, int]:
    series = []
    for name, group in _groups(_by_method(table, page), ["case", "method", *page.grid]):
        mark = page.marks.get(name)
        x, counted = group["multiplier"].tolist(), group["probability"].tolist()
        if group["lognormal"].notna().all():
            low, high = group["lognormal_low"].tolist(), group["lognormal_high"].tolist()
            series.append(charts.Series(name, x, counted, low, high, curve=group["lognormal"].tolist(), mark=mark))
        else:  # a wall that falls under its dead load has no logarithm, and a wide bracket no place
            low = group["low"].fillna(group["probability"]).tolist()
            high = group["high"].fillna(group["probability_at_most"]).tolist()
            series.append(charts.Series(name, x, counted, low, high, marks=False, step=True, mark=mark))
    chart = charts.Chart("Fragility", "multiplier", "probability of collapse", series[:MOST_SERIES], zero_y=True)
    return chart, max(0, len(series) - MOST_SERIES)


def _groups(table: pd.DataFrame, by: Sequence[str]) -> Iterator[tuple[str, pd.DataFrame]]:
    """Groups with a name of what tells them apart."""
    varying = [name for name in by if table[name].nunique(dropna=False) > 1] or ["method"]
    for values, group in table.groupby(varying, dropna=False, sort=False):
        parts = [
            str(value) if name in ("case", "method") else f"{name} {_cell(value)}"
            for name, value in zip(varying, values, strict=True)
            if not (isinstance(value, float) and value != value)
        ]
        yield ", ".join(parts) or "all", group
