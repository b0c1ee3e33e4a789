"""The load case or direction that governs a wall, with what an engineer asks of it: reactions and critical joints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from harness.model.comparison import CaseResults
from harness.model.envelope import EQUAL
from harness.model.joint_margins import JOINTS, JointColumn, JointRow, joint_rows
from harness.model.live_load import direction_in_words
from harness.model.method import Finding, Status
from harness.model.proof import least_known, proof_of
from harness.model.result import Result, plastic_and_residual_of
from harness.model.support_reactions import SupportReaction, out_of_balance, reactions_of
from harness.model.table import in_units
from reports.findings.strength import least_residual, least_safe
from reports.labels import labels, numbers

_CRITICAL = tuple(
    column
    for column in JOINTS
    if column.name not in ("interface", "joint", "utilisation", "eccentricity", "length", "thickness")
)
"""Columns of the most critical joints."""


@dataclass(frozen=True)
class Way:
    """One load case or direction of the live load.

    Attributes:
        name: in words.
        value: the least multiplier with its method, or what was found instead.
        proved: what is proved of it.
        governs: whether no other has a lower one, residual ones included where the joints have strength; of none while
            another has no accepted answer.
        residual: the least multiplier without that strength; empty of dry joints.
    """

    name: str
    value: str
    proved: str
    governs: bool
    residual: str = ""


@dataclass(frozen=True)
class Governing:
    """What governs one wall.

    Attributes:
        item: the load case with the lowest multiplier, residual or with strength of the joints.
        ways: all load cases.
        unanswered: names of those without an accepted answer, any of which may govern.
        shown: the state that is drawn and whose forces stand in the tables; None without one.
        reactions: of the supports in that state.
        balance: part of the loads that the reactions do not balance; None without a state.
        joints: the most critical ones of that state.
        joint_columns: of their table.
    """

    item: CaseResults
    ways: list[Way]
    unanswered: list[str]
    shown: Result | None
    reactions: list[SupportReaction]
    balance: float | None
    joints: list[JointRow]
    joint_columns: tuple[JointColumn, ...]

    @property
    def by_residual(self) -> bool:
        """Whether residual multipliers count for which load case governs."""
        return any(way.residual for way in self.ways)

    @property
    def strength_in_words(self) -> str:
        """What is counted of the strength of joints in the least multiplier of each load case; empty of dry joints."""
        breaks = self.item.case.assembly.breaks
        return (", as joints break" if breaks else ", with strength") if self.by_residual else ""


def governing(items: Sequence[CaseResults], joints: int = 8) -> Governing:
    """The load case that governs a wall.

    Args:
        items: its load cases, one or more.
        joints: number of most critical joints to list.
    """
    sizes = [_collapse(item) for item in items]
    known = [math.inf if size is None else size for size in sizes]
    lowest = min(known)
    item = items[known.index(lowest)]
    case, shown = item.case, _shown(item)
    sure = lowest < math.inf and None not in sizes
    listed = [] if shown is None else reactions_of(case, shown)
    balance = None
    if shown is not None and listed:
        balance = out_of_balance(case.assembly, listed, shown.forces_multiplier or 0.0)
    rows = joint_rows(case, shown)[:joints] if shown else []
    crushes = any(row.number("crushing_utilisation") is not None for row in rows)
    critical = [column for column in _CRITICAL if crushes or column.name != "crushing_utilisation"]
    return Governing(
        item=item,
        ways=[
            _way(each, governs=sure and size <= lowest * (1.0 + EQUAL)) for each, size in zip(items, known, strict=True)
        ],
        unanswered=[_name(each) for each, size in zip(items, sizes, strict=True) if size is None],
        shown=shown,
        reactions=listed,
        balance=balance,
        joints=rows,
        joint_columns=in_units(critical, case.wall.units.force, case.wall.units.length),
    )


def _collapse(item: CaseResults) -> float | None:
    """The multiplier by which a load case governs: with strength of joints or without, the lower.

    Infinite where nothing makes the wall collapse; None without an accepted answer.
    """
    if item.case.assembly.strong:
        found = least_safe(item)
        return None if found is None else found[0]
    least = least_known(item)
    if least is not None and least.multiplier is not None:
        return least.multiplier
    findings = {r.finding for r in item.results if r.status is Status.OK and r.judge.accepted is not False}
    if Finding.FALLS in findings:
        return 0.0
    return math.inf if findings & {Finding.UNBOUNDED, Finding.STANDS} else None


def _name(item: CaseResults) -> str:
    return item.case.load_case or direction_in_words(item.case)


def _way(item: CaseResults, *, governs: bool) -> Way:
    least = least_known(item)
    answers = dict.fromkeys(labels.FINDING[result.finding] for result in item.mains)
    value = ", ".join(answers) if least is None else f"{numbers.multiplier(least.multiplier)} ({least.method})"
    proved = "" if least is None else proof_of(item, least).label
    return Way(_name(item), value, proved, governs, _residual(item) if item.case.assembly.strong else "")


def _residual(item: CaseResults) -> str:
    """The least residual multiplier and who found it, or what was found instead."""
    found = least_residual(item)
    if found is None:
        return "no accepted answer"
    value, result = found
    pair = plastic_and_residual_of(result)
    if pair is not None and not pair[1].finding.has_multiplier:
        return f"{labels.FINDING[pair[1].finding]} ({result.method})"
    return f"{numbers.multiplier(value)} ({result.method})"


def _shown(item: CaseResults) -> Result | None:
    """The state that is drawn and whose reactions are shown: the least, or any accepted one with forces."""
    least = least_known(item)
    if least is not None and least.forces is not None and least.mechanism is not None:
        return least
    return next(
        (r for r in labels.in_order(item) if r.status is Status.OK and r.forces is not None and r.mechanism),
        None,
    )
