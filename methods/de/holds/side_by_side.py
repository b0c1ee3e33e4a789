"""Insertion orders searched side by side: none waits for another.

All begin with the tuning that is tried first. Where the first order asks for another, the others are searched again
with it, so the answer is the one that a single process gives, to the bit.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from harness.model.assembly import FloatArray
from harness.model.deadline import best_so_far
from methods.de.holds.order_bracket import BracketSearch, OrderBracket
from methods.numerics.forks import in_forks


@dataclass(frozen=True, eq=False)
class Findings:
    """What a search found in a process of its own.

    Attributes:
        found, states: as `BracketSearch` has them; steps: time steps of its engine.
        stopped: whether the time limit ended it.
    """

    found: OrderBracket
    states: list[tuple[float, FloatArray]]
    steps: int
    stopped: bool

    def taken_by(self, search: BracketSearch) -> OrderBracket:
        """Put the findings into a search that was not run here."""
        search.found, search.states, search.engine.steps = self.found, self.states, self.steps
        return self.found


def searched_ahead(
    searches: Sequence[BracketSearch],
    ask_multiplier: bool,
    processes: int,
    take: Callable[[BracketSearch, Findings], None],
) -> None:
    """Run searches in forks of this process, and give each one's findings to `take` as they end.

    Raises:
        OutOfTime: the time was over; the findings until then were given.
    """
    calls = [partial(_findings, search, ask_multiplier) for search in searches]
    for number, findings in in_forks(calls, processes):
        take(searches[number], findings)


def _findings(search: BracketSearch, ask_multiplier: bool) -> Findings:
    def to_its_end() -> bool:
        search.run(ask_multiplier)
        return False

    stopped = best_so_far(to_its_end, lambda: True)
    return Findings(search.found, search.states, search.engine.steps, stopped)
