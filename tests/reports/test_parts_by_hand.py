"""Parts of pages and charts against values worked out by hand: each states what one line of the report has to do."""

from __future__ import annotations

import math
import re
from typing import Any
from xml.etree import ElementTree

import pandas as pd
import pytest

from harness.engine.baseline import Value
from harness.engine.diff import Answered, Answers, difference
from harness.model.columns import ComparedRow
from harness.model.comparison import CaseResults
from harness.model.method import Finding, Status
from harness.model.result import Comparison, Result, Verdict
from reports.charts import charts, curves
from reports.charts.dots import Above
from reports.drawing import looks
from reports.drawing.force_drawing import force_drawing
from reports.figures.profile import profile_figure
from reports.page import diff_page, glance, study_page, vectors
from reports.page.reference_tables import HELD_CELLS
from tests.reports import samples


def solved(**more: Any) -> Result:
    return samples.solved(samples.bond(), "la", 0.5).model_copy(update=more)


def test_a_logarithmic_axis_goes_from_four_fifths_of_the_least_to_five_fourths_of_the_greatest():
    axis = charts.Axis([1.0, 100.0], 20.0, 120.0, log=True)
    assert [axis.place(value) for value in (0.8, 10.0, 125.0)] == pytest.approx([20.0, 70.0, 120.0])
    assert axis.place(0.0) is None


def test_a_line_has_a_gap_where_there_is_no_value():
    series = charts.Series("a", [1.0, 2.0, 3.0, 4.0, 5.0], [1.0, 2.0, math.nan, 3.0, 4.0], marks=False)
    (path,) = re.findall(r'<path class="line[^>]* d="([^"]*)"', str(charts.svg(charts.Chart("t", "x", "y", [series]))))
    assert (path.count("M"), path.count("L")) == (2, 2)


def test_differences_stand_level_up_to_a_thousandth_and_by_powers_of_ten_beyond():
    """From -.1 % to 10 %: log10(1 + 1000 d) goes from -.30103 to 2.00432, and 0 % stands at 13.06 % of that."""
    axis = Above([0.0, 0.1])
    low, high = -math.log10(2.0), math.log10(101.0)
    assert [axis.place(value) for value in (-0.001, 0.1)] == pytest.approx([3.0, 97.0])
    assert axis.place(0.0) == pytest.approx(3.0 - 94.0 * low / (high - low))
    assert axis.ticks == [-0.001, 0.0, 0.001, 0.01, 0.1]


def test_a_performance_profile_ends_at_twice_the_greatest_ratio():
    table = pd.DataFrame({"method": ["la"], "correct": [True], "cpu_seconds": [1.0], "above_least": [0.0]})
    figure = profile_figure({"la": ([1.0, 4.0], [0.5, 1.0]), "fe": ([], [])}, table)
    ends = [line.get_xydata()[-1].tolist() for line in figure.axes[0].lines]
    assert ends == [[8.0, 1.0], [8.0, 0.0]]


def test_lines_of_a_file_are_as_many_times_as_wide_as_is_asked():
    drawn = [role for role in looks.LOOKS if not role.startswith(looks._PAPER_ONLY)]
    thin = [role for role in drawn if looks.LOOKS[role].width and looks.LOOKS[role].thin]
    assert len(thin) > 3
    for role in thin:
        (rule,) = re.findall(rf"svg \.{role} {{ ([^}}]*) }}", looks.css(3.0))
        assert f"stroke-width: {3.0 * looks.LOOKS[role].width:.4g}px;" in rule


@pytest.mark.parametrize(
    ("lines", "whole", "said"),
    [
        (0, 0, ""),
        (1, 0, "1 line more is"),
        (2, 0, "2 lines more are"),
        (0, 1, "1 chart more is"),
        (1, 1, "chart more are"),
    ],
)
def test_what_is_not_drawn_is_counted_in_the_right_number(lines: int, whole: int, said: str):
    left = study_page._left(lines, whole)
    assert said in left
    assert bool(left) is bool(said)


