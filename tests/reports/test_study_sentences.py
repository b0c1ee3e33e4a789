"""Sentences and tables about grids and studies against what they have to say of data made by hand."""

from __future__ import annotations

import math
from typing import Any

import pandas as pd

from harness.model.case import Case
from harness.model.comparison import CaseResults, ComparisonRun
from reports.charts import families, grid
from reports.charts.grid import GridCell
from reports.charts.study_findings import answer, findings
from reports.page import paper
from tests.reports import samples
from tests.walls import case as wall_case
from tests.walls import running_bond


def cell(proportion: float, friction: float, fe: float, la: float, **more: Any) -> GridCell:
    """A wall of a grid with a multiplier of FE and one of LA."""
    kept: dict[str, Any] = {"associated": None, "above": None, "head_thrust": {}} | more
    ranges = {"fe": (fe, fe), "la": (la, la)}
    return GridCell(0, proportion, friction, ranges, {name: samples.TRAITS[name] for name in ranges}, **kept)


def test_a_grid_is_told_in_its_own_figures():
    """FE lies 8.26 % and 14.3 % above the middle of both; medians are of the two walls on which they differ."""
    bound = {"above": "la-associated"}
    cells = [
        cell(2.0, 0.5, 0.5, 0.5, associated=0.8, head_thrust={"fe": 9.0, "la": 9.0, "la-associated": 9.0}, **bound),
        cell(2.0, 0.8, 0.59, 0.5, associated=0.885, head_thrust={"fe": 0.1, "la": 0.2, "la-associated": 0.5}, **bound),
        cell(3.0, 0.5, 0.65, 0.65),
        cell(3.0, 0.8, 0.8, 0.6, associated=1.0, head_thrust={"fe": 0.3, "la": 0.4, "la-associated": 0.9}, **bound),
    ]
    assert grid._where(cells) == (
        "They agree within 1 % on 2 of 4 walls. The least friction at which they differ is, by proportion, 2:1 at 0.8, "
        "3:1 at 0.8."
    )
    assert list(grid._why(cells)) == [
        "On 2 of the 2 walls where they differ, FE is highest, by up to 14 % from the middle one; its head joints "
        "carry 0.2 of the wall's weight there in the median, with 0.3 in LA.",
        "The least known multiplier is not monotone in friction: it falls at 3:1 from 0.65000 at 0.5 to 0.60000 at "
        "0.8.",
        "The associated maximum lies up to 50 % above FE where they differ: its forces press on the head joints with "
        "0.7 of the wall's weight in the median, FE's with 0.2, LA's with 0.3.",
    ]
    assert [(each.text, each.shade, each.least) for each in cells] == [
        ("agree", "agree", "LA 0.50000"),
        ("FE high 8 %", "differ-2", "LA 0.50000"),
        ("agree", "agree", "LA 0.65000"),
        ("FE high 14 %", "differ-3", "LA 0.60000"),
    ]
    assert cells[1].hover == "fe 0.59000, la 0.50000, associated maximum 0.88500 (upper bound)"
    alone = [cells[0], cells[1]]
    assert next(iter(grid._why(alone))) == (
        "On the one wall where they differ, FE is highest, by 8 % from the middle one; its head joints carry 0.1 of "
        "the wall's weight there, with 0.2 in LA."
    )


