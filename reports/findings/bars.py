"""Ties and props of a wall: what is given, and their forces in every answer."""

from __future__ import annotations

from dataclasses import dataclass

from harness.model.bar_forces import bar_forces_of
from harness.model.case import Case
from harness.model.comparison import CaseResults
from reports.labels import numbers


@dataclass(frozen=True)
class BarRow:
    """The force of one bar by one method."""

    method: str
    bar: str
    joins: str
    force: str
    limits: str
    state: str


def bar_rows(item: CaseResults) -> list[BarRow]:
    """One row a method and bar; none where the wall has no ties and props, or no answer gives forces."""
    return [
        BarRow(
            result.method,
            bar.bar,
            f"{bar.start} to {bar.end}",
            numbers.given(bar.tension, 4),
            f"{numbers.given(bar.least, 4)} to {numbers.given(bar.greatest, 4)}",
            bar.state,
        )
        for result in item.results
        for bar in bar_forces_of(item.case, result)
    ]


def bars_text(case: Case) -> str:
    """How many ties, props and faces in passive fill there are, and their greatest forces; empty if there are none."""
    bars = case.assembly.bars
    said = []
    pulled, pushed = bars.prestress + bars.greatest, -(bars.prestress + bars.least)
    for kind, noun, strongest in (("tie", "tie", pulled), ("prop", "prop", pushed), ("fill", "passive face", pushed)):
        forces = [float(force) for force, own in zip(strongest, bars.kinds, strict=True) if own == kind]
        if forces:
            most = numbers.quantity(max(forces), case.wall.units.force, 4)
            limit = most if min(forces) == max(forces) else f"up to {most}"
            said.append(f"{numbers.count(len(forces), noun)}, yield force {limit}")
    return "; ".join(said)
