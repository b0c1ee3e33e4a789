"""The sources of collapse states in the order in which a search tries them, and how it does."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

from harness.model.assembly import FloatArray
from methods.la.sources.arcs import FAR, ArcPaths
from methods.la.sources.dilatancy_continuation import DilatancyContinuation
from methods.la.sources.friction_continuation import FrictionContinuation
from methods.la.sources.mechanisms import GivenMechanisms, JoinedBlocks, SingleBlocks
from methods.la.sources.paths import AssociatedForces, CentralPath, OtherWeights, ReducedFriction, TrescaMechanisms
from methods.la.sources.search import Search, Source
from methods.la.sources.springs import AnalyticCentre, FromGravity, LowPrestress, ShiftedAssociated
from methods.numerics.failures import SingularMatrix

__all__ = ["SOURCES", "Source", "explore", "from_motions"]

SOURCES: tuple[Source, ...] = (
    ReducedFriction(factors=(0.3,), most=2000),
    ReducedFriction(factors=(0.6, 0.0), most=2000),
    ReducedFriction(factors=(0.6,), least=2001),
    ArcPaths(),
    DilatancyContinuation(),
    LowPrestress(least=2001),
    CentralPath(most=1000),
    FrictionContinuation(beside=FromGravity()),
    ReducedFriction(factors=(0.3, 0.0), least=2001, anyway=False),
    TrescaMechanisms(),
    CentralPath(anyway=False),
    LowPrestress(most=2000),
    SingleBlocks(),
    OtherWeights(),
    ArcPaths(near=FAR, far=FAR[1:], anyway=False),
    ShiftedAssociated(),
    AnalyticCentre(),
    AssociatedForces(),
    JoinedBlocks(),
)
"""The soonest state first, then lower ones; what is for walls on which nothing is known stands behind the others."""


def from_motions(motions: Sequence[FloatArray]) -> tuple[Source, ...]:
    """The sources of a search that takes up given motions of joints (m, 3) alone; all, where none moves anything."""
    given = GivenMechanisms(tuple(motions))
    return (given, JoinedBlocks()) if given.moves else SOURCES


def explore(search: Search, sources: Sequence[Source] = SOURCES) -> None:
    """Try the sources in order, and descend from the lowest states of each; the record of the search has what came.

    Raises:
        OutOfTime: the time given is over; the record has what was found so far.
    """
    if search.associated.outcome == "unknown":
        search.solve_associated()
    if search.associated.outcome == "unbounded":
        limits = search.budget.limits
        search.budget.limits = replace(limits, breakpoints=limits.unbounded_breakpoints)
    for source in sources:
        if not source.applies(search.problem):
            continue
        with search.record.trying(source.name, search.budget.spent) as tried:
            with suppress(SingularMatrix):  # It ends one source, not the search.
                for state in source.states(search):
                    search.note(state)
                    tried.states.append(state)
            for end in search.descend_from(tried.states):
                tried.ends.append(end)