def test_walls_of_a_grid_on_which_an_answer_is_missing_or_a_bracket_open_are_counted_apart():
    traits = {name: samples.TRAITS[name] for name in ("la", "de")}

    def of(la: tuple[float, float] | None, de: tuple[float, float] | None) -> GridCell:
        return GridCell(3, 2.0, 0.5, {"la": la, "de": de}, traits, None, None, {})

    near, open_, lost, low = (
        of((0.5, 0.5), (0.499, 0.501)),
        of((0.5, 0.5), (0.45, 0.55)),
        of((0.5, 0.5), None),
        of((0.5, 0.5), (0.3, 0.4)),
    )
    assert [(each.text, each.shade) for each in (near, open_, lost, low)] == [
        ("agree", "agree"),
        ("DE open", "open"),
        ("no DE", "lost"),
        ("LA high 18 %", "differ-3"),  # the middle of .5 and .35 is .425
    ]
    assert open_.hover == "la 0.50000, de [0.45000, 0.55000]"
    assert grid._where([near, near, open_, lost, low]) == (
        "They agree within 1 % on 2 of 5 walls; on 1 a measured bracket does not decide; on 1 a method gave no answer. "
        "The least friction at which they differ is, by proportion, 2:1 at 0.5."
    )
    assert (
        grid._where([near, open_]) == "They agree within 1 % on 1 of 2 walls; on 1 a measured bracket does not decide."
    )
    wide = of((0.25, 0.75), (0.45, 0.55))
    assert wide.text == "LA open", "the widest of all is what leaves it open"


def test_the_papers_tables_stand_beside_ours_in_numbers():
    found = paper.paper_comparison(samples.typical())
    assert found is not None
    assert found.experiment == (
        "A wall that fails 20 % earlier than ours would fail at 0.452 (FE), 0.446 (LA), 0.451 to 0.453 (DE)."
    )
    assert (found.names, found.ratio_paper, found.ratio_ours) == ("FE : LA : DE", "20 : 15 : 360", "20 : 10 : 400")
    assert found.ratio_to_value == "20 : 10 : 400", "the search had its value at its end, after .1 s"
    assert [
        (row.method, row.paper_ratio, row.ratio, row.cpu.text, row.settings, row.changed) for row in found.cost
    ] == [
        ("fe", "20.0", "20.0", "200 ms", 2, "none"),
        ("la", "15.0", "10.0", "100 ms", 2, "none"),
        ("de", "360", "400", "4 s", 2, "none"),
    ]
    assert [row.until_value for row in found.cost] == [None, 0.1, None]
    assert [(row.ours.text, row.anchor) for row in found.block] == [
        ("0.47619", "run-0-0"),
        ("0.40000", "run-0-1"),
        ("0.54545", "run-0-2"),
        ("[0.41270, 0.54550]", "run-0-3"),
    ]
    assert [row.difference for row in found.block][:3] == ["0", "0", "0"] or all(
        row.difference == "0" or "×10⁻¹" in row.difference or row.difference == "10⁻¹⁶" for row in found.block[:3]
    )


def table(rows: list[dict[str, Any]]) -> dict[str, pd.DataFrame]:
    base = {"case": "a", "method": "fe", "answered": 1, "brackets": 0, "deviation": math.nan}
    full = []
    for row in rows:
        mean = row.get("mean", math.nan)
        ends = {"mean_low": mean, "mean_high": mean, "q05_low": mean, "q95_high": mean}
        full.append(base | ends | row)
    return {"quantiles": pd.DataFrame(full)}


def test_multipliers_of_a_study_are_told_along_its_grid_or_by_their_scatter():
    along = [{"friction": mu, "mean": mean} for mu, mean in ((0.4, 0.45), (0.6, 0.4), (0.8, 0.5))]
    assert findings(table(along), ["friction"]) == [
        "fe: multipliers from 0.40000 (friction 0.6) to 0.50000 (friction 0.8)."
    ]
    level = [{"friction": mu, "mean": 0.4} for mu in (0.4, 0.6)]
    assert findings(table(level), ["friction"]) == ["fe: multipliers 0.40000 at all points of the grid."]
    drawn = [{"friction": mu, "mean": mean, "answered": 5} for mu, mean in ((0.4, 0.45), (0.6, 0.4))]
    assert findings(table(drawn), ["friction"])[0].startswith("fe: mean multipliers from 0.40000 (friction 0.6)")
    scattered = {"mean": 0.45, "deviation": 0.05, "answered": 12, "brackets": 2, "q05_low": 0.4, "q95_high": 0.5}
    assert findings(table([scattered]), []) == [
        "fe: mean multiplier 0.450, standard deviation 0.050 over 10 walls; nine of ten lie between 0.400 and 0.500; "
        "2 of 12 answers are wide brackets."
    ]
    wide = {"mean_low": 0.4, "mean_high": 0.5, "answered": 3, "brackets": 3}
    assert findings(table([wide]), []) == ["fe: mean multiplier [0.40000, 0.50000]; 3 of 3 answers are wide brackets."]
    assert findings(table([wide | {"answered": 2, "brackets": 2}]), [])[0].startswith("fe: mean multiplier")
    assert findings(table([{"mean": 0.4}]), []) == ["fe: multiplier 0.40000."]
    two = [{"mean": 0.4}, {"mean": 0.5, "case": "b"}, {"mean": 0.5, "case": "b", "method": "la", "answered": 0}]
    assert findings(table(two), []) == ["fe on a: multiplier 0.40000.", "fe on b: multiplier 0.50000."]
    many = [{"mean": 0.4, "method": f"m{k}"} for k in range(7)]
    assert findings(table(many), []) == []
    assert len(findings(table(many[:6]), [])) == 6


