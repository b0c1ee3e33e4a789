"""The search for low collapse states: exact programme on a mechanism, ray descent; and what its sources meet.

Without loss of generality the mechanism is an extreme ray of {g >= 0, C u = E g}. For a mechanism that moves in the
contacts J the best multiplier is the linear programme lambda(J) = min lambda s.t. equilibrium, S r >= 0, y_J = 0.
Ray descent: at its solution draw another extreme mechanism among the contacts with y = 0, solve its programme, keep
it if lower. Every draw comes from a seeded generator, and effort is counted in programmes, never in seconds.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.core.programmes import KinematicProgramme, KinematicSolution, StaticProgramme
from methods.la.core.state import CollapseState, moving_contacts, residuals, tight_contacts
from methods.la.interior.associated import AssociatedResult, EndOfPath, solve_associated
from methods.la.interior.copies import path_ends
from methods.la.interior.interior_point import PathResult, PathSettings, follow_path, start_point
from methods.la.interior.interior_starting_point import phase_one_forces
from methods.la.interior.newton_step import Point
from methods.la.interior.path_programmes import Exactness, cheapest_mechanism, exact_state, state_of_mechanism
from methods.la.sources.budget import Budget, SearchLimits
from methods.la.sources.gravity import Gravity
from methods.la.sources.record import LEAST_IMPROVEMENT, Record
from methods.springs.model.points import GapSettings


@dataclass(frozen=True)
class Choices:
    """How a search solves its programmes, and when it trusts them.

    Attributes:
        vertices_up_to: interfaces up to which the mechanism nearest to a path, and its state, are vertices of HiGHS;
            above, the interior point solves both programmes, ten times sooner at 3,500.
        once_above: interfaces above which nothing descends from a multiplier that a descent ended at.
        gravity_up_to: interfaces up to which it is asked what falls without self-stress; above, that may take longer
            than the search.
        still: blocks slower than this share of the fastest count as still, when moving ones are joined.
        widest_gap: relative gap at the end of a path above which its slacks tell no mechanism.
        central: accuracy of the central path: its end only tells the mechanism.
        nearly_zero, small: scaled slacks that count as zero when a mechanism is sought near them, first and then.
        exactness: of states that are read from paths; associated: how that programme ends.
        spring_ratios: kt / kn of paths of springs from the same kind of forces, in turn; the first is that of `fe`,
            whose falls under the dead load are named beside the answer.
    """

    vertices_up_to: int = 1000
    once_above: int = 400
    gravity_up_to: int = 2000
    still: float = 1e-9
    widest_gap: float = 1e-2
    central: PathSettings = field(default_factory=lambda: PathSettings(gap=1e-7, residual=1e-6))
    nearly_zero: float = 1e-6
    small: float = 1e-3
    exactness: Exactness = Exactness()
    associated: EndOfPath = EndOfPath()
    spring_ratios: tuple[float, ...] = (GapSettings().stiffness_ratio, 5.0, 50.0)


class Search:
    """Everything that a wall's search shares: programmes, known mechanisms, budget, record.

    `known` holds the state of every mechanism tried, None where no forces fit it below the multiplier beside it;
    `ends` the multipliers at which descents ended; `associated` the programme of statics alone, once it is solved.

    Args:
        problem: the scaled wall; newton: its Newton matrix.
        seed: of all draws.
        budget: what may be spent.
        parent: a search of the same wall at another friction, whose draws, budget and choices this one shares.
        choices: how it solves its programmes.
    """

    def __init__(
        self,
        problem: Problem,
        newton: NewtonMatrix,
        seed: int = 0,
        budget: Budget | None = None,
        parent: Search | None = None,
        choices: Choices = Choices(),
    ) -> None:
        self.problem, self.newton = problem, newton
        self.seed: int = seed if parent is None else parent.seed
        self.parent = parent
        self.generator: np.random.Generator = np.random.default_rng(seed) if parent is None else parent.generator
        self.budget: Budget = (budget or Budget()) if parent is None else parent.budget
        self.choices: Choices = choices if parent is None else parent.choices
        self.record = Record()
        self.known: dict[bytes, tuple[CollapseState | None, float]] = {}
        self.ends: list[float] = []
        self.associated = AssociatedResult("unknown")

    def begin_round(self, limits: SearchLimits) -> None:
        """Go on with other limits; more draws may lead down from where a descent ended."""
        self.budget.limits = limits
        self.ends.clear()

    def varied(self, problem: Problem) -> Search:
        """A search of the same wall with other friction coefficients or weights, which serves this one."""
        return Search(problem, self.newton, parent=self)

    @cached_property
    def static(self) -> StaticProgramme:
        """The programme of the forces that fit a mechanism."""
        return StaticProgramme(self.problem)

    @cached_property
    def kinematic(self) -> KinematicProgramme:
        """The programme of mechanisms, which friction does not change."""
        return KinematicProgramme(self.problem) if self.parent is None else self.parent.kinematic

    @cached_property
    def gravity(self) -> Gravity:
        """What the dead load does to the wall with springs in its joints and no self-stress in them."""
        return Gravity.of(self.problem, self.choices.spring_ratios[0])

    @cached_property
    def central_forces(self) -> FloatArray | None:
        """Forces (m, 3) well within yield under the dead load; None if none are found."""
        return phase_one_forces(self.problem, self.newton)

    def finds_motion(self) -> bool:
        """Whether the wall has any mechanism on which the live load does work, whatever its forces.

        It is taken to have one where it is too large for a vertex.
        """
        if self.problem.n_interfaces > self.choices.vertices_up_to:
            return True
        shape = (self.problem.n_interfaces, 4)
        return self.kinematic.solve(np.ones(shape, dtype=bool), np.ones(shape)) is not None

    def adopt(self, other: Search, most: int) -> list[CollapseState]:
        """The states here of the mechanisms that were lowest in another search, whose friction may differ.

        Zero-dilatancy mechanisms do not depend on friction, so each needs one static programme only. Where forces fit
        none of them, the mechanisms nearest to their forces are tried.
        """
        theirs = sorted((state for state, _ in other.known.values() if state is not None), key=lambda s: s.multiplier)
        states = [self._best_of(state.velocities, state.moving) for state in theirs[:most]]
        if not any(states):
            states = [self.nearest_state(self.problem.slacks(state.forces)) for state in theirs[:most]]
        return [state for state in states if state is not None]

    def state_of(self, velocities: FloatArray, rates: FloatArray, below: float = np.inf) -> CollapseState | None:
        """The best collapse state of a mechanism, or None if no forces fit it with a multiplier below a given one."""
        return self._best_of(velocities, moving_contacts(rates), below)

    def lowered(self, state: CollapseState) -> CollapseState:
        """The lowest state of the mechanism of a state: other forces may fit it at a lower multiplier."""
        least = self._best_of(state.velocities, state.moving)
        lower = least is not None and least.multiplier < state.multiplier - LEAST_IMPROVEMENT
        return least if least is not None and lower else state

    def _best_of(self, velocities: FloatArray, moving: BoolArray, below: float = np.inf) -> CollapseState | None:
        key = _key(moving)
        state, asked = self.known.get(key, (None, -np.inf))
        if state is None and below > asked:
            state = self._solved(velocities, moving, below)
            self.known[key] = state, below
            if state is not None:
                self.note(state)
        return state

    def _solved(self, velocities: FloatArray, moving: BoolArray, below: float) -> CollapseState | None:
        if self.problem.n_interfaces > self.choices.vertices_up_to:  # which cannot end early
            state, steps = state_of_mechanism(self.problem, self.newton, velocities, moving, self.choices.exactness)
            self.stepped(steps)
            exact = state is not None and max(residuals(self.problem, state).values()) <= self.choices.exactness.kept
            return state if exact else None
        self.budget.spent.programmes += 1
        solution = self.static.solve(moving, below=below)
        if isinstance(solution, str):
            return None
        return CollapseState(solution.forces, solution.multiplier, velocities, moving)

    def _lower(self, mechanism: KinematicSolution | None, state: CollapseState) -> CollapseState | None:
        """The state of a mechanism, if there is one below another state."""
        return None if mechanism is None else self.state_of(mechanism.velocities, mechanism.rates, state.multiplier)

    def solve_associated(self) -> AssociatedResult:
        """The greatest multiplier of statics alone, which is kept: no collapse state is above it."""
        self.associated = solve_associated(self.problem, self.newton, end=self.choices.associated)
        return self.associated

    def note(self, state: CollapseState) -> None:
        """Note a collapse state if none known is lower."""
        self.record.note(state, self.budget.spent)

    def nearest_state(
        self, slack: FloatArray, rates: FloatArray | None = None, below: float = np.inf
    ) -> CollapseState | None:
        """The collapse state of the mechanism that does least work y.g on given slacks (m, 4), or None.

        Args:
            slack: which may be those of another friction.
            rates: (m, 4) of the path that has these slacks, if they belong to one.
            below: multiplier from which on a state is of no use; the search may end before it knows one.
        """
        slack = np.maximum(slack, 0.0)
        if self.problem.n_interfaces > self.choices.vertices_up_to:
            return self._nearest_by_path(slack)
        for allowed in self._allowed(slack, rates):
            self.budget.spent.programmes += 1
            mechanism = self.kinematic.solve(allowed, slack)
            if mechanism is not None:
                state = self.state_of(mechanism.velocities, mechanism.rates, below)
                if state is not None:
                    return state
        return None

    def _nearest_by_path(self, slack: FloatArray) -> CollapseState | None:
        mechanism = cheapest_mechanism(self.problem, self.newton, slack, np.random.default_rng(self.seed))
        self.stepped(mechanism.iterations)
        state, steps = exact_state(self.problem, self.newton, mechanism, self.choices.exactness)
        self.stepped(steps)
        if state is not None:
            self.known[_key(state.moving)] = state, np.inf
            self.note(state)
        return state

    def stepped(self, steps: int) -> None:
        """Count Newton steps of the whole wall."""
        self.budget.stepped(steps, self.problem.n_velocities // 3)

    def _allowed(self, slack: FloatArray, rates: FloatArray | None) -> list[BoolArray]:
        everywhere = np.ones(slack.shape, dtype=bool)
        if rates is None:
            return [slack <= self.choices.nearly_zero, everywhere]
        return [rates >= slack, slack <= self.choices.small, everywhere]

    def follow(self, start: Point, settings: PathSettings) -> PathResult:
        """Interior point from a start; counts its steps."""
        result = follow_path(self.problem, self.newton, start, settings)
        self.stepped(result.iterations)
        return result

    def path_end(self) -> PathResult | None:
        """Where the interior point leads from the centred start; None if far from complementarity."""
        result = self.follow(start_point(self.problem), self.choices.central)
        return None if result.gap > self.choices.widest_gap else result

    def ends_of_copies(self, guide: Problem, dead: FloatArray) -> Iterator[tuple[FloatArray, FloatArray]]:
        """Slacks and rates (m, 4) where central paths of copies of a guide with dead loads (k, 3n) arrive."""
        slack, rates, steps = path_ends(guide, self.newton, dead, self.choices.widest_gap)
        self.stepped(steps)
        return zip(slack, rates, strict=True)

    def interior(self) -> CollapseState | None:
        """The exact state nearest to where the interior point leads from the centred start."""
        end = self.path_end()
        return None if end is None else self.nearest_state(end.point.slack, end.point.rates)

    def as_one_block(self, state: CollapseState) -> CollapseState | None:
        """The best state in which all blocks that move in `state` move as one rigid body; None if they cannot.

        Descent splits blocks up and seldom joins them again, while the joined ones may bear less.
        """
        assembly = self.problem.assembly
        speed = np.abs(state.velocities.reshape(-1, 3)).max(axis=1)
        moves = np.zeros(assembly.n_blocks, dtype=bool)
        moves[assembly.free] = speed > self.choices.still * speed.max(initial=0.0)
        edge = moves[assembly.block_a] != moves[assembly.block_b]
        slack = np.maximum(self.problem.slacks(state.forces), 0.0)
        self.budget.spent.programmes += 1
        mechanism = self.kinematic.solve(np.repeat(edge[:, None], 4, axis=1), slack)
        return self._lower(mechanism, state)

    def descend_from(self, states: Iterable[CollapseState]) -> list[CollapseState]:
        """Where ray descent leads from the lowest of the states that differ in multiplier."""
        reached: list[CollapseState] = []
        seen: set[int] = set()
        for state in sorted(states, key=lambda s: s.multiplier):
            place = round(state.multiplier * 1e9)
            if place in seen or len(reached) >= self.budget.limits.descents:
                continue
            seen.add(place)
            reached.append(self.descend(state))
        return reached

    def descend(self, state: CollapseState) -> CollapseState:
        """Ray descent from a state."""
        large = self.problem.n_interfaces > self.choices.once_above
        if large and any(abs(state.multiplier - end) <= LEAST_IMPROVEMENT for end in self.ends):
            return state
        failures, limits = 0, self.budget.limits
        for _ in range(min(limits.draws, self.budget.programmes)):
            if failures >= limits.failures or not self.budget.programmes:
                break
            tight = tight_contacts(self.problem, state.forces)
            cost = self.generator.exponential(size=tight.shape) ** 2
            self.budget.spent.programmes += 1
            mechanism = self.kinematic.solve(tight, cost)
            other = self._lower(mechanism, state)
            if other is not None and other.multiplier < state.multiplier - LEAST_IMPROVEMENT:
                state, failures = other, 0
            else:
                failures += 1
        self.ends.append(state.multiplier)
        return state


def _key(moving: BoolArray) -> bytes:
    return np.packbits(moving).tobytes()


class Source(Protocol):
    """A way to collapse states of a wall. What it was tuned with are fields of the object, so that others can be set.

    A source draws from the budget of the search, and stops where that ends or where what is known makes it needless.
    """

    @property
    def name(self) -> str:
        """What the source is called in results: words of the field."""

    def applies(self, problem: Problem) -> bool:
        """Whether it can lead to a state of this wall and is worth its work at this size."""

    def states(self, search: Search) -> Iterator[CollapseState]:
        """Exact collapse states, in the order found; those that are lower than all before are noted by the caller."""
