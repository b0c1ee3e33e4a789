"""Collapse states at the ends of the paths of springs, from contact forces that they carry as they stand.

The live load changes along the equilibrium path of the wall (`methods.springs`) until a mechanism moves without any
change of force: an exact collapse state under zero dilatancy, whatever the stiffness of the springs. Where a path goes
depends on the self-stress it starts with.

The forces of gravity on a wall without any, random vertices of statics of least weighted compression, and mixtures of
both with central forces lead to low states of walls of irregular blocks. Central paths end high there: they keep all
the self-stress that friction allows.

On the largest walls a point on the associated path somewhat before its end has forces within yield by a margin; with
the joints smooth that the dead load leaves unloaded, they lead to low states too. Where no forces fit the mechanisms
that the central path ends at, this path has both from the start.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from harness.model.assembly import FloatArray
from methods.la.continuation import smoothed
from methods.la.interior_point import PathSettings, follow_path, start_point
from methods.la.newton_matrix import NewtonMatrix
from methods.la.problem import Problem
from methods.la.search import LOWER, Search
from methods.la.state import CollapseState, moving_contacts
from methods.springs.continuation import Tracer
from methods.springs.equilibrium import Equilibrium, doubled, first_step, gravity_state
from methods.springs.factor import Factor, SingularTangent, make_factor
from methods.springs.jump import JUMPS, TURN, past_turn
from methods.springs.path_record import PathEnd, PathRecord
from methods.springs.plateau import finish
from methods.springs.preload import preloaded
from methods.springs.settings import GapSettings
from methods.springs.wall_model import WallModel, build_model

SAFE = PathSettings(dilatancy=1.0, gap=0.1, residual=1e-7)
"""Where the associated path is left. Full steps meet the equilibrium at a gap of half a percent or so."""
CERTIFICATE = 1e-12
"""Residual of a mechanism at which the path ends."""
MOST_KINKS = 5
"""Changes of state per gap point after which the path is given up."""
LIGHT_UP_TO = 2000
"""Interfaces up to which paths from little self-stress are tried whatever else is found.

That of gravity may jump, which may take thousands of factorisations.
"""
RATIOS = (0.5, 5.0, 50.0)
"""kt / kn of the paths, in turn; the first is that of `fe`."""
HEAVY = 3
"""Power of the exponential weights on compression: a few joints are to carry next to nothing."""
VERTEX = ((1.0, 0.0, 0.0),)
MIXTURES = ((0.9, 0.0, 0.1), (0.7, 0.0, 0.3), (0.24, 0.7, 0.06), (0.48, 0.4, 0.12))
"""Shares of a vertex, of gravity's forces and of central ones in those that a path starts from, in turn.

Pure vertices have many forces at zero or at the limit of friction, and on walls of hundreds of blocks their paths
seldom end; a tenth of central forces takes them off their limits.
"""
VERTICES_UP_TO = 200
"""Interfaces up to which the paths start from pure vertices.

