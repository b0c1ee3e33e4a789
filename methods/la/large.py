"""Collapse states of large walls: the two programmes of the search solved by the interior point instead of simplex.

Both are linear, hence their central paths are monotone however large the wall is. The kinematic programme
min c.g, C u = E g, fL.u = const is the dual of max lambda s.t. C' r + lambda fL = 0, E' r + c >= 0: the same problem
without dead load and friction and with cohesion c. The static programme min lambda, y_J = 0 is the associated one
with the live load reversed and the slacks J held at zero.
"""

from __future__ import annotations

import time
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.arc import ArcPath
from methods.la.continuation import smoothed
from methods.la.exact import close_tight, exact_forces, exact_mechanism
from methods.la.feasible_pair import feasible_pair, kinematic_programme
from methods.la.interior_point import PathResult, PathSettings, follow_path, start_point
from methods.la.lagged import SHARP, lagged_mechanism
from methods.la.newton_matrix import NewtonMatrix
from methods.la.problem import Problem
from methods.la.region import Region, in_whole, moving_region
from methods.la.state import CollapseState, residuals
from methods.numerics.failures import NumericalFailure

LINEAR = PathSettings(dilatancy=1.0, gap=1e-13, residual=1e-3, max_iterations=150, patience=20)
EXACT_ENOUGH = 1e-10
"""Largest residual of a state that is kept."""
EXACT = 1e-12
"""Residual below which no more exact state is looked for."""
SHARES = (1e-6, 1e-7, 1e-8)
"""Shares of its slack above which a rate counts as motion, tried until a state is exact."""
WORTH = 1e-4
"""Relative rise of the multiplier that a more exact state is worth."""
ATTEMPTS = ((80, 0.3), (120, 0.15), (100, 0.6))
"""Newton steps with lagged bounds and how fast the bounds follow, tried in order."""
FEW_INTERFACES = 2000
"""Interfaces up to which every factor of `SMOOTH` is tried, instead of the first that leads to a state."""
MOST_INTERFACES = 6000
"""Interfaces above which Newton's path of the whole wall stalls at folds."""
SMOOTH = (0.3, 0.6, 0.0)
"""Factors on the friction of the joints that the dead load leaves unloaded, each the guide of one attempt."""
PATH = PathSettings(gap=1e-8, residual=1e-3, max_iterations=150)
WIDEST_GAP = 1e-2
"""Relative gap at the end of a path above which its slacks do not tell a mechanism."""


@dataclass(frozen=True)
class Lead:
    """How a path by arc length begins, and how far it is followed.

    Attributes:
        smooth: factor on the friction of the joints that the dead load leaves unloaded.
        gap: relative gap of the associated path at which the forces of its start are taken.
        spread: of the weights about their mean.
        gaps: of the path at which its mechanism is tried.
        most_steps: Newton steps from one of them to the next.
    """

    smooth: float
    gap: float
    spread: float
    gaps: tuple[float, ...]
    most_steps: int


NEAR = (10.0, (1e-6, 1e-8), 600)
LEADS = (Lead(0.3, 1e-2, *NEAR), Lead(0.45, 1e-2, *NEAR), Lead(0.3, 1e-3, *NEAR))
"""Paths near the central one, which end low but do not always arrive."""
FAR = (np.inf, (1e-8, 1e-9, 1e-10), 2000)
FAR_LEADS = (Lead(0.15, 1e-2, *FAR), Lead(0.3, 1e-3, *FAR), Lead(0.0, 1e-2, *FAR))
"""Paths with the weights of their start, tried where no other led to a state and from MANY moving blocks on."""
MANY = 2000
"""Blocks of a moving part on which a path near the central one folds a thousand times and more."""
ENOUGH = 1e6
"""Newton steps times blocks of the moving part after which no other lead is tried once there is a state."""


