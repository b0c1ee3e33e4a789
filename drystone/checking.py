"""Methods held to what is known of walls: checked references and, in the full tier, certificates in fractions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from drystone.certificates import certificate_line, certificate_runs
from drystone.walls import Wall, checked_walls, library_wall, library_walls
from harness.engine import pipeline
from harness.engine.plan import check_methods
from harness.engine.run import Limits, Run
from harness.engine.store import Store
from harness.model.case import Case
from harness.model.result import Result

if TYPE_CHECKING:
    import pandas as pd

Tier = Literal["quick", "full"]
SECONDS = {"quick": 120.0, "full": 3600.0}
"""Limits of a run: the quick tier asks for nothing that takes longer than a minute."""


@dataclass(frozen=True)
class Check:
    """What was held to what. In a notebook it shows its table.

    Attributes:
        lines: one a checked reference or certificate: case, reference, method, value, relation, expected, tolerance,
            source, requirement, verdict, sentence.
    """

    lines: list[dict[str, Any]]

    @property
    def passed(self) -> bool:
        """Whether all agree that could be tested; one whose method needs a package that is not installed could not."""
        return all(line["verdict"] in ("agrees", "not_tested") for line in self.lines)

    def to_pandas(self) -> pd.DataFrame:
        """The lines as a table."""
        import pandas as pd

        return pd.DataFrame(self.lines).drop(columns="settings", errors="ignore")

    def _repr_html_(self) -> str:
        from reports.drawing.svg import html
        from reports.labels.numbers import met

        shown = self.to_pandas()[["case", "reference", "method", "value", "relation", "expected", "verdict"]]
        held = sum(line["verdict"] == "agrees" for line in self.lines)
        table = str(shown.to_html(index=False, na_rep="-", float_format="{:.6g}".format))
        return html(met(held, len(self.lines), "reference"), table=table)


def check(
    walls: Wall | Iterable[Wall] | None = None,
    *,
    tier: Tier = "quick",
    jobs: int = 1,
    store: str | Path | None = None,
    fresh: bool = False,
    progress: pipeline.Progress | None = None,
) -> Check:
    """Hold the methods to the checked references of walls.

    Args:
        walls: of the library, or with references of their own; None: all of the library.
        tier: "full" asks for the slow references too, and checks the certificates beside the cases in fractions.
        jobs: runs at a time.
        store: file in which results are kept and looked for; None: nowhere.
        fresh: run again what is in the store.
        progress: called after each run with the run, its result and whether it was stored.

    Raises:
        InputError: a method that a reference names does not exist, or a store that is damaged.

    >>> import drystone
    >>> drystone.check(drystone.library_wall("slide")).passed
    True
    """
    chosen = map(library_wall, library_walls()) if walls is None else checked_walls(walls)
    plan = planned([wall.case for wall in chosen], tier)
    with pipeline.opened_at(store) as opened:
        return held(plan, opened, jobs, fresh=fresh, progress=progress)


@dataclass(frozen=True)
class Plan:
    """The runs of a check: those that checked references need, and those that certificates are held to."""

    gated: list[Run]
    certified: list[Run]

    @property
    def runs(self) -> list[Run]:
        """All of them, the gated ones first."""
        return [*self.gated, *self.certified]


def held(
    plan: Plan, store: Store | None, jobs: int, *, fresh: bool = False, progress: pipeline.Progress | None = None
) -> Check:
    """What the runs of a plan find, or the store has of them, beside what is known; arguments as of `check`."""
    results = pipeline.execute(plan.runs, store, jobs, fresh=fresh, progress=progress)
    gated = _lines(plan.gated, results[: len(plan.gated)])
    rest = zip(plan.certified, results[len(plan.gated) :], strict=True)
    return Check(gated + [certificate_line(run, result) for run, result in rest])


def planned(cases: Sequence[Case], tier: Tier) -> Plan:
    """The runs of a check.

    Raises:
        InputError: a method that a reference names does not exist.
    """
    limits = Limits(seconds=SECONDS[tier])
    runs = [run for case in cases for run in _gated_runs(case, limits, tier)]
    check_methods(sorted({run.method for run in runs}), "applies_to of a checked reference")
    return Plan(runs, certificate_runs(cases, limits) if tier == "full" else [])


def _gated_runs(case: Case, limits: Limits, tier: str) -> list[Run]:
    """The runs that the checked references of a case need, and no others."""
    needed: dict[tuple[str, str], Run] = {}
    for item in case.file.references:
        if not item.gate or (item.tier == "full" and tier != "full"):
            continue
        for method in item.applies_to:
            place = (method, repr(sorted(item.settings.items())))
            earlier = needed.get(place)
            references = (*earlier.references, item) if earlier else (item,)
            needed[place] = Run(case, method, dict(item.settings), limits, references)
    return list(needed.values())


def _lines(runs: Sequence[Run], results: Sequence[Result]) -> list[dict[str, Any]]:
    """One row a checked reference: case, quantity, method, value, reference, tolerance, source, verdict, sentence."""
    rows = []
    for run, result in zip(runs, results, strict=True):
        for reference, comparison in zip(run.references, result.comparisons, strict=True):
            rows.append(
                {
                    "case": run.case.id,
                    "reference": reference.id,
                    "quantity": reference.quantity,
                    "method": run.method,
                    "settings": run.settings,
                    "value": comparison.value,
                    "relation": reference.relation,
                    "expected": comparison.expected,
                    "tolerance": reference.tolerance,
                    "type": str(reference.type),
                    "source": reference.source,
                    "requirement": reference.requirement,
                    "verdict": str(comparison.verdict),
                    "sentence": comparison.sentence,
                }
            )
    return rows
