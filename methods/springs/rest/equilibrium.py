"""Equilibrium under the dead load and off it: Newton, then pseudo-transient relaxation when Newton cycles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from harness.model.assembly import FloatArray
from methods.springs.model.factor import Factor
from methods.springs.model.wall_model import WallModel
from methods.springs.rest.newton import Equilibrium, newton
from methods.springs.rest.pseudo_transient import PseudoTransient

_FIRST_MULTIPLIER = 1e-3
"""Of the first Newton step off the breakpoints on which gravity leaves many gap points."""
_NEWTON_STEPS = 25
"""At most, of each of the doubled steps that follow."""
_STEPS_UNDER_DEAD_LOAD = 10_000
"""Newton steps to the first rest of all, at most."""


def equilibrium(
    model: WallModel,
    factor: Factor,
    u: FloatArray,
    multiplier: float,
    history: FloatArray,
    limit: int | None = None,
    commits: bool = False,
) -> Equilibrium:
    """Newton, then pseudo-transient relaxation of at most `limit` steps (None: as the options say) from the same start.

    Args:
        commits: whether that motion commits its friction history; the equilibrium holds under `history` if not.
    """
    answer = newton(model, factor, u, multiplier, history)
    if answer.found:
        return answer
    start = replace(answer, u=u, history=history)
    return PseudoTransient(model, factor, start, commits).move(multiplier, limit)


def gravity_state(model: WallModel, factor: Factor) -> Equilibrium:
    """Equilibrium under the dead load from the virgin state."""
    return equilibrium(model, factor, np.zeros(model.n_unknowns), 0.0, model.history, _STEPS_UNDER_DEAD_LOAD)


def first_step(model: WallModel, factor: Factor, rest: Equilibrium, scale: float) -> Equilibrium:
    """Equilibrium a small step off the one under the dead load: the longest of a few that has one.

    Args:
        model: the wall; factor: its tangent; rest: equilibrium under the dead load.
        scale: a multiplier of the order of collapse.
    """
    options = model.options.first_steps
    multiplier = _FIRST_MULTIPLIER * min(1.0, scale)
    first = equilibrium(model, factor, rest.u, multiplier, rest.history)
    for _ in range(options.tries):
        if first.found:
            break
        multiplier *= options.shorter
        first = equilibrium(model, factor, rest.u, multiplier, rest.history)
    return first


def doubled(model: WallModel, factor: Factor, first: Equilibrium) -> Iterator[Equilibrium]:
    """Equilibria at 2, 4, 8, ... times the multiplier of a first one, as far as Newton converges and loads are raised.

    Without commits the law has no history, so they lie on the path from the first.
    """
    options = model.options
    while first.multiplier < options.furthest:
        first = newton(model, factor, first.u, 2.0 * first.multiplier, first.history, _NEWTON_STEPS)
        if not first.found:
            return
        yield first
