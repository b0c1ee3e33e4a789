"""A measured bracket that is wide is marked so in the result, and from there in every output."""

from __future__ import annotations

import pytest

from harness.engine.run import Limits
from harness.engine.sweep.expand import expand, sources_of
from harness.engine.sweep.quick import quick_study
from harness.engine.sweep.running import row_of
from harness.model import columns
from harness.model.comparison import CaseResults
from harness.model.method import Answer, Finding, Status
from harness.model.result import bracket_is_wide, result_of
from harness.model.result_texts import answer_text
from harness.model.table import types, values
from reports.labels.wall_summary import value_in_words
from reports.page.tables import run_row
from tests.reports import samples
from tests.walls import assembly, stack

STUDIED = sources_of(quick_study("slide", ["la"], {}, Limits(), []))


def result(low, high, flow="approximate", multiplier=None, finding=Finding.COLLAPSES):
    wall = assembly(stack(1))
    middle = 0.5 * (low + high) if multiplier is None else multiplier
    answer = Answer(Status.OK, finding, "", middle, (low, high), flow=flow)
    return result_of(answer, wall, case="made-up", method="de", family="de")


@pytest.mark.parametrize(
    ("found", "width", "wide"),
    [
        (result(0.445, 0.5), 0.11, True),
        (result(0.4949, 0.5), 0.0102, True),  # .5 %, as stated, of either end of the sum .9949 is .00497
        (result(0.4951, 0.5), 0.0098, False),
        (result(0.0, 0.5, multiplier=0.0), 1.0, True),
        (result(0.0, 1e-5, multiplier=0.0, finding=Finding.AT_LIMIT), None, False),  # statics shows that it is zero
        (result(0.1, 0.5, flow="non-associated"), None, False),  # a proved bound below a state that is exact
    ],
)
def test_a_measured_bracket_is_wide_beyond_the_stated_accuracy_in_results_as_in_studies(found, width, wide):
    assert found.bracket_width == (None if width is None else pytest.approx(width))
    assert found.bracket_wide is wide
    assert (found.width_in_words != "") is wide
    assert bracket_is_wide(found, found.traits) is wide
    (run,) = expand(quick_study("slide", ["la"], {}, Limits(), []), STUDIED)
    assert row_of(run, found)["bracket_wide"] is wide


def test_every_output_says_that_a_bracket_is_wide():
    found = result(0.445, 0.5)
    found.traits = found.traits.model_copy(update={"brackets": True})
    assert "11 % wide" in answer_text(found)
    assert "11 % wide" in value_in_words(found)
    assert "11 % wide" in run_row(0, 0, CaseResults(samples.bond(), [found])).cell("multiplier").text
    row = values(columns.RESULTS, columns.ResultRow(found))
    assert row["bracket_width"] == pytest.approx(0.11)
    assert row["bracket_wide"] is True
    assert {"bracket_width", "bracket_wide"} <= set(types(columns.RESULTS))
    assert found.summary()["bracket_wide"] is True
