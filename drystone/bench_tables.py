"""Tables of `drystone bench` that others publish: whether they can be joined to one's own.

A table is what its author says: it is compared with itself, the walls of the set and the rows beside it, and refused
where these contradict each other. That its answers were judged is not repeated.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from harness.engine.judge import COARSEST
from harness.model.errors import InputError
from harness.model.method import Finding

if TYPE_CHECKING:
    import pandas as pd

COLUMNS = (
    "set", "version", "wall", "blocks", "interfaces", "method", "finding", "status", "judge", "multiplier", "lower",
    "upper", "answered", "correct", "exact", "proved", "cpu_seconds", "wall_seconds", "peak_memory_bytes",
    "speed_seconds", "speed_spread", "processor",
)  # fmt: skip
"""Of the table, in their order."""
_FLAGS = ("answered", "correct", "exact", "proved")
_RENAME = "Leave the method out of one of the two, or give it another name in the table"
_PROVED = 1e-5
"""Relative distance below a proved minimum from which a state contradicts it: certificates leave 3e-6."""


def check_table(
    table: pd.DataFrame,
    name: str,
    sets: Collection[str],
    versions: Collection[int],
    walls: Collection[str],
    methods: Collection[str] = (),
    beside: Collection[pd.DataFrame] = (),
) -> None:
    """Refuse a table of others that cannot be joined to one of these sets, versions, walls and methods.

    Args:
        table: of others; name: of its file.
        sets, versions, walls: of one's own table.
        methods: whose rows one's own table has or will have.
        beside: tables that were checked and are joined as well.

    Raises:
        InputError: as `Bench.joined`; here rows of this table and those beside it are compared with each other.
    """
    import pandas as pd

    missing = [column for column in COLUMNS if column not in table.columns]
    if missing:
        raise InputError(f"it has no column {', '.join(missing)}", "Give a table of `drystone bench -o`", source=name)
    for column, own in (("set", sets), ("version", versions)):
        theirs = set(table[column])
        if set(own) != theirs:
            raise InputError(
                f"its {column} is {', '.join(map(str, theirs)) or 'missing'} and not {', '.join(map(str, own))}",
                "Join tables of one set and version",
                source=name,
            )
    for column, wrong in _wrong_cells(table, set(walls)):
        for _, row in table[wrong].head(1).iterrows():
            problem = (
                f"column {column} has a cell that cannot be in it: {row[column]} ({row['method']} on {row['wall']})"
            )
            raise InputError(problem, "Give a table of `drystone bench -o`", source=name)
    for method in sorted(set(methods) & set(table["method"])):
        raise InputError(f"it has rows of {method}, and so has the other table", _RENAME, source=name)
    refuse_contradictions(pd.concat([*beside, table]).astype(dict.fromkeys(_FLAGS, bool)), name)


def refuse_contradictions(table: pd.DataFrame, name: str) -> None:
    """Refuse a table whose rows contradict themselves or each other.

    Args:
        table: with the columns `COLUMNS`; name: of the file that is to blame.

    Raises:
        InputError: the first contradiction, with method and wall.
    """
    for problem, remedy in _contradictions(table):
        raise InputError(problem, remedy, source=name)


def _wrong_cells(table: pd.DataFrame, walls: set[str]) -> Iterator[tuple[str, Any]]:
    """Columns of a table of others, each with which of its cells cannot be in it: other walls, no flag, no number.

    Answers that are not correct may be below zero.
    """
    import pandas as pd

    yield "wall", ~table["wall"].isin(walls)
    yield "method", table["method"].isna()
    for column in _FLAGS:
        yield column, ~table[column].map(lambda cell: isinstance(cell, bool | np.bool_))
    answers, measures = (
        ("multiplier", "lower", "upper"),
        ("cpu_seconds", "wall_seconds", "speed_seconds", "speed_spread"),
    )
    for column in (*answers, *measures):
        numbers = pd.to_numeric(table[column], errors="coerce")
        below_zero = (numbers < 0.0) & (table["correct"].astype(bool) if column in answers else True)
        yield column, (numbers.isna() & table[column].notna()) | below_zero | np.isinf(numbers)
    for column in ("blocks", "interfaces", "peak_memory_bytes"):
        yield column, ~(pd.to_numeric(table[column], errors="coerce").between(0, 2**53))


_FOUND = [str(finding) for finding in Finding if finding is not Finding.NONE]
_WITH_MULTIPLIER = [str(finding) for finding in Finding if finding.has_multiplier]


def _unaccepted(rows: pd.DataFrame) -> Any:
    return ~rows["answered"] | (rows["judge"] != "accepted")


_NOT_SO: dict[str, Callable[[pd.DataFrame], Any]] = {
    "is correct and not answered, or the judge has not accepted it": lambda rows: rows["correct"] & _unaccepted(rows),
    "is answered with another status than ok": lambda rows: rows["answered"] & (rows["status"] != "ok"),
    "is answered in no CPU time": lambda rows: rows["answered"] & ~(rows["cpu_seconds"] > 0.0),
    "is an exact state without a multiplier": lambda rows: rows["exact"] & rows["multiplier"].isna(),
    "is proved and no exact state": lambda rows: rows["proved"] & ~rows["exact"],
    "is proved and not answered, or the judge has not accepted it": lambda rows: rows["proved"] & _unaccepted(rows),
    "is correct with a finding that is none": lambda rows: rows["correct"] & ~rows["finding"].isin(_FOUND),
    "is correct with a multiplier that its finding does not have, or without the one it has": lambda rows: (
        rows["correct"] & (rows["finding"].isin(_WITH_MULTIPLIER) != rows["multiplier"].notna())
    ),
    "has one end of a bracket": lambda rows: rows["lower"].isna() != rows["upper"].isna(),
    "has a bracket whose lower end is the higher": lambda rows: rows["lower"] > rows["upper"],
    "is correct with a multiplier outside its bracket": lambda rows: (
        rows["correct"]
        & (
            (rows["multiplier"] < rows["lower"] - COARSEST * rows["upper"].abs())
            | (rows["multiplier"] > rows["upper"] + COARSEST * rows["upper"].abs())
        )
    ),
}
"""What no row of a table can be, in words, and which rows are."""


def _contradictions(table: pd.DataFrame) -> Iterator[tuple[str, str]]:
    """What rows of a table say against themselves and each other, each with what would be right."""
    remedy = "Give a table as `drystone bench -o` wrote it"
    for words, found in _NOT_SO.items():
        for _, row in table[found(table)].head(1).iterrows():
            yield f"{row['method']} on {row['wall']} {words}", remedy
    for _, row in table[table.duplicated(["wall", "method"])].head(1).iterrows():
        yield f"{row['method']} on {row['wall']} has two rows", _RENAME
    for column in ("blocks", "interfaces"):
        counts = table.groupby("wall")[column].nunique()
        for wall in counts[counts > 1].index[:1]:
            yield f"{wall} has different numbers of {column}", "Join tables of the same walls"
    states = table[table["correct"] & table["exact"]]
    proved = states[states["proved"]].groupby("wall")["multiplier"].max()
    states = states.assign(least=states["wall"].map(proved))
    for _, row in states[states["multiplier"] < states["least"] * (1.0 - _PROVED)].head(1).iterrows():
        problem = f"{row['method']} has a state of {row['wall']} at {row['multiplier']:.9g}"
        yield f"{problem}, below {row['least']:.9g}, which a row calls the proved minimum", "One of them is wrong"
