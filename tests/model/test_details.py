"""Requirement: details of an answer are read by type, and what is of another type counts as missing."""

from __future__ import annotations

import pytest

from harness.model.details import AnswerDetails, LastImprovement, SweepOrder

FULL = {
    "unknowns": 281,
    "stopped_by_limit": True,
    "associated": 0.58,
    "start_values": [0.6, 0.558],
    "improvements": [{"source": "first", "multiplier": 0.6}, {"source": "last", "multiplier": 0.558, "cpu_seconds": 1}],
    "certificate": {"bound": "1/2"},
    "peak": 0.57,
    "plateau": 0.565,
    "histories": [{"plateau": 0.565}, {"plateau": None}, {"plateau": 0.566}],
    "proved_least": True,
    "lower_bound": 0.55,
    "lowest_moving": 0.561,
    "missing_package": True,
    "orders": [{"order": "as drawn", "held": 0.4, "moving": 0.5}, {"order": "reversed", "held": 0.45, "moving": None}],
    "reporting_order": "reversed",
    "release": {"time_unit": "s", "frames": [[[0.0, 0.0, 0.0]], [[1.0, 0.0, 0.5]]]},
}


def test_details_are_read_by_type():
    read = AnswerDetails(FULL)
    assert read.unknowns == 281
    assert read.stopped_by_limit
    assert read.associated == 0.58
    assert read.start_values == [0.6, 0.558]
    assert read.last_improvement == LastImprovement("last", 0.558, 1.0)
    assert read.certificate == {"bound": "1/2"}
    assert (read.proved_least, read.lower_bound, read.lowest_moving) == (True, 0.55, 0.561)
    assert read.missing_package
    assert (read.peak, read.plateau, read.plateaus) == (0.57, 0.565, [0.565, 0.566])
    assert read.orders == [SweepOrder("as drawn", 0.4, 0.5), SweepOrder("reversed", 0.45, None)]
    assert read.reported_order == SweepOrder("reversed", 0.45, None)
    assert read.release is not None
    assert read.release.time_unit == "s"
    assert read.release.frames is not None
    assert read.release.frames.shape == (2, 1, 3)


@pytest.mark.parametrize(
    "data",
    [
        {},
        dict.fromkeys(FULL),
        {name: "words" for name in FULL if name not in ("unknowns", "start_values", "stopped_by_limit")},
    ],
)
def test_what_is_missing_or_of_another_type_is_not_there(data):
    read = AnswerDetails(data)
    assert (read.unknowns, read.stopped_by_limit, read.associated, read.start_values) == (None, False, None, [])
    assert (read.last_improvement, read.peak, read.plateau, read.plateaus) == (None,) * 3 + ([],)
    assert (read.proved_least, read.lower_bound, read.lowest_moving, read.missing_package) == (False, None, None, False)
    assert (read.orders, read.reported_order, read.release) == (None, SweepOrder(), None)


@pytest.mark.parametrize("value", [True, float("nan"), float("inf"), "0.5"])
def test_lower_bound_that_is_no_finite_number_is_not_there(value):
    assert AnswerDetails({"lower_bound": value}).lower_bound is None


def test_claims_are_handed_on_as_they_are_given():
    names = ("certificate", "without_strength", "live_forces", "dead_forces", "dilatant_mechanism", "moving_forces")
    for claim in ({"bound": "1/2"}, "words", [[1.0, 0.0, 0.0]], None):
        assert [getattr(AnswerDetails({name: claim}), name) for name in names] == [claim] * len(names)
        assert AnswerDetails({"dead_bar_forces": claim}).bar_tensions("dead_bar_forces") == claim
    assert AnswerDetails({"without_strength": None}).has_without_strength
    assert not AnswerDetails({}).has_without_strength


def test_quantity_of_a_reference_is_a_number_or_a_text():
    read = AnswerDetails({"spread": 0.01, "end": "plateau", "histories": [1.0]})
    assert [read.quantity(name) for name in ("spread", "end", "histories", "other")] == [0.01, "plateau", None, None]
