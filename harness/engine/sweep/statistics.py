"""What a study says: quantiles over draws and seeds, probability of failure, fragility curves, sensitivities."""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from scipy import stats

from harness.model.method import Finding, Status

SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)
CONFIDENCE = 0.95
FEWEST = 5
"""Walls of a group from which a fragility curve is drawn."""
RESAMPLES = 400
"""Bootstrap samples of a fitted fragility curve; the ends of its band then scatter by about a tenth of its width."""


def answered(table: pd.DataFrame) -> pd.DataFrame:
    """The rows that say at which multiplier a wall collapses: ended well, and not rejected by the judge.

    A wall that falls under its dead load collapses at multiplier zero. What the judge can neither accept nor reject
    counts, as measurements on uneven blocks do, whose forces are not those of the wall.
    """
    good = (table["status"] == str(Status.OK)) & table["judge_accepted"].ne(False).fillna(True)
    falls = table["finding"] == str(Finding.FALLS)
    kept = table[good & (falls | table["multiplier"].notna())].copy()
    kept.loc[kept["finding"] == str(Finding.FALLS), "multiplier"] = 0.0
    return kept


def quantiles(table: pd.DataFrame, by: Sequence[str]) -> pd.DataFrame:
    """Number of walls, of those without an answer, mean, deviation and quantiles of the multiplier in each group."""
    values = answered(table).groupby(list(by), dropna=False)["multiplier"]
    found = pd.DataFrame({"answered": values.size(), "mean": values.mean(), "deviation": values.std(ddof=1)})
    for share in SHARES:
        found[f"q{100 * share:02.0f}"] = values.quantile(share)
    asked = table.groupby(list(by), dropna=False).size().rename("runs")
    return (
        found.join(asked, how="right")
        .assign(answered=lambda item: item["answered"].fillna(0).astype(int))
        .reset_index()
    )


def failure_probability(table: pd.DataFrame, by: Sequence[str], multipliers: Sequence[float]) -> pd.DataFrame:
    """Share of walls that collapse at or below a multiplier, with Wilson's score interval (1927) at 95 %."""
    rows = []
    for names, group in answered(table).groupby(list(by), dropna=False):
        for multiplier in multipliers:
            failed = int((group["multiplier"] <= multiplier).sum())
            interval = stats.binomtest(failed, len(group)).proportion_ci(CONFIDENCE, method="wilson")
            rows.append(
                dict(zip(by, names, strict=True))
                | {"multiplier": multiplier, "walls": len(group), "failed": failed, "probability": failed / len(group)}
                | {"low": float(interval.low), "high": float(interval.high)}
            )
    return pd.DataFrame(rows)


def fragility(table: pd.DataFrame, by: Sequence[str]) -> pd.DataFrame:
    """Probability of collapse against the multiplier, one curve a group: counted, and a lognormal fit with its band.

    The empirical distribution has the log-log transformed Greenwood interval (Kalbfleisch and Prentice 1980, as in
    `scipy.stats.ecdf`); the lognormal curve is fitted by maximum likelihood (Baker 2015, Earthquake Spectra 31) and its
    band comes from a bootstrap over walls with a fixed seed. Both at 95 %.
    """
    rows: list[dict[str, Any]] = []
    for names, group in answered(table).groupby(list(by), dropna=False):
        values = np.sort(group["multiplier"].to_numpy(float))
        if len(values) < FEWEST:
            continue
        place = dict(zip(by, names, strict=True))
        rows += _curve(place, values)
    return pd.DataFrame(rows)


def _curve(place: dict[str, Any], values: np.ndarray[Any, np.dtype[np.float64]]) -> list[dict[str, Any]]:
    found = stats.ecdf(values).cdf
    with warnings.catch_warnings(action="ignore"):  # beyond the last wall the interval is undefined, and stays empty
        interval: Any = found.confidence_interval(CONFIDENCE, method="log-log")
    fitted = np.full((3, len(found.quantiles)), np.nan)
    median = dispersion = float("nan")
    if values[0] > 0.0 and values[-1] > values[0]:
        logs = np.log(values)
        median, dispersion = float(np.exp(logs.mean())), float(logs.std())
        rng = np.random.default_rng(0)
        again = np.log(found.quantiles)[:, None]
        drawn = rng.choice(logs, (len(logs), RESAMPLES))
        spread = np.maximum(drawn.std(axis=0), 1e-12)
        curves = stats.norm.cdf((again - drawn.mean(axis=0)) / spread)
        tail = 0.5 * (1.0 - CONFIDENCE)
        fitted[0] = stats.norm.cdf((again[:, 0] - logs.mean()) / logs.std())
        fitted[1:] = np.quantile(curves, [tail, 1.0 - tail], axis=1)
    return [
        place
        | {"multiplier": float(at), "probability": float(counted), "low": float(low), "high": float(high)}
        | {"lognormal": float(curve), "lognormal_low": float(below), "lognormal_high": float(above)}
        | {"median": median, "dispersion": dispersion}
        for at, counted, low, high, curve, below, above in zip(
            found.quantiles,
            found.probabilities,
            interval.low.probabilities,
            interval.high.probabilities,
            *fitted,
            strict=True,
        )
    ]


def sensitivity(table: pd.DataFrame, quantities: Sequence[str], by: Sequence[str]) -> pd.DataFrame:
    """How much each drawn quantity matters: Borgonovo's delta (2007) and the first-order index, by SALib.

    Raises:
        ImportError: SALib is not installed.
    """
    from SALib.analyze import delta

    rows = []
    for names, group in answered(table).groupby(list(by), dropna=False):
        inputs, values = group[list(quantities)].to_numpy(float), group["multiplier"].to_numpy(float)
        if len(values) < 10 * len(quantities) or np.ptp(values) == 0.0:
            continue
        bounds = [[float(column.min()), float(column.max())] for column in inputs.T]
        problem = {"num_vars": len(quantities), "names": list(quantities), "bounds": bounds}
        form = warnings.formatwarning
        with warnings.catch_warnings(), contextlib.redirect_stderr(io.StringIO()):  # it tells of its bins
            found = delta.analyze(problem, inputs, values, seed=1)  # with seed 0 it draws at random
        warnings.formatwarning = form
        for k, quantity in enumerate(quantities):
            rows.append(
                dict(zip(by, names, strict=True))
                | {"quantity": quantity, "walls": len(values)}
                | {"delta": float(found["delta_raw"][k]), "delta_confidence": float(found["delta_raw_conf"][k])}
                | {"first_order": float(found["S1"][k]), "first_order_confidence": float(found["S1_conf"][k])}
            )
    return pd.DataFrame(rows)
