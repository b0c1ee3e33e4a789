"""A finite step with freshly committed friction history, by Newton on the factor that the path already has.

After a commit every slipping point sits exactly on its breakpoint, where a path has no single direction. A finite step
decides which of them stick. Few points change, so the factor follows by rank-one updates.
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import FloatArray, IntArray
from methods.numerics.block_kernels import COLUMNS
from methods.numerics.vectors import largest
from methods.springs.model.factor import Change, Factor, SingularTangent, refactor_any
from methods.springs.model.gap_law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, classify, same_forces
from methods.springs.model.point_loops import point_strains
from methods.springs.model.wall_model import WallModel
from methods.springs.path.continuation import PathFollower

_STEPS = 12
"""Newton steps at most."""
_UPDATES = 24
"""Changed points above which a fresh factor is cheaper than updates."""
_PIVOT = 1e3
"""|1 + b'y|, or its inverse, above which updates are not trusted here."""
_LONGEST = 5.0
"""Steps longer than this many tangent steps may have left the branch and are not taken."""
_BALANCED = 1e-9
"""Out-of-balance force (share of the load scale) up to which a step is taken without a further one: by way of huge
displacements, over a nearly singular tangent, it loses digits."""


def committed_step(follower: PathFollower, ahead: float) -> PathFollower | None:
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
