"""The bracket of the least collapse multiplier: windows, and cases of contacts where they have no more to give."""

from __future__ import annotations

import time

from harness.model.deadline import best_so_far
from methods.proof.search.equations import Equations
from methods.proof.search.rate_bounds import RateProgramme
from methods.proof.search.slack_bounds import SlackProgramme
from methods.proof.search.window_search import Bracket, Certify, Stop, WindowSearch


def bracket(
    equations: Equations, upper: float, seconds: float, lower: float = 0.0, certify: Certify | None = None
) -> Bracket:
    """The bracket that this much CPU time gives, or the time of the run where that is over before.

    Args:
        equations: the scaled wall, which stands under its dead load.
        upper: scaled multiplier of a collapse state, above zero.
        seconds: of CPU time; a window whose slacks are being bounded is finished.
        lower: a bound that is known.
        certify: asked after every window; the next begins at what it leaves of the bound.
    """
    until = time.process_time() + seconds
    search = WindowSearch(equations, SlackProgramme(equations), Bracket(lower, upper), until, certify)
    found = search.found
    found.stopped = Stop.TIME

    def windows() -> None:
        while not found.closed and time.process_time() < until:
            if not search.window():
                branched(search)
                break

    best_so_far(windows, lambda: None)  # What is known by then is the bracket.
    if found.closed:
        found.stopped = None
    elif search.unbounded:
        found.stopped = Stop.SIZE
    return found


def branched(root: WindowSearch) -> None:
    """Raise the bound of a search that has no more to give: its states divided, and again, the lowest part first.

    Every state lies in one of both parts, so the least bound of both is one of the whole.
    """
    found, leaves, rates = root.found, [root], RateProgramme(root.equations)
    while not found.closed and time.process_time() < root.until:
        leaf = min(leaves, key=lambda each: each.found.lower)
        more, before = False, leaf.found.iterations
        if leaf is not root:
            more = leaf.window()
            found.iterations += leaf.found.iterations - before
        if leaf.found.closed:
            leaf.found.lower = leaf.found.upper
        elif not more and time.process_time() < root.until:
            at = leaf.division()
            if at is None:
                found.stopped = Stop.DECIDED
                break
            leaves.remove(leaf)
            leaves += leaf.parts(at, rates)
            found.branches += 1
        found.lower = max(found.lower, min(each.found.lower for each in leaves))
