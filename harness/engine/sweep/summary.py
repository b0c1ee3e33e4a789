"""What a study leaves besides its rows: tables of statistics, and the words and figures of its page."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from dataclasses import dataclass, field
from importlib.util import find_spec
from typing import Any

import pandas as pd

from harness.engine.sweep import statistics
from harness.engine.sweep.study import Study, Whole
from harness.model.errors import without_numbers
from harness.model.method import Status
from harness.model.method_registry import load_method, method_names

_NO_SALIB = "SALib is not installed, so no sensitivities are reported: pip install 'drystone[sensitivity]'"


@dataclass(frozen=True)
class GridSummary:
    """A study with its results.

    Attributes:
        study: what was asked.
        rows: one row a run.
        groups: the columns that tell one group of walls from another: case, method and the grid.
        tables: statistics by name, those that the study allows.
        remarks: sentences that a reader should see.
    """

    study: Study
    rows: pd.DataFrame
    groups: list[str]
    tables: dict[str, pd.DataFrame]
    remarks: list[str] = field(default_factory=list)

    def by_method(self) -> list[dict[str, str]]:
        """The multipliers as a table to read: one row a wall and point of the grid, one column a method.

        Returns:
            rows of words: a multiplier or a wide bracket, a mean with its deviation where seeds or draws make several,
            and how many of the runs are lost; `case` is left out where all are one.
        """
        found = self.tables["quantiles"]
        place = [name for name in self.groups if name != "method" and (name != "case" or found["case"].nunique() > 1)]
        said: dict[tuple[str, ...], dict[str, str]] = {}
        for group in found.to_dict("records"):
            here = tuple(f"{group[name]:.6g}" if isinstance(group[name], float) else str(group[name]) for name in place)
            said.setdefault(here, {})[str(group["method"])] = _words(group)
        methods = [name for name in self.study.methods if name in set(found["method"])]
        bounds = {name for name in methods if name in method_names() and load_method(name).traits.bounds_above}
        heads = {name: f"{name} (upper bound)" if name in bounds else name for name in methods}
        return [
            dict(zip(place, here, strict=True)) | {head: words.get(name, "-") for name, head in heads.items()}
            for here, words in said.items()
        ]


def _words(group: dict[Hashable, Any]) -> str:
    """The multipliers of a group in words."""
    runs, answered = int(group["runs"]), int(group["answered"])
    if not answered:
        return "no answer"
    brackets = int(group["brackets"])
    if answered == brackets:
        said = f"[{group['mean_low']:.6g}, {group['mean_high']:.6g}]"
    else:
        spread = f" ± {group['deviation']:.2g}" if answered - brackets > 1 else ""
        said = f"{group['mean']:.6g}{spread}"
    notes = [f"{brackets} of {runs} wide brackets"] if brackets and answered > 1 else []
    notes += [f"{runs - answered} of {runs} lost"] if answered < runs else []
    return f"{said} ({', '.join(notes)})" if notes else said


def grid_of(study: Study) -> list[str]:
    """The quantities of a study's grid, seeds left out: walls that differ by a seed alone belong to one group."""
    seeds = {name for name, axis in study.vary.items() if isinstance(axis, Whole)}
    names = [*study.vary, *(name for group in study.together for name in group)]
    return [name for name in names if name not in seeds]


def varied_of(study: Study) -> list[str]:
    """Every quantity that a study varies, in its order: the grid, what varies together, what is drawn."""
    return [*study.vary, *(name for group in study.together for name in group), *study.draw]


def _taken_over(rows: pd.DataFrame, place: list[str]) -> tuple[pd.DataFrame, list[str]]:
    """The runs that a state of a neighbour changed, with both multipliers and the change in percent; and sentences.

    Of a run that ended before it had tried all mechanisms of its neighbours nothing is said but that, and why.
    """
    changed = rows[rows["from_neighbour"].eq(True).fillna(False)]
    table = changed[[*place, "multiplier_alone", "multiplier"]].reset_index(drop=True)
    table["change_percent"] = 100.0 * (table["multiplier"] / table["multiplier_alone"] - 1.0)
    failures = rows["neighbour_failure"].dropna()
    unknown = _by_kind(failures, f"of {len(rows)} runs did not try all mechanisms of their neighbours,")
    if len(table):
        most = table["change_percent"].min()
        by = "" if pd.isna(most) else f", by up to {-most:.2g} %"
        taken = f"{len(table)} of {len(rows)} runs take a lower multiplier from the mechanism of a neighbour{by}"
        return table, [f"{taken}; forces of their own walls fit it.", *unknown]
    who = "No other run" if len(failures) else "No run"
    return table, [*unknown, f"{who} found a lower state from the mechanisms of its neighbours."]


def _unanswered(rows: pd.DataFrame) -> list[str]:
    """Why runs gave no answer."""
    lost = rows[rows["status"] != str(Status.OK)]
    return _by_kind(lost["status"].str.replace("_", " ") + ": " + lost["sentence"], f"of {len(rows)} runs")


def _by_kind(sentences: Iterable[str], runs: str, most: int = 6) -> list[str]:
    """Of sentences that differ in their numbers alone the first, and how many of the runs say so."""
    kinds: dict[str, list[str]] = {}
    for sentence in sentences:
        kinds.setdefault(without_numbers(sentence), []).append(sentence)
    said = [f"{len(alike)} {runs} {alike[0]}" for alike in kinds.values()]
    return said[:most] + [f"and {len(said) - most} reasons more, in the rows"] * (len(said) > most)


def summarise(study: Study, rows: pd.DataFrame) -> GridSummary:
    """The statistics that a study's rows allow."""
    groups = ["case", "method", *grid_of(study)]
    rows = rows.copy()
    tables = {"quantiles": statistics.quantiles(rows, groups)}
    remarks = []
    if study.neighbours:
        tables["neighbours"], sentences = _taken_over(rows, ["case", "method", *varied_of(study)])
        remarks.extend(sentences)
    counted = statistics.answered(rows)
    lost = len(rows) - len(counted)
    if lost:
        remarks.append(f"{lost} of {len(rows)} runs gave no multiplier, or a rejected one; they are in the rows.")
    remarks += _unanswered(rows)
    unjudged = int(counted["judge_accepted"].isna().sum())
    if unjudged:
        remarks.append(f"{unjudged} of {len(rows)} runs count although their answers are not judged.")
    brackets = int(counted["multiplier"].isna().sum())
    if brackets:
        remarks.append(
            f"{brackets} of {len(rows)} runs give a bracket wider than the stated accuracy of their method. They are "
            "in no mean and in no sensitivity; quantiles and probabilities have a lower and an upper value."
        )
    agreement = statistics.agreement(rows, ["case", *varied_of(study)])
    if len(agreement) > 1:
        tables["agreement"] = agreement
    many = int(tables["quantiles"]["answered"].max()) >= statistics.FEWEST if len(rows) else False
    if many:
        curves = statistics.fragility(rows, groups)
        tables["fragility"] = curves
    if study.multipliers and len(counted):
        tables["failure"] = statistics.failure_probability(rows, groups, study.multipliers)
    if study.draw:
        if find_spec("SALib") is None:
            remarks.append(_NO_SALIB)
        else:
            found = statistics.sensitivity(rows, list(study.draw), groups)
            if len(found):
                tables["sensitivity"] = found
    return GridSummary(study, rows, groups, tables, remarks)
