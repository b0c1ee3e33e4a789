"""Results of a study, in sentences: where multipliers lie, how likely collapse is, what matters most."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pandas as pd

from reports.labels import numbers

_MOST_GROUPS = 6
"""Groups described in sentences; more are read from charts and tables."""


def findings(tables: Mapping[str, pd.DataFrame], grid: Sequence[str]) -> list[str]:
    """The sentences of a study behind its answer.

    Args:
        tables: statistics by name, as `harness.engine.sweep.summary` makes them.
        grid: names of the quantities on the grid.
    """
    return [
        *_levels(tables["quantiles"], grid),
        *_failures(tables.get("failure"), grid),
        *_matters(tables, grid),
    ]


def answer(tables: Mapping[str, pd.DataFrame]) -> str:
    """On how many walls the families agree, differ, or cannot be separated; empty where it is known of none."""
    table = tables.get("agreement")
    if table is None or not len(table):
        return ""
    number = {word: int((table["agree"] == word).sum()) for word in ("yes", "no", "open", "")}
    said = f"The families agree within 1 % on {number['yes']} of {numbers.count(len(table), 'wall')}"
    if number["no"]:
        greatest = float(table.loc[table["agree"] == "no", "most_percent"].max())
        said += f" and differ on {number['no']}" + (f", by up to {greatest:.1f} %" if math.isfinite(greatest) else "")
    said += f"; on {number['open']} brackets do not decide" if number["open"] else ""
    return said + (f"; {number['']} lack the answer of a family." if number[""] else ".")


def _levels(spread: pd.DataFrame, grid: Sequence[str]) -> Iterator[str]:
    """How a multiplier goes along the one quantity that varies, or how it scatters."""
    solved = spread[spread["answered"] > 0]
    varied = [name for name in grid if solved[name].nunique() > 1]
    groups = list(solved.groupby(["case", "method"], sort=False))
    if len(groups) > _MOST_GROUPS:
        return
    for (case, method), group in groups:
        about = f"{method} on {case}" if solved["case"].nunique() > 1 else str(method)
        least, most = group.sort_values("mean_low").iloc[0], group.sort_values("mean_high").iloc[-1]
        brackets, answered = int(group["brackets"].sum()), int(group["answered"].sum())
        low, high = float(least["mean_low"]), float(most["mean_high"])
        mean = "mean multipliers" if (group["answered"] > 1).any() else "multipliers"
        if varied and least.name != most.name and low < high:
            said = (
                f"{mean} from {_mean_text(least)} ({_place(least, varied)}) to {_mean_text(most)} "
                f"({_place(most, varied)})"
            )
        elif varied and len(group) > 1:
            where = numbers.multiplier(low) if low == high else f"within {numbers.interval((low, high))}"
            said = f"{mean} {where} at all points of the grid"
        elif answered > 1 and brackets < answered:
            only = group.iloc[0]
            said = (
                f"mean multiplier {numbers.plain(only['mean'], 3)}, standard deviation "
                f"{numbers.plain(only['deviation'], 2)} over {answered - brackets} walls; nine of ten lie between "
                f"{numbers.plain(only['q05_low'], 3)} and {numbers.plain(only['q95_high'], 3)}"
            )
        else:
            said = f"{'mean ' if answered > 1 else ''}multiplier {_mean_text(most)}"
        left = "" if not brackets else f"; {brackets} of {answered} answers are wide brackets"
        yield f"{about}: {said}{left}."


def _mean_text(row: pd.Series[Any]) -> str:
    """The mean over a group, between two ends where wide brackets leave it."""
    low, high = float(row["mean_low"]), float(row["mean_high"])
    return numbers.multiplier(low) if low == high else numbers.interval((low, high))


def _place(row: pd.Series[Any], varied: Sequence[str]) -> str:
    return ", ".join(
        f"{name} {value:g}" if isinstance(value := row[name], float) else f"{name} {value}" for name in varied
    )


def _failures(table: pd.DataFrame | None, grid: Sequence[str]) -> Iterator[str]:
    """The probability of failure at each multiplier asked."""
    if table is None or len(table) > _MOST_GROUPS:
        return
    several = [name for name in ("case", "method", *grid) if table[name].nunique(dropna=False) > 1]
    for row in table.to_dict("records"):
        where = f" ({', '.join(str(row[name]) for name in several)})" if several else ""
        share = " to ".join(dict.fromkeys(f"{100 * row[name]:.0f}" for name in ("probability", "probability_at_most")))
        yield (
            f"At multiplier {row['multiplier']:g}{where}, {share} % of {row['walls']} walls "
            f"have collapsed; 95 % interval {100 * row['low']:.0f} to {100 * row['high']:.0f} %."
        )


def _matters(tables: Mapping[str, pd.DataFrame], grid: Sequence[str]) -> Iterator[str]:
    """Which of the drawn quantities matters most, where their intervals tell."""
    table = tables.get("sensitivity")
    if table is None or table["quantity"].nunique() < 2:
        return
    groups = list(table.groupby(["case", "method", *grid], sort=False, dropna=False))
    if len(groups) > _MOST_GROUPS:
        return
    for names, group in groups:
        first, second = (row for _, row in group.sort_values("delta", ascending=False).head(2).iterrows())
        about = f" by {names[1]}" + (f" on {names[0]}" if table["case"].nunique() > 1 else "")
        if first["delta"] - first["delta_confidence"] > second["delta"] + second["delta_confidence"]:
            yield f"Most depends on {first['quantity']} (Borgonovo's delta {first['delta']:.2f}){about}."
        else:
            yield (
                f"Whether {first['quantity']} or {second['quantity']} matters more, {first['walls']} "
                f"walls do not decide{about} (Borgonovo's delta {first['delta']:.2f} and {second['delta']:.2f})."
            )
