"""The page of a study: what was asked, charts over its grid, fragility curves and tables of statistics."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

import pandas as pd
from markupsafe import Markup

from harness.model.writing import write_whole
from reports import charts
from reports.environment import environment
from reports.study_findings import findings

MOST_SERIES, MOST_ROWS, FOLDED = 12, 400, 20
"""Lines in one chart and rows in one table of the page, the files beside it hold all; a longer table is folded."""

READ = {
    "failure": "Share of walls that collapse at or below a multiplier, with Wilson's score interval at 95 %.",
    "sensitivity": "Borgonovo's delta: 0 where a quantity does not matter, 1 where nothing else does; and the share of "
    "the variance it explains alone.",
    "quantiles": "One line a group of walls: how many answered, mean, standard deviation and quantiles of the "
    "multiplier over seeds and draws.",
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
            charts=[(title, Markup(charts.svg(chart))) for title, chart in _charts(page)],
            found=findings(page.tables, page.grid),
            tables=[(name, READ[name], *_cells(page.tables[name])) for name in READ if len(page.tables.get(name, ()))],
            folded=FOLDED,
        )
    )


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


def _charts(page: StudyPage) -> Iterator[tuple[str, charts.Chart]]:
    spread = page.tables["quantiles"]
    axis = _main_axis(spread, page.grid)
    if axis is not None:
        yield f"Multiplier over {axis}", _over_axis(spread, axis, [name for name in page.grid if name != axis])
    curves = page.tables.get("fragility")
    if curves is not None and len(curves):
        yield "Fragility", _fragility(curves, ["case", "method", *page.grid])


def _main_axis(table: pd.DataFrame, grid: Sequence[str]) -> str | None:
    """The numeric quantity of the grid with most values, or None."""
    numeric = [name for name in grid if pd.api.types.is_numeric_dtype(table[name]) and table[name].nunique() > 1]
    return max(numeric, key=lambda name: table[name].nunique(), default=None)


def _over_axis(table: pd.DataFrame, axis: str, others: Sequence[str]) -> charts.Chart:
    series = []
    for name, group in _groups(table[table[axis].notna()], ["case", "method", *others]):
        line = group[group["q50"].notna()].sort_values(axis)
        several = bool((line["answered"] > 1).any())
        series.append(
            charts.Series(
                name,
                line[axis].astype(float).tolist(),
                line["q50"].astype(float).tolist(),
                low=line["q05"].astype(float).tolist() if several else [],
                high=line["q95"].astype(float).tolist() if several else [],
            )
        )
    series = [line for line in series if line.x][:MOST_SERIES]
    return charts.Chart(f"Multiplier over {axis}", axis, "collapse multiplier", series)


def _fragility(table: pd.DataFrame, by: Sequence[str]) -> charts.Chart:
    series = []
    for name, group in _groups(table, by):
        x, counted = group["multiplier"].tolist(), group["probability"].tolist()
        if group["lognormal"].notna().all():
            low, high = group["lognormal_low"].tolist(), group["lognormal_high"].tolist()
            series.append(charts.Series(name, x, counted, low, high, curve=group["lognormal"].tolist()))
        else:  # a wall that falls under its dead load has no logarithm
            low, high = (group[end].fillna(group["probability"]).tolist() for end in ("low", "high"))
            series.append(charts.Series(name, x, counted, low, high, marks=False, step=True))
    return charts.Chart("Fragility", "multiplier", "probability of collapse", series[:MOST_SERIES], zero_y=True)


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
