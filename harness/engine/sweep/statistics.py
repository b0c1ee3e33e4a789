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

from harness.model.assembly import FloatArray
from harness.model.method import Finding, Status
from harness.model.ranges import differences

_SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)
_CONFIDENCE = 0.95
FEWEST = 5
"""Walls of a group from which a fragility curve is drawn."""
_RESAMPLES = 400
"""Bootstrap samples of a fitted fragility curve; the ends of its band then scatter by about a tenth of its width."""


def answered(table: pd.DataFrame) -> pd.DataFrame:
    """The rows that say at which multiplier a wall collapses: ended well, and not rejected by the judge.

    A wall that falls under its dead load collapses at multiplier zero. What the judge can neither accept nor reject
    counts, as measurements on uneven blocks do, whose forces are not those of the wall.

    Returns:
        the rows, with the columns `earliest` and `latest`: between them the multiplier lies. They are one value, except
        where a measured bracket is wider than the accuracy of its method; `multiplier` is then missing.
    """
    good = (table["status"] == str(Status.OK)) & table["judge_accepted"].ne(False).fillna(True)
    falls = table["finding"] == str(Finding.FALLS)
    kept = table[good & (falls | table["multiplier"].notna())].copy()
    kept.loc[kept["finding"] == str(Finding.FALLS), "multiplier"] = 0.0
    wide = kept["bracket_wide"].eq(True).fillna(False).astype(bool)
    kept["earliest"] = kept["multiplier"].mask(wide, kept["bracket_low"])
    kept["latest"] = kept["multiplier"].mask(wide, kept["bracket_high"])
    kept["multiplier"] = kept["multiplier"].mask(wide)
    return kept


def quantiles(table: pd.DataFrame, by: Sequence[str]) -> pd.DataFrame:
    """Number of runs, of those with an answer and of wide brackets, mean, deviation and quantiles in each group.

    Mean and deviation are over multipliers without wide brackets; between `mean_low` and `mean_high` lies the mean over
    all. Each quantile has two columns, the least and the
    greatest that the brackets allow: `q50_low` is the median if all walls collapse at the lower ends.
    """
    groups = answered(table).groupby(list(by), dropna=False)
    values = groups["multiplier"]
    found = pd.DataFrame({"answered": groups.size(), "mean": values.mean(), "deviation": values.std(ddof=1)})
    found.insert(1, "brackets", found["answered"] - values.count())
    found["mean_low"], found["mean_high"] = groups["earliest"].mean(), groups["latest"].mean()
    for share in _SHARES:
        for end, column in (("low", "earliest"), ("high", "latest")):
            found[f"q{100 * share:02.0f}_{end}"] = groups[column].quantile(share)
    asked = table.groupby(list(by), dropna=False).size().rename("runs")
    counts = ["answered", "brackets"]
    return (
        found.join(asked, how="right").fillna(dict.fromkeys(counts, 0)).astype(dict.fromkeys(counts, int)).reset_index()
    )


def failure_probability(table: pd.DataFrame, by: Sequence[str], multipliers: Sequence[float]) -> pd.DataFrame:
    """Share of walls that collapse at or below a multiplier, with Wilson's score interval (1927) at 95 %.

    Walls whose wide bracket holds the multiplier may have failed: `failed` counts them as standing, `failed_at_most` as
    failed, and the interval reaches from the lower end of the one to the upper end of the other.
    """
    rows = []
    for names, group in answered(table).groupby(list(by), dropna=False):
        for multiplier in multipliers:
            surely, perhaps = (int((group[end] <= multiplier).sum()) for end in ("latest", "earliest"))
            intervals = [
                stats.binomtest(failed, len(group)).proportion_ci(_CONFIDENCE, method="wilson")
                for failed in (surely, perhaps)
            ]
            rows.append(
                dict(zip(by, names, strict=True))
                | {"multiplier": multiplier, "walls": len(group), "failed": surely, "failed_at_most": perhaps}
                | {"probability": surely / len(group), "probability_at_most": perhaps / len(group)}
                | {"low": float(intervals[0].low), "high": float(intervals[1].high)}
            )
    return pd.DataFrame(rows)


