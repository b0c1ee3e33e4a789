"""What a search found: which state, by which source, when, and after how much work."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any

from methods.la.core.state import CollapseState
from methods.la.sources.budget import Work

LEAST_IMPROVEMENT = 1e-10
"""A scaled multiplier is lower if it is lower by this much: about ten times what linear programmes leave of it."""


@dataclass(frozen=True)
class _Improvement:
    """A state lower than all before it, its source, the CPU time of the process [s] and the work done until then."""

    state: CollapseState
    source: str
    seconds: float
    work: Work


@dataclass
class _Tried:
    """What one source led to: states, and the states that descents from them end at; CPU seconds and work it took."""

    source: str
    states: list[CollapseState] = field(default_factory=list)
    ends: list[CollapseState] = field(default_factory=list)
    seconds: float = 0.0
    work: Work = field(default_factory=Work)


class Record:
    """The states of one search, in the order found.

    Attributes:
        improvements: states that were lower than all before.
        tried: one entry a source that was tried.
    """

    def __init__(self) -> None:
        self.improvements: list[_Improvement] = []
        self.tried: list[_Tried] = []
        self.source = ""
        self.began = time.process_time()

    @property
    def least(self) -> float:
        """The least multiplier (scaled) of a collapse state so far; infinite before the first."""
        return self.improvements[-1].state.multiplier if self.improvements else float("inf")

    @property
    def known(self) -> bool:
        """Whether a state is known."""
        return bool(self.improvements)

    @property
    def states(self) -> list[CollapseState]:
        """All states that sources and descents led to."""
        return [state for tried in self.tried for state in (*tried.states, *tried.ends)]

    @property
    def ends(self) -> list[list[CollapseState]]:
        """What each source led to in the end: of one descent or more, or without any."""
        return [tried.ends or tried.states for tried in self.tried]

    def led_to_state(self, source: str) -> bool:
        """Whether a source of this name led to a state."""
        return any(tried.source == source and tried.states for tried in self.tried)

    def led_to_state_but(self, source: str) -> bool:
        """Whether a source of any other name led to a state."""
        return any(tried.source != source and tried.states for tried in self.tried)

    @contextmanager
    def trying(self, source: str, spent: Work) -> Iterator[_Tried]:
        """Note what is found and spent in this time as of a source; `spent` is the count that goes on."""
        before, began = replace(spent), time.process_time()
        self.source = source
        tried = _Tried(source)
        self.tried.append(tried)
        try:
            yield tried
        finally:
            tried.seconds, tried.work = time.process_time() - began, spent.since(before)

    def _by_name(self) -> dict[str, list[_Tried]]:
        """What was tried, of sources that stand at several places of the order together."""
        groups: dict[str, list[_Tried]] = {}
        for tried in self.tried:
            groups.setdefault(tried.source, []).append(tried)
        return groups

    def note(self, state: CollapseState, work: Work) -> None:
        """Keep a state if none known is lower."""
        if state.multiplier < self.least - LEAST_IMPROVEMENT:
            self.improvements.append(_Improvement(state, self.source, time.process_time(), replace(work)))

    def path(self, unit: float) -> dict[str, list[float]]:
        """When which multiplier was the least known: CPU seconds since the search began, multipliers."""
        return {
            "cpu_seconds": [found.seconds - self.began for found in self.improvements],
            "multiplier": [found.state.multiplier * unit for found in self.improvements],
        }

    def details(self, unit: float) -> dict[str, Any]:
        """What each source that was begun led to and took, and which of them found what was the least known."""
        return {
            "sources": [_row(name, group, unit) for name, group in self._by_name().items() if _begun(group)],
            "improvements": [
                {
                    "source": found.source,
                    "multiplier": found.state.multiplier * unit,
                    "cpu_seconds": found.seconds - self.began,
                    **_counts(found.work),
                }
                for found in self.improvements
            ],
        }


def _begun(group: list[_Tried]) -> bool:
    return any(tried.states or tried.work != Work() for tried in group)


def _row(name: str, group: list[_Tried], unit: float) -> dict[str, Any]:
    counts = [_counts(tried.work) for tried in group]
    return {
        "source": name,
        "states": sum(len(tried.states) for tried in group),
        "least": min((s.multiplier * unit for tried in group for s in tried.states + tried.ends), default=None),
        "cpu_seconds": sum(tried.seconds for tried in group),
        **{counted: sum(count[counted] for count in counts) for counted in counts[0]},
    }


def _counts(work: Work) -> dict[str, int]:
    return {"programmes": work.programmes, "newton_steps": work.newton_steps, "breakpoints": work.breakpoints}
