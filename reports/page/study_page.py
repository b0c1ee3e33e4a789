"""The page of a study: what was asked, charts over its grid, fragility curves and tables of statistics."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

import pandas as pd
from markupsafe import Markup

from harness.model.ranges import percent_text
from harness.model.writing import write_whole
from reports.charts import charts
from reports.charts.study_findings import findings
from reports.environment import environment

MOST_SERIES, MOST_CHARTS, MOST_ROWS, FOLDED = 12, 40, 400, 20
"""Lines in one chart, charts over one quantity and rows in one table of the page, the files beside it hold all; a
longer table is folded."""

READ = {
    "agreement": "A row is a point of the grid, a column a value of the quantity on the axis. “agree”: the multipliers "
    "of all families lie within 1 % of the lowest. Otherwise the cell gives how far the highest lies above the lowest; "
    "two numbers are the least and the greatest difference that brackets allow. “open”: the brackets do not decide.",
    "failure": "Share of walls that collapse at or below a multiplier, with Wilson's score interval at 95 %. A wall "
    "whose wide bracket holds the multiplier counts in `probability_at_most` only.",
    "sensitivity": "Borgonovo's delta: 0 where a quantity does not matter, 1 where nothing else does; and the share of "
    "the variance it explains alone.",
    "quantiles": "One line a group of walls: how many answered, how many of them with a wide bracket, mean and "
    "standard deviation without these, the mean and quantiles of all as low and as high as the brackets allow.",
    "neighbours": "Runs that a mechanism of a neighbouring wall led lower, and what they had found alone. A search "
    "that misses a state at one point of a study may find it at the next.",
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
        data: names of the files beside the page.
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


def write_page(page: StudyPage, path: Path) -> None:
    """Write the page of a study as one HTML file that works offline."""
    write_whole(path, render(page))


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
            seconds=float(page.rows["cpu_seconds"].sum()),
            charts=[(title, Markup(charts.svg(chart)), left) for title, chart, left in _charts(page)],
            found=findings(page.tables, page.grid),
            tables=[(name, READ[name], *_cells(shown)) for name, shown in _shown(page) if len(shown)],
            folded=FOLDED,
        )
    )


def _shown(page: StudyPage) -> Iterator[tuple[str, pd.DataFrame]]:
    """The tables of the page, in its order; that of agreement with its axis across."""
    for name in READ:
        table = page.tables.get(name)
        if table is not None:
            yield name, _across(table, page.grid) if name == "agreement" else table


def _across(table: pd.DataFrame, grid: Sequence[str]) -> pd.DataFrame:
    """Where families agree, one row for the other quantities and one column for a value of the main axis."""
    axis = _main_axis(table, grid)
    said = table.assign(said=[_agreement(row) for row in table.to_dict("records")])
    others = [name for name in ("case", *grid) if name != axis and table[name].nunique(dropna=False) > 1]
    if axis is None:
        return said[[*others, "said"]]
    wide = said.pivot_table(
        index=others or ["case"], columns=axis, values="said", aggfunc=", ".join, fill_value="", sort=False
    )
    wide.columns = [f"{axis} {value:g}" for value in wide.columns]
    return wide.reset_index()


def _agreement(row: Mapping[Hashable, Any]) -> str:
    if row["agree"] == "":
        return "no answer of all"
    if row["agree"] == "yes":
        return "agree"
    apart = percent_text(0.01 * row["least_percent"], 0.01 * row["most_percent"])
    return f"open, {apart}" if row["agree"] == "open" else apart


def _cells(table: pd.DataFrame) -> tuple[list[str], list[list[str]], int]:
    """Heads, rows and the number of rows left out of a table."""
    shown = table.head(MOST_ROWS)
    return (
        list(map(str, table.columns)),
        [[_cell(value) for value in row] for row in shown.itertuples(index=False)],
        (len(table) - len(shown)),
    )


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return "" if value != value else f"{value:.6g}"
    return "" if value is None or value is pd.NA else str(value)


def _charts(page: StudyPage) -> Iterator[tuple[str, charts.Chart, int]]:
    """Titles and charts, with the number of lines that were not drawn for want of room."""
    spread = page.tables["quantiles"]
    axis = _main_axis(spread, page.grid)
    if axis is not None:
        drawn = [_over_axis(spread, axis, page.grid)]
        others = [name for name in ("case", *page.grid) if name != axis and spread[name].nunique(dropna=False) > 1]
        if drawn[0][1] and others:  # too many lines for one chart: one for each of the other quantities' values
            drawn = [_over_axis(part, axis, page.grid, name) for name, part in _groups(spread, others)][:MOST_CHARTS]
        for chart, left in drawn:
            yield chart.title, chart, left
    curves = page.tables.get("fragility")
    if curves is not None and len(curves):
        yield "Fragility", *_fragility(curves, ["case", "method", *page.grid])


def _main_axis(table: pd.DataFrame, grid: Sequence[str]) -> str | None:
    """The numeric quantity of the grid with most values, or None."""
    numeric = [name for name in grid if pd.api.types.is_numeric_dtype(table[name]) and table[name].nunique() > 1]
    return max(numeric, key=lambda name: table[name].nunique(), default=None)


def _over_axis(table: pd.DataFrame, axis: str, grid: Sequence[str], of: str = "") -> tuple[charts.Chart, int]:
    """Medians and quantiles over a quantity, and how many lines are left out; wide brackets are bars alone."""
    series = []
    others = [name for name in grid if name != axis]
    for name, group in _groups(table[table[axis].notna()], ["case", "method", *others]):
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
            )
        )
    series = [line for line in series if line.x]
    title = f"Multiplier over {axis}" + (f": {of}" if of else "")
    return charts.Chart(title, axis, "collapse multiplier", series[:MOST_SERIES]), max(0, len(series) - MOST_SERIES)


def _fragility(table: pd.DataFrame, by: Sequence[str]) -> tuple[charts.Chart, int]:
    series = []
    for name, group in _groups(table, by):
        x, counted = group["multiplier"].tolist(), group["probability"].tolist()
        if group["lognormal"].notna().all():
            low, high = group["lognormal_low"].tolist(), group["lognormal_high"].tolist()
            series.append(charts.Series(name, x, counted, low, high, curve=group["lognormal"].tolist()))
        else:  # a wall that falls under its dead load has no logarithm, and a wide bracket no place
            low = group["low"].fillna(group["probability"]).tolist()
            high = group["high"].fillna(group["probability_at_most"]).tolist()
            series.append(charts.Series(name, x, counted, low, high, marks=False, step=True))
    chart = charts.Chart("Fragility", "multiplier", "probability of collapse", series[:MOST_SERIES], zero_y=True)
    return chart, max(0, len(series) - MOST_SERIES)


def _groups(table: pd.DataFrame, by: Sequence[str]) -> Iterator[tuple[str, pd.DataFrame]]:
    """Groups with a name of what tells them apart."""
    telling = [name for name in by if table[name].nunique(dropna=False) > 1] or ["method"]
    for values, group in table.groupby(telling, dropna=False, sort=False):
        parts = [
            str(value) if name in ("case", "method") else f"{name} {_cell(value)}"
            for name, value in zip(telling, values, strict=True)
            if not (isinstance(value, float) and value != value)
        ]
        yield ", ".join(parts) or "all", group
