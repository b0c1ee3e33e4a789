"""What the searches of all insertion orders found, and the answer where the time limit stopped them: no more than that.

Orders are searched side by side, all with the tuning that is tried first. Where the first order asks for another, the
others are searched again with it, so the answer is the one that a single process gives, to the bit.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import STOPPED, OutOfTime, best_so_far
from harness.model.method import Answer, Finding, Status, processes_allowed
from methods.de.holds.order_bracket import BracketSearch, OrderBracket
from methods.numerics.forks import in_forks

SEARCH_STOPPED = f"the search was {STOPPED}"
_BRACKET_MEANING = (
    "[multiplier held, multiplier moving], at the time limit: the sweep orders that were searched to the "
    "end, or the first, were held at or above the lower end and moved at or below the upper end"
)


def undecided(how: str = "") -> Answer:
    """Not even the dead load was held, or moved the wall; `how` tells what the wall was given, after a comma."""
    return Answer(
        Status.NOT_CONVERGED, Finding.NONE, f"whether the dead load is held was not decided{how}: {SEARCH_STOPPED}"
    )


def unmoved(stood: float, how: str = "") -> Answer:
    """The wall stands at a multiplier, and nothing moved it above; `how` as in `undecided`."""
    return Answer(
        Status.NOT_CONVERGED, Finding.NONE, f"stands at {stood:.6g}{how}; no motion was shown: {SEARCH_STOPPED}"
    )


@dataclass(eq=False)
class BracketState:
    """What the searches of a wall have found at any time.

    Attributes:
        orders: how many insertion orders are asked for.
        searches: every search that was begun, the one under way last.
        finished: the brackets of the orders that were searched to the end.
        ahead: by name of the order, what searches in other processes found that were not asked for here yet.
    """

    orders: int
    searches: list[BracketSearch] = field(default_factory=list)
    finished: list[OrderBracket] = field(default_factory=list)
    ahead: dict[str, _Findings] = field(default_factory=dict)

    def searched(self, search: BracketSearch, ask_multiplier: bool) -> OrderBracket:
        """Run a search whose findings are kept whatever stops it, or take those of one that was run ahead."""
        self.searches.append(search)
        findings = self.ahead.pop(search.found.order, None)
        return search.run(ask_multiplier) if findings is None else findings.taken_by(search)

    def search_ahead(self, searches: Sequence[BracketSearch], ask_multiplier: bool) -> None:
        """Run searches of one tuning side by side, in as many processes as the run may have; in one, leave them.

        Raises:
            OutOfTime: the time was over; what they had found is known as if it was found here.
        """
        processes = processes_allowed()
        if processes == 1 or len(searches) == 1:
            return
        self.ahead = {}

        def take(search: BracketSearch, findings: _Findings) -> None:
            self.ahead[search.found.order] = findings

        def keep() -> None:
            for search in searches:
                findings = self.ahead.get(search.found.order)
                if findings is not None:
                    self.searches.append(search)
                    found = findings.taken_by(search)
                    if not findings.stopped and found.shows(ask_multiplier):
                        self.finished.append(found)
            raise OutOfTime

        best_so_far(lambda: _searched_ahead(searches, ask_multiplier, processes, take), keep)

    def counted(self) -> list[BracketSearch]:
        """The searches of the orders that were searched to the end; without any, all of the first order."""
        return [search for search in self.searches if search.found in self.finished] or self.searches


@dataclass(frozen=True, eq=False)
class _RestState:
    """A state at rest whose contact forces (m, 3) [force] show that the wall bears this multiplier."""

    search: BracketSearch
    multiplier: float
    forces: FloatArray


def highest_shown(assembly: Assembly, searches: list[BracketSearch], tolerance: float) -> _RestState | None:
    """The highest state held whose contact forces are in balance as far as the judge asks; None if none is.

    Near collapse a state that is held may be followed further before its forces balance block by block; one below it,
    which came to rest sooner, then shows the lower end.

    Args:
        assembly: the wall; searches: of it.
        tolerance: what the judge lets be left out of balance on a block, as a share of what acts on it.
    """
    states = [(multiplier, k) for k, search in enumerate(searches) for multiplier, _ in search.states]
    for multiplier, k in sorted(states, key=lambda item: (-item[0], item[1])):
        search = searches[k]
        search.engine.restore(dict(search.states)[multiplier])
        search.engine.load(multiplier)
        forces = search.engine.contact_forces()
        left = _out_of_balance(assembly, forces, assembly.dead + multiplier * assembly.live)
        if float(left.max(initial=0.0)) <= tolerance:
            return _RestState(search, multiplier, forces)
    return None


def stopped_answer(assembly: Assembly, known: BracketState, tolerance: float, details: dict[str, Any]) -> Answer:
    """What was shown when the time was over.

    Args:
        assembly: the wall; known: what its searches found; tolerance: as for `highest_shown`; details: of the answer.
    """
    counted = known.counted()
    found = [search.found for search in counted]
    stood = highest_shown(assembly, counted, tolerance)
    if stood is None:
        answer = _without_rest(known)
    else:
        answer = _with_rest(assembly, known, found, stood)
        answer.forces, answer.forces_multiplier = stood.forces, stood.multiplier
        answer.path = stood.search.found.path
    answer.iterations = sum(search.engine.steps for search in known.searches)
    answer.details = details | {"stopped_by_limit": True}
    return answer


def _without_rest(known: BracketState) -> Answer:
    """Nothing is shown to bear even the dead load."""
    moved = [bracket for bracket in known.finished if bracket.held is None and bracket.moving is not None]
    if moved and len(moved) == len(known.finished):
        sentence = f"falls under its dead load: it moved at multiplier 0 in {_so_far(known)}; {SEARCH_STOPPED}"
        answer = Answer(Status.OK, Finding.FALLS, sentence, mechanism=moved[0].velocity)
        answer.flow = "approximate"
        return answer
    return undecided()


def _with_rest(assembly: Assembly, known: BracketState, found: list[OrderBracket], stood: _RestState) -> Answer:
    """A state at rest is shown; the upper end is that of the motions above it, if there are any."""
    if not assembly.has_live_load:
        return Answer(Status.OK, Finding.STANDS, f"the dead load is held in {_so_far(known)}; {SEARCH_STOPPED}")
    low = min([stood.multiplier, *(b.held for b in known.finished if b.held is not None)])
    moving = [b for b in found if b.moving is not None and b.moving > low]
    if not moving:
        return unmoved(stood.multiplier)
    best = (max if known.finished else min)(moving, key=lambda b: b.moving or 0.0)
    assert best.moving is not None
    middle = 0.0 if best.nothing else 0.5 * (low + best.moving)
    sentence = (
        f"collapses between {low:.6g} (held) and {best.moving:.6g} (moving) in {_so_far(known)}; {SEARCH_STOPPED}, "
        f"and the multiplier {middle:.6g} is only the middle of the bracket so far"
    )
    answer = Answer(
        Status.OK, Finding.COLLAPSES, sentence, multiplier=middle, bracket=(low, best.moving), mechanism=best.velocity
    )
    answer.bracket_meaning, answer.flow = _BRACKET_MEANING, "approximate"
    return answer


def _so_far(known: BracketState) -> str:
    """How many orders were searched, in words."""
    if known.finished:
        return f"{len(known.finished)} of {known.orders} sweep orders"
    return f"the first of {known.orders} sweep orders, not yet searched to its end"


@dataclass(frozen=True, eq=False)
class _Findings:
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


def _searched_ahead(
    searches: Sequence[BracketSearch],
    ask_multiplier: bool,
    processes: int,
    take: Callable[[BracketSearch, _Findings], None],
) -> None:
    """Run searches in forks of this process, and give each one's findings to `take` as they end.

    Raises:
        OutOfTime: the time was over; the findings until then were given.
    """
    calls = [partial(_findings, search, ask_multiplier) for search in searches]
    for number, findings in in_forks(calls, processes):
        take(searches[number], findings)


def _findings(search: BracketSearch, ask_multiplier: bool) -> _Findings:
    def to_its_end() -> bool:
        search.run(ask_multiplier)
        return False

    stopped = best_so_far(to_its_end, lambda: True)
    return _Findings(search.found, search.states, search.engine.steps, stopped)


def _out_of_balance(assembly: Assembly, forces: FloatArray, load: FloatArray) -> FloatArray:
    """(n_free,) largest force or moment left over on each free block, as a share of all that acts on it.

    Moments count divided by the radius of the block. A block on which nothing acts is in balance.

    Args:
        assembly: the wall.
        forces: (m, 3) contact forces (n1, n2, s) [force].
        load: (n, 3) loads on the blocks [force, force, moment].
    """
    left = (assembly.kinematic_matrix.T @ forces.ravel() + load[assembly.free].ravel()).reshape(-1, 3)
    left[:, 2] /= assembly.radius[assembly.free]
    acting = np.hypot(load[:, 0], load[:, 1]) + abs(load[:, 2]) / assembly.radius
    for side in (assembly.block_a, assembly.block_b):
        np.add.at(acting, side, abs(forces).sum(axis=1))
    own = acting[assembly.free]
    share: FloatArray = abs(left).max(axis=1) / np.where(own > 0.0, own, 1.0)
    return share
