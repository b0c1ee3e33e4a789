"""A path followed to its end: past turns by jumps, with the friction history committed on the way if asked for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from methods.springs.model.factor import SingularTangent
from methods.springs.path.commits import committed_step
from methods.springs.path.continuation import PathFollower
from methods.springs.path.path_record import PathEnd, PathRecord
from methods.springs.rest.equilibrium import equilibrium

_WITHIN = 300.0
"""Displacements, in multiples of the first, up to which the history is still committed."""
_TURN = 0.1
"""Share of the peak by which a path may turn down before a jump from it is tried."""
_RAISED = 1e-3
"""Share of the peak by which the load is raised above it for a jump."""
_LEAST_RISE = 1e-9
"""Multiplier added to that."""


@dataclass(frozen=True)
class LoadPath:
    """Where a path ended and why, the commits on the way, and the largest residual found on it."""

    follower: PathFollower
    end: PathEnd
    commits: int
    residual: float


def follow(
    follower: PathFollower,
    record: PathRecord,
    max_events: int,
    interval: float = np.inf,
    highest: float = np.inf,
    jumps: int | None = None,
    committed_up_to: float = np.inf,
) -> LoadPath:
    """Follow a path from where the follower stands to its end.

    Args:
        follower: the beginning of the path, which is used up.
        record: receives the path.
        max_events: changes of state after which the path is given up.
        interval: multiplier between two commits of the history; infinite for none.
        highest: multiplier above which a path with commits counts as lost.
        jumps: most jumps tried where the path turns down (None: as the options say); none at a peak from which one was
            tried in vain.
        committed_up_to: multiplier above which the history is no longer committed.

    Raises:
        SingularTangent: the path cannot be taken up again where it stands.
        OutOfTime: the time given is over; the record has the path so far.
    """
    options = follower.model.options
    jumps = options.jumps if jumps is None else jumps
    committing, large = interval < np.inf, _WITHIN * follower.first_displacement
    turn = _TURN if jumps > 0 else np.inf
    commits, residual, hopeless = 0, 0.0, -np.inf
    while True:
        after = None
        early = record.peak <= follower.multiplier <= committed_up_to - interval and follower.extent < large
        if committing and early and follower.may_commit():
            after = _committed(follower, interval, record)
        if after is not None:
            commits, follower, end = commits + 1, after, PathEnd.TARGET
        else:
            end = follower.run(record, max_events, follower.multiplier + interval, turn)
        residual = max(residual, follower.worst_residual)
        if end == PathEnd.TURNED_DOWN:
            follower, turn = _past_turn(follower, record.peak, jumps if record.peak > hopeless else 0)
            jumps -= 1
            if turn == np.inf:
                hopeless = record.peak
        elif end != PathEnd.TARGET:
            return LoadPath(follower, end, commits, residual)
        elif follower.multiplier > highest:
            return LoadPath(follower, PathEnd.BREAKDOWN, commits, residual)


def _committed(follower: PathFollower, interval: float, record: PathRecord) -> PathFollower | None:
    """The follower one interval after a commit, by a finite Newton step; None where that does not settle."""
    after = committed_step(follower, interval)
    if after is None:
        follower.refresh()
        return None
    record.peak = max(record.peak, after.multiplier)
    record.add(
        after.multiplier,
        float(follower.model.live @ after.u),
        after.n_slip,
        after.n_open,
        after.model.bar_tensions(after.trial),
    )
    record.keep(after.load_step)
    return _successor(after, follower)


def _past_turn(follower: PathFollower, peak: float, jumps: int) -> tuple[PathFollower, float]:
    """The follower to go on with where a path has turned down, and the share of the peak at which to look again.

    Args:
        follower: where the path has turned down; peak: its peak; jumps: how many may still be tried.

    Raises:
        SingularTangent: the path cannot be taken up again where it stands.
    """
    after = _jump(follower, peak) if jumps > 0 else None
    if after is not None:
        return after, _TURN
    follower.refresh()
    return follower, np.inf


def _jump(follower: PathFollower, peak: float) -> PathFollower | None:
    """The follower just above the peak, at the equilibrium that the springs reach from where it is; None if none."""
    above = peak * (1.0 + _RAISED) + _LEAST_RISE
    answer = equilibrium(follower.model, follower.factor, follower.u, above, follower.history, commits=True)
    if not answer.found:
        return None
    try:
        follow = PathFollower.from_rest(follower.model, follower.factor, answer)
    except SingularTangent:
        return None
    return _successor(follow, follower)


def _successor(follow: PathFollower, follower: PathFollower) -> PathFollower:
    """A follower further along the path, which keeps the scales of the one it follows."""
    follow.direction.elastic, follow.first_displacement = follower.direction.elastic, follower.first_displacement
    follow.certificate = follower.certificate
    return follow
