"""Programmes over contact forces whose vertices are computed to rounding: extreme multipliers, falls, bounds.

min or max lambda s.t. C' r + f0 + lambda fL = 0, S r + s0 >= 0, and its dual: a dilatant mechanism. Both sides are read
from one vertex (`methods.numerics.vertex`), so that neither is nearer to the truth than the other. Forces are measured
in units of their interface and equilibrium in units of its block, so that a light block beside a heavy one counts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import BoolArray, FloatArray
from methods.la.core.problem import Problem
from methods.la.core.programmes import KinematicSolution, StaticSolution
from methods.numerics.linear_programme import INFINITY, Programme
from methods.numerics.shear_rows import (
    COST,
    Entries,
    entries_of_shear_limits,
    least_shear_slacks,
    rows_of_blocks,
    shear_unit,
)
from methods.numerics.vertex import Vertex

_SIMPLEX_UP_TO = 400
"""Interfaces above which the interior point with crossover of HiGHS is quicker than its simplex method."""

_BADLY_SCALED = 1e3
"""Ratio of loads of two blocks from which forces and equilibrium are measured in units of their own."""


@dataclass(frozen=True)
class _ExtremeSolution:
    """Forces of the greatest or least multiplier, and the dilatant mechanism dual to them: with or against the load."""

    statics: StaticSolution
    kinematics: KinematicSolution


@dataclass(frozen=True, eq=False)
class RowScaling:
    """What one unit of a programme is worth: forces of every interface (m,), equilibrium of every free block (n,)."""

    interfaces: FloatArray
    blocks: FloatArray


@dataclass(frozen=True, eq=False)
class DeadWork:
    """The least -dead.u of mechanisms, and the contacts (m, 4) that must be at rest for the forces that prove it."""

    work: float
    needs: BoolArray


class ForceProgramme:
    """The programmes of one wall over its contact forces. Columns are (n1, n2, s) an interface and the multiplier.

    Args:
        problem: the scaled wall.
        units: None measures all forces in mean block weights.
        also: (3n,) a further load that may act at any multiple from zero on; its column stands before the multiplier's.
    """

    def __init__(self, problem: Problem, units: RowScaling | None = None, also: FloatArray | None = None) -> None:
        self.problem = problem
        m, n = problem.n_interfaces, problem.n_velocities
        self._units = units or RowScaling(np.ones(m), np.ones(n // 3))
        self._rows = np.repeat(1.0 / self._units.blocks, 3)
        self._columns = np.repeat(self._units.interfaces, 3)
        self._loads = 1 if also is None else 2
        self._equilibrium = self._entries_of_equilibrium([problem.live] if also is None else [also, problem.live])
        self._matrix = self._with_limits(problem.law.rows)
        self._dead = self._rows * problem.dead

    def _entries_of_equilibrium(self, loads: list[FloatArray]) -> Entries:
        """Values, rows and columns of the matrix of equilibrium: of the forces, then of the loads (3n,)."""
        statics = self.problem.statics
        row = np.repeat(np.arange(statics.shape[0]), np.diff(statics.indptr))
        parts = [(self._rows[row] * statics.data * self._columns[statics.indices], row, statics.indices)]
        for k, load in enumerate(loads):
            acting = np.flatnonzero(load)
            column = np.full(len(acting), statics.shape[1] + k)
            parts.append((self._rows[acting] * load[acting], acting, column))
        values, rows, columns = (np.concatenate(part) for part in zip(*parts, strict=True))
        return values, rows, columns

    def _with_limits(self, limits: FloatArray) -> sp.csc_matrix:
        """The matrix of equilibrium and of the shear rows of (m, 4, 3)."""
        n, m = self.problem.n_velocities, self.problem.n_interfaces
        shear = entries_of_shear_limits(limits)
        values, rows, columns = (
            np.concatenate([ours, theirs]) for ours, theirs in zip(self._equilibrium, shear, strict=True)
        )
        rows[len(self._equilibrium[1]) :] += n
        return sp.csc_matrix((values, (rows, columns)), shape=(n + 2 * m, 3 * m + self._loads))

    def extreme(self, greatest: bool, tight: BoolArray | None = None, solver: str = "auto") -> _ExtremeSolution | str:
        """The greatest or, from zero on, the least multiplier of statics; or how the programme ended without one.

        Args:
            greatest: which of the two.
            tight: (m, 4) slacks held at zero.
            solver: "simplex", "ipm" (with crossover) or "auto" (by size).
        """
        m = self.problem.n_interfaces
        tight = np.zeros((m, 4), dtype=bool) if tight is None else tight
        column, limits = self._within_yield(tight)
        cost = self._of_multiplier(-1.0 if greatest else 1.0)
        multiplier = (-INFINITY if greatest else 0.0, INFINITY)
        solved = self._solved(column, limits, cost, multiplier, solver, presolve=not greatest)
        if isinstance(solved, str):
            return solved
        vertex, iterations = solved
        velocities, rates = self._motion(vertex)
        work = abs(float(self.problem.live @ velocities))
        scale = self.problem.live_work / work if work > 0.0 else 1.0
        return _ExtremeSolution(
            StaticSolution(self._forces(vertex), float(vertex.value[-1]), iterations),
            KinematicSolution(scale * velocities, scale * rates),
        )

    def extreme_work(
        self, strains: FloatArray, greatest: bool, parted: BoolArray | None = None
    ) -> tuple[FloatArray, FloatArray] | str:
        """The forces (m, 3) that do the greatest or least work on strains (m, 3) without live load, or how it ended.

        Beside them stand the velocities (3n,) of the mechanism dual to them, which has these strains besides those of
        its velocities; for the greatest work, the opposite strains. Ends of joints `parted` (m, 2) bear nothing.
        """
        sense = -1.0 if greatest else 1.0
        scale = COST / float(abs(strains).max())
        cost = np.append(sense * scale * strains.ravel() * self._columns, np.zeros(self._loads))
        tight = np.zeros((self.problem.n_interfaces, 4), dtype=bool)
        if parted is not None:
            tight[:, :2] = parted
        column, limits = self._within_yield(tight)
        solved = self._solved(column, limits, cost, (0.0, 0.0), "auto")
        if isinstance(solved, str):
            return solved
        return self._forces(solved[0]), self._motion(solved[0])[0] / scale

    def _of_multiplier(self, sense: float) -> FloatArray:
        """Cost of the columns: of the multiplier alone."""
        cost = np.zeros(3 * self.problem.n_interfaces + self._loads)
        cost[-1] = COST * self.problem.live_work * sense
        return cost

    def _within_yield(self, tight: BoolArray) -> tuple[tuple[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]:
        """Bounds of the columns of forces (3m,) and of the shear rows (2m,) with slacks `tight` (m, 4) held at zero."""
        law, m = self.problem.law, self.problem.n_interfaces
        unit = self._units.interfaces[:, None]
        least = np.column_stack([law.least_normal / unit, np.full(m, -INFINITY)])
        still = np.column_stack([tight[:, :2], np.zeros(m, dtype=bool)])
        limits = least_shear_slacks(law) / np.repeat(unit, 2)
        return (
            (least.ravel(), np.where(still, least, INFINITY).ravel()),
            (limits, np.where(tight[:, 2:].ravel(), limits, INFINITY)),
        )

    def least_dead_work(self, still: BoolArray) -> DeadWork | str:
        """The least -dead.u of mechanisms with unit live work, at rest in contacts `still` (m, 4).

        Their slips lift by the joints' own dilatancy.

        It is the greatest multiplier of forces that do no negative work on any of them: compression where a gap may
        open, no shear where it may slip either way, any force where it is at rest. Where a slip lifts, shear up to
        what the compression does as it is lifted.

        No such forces carry the dead load where it does work on some of the mechanisms without the live load. Where
        forces that do no negative work carry the live load alone, no mechanism has live work above zero: the work is
        inf.
        """
        found = self._dead_work(still, self._dead, INFINITY)
        if found != "infeasible":
            return found
        alone = self._dead_work(still, np.zeros_like(self._dead), 1.0)
        if isinstance(alone, str) or alone.work < 0.5:
            return found
        return replace(alone, work=np.inf)

    def _dead_work(self, still: BoolArray, dead: FloatArray, most_live: float) -> DeadWork | str:
        """The programme of `least_dead_work` beside another dead load and with a multiplier of at most so much."""
        m = self.problem.n_interfaces
        lower = np.where(still[:, :2], -INFINITY, 0.0)
        forward, backward = ~still[:, 2], ~still[:, 3]
        least = np.where(forward, 0.0, -INFINITY)
        most = np.where(backward, 0.0, INFINITY)
        limits = np.full(2 * m, -INFINITY)
        matrix = self._matrix
        if self.problem.dilates:
            least, most = np.full((2, m), INFINITY) * np.array([[-1.0], [1.0]])
            limits = np.where(~still[:, 2:].ravel(), 0.0, -INFINITY)
            matrix = self._with_limits(self.problem.law.flow.transpose(0, 2, 1))
        column = (np.column_stack([lower, least]).ravel(), np.column_stack([np.full((m, 2), INFINITY), most]).ravel())
        within = (limits, np.full(2 * m, INFINITY))
        cost, loads = self._of_multiplier(-1.0), (-INFINITY, most_live)
        solved = self._solved(column, within, cost, loads, "simplex", matrix, dead)
        if isinstance(solved, str):
            return solved
        first, second, shear = solved[0].value[: 3 * m].reshape(-1, 3).T
        needs = np.column_stack([first < 0.0, second < 0.0, shear < 0.0, shear > 0.0])
        return DeadWork(float(solved[0].value[-1]), needs | self.problem.dilates)

    def _solved(
        self,
        column: tuple[FloatArray, FloatArray],
        limits: tuple[FloatArray, FloatArray],
        cost: FloatArray,
        multiplier: tuple[float, float],
        solver: str,
        matrix: sp.csc_matrix | None = None,
        dead: FloatArray | None = None,
        *,
        presolve: bool = True,
    ) -> tuple[Vertex, int] | str:
        m, n = self.problem.n_interfaces, self.problem.n_velocities
        dead = self._dead if dead is None else dead
        also = self._loads - 1
        programme = Programme(
            self._matrix if matrix is None else matrix,
            cost,
            (
                np.concatenate([column[0], np.zeros(also), [multiplier[0]]]),
                np.concatenate([column[1], np.full(also, INFINITY), [multiplier[1]]]),
            ),
            (np.append(-dead, limits[0]), np.append(-dead, limits[1])),
        )
        programme.highs.setOptionValue("small_matrix_value", 1e-12)
        if solver == "auto":
            solver = "simplex" if m <= _SIMPLEX_UP_TO else "ipm"
        programme.highs.setOptionValue("solver", solver)
        # It costs the dual simplex method more than it saves for greatest multipliers; the primal one takes .9 of the
        # time, and ends at vertices with self-stress of thousands of weights where joints are rough.
        if solver == "simplex" and not presolve:
            programme.highs.setOptionValue("presolve", "off")
        status, _, _ = programme.run()
        if status != "optimal":
            return status
        iterations = programme.iterations()
        vertex = programme.vertex(rows_of_blocks(n // 3, m))
        return (vertex, iterations) if vertex is not None and vertex.optimal else "unknown"

    def _motion(self, vertex: Vertex) -> tuple[FloatArray, FloatArray]:
        """Velocities (3n,) and rates (m, 4) dual to a vertex."""
        n = self.problem.n_velocities
        velocities = -vertex.dual[:n] * self._rows
        own = 1.0 / self._units.interfaces[:, None]
        slips = own * vertex.dual[n:].reshape(-1, 2) / shear_unit(self.problem.friction)[:, None]
        rates = np.column_stack([own * vertex.reduced[: 3 * self.problem.n_interfaces].reshape(-1, 3)[:, :2], slips])
        return velocities, rates

    def _forces(self, vertex: Vertex) -> FloatArray:
        """Forces (m, 3) of a vertex."""
        values = vertex.value[: 3 * self.problem.n_interfaces]
        return self.problem.law.within((values * self._columns).reshape(-1, 3))


def force_programme(problem: Problem) -> ForceProgramme:
    """The programmes of a wall in units that suit the loads of its blocks."""
    return ForceProgramme(problem, row_scaling(problem))


def rates_against_any_load(problem: Problem, units: RowScaling | None, tight: BoolArray) -> FloatArray | None:
    """Rates (m, 4) of a mechanism to rounding that proves that no forces bear any multiplier, or None without one.

    Args:
        problem: the scaled wall; units: of its forces; tight: (m, 4) slacks held at zero, whose rates have any sign.
    """
    part = ForceProgramme(replace(problem, live=-problem.dead), units, also=problem.live)
    found = part.extreme(greatest=False, tight=tight)
    return None if isinstance(found, str) or _carries_all(problem, found) else found.kinematics.rates


def badly_scaled(problem: Problem) -> bool:
    """Whether loads of blocks differ so much that forces and equilibrium are measured in units of their own."""
    size = _loads(problem)
    return bool(size.max(initial=0.0) >= _BADLY_SCALED * size.min(initial=np.inf) > 0.0)


def _loads(problem: Problem) -> FloatArray:
    """(n,) largest of the loads on every free block; the least of all where a block has none, zero where none has."""
    size = (abs(problem.dead) + abs(problem.live)).reshape(-1, 3).max(axis=1)
    least = float(size[size > 0.0].min()) if np.any(size > 0.0) else 0.0
    return np.asarray(np.maximum(size, least))


def row_scaling(problem: Problem) -> RowScaling | None:
    """Units of interfaces and blocks where loads differ much: what each carries of the dead load, or its own load."""
    if not badly_scaled(problem):
        return None
    size = _loads(problem)
    found = ForceProgramme(replace(problem, live=-problem.dead)).extreme(greatest=False)
    assembly = problem.assembly
    own = np.full(assembly.n_blocks, np.inf)
    own[assembly.free] = size
    carried = np.minimum(own[assembly.block_a], own[assembly.block_b])
    if not isinstance(found, str):
        carried = np.maximum(carried, abs(found.statics.forces).max(axis=1))
    blocks = np.where(np.isfinite(own), own, 0.0)
    for block in (assembly.block_a, assembly.block_b):
        np.maximum.at(blocks, block, carried)
    return RowScaling(_power_of_two(carried), _power_of_two(blocks[assembly.free]))


def _power_of_two(size: FloatArray) -> FloatArray:
    return np.asarray(2.0 ** np.round(np.log2(size)), dtype=np.float64)


def standing(problem: Problem) -> StaticSolution | KinematicSolution | str:
    """Forces that carry the dead load within yield, or the dilatant mechanism that proves that none do; or the end.

    The part of the dead load that need not be carried is least: zero or, because yield of dry joints is a cone, all
    of it; where joints have strength, any part.
    """
    found = force_programme(replace(problem, live=-problem.dead)).extreme(greatest=False)
    if isinstance(found, str):
        return found
    return found.statics if _carries_all(problem, found) else found.kinematics


def _carries_all(problem: Problem, found: _ExtremeSolution, rounding: float = 1e-9) -> bool:
    """Whether the least part of the dead load that is not carried is none, but for rounding where it may be any."""
    return found.statics.multiplier <= (0.5 if problem.law.is_cone else rounding)
