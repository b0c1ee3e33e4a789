"""Sentences of the report that a reader may quote: brackets, costs, slopes, searches."""

from __future__ import annotations

import pytest

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Finding
from reports.charts import charts, curves, studies
from reports.findings.agreement import agreement, spread
from reports.page import paper
from tests.reports import samples
from tests.walls import case as wall_case
from tests.walls import stack

CASE = samples.bond("wall-21")


def measured(low: float, high: float):
    return samples.solved(CASE, "de", 0.5 * (low + high), bracket=(low, high), flow="approximate")


def test_a_value_within_a_measured_bracket_agrees_and_one_beside_it_is_as_far_off_as_the_nearest_end():
    fe = samples.solved(CASE, "fe", 0.5)
    inside = agreement(CASE.assembly, fe, measured(0.4, 0.55))
    assert (inside.difference, inside.within) == (0.0, True)
    above = agreement(CASE.assembly, fe, measured(0.51, 0.6))
    assert (above.difference, above.within) == (pytest.approx(0.02), False)
    below = agreement(CASE.assembly, measured(0.51, 0.6), fe)
    assert below.difference == pytest.approx(0.5 / 0.51 - 1.0)
    assert spread(CaseResults(CASE, [fe, measured(0.51, 0.6)])) == pytest.approx((0.02, 0.2))
    assert spread(CaseResults(CASE, [fe, measured(0.4, 0.55)])) == pytest.approx((0.0, 0.25))


def test_cost_of_limit_analysis_stands_for_the_value_and_for_the_whole_search():
    la = samples.solved(CASE, "la", 0.4, cpu=3.0, path={"cpu_seconds": [0.1, 0.2], "multiplier": [0.5, 0.4]})
    rows = [samples.solved(CASE, "fe", 0.5, cpu=1.0), la, measured(0.45, 0.55).model_copy(update={"cpu_seconds": 18.0})]
    found = paper.paper_comparison(ComparisonRun("a", "b", "c", [CaseResults(CASE, rows)]))
    assert found is not None
    assert found.ratio_ours == "20 : 60 : 360"
    assert found.ratio_to_value == "20 : 4.0 : 360"
    assert "0.360 to 0.440 (DE)" in found.experiment


def test_slopes_are_fitted_over_four_sizes_of_one_kind_of_wall_that_collapses():
    def run(sizes, finding=Finding.COLLAPSES, grow=0.0):
        items = []
        for count in sizes:
            wall = wall_case(stack(count) | {"height": 0.2 + grow * count})
            row = samples.solved(wall, "fe", 0.5, cpu=0.01 * count**2)
            items.append(CaseResults(wall, [row.model_copy(update={"finding": finding})]))
        return ComparisonRun("a", "b", "c", items)

    assert "fe 2.00 (stack, friction 0.65, 4 sizes)" in studies.cost_against_size(run((2, 4, 8, 16))).sentence
    assert "no slope" in studies.cost_against_size(run((2, 8, 16))).sentence
    assert studies.cost_against_size(run((2, 4, 8, 16), Finding.STANDS)) is None
    assert "no slope" in studies.cost_against_size(run((2, 4, 8, 16), grow=0.01)).sentence, "other blocks each time"


def test_a_chart_with_nothing_to_see_is_words():
    same = {"start_values": [0.5] * 12}
    row = samples.solved(CASE, "la", 0.5, details=same, path={"cpu_seconds": [0.01], "multiplier": [0.5]})
    found = curves.curves(CaseResults(CASE, [row]))
    assert [bool(chart) for _, chart in found] == [False, False]
    assert "each of 12 starts of the search leads to 0.50000" in found[0][0]
    assert "that of la reached 0.50000 after 10 ms" in found[1][0]


def test_ticks_of_a_narrow_axis_differ():
    axis = charts.Axis([0.5, 0.50016], 0.0, 100.0, log=False)
    texts = [axis.text(value) for value in axis.ticks]
    assert len(set(texts)) == len(texts) > 2
