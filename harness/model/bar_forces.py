"""Forces of ties and props in an answer, as a table."""

from __future__ import annotations

from dataclasses import dataclass
from operator import attrgetter

from harness.model.bars import bar_tensions, state_of
from harness.model.case import Case
from harness.model.passive import FILL
from harness.model.result import Result
from harness.model.table import TableColumn


@dataclass(frozen=True)
class BarForce:
    """The force of one tie or prop.

    Attributes:
        bar: its name; kind: "tie", "prop" or "fill"; start, end: ids of the blocks it joins, "fill" of passive fill.
        tension: total, its prestress included; compression is negative [force].
        least, greatest: range of the tension, from prestress to yield force [force].
        state: as `harness.model.bars.state_of` says.
    """

    bar: str
    kind: str
    start: str
    end: str
    tension: float
    least: float
    greatest: float
    state: str


BARS: tuple[TableColumn[BarForce], ...] = (
    TableColumn("bar", "string", "", "name of the tie or prop, or of the side of a block in fill", attrgetter("bar")),
    TableColumn("kind", "string", "", "tie, prop or fill", attrgetter("kind")),
    TableColumn("from", "string", "", "id of the block at its one end", attrgetter("start")),
    TableColumn("to", "string", "", "id of the block at its other end", attrgetter("end")),
    TableColumn("tension", "Float64", "force", "tension, compression negative", attrgetter("tension")),
    TableColumn("least", "Float64", "force", "least tension, compression negative", attrgetter("least")),
    TableColumn("greatest", "Float64", "force", "greatest tension, compression negative", attrgetter("greatest")),
    TableColumn("state", "string", "", "yields, bears, slack or at its prestress", attrgetter("state")),
)
"""Columns of the forces of bars; their units are kinds, which `harness.model.table.in_units` replaces."""


def bar_forces_of(case: Case, result: Result) -> list[BarForce]:
    """The forces of the bars of an answer, at its `forces_multiplier`; none where it gives none of this wall."""
    bars, ids = case.assembly.bars, case.assembly.block_ids
    listed = bar_tensions(case.assembly, result)
    if listed is None:
        return []
    least, greatest = (bars.prestress + bars.least).tolist(), (bars.prestress + bars.greatest).tolist()
    return [
        BarForce(
            bars.names[k],
            bars.kinds[k],
            FILL if bars.kinds[k] == FILL else ids[bars.block_a[k]],
            ids[bars.block_b[k]],
            tension,
            least[k],
            greatest[k],
            state_of(bars.kinds[k], tension, least[k], greatest[k]),
        )
        for k, tension in enumerate(listed.tolist())
    ]
