"""The dynamic jump of a wall whose path has turned down, to equilibrium just above the peak."""

from __future__ import annotations

import numpy as np

from methods.springs.model.factor import SingularTangent
from methods.springs.path.continuation import PathFollower
from methods.springs.rest.equilibrium import equilibrium


def past_turn(follower: PathFollower, peak: float, jumps: int) -> tuple[PathFollower, float]:
    """The tracer to go on with where a path has turned down, and the share of the peak at which to look again.

    Args:
        tracer: where the path has turned down; peak: its peak; jumps: how many may still be tried.

    Raises:
        SingularTangent: the path cannot be taken up again where it stands.
    """
    after = _jump(follower, peak) if jumps > 0 else None
    if after is not None:
        return after, follower.model.options.jump.turn
    follower.refresh()
    return follower, np.inf


def _jump(follower: PathFollower, peak: float) -> PathFollower | None:
    """The tracer just above the peak, at the equilibrium that the springs come to from where it is; None if at none."""
    options = follower.model.options.jump
    above = peak * (1.0 + options.above) + options.least
    answer = equilibrium(follower.model, follower.factor, follower.u, above, follower.history, commits=True)
    if not answer.found:
        return None
    try:
        follow = PathFollower.from_rest(follower.model, follower.factor, answer)
    except SingularTangent:
        return None
    return successor(follow, follower)


def successor(follow: PathFollower, follower: PathFollower) -> PathFollower:
    """A tracer further along the path, which keeps the scales of the one it follows."""
    follow.direction.elastic, follow.first_displacement = follower.direction.elastic, follower.first_displacement
    follow.certificate = follower.certificate
    return follow
