"""How two sets of answers stand to each other: what the engine hands to those who show it."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from enum import StrEnum
from operator import attrgetter

from harness.model.table import TableColumn


class Kind(StrEnum):
    """How an answer stands to the one before."""

    WORSE = "worse"
    GONE = "gone"
    SLOWER = "slower"
    BETTER = "better"
    NEW = "new"
    SAME = "same"


@dataclass(frozen=True)
class Slower:
    """When a run counts as slower.

    Attributes:
        share: by how much of the old time at least; half as much again is beyond what runs of one code differ by on a
            machine that does nothing else.
        floor: CPU seconds by which it must be slower as well, since short runs consist of their start.
    """

    share: float = 0.5
    floor: float = 0.1


@dataclass(frozen=True)
class Row:
    """One case and method in both sets.

    Attributes:
        case, method: which.
        kind: how the answer stands to the one before.
        figures: the two values.
        old_seconds, new_seconds: CPU time, where it was measured.
        ratio: new time by old time, where the two may be compared.
    """

    case: str
    method: str
    kind: Kind
    figures: str
    old_seconds: float | None = None
    new_seconds: float | None = None
    ratio: float | None = None


@dataclass(frozen=True)
class Pairs:
    """Times of one method over the cases that both sets have.

    Attributes:
        method: which.
        number: of pairs.
        ratio: median of new time by old time.
        slower: in how many pairs the new run took longer.
    """

    method: str
    number: int
    ratio: float
    slower: int


DifferenceColumn = TableColumn[Row]

DIFFERENCE: tuple[DifferenceColumn, ...] = (
    DifferenceColumn("case", "string", "", "id of the wall", attrgetter("case")),
    DifferenceColumn("method", "string", "", "name of the method", attrgetter("method")),
    DifferenceColumn(
        "kind", "string", "", "how the answer stands to the one before", lambda row: str(row.kind), "stands"
    ),
    DifferenceColumn("figures", "string", "", "the values", attrgetter("figures"), "value"),
    DifferenceColumn("old_seconds", "Float64", "s", "processor time before", attrgetter("old_seconds"), "CPU before"),
    DifferenceColumn("new_seconds", "Float64", "s", "processor time now", attrgetter("new_seconds"), "CPU now"),
    DifferenceColumn(
        "ratio", "Float64", "1", "new time by old time, where the two may be compared", attrgetter("ratio")
    ),
)
"""Columns of two sets of answers, in the page and in JSON."""


@dataclass(frozen=True)
class Difference:
    """Two sets of answers compared.

    Attributes:
        old, new: their names.
        rows: what is worse first.
        pairs: times by method.
        not_run: how many answers of a baseline the new set does not have.
        remarks: what a reader has to know of the comparison itself.
        slower: when a run counted as slower.
    """

    old: str
    new: str
    rows: list[Row]
    pairs: list[Pairs]
    not_run: int
    remarks: list[str]
    slower: Slower

    @property
    def counts(self) -> dict[Kind, int]:
        """How many rows are of each kind, all kinds."""
        found = Counter(row.kind for row in self.rows)
        return {kind: found[kind] for kind in Kind}

    @property
    def passed(self) -> bool:
        """Whether nothing is worse, gone or slower."""
        return not any(self.counts[kind] for kind in (Kind.WORSE, Kind.GONE, Kind.SLOWER))
