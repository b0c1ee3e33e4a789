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
from dataclasses import dataclass, field, replace
from functools import partial
from typing import ClassVar

import numpy as np

from harness.model.assembly import FloatArray
from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState, moving_contacts
from methods.la.interior.interior_point import PathSettings, follow_path, start_point
from methods.la.sources.arcs import ArcPaths
from methods.la.sources.dilatancy_continuation import DilatancyContinuation
from methods.la.sources.friction_continuation import with_reduced_friction
from methods.la.sources.gravity import Gravity
from methods.la.sources.record import LEAST_IMPROVEMENT
from methods.la.sources.search import Search
from methods.springs.model.factor import SingularTangent, make_factor
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import build_model
from methods.springs.path.continuation import PathFollower
from methods.springs.path.load_path import follow
from methods.springs.path.path_record import PathEnd, PathRecord
from methods.springs.path.plateau import finish
from methods.springs.rest.equilibrium import doubled, first_step

_CERTIFICATE = 1e-12
"""Residual of a mechanism at which a path ends."""
_MOST_BREAKPOINTS = 5
"""Changes of state per gap point after which one is given up."""
_RIGHT = 1e-6
"""Sine of the angle by which right-angled joints may be off."""


@dataclass(frozen=True)
class _PathStart:
    """The beginning of a path, the jumps tried where it turns down, and the multiplier between two commits."""

    follower: PathFollower
    jumps: int = 0
    interval: float = np.inf


Start = Callable[[], _PathStart | None]
"""Makes the beginning of a path where that is possible. Raises SingularTangent."""


@dataclass(frozen=True)
class CommittedHistories:
    """Paths from gravity on which the friction history is committed, as in `fe`'s histories.

    Attributes:
        ratios: kt / kn, one path each.
        share: of the least multiplier known between two commits.
    """

    ratios: tuple[float, ...] = (0.5, 0.2, 0.05)
    share: float = 2e-3

    def starts(self, search: Search) -> Iterator[Start]:
        """The beginnings of the paths."""
        for ratio in self.ratios:
            yield partial(self._from_gravity, search, ratio)

    def _from_gravity(self, search: Search, ratio: float) -> _PathStart | None:
        """The path with kt/kn = ratio; None without equilibrium, or where no multiplier is known to measure commits."""
        least = _scale(search)
        gravity = Gravity.of(search.problem, ratio)
        return _from_gravity(search, gravity, least, self.share * least) if 0.0 < least < np.inf else None


