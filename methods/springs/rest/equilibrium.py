"""Equilibrium under the dead load and off it: Newton, then slow motion when Newton cycles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import FloatArray
from methods.springs.model.factor import Factor
from methods.springs.model.wall_model import WallModel
from methods.springs.rest.newton import Equilibrium, newton
from methods.springs.rest.pseudo_transient import LOAD_RAISING, REST, PseudoTransient


@dataclass(frozen=True)
class FirstSteps:
    """The Newton steps off the breakpoints on which gravity leaves many gap points.

    Attributes:
        multiplier: of the first.
        shorter: factor on it where the wall does not stand that one; tries: how often, at most: a wall may collapse at
            a multiplier below it.
        newton_steps: at most, of each of the doubled steps that follow.
    """

    multiplier: float = 1e-3
    shorter: float = 0.1
    tries: int = 5
    newton_steps: int = 25


FIRST_STEPS = FirstSteps()


def equilibrium(
    model: WallModel,
    factor: Factor,
    u: FloatArray,
    multiplier: float,
    history: FloatArray,
    limit: int = REST.steps,
    commits: bool = False,
) -> Equilibrium:
    """Newton, then slow motion of at most `limit` Newton steps from where Newton started.

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
    return equilibrium(model, factor, np.zeros(model.n_unknowns), 0.0, model.history, REST.steps_under_dead_load)


def first_step(model: WallModel, factor: Factor, rest: Equilibrium, scale: float) -> Equilibrium:
    """Equilibrium a small step off the one under the dead load: the longest of a few that has one.

    Args:
        model: the wall; factor: its tangent; rest: equilibrium under the dead load.
        scale: a multiplier of the order of collapse.
    """
    multiplier = FIRST_STEPS.multiplier * min(1.0, scale)
    first = equilibrium(model, factor, rest.u, multiplier, rest.history)
    for _ in range(FIRST_STEPS.tries):
        if first.found:
            break
        multiplier *= FIRST_STEPS.shorter
        first = equilibrium(model, factor, rest.u, multiplier, rest.history)
    return first


def doubled(model: WallModel, factor: Factor, first: Equilibrium) -> Iterator[Equilibrium]:
    """Equilibria at 2, 4, 8, ... times the multiplier of a first one, as far as Newton converges and loads are raised.

    Without commits the law has no history, so they lie on the path from the first.
    """
    while first.multiplier < LOAD_RAISING.furthest:
        first = newton(model, factor, first.u, 2.0 * first.multiplier, first.history, FIRST_STEPS.newton_steps)
        if not first.found:
            return
        yield first
