"""Collapse states of large walls: the two programmes of the search solved by the interior point instead of simplex.

Both are linear, hence their central paths are monotone however large the wall is. The kinematic programme
min c.g, C u = E g, fL.u = const is the dual of max lambda s.t. C' r + lambda fL = 0, E' r + c >= 0: the same problem
without dead load and friction and with cohesion c. The static programme min lambda, y_J = 0 is the associated one
with the live load reversed and the slacks J held at zero.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.exact import close_tight, exact_forces
from methods.la.interior_point import PathResult, PathSettings, follow_path, start_point
from methods.la.newton_matrix import NewtonMatrix
from methods.la.problem import Problem
from methods.la.state import CollapseState, residuals

LINEAR = PathSettings(dilatancy=1.0, gap=1e-13, residual=1e-3, max_iterations=150, patience=8)
SHARP = PathSettings(dilatancy=1.0, gap=1e-17, residual=1e-3, max_iterations=150, patience=5)
"""Rates of contacts that do not move must vanish against forces of any size, hence the small gap."""


def cheapest_mechanism(
    problem: Problem, newton: NewtonMatrix, cost: FloatArray, generator: np.random.Generator, least: float = 1e-4
) -> PathResult:
    """The zero-dilatancy mechanism of least cost c.g; cost (m, 4) >= 0. Velocities and rates are in its point.

    A random cost of relative size `least` is added, so that one extreme mechanism is the cheapest by a margin.
    """
    spread = least * generator.uniform(0.5, 1.5, cost.shape)
    size = float(np.median(cost[cost > 0.0])) if np.any(cost > 0.0) else 1.0
    shifted = replace(
        problem,
        dead=np.zeros_like(problem.dead),
        friction=np.zeros_like(problem.friction),
        cohesion=cost / size + spread,
    )
    return follow_path(shifted, newton, start_point(shifted), SHARP)


def least_multiplier(problem: Problem, newton: NewtonMatrix, moving: BoolArray) -> PathResult:
    """The forces of least multiplier with the slacks of the moving contacts (m, 4) at zero, as a path's end.

    The path belongs to the reversed live load: its multiplier has the opposite sign.
    """
    tight = close_tight(problem, moving)
    reversed_load = replace(problem, live=-problem.live)
    return follow_path(reversed_load, newton, start_point(reversed_load, tight=tight), LINEAR, tight)


def state_of_mechanism(
    problem: Problem, newton: NewtonMatrix, velocities: FloatArray, moving: BoolArray
) -> tuple[CollapseState | None, int]:
    """The best collapse state of a mechanism with contacts `moving` (m, 4), exact to rounding, and the steps spent."""
    result = least_multiplier(problem, newton, moving)
    point = result.point
    best: CollapseState | None = None
    merit = float("inf")
    for bias in (1e6, 1e3, 1e9):
        tight = close_tight(problem, moving) | (point.rates > bias * point.slack)
        try:
            forces, multiplier = exact_forces(
                problem, newton, problem.forces_of_slacks(point.slack), -point.multiplier, tight, floor=1e-14
            )
        except RuntimeError:
            continue
        state = CollapseState(forces, multiplier, velocities, moving)
        size = max(residuals(problem, state).values())
        if size < merit:
            best, merit = state, size
        if merit < 1e-12:
            break
    return best, result.iterations


def large_search(problem: Problem, newton: NewtonMatrix, seed: int) -> tuple[list[CollapseState], int, float]:
    """Exact collapse states near the end of the zero-dilatancy path, the Newton steps spent, the gap of that path.

    The path need not end: where it stalls at a fold, the mechanism of least work on the slacks reached is still near
    a collapse state. Contacts count as moving down to rates of a millionth of their own slack, because rates decay
    geometrically away from the centre of a mechanism.
    """
    generator = np.random.default_rng(seed)
    path = follow_path(problem, newton, start_point(problem), PathSettings(gap=1e-8, residual=1e-3, max_iterations=150))
    steps = path.iterations
    states: list[CollapseState] = []
    for least in (1e-4, 1e-6, 1e-2):
        mechanism = cheapest_mechanism(problem, newton, path.point.slack, generator, least)
        steps += mechanism.iterations
        moving = mechanism.point.rates > 1e-6 * mechanism.point.slack
        state, spent = state_of_mechanism(problem, newton, mechanism.point.velocities, moving)
        steps += spent
        if state is not None and max(residuals(problem, state).values()) < 1e-11:
            states.append(state)
            break
    return states, steps, path.gap