def cheapest_mechanism(
    problem: Problem, newton: NewtonMatrix, cost: FloatArray, generator: np.random.Generator, least: float = 1e-4
) -> PathResult:
    """The zero-dilatancy mechanism of least cost c.g; cost (m, 4) >= 0. Velocities and rates are in its point.

    A random cost of relative size `least` is added, so that one extreme mechanism is the cheapest by a margin.
    """
    spread = least * generator.uniform(0.5, 1.5, cost.shape)
    size = float(np.median(cost[cost > 0.0])) if np.any(cost > 0.0) else 1.0
    programme = kinematic_programme(problem, cost / size + spread)
    return follow_path(programme, newton, start_point(programme), SHARP)


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
    """The best collapse state of a mechanism with contacts `moving` (m, 4), exact to rounding, and the steps spent.

    One at a negative multiplier is none: the wall would not bear its dead load alone.
    """
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
        except NumericalFailure:
            continue
        if multiplier < -EXACT_ENOUGH:
            continue
        state = CollapseState(forces, multiplier, velocities, moving)
        size = max(residuals(problem, state).values())
        if size < merit:
            best, merit = state, size
        if merit < EXACT:
            break
    return best, result.iterations


def mechanism_states(
    problem: Problem,
    newton: NewtonMatrix,
    path: PathResult,
    thresholds: tuple[float, ...],
    shares: tuple[float, ...] = SHARES,
) -> tuple[CollapseState | None, int]:
    """The first exact collapse state of a mechanism whose rates count as motion above a threshold, and the steps spent.

    Rates decay geometrically away from the centre of a mechanism. A contact that moves by a billionth may be one that
    approximate forces misjudged; without it the mechanism is exact to the tolerance, or is made so. The greatest share
    of its slack above which a rate counts leaves the forces the most freedom, and so the least multiplier, but the
    mechanism the least exact: lower shares are tried while they raise the multiplier by little.
    """
    steps, best, merit = 0, None, EXACT_ENOUGH
    tried: set[int] = set()
    for threshold in thresholds:
        for share in shares:
            moving = path.point.rates > np.maximum(threshold, share * path.point.slack)
            if int(moving.sum()) in tried:
                continue
            tried.add(int(moving.sum()))
            state, spent = state_of_mechanism(problem, newton, path.point.velocities, moving)
            steps += spent
            if state is None or residuals(problem, state)["equilibrium"] > EXACT_ENOUGH:
                break
            for candidate in (state, _at_rest_elsewhere(problem, newton, state)):
                size = max(residuals(problem, candidate).values())
                if size < merit and (best is None or candidate.multiplier < best.multiplier * (1.0 + WORTH)):
                    best, merit = candidate, size
            if merit < EXACT:
                return best, steps
        if best is not None:
            break
    return best, steps


def _at_rest_elsewhere(problem: Problem, newton: NewtonMatrix, state: CollapseState) -> CollapseState:
    try:
        return replace(state, velocities=exact_mechanism(problem, newton, state.velocities, state.moving, False))
    except NumericalFailure:
        return state


def lagged_state(
    problem: Problem, newton: NewtonMatrix, attempts: tuple[tuple[int, float], ...] = ATTEMPTS
) -> tuple[CollapseState | None, int, float]:
    """The exact state at the end of a path with lagged friction bounds, the Newton steps spent, the gap at the end."""
    steps, gap = 0, float("inf")
    state: CollapseState | None = None
    for count, follow in attempts:
        try:
            path, spent = lagged_mechanism(problem, newton, count, follow)
        except NumericalFailure:
            continue
        state, more = mechanism_states(problem, newton, path, (0.0, 1e-9))
        steps, gap = steps + spent + more, path.gap
        if state is not None:
            break
    return state, steps, gap


@dataclass
class LargeSearch:
    """What the search of a large wall found and spent.

    Attributes:
        states: exact collapse states in the order found.
        seconds: CPU time of the process when each was found [s].
        steps: Newton steps.
        gap: relative gap at the end of the path that led to the last state, or of the last path.
    """

    states: list[CollapseState] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    steps: int = 0
    gap: float = float("inf")

    def add(self, state: CollapseState | None, steps: int, gap: float) -> None:
        """Count an attempt and keep its state if it led to one."""
        self.steps, self.gap = self.steps + steps, gap
        if state is not None:
            self.states.append(state)
            self.seconds.append(time.process_time())


