"""The bracket of the least collapse multiplier: windows, and cases of contacts where they have no more to give."""

from __future__ import annotations

from collections.abc import Iterator

from harness.model.deadline import best_so_far
from methods.numerics.forks import ForkLost
from methods.proof.search.equations import Equations
from methods.proof.search.rate_bounds import RateProgramme
from methods.proof.search.side_by_side import windows_of
from methods.proof.search.slack_bounds import SlackProgramme
from methods.proof.search.window_search import Bracket, Certify, Stop, WindowSearch


def bracket(
    equations: Equations, upper: float, seconds: float, lower: float = 0.0, certify: Certify | None = None
) -> Bracket:
    """The bracket that this much time gives, or the time of the run where that is over before.

    Args:
        equations: the scaled wall, which stands under its dead load.
        upper: scaled multiplier of a collapse state, above zero.
        seconds: of the clock of the options; a window whose slacks are being bounded is finished.
        lower: a bound that is known.
        certify: asked after every window; the next begins at what it leaves of the bound.
    """
    until = equations.options.clock() + seconds
    search = WindowSearch(equations, SlackProgramme(equations), Bracket(lower, upper), until, certify)
    found = search.found
    found.stopped = Stop.TIME

    def windows() -> None:
        while not found.closed and equations.options.clock() < until and search.has_room():
            if not search.window():
                branched(search)
                break

    best_so_far(windows, lambda: None)  # What is known by then is the bracket.
    if found.closed:
        found.stopped = None
    elif found.stopped == Stop.TIME and not search.has_room():
        found.stopped = Stop.SPACE
    elif search.unbounded:
        found.stopped = Stop.SIZE
    return found


def branched(root: WindowSearch) -> None:
    """Raise the bound of a search that has no more to give: its states divided, and again, the lowest part first.

    Every state lies in one of both parts, so the least bound of both is one of the whole.
    """
    found, leaves, rates, options = root.found, [root], RateProgramme(root.equations), root.equations.options
    busy: dict[WindowSearch, int] = {}

    def in_time() -> bool:
        return not found.closed and options.clock() < root.until and root.has_room(len(busy) + 1)

    def lowest() -> Iterator[WindowSearch]:
        while in_time() and (waiting := [leaf for leaf in leaves if leaf not in busy and not leaf.found.closed]):
            leaf = min(waiting, key=lambda each: each.found.lower)
            busy[leaf] = leaf.found.iterations
            yield leaf

    def divided(leaf: WindowSearch) -> bool:
        at = leaf.division()
        if at is None:
            found.stopped = Stop.DECIDED
            return False
        leaves.remove(leaf)
        leaves.extend(leaf.parts(at, rates))
        found.branches += 1
        return True

    def windows() -> None:
        for leaf, more in windows_of(lowest(), options.jobs):
            found.iterations += leaf.found.iterations - busy.pop(leaf)
            if leaf.found.closed:
                leaf.found.lower = leaf.found.upper
            elif not more and options.clock() < root.until and not divided(leaf):
                return
            found.lower = max(found.lower, min(each.found.lower for each in leaves))

    if not in_time() or not divided(root):
        return
    try:
        while in_time() and found.stopped != Stop.DECIDED:
            windows()
    except ForkLost:
        found.stopped = Stop.LOST
