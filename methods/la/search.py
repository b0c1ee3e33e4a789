"""The search for low collapse states: exact programme on a mechanism, ray descent, seeded restarts.

Without loss of generality the mechanism is an extreme ray of {g >= 0, C u = E g}. For a mechanism that moves in the
contacts J the best multiplier is the linear programme lambda(J) = min lambda s.t. equilibrium, S r >= 0, y_J = 0.
Ray descent: at its solution draw another extreme mechanism among the contacts with y = 0, solve its programme, keep
it if lower. Every draw comes from a seeded generator, and effort is counted in programmes, never in seconds.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.associated import AssociatedResult, solve_associated
from methods.la.interior_point import PathResult, PathSettings, follow_path, start_point
from methods.la.newton_matrix import NewtonMatrix
from methods.la.newton_step import Point
from methods.la.problem import Problem
from methods.la.programmes import SIMPLEX_INTERFACES, KinematicProgramme, StaticProgramme
from methods.la.standing import standing_forces
from methods.la.state import CollapseState, moving_contacts, tight_contacts

LOWER = 1e-10
"""A multiplier is lower if it is lower by this much (scaled)."""
ONCE_ABOVE = 400
"""Interfaces above which nothing descends from a multiplier that a descent ended at: its programmes take long."""
STILL = 1e-9
"""Blocks slower than this share of the fastest count as still."""


@dataclass(frozen=True)
class Effort:
    """Limits of a search, in counts.

    Attributes:
        failures: draws without a lower value after which a descent ends.
        draws: draws of a descent at most.
    """

    failures: int = 12
    draws: int = 200


@dataclass
class Tally:
    """What a search and those of other friction that serve it spent: Newton steps, programmes, kinks of springs."""

    newton_steps: int = 0
    programmes: int = 0
    kinks: int = 0


class Search:
    """Everything that a wall's search shares: programmes, known mechanisms, counters.

    `lower` holds each state that was lower than all before, `history` its multiplier (scaled) with the CPU time of the
    process at which it was found [s], `ends` those at which descents ended, `associated` the programme of statics
    alone, once it is solved.
    """

    def __init__(self, problem: Problem, newton: NewtonMatrix, seed: int = 0, parent: Search | None = None) -> None:
        self.problem, self.newton = problem, newton
        self.static = StaticProgramme(problem, "simplex" if problem.n_interfaces <= SIMPLEX_INTERFACES else "ipm")
        self.kinematic: KinematicProgramme = KinematicProgramme(problem) if parent is None else parent.kinematic
        self.generator: np.random.Generator = np.random.default_rng(seed) if parent is None else parent.generator
        self.known: dict[bytes, CollapseState | None] = {}
        self.tally: Tally = Tally() if parent is None else parent.tally
        self.lower: list[CollapseState] = []
        self.history: list[tuple[float, float]] = []
        self.ends: list[float] = []
        self.associated = AssociatedResult("unknown")

    @cached_property
    def central_forces(self) -> FloatArray | None:
        """Forces (m, 3) well within yield under the dead load; None if none are found."""
        return standing_forces(self.problem, self.newton)

    def finds_motion(self) -> bool:
        """Whether the wall has any mechanism on which the live load does work, whatever its forces."""
        shape = (self.problem.n_interfaces, 4)
        return self.kinematic.solve(np.ones(shape, dtype=bool), np.ones(shape)) is not None

    def adopt(self, other: Search, most: int) -> list[CollapseState]:
        """The states here of the mechanisms that were lowest in another search, whose friction may differ.

        Zero-dilatancy mechanisms do not depend on friction, so each needs one static programme only. Where forces fit
        none of them, the mechanisms nearest to their forces are tried.
        """
        theirs = sorted((state for state in other.known.values() if state is not None), key=lambda s: s.multiplier)
        states = [self._best_of(state.velocities, state.moving) for state in theirs[:most]]
        if not any(states):
            states = [self.nearest_mechanism(state.forces) for state in theirs[:most]]
        return [state for state in states if state is not None]

    def state_of(self, velocities: FloatArray, rates: FloatArray) -> CollapseState | None:
        """The best collapse state of a mechanism, or None if no forces fit it."""
        return self._best_of(velocities, moving_contacts(rates))

    def _best_of(self, velocities: FloatArray, moving: BoolArray) -> CollapseState | None:
        key = np.packbits(moving).tobytes()
        if key not in self.known:
            self.tally.programmes += 1
            solution = self.static.solve(moving)
            if isinstance(solution, str):
                self.known[key] = None
            else:
                state = CollapseState(solution.forces, solution.multiplier, velocities, moving)
                self.known[key] = state
                self.record(state)
        return self.known[key]

    def solve_associated(self) -> AssociatedResult:
        """The greatest multiplier of statics alone, which is kept: no collapse state is above it."""
        self.associated = solve_associated(self.problem, self.newton)
        return self.associated

    @property
    def least(self) -> float:
        """The least multiplier (scaled) of a collapse state so far; infinite before the first."""
        return self.history[-1][1] if self.history else np.inf

    def record(self, state: CollapseState) -> None:
        """Note a collapse state if none known is lower."""
        if state.multiplier < self.least - LOWER:
            self.history.append((time.process_time(), state.multiplier))
            self.lower.append(state)

    def nearest_mechanism(self, forces: FloatArray, rates: FloatArray | None = None) -> CollapseState | None:
        """The collapse state of the extreme mechanism that does least work y.g on the slacks of given forces."""
        slack = np.maximum(self.problem.slacks(forces), 0.0)
        for allowed in self._allowed(slack, rates):
            self.tally.programmes += 1
            mechanism = self.kinematic.solve(allowed, slack)
            if mechanism is not None:
                state = self.state_of(mechanism.velocities, mechanism.rates)
                if state is not None:
                    return state
        return None

    def _allowed(self, slack: FloatArray, rates: FloatArray | None) -> list[BoolArray]:
        everywhere = np.ones(slack.shape, dtype=bool)
        if rates is None:
            return [slack <= 1e-6, everywhere]
        return [rates >= slack, slack <= 1e-3, everywhere]

    def follow(self, start: Point, settings: PathSettings) -> PathResult:
        """Interior point from a start; counts its steps."""
        result = follow_path(self.problem, self.newton, start, settings)
        self.tally.newton_steps += result.iterations
        return result

    def interior(self, spread: float = 0.0, settings: PathSettings | None = None) -> CollapseState | None:
        """The exact state nearest to where the interior point leads, from the centred or a random start."""
        settings = settings or PathSettings(gap=1e-7, residual=1e-6)
        result = self.follow(start_point(self.problem, spread, self.generator), settings)
        if result.gap > 1e-2:
            return None
        return self.nearest_mechanism(self.problem.forces_of_slacks(result.point.slack), result.point.rates)

    def as_one_block(self, state: CollapseState) -> CollapseState | None:
        """The best state in which all blocks that move in `state` move as one rigid body; None if they cannot.

        Descent splits blocks up and seldom joins them again, while the joined ones may bear less.
        """
        assembly = self.problem.assembly
        speed = np.abs(state.velocities.reshape(-1, 3)).max(axis=1)
        moves = np.zeros(assembly.n_blocks, dtype=bool)
        moves[assembly.free] = speed > STILL * speed.max(initial=0.0)
        edge = moves[assembly.block_a] != moves[assembly.block_b]
        slack = np.maximum(self.problem.slacks(state.forces), 0.0)
        self.tally.programmes += 1
        mechanism = self.kinematic.solve(np.repeat(edge[:, None], 4, axis=1), slack)
        return None if mechanism is None else self.state_of(mechanism.velocities, mechanism.rates)

    def descend(self, state: CollapseState, effort: Effort) -> CollapseState:
        """Ray descent from a state."""
        large = self.problem.n_interfaces > ONCE_ABOVE
        if large and any(abs(state.multiplier - end) <= LOWER for end in self.ends):
            return state
        failures = 0
        for _ in range(effort.draws):
            if failures >= effort.failures:
                break
            tight = tight_contacts(self.problem, state.forces)
            cost = self.generator.exponential(size=tight.shape) ** 2
            self.tally.programmes += 1
            mechanism = self.kinematic.solve(tight, cost)
            other = None if mechanism is None else self.state_of(mechanism.velocities, mechanism.rates)
            if other is not None and other.multiplier < state.multiplier - LOWER:
                state, failures = other, 0
            else:
                failures += 1
        self.ends.append(state.multiplier)
        return state
