"""Mechanisms that need no search: those of walls alike, and motions of one block with the least multiplier of each.

Interior paths, descent and paths of springs all begin with forces, and so with the joints that those press. A block
that slides out alone from among others, which could press on it but need not, is seldom found from there. Its motions
are few, though: those of one rigid body against joints without dilatancy are the extreme rays of a cone in three
dimensions, and each is a mechanism whose least multiplier is one linear programme.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from harness.model.assembly import FloatArray
from harness.model.joint_law import block_diagonal
from methods.la.core.problem import Problem
from methods.la.core.state import CollapseState, moving_contacts
from methods.la.sources.record import LEAST_IMPROVEMENT
from methods.la.sources.search import Search

ROUNDING = 1e-9
"""Rates and products of unit vectors up to this are zero to rounding."""


def _motions_of(problem: Problem, block: int) -> Iterator[tuple[FloatArray, float]]:
    """Velocities (3n,) of the block's own motions, and the least scaled multiplier that its equilibrium allows each."""
    own = slice(3 * block, 3 * block + 3)
    columns = problem.kinematic[:, own].tocoo()
    joints, row = np.unique(columns.row // 3, return_inverse=True)
    strains = np.zeros((len(joints), 3, 3))
    strains[row, columns.row % 3, columns.col] = columns.data
    for motion in extreme_motions(strains, problem.live[own]):
        velocities = np.zeros(problem.n_velocities)
        velocities[own] = motion * (problem.live_work / float(problem.live[own] @ motion))
        yield velocities, least_of_block(problem, block, joints, strains, motion)


def extreme_motions(strains: FloatArray, live: FloatArray) -> FloatArray:
    """(r, 3) unit motions of a rigid body that move in fewest of its contacts.

    Args:
        strains: (k, 3, 3) openings at both ends and slip of its joints, from its motion; no opening may be negative.
        live: (3,) live load on the body, which is to do positive work.
    """
    rows = _distinct(strains.reshape(-1, 3))
    first, second = np.triu_indices(len(rows), 1)
    motions = _distinct(np.cross(rows[first], rows[second]))
    work = motions @ live
    doing = abs(work) > ROUNDING * np.linalg.norm(live)
    motions = motions[doing] * np.sign(work[doing])[:, None]
    rates = np.einsum("kij,rj->rki", strains, motions)
    possible = (rates[:, :, :2] >= -ROUNDING).all(axis=(1, 2))
    motions, rates = motions[possible], rates[possible].reshape(-1, 3 * len(strains))
    moving = np.hstack([rates > ROUNDING, rates < -ROUNDING])
    within = ~(moving[:, None] & ~moving[None]).any(axis=2)
    return np.asarray(motions[~(within & ~within.T).any(axis=0)])


def least_of_block(
    problem: Problem, block: int, joints: NDArray[Any], strains: FloatArray, motion: FloatArray
) -> float:
    """The least scaled multiplier at which a moving block's joints balance its own loads; inf if they cannot.

    Args:
        joints: (k,) its interfaces; strains: (k, 3, 3) of them; motion: (3,) of the block.
    """
    own = slice(3 * block, 3 * block + 3)
    rates = strains @ motion
    slacks = np.pad(block_diagonal(problem.law.rows[joints]).toarray(), ((0, 0), (0, 1)))
    constant = problem.law.constant[joints].ravel()
    moving = np.column_stack([rates, -rates[:, 2]]).ravel() > ROUNDING
    solution = linprog(
        np.eye(slacks.shape[1])[-1],
        A_ub=-slacks,
        b_ub=constant,
        A_eq=np.vstack([slacks[moving], np.column_stack([strains.reshape(-1, 3).T, problem.live[own]])]),
        b_eq=np.append(0.0 - constant[moving], -problem.dead[own]),
        bounds=[(None, None)] * (slacks.shape[1] - 1) + [(0.0, None)],
    )
    return np.inf if solution.status != 0 or solution.x is None else float(solution.x[-1])


def _distinct(vectors: FloatArray) -> FloatArray:
    """Unit vectors (k, 3) along those that differ in more than length, sense and rounding."""
    length = np.linalg.norm(vectors, axis=1)
    unit = vectors[length > ROUNDING] / length[length > ROUNDING, None]
    leading = np.take_along_axis(unit, (abs(unit) > ROUNDING).argmax(axis=1)[:, None], axis=1)
    unit = unit * np.sign(leading)
    return np.asarray(unit[np.unique(unit.round(8), axis=0, return_index=True)[1]])


@dataclass(frozen=True, eq=False)
class GivenMechanisms:
    """Mechanisms, distinguished by how their joints move. A state counts only if forces of this wall fit its mechanism.

    Attributes:
        motions: (m, 3) openings at both ends and slip of the joints of each, at any scale.
        most: interfaces up to which mechanisms are vertices, which tell whether the joints can move so here.
    """

    motions: tuple[FloatArray, ...]
    most: int = 1000
    name: ClassVar[str] = "mechanisms of other runs"

    @property
    def moves(self) -> bool:
        """Whether anything moves in any of them."""
        return any(motion.any() for motion in self.motions)

    def applies(self, problem: Problem) -> bool:
        """Where mechanisms are vertices."""
        return problem.n_interfaces <= self.most

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state a mechanism whose joints can move alike in this wall and that forces fit."""
        for motion in self.motions:
            moving = moving_contacts(search.problem.rates_of_strains(motion, False))
            if not moving.any():
                continue
            search.budget.spent.programmes += 1
            mechanism = search.kinematic.solve(moving, np.ones(moving.shape))
            state = None if mechanism is None else search.state_of(mechanism.velocities, mechanism.rates)
            if state is not None:
                yield state


@dataclass(frozen=True)
class SingleBlocks:
    """Blocks that may move alone below the least multiplier known.

    Attributes:
        most: interfaces above which they are not asked.
    """

    name: ClassVar[str] = "single blocks"
    most: int = 2000

    def applies(self, problem: Problem) -> bool:
        """On joints that slide without lifting."""
        return problem.n_interfaces <= self.most and not problem.dilates

    def states(self, search: Search) -> Iterator[CollapseState]:
        """One state a motion that forces fit."""
        problem = search.problem
        for block in range(problem.assembly.n_free):
            for velocities, least in _motions_of(problem, block):
                search.budget.spent.programmes += 1
                if least >= search.record.least - LEAST_IMPROVEMENT:
                    continue
                state = search.state_of(velocities, problem.rates_of_velocities(velocities, False), search.record.least)
                if state is not None:
                    yield state


@dataclass(frozen=True)
class JoinedBlocks:
    """The blocks that move in the least state known, as one rigid body: descent splits them and seldom joins them."""

    name: ClassVar[str] = "moving blocks joined"

    def applies(self, problem: Problem) -> bool:
        """On every wall."""
        return True

    def states(self, search: Search) -> Iterator[CollapseState]:
        """The joined state, where it is lower."""
        if not search.record.known or not search.budget.limits.descents:
            return
        least = search.record.improvements[-1].state
        joined = search.as_one_block(least)
        if joined is not None and joined.multiplier < least.multiplier:
            yield joined