def test_groups_are_named_by_what_tells_them_apart_and_not_by_what_they_do_not_have():
    table = pd.DataFrame({"method": ["fe", "fe", "la"], "friction": [0.5, 0.75, math.nan]})
    names = [name for name, _ in study_page._groups(table, ["method", "friction"])]
    assert names == ["fe, friction 0.5", "fe, friction 0.75", "la"]


def test_a_file_is_higher_by_one_line_for_each_line_of_its_heading():
    case = samples.bond(title="A wall")
    drawing = force_drawing(case, samples.solved(case, "la", 0.5))
    boxes = []
    for said in ("", "said"):
        root = ElementTree.fromstring(vectors.headed(case, drawing, said))
        boxes.append([float(x) for x in root.attrib["viewBox"].split()])
    assert boxes[1][3] - boxes[0][3] == vectors.LINE
    assert boxes[0][1] - boxes[1][1] == vectors.LINE
    assert drawing.frame.box[1] - boxes[0][1] == 2 * vectors.LINE  # title and friction


def test_words_that_just_fit_stay_on_a_line():
    width = 10.1 * 0.55 * vectors.LETTERS
    assert vectors._broken("12345 7890 12345 78901", width) == ["12345 7890", "12345", "78901"]


def test_how_far_the_least_state_lies_below_the_others_is_told_only_where_it_does():
    case = samples.bond()
    least, same, above = (samples.solved(case, name, value) for name, value in (("la", 0.5), ("fe", 0.5), ("de", 0.75)))
    item = CaseResults(case, [least, same, above])
    assert glance._below(item, least, [least, same]) == ""
    assert glance._below(item, least, [least, above]).startswith(", 0.25 lower (")


def test_load_steps_between_the_ends_of_the_bracket_are_undecided():
    result = solved(
        path={"multiplier": [0.3, 0.5, 0.4], "residual": [0.0, 0.0, 0.0]},
        details={"orders": [{"order": "a", "held": 0.35, "moving": 0.45}], "reporting_order": "a"},
    )
    names = re.findall(r">(held|moving|undecided)<", str(curves._holds(result)[1]))
    assert names == ["held", "moving", "undecided"]
    open_end = result.model_copy(update={"details": {}})
    assert re.findall(r">(held|moving|undecided)<", str(curves._holds(open_end)[1])) == []  # one series has no legend


@pytest.mark.parametrize(("apart", "same"), [(0.5, True), (2.0, False)])
def test_starts_lead_to_one_state_within_a_relative_difference(apart: float, same: bool):
    said, chart = curves._starts(solved(details={"start_values": [100.0, 100.0 * (1.0 + apart * curves.SAME)]}))
    assert ("each of 2 starts" in said) is same
    assert bool(chart) is not same


@pytest.mark.parametrize(("quantity", "expected", "text"), [("blocks", 21.0, "21"), ("multiplier", 0.425, "0.425")])
def test_counts_are_whole_and_no_other_quantity_is_rounded_to_a_whole_number(quantity: str, expected: float, text: str):
    compared = Comparison(
        reference="r", quantity=quantity, value=expected, expected=expected, tolerance=1e-9, gate=True,
        verdict=Verdict.AGREES, sentence="",
    )  # fmt: skip
    assert HELD_CELLS["expected"](ComparedRow(solved(), compared, None)).text.startswith(text)
    in_words = compared.model_copy(update={"quantity": "blocks", "expected": "many"})
    assert HELD_CELLS["expected"](ComparedRow(solved(), in_words, None)).text == "many"


def test_what_changed_stands_in_the_table_and_what_did_not_is_folded_away():
    def answers(**values: float) -> Answers:
        found = {
            name: Value(status=Status.OK, finding=Finding.COLLAPSES, multiplier=value) for name, value in values.items()
        }
        return Answers("made up", {(name, "la"): Answered(value, True) for name, value in found.items()})

    page = diff_page.render(difference(answers(moved=0.5, kept=0.25), answers(moved=0.625, kept=0.25)))
    shown, folded = page.split("<h2>What changed</h2>")[1].split("<details>")
    assert ("moved" in shown, "kept" in shown) == (True, False)
    assert "<summary>1 answer the same</summary>" in folded
    assert ("moved" in folded.split("</details>")[0], "kept" in folded) == (False, True)
