"""The page of a study: its sentences, its fragility curve, and what it folds away."""

from __future__ import annotations

import re

import numpy as np
import pandas as pd

from harness.engine.sweep import statistics
from harness.engine.sweep.frame import tidy
from harness.model.method import Traits
from harness.model.method_registry import load_method
from reports.charts.grid import shade
from reports.charts.study_findings import answer, findings
from reports.charts.styles import mark_named
from reports.page.study_page import StudyPage, render


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
    assert "200 walls do not decide" in findings(tables, [])[-1]


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


def families_over_friction(lines: int) -> pd.DataFrame:
    """FE and LA on so many proportions at two frictions; LA lies 20 % lower at the greater friction."""
    parts = []
    for method, last in (("fe", 0.6), ("la", 0.5)):
        values = [value for _ in range(lines) for value in (0.3, last)]
        grid = {"friction": [0.3, 0.9] * lines, "proportion": [f"{k}:1" for k in range(lines) for _ in range(2)]}
        parts.append(walls(values, method, **grid).assign(family=method))
    return pd.concat(parts, ignore_index=True)


def test_a_grid_has_a_table_of_where_the_families_agree():
    rows, grid = families_over_friction(2), ["friction", "proportion"]
    tables = tables_of(rows, *grid) | {"agreement": statistics.agreement(rows, ["case", *grid])}
    said = answer(tables)
    assert said == "The families agree within 1 % on 2 of 4 walls and differ on 2, by up to 20.0 %."
    page = render(StudyPage("A study", "Where?", "drystone sweep", "now", rows, grid, tables))
    assert page.index("Where?") < page.index(said) < page.index('<table class="grid">') < page.index("<svg")
    assert '<th scope="colgroup" colspan="2">friction</th>' in page
    assert '<th scope="col">0.3</th><th scope="col">0.9</th>' in page
    agree, differ = '<td class="agree"><span class="sr">agree</span></td>', '<td class="differ-2">20.0 %</td>'
    assert f'<tr><th scope="row">proportion 1:1</th>{agree}{differ}</tr>' in page
    assert "differ by more than 1 %" not in page, "the legend has the shades of the map alone"


def test_shades_say_what_is_certain():
    found = [shade(*ends) for ends in ((0.0, 0.01), (0.01, 0.3), (0.011, 0.3), (0.051, 0.3), (0.201, 0.3))]
    assert found == ["agree", "open", "differ-1", "differ-2", "differ-3"]
    assert shade(np.nan, np.nan) == "lost"


def test_methods_are_drawn_as_in_the_report_and_in_the_order_of_the_study():
    rows, grid = families_over_friction(1), ["friction"]
    marks = {name: mark_named(name, load_method(name).traits) for name in ("la", "fe")}
    page = render(StudyPage("A study", "", "c", "now", rows, grid, tables_of(rows, *grid), marks=marks))
    legend = re.findall(r'class="line" style="color:(#\w+)" stroke-dasharray="[^"]*" d="M\d+ \d+h26"/>', page)
    assert legend == [marks["la"].colour, marks["fe"].colour]
    assert mark_named("x", Traits(colour="#123456", marker="s")).shape != mark_named("x", Traits(marker="o")).shape


def test_quantities_that_vary_as_one_make_one_line():
    parts = [walls([0.3, 0.5, 0.6], name, friction=[0.3, 0.6, 0.9], courses=[1.0, 2.0, 3.0]) for name in ("fe", "la")]
    rows, grid = pd.concat(parts, ignore_index=True), ["friction", "courses"]
    page = render(StudyPage("A study", "", "c", "now", rows, grid, tables_of(rows, *grid)))
    assert page.count("<svg") == 1
    assert page.count("<title>fe: ") == 3


def test_charts_that_are_left_out_are_counted_and_files_are_linked():
    rows, grid = families_over_friction(43), ["friction", "proportion"]
    page = render(StudyPage("A study", "", "c", "now", rows, grid, tables_of(rows, *grid), data=["a b/runs.csv"]))
    assert page.count("<svg") == 40
    assert "3 charts more are not drawn; the files have them." in page
    assert '<li><a href="a%20b/runs.csv">a b/runs.csv</a></li>' in page


def test_lines_that_one_chart_does_not_hold_have_charts_of_their_own():
    rows, grid = families_over_friction(7), ["friction", "proportion"]
    page = render(StudyPage("A study", "", "drystone sweep", "now", rows, grid, tables_of(rows, *grid)))
    assert page.count("<figcaption>proportion ") == 7
    assert "not drawn" not in page
    few = walls([0.3, 0.6] * 6, friction=[0.3, 0.9] * 6, proportion=[float(k) for k in range(6) for _ in range(2)])
    page = render(StudyPage("A study", "", "drystone sweep", "now", few, grid[::-1], tables_of(few, *grid[::-1])))
    assert page.count("<svg") == 1


def test_lines_that_are_left_out_are_counted():
    parts = [walls([0.3, 0.5], f"m{k}", friction=[0.3, 0.9]) for k in range(15)]
    rows = pd.concat(parts, ignore_index=True)
    page = render(StudyPage("A study", "", "c", "now", rows, ["friction"], tables_of(rows, "friction")))
    assert "3 lines more are not drawn; the files have them." in page


def test_equal_multipliers_over_a_grid_have_no_ends_and_a_bracket_about_all_others_is_both():
    rows = walls([0.5, 0.5], friction=[0.3, 0.9])
    assert findings(tables_of(rows, "friction"), ["friction"]) == ["fe: multipliers 0.50000 at all points of the grid."]
    rows = walls([0.5, 0.55], friction=[0.3, 0.9])
    rows = rows.assign(bracket_low=[0.5, 0.3], bracket_high=[0.5, 0.8], bracket_wide=[False, True])
    assert findings(tables_of(rows, "friction"), ["friction"]) == [
        "fe: multipliers within [0.30000, 0.80000] at all points of the grid; 1 of 2 answers are wide brackets."
    ]


def test_lines_are_named_by_what_tells_them_apart():
    def legend(*parts: pd.DataFrame) -> list[str]:
        rows = pd.concat(parts, ignore_index=True)
        page = page_of(rows, tables_of(rows)).split("<h2>Fragility</h2>")[1]
        return re.findall(r'<text x="\d+" y="\d+">([^<]*)</text>', page.partition("</svg>")[0])

    values = [0.3, 0.4, 0.5, 0.6, 0.7]
    one, other = walls(values), walls(values, "la")
    assert legend(one) == []
    assert legend(one, other) == ["fe", "la"]
    assert legend(one, one.assign(case="b")) == ["a", "b"]
    assert legend(one, other.assign(case="b")) == ["a, fe", "b, la"]


def test_one_wall_has_a_multiplier_and_no_mean():
    assert findings(tables_of(walls([0.4])), []) == ["fe: multiplier 0.40000."]


def test_the_least_and_the_most_of_a_value_stand_in_one_cell():
    rows = walls([0.3, 0.5])
    tables = tables_of(rows)
    tables["quantiles"] = tables["quantiles"].assign(mean=0.4, mean_low=0.35, mean_high=0.45, q05_low=0.3, q05_high=0.3)
    text = page_of(rows, tables).split("<h2>Quantiles</h2>")[1].split("</table>")[0]
    heads = re.findall(r'<th scope="col">([^<]+)</th>', text)
    cells = dict(zip(heads, re.findall(r"<td>([^<]*)</td>", text), strict=True))
    assert (cells["mean"], cells["mean of all"], cells["q05"]) == ("0.4", "0.35 to 0.45", "0.3")
    assert len(heads) <= 14, "as wide as the page at 1280 px"
