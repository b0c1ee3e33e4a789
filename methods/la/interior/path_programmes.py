"""The two programmes of the search solved by the interior point instead of simplex, for walls of any size.

Both are linear, hence their central paths are monotone however large the wall is. The kinematic programme
min c.g, C u = E g, fL.u = const is the dual of max lambda s.t. C' r + lambda fL = 0, E' r + c >= 0: the same problem
without dead load and friction and with the constant parts c. The static programme min lambda, y_J = 0 is the
associated one with the live load reversed and the slacks J held at zero.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.core.exact import close_tight, exact_forces, exact_mechanism
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState, residuals
from methods.la.interior.interior_point import PathResult, PathSettings, follow_path, start_point
from methods.la.interior.interior_starting_point import kinematic_programme
from methods.numerics.failures import NumericalFailure


@dataclass(frozen=True)
class Exactness:
    """How exact a state read from the end of a path must be, and how it is made so.

    Attributes:
        kept: largest residual of a state that is kept.
        enough: residual below which no more exact state is looked for.
        thresholds: rates up to which a contact counts as still, tried until a state is exact.
        shares: shares of its slack above which a rate counts as motion, tried in turn.
        worth: relative rise of the multiplier that a more exact state is worth.
        biases: ratios of rate and slack above which a slack counts as zero, tried in turn.
        linear: how the path of the static programme is followed.
    """

    kept: float = 1e-10
    enough: float = 1e-12
    thresholds: tuple[float, ...] = (0.0, 1e-9)
    shares: tuple[float, ...] = (1e-6, 1e-7, 1e-8)
    worth: float = 1e-4
    biases: tuple[float, ...] = (1e6, 1e3, 1e9)
    linear: PathSettings = field(
        default_factory=lambda: PathSettings(1.0, 1e-13, 1e-3, max_iterations=150, patience=20)
    )


def cheapest_mechanism(
    problem: Problem, newton: NewtonMatrix, cost: FloatArray, generator: np.random.Generator, least: float = 1e-4
) -> PathResult:
    """The zero-dilatancy mechanism of least cost c.g; cost (m, 4) >= 0. Velocities and rates are in its point.

    A random cost of relative size `least` is added, so that one extreme mechanism is the cheapest by a margin.
    """
    spread = least * generator.uniform(0.5, 1.5, cost.shape)
    size = float(np.median(cost[cost > 0.0])) if np.any(cost > 0.0) else 1.0
    programme = kinematic_programme(problem, cost / size + spread)
    return follow_path(programme, newton, start_point(programme), PathSettings.sharp())


def _least_multiplier(problem: Problem, newton: NewtonMatrix, moving: BoolArray, settings: PathSettings) -> PathResult:
    """The forces of least multiplier with the slacks of the moving contacts (m, 4) at zero, as a path's end.

    The path belongs to the reversed live load: its multiplier has the opposite sign.
    """
    tight = close_tight(problem, moving)
    reversed_load = replace(problem, live=-problem.live)
    return follow_path(reversed_load, newton, start_point(reversed_load, tight=tight), settings, tight)


def state_of_mechanism(
    problem: Problem,
    newton: NewtonMatrix,
    velocities: FloatArray,
    moving: BoolArray,
    exactness: Exactness = Exactness(),
) -> tuple[CollapseState | None, int]:
    """The best collapse state of a mechanism with contacts `moving` (m, 4), exact to rounding, and the steps spent.

    One at a negative multiplier is none: the wall would not bear its dead load alone.
    """
    result = _least_multiplier(problem, newton, moving, exactness.linear)
    point = result.point
    best: CollapseState | None = None
    merit = float("inf")
    for bias in exactness.biases:
        tight = close_tight(problem, moving) | (point.rates > bias * point.slack)
        try:
            forces, multiplier = exact_forces(
                problem, newton, problem.forces_of_slacks(point.slack), -point.multiplier, tight, floor=1e-14
            )
        except NumericalFailure:
            continue
        if multiplier < -exactness.kept:
            continue
        state = CollapseState(forces, multiplier, velocities, moving)
        size = max(residuals(problem, state).values())
        if size < merit:
            best, merit = state, size
        if merit < exactness.enough:
            break
    return best, result.iterations


def exact_state(
    problem: Problem,
    newton: NewtonMatrix,
    path: PathResult,
    exactness: Exactness = Exactness(),
) -> tuple[CollapseState | None, int]:
    """The first exact collapse state of a mechanism whose rates count as motion above a threshold, and the steps spent.

    Rates decay geometrically away from the centre of a mechanism. A contact that moves by a billionth may be one that
    approximate forces misjudged; without it the mechanism is exact to the tolerance, or is made so. The greatest share
    of its slack above which a rate counts leaves the forces the most freedom, and so the least multiplier, but the
    mechanism the least exact: lower shares are tried while they raise the multiplier by little.
    """
    steps, best, merit = 0, None, exactness.kept
    tried: set[int] = set()
    for threshold in exactness.thresholds:
        for share in exactness.shares:
            moving = path.point.rates > np.maximum(threshold, share * path.point.slack)
            if int(moving.sum()) in tried:
                continue
            tried.add(int(moving.sum()))
            state, spent = state_of_mechanism(problem, newton, path.point.velocities, moving, exactness)
            steps += spent
            if state is None or residuals(problem, state)["equilibrium"] > exactness.kept:
                break
            for candidate in (state, _at_rest_elsewhere(problem, newton, state)):
                size = max(residuals(problem, candidate).values())
                if size < merit and (best is None or candidate.multiplier < best.multiplier * (1.0 + exactness.worth)):
                    best, merit = candidate, size
            if merit < exactness.enough:
                return best, steps
        if best is not None:
            break
    return best, steps


def _at_rest_elsewhere(problem: Problem, newton: NewtonMatrix, state: CollapseState) -> CollapseState:
    try:
        return replace(state, velocities=exact_mechanism(problem, newton, state.velocities, state.moving, False))
    except NumericalFailure:
        return state
