"""A study hands collapse states to its neighbours: a mechanism found at one friction is tried at the next.

A search for the least state may miss at one point of a study what it finds at another. Mechanisms depend on the joints
that move, not on friction, so each run takes up those of its neighbours, on its own wall and by its own forces; only a
state that the method finds there, and the judge accepts, counts. Every round uses what was known at the end of the one
before, in the order of the runs: the answers depend on the study alone, not on the number of workers.
"""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from harness.engine.run import Motion
from harness.engine.store import Store
from harness.engine.sweep.expand import SweepRun
from harness.engine.sweep.running import Row
from harness.model.assembly import Assembly, IntArray
from harness.model.details import AnswerDetails
from harness.model.method import Finding, Status
from harness.model.method_registry import load_method

Make = Callable[[Sequence[SweepRun]], list[Row]]
"""Makes runs, or finds them in the store, and gives their rows in any order."""

_DECIDED = {str(Finding.FALLS), str(Finding.STANDS)}
"""Findings that no mechanism of another wall can change."""
_NEAREST = 8
"""Walls of the same joints from which each takes states over, by the order of what varies."""
_ROUNDS = 6
"""After which no more is handed on; each carries a state one neighbourhood further."""
_LOWER = 1e-9
"""Relative difference from which a multiplier is lower, above what is left of rounding."""


@dataclass(eq=False)
class _Cell:
    """A run that takes part, with the row that stands for it and what it was handed."""

    run: SweepRun
    row: Row
    assembly: Assembly
    alone: float = field(init=False)
    near: list[_Cell] = field(default_factory=list)
    motion: Motion | None = None
    handed: set[str] = field(default_factory=set)
    failure: str = ""

    def __post_init__(self) -> None:
        self.alone = self.multiplier
        self.row = self.row | {"from_neighbour": False}

    @property
    def multiplier(self) -> float:
        """Of an accepted collapse; infinite where none is known."""
        return _multiplier(self.row)

    def look_up(self, store: Store) -> None:
        """Take the motion of the joints in the mechanism of the row from the store."""
        kept = store.get(str(self.row["key"])) if np.isfinite(self.multiplier) else None
        if kept is not None and kept[0].mechanism is not None:
            self.motion = Motion.of(str(self.row["key"]), self.assembly, kept[0].mechanism)

    def asks(self) -> SweepRun | None:
        """The run that takes up what neighbours know and this one was not handed yet; None where there is nothing."""
        fresh = {near.motion.key: near.motion for near in self.near if near.motion is not None}
        fresh = {key: motion for key, motion in fresh.items() if key not in self.handed}
        self.handed.update(fresh)
        return replace(self.run, given=tuple(fresh.values())) if fresh else None

    def takes(self, row: Row, failure: str) -> bool:
        """Whether a row is a lower state, which then stands for the run; its cost counts in any case.

        Args:
            row: of a run with what neighbours found.
            failure: why it did not try all of that; then it is not known whether some of it leads lower.
        """
        spent = {name: _sum(self.row[name], row[name]) for name in ("cpu_seconds", "wall_seconds")}
        found = _multiplier(row)
        better = found < self.multiplier - _LOWER * abs(found)
        self.row = (self.row | row if better else self.row) | spent
        if better:
            self.row |= {"from_neighbour": True, "multiplier_alone": self.alone if np.isfinite(self.alone) else None}
        self.failure = self.failure or failure
        if self.failure:
            self.row |= {"neighbour_failure": self.failure, "from_neighbour": self.row["from_neighbour"] or None}
        return better


def handed_on(runs: Sequence[SweepRun], rows: Iterable[Row], store: Store, make: Make) -> list[Row]:
    """The rows of a study after each run has taken up what its neighbours found, round after round until none falls.

    Args:
        runs: of the study, each made by itself.
        rows: of these, in any order.
        store: with their results.
        make: makes the runs that take up motions.

    Returns:
        one row a run; where a state was taken over its `multiplier_alone` is what the run found by itself; where a run
        ended before it had tried all that neighbours found its `neighbour_failure` says why.
    """
    by_number = {int(row["number"]): row for row in rows}
    cells = list(_cells(runs, by_number))
    changed = cells
    for _ in range(_ROUNDS):
        for cell in changed:
            cell.look_up(store)
        asked = {cell.run.number: (cell, run) for cell in cells if (run := cell.asks()) is not None}
        if not asked:
            break
        ended = {int(row["number"]): row for row in make([run for _, run in asked.values()])}
        changed = [
            cell for number, (cell, _) in asked.items() if cell.takes(ended[number], _failure(ended[number], store))
        ]
    return [row for _, row in sorted((by_number | {cell.run.number: cell.row for cell in cells}).items())]


def _cells(runs: Sequence[SweepRun], rows: dict[int, Row]) -> Iterable[_Cell]:
    """The runs that may take states over, each with its neighbours."""
    follow = {name for name in {run.method for run in runs} if load_method(name).follows_motions}
    groups = defaultdict[Hashable, list[_Cell]](list)
    for run in runs:
        row = rows[run.number]
        if run.method in follow and row["finding"] not in _DECIDED and row["status"] != str(Status.REFUSED):
            assembly = run.variant.assembly
            settings = json.dumps(dict(run.settings), sort_keys=True)
            groups[(run.method, settings, *_joints(assembly))].append(_Cell(run, row, assembly))
    for group in groups.values():
        if len(group) > 1:
            places = _places([cell.run for cell in group])
            for number, cell in enumerate(group):
                away = ((places - places[number]) ** 2).sum(axis=1)
                order = [int(k) for k in np.argsort(away, kind="stable") if k != number]
                cell.near = [group[k] for k in order[:_NEAREST]]
            yield from group


def _joints(assembly: Assembly) -> tuple[Hashable, ...]:
    """Equal for walls with the same blocks and joints in the same order, whatever their shapes and frictions."""
    arrays = (assembly.fixed, assembly.block_a, assembly.block_b)
    return (assembly.block_ids, assembly.joint, *(array.tobytes() for array in arrays))


def _places(runs: Sequence[SweepRun]) -> IntArray:
    """(k, d) place of every run in the order of each quantity: by size, or by first appearance where it has none."""
    columns = [_order([run.variant.source.name for run in runs])]
    for name in runs[0].varied:
        columns.append(_order([run.varied.get(name) for run in runs]))
    return np.column_stack(columns)


def _order(values: Sequence[Any]) -> IntArray:
    if all(isinstance(value, int | float) for value in values):
        known = sorted(set(values))
    else:
        values = [json.dumps(value) for value in values]
        known = list(dict.fromkeys(values))
    place = {value: number for number, value in enumerate(known)}
    return np.array([place[value] for value in values], dtype=np.int64)


def _failure(row: Row, store: Store) -> str:
    """How a run ended that did not try all that it was given, with its sentence; empty where it did."""
    status = str(row["status"])
    if status in (str(Status.OK), str(Status.NOT_CONVERGED)):
        kept = store.get(str(row["key"]))
        if kept is None or not AnswerDetails(kept[0].details).stopped_by_limit:
            return ""
        status = "stopped"
    return f"{status.replace('_', ' ')}: {row['sentence']}"


def _multiplier(row: Row) -> float:
    good = row.get("status") == str(Status.OK) and Finding(str(row.get("finding"))).has_multiplier
    value = row.get("multiplier")
    return float(value) if good and value is not None and row.get("judge_accepted") is True else float("inf")


def _sum(first: float | None, second: float | None) -> float | None:
    return None if first is None else first + (second or 0.0)
