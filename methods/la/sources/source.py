"""Where collapse states come from: one protocol, which every way of the search meets."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState
from methods.la.sources.search import Search


class Source(Protocol):
    """A way to collapse states of a wall. What it was tuned with are fields of the object, so that others can be set.

    A source draws from the budget of the search, and stops where that ends or where what is known makes it needless.
    """

    @property
    def name(self) -> str:
        """What the source is called in results: words of the field."""

    def applies(self, problem: Problem) -> bool:
        """Whether it can lead to a state of this wall and is worth its work at this size."""

    def states(self, search: Search) -> Iterator[CollapseState]:
        """Exact collapse states, in the order found; those that are lower than all before are noted by the caller."""