def central_search(found: LargeSearch, problem: Problem, newton: NewtonMatrix, seed: int) -> None:
    """Add the state at the end of Newton's path of the wall with smoother unloaded joints: the soonest, if there is."""
    guide = smoothed(problem, SMOOTH[0]) if problem.n_interfaces <= MOST_INTERFACES else None
    if guide is not None:
        found.add(*_path_state(problem, guide, newton, seed))


def large_search(
    found: LargeSearch, problem: Problem, newton: NewtonMatrix, seed: int, velocities: FloatArray | None
) -> None:
    """Add exact collapse states of a large wall to those found, which are kept where the time ends the search.

    First at the ends of further paths as in `central_search`, then along paths by arc length in the part that an
    associated mechanism with velocities (3n,), if one is known, moves. Where no forces fit those
    mechanisms, from the wall itself with lagged friction bounds, and from its own path.
    """
    whole = problem.n_interfaces <= MOST_INTERFACES
    for factor in SMOOTH[1:] if whole else ():
        if found.states and problem.n_interfaces > FEW_INTERFACES:
            break
        guide = smoothed(problem, factor)
        if guide is not None:
            found.add(*_path_state(problem, guide, newton, seed))
    if velocities is not None:
        _search_part(found, problem, newton, seed, velocities)
    if whole and not found.states and not problem.dilates:
        found.add(*lagged_state(problem, newton))
    if whole and not found.states:
        found.add(*_path_state(problem, problem, newton, seed))


def _search_part(found: LargeSearch, problem: Problem, newton: NewtonMatrix, seed: int, velocities: FloatArray) -> None:
    """Add the states that paths by arc length lead to in the part that moves."""
    region = moving_region(problem, velocities)
    blocks, before = region.problem.n_velocities // 3, found.steps
    for lead in FAR_LEADS if blocks > MANY else LEADS + FAR_LEADS:
        if found.states and (lead in FAR_LEADS or (found.steps - before) * blocks > ENOUGH):
            break
        with suppress(NumericalFailure):  # A matrix singular to rounding ends one lead, not the search.
            _follow_lead(found, lead, problem, newton, region, seed)


def _follow_lead(
    found: LargeSearch, lead: Lead, problem: Problem, newton: NewtonMatrix, region: Region, seed: int
) -> None:
    """Add what one path by arc length leads to."""
    guide = smoothed(region.problem, lead.smooth) or region.problem
    start, steps = feasible_pair(guide, region.newton, lead.gap)
    found.steps += steps
    if start is None:
        return
    arc = ArcPath(guide, region.newton, start, lead.spread)
    for gap in lead.gaps:
        path = arc.follow(gap, lead.most_steps)
        found.add(None, path.iterations, path.gap)
        if not path.converged:
            return
        mechanism = cheapest_mechanism(guide, region.newton, path.point.slack, np.random.default_rng(seed))
        state, steps = mechanism_states(region.problem, region.newton, mechanism, (0.0, 1e-9), SHARES[:1])
        found.steps += mechanism.iterations + steps
        if state is None:
            continue
        state, steps = mechanism_states(problem, newton, in_whole(problem, region, mechanism), (0.0, 1e-9))
        found.add(state, steps, path.gap)
        if state is not None:
            return


def _path_state(
    problem: Problem, guide: Problem, newton: NewtonMatrix, seed: int
) -> tuple[CollapseState | None, int, float]:
    """The exact state of the mechanism of least work at the end of a guide's path, the steps spent, the path's gap."""
    path = follow_path(guide, newton, start_point(guide), PATH)
    if path.gap > WIDEST_GAP:
        return None, path.iterations, path.gap
    mechanism = cheapest_mechanism(guide, newton, path.point.slack, np.random.default_rng(seed))
    state, spent = mechanism_states(problem, newton, mechanism, (0.0, 1e-9))
    return state, path.iterations + mechanism.iterations + spent, path.gap
