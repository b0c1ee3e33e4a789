"""Collapse states at the ends of the paths of springs, from contact forces that they carry as they stand.

The live load changes along the equilibrium path of the wall (`methods.springs`) until a mechanism moves without any
change of force: an exact collapse state under zero dilatancy, whatever the stiffness of the springs. Where a path goes
depends on the self-stress it starts with.

The forces of gravity on a wall without any, random vertices of statics of least weighted compression, and mixtures of
both with central forces lead to low states of walls of irregular blocks; so do friction histories that are committed on
the way from gravity. Central paths end high there: they keep all the self-stress that friction allows.

On the largest walls a point on the associated path somewhat before its end has forces within yield by a margin; with
the joints smooth that the dead load leaves unloaded, they lead to low states too. Where no forces fit the mechanisms
that the central path ends at, this path has both from the start.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from harness.model.assembly import FloatArray
from methods.la.continuation import smoothed
from methods.la.interior_point import PathSettings, follow_path, start_point
from methods.la.problem import Problem
from methods.la.search import LOWER, Search
from methods.la.state import CollapseState, moving_contacts
from methods.springs.continuation import Tracer
from methods.springs.equilibrium import doubled, first_step, gravity_state
from methods.springs.factor import Factor, SingularTangent, make_factor
from methods.springs.follow import follow
from methods.springs.jump import JUMPS
from methods.springs.newton import FALLING, Equilibrium
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
COMMITTED, SHARE = (0.5, 0.2, 0.05), 2e-3
"""kt / kn of paths from gravity with commits, and the share of the least known multiplier between two of them."""
SHARES = (3e-3, 1e-3)
"""Such shares for paths from central forces."""
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

Above, none is begun on walls of right-angled joints where gravity leads above what is known: on none of ten walls of
courses, nor of 25 of rectangular stones of many sizes, did one lead to anything lower. Gravity is no such sign where
joints have many directions.
"""
RIGHT = 1e-6
"""Sine of the angle by which joints may be off the right one."""


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
        return [] if self.equilibrium.found else self.model.moving_blocks(motion, FALLING)

    @cached_property
    def forces(self) -> FloatArray | None:
        """The scaled contact forces (m, 3); None where no equilibrium is found."""
        model, found = self.model, self.equilibrium
        if not found.found:
            return None
        return model.end_forces(*model.forces(found.u, found.history, found.state)) / self.problem.unit_force


@dataclass(frozen=True)
class Beginning:
    """The beginning of a path, the jumps tried where it turns down, and the multiplier between two commits."""

    tracer: Tracer
    jumps: int = 0
    interval: float = np.inf


Start = Callable[[], Beginning | None]
"""Makes the beginning of a path where that is possible. Raises SingularTangent."""


def gravity_of(problem: Problem, ratio: float = RATIOS[0]) -> Gravity:
    """The springs under the dead load of a wall that stands by statics, with kt/kn = ratio."""
    model = build_model(problem.assembly, GapSettings(stiffness_ratio=ratio))
    factor = make_factor(model)
    return Gravity(problem, model, factor, gravity_state(model, factor))


def light_states(search: Search, gravity: Gravity, kinks: int, greatest: float = np.inf) -> Iterator[CollapseState]:
    """Collapse states that forces with little self-stress lead to: gravity's, then vertices or mixtures.

    On walls of many interfaces those of gravity with committed histories come between.

    No other forces that fit its mechanism made any of 611 such states on walls of irregular blocks lower.

    Args:
        search: of the wall, which stands under its dead load; its generator draws the vertices.
        gravity: what the dead load does to the wall.
        kinks: changes of state on all paths together after which no other is begun.
        greatest: multiplier (scaled) that no collapse state is above.
    """
    problem = search.problem
    for k, state in _ends(search, _light_starts(search, gravity, greatest), kinks):
        yield state
        above = k == 0 and state.multiplier > search.least + LOWER
        if above and problem.n_interfaces > VERTICES_UP_TO and _right_angled(problem):
            return


def _light_starts(search: Search, gravity: Gravity, greatest: float) -> Iterator[Start]:
    yield partial(_from_gravity, gravity, search.problem.unit_multiplier)
    if search.problem.n_interfaces > VERTICES_UP_TO:
        yield from _committed(search, greatest)
    for k in range(2 * search.problem.n_interfaces):
        yield partial(_from_mixture, search, gravity, k)


def last_states(search: Search, greatest: float, kinks: int) -> Iterator[CollapseState]:
    """Collapse states of a large wall to which nothing else led: from central forces, and gravity's.

    Args:
        search: of the wall, which stands under its dead load.
        greatest: multiplier (scaled) that no collapse state is above.
        kinks: changes of state on all paths together after which no other is begun.
    """
    yield from (state for _, state in _ends(search, _last_starts(search, greatest), kinks))


def first_state(search: Search, kinks: int) -> CollapseState | None:
    """The collapse state that safe forces of a large wall lead to, where its central path led to none."""
    return next((state for _, state in _ends(search, iter([partial(_from_safe_forces, search)]), kinks)), None)


