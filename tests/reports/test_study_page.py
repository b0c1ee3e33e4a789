"""The page of a study: its sentences, its fragility curve, and what it folds away."""

from __future__ import annotations

import numpy as np
import pandas as pd

from harness.engine.sweep import statistics
from harness.engine.sweep.frame import tidy
from reports.study_findings import findings
from reports.study_page import StudyPage, render


def walls(values: list[float], method: str = "fe", **columns: list[float]) -> pd.DataFrame:
    answer = {"case": "a", "method": method, "status": "ok", "finding": "collapses", "judge_accepted": True}
    rows = [{"number": number, "multiplier": value} | answer for number, value in enumerate(values)]
    return tidy(rows, []).assign(**columns)


def tables_of(rows: pd.DataFrame, *grid: str, multipliers: tuple[float, ...] = ()) -> dict[str, pd.DataFrame]:
    by = ["case", "method", *grid]
    found = {"quantiles": statistics.quantiles(rows, by), "fragility": statistics.fragility(rows, by)}
    return found | ({"failure": statistics.failure_probability(rows, by, multipliers)} if multipliers else {})


def page_of(rows: pd.DataFrame, tables: dict[str, pd.DataFrame]) -> str:
    return render(StudyPage("A study", "", "drystone sweep", "now", rows, [], tables))


def test_scatter_is_told_with_its_interval():
    rows = walls([0.40, 0.44, 0.50, 0.55, 0.62])
    said = " ".join(findings(tables_of(rows, multipliers=(0.5,)), []))
    assert "mean multiplier 0.502, standard deviation 0.087 over 5 walls" in said
    assert "At multiplier 0.5, 60 % of 5 walls have collapsed; 95 % interval 23 to 88 %." in said


def test_the_ends_of_a_grid_are_told_by_their_multipliers():
    rows = walls([0.3, 0.5, 0.4], friction=[0.3, 0.5, 0.9])
    said = findings(tables_of(rows, "friction"), ["friction"])
    assert said == ["fe: multipliers from 0.30000 (friction 0.3) to 0.50000 (friction 0.5)."]


def test_what_matters_is_told_only_where_intervals_part():
    rows = walls([0.4, 0.5, 0.6])
    sensitivity = pd.DataFrame({"case": "a", "method": "fe", "quantity": ["friction", "size"], "walls": 200})
    sensitivity = sensitivity.assign(
        delta=[0.6, 0.2], delta_confidence=0.1, first_order=0.5, first_order_confidence=0.1
    )
    tables = tables_of(rows) | {"sensitivity": sensitivity}
    assert "Most depends on friction (Borgonovo's delta 0.60) by fe." in findings(tables, [])
    tables["sensitivity"] = sensitivity.assign(delta_confidence=0.3)
    assert "200 walls do not tell" in findings(tables, [])[-1]


def test_a_fitted_curve_lies_in_its_band_and_a_wall_that_falls_leaves_a_staircase():
    rows = walls(np.exp(np.random.default_rng(1).normal(-0.7, 0.2, 30)).tolist())
    page = page_of(rows, tables_of(rows))
    assert 'class="band s0"' in page
    assert 'class="bar s0"' not in page
    rows.loc[0, ["finding", "multiplier"]] = ["falls", np.nan]
    page = page_of(rows, tables_of(rows))
    assert 'class="band s0"' not in page
    assert 'class="bar s0"' in page


def test_long_tables_are_folded():
    rows = walls(np.linspace(0.4, 0.6, 30).tolist())
    page = page_of(rows, tables_of(rows, multipliers=(0.5,)))
    assert page.count("<details>") == 1
    assert page.index("<h2>Failure") < page.index("<h2>Quantiles") < page.index("<h2>Fragility</h2>\n<p")