def agreement(table: pd.DataFrame, by: Sequence[str], within: float = 0.01) -> pd.DataFrame:
    """Where the main methods of the families agree: one row a wall, with the range of each method and how far they lie
    from each other.

    Args:
        table: the rows of a study.
        by: columns that tell one wall from another.
        within: relative difference up to which methods agree.

    Returns:
        the columns `by`, one of text a method, `least_percent` and `most_percent` (the difference between the highest
        and the lowest multiplier over the lowest, as small and as large as brackets allow) and `agree`: "yes", "no",
        "open" where brackets do not say, or "" where a family has no answer. No rows if there are fewer than two
        families.
    """
    mains = table[table["method"] == table["family"]]
    methods = list(dict.fromkeys(mains["method"]))
    if len(methods) < 2:
        return pd.DataFrame()
    rows = []
    for names, group in answered(mains).groupby(list(by), dropna=False, sort=False):
        # a wall that is asked twice, with other settings of a method, has no one answer
        ends = {row["method"]: (row["earliest"], row["latest"]) for row in group.to_dict("records")}
        said = {name: _range_text(*ends[name]) if name in ends else "" for name in methods}
        apart: dict[str, Any] = {"least_percent": np.nan, "most_percent": np.nan, "agree": ""}
        if len(ends) == len(methods) and len(group) == len(methods):
            least, most = differences(list(ends.values()))
            word = "yes" if most <= within else "no" if least > within else "open"
            apart = {"least_percent": 100.0 * least, "most_percent": 100.0 * most, "agree": word}
        rows.append(dict(zip(by, names, strict=True)) | said | apart)
    return pd.DataFrame(rows)


def _range_text(low: float, high: float) -> str:
    return f"{low:.6g}" if low == high else f"[{low:.6g}, {high:.6g}]"


def fragility(table: pd.DataFrame, by: Sequence[str]) -> pd.DataFrame:
    """Probability of collapse against the multiplier, one curve a group: counted, and a lognormal fit with its band.

    The empirical distribution has the log-log transformed Greenwood interval (Kalbfleisch and Prentice 1980, as in
    `scipy.stats.ecdf`); the lognormal curve is fitted by maximum likelihood (Baker 2015, Earthquake Spectra 31) and its
    band comes from a bootstrap over walls with a fixed seed. Both at 95 %. A group with wide brackets has no lognormal
    curve: `probability` counts their walls at the upper ends and `probability_at_most` at the lower ones.
    """
    rows: list[dict[str, Any]] = []
    for names, group in answered(table).groupby(list(by), dropna=False):
        if len(group) < FEWEST:
            continue
        place = dict(zip(by, names, strict=True))
        if group["multiplier"].isna().any():
            rows += _between(place, *(np.sort(group[end].to_numpy(float)) for end in ("earliest", "latest")))
        else:
            rows += _curve(place, np.sort(group["multiplier"].to_numpy(float)))
    return pd.DataFrame(rows)


def _between(place: dict[str, Any], earliest: FloatArray, latest: FloatArray) -> list[dict[str, Any]]:
    """The shares counted if walls with wide brackets collapse as early, and as late, as these allow; no fit."""
    early, late = ({row["multiplier"]: row for row in _curve(place, values)} for values in (earliest, latest))
    rows, surely, perhaps = [], dict.fromkeys(("probability", "low"), 0.0), dict.fromkeys(("probability", "high"), 0.0)
    for at in sorted({*early, *late}):
        surely, perhaps = late.get(at, surely), early.get(at, perhaps)
        rows.append(
            place
            | {"multiplier": at, "probability": surely["probability"], "probability_at_most": perhaps["probability"]}
            | {"low": surely["low"], "high": perhaps["high"]}
            | dict.fromkeys(("lognormal", "lognormal_low", "lognormal_high", "median", "dispersion"), np.nan)
        )
    return rows


def _curve(place: dict[str, Any], values: FloatArray) -> list[dict[str, Any]]:
    found = stats.ecdf(values).cdf
    with warnings.catch_warnings(action="ignore"):  # beyond the last wall the interval is undefined, and stays empty
        interval: Any = found.confidence_interval(_CONFIDENCE, method="log-log")
    fitted = np.full((3, len(found.quantiles)), np.nan)
    median = dispersion = float("nan")
    if values[0] > 0.0 and values[-1] > values[0]:
        logs = np.log(values)
        median, dispersion = float(np.exp(logs.mean())), float(logs.std())
        rng = np.random.default_rng(0)
        again = np.log(found.quantiles)[:, None]
        drawn = rng.choice(logs, (len(logs), _RESAMPLES))
        spread = np.maximum(drawn.std(axis=0), 1e-12)
        curves = stats.norm.cdf((again - drawn.mean(axis=0)) / spread)
        tail = 0.5 * (1.0 - _CONFIDENCE)
        fitted[0] = stats.norm.cdf((again[:, 0] - logs.mean()) / logs.std())
        fitted[1:] = np.quantile(curves, [tail, 1.0 - tail], axis=1)
    return [
        place
        | {"multiplier": float(at), "probability": float(counted), "probability_at_most": float(counted)}
        | {"low": float(low), "high": float(high)}
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
        group = group[group["multiplier"].notna()]  # a wide bracket is no value
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
