"""What came of a study, in sentences: where multipliers lie, how likely collapse is, what matters most."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pandas as pd

from reports import numbers

MOST_GROUPS = 6
"""Groups told in sentences; more are read from charts and tables."""


def findings(tables: Mapping[str, pd.DataFrame], grid: Sequence[str]) -> list[str]:
    """The sentences that open the page of a study.

    Args:
        tables: statistics by name, as `harness.engine.sweep.summary` makes them.
        grid: names of the quantities on the grid.
    """
    return [*_levels(tables["quantiles"], grid), *_failures(tables.get("failure"), grid), *_matters(tables, grid)]


def _levels(spread: pd.DataFrame, grid: Sequence[str]) -> Iterator[str]:
    """How a multiplier goes along the one quantity that varies, or how it scatters."""
    told = spread[spread["answered"] > 0]
    varied = [name for name in grid if told[name].nunique() > 1]
    groups = list(told.groupby(["case", "method"], sort=False))
    if len(groups) > MOST_GROUPS:
        return
    for (case, method), group in groups:
        about = f"{method} on {case}" if told["case"].nunique() > 1 else str(method)
        rising = group.sort_values("mean")
        least, most = rising.iloc[0], rising.iloc[-1]
        if varied and least["mean"] < most["mean"]:
            mean = "mean multipliers" if (group["answered"] > 1).any() else "multipliers"
            yield (
                f"{about}: {mean} from {numbers.multiplier(least['mean'])} ({_place(least, varied)}) "
                f"to {numbers.multiplier(most['mean'])} ({_place(most, varied)})."
            )
        elif group["answered"].iloc[0] > 1:
            only = group.iloc[0]
            yield (
                f"{about}: mean multiplier {numbers.plain(only['mean'], 3)}, standard deviation "
                f"{numbers.plain(only['deviation'], 2)} over {only['answered']} walls; nine of ten lie between "
                f"{numbers.plain(only['q05'], 3)} and {numbers.plain(only['q95'], 3)}."
            )
        else:
            yield f"{about}: multiplier {numbers.multiplier(most['mean'])}."


def _place(row: pd.Series[Any], varied: Sequence[str]) -> str:
    return ", ".join(
        f"{name} {value:g}" if isinstance(value := row[name], float) else f"{name} {value}" for name in varied
    )


def _failures(table: pd.DataFrame | None, grid: Sequence[str]) -> Iterator[str]:
    """The probability of failure at each multiplier asked."""
    if table is None or len(table) > MOST_GROUPS:
        return
    several = [name for name in ("case", "method", *grid) if table[name].nunique(dropna=False) > 1]
    for row in table.to_dict("records"):
        where = f" ({', '.join(str(row[name]) for name in several)})" if several else ""
        yield (
            f"At multiplier {row['multiplier']:g}{where}, {100 * row['probability']:.0f} % of {row['walls']} walls "
            f"have collapsed; 95 % interval {100 * row['low']:.0f} to {100 * row['high']:.0f} %."
        )


def _matters(tables: Mapping[str, pd.DataFrame], grid: Sequence[str]) -> Iterator[str]:
    """Which of the drawn quantities matters most, where their intervals tell."""
    table = tables.get("sensitivity")
    if table is None or table["quantity"].nunique() < 2:
        return
    groups = list(table.groupby(["case", "method", *grid], sort=False, dropna=False))
    if len(groups) > MOST_GROUPS:
        return
    for names, group in groups:
        first, second = (row for _, row in group.sort_values("delta", ascending=False).head(2).iterrows())
        about = f" by {names[1]}" + (f" on {names[0]}" if table["case"].nunique() > 1 else "")
        if first["delta"] - first["delta_confidence"] > second["delta"] + second["delta_confidence"]:
            yield f"Most depends on {first['quantity']} (Borgonovo's delta {first['delta']:.2f}){about}."
        else:
            yield (
                f"Whether {first['quantity']} or {second['quantity']} matters more, {first['walls']} "
                f"walls do not tell{about} (Borgonovo's delta {first['delta']:.2f} and {second['delta']:.2f})."
            )
