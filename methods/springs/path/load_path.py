"""A path followed to its end: past turns by jumps, with the friction history committed on the way if asked for.

After a commit every slipping point sits exactly on its breakpoint, where a path has no single direction. A finite step,
by Newton on the factor that the path already has, decides which of them stick. Few points change, so the factor follows
by rank-one updates.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.block_kernels import COLUMNS
from methods.numerics.vectors import largest
from methods.springs.model.factor import Change, Factor, SingularTangent, refactor_any
from methods.springs.model.gap_law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, classify, same_forces
from methods.springs.model.point_loops import point_strains
from methods.springs.model.wall_model import WallModel
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
_STEPS = 12
"""Newton steps at most after a commit."""
_UPDATES = 24
"""Changed points above which a fresh factor is cheaper than updates."""
_PIVOT = 1e3
"""|1 + b'y|, or its inverse, above which updates are not trusted here."""
_LONGEST = 5.0
"""Steps longer than this many tangent steps may have left the branch and are not taken."""
_BALANCED = 1e-9
"""Out-of-balance force (share of the load scale) up to which a step is taken without a further one: by way of huge
displacements, over a nearly singular tangent, it loses digits."""


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
    after = _committed_step(follower, interval)
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


def _committed_step(follower: PathFollower, ahead: float) -> PathFollower | None:
    """Commit the history where the follower stands and step `ahead` in the multiplier.

    Returns:
        A follower on the new path, or None when Newton did not settle (the old follower must then be `refresh`ed).
    """
    model, factor = follower.model, follower.factor
    near = model.options.breakpoints.force * follower.scale
    history = follower.commit()
    multiplier = follower.multiplier + ahead
    u, state = follower.u.copy(), follower.state.copy()
    shift = history - follower.history
    opening, trial = follower.opening.copy(), follower.trial + shift
    opening_rate, slip_rate = np.empty_like(opening), np.empty_like(trial)
    seen: set[bytes] = set()
    landed = np.empty_like(state)
    try:
        for _ in range(_STEPS):
            step = factor.solve(model.out_of_balance(opening, trial, state, multiplier))
            u += step
            point_strains(model.unknown, model.rows, model.interface, model.position, step, opening_rate, slip_rate)
            opening += opening_rate
            trial += model.kt * slip_rate
            classify(opening, trial, model.kn, model.mu, model.lift, landed, False)
            if same_forces(opening, trial, model.kn, model.mu, model.lift, state, landed, near):
                opening, trial = model.strains(u)
                trial = model.kt * trial + history
                if largest(model.out_of_balance(opening, trial, state, multiplier)) > _BALANCED * follower.scale:
                    continue
                if not _near(follower, u, ahead):
                    return None
                return PathFollower(model, factor, u, multiplier, history, state, factorised=True)
            key = landed.tobytes()
            if key in seen:
                return None
            seen.add(key)
            _change_states(model, factor, state, landed)
    except SingularTangent:
        return None
    return None


def _near(follower: PathFollower, u: FloatArray, ahead: float) -> bool:
    """Whether a step stays on its branch: the live load works forwards, not much further than the tangent predicts."""
    moved = u - follower.u
    predicted = largest(follower.direction.velocity) * ahead
    return float(follower.model.live @ moved) > 0.0 and largest(moved) <= _LONGEST * predicted


def _change_states(model: WallModel, factor: Factor, state: IntArray, wanted: IntArray) -> None:
    """Bring a factor from one set of states (changed in place) to another.

    A tangent that turns singular on the way belongs to a step gone astray, which is not worth a regularised factor.
    Only one that was regularised before, or a wall with a block without load, has free motions that nothing resists.

    Raises:
        SingularTangent: the tangent is singular, and may not be.
    """
    points = np.flatnonzero(state != wanted).tolist()
    changes = [change for p in points for change in _way(p, int(state[p]), int(wanted[p]))]
    if len(points) <= _UPDATES and factor.count + len(changes) < factor.capacity:
        for k, change in enumerate(changes):
            if k % COLUMNS == 0:
                factor.foresee(changes[k : k + COLUMNS])
            if not _change(model, factor, change):
                break
        else:
            state[:] = wanted
            return
    state[:] = wanted
    if factor.is_regularised or model.idle_blocks:
        refactor_any(factor, state)
    else:
        factor.refactor(state)


def _way(point: int, old: int, new: int) -> tuple[Change, ...]:
    """The changes between neighbouring states that lead a point from one state to another."""
    between = old
    if {old, new} == {OPEN, STICK}:
        between = SLIP_PLUS
    elif {old, new} == {SLIP_PLUS, SLIP_MINUS}:
        between = STICK
    return ((point, old, new),) if between == old else ((point, old, between), (point, between, new))


def _change(model: WallModel, factor: Factor, change: Change) -> bool:
    """One rank-one update; False when it would cost digits."""
    index, _, b = model.change(*change)
    y = factor.solve_change(change)
    denominator = 1.0 + float(b @ y[index])
    if not 1.0 / _PIVOT < abs(denominator) < _PIVOT:
        return False
    factor.update(y, index, b, denominator)
    return True
