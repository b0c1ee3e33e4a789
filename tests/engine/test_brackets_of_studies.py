"""A wide bracket stays a bracket in the tables of a study: earliest and latest possible, and in no mean."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from harness.engine.sweep import statistics
from harness.engine.sweep.curve import curve_of
from harness.engine.sweep.frame import tidy
from harness.engine.sweep.study import Curve, Study
from harness.engine.sweep.summary import summarise

BY = ["case", "method"]


def table(values: list[float | tuple[float, float]], method: str = "de", **columns: list[float]) -> pd.DataFrame:
    rows = []
    for number, value in enumerate(values):
        low, high = value if isinstance(value, tuple) else (value, value)
        answer = {"case": "a", "method": method, "family": method, "status": "ok", "finding": "collapses"}
        bracket = {"bracket_low": low, "bracket_high": high, "bracket_wide": low < high}
        rows.append(answer | bracket | {"number": number, "multiplier": 0.5 * (low + high), "judge_accepted": True})
    return tidy(rows, []).assign(**columns)


MIXED: list[float | tuple[float, float]] = [0.5, 0.6, (0.455, 0.775)]


def test_a_wide_bracket_is_in_no_mean_and_quantiles_have_two_ends():
    (row,) = statistics.quantiles(table(MIXED), BY).to_dict("records")
    assert (row["runs"], row["answered"], row["brackets"]) == (3, 3, 1)
    assert row["mean"] == pytest.approx(0.55)
    assert row["deviation"] == pytest.approx(0.1 / np.sqrt(2.0))
    assert (row["q50_low"], row["q50_high"]) == pytest.approx((0.5, 0.6))  # of .455 .5 .6 and of .5 .6 .775
    assert (row["mean_low"], row["mean_high"]) == pytest.approx((1.555 / 3, 1.875 / 3))


def test_a_bracket_within_the_accuracy_of_its_method_is_a_value():
    narrow = table([0.5, 0.6])
    (row,) = statistics.quantiles(narrow, BY).to_dict("records")
    assert (row["brackets"], row["mean"], row["q50_low"], row["q50_high"]) == (0, 0.55, 0.55, 0.55)


def test_a_wall_whose_bracket_holds_the_multiplier_may_have_failed():
    (row,) = statistics.failure_probability(table(MIXED), BY, [0.55]).to_dict("records")
    assert (row["failed"], row["failed_at_most"]) == (1, 2)
    assert (row["probability"], row["probability_at_most"]) == pytest.approx((1 / 3, 2 / 3))
    (sure,) = statistics.failure_probability(table([0.5, 0.6, 0.7]), BY, [0.55]).to_dict("records")
    (perhaps,) = statistics.failure_probability(table([0.5, 0.5, 0.7]), BY, [0.55]).to_dict("records")
    assert (row["low"], row["high"]) == pytest.approx((sure["low"], perhaps["high"]))


def test_a_fragility_curve_with_a_wide_bracket_has_an_early_and_a_late_side_and_no_fit():
    curve = statistics.fragility(table([0.5, 0.6, 0.7, 0.8, (0.55, 0.75)]), BY).set_index("multiplier")
    assert curve["probability"].to_dict() == pytest.approx(
        {0.5: 0.2, 0.55: 0.2, 0.6: 0.4, 0.7: 0.6, 0.75: 0.8, 0.8: 1.0}
    )
    assert curve["probability_at_most"].to_dict() == pytest.approx(
        {0.5: 0.2, 0.55: 0.4, 0.6: 0.6, 0.7: 0.8, 0.75: 0.8, 0.8: 1.0}
    )
    assert curve["lognormal"].isna().all()
    sharp = statistics.fragility(table([0.5, 0.6, 0.7, 0.8, 0.65]), BY)
    assert sharp["lognormal"].notna().all()
    assert (sharp["probability"] == sharp["probability_at_most"]).all()


def test_the_study_counts_the_brackets_that_are_in_no_mean():
    study = Study.model_validate({"name": "x", "title": "x", "cases": ["a"], "methods": ["de"]})
    summary = summarise(study, table(MIXED))
    assert [said for said in summary.remarks if said.startswith("1 of 3 runs give a bracket wider than")]
    assert summary.by_method() == [{"de": "0.55 ± 0.071 (1 of 3 wide brackets)"}]
    assert summarise(study, table([(0.455, 0.775)])).by_method() == [{"de": "[0.455, 0.775]"}]
    assert not any("bracket" in said for said in summarise(study, table([0.5, 0.6])).remarks)


def two_families(fe: list[float], de: list[float | tuple[float, float]]) -> pd.DataFrame:
    size = [float(number) for number in range(len(fe))]
    return pd.concat([table([*fe], "fe", size=size), table(de, "de", size=size)], ignore_index=True)


def test_the_families_agree_differ_or_are_not_told_apart():
    rows = two_families([0.5, 0.5, 0.5, 0.5], [0.504, 0.6, (0.49, 0.56), (0.55, 0.6)])
    found = statistics.agreement(rows, ["case", "size"])
    assert found["agree"].tolist() == ["yes", "no", "open", "no"]
    assert found["least_percent"].tolist() == pytest.approx([0.8, 20.0, 0.0, 10.0])
    assert found["most_percent"].tolist() == pytest.approx([0.8, 20.0, 12.0, 20.0])
    assert found["de"].tolist()[1:3] == ["0.6", "[0.49, 0.56]"]


def test_a_family_without_an_answer_leaves_agreement_empty_and_a_second_method_of_a_family_is_not_asked():
    rows = two_families([0.5, 0.5], [0.5, 0.5])
    rows.loc[3, "status"] = "timeout"
    more = table([0.1, 0.1], "de-mujoco", size=[0.0, 1.0]).assign(family="de")
    found = statistics.agreement(pd.concat([rows, more], ignore_index=True), ["case", "size"])
    assert found["agree"].tolist() == ["yes", ""]
    assert statistics.agreement(table([0.5]), ["case"]).empty


def curve_rows(found: dict[float, list[float | tuple[float, float]]]) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for size, values in found.items():
        for value in values:
            low, high = value if isinstance(value, tuple) else (value, value)
            answer = {"size": size, "multiplier": 0.5 * (low + high), "method": "x"}
            rows.append(answer | {"bracket_low": low, "bracket_high": high, "bracket_wide": low < high})
    return rows


def drawn(found: dict[float, list[float | tuple[float, float]]], **curve: object) -> dict[str, object]:
    asked = Curve.model_validate({"across": "size"} | curve)
    study = Study(name="s", title="t", cases=["wall-21"], methods=["x"], curve=asked)
    return curve_of(study, curve_rows(found))


def test_a_curve_draws_a_wide_bracket_as_a_bar_and_its_sentence_gives_both_ends():
    curve = drawn({0.0: [1.0], 0.1: [0.8, (0.5, 0.7)], 0.2: [(0.4, 0.6)]})
    (line,) = curve["series"]  # type: ignore[misc]
    assert line["y"] == [1.0, 0.8, None]
    assert (line["low"], line["high"]) == ([1.0, 0.5, 0.4], [1.0, 0.8, 0.6])
    assert "x: between 0.4 and 0.6 at 0.2" in str(curve["sentence"])
    assert "2 walls gave a wide bracket and are in no mean drawn" in str(curve["sentence"])


def test_a_change_from_a_bracket_is_as_small_and_as_large_as_it_allows():
    curve = drawn({0.0: [(0.8, 1.0)], 0.1: [0.4]}, relative=True)
    (line,) = curve["series"]  # type: ignore[misc]
    assert line["y"] == [None, None]
    assert (line["low"][1], line["high"][1]) == pytest.approx((-60.0, -50.0))


def test_a_level_that_the_mean_alone_passes_is_given_with_its_uncertainty():
    said = str(drawn({0.0: [1.0, 1.0], 0.1: [0.7, 0.9]}, level=0.75)["sentence"])
    assert "0.75 not up to 0.1 by the mean, within its uncertainty from 0.083 to beyond 0.1" in said
    said = str(drawn({0.0: [1.0, 1.0], 0.1: [0.65, 0.85]}, level=0.8)["sentence"])
    assert "0.8 at about 0.08 by the mean, within its uncertainty from 0.057 to beyond 0.1" in said


def test_what_is_in_no_mean_is_told_in_the_singular_and_the_plural():
    one = str(drawn({0.0: [1.0], 0.1: [0.8, (0.5, 0.7)]})["sentence"])
    assert one.endswith("; 1 wall gave a wide bracket and is in no mean drawn.")
    two = str(drawn({0.0: [1.0, (0.5, 0.7)], 0.1: [0.8, (0.5, 0.7)]})["sentence"])
    assert two.endswith("; 2 walls gave a wide bracket and are in no mean drawn.")


@pytest.mark.parametrize("unit", [1.0, 8.0])
def test_a_change_in_percent_is_the_same_in_any_unit_of_load(unit: float):
    curve = drawn({0.0: [unit], 0.1: [0.9 * unit, (0.5 * unit, 0.7 * unit)]}, relative=True)
    (line,) = curve["series"]  # type: ignore[misc]
    assert line["y"] == pytest.approx([0.0, -10.0])
    assert (line["low"], line["high"]) == (pytest.approx([0.0, -50.0]), pytest.approx([0.0, -10.0]))
