"""Statistics of studies against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from harness.engine.sweep import statistics
from harness.engine.sweep.frame import tidy
from harness.engine.sweep.study import Study
from harness.engine.sweep.summary import summarise
from tests.engine.studies import study


def made_up(values: list[float | None], **columns: Any) -> pd.DataFrame:
    rows = [
        {
            "number": number,
            "case": "a",
            "method": "la",
            "status": "ok" if value is not None else "timeout",
            "finding": "collapses" if value is not None else "none",
            "multiplier": value,
            "judge_accepted": True,
            "sentence": "found" if value is not None else "It was stopped at the limit of 2 s.",
        }
        for number, value in enumerate(values)
    ]
    return tidy(rows, []).assign(**columns)


def test_probability_of_failure_is_counted_with_wilsons_interval():
    table = made_up([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, None])
    found = statistics.failure_probability(table, ["case", "method"], [0.3]).iloc[0]
    assert (found["walls"], found["failed"], found["probability"]) == (10, 3, 0.3)
    z, n, p = 1.959963985, 10, 0.3
    centre, half = p + z * z / (2 * n), z * np.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    assert found["low"] == pytest.approx((centre - half) / (1 + z * z / n), abs=1e-8)
    assert found["high"] == pytest.approx((centre + half) / (1 + z * z / n), abs=1e-8)


def test_a_wall_that_falls_under_its_dead_load_has_failed_at_any_multiplier():
    table = made_up([0.5, 0.6])
    table.loc[0, ["finding", "multiplier"]] = ["falls", np.nan]
    assert statistics.failure_probability(table, ["case", "method"], [0.0])["probability"][0] == 0.5


def test_a_rejected_answer_counts_for_nothing():
    table = made_up([0.5, 0.6])
    table.loc[0, "judge_accepted"] = False
    assert statistics.quantiles(table, ["case", "method"])["answered"].tolist() == [1]


def test_what_the_judge_cannot_decide_counts_and_is_told():
    table = made_up([0.5, 0.6])
    table["judge_accepted"] = table["judge_accepted"].astype("boolean")
    table.loc[0, "judge_accepted"] = pd.NA
    assert statistics.quantiles(table, ["case", "method"])["answered"].tolist() == [2]
    study = Study.model_validate(
        {"name": "x", "title": "x", "cases": ["a"], "methods": ["la"], "vary": {"seed": {"seeds": 2}}}
    )
    assert [row for row in summarise(study, table).remarks if row.startswith("1 of 2 runs count although")]


def test_fragility_curve_of_a_lognormal_sample_is_that_lognormal_within_its_band():
    rng = np.random.default_rng(3)
    values = np.exp(np.log(0.5) + 0.2 * rng.standard_normal(300))
    curve = statistics.fragility(made_up(list(values)), ["case", "method"])
    # with 300 walls the deviations of median and dispersion are 0.2 / sqrt(300) = 0.012 and 0.008
    assert curve["median"][0] == pytest.approx(0.5, rel=0.04)
    assert curve["dispersion"][0] == pytest.approx(0.2, abs=0.025)
    true = stats.norm.cdf(np.log(curve["multiplier"] / 0.5) / 0.2)
    inside = (curve["lognormal_low"] <= true) & (true <= curve["lognormal_high"])
    assert inside.mean() > 0.8
    counted = curve["low"].notna() & curve["high"].notna()
    assert ((curve["low"] <= true) & (true <= curve["high"]))[counted].mean() > 0.8
    assert (curve["probability"].diff().dropna() > 0.0).all()


def test_sensitivity_names_the_quantity_that_matters():
    rng = np.random.default_rng(0)
    first, second = rng.random(200), rng.random(200)
    table = made_up(list(0.3 + first + 0.1 * second), first=first, second=second)
    found = statistics.sensitivity(table, ["first", "second"], ["case", "method"]).set_index("quantity")
    # variances 1 / 12 and 0.01 / 12: shares of 0.990 and 0.0099
    assert found["first_order"]["first"] == pytest.approx(0.99, abs=0.1)
    assert found["delta"]["first"] > 3.0 * found["delta"]["second"]


def test_lost_runs_are_counted_beside_the_mean_of_the_others():
    asked = study(methods=["la"], vary={"seed": {"seeds": 4}})
    assert summarise(asked, made_up([0.5, 0.6, None, None])).by_method() == [{"la": "0.55 ± 0.071 (2 of 4 lost)"}]
    assert summarise(asked, made_up([0.5, 0.6])).by_method() == [{"la": "0.55 ± 0.071"}]
    assert summarise(asked, made_up([None])).by_method() == [{"la": "no answer"}]
    above = made_up([0.5, 0.6]).assign(method="la-associated")
    said = summarise(study(methods=["la-associated"], vary={"seed": {"seeds": 4}}), above).by_method()
    assert said == [{"la-associated (upper bound)": "0.55 ± 0.071"}]


def test_walls_that_all_collapse_at_one_multiplier_have_no_lognormal_curve():
    curve = statistics.fragility(made_up([0.5] * 6), ["case", "method"])
    assert curve["probability"].tolist() == [1.0]
    assert curve[["lognormal", "lognormal_low", "lognormal_high", "median", "dispersion"]].isna().all(axis=None)


def test_the_band_of_a_lognormal_curve_is_as_wide_as_theory_says():
    # Of n walls the deviation of the fitted probability at the median is that of the mean: phi(0) / sqrt(n).
    rng = np.random.default_rng(5)
    curve = statistics.fragility(made_up(list(np.exp(0.3 * rng.standard_normal(300)))), ["case", "method"])
    middle = curve.iloc[(curve["lognormal"] - 0.5).abs().argmin()]
    half = 1.959964 * stats.norm.pdf(0.0) / np.sqrt(300)
    # ends from 400 samples scatter by a twentieth or so each
    assert 0.5 * (middle["lognormal_high"] - middle["lognormal_low"]) == pytest.approx(half, rel=0.1)


@pytest.mark.parametrize(("walls", "told"), [(19, False), pytest.param(20, True, marks=pytest.mark.slow)])
def test_ten_walls_a_quantity_tell_what_matters_and_fewer_do_not(walls: int, told: bool):
    rng = np.random.default_rng(1)
    first, second = rng.random(walls), rng.random(walls)
    found = statistics.sensitivity(
        made_up(list(0.3 + first), first=first, second=second), ["first", "second"], ["case"]
    )
    assert len(found) == (2 if told else 0)
