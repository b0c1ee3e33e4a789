"""Sentences of the report that a reader may quote: brackets, costs, slopes, searches."""

from __future__ import annotations

import pytest

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Finding
from reports.charts import charts, curves, families, studies
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


@pytest.mark.parametrize("load", [1e-3, 1.0, 1e3])
def test_a_plateau_is_drawn_to_three_times_the_displacement_at_which_it_begins_whatever_the_load(load: float):
    rise = [(0.1 * k, load * 0.1 * k) for k in range(11)]  # to 1 at a displacement of 1, then a creep of half a percent
    plateau = [(1.0 + 0.5 * k, load * (1.0 + 1e-4 * k)) for k in range(1, 51)]
    moved, loads = (list(column) for column in zip(*rise, *plateau, strict=True))
    path = {"live_displacement": moved, "multiplier": loads}
    row = samples.solved(CASE, "fe", loads[-1], path=path)
    ((caption, drawn),) = curves.curves(CaseResults(CASE, [row]))
    assert caption.endswith("; the plateau continues beyond the right edge.")
    assert max(drawn.chart.series[0].x) == pytest.approx(3.0)
    row = samples.solved(CASE, "fe", loads[10], path={name: values[:14] for name, values in path.items()})
    ((caption, drawn),) = curves.curves(CaseResults(CASE, [row]))
    assert "beyond" not in caption
    assert len(drawn.chart.series[0].x) == 14


def test_starts_of_a_search_are_counted_from_one_with_the_least_so_far_and_what_a_descent_found():
    def chart_of(value: float) -> charts.Chart:
        row = samples.solved(CASE, "la", value, details={"start_values": [0.6, 0.5, 0.7], "associated": 0.8})
        ((caption, drawn),) = curves.curves(CaseResults(CASE, [row]))
        assert caption == "la: the collapse state each start of the search leads to."
        return drawn.chart

    chart = chart_of(0.4)
    least, found = chart.series
    assert (least.x, least.y) == ([1.0, 2.0, 3.0], [0.6, 0.5, 0.5])
    assert (found.x, found.y) == ([1.0, 2.0, 3.0], [0.6, 0.5, 0.7])
    assert [value for _, value in chart.levels] == [0.8, 0.4]
    assert [value for _, value in chart_of(0.5).levels] == [0.8]


def test_walls_of_the_papers_application_carry_the_dead_part_and_the_multiplier():
    said = paper.printed().application
    case = samples.bond(said.rows[0].case)
    rows = [
        samples.solved(case, "la", 0.25),
        samples.solved(case, "de", 0.3, flow="approximate", bracket=(0.25, 0.35)),
    ]
    found = paper.paper_comparison(ComparisonRun("a", "b", "c", [CaseResults(case, rows)]))
    assert found is None, "neither the block nor the wall of the paper was run"
    (row,) = paper.applications(ComparisonRun("a", "b", "c", [CaseResults(case, rows)]))
    told = dict(zip(said.methods, (cell.text for cell in row.ours), strict=True))
    assert (told["la"], told["de"]) == ("0.350", "0.350 to 0.450")  # .1 of the load counts as dead


def test_brackets_of_a_family_of_walls_are_bars():
    items = []
    for number, friction in enumerate((0.4, 0.6, 0.8)):
        case = samples.bond(f"wall-{number}", friction=friction)
        low, high = friction - 0.1, friction + 0.2
        items.append(
            CaseResults(
                case,
                [
                    samples.solved(case, "la", friction),
                    samples.solved(case, "de", 0.5 * (low + high), bracket=(low, high), flow="approximate"),
                ],
            )
        )
    (study,) = families.families(ComparisonRun("", "", "", items))
    la, de = study.charts[0][1].chart.series
    assert (la.x, la.y, la.low) == ([0.4, 0.6, 0.8], [0.4, 0.6, 0.8], [])
    assert de.low == pytest.approx([0.3, 0.5, 0.7])
    assert de.high == pytest.approx([0.6, 0.8, 1.0])