def test_probabilities_and_influences_of_a_study_are_told():
    failure = {
        "case": ["a", "a"],
        "method": ["fe", "la"],
        "multiplier": [0.4, 0.4],
        "probability": [0.25, 0.5],
        "probability_at_most": [0.25, 0.75],
        "walls": [8, 8],
        "low": [0.07, 0.2],
        "high": [0.59, 0.9],
    }
    matters = {
        "case": ["a"] * 3,
        "method": ["fe"] * 3,
        "quantity": ["friction", "size", "load"],
        "delta": [0.2, 0.61, 0.1],
        "delta_confidence": [0.1, 0.1, 0.1],
        "walls": [50] * 3,
    }
    found = table([{"mean": 0.4, "method": f"m{k}"} for k in range(7)])
    found |= {"failure": pd.DataFrame(failure), "sensitivity": pd.DataFrame(matters)}
    assert findings(found, []) == [
        "At multiplier 0.4 (fe), 25 % of 8 walls have collapsed; 95 % interval 7 to 59 %.",
        "At multiplier 0.4 (la), 50 to 75 % of 8 walls have collapsed; 95 % interval 20 to 90 %.",
        "Most depends on size (Borgonovo's delta 0.61) by fe.",
    ]
    found["sensitivity"]["delta_confidence"] = 0.21
    assert findings(found, [])[-1] == (
        "Whether size or friction matters more, 50 walls do not decide by fe (Borgonovo's delta 0.61 and 0.20)."
    )


def test_walls_of_a_study_are_counted_by_whether_families_agree():
    agree = {"agree": ["yes", "no", "no", "open", ""], "most_percent": [0.1, 3.0, 7.5, 9.0, math.nan]}
    assert answer({"agreement": pd.DataFrame(agree)}) == (
        "The families agree within 1 % on 1 of 5 walls and differ on 2, by up to 7.5 %; on 1 brackets do not decide; 1 "
        "lack the answer of a family."
    )
    assert answer({"agreement": pd.DataFrame({"agree": ["yes"], "most_percent": [0.1]})}) == (
        "The families agree within 1 % on 1 of 1 wall."
    )


def test_walls_are_one_family_only_where_their_loads_are_alike():
    def wall(push: tuple[float, float], friction: float, gravity: tuple[float, float] = (0.0, -1.0)) -> Case:
        loads = {"live": {"body": [{"per_weight": list(push)}]}, "gravity": list(gravity)}
        return wall_case(running_bond(3, 2), friction, loads=loads)

    def studies(cases: list[Case]) -> int:
        items = [CaseResults(case, [samples.solved(case, "la", 0.5)]) for case in cases]
        return len(families.families(ComparisonRun("", "", "", items)))

    frictions = (0.4, 0.6, 0.8)
    assert studies([wall((1.0, 0.0), mu) for mu in frictions]) == 1
    assert studies([wall((1.0, 0.0 if mu < 0.7 else -0.5), mu) for mu in frictions]) == 0
    assert studies([wall((1.0, 0.0), mu, (0.0, -1.0 if mu < 0.7 else -1.5)) for mu in frictions]) == 0
