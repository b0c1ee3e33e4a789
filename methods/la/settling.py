"""Supports that move until no admissible state is left, or a collapse that goes on: limit analysis on updated geometry.

At every displacement d of the supports the least reaction and the mechanism dual to it are found (`core/reaction`) in
the wall as it stands then, whose opened joints are pins. The wall follows that mechanism by finite rotations about its
pins; it is the wall's own linkage, so the points that meet are brought together exactly after each step. Where the
forces that the pins leave no longer lie within yield, no admissible state is left: the wall falls, and a dilatant
mechanism with the supports at rest proves it. A joint that closes again bears again. A mechanism that slides is not
followed: dilatant slip, which the programme has, would lift a wall that really does not lift.

Sources: Portioli and Cascini (2017); Iannuzzo et al. (2020).

In `with_multiplier` the live load takes the place of the support: the collapse goes on, and the greatest multiplier and
its dual mechanism are found again on the way, until the wall falls under its dead load. Mechanisms that slide are not
followed, so that the flow does not matter beyond the first state.

Sources: Heyman (1995) on rocking blocks; Makris and Vassiliou (2013) on the portal.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import BoolArray, FloatArray
from harness.model.deadline import Deadline
from harness.model.result import fastest_vertex
from methods.la.core.problem import make_problem
from methods.la.core.reaction import extreme_reaction
from methods.la.core.vertex_programmes import force_programme
from methods.la.moved_wall import MovedWall
from methods.la.settings import ClosureTolerances, SettlingSteps
from methods.numerics.linear_programme import INFINITY, Programme

FALLS, CLOSES, PARTS, STUCK = "falls", "closes", "parts", "stuck"


_WHY = {
    PARTS: "From there on its joints cannot all meet without sliding.",
    STUCK: "From there on no multiplier of the live load is in equilibrium with these open joints: others would open.",
}
"""Why a wall was followed no further."""


@dataclass(frozen=True, eq=False)
class _StandingState:
    """A wall that has moved, and how it would move on.

    Attributes:
        wall: where its blocks are.
        value: the least reaction of moving supports there, or the collapse multiplier where they rest.
        forces: (m, 3) contact forces [force]; mechanism: (n, 3) motion of all blocks.
    """

    wall: MovedWall
    value: float
    forces: FloatArray
    mechanism: FloatArray


StateOf = Callable[[MovedWall], _StandingState | str]
"""The state of a wall where it is, or a word for why there is none; `STUCK` where that is no fall."""


@dataclass(frozen=True, eq=False)
class SettledUntil:
    """How far supports can move. k points.

    Attributes:
        points: (k,) states on the way, the last with the largest displacement at which the wall stands.
        fall: the wall at a displacement a hair larger, at which it falls, or None.
        mechanism: (n, 3) dilatant motion that proves the fall, supports at rest; None without one.
        reason: why the wall was followed no further; empty where it falls.
    """

    points: tuple[_StandingState, ...]
    fall: MovedWall | None
    mechanism: FloatArray | None
    reason: str


def _with_least_reaction(wall: MovedWall) -> _StandingState | str:
    """The least reaction of a wall as it stands, or how the programme ended."""
    found = extreme_reaction(wall.assembly, greatest=False, parted=~wall.closed)
    return found if isinstance(found, str) else _StandingState(wall, found.reaction, found.forces, found.mechanism)


def settle(
    start: MovedWall, steps: SettlingSteps = SettlingSteps(), state_of: StateOf = _with_least_reaction
) -> SettledUntil | str:
    """Move the wall along its mechanisms until it falls; or how the first programme ended without a solution.

    Args:
        start: where the wall begins, as `MovedWall.at_rest` of an assembly; dry joints, no bars, loads through the
            centroids.
        steps: of the displacement.
        state_of: how it would move on from where it is; by default as its supports prescribe, which must strain joints.
    """
    now, assembly = state_of(start), start.drawn
    if isinstance(now, str):
        return now
    size = assembly.length_scale / (fastest_vertex(assembly, assembly.support_motion) or 1.0)
    farthest = start.displacement + steps.far * size
    deadline, step, points = Deadline.of_run(), steps.first * size, [now]
    for _ in range(steps.most):
        deadline.ask()
        held, sliding = _held(now, steps.moves)
        if sliding:
            return SettledUntil(
                tuple(points), None, None, f"From there on the joint between {sliding} slides, which is not followed."
            )
        left = farthest - now.wall.displacement
        if not left > steps.width * size:
            return SettledUntil(tuple(points), None, None, "It stands as far as it was followed.")
        before = now.wall
        length = min(step, left) if _turns(now, steps.moves) else left
        now, failure = _advanced(now, length, held, steps.width * size, steps.closure, state_of)
        if now.wall.displacement > points[-1].wall.displacement:
            points.append(now)
        if failure is None:
            step = min(steps.longer * step, steps.longest * size)
        elif failure.kind == CLOSES:
            closed = now.wall.closed | (failure.wall.gaps < 0.0)
            if now.wall is before and np.array_equal(closed, before.closed):
                return SettledUntil(tuple(points), None, None, "From there on a joint opens and closes again at once.")
            again = state_of(replace(now.wall, closed=closed))
            if isinstance(again, str):
                return SettledUntil(tuple(points), None, None, f"Where a joint closes the programme is {again}.")
            now = again
        elif failure.kind == FALLS:
            return _fallen(points, failure, held, steps)
        else:
            return SettledUntil(tuple(points), None, None, _WHY[failure.kind])
    return SettledUntil(tuple(points), None, None, f"It stands after {steps.most} steps.")


@dataclass(frozen=True, eq=False)
class _Failure:
    """Why a step is too long: no admissible state is left, a joint has closed, pins cannot meet, or no load balances.

    Attributes:
        kind: of these four; wall: after the step, before it where pins cannot meet.
        start: where the step begins; step: its length.
    """

    kind: str
    wall: MovedWall
    start: _StandingState
    step: float


def _held(now: _StandingState, moves: float) -> tuple[BoolArray, str]:
    """(m, 2) ends of joints that go on to meet, and the blocks of one that slides under force or touching, if any."""
    assembly, mechanism = now.wall.assembly, now.mechanism
    rates = (assembly.kinematic_matrix @ mechanism[assembly.free].ravel()).reshape(-1, 3) + assembly.support_strains
    least = moves * fastest_vertex(assembly, mechanism)
    held = now.wall.closed & (rates[:, :2] <= least)
    pressed = now.forces[:, :2].sum(axis=1) > moves * assembly.force_scale / assembly.n_free
    slides = np.flatnonzero((pressed | held.any(axis=1)) & (abs(rates[:, 2]) > least))
    if not len(slides):
        return held, ""
    joint = slides[np.argmax(abs(rates[slides, 2]))]
    return held, " and ".join(assembly.block_ids[side[joint]] for side in (assembly.block_a, assembly.block_b))


def _turns(now: _StandingState, moves: float) -> bool:
    """Whether a block turns: if none does, no joint that bears is strained; the state stays until one closes."""
    assembly, mechanism = now.wall.assembly, now.mechanism
    turning = float(abs(mechanism[:, 2]).max()) * assembly.length_scale
    return turning > moves * fastest_vertex(assembly, mechanism)


def _tried(
    now: _StandingState, step: float, held: BoolArray, closure: ClosureTolerances, state_of: StateOf
) -> _StandingState | _Failure:
    """The wall after a step, or why the step is too long."""
    wall = now.wall.moved(now.mechanism, step, held, closure)
    if wall is None:
        return _Failure(PARTS, now.wall, now, step)
    if bool((wall.gaps[~held] < -closure.distance * wall.drawn.length_scale).any()):
        return _Failure(CLOSES, wall, now, step)
    found = state_of(wall)
    if isinstance(found, str):
        return _Failure(STUCK if found == STUCK else FALLS, wall, now, step)
    return found


def _advanced(
    now: _StandingState, step: float, held: BoolArray, width: float, closure: ClosureTolerances, state_of: StateOf
) -> tuple[_StandingState, _Failure | None]:
    """The wall after a step; or, where that is too long, after the longest that is not, with why it is the longest."""
    found = _tried(now, step, held, closure, state_of)
    if isinstance(found, _StandingState):
        return found, None
    best, low, high = now, 0.0, found
    while high.step - low > width:
        middle = _tried(now, 0.5 * (low + high.step), held, closure, state_of)
        if isinstance(middle, _StandingState):
            best, low = middle, middle.wall.displacement - now.wall.displacement
        else:
            high = middle
    return best, high


def _fallen(points: list[_StandingState], failure: _Failure, held: BoolArray, steps: SettlingSteps) -> SettledUntil:
    """The end of a wall that falls, at the least displacement beyond its last at which a mechanism proves it.

    The programme may find no forces a hair before a mechanism does work beyond rounding.
    """
    width = steps.width * failure.start.wall.drawn.length_scale
    for further in (0.0, *(width * 10.0**k for k in range(steps.proofs))):
        wall = failure.start.wall.moved(failure.start.mechanism, failure.step + further, held, steps.closure)
        mechanism = None if wall is None else _falling(wall, steps.immense)
        if mechanism is not None:
            return SettledUntil(tuple(points), wall, mechanism, "")
    return SettledUntil(tuple(points), None, None, "From there on no forces are found, and no mechanism proves a fall.")


def _falling(wall: MovedWall, immense: float) -> FloatArray | None:
    """(n, 3) dilatant mechanism on which the dead load does most work while the supports rest, or None.

    Speeds lie between -1 and 1. Rounding leaves closings, on which forces would have to be immense to undo the work.
    """
    assembly = wall.assembly
    problem = make_problem(assembly)
    strains = problem.kinematic.tocsr()
    slip = sp.diags(assembly.friction) @ strains[2::3]
    ends = [strains[k::3][wall.closed[:, k]] + way * slip[wall.closed[:, k]] for k in (0, 1) for way in (1.0, -1.0)]
    flow = sp.vstack(ends).tocsc()
    count, rows = flow.shape[1], flow.shape[0]
    programme = Programme(
        flow, -problem.dead, (np.full(count, -1.0), np.ones(count)), (np.zeros(rows), np.full(rows, INFINITY))
    )
    if programme.run()[0] != "optimal":
        return None
    vertex = programme.vertex()
    if vertex is None:
        return None
    velocities = vertex.value[:count]
    closings = -float(np.minimum(flow @ velocities, 0.0).sum())
    units = np.finfo(float).eps * np.maximum(assembly.friction, 1.0)[:, None] * wall.closed
    rounding = 0.5 * float(units.sum()) + float(units.max(initial=0.0))
    if not float(problem.dead @ velocities) > immense * assembly.n_free * max(closings, rounding):
        return None
    mechanism = np.zeros((assembly.n_blocks, 3))
    mechanism[assembly.free] = problem.velocities_of_blocks(velocities)
    return mechanism


def with_multiplier(wall: MovedWall) -> _StandingState | str:
    """The greatest multiplier of a wall as it stands, and its mechanism with a fastest vertex of speed one.

    Returns:
        The state; `FALLS` where its multiplier is below zero; `STUCK` where it has moved and no multiplier balances it;
        or how the programme of the wall as drawn ended.
    """
    assembly = wall.assembly
    problem = make_problem(assembly)
    tight = np.zeros((assembly.n_interfaces, 4), dtype=bool)
    tight[:, :2] = ~wall.closed
    found = force_programme(problem).extreme(greatest=True, tight=tight)
    if isinstance(found, str):
        return STUCK if np.any(wall.places) else found
    multiplier = problem.to_multiplier(found.statics.multiplier)
    if multiplier < 0.0:
        return FALLS
    mechanism = np.zeros((assembly.n_blocks, 3))
    mechanism[assembly.free] = problem.velocities_of_blocks(found.kinematics.velocities)
    return _StandingState(
        wall, multiplier, problem.to_forces(found.statics.forces), mechanism / fastest_vertex(assembly, mechanism)
    )