def _last_starts(search: Search, greatest: float) -> Iterator[Start]:
    yield partial(_from_central_forces, search, RATIOS[0])
    if search.problem.n_interfaces > LIGHT_UP_TO:
        yield from _committed(search, greatest)
    for share in SHARES:
        yield partial(_from_central_forces, search, RATIOS[0], share, greatest)
    for ratio in RATIOS[1:]:
        yield partial(_from_central_forces, search, ratio)


def _ends(search: Search, starts: Iterator[Start], kinks: int) -> Iterator[tuple[int, CollapseState]]:
    """The number of each start whose path ends in a collapse state, and the state."""
    most = search.tally.kinks + kinks
    for k, start in enumerate(starts):
        if search.tally.kinks >= most:
            return
        state = None
        with suppress(SingularTangent):
            beginning = start()
            state = None if beginning is None else _collapse_state(search, beginning)
        if state is not None:
            search.record(state)
            yield k, state


def _right_angled(problem: Problem) -> bool:
    """Whether all joints are parallel or at right angles to each other."""
    assembly = problem.assembly
    first = assembly.tangent[0]
    off = np.minimum(abs(assembly.tangent @ first), abs(assembly.normal @ first))
    return bool(off.max() < RIGHT)


def _from_mixture(search: Search, gravity: Gravity, k: int) -> Beginning | None:
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


def _from_gravity(gravity: Gravity, scale: float, interval: float = np.inf) -> Beginning | None:
    """The path from the forces that gravity causes in a wall without self-stress; None if there are none.

    Args:
        gravity: what the dead load does; scale: a multiplier of the order of collapse.
        interval: multiplier between two commits of the history.
    """
    if not gravity.equilibrium.found:
        return None
    model, factor = gravity.model, gravity.factor
    first = first_step(model, factor, gravity.equilibrium, scale)
    if not first.found:
        return None
    if interval == np.inf:
        for further in doubled(model, factor, first):
            first = further
    tracer = Tracer.from_rest(model, factor, first, CERTIFICATE)
    return Beginning(tracer, JUMPS, interval)


def _committed(search: Search, greatest: float) -> Iterator[Start]:
    for ratio in COMMITTED:
        yield partial(_from_gravity_committed, search, ratio, greatest)


def _from_gravity_committed(search: Search, ratio: float, greatest: float) -> Beginning | None:
    """The path from gravity's forces with kt/kn = ratio, with a commit every SHARE of the least multiplier known.

    Returns:
        None where gravity finds no equilibrium, or neither a state nor the greatest multiplier is known.
    """
    least = _least(search, greatest)
    return _from_gravity(gravity_of(search.problem, ratio), least, SHARE * least) if 0.0 < least < np.inf else None


def _least(search: Search, greatest: float) -> float:
    """The least multiplier known, or else the greatest that there may be."""
    return min(search.least, greatest) * search.problem.unit_multiplier


def _from_safe_forces(search: Search) -> Beginning | None:
    """The path from forces somewhat before the end of the associated one of the wall with smooth unloaded joints."""
    guide = smoothed(search.problem, 0.0) or search.problem
    safe = follow_path(guide, search.newton, start_point(guide), SAFE)
    search.tally.newton_steps += safe.iterations
    if not safe.converged:
        return None
    forces = guide.forces_of_slacks(safe.point.slack)
    return _from_forces(search.problem, forces, safe.point.multiplier, RATIOS[0])


def _from_central_forces(
    search: Search, ratio: float, share: float = np.inf, greatest: float = np.inf
) -> Beginning | None:
    """The path from forces well within yield under the dead load, with commits as from gravity if any."""
    forces = search.central_forces
    if forces is None:
        return None
    beginning = _from_forces(search.problem, forces, 0.0, ratio)
    if share == np.inf:
        return beginning
    return replace(beginning, jumps=JUMPS, interval=share * _least(search, greatest))


def _from_forces(problem: Problem, forces: FloatArray, multiplier: float, ratio: float) -> Beginning:
    """The path from scaled forces (m, 3) in equilibrium with a scaled multiplier. Raises SingularTangent."""
    model = build_model(problem.assembly, GapSettings(stiffness_ratio=ratio))
    start = multiplier * problem.unit_multiplier, problem.to_forces(forces)
    return Beginning(preloaded(model, make_factor(model), *start, CERTIFICATE))


def _collapse_state(search: Search, beginning: Beginning) -> CollapseState | None:
    """The collapse state at the end of a path; None also below a multiplier of zero."""
    problem, record, model = search.problem, PathRecord(), beginning.tracer.model
    most = MOST_KINKS * model.n_points
    try:
        way = follow(beginning.tracer, record, most, beginning.interval, jumps=beginning.jumps)
    finally:
        search.tally.kinks += record.events
    last = way.tracer
    found = finish(model, last.present(), last.kept) if way.end in (PathEnd.PLATEAU, PathEnd.BREAKDOWN) else None
    if found is None or found.multiplier < 0.0:
        return None
    velocities = problem.from_mechanism(found.mechanism)
    velocities *= problem.live_work / float(problem.live @ velocities)
    moving = moving_contacts(problem.rates_of_velocities(velocities, False))
    return CollapseState(
        found.forces / problem.unit_force, found.multiplier / problem.unit_multiplier, velocities, moving
    )
