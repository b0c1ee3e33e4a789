"""Numbers of the report against values worked out by hand: axes, arrows, speeds, counts, figures."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.result import Verdict
from reports.charts.charts import WIDTH, Axis, Chart, Plot, Series, thin
from reports.drawing.display_list import Arrows
from reports.figures.multipliers import multipliers_figure
from reports.geometry.shapes import moving
from reports.page.tables import findings
from tests.reports import samples


def test_an_axis_of_powers_has_no_tick_beyond_its_ends():
    axis = Axis([1.0, 40.0], 0.0, 100.0, log=True)
    assert (axis.low, axis.high) == pytest.approx((0.8, 50.0))
    assert axis.ticks == pytest.approx([1.0, 2.0, 5.0, 10.0, 20.0, 50.0])


def test_values_below_zero_keep_their_distance_on_an_axis():
    axis = Axis([-3.0, -1.0], 0.0, 100.0, log=False)
    assert (axis.low, axis.high) == pytest.approx((-3.12, -0.88)), ".06 of the distance at both ends"
    assert axis.place(-2.0) == pytest.approx(50.0)


def test_a_chart_ends_inside_its_picture():
    plot = Plot.of(Chart("t", "x", "y", [Series("a", [0.0, 10.0], [0.0, 1.0])]))
    assert 0.0 < plot.across.start < plot.across.end < WIDTH
    assert plot.across.end - plot.across.start > 0.5 * WIDTH


def test_a_thinned_path_keeps_about_as_many_points_as_it_may():
    x = [float(k) for k in range(900)]
    y = [float((7 * k) % 11) for k in range(900)]
    kept, _ = thin(x, y, 300)
    assert 200 < len(kept) <= 301


def test_the_head_of_an_arrow_is_four_fifths_as_wide_as_long():
    arrows = Arrows("force", np.array([[0.0, 0.0]]), np.array([[10.0, 0.0]]), np.array([5.0]))
    (shaft,), (head,) = arrows.outlines()
    assert shaft.tolist() == [[0.0, 0.0], [5.0, 0.0]]
    assert head.tolist() == [[10.0, 0.0], [5.0, 2.0], [5.0, -2.0]]


def test_a_block_that_turns_about_a_corner_of_its_own_moves_by_the_opposite_one():
    """A turn by w about the lower left corner (0, 0) moves (1, .5) by w (-.5, 1): the velocity of the middle fits."""
    wall = samples.block().assembly
    motion = np.zeros((3, 3))
    motion[2] = (-0.25, 0.5, 1.0)
    assert moving(wall, motion).tolist() == [False, False, True]
    # Beside a block whose corners are about as fast, one that moves by 1e-4 of that does not count as moving.
    motion[0] = (1.1e-3 * np.hypot(1.0, 0.5), 0.0, 0.0)
    assert moving(wall, motion).tolist() == [True, False, True]
    motion[0] = (0.9e-3 * np.hypot(1.0, 0.5), 0.0, 0.0)
    assert moving(wall, motion).tolist() == [False, False, True]


def test_references_that_are_met_are_counted():
    run = samples.typical()
    gated = [item for case in run.cases for result in case.results for item in result.comparisons if item.gate]
    assert [item.verdict for item in gated] == [Verdict.AGREES] * 2
    assert "Of 2 checked reference values, 2 are met" in findings(run)
    gated[0].verdict = Verdict.OUTSIDE_TOLERANCE
    assert "Of 2 checked reference values, 1 is met" in findings(run)


def marks_of(figure: Figure) -> dict[str, list[tuple[float, float]]]:
    """Where the marks of each method stand in the figure of multipliers, by its colour and marker."""
    (axes,) = figure.axes
    names = {
        (line.get_color(), line.get_marker()): str(line.get_label()) for line in axes.lines if not len(line.get_xdata())
    }
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in names.values()}
    for line in axes.lines:
        if len(line.get_xdata()) == 1:
            (x,), (y,) = np.atleast_1d(line.get_xdata()), np.atleast_1d(line.get_ydata())
            found[names[line.get_color(), line.get_marker()]].append((float(x), float(y)))
    return found


def test_the_figure_of_multipliers_marks_every_value_once_and_names_every_method():
    first, second = samples.bond("a"), samples.bond("b")
    missing = samples.solved(second, "fe", 0.0).model_copy(update={"multiplier": None})
    never = samples.solved(second, "de", 0.0).model_copy(update={"multiplier": None})
    run = ComparisonRun(
        "t",
        "",
        "",
        [
            CaseResults(first, [samples.solved(first, "fe", 0.5), samples.solved(first, "la", 0.4)]),
            CaseResults(second, [missing, samples.solved(second, "la", 0.3), never]),
        ],
    )
    marks = marks_of(multipliers_figure(run))
    assert set(marks) == {"fe", "la", "de"}
    assert marks["de"] == []
    assert [x for x, _ in marks["fe"]] == [0.5]
    assert [x for x, _ in marks["la"]] == [0.4, 0.3]
    assert [round(y) for _, y in marks["la"]] == [0, 1], "a row a wall"