@dataclass(frozen=True)
class LowPrestress:
    """Paths from forces with little self-stress: gravity's, then vertices or mixtures of statics.

    On walls of many interfaces those of gravity with updated plastic slip come between; on larger ones the path from
    forces well within yield comes first, and gravity's where it ends without a state: with many joints at the limit of
    friction from the beginning that has more events. On small walls whose joints are
    all parallel or at right angles gravity's is the only one: central paths with other block weights lead lower there,
    in less time. docs/notes/limit-analysis.md gives the evidence for this and for the limits below.

    Attributes:
        least, most: interfaces between which it is tried; above 6,000 the path of gravity takes minutes.
        vertices_up_to: interfaces up to which paths start from pure vertices, and walls of right-angled joints have
            gravity's path alone. Above, such walls have no other where that ends above the least known state; gravity
            is no such sign where joints have many directions.
        one_path: interfaces above which one path with a state is enough, because updated histories need many
            breakpoints and gain little; and none is followed on walls of right-angled joints where paths by arc length
            led to states, which are lower.
        vertex: shares of a vertex, of gravity's forces and of central ones up to there.
        mixtures: above, in turn. Pure vertices have many forces at zero or at the limit of friction, and on walls of
            hundreds of blocks their paths seldom end; a tenth of central forces takes them off their limits.
        heavy: power of the exponential weights on compression: a few joints are to carry next to nothing.
    """

    name: ClassVar[str] = "springs with low prestress"
    least: int = 0
    most: int = 6000
    vertices_up_to: int = 200
    one_path: int = 2000
    committed: CommittedHistories = CommittedHistories()
    vertex: tuple[tuple[float, float, float], ...] = ((1.0, 0.0, 0.0),)
    mixtures: tuple[tuple[float, float, float], ...] = (
        (0.9, 0.0, 0.1),
        (0.7, 0.0, 0.3),
        (0.24, 0.7, 0.06),
        (0.48, 0.4, 0.12),
    )
    heavy: int = 3

    def applies(self, problem: Problem) -> bool:
        """On joints that slide without lifting; with strength, ties or props from gravity's forces alone."""
        return self.least <= problem.n_interfaces <= self.most and not problem.dilates

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state a path that ends, until the breakpoints are spent."""
        problem, known = search.problem, search.record.least
        right_angled = _right_angled(problem, _RIGHT)
        if right_angled and problem.n_interfaces > self.one_path and search.record.led_to_state(ArcPaths.name):
            return
        small = problem.n_interfaces <= self.vertices_up_to
        for k, state in _ends(search, self._starts(search)):
            yield state
            if problem.n_interfaces > self.one_path:
                return
            if k == 0 and right_angled and (small or state.multiplier > known + LEAST_IMPROVEMENT):
                return

    def _starts(self, search: Search) -> Iterator[Start]:
        problem = search.problem
        if problem.n_interfaces > self.one_path and problem.law.is_cone:
            yield partial(_from_central_forces, search, search.choices.spring_ratios[0])
        yield from FromGravity().starts(search)
        if problem.n_interfaces > self.one_path or not problem.law.is_cone:
            return
        if problem.n_interfaces > self.vertices_up_to:
            yield from self.committed.starts(search)
        for k in range(2 * problem.n_interfaces):
            yield partial(self._from_mixture, search, k)

    def _from_mixture(self, search: Search, k: int) -> _PathStart | None:
        """The path from the k-th mixture of a random vertex of statics, gravity's and central forces.

        Returns:
            None where one of them is missing.
        """
        interfaces = search.problem.n_interfaces
        mixtures = self.vertex if interfaces <= self.vertices_up_to else self.mixtures
        share, own, middle = mixtures[k % len(mixtures)]
        own_forces = search.gravity.forces if own else None
        central = search.central_forces if middle else None
        if (own and own_forces is None) or (middle and central is None):
            return None
        weights = search.generator.exponential(size=(interfaces, 2)) ** self.heavy
        search.budget.spent.programmes += 1
        vertex = search.static.lightest(weights)
        if vertex is None:
            return None
        forces = share * vertex
        if own_forces is not None:
            forces += own * own_forces
        if central is not None:
            forces += middle * central
        ratios = search.choices.spring_ratios
        return _from_forces(search, forces, 0.0, ratios[k % len(ratios)])


@dataclass(frozen=True)
class FromGravity:
    """The path from gravity's forces alone.

    Attributes:
        most: interfaces up to which it is followed.
    """

    name: ClassVar[str] = "springs from gravity"
    most: int = 200

    def applies(self, problem: Problem) -> bool:
        """On joints that slide without lifting."""
        return problem.n_interfaces <= self.most and not problem.dilates

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state, if the path ends in one."""
        yield from (state for _, state in _ends(search, self.starts(search)))

    def starts(self, search: Search) -> Iterator[Start]:
        """The beginning of the path."""
        yield partial(_from_gravity, search, search.gravity, search.problem.unit_multiplier)


@dataclass(frozen=True)
class ShiftedAssociated:
    """The path from forces somewhat before the end of the associated one, where no state is known yet.

    Attributes:
        left: where the associated path is left; full steps meet the equilibrium at a gap of half a percent or so.
    """

    name: ClassVar[str] = "springs from shifted associated forces"
    left: PathSettings = field(default_factory=lambda: PathSettings(dilatancy=1.0, gap=0.1, residual=1e-7))

    def applies(self, problem: Problem) -> bool:
        """On dry joints that slide without lifting, as springs do."""
        return not problem.dilates and problem.law.is_cone

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state at most; none where statics allows any load."""
        if not (search.record.known or search.associated.outcome == "unbounded"):
            yield from (state for _, state in _ends(search, iter([partial(self._start, search)])))

    def _start(self, search: Search) -> _PathStart | None:
        """From the wall with smooth unloaded joints, if it has any."""
        guide = with_reduced_friction(search.problem, 0.0) or search.problem
        safe = follow_path(guide, search.newton, start_point(guide), self.left)
        search.stepped(safe.iterations)
        if not safe.converged:
            return None
        forces = guide.forces_of_slacks(safe.point.slack)
        return _from_forces(search, forces, safe.point.multiplier, search.choices.spring_ratios[0])


@dataclass(frozen=True)
class AnalyticCentre:
    """Paths from forces well within yield under the dead load, and gravity's, where nothing else led to a low state.

    Attributes:
        shares: of the least multiplier known between two commits, one path each.
        gravity_above: interfaces above which gravity's committed histories are tried here, as nowhere else.
        lower_up_to: interfaces up to which they are followed though the dilatancy continuation led to a state; above,
            a path takes minutes.
    """

    name: ClassVar[str] = "springs from the analytic centre"
    shares: tuple[float, ...] = (3e-3, 1e-3)
    gravity_above: int = 2000
    lower_up_to: int = 6000
    committed: CommittedHistories = CommittedHistories()

    def applies(self, problem: Problem) -> bool:
        """On dry joints that slide without lifting, as springs do."""
        return not problem.dilates and problem.law.is_cone

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state a path that ends; none where statics allows any load.

        States of the dilatancy continuation are higher than those of springs by up to a hundredth.
        """
        lower = search.problem.n_interfaces <= self.lower_up_to
        known = search.record.led_to_state_but(DilatancyContinuation.name) if lower else search.record.known
        if not (known or search.associated.outcome == "unbounded"):
            yield from (state for _, state in _ends(search, self._starts(search)))

    def _starts(self, search: Search) -> Iterator[Start]:
        first, *others = search.choices.spring_ratios
        yield partial(_from_central_forces, search, first)
        if search.problem.n_interfaces > self.gravity_above:
            yield from self.committed.starts(search)
        for share in self.shares:
            yield partial(_from_central_forces, search, first, share)
        for ratio in others:
            yield partial(_from_central_forces, search, ratio)


