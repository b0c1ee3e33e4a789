"""Charts against their data: what a reader measures on the drawing is what was computed."""

from __future__ import annotations

import math
import re
from itertools import pairwise

import numpy as np
import pytest

from harness.model.comparison import CaseResults, ComparisonRun
from reports.charts import charts, dots, studies
from reports.page.study_page import StudyPage, render
from tests.reports import samples
from tests.reports.read_chart import Read
from tests.reports.test_study_page import page_of, tables_of, walls

NEAR = 0.01
"""Places are written to a tenth of a pixel on axes of some 250: of an axis of one to ten this is the rounding."""


@pytest.mark.parametrize(("log_x", "log_y"), [(False, False), (True, False), (False, True), (True, True)])
def test_points_bars_and_line_of_a_chart_are_read_back(log_x: bool, log_y: bool):
    x, y = [1.0, 2.0, 5.0, 8.0], [0.2, 0.5, 0.3, 0.9]
    low, high = [0.1, 0.4, 0.2, 0.7], [0.3, 0.6, 0.5, 1.0]
    chart = charts.Chart("t", "x", "y", [charts.Series("a", x, y, low, high)], log_x=log_x, log_y=log_y)
    read = Read(str(charts.svg(chart)), log_x=log_x, log_y=log_y)
    for points in (read.lines[0], read.marks):
        assert np.array(points) == pytest.approx(np.column_stack([x, y]), rel=NEAR, abs=NEAR)
    assert np.array(read.bars) == pytest.approx(np.column_stack([x, low, high]), rel=NEAR, abs=NEAR)


def test_a_performance_profile_rises_by_one_case_at_each_ratio():
    # FE takes 1, 4, 1 of the fastest's time and LA 2, 1, 1: FE has solved 2 of 3 at 1 and all at 4, LA all at 2.
    case = samples.bond()
    items = [
        CaseResults(case, [samples.solved(case, "fe", 0.5, cpu=first), samples.solved(case, "la", 0.5, cpu=second)])
        for first, second in ((1.0, 2.0), (4.0, 1.0), (1.0, 1.0))
    ]
    study = studies.performance_profile(ComparisonRun("", "", "", items))
    assert study is not None
    for line, last in zip(Read(str(study.charts[0][1]), log_x=True).lines, (4.0, 2.0), strict=True):
        corners = [(1.0, 1.0 / 3.0), (1.0, 2.0 / 3.0), (last, 1.0), (10.0, 1.0)]
        assert np.array(line) == pytest.approx(np.array(corners), rel=NEAR, abs=NEAR)


def test_a_fragility_curve_is_the_lognormal_of_its_walls_and_its_points_are_counted_shares():
    values = [0.2, 0.25, 0.4, 0.5, 0.8]
    rows = walls(values)
    read = Read(page_of(rows, tables_of(rows)).split("<h2>Fragility</h2>")[1])
    counted = [(value, (k + 1) / 5) for k, value in enumerate(values)]
    assert np.array(read.marks) == pytest.approx(np.array(counted), abs=NEAR)
    logs = np.log(values)
    fitted = [0.5 * (1.0 + math.erf((log - logs.mean()) / (math.sqrt(2.0) * logs.std()))) for log in logs]
    assert np.array(read.lines[0]) == pytest.approx(np.column_stack([values, fitted]), abs=NEAR)


def test_multipliers_over_the_grid_are_drawn_and_printed():
    rows = walls([0.31, 0.47, 0.52], friction=[0.3, 0.5, 0.9])
    page = render(StudyPage("A study", "", "c", "now", rows, ["friction"], tables_of(rows, "friction")))
    told = [(0.3, 0.31), (0.5, 0.47), (0.9, 0.52)]
    points = Read(page.split("<h2>Multiplier over friction</h2>")[1]).marks
    assert np.array(points) == pytest.approx(np.array(told), abs=NEAR)
    assert all(f"<td>{value:g}</td>" in page for pair in told for value in pair)


def test_bars_of_two_series_stand_beside_each_other_and_the_legend_shows_what_is_drawn():
    nothing = [math.nan, math.nan]
    series = [
        charts.Series("means", [1.0, 2.0], [3.0, 4.0], low=[2.0, 3.0], high=[4.0, 5.0]),
        charts.Series("brackets alone", [1.0, 2.0], nothing, low=[2.5, 3.5], high=[4.5, 5.5]),
    ]
    text = str(charts.svg(charts.Chart("both", "x", "y", series)))
    bars = re.findall(r'class="bar (s\d)" d="M([\d.]+) ([\d.]+)[Vv]', text)
    places = {name: [float(x) for other, x, _ in bars if other == name][:2] for name in ("s0", "s1")}
    for first, second in zip(places["s0"], places["s1"], strict=True):
        assert 5.0 < second - first < 9.0
    legends = text.count('class="mark s0"'), text.count('class="mark s1"')
    assert legends == (3, 0)  # two points and their sample; none where there are brackets alone
    assert text.count('class="line s1"') == 0


def test_a_legend_takes_nothing_from_the_height_of_the_plot():
    one, many = (
        charts.Plot.of(charts.Chart("t", "x", "y", [charts.Series(f"s{k}", [1.0, 2.0], [0.0, 1.0]) for k in range(n)]))
        for n in (1, 7)
    )
    assert (one.rows, many.rows) == (0, 3)
    assert many.height - many.top == one.height - one.top == pytest.approx(one.up.start - one.up.end + charts.BOTTOM)
    assert many.height - one.height == 3 * charts.ROW


def test_samples_of_a_legend_stand_between_the_names():
    series = [charts.Series(name, [1.0], [math.nan], [0.5], [0.7], line=False) for name in ("first", "second")]
    text = str(charts.svg(charts.Chart("t", "x", "y", series)))
    samples_at = [float(x) for x in re.findall(r'd="M(\d+) [\d.]+v10"', text)]
    names_at = [float(x) for x in re.findall(r'<text x="(\d+)" y="\d+">', text)]
    assert len(samples_at) == len(names_at) == 2
    assert samples_at[0] < names_at[0] < samples_at[1] < names_at[1]
    assert all(10.0 < name - sample < 30.0 for sample, name in zip(samples_at, names_at, strict=True))


def test_a_tick_at_the_rounded_end_of_an_axis_is_kept():
    assert charts.ticks(0.1 + 0.2, 0.8)[0] == pytest.approx(0.3)
    assert charts.ticks(0.2, 0.7 - 1e-16)[-1] == pytest.approx(0.7)


def test_the_band_of_a_dot_plot_lies_between_its_values():
    scale = dots.plain_scale([0.0, 1.0])
    text = str(dots.html(dots.DotPlot("t", scale, [], band=(0.25, 0.75))))
    found = re.search(r'class="within" x="([\d.]+)%" width="([\d.]+)%"', text)
    assert found is not None
    ends = [scale.place(0.25) or 0.0, scale.place(0.75) or 0.0]
    assert float(found[1]) == pytest.approx(ends[0], abs=0.01)
    assert float(found[1]) + float(found[2]) == pytest.approx(ends[1], abs=0.01)


def test_labels_of_a_dot_plot_have_room_for_their_letters():
    text = str(dots.html(dots.DotPlot("t", dots.plain_scale([0.59994, 0.60011]), [])))
    shown = [(float(x), name) for x, name in re.findall(r'left:([\d.]+)%">([^<]+)<', text)]
    assert len(shown) > 1
    for (left, first), (right, second) in pairwise(shown):
        assert 2.2 * (right - left) >= 6.5 * 0.5 * (len(first) + len(second)), "on an axis of 220 px"
