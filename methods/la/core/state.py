"""A collapse state and the method's own check of it, before the judge sees it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.core.exact import exact_forces, exact_mechanism
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.numerics.failures import NumericalFailure

_MOVING = 1e-11
"""Rates below this, relative to the largest, are rounding."""

_TIGHT = 1e-8
"""Slacks below this, in mean block weights, are rounding."""

LIGHTEST, SLOWEST = 1e-13, 1e-2
"""Shares of the largest force, and of the fastest speed, from which those of a block count."""


@dataclass(frozen=True, eq=False)
class CollapseState:
    """Scaled forces (m, 3), multiplier, velocities (3n,) and the contacts that move (m, 4)."""

    forces: FloatArray
    multiplier: float
    velocities: FloatArray
    moving: BoolArray
    associated: bool = False


def residuals(problem: Problem, state: CollapseState) -> dict[str, float]:
    """Relative residuals of a collapse state: equilibrium, yield, interpenetration, complementarity.

    Equilibrium and yield are relative to the total dead load, interpenetration to the fastest velocity component,
    complementarity (the work of the slacks on the rates) to the live work.
    """
    blocks = max(problem.n_velocities / 3.0, 1.0)
    slack = problem.slacks(state.forces)
    rates = problem.rates_of_velocities(state.velocities, state.associated)
    speed = float(abs(state.velocities).max(initial=0.0)) or 1.0
    work = float(problem.live @ state.velocities)
    return {
        "equilibrium": float(abs(problem.imbalance(state.forces, state.multiplier)).max(initial=0.0)) / blocks,
        "yield": max(0.0, -float(slack.min(initial=0.0))) / blocks,
        "interpenetration": max(0.0, -float(rates.min(initial=0.0))) / speed,
        "complementarity": float(abs(slack * rates).sum()) / work if work > 0.0 else float("inf"),
    }


def local_residuals(problem: Problem, state: CollapseState) -> tuple[FloatArray, FloatArray, FloatArray]:
    """What is wrong about a state where it arises: equilibrium (n,) of blocks, tension and closing (m,) of interfaces.

    Equilibrium is relative to the largest force or load on its block, yield to the lesser of those of its two blocks,
    closing to the faster of them. A block without load, which may bear nothing, has at least the size of the lightest.
    """
    assembly = problem.assembly
    n = problem.n_velocities // 3
    balance = problem.imbalance(state.forces, state.multiplier).reshape(-1, 3)
    terms = np.asarray(abs(problem.statics) @ abs(state.forces.ravel())) + abs(problem.dead)
    terms += abs(state.multiplier * problem.live)
    size = terms.reshape(-1, 3).max(axis=1)
    loaded = (abs(problem.dead) + abs(problem.live)).reshape(-1, 3).any(axis=1)
    size[~loaded] = np.maximum(size[~loaded], size[loaded].min(initial=np.inf, where=size[loaded] > 0.0))
    rates = problem.rates_of_velocities(state.velocities, state.associated)
    speed = abs(state.velocities.reshape(-1, 3)).max(axis=1)
    place = np.full(assembly.n_blocks, n)
    place[assembly.free] = np.arange(n)
    a, b = place[assembly.block_a], place[assembly.block_b]
    lesser = np.minimum(np.append(size, np.inf)[a], np.append(size, np.inf)[b])
    faster = np.maximum(np.append(speed, 0.0)[a], np.append(speed, 0.0)[b])
    tension = np.maximum(-problem.slacks(state.forces).min(axis=1), 0.0)
    closing = np.maximum(-rates[:, :2].min(axis=1), 0.0)
    return (
        _share(abs(balance).max(axis=1), size, LIGHTEST),
        _share(tension, np.where(np.isfinite(lesser), lesser, 0.0), LIGHTEST),
        _share(closing, faster, SLOWEST),
    )


def _share(value: FloatArray, of: FloatArray, least: float) -> FloatArray:
    """Values relative to sizes, of which none counts as less than this share of the largest."""
    floor = least * float(of.max(initial=0.0)) or 1.0
    return np.asarray(value / np.maximum(of, floor))


def moving_contacts(rates: FloatArray) -> BoolArray:
    """(m, 4) rates that are more than rounding."""
    return rates > _MOVING * float(rates.max(initial=0.0))


def tight_contacts(problem: Problem, forces: FloatArray) -> BoolArray:
    """(m, 4) slacks that are no more than rounding."""
    return problem.slacks(forces) <= _TIGHT


def polished(
    problem: Problem, newton: NewtonMatrix, state: CollapseState, tight: BoolArray | None = None
) -> CollapseState:
    """The same collapse state with forces and mechanism exact to rounding, where that lowers its residuals.

    Args:
        problem: the scaled wall.
        newton: its Newton matrix.
        state: an approximate collapse state; its `moving` contacts are kept.
        tight: (m, 4) slacks to hold at zero; by default those that are zero to rounding.
    """
    best, merit = state, max(residuals(problem, state).values())
    guess = tight_contacts(problem, state.forces) if tight is None else tight
    for tight in (guess | state.moving, state.moving):
        for candidate in _exact(problem, newton, state, tight):
            size = max(residuals(problem, candidate).values())
            if size < merit:
                best, merit = candidate, size
        if merit < 1e-13:
            break
    return best


def _exact(problem: Problem, newton: NewtonMatrix, state: CollapseState, tight: BoolArray) -> Iterator[CollapseState]:
    """The state with exact forces, then with an exact mechanism too, as far as there are any."""
    try:
        forces, multiplier = exact_forces(problem, newton, state.forces, state.multiplier, tight)
        state = replace(state, forces=forces, multiplier=multiplier)
        yield state
        yield replace(
            state, velocities=exact_mechanism(problem, newton, state.velocities, state.moving, state.associated)
        )
    except NumericalFailure:
        return