def _ends(search: Search, starts: Iterator[Start]) -> Iterator[tuple[int, CollapseState]]:
    """The number of each start whose path ends in a collapse state, and the state, while there are breakpoints left."""
    for k, start in enumerate(starts):
        if not search.budget.breakpoints_left(search.record.known):
            return
        state = None
        with suppress(SingularTangent):
            path_start = start()
            state = None if path_start is None else _collapse_state(search, path_start)
        if state is not None:
            yield k, search.lowered(state)


def _right_angled(problem: Problem, sine: float) -> bool:
    """Whether all joints are parallel or at right angles to each other, but for an angle of this sine."""
    assembly = problem.assembly
    first = assembly.tangent[0]
    off = np.minimum(abs(assembly.tangent @ first), abs(assembly.normal @ first))
    return bool(off.max() < sine)


def _from_gravity(search: Search, gravity: Gravity, scale: float, interval: float = np.inf) -> _PathStart | None:
    """The path from the forces that gravity causes in a wall without self-stress; None if there are none.

    Args:
        search: whose path it is.
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
    follower = PathFollower.from_rest(model, factor, first, _CERTIFICATE)
    return _PathStart(follower, model.options.jumps, interval)


def _scale(search: Search) -> float:
    """The least multiplier known, or else the greatest that there may be."""
    return min(search.record.least, search.associated.greatest) * search.problem.unit_multiplier


def _from_central_forces(search: Search, ratio: float, share: float = np.inf) -> _PathStart | None:
    """The path from forces well within yield under the dead load, with commits as from gravity if any."""
    forces = search.central_forces
    if forces is None:
        return None
    path_start = _from_forces(search, forces, 0.0, ratio)
    if share == np.inf:
        return path_start
    jumps = path_start.follower.options.jumps
    return replace(path_start, jumps=jumps, interval=share * _scale(search))


def _from_forces(search: Search, forces: FloatArray, multiplier: float, ratio: float) -> _PathStart:
    """The path from scaled forces (m, 3) in equilibrium with a scaled multiplier. Raises SingularTangent."""
    problem = search.problem
    model = build_model(problem.assembly, GapSettings(stiffness_ratio=ratio))
    start = multiplier * problem.unit_multiplier, problem.to_forces(forces)
    return _PathStart(PathFollower.from_forces(model, make_factor(model), *start, _CERTIFICATE))


def _collapse_state(search: Search, path_start: _PathStart) -> CollapseState | None:
    """The collapse state at the end of a path; None also below a multiplier of zero."""
    problem, record, model = search.problem, PathRecord(), path_start.follower.model
    most = _MOST_BREAKPOINTS * model.n_points
    try:
        way = follow(path_start.follower, record, most, path_start.interval, jumps=path_start.jumps)
    finally:
        search.budget.spent.breakpoints += record.events
    last = way.follower
    found = finish(model, last.present(), last.kept) if way.end in (PathEnd.PLATEAU, PathEnd.BREAKDOWN) else None
    if found is None or found.multiplier < 0.0:
        return None
    velocities = problem.from_mechanism(found.mechanism)
    velocities *= problem.live_work / float(problem.live @ velocities)
    moving = moving_contacts(problem.rates_of_velocities(velocities, False))
    return CollapseState(
        found.forces / problem.unit_force, found.multiplier / problem.unit_multiplier, velocities, moving
    )