Above, none is begun where gravity leads above what is known: that marks a wall of courses, and on none of ten of those
did a mixture lead to anything lower.
"""


@dataclass(frozen=True)
class PrestressedResult:
    """The collapse state at the end of the path, or None; Newton steps before it, kinks along it."""

    state: CollapseState | None
    steps: int
    kinks: int


@dataclass(frozen=True)
class Gravity:
    """What the dead load does to a wall with springs in its joints and no self-stress in them."""

    problem: Problem
    model: WallModel
    factor: Factor
    equilibrium: Equilibrium

    @property
    def falling(self) -> list[str]:
        """Names of the blocks that fall; none where there is equilibrium, or the search for it did not end."""
        motion = self.model.block_displacements(self.equilibrium.rate)
        return [] if self.equilibrium.found else self.model.moving_blocks(motion)

    @cached_property
    def forces(self) -> FloatArray | None:
        """The scaled contact forces (m, 3); None where no equilibrium is found."""
        model, found = self.model, self.equilibrium
        if not found.found:
            return None
        return model.end_forces(*model.forces(found.u, model.history, found.state)) / self.problem.unit_force


def gravity_of(problem: Problem) -> Gravity:
    """The springs under the dead load of a wall that stands by statics."""
    model = build_model(problem.assembly, GapSettings())
    factor = make_factor(model)
    return Gravity(problem, model, factor, gravity_state(model, factor))


def prestressed_state(problem: Problem, newton: NewtonMatrix) -> PrestressedResult:
    """The collapse state that safe forces of the wall lead to, or else, on a larger one, those of gravity.

    Args:
        problem: the scaled wall, which stands under its dead load and has a live load.
        newton: its Newton matrix.
    """
    guide = smoothed(problem, 0.0) or problem
    safe = follow_path(guide, newton, start_point(guide), SAFE)
    kinks = 0
    if safe.converged:
        forces = guide.forces_of_slacks(safe.point.slack)
        with suppress(SingularTangent):
            state, kinks = _collapse_state(problem, _from_forces(problem, forces, safe.point.multiplier, RATIOS[0]))
            if state is not None:
                return PrestressedResult(state, safe.iterations, kinks)
    if problem.n_interfaces > LIGHT_UP_TO:
        with suppress(SingularTangent):
            tracer = _from_gravity(gravity_of(problem))
            if tracer is not None:
                state, more = _collapse_state(problem, tracer)
                return PrestressedResult(state, safe.iterations, kinks + more)
    return PrestressedResult(None, safe.iterations, kinks)


def light_states(search: Search, gravity: Gravity, kinks: int) -> Iterator[CollapseState]:
    """Collapse states that forces with little self-stress lead to: those of gravity, then vertices or mixtures.

    No other forces that fit its mechanism made any of 611 such states on walls of irregular blocks lower.

    Args:
        search: of the wall, which stands under its dead load; its generator draws the vertices.
        gravity: what the dead load does to the wall.
        kinks: changes of state on all paths together after which no other is begun.
    """
    problem = search.problem
    spent = 0
    for k in range(1 + 2 * problem.n_interfaces):
        if spent >= kinks:
            break
        try:
            tracer = _from_mixture(search, gravity, k - 1) if k else _from_gravity(gravity)
            if tracer is None:
                continue
            state, passed = _collapse_state(problem, tracer, 0 if k else JUMPS)
        except SingularTangent:
            continue
        spent += passed
        if state is None:
            continue
        search.record(state.multiplier)
        yield state
        if k == 0 and state.multiplier > search.least + LOWER and problem.n_interfaces > VERTICES_UP_TO:
            return


def _from_mixture(search: Search, gravity: Gravity, k: int) -> Tracer | None:
    """The path from the k-th mixture of a random vertex of statics, gravity's and central forces.

    Returns:
        None where one of them is missing.
    """
    mixtures = VERTEX if search.problem.n_interfaces <= VERTICES_UP_TO else MIXTURES
    share, own, middle = mixtures[k % len(mixtures)]
    own_forces = gravity.forces if own else None
    central = search.central_forces if middle else None
    if (own and own_forces is None) or (middle and central is None):
        return None
    weights = search.generator.exponential(size=(search.problem.n_interfaces, 2)) ** HEAVY
    search.tally.programmes += 1
    vertex = search.static.lightest(weights)
    if vertex is None:
        return None
    forces = share * vertex
    if own_forces is not None:
        forces += own * own_forces
    if central is not None:
        forces += middle * central
    return _from_forces(search.problem, forces, 0.0, RATIOS[k % len(RATIOS)])


def _from_gravity(gravity: Gravity) -> Tracer | None:
    """The path from the forces that gravity causes in a wall without self-stress; None if there are none."""
    if not gravity.equilibrium.found:
        return None
    model, factor = gravity.model, gravity.factor
    first, multiplier = first_step(model, factor, gravity.equilibrium.u, model.history, gravity.problem.unit_multiplier)
    if not first.found:
        return None
    for answer, further in doubled(model, factor, first, multiplier, model.history):
        first, multiplier = answer, further
    return Tracer(model, factor, first.u, multiplier, model.history, first.state, certificate=CERTIFICATE)


def _from_forces(problem: Problem, forces: FloatArray, multiplier: float, ratio: float) -> Tracer:
    """The path from scaled forces (m, 3) in equilibrium with a scaled multiplier. Raises SingularTangent."""
    model = build_model(problem.assembly, GapSettings(stiffness_ratio=ratio))
    start = multiplier * problem.unit_multiplier, problem.to_forces(forces)
    return preloaded(model, make_factor(model), *start, CERTIFICATE)


def _collapse_state(problem: Problem, tracer: Tracer, jumps: int = 0) -> tuple[CollapseState | None, int]:
    """The collapse state at the end of a path, or None, also below a multiplier of zero; and the kinks on the way.

    Args:
        problem: the scaled wall; tracer: the beginning of the path.
        jumps: jumps tried where the path turns down.
    """
    record, model = PathRecord(), tracer.model
    turn = TURN if jumps else np.inf
    while (end := tracer.run(record, MOST_KINKS * model.n_points, turn=turn)) == PathEnd.TURNED_DOWN:
        tracer, turn = past_turn(tracer, record.peak, jumps)
        jumps -= 1
    found = finish(model, tracer.present(), tracer.kept) if end in (PathEnd.PLATEAU, PathEnd.BREAKDOWN) else None
    if found is None or found.multiplier < 0.0:
        return None, record.events
    velocities = problem.from_mechanism(found.mechanism)
    velocities *= problem.live_work / float(problem.live @ velocities)
    moving = moving_contacts(problem.rates_of_velocities(velocities, False))
    state = CollapseState(
        found.forces / problem.unit_force, found.multiplier / problem.unit_multiplier, velocities, moving
    )
    return state, record.events
