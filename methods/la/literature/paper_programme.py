"""The programme (8)-(11) of Baggio and Trovalusci (1995) in its reduced unknowns (lambda, r2, m).

The interfaces are split into a kinematically determined system of n joints (B1, square and regular) and the others
(B2). The strains of the first give the velocities, u = A0 q1 with A0 = B1^-1, and the forces of the others give those
of the first, r1 = -(A' r2 + A0' f) with A = B2 A0 and f = f0 + lambda fL. The programme is

    min lambda   s.t.  (A M1 - M2) m = 0,   y = S r(lambda, r2) >= 0,   y.m = 0,   (A0 M1 m).fL = 1,   lambda, m >= 0

with 1 + 3 (m - n) + 4 m unknowns. Gradients are exact; Ipopt solves a sequence of relaxations y.m <= epsilon.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.deadline import Deadline, OutOfTime
from harness.model.errors import optional
from harness.model.joint_law import block_diagonal
from harness.model.method import Answer, Finding, Status
from methods.la.answers import NO_MOTION, collapse_answer, not_converged, unbounded_answer
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem
from methods.la.core.state import polished
from methods.la.family import LimitAnalysisFamily
from methods.la.literature.cooperation import finite_element_answer, without_start
from methods.la.methods import LA_PAPER
from methods.la.sources.search import Search
from methods.numerics.failures import NumericalFailure, sparse_lu

_FASTEST = 1e3
"""Bound on the rates at a mean live displacement of one; without it Ipopt's tolerances admit rates of any size."""
_ENDS = {
    0: "Solve_Succeeded",
    1: "Solved_To_Acceptable_Level",
    2: "Infeasible_Problem_Detected",
    3: "Search_Direction_Becomes_Too_Small",
    4: "Diverging_Iterates",
    5: "User_Requested_Stop",
    6: "Feasible_Point_Found",
    -1: "Maximum_Iterations_Exceeded",
    -2: "Restoration_Failed",
    -3: "Error_In_Step_Computation",
    -10: "Not_Enough_Degrees_Of_Freedom",
    -13: "Invalid_Number_Detected",
}
"""How Ipopt says that it ended (its ApplicationReturnStatus)."""


@dataclass(frozen=True)
class _PaperResult:
    """Scaled forces (m, 3), multiplier and rates (m, 4), the number of unknowns, iterations and Ipopt's last word."""

    forces: FloatArray
    multiplier: float
    rates: FloatArray
    unknowns: int
    iterations: int
    message: str


def _determined_system(problem: Problem) -> IntArray:
    """(n,) interfaces of a kinematically determined system: one chain of joints leads from every block to a support.

    The chains prefer joints that face gravity over head joints, and of the two halves of a bed joint the one towards
    which the live load pushes, as the paper guesses the statically active joints of a wall pushed sideways.

    Raises:
        ValueError: a block has no chain of joints to a support.
    """
    assembly = problem.assembly
    nodes = np.where(assembly.fixed, 0, np.cumsum(~assembly.fixed))
    tail, head = nodes[assembly.block_a], nodes[assembly.block_b]
    push = assembly.live[:, :2].sum(axis=0)
    push = push / (np.linalg.norm(push) or 1.0)
    middle = 0.5 * (assembly.end1 + assembly.end2)
    upper = np.where(
        assembly.centroid[assembly.block_a][:, 1] > assembly.centroid[assembly.block_b][:, 1],
        assembly.block_a,
        assembly.block_b,
    )
    side = ((middle - assembly.centroid[upper]) @ push) / problem.unit_length
    cost = 1.0 + 4.0 * (1.0 - abs(assembly.normal[:, 1])) - 0.2 * np.tanh(side)
    best: dict[tuple[int, int], int] = {}
    for p in np.argsort(cost, kind="stable").tolist():
        best.setdefault((min(tail[p], head[p]), max(tail[p], head[p])), p)
    keys = [key for key in best if key[0] != key[1]]
    chosen = np.array([best[key] for key in keys])
    first, second = np.array(keys).T
    size = assembly.n_free + 1
    graph = sp.csr_matrix((cost[chosen], (first, second)), shape=(size, size))
    _, before = dijkstra(csgraph=graph, directed=False, indices=np.int64(0), return_predecessors=True)  # type: ignore[call-overload]
    if np.any(before[1:] < 0):
        raise ValueError("a block has no chain of joints to a support")
    return np.array([best[(min(k, int(before[k])), max(k, int(before[k])))] for k in range(1, size)])


def _solve_paper_programme(
    problem: Problem, start_forces: FloatArray | None, max_iterations: int, epsilons: tuple[float, ...]
) -> _PaperResult:
    """A local solution of the programme.

    Args:
        problem: the scaled wall.
        start_forces: (m, 3) whose r2 starts the programme, or None for the paper's r2 = 0.
        max_iterations: of Ipopt, for each relaxation.
        epsilons: bounds of y.m relative to the live work, decreasing.

    Raises:
        OutOfTime: the time of the run is over.
    """
    ipyopt = optional("ipyopt", "paper", "method la-paper")

    programme = _programme_of(problem)
    unknowns, iterations, message = programme.start(start_forces), 0, ""
    counted: list[int] = []

    def goes_on(_mode: int, iteration: int, *_rest: float) -> bool:
        """Note the number of the iteration, and go on while there is time."""
        counted.append(iteration)
        return not problem.deadline.passed

    for epsilon in epsilons:
        counted.clear()
        solver = ipyopt.Problem(
            *programme.bounds_of_unknowns(),
            *programme.bounds_of_constraints(epsilon),
            programme.entries_of_derivatives(),
            programme.entries_of_curvature(),
            lambda x: float(x[0]),
            programme.put_slope,
            programme.put_constraints,
            programme.put_derivatives,
            programme.put_curvature,
            intermediate_callback=goes_on,
            ipopt_options={"print_level": 0, "sb": "yes", "max_iter": max_iterations, "tol": 1e-9},
        )
        unknowns, status = _solved(solver, unknowns, problem.deadline)
        iterations += max(counted, default=0)
        message = _ENDS.get(status, f"status {status}")
    return _PaperResult(
        programme.forces(unknowns), float(unknowns[0]), programme.rates(unknowns), len(unknowns), iterations, message
    )


def _solved(solver: Any, start: FloatArray, deadline: Deadline) -> tuple[FloatArray, int]:
    """The unknowns that Ipopt ends at and its status; an alarm that rings inside one of its callbacks is not lost."""
    try:
        unknowns, _, status = solver.solve(start.copy())
    except RuntimeError:
        if deadline.raised:
            raise OutOfTime from None
        raise
    if deadline.raised:
        raise OutOfTime
    deadline.ask()
    return unknowns, int(status)


@dataclass(frozen=True)
class _Programme:
    """The programme in x = (lambda, r2, rates): forces and slacks are linear in the first two, x_f = (lambda, r2).

    Attributes:
        second: (k,) rows of r2 among the forces.
        fixed_forces: (3m,) forces at x_f = 0; forces_of: (3m, 1 + k) of x_f.
        fixed_slacks: (4m,) slacks at x_f = 0; slacks_of: (4m, 1 + k) of x_f.
        compatibility: (k, 4m); live_row: (4m,) work of the live load of rates, in units of `live_work`.
        live_work: of the scaled wall.
    """

    second: IntArray
    fixed_forces: FloatArray
    forces_of: FloatArray
    fixed_slacks: FloatArray
    slacks_of: sp.csr_array
    compatibility: sp.csr_array
    live_row: FloatArray
    live_work: float

    @property
    def _forces(self) -> int:
        return 1 + len(self.second)

    @property
    def _rates(self) -> int:
        return len(self.live_row)

    def start(self, forces: FloatArray | None) -> FloatArray:
        """The unknowns to start from: r2 of forces (m, 3), or zero."""
        second = np.zeros(len(self.second)) if forces is None else forces.ravel()[self.second]
        return np.concatenate([[0.0], second, np.full(self._rates, 0.1)])

    def forces(self, unknowns: FloatArray) -> FloatArray:
        """(m, 3) forces of the unknowns."""
        return (self.fixed_forces + self.forces_of @ unknowns[: self._forces]).reshape(-1, 3)

    def rates(self, unknowns: FloatArray) -> FloatArray:
        """(m, 4) rates of the unknowns."""
        return unknowns[self._forces :].reshape(-1, 4)

    def bounds_of_unknowns(self) -> tuple[int, FloatArray, FloatArray]:
        """How many unknowns there are, and between which values they lie."""
        free = np.full(len(self.second), np.inf)
        lower = np.concatenate([[0.0], -free, np.zeros(self._rates)])
        return len(lower), lower, np.concatenate([[np.inf], free, np.full(self._rates, _FASTEST)])

    def bounds_of_constraints(self, epsilon: float) -> tuple[int, FloatArray, FloatArray]:
        """How many constraints there are, and between which values they lie: compatibility, y, y.m, live work."""
        none = np.zeros(len(self.second))
        lower = np.concatenate([none, np.zeros(self._rates), [-np.inf, 0.0]])
        return len(lower), lower, np.concatenate([none, np.full(self._rates, np.inf), [epsilon, 0.0]])

    def _slacks(self, unknowns: FloatArray) -> FloatArray:
        return np.asarray(self.fixed_slacks + self.slacks_of @ unknowns[: self._forces])

    def put_slope(self, unknowns: FloatArray, out: FloatArray) -> None:
        """The gradient of lambda."""
        out[:] = 0.0
        out[0] = 1.0

    def put_constraints(self, unknowns: FloatArray, out: FloatArray) -> None:
        """The values of the constraints."""
        rates, slacks = unknowns[self._forces :], self._slacks(unknowns)
        out[: len(self.second)] = self.compatibility @ rates
        out[len(self.second) : -2] = slacks
        out[-2] = slacks @ rates / self.live_work
        out[-1] = self.live_row @ rates - 1.0

    def entries_of_derivatives(self) -> tuple[IntArray, IntArray]:
        """Row and column of each derivative, in the order of `put_derivatives`."""
        k, forces = len(self.second), self._forces
        compatible, slack, live = self.compatibility.tocoo(), self.slacks_of.tocoo(), np.flatnonzero(self.live_row)
        work = k + self._rates
        rows = (compatible.row, k + slack.row, np.full(forces + self._rates, work), np.full(len(live), work + 1))
        columns = (compatible.col + forces, slack.col, np.arange(forces + self._rates), forces + live)
        return _joined(rows), _joined(columns)

    def put_derivatives(self, unknowns: FloatArray, out: FloatArray) -> None:
        """The derivatives of the constraints: constant but those of y.m."""
        rates = unknowns[self._forces :]
        out[:] = np.concatenate(
            [
                self.compatibility.data,
                self.slacks_of.data,
                (self.slacks_of.T @ rates) / self.live_work,
                self._slacks(unknowns) / self.live_work,
                self.live_row[np.flatnonzero(self.live_row)],
            ]
        )

    def entries_of_curvature(self) -> tuple[IntArray, IntArray]:
        """Row and column of each second derivative: y.m alone is curved, as a product of rates and x_f."""
        slack = self.slacks_of.tocoo()
        return _joined((self._forces + slack.row,)), _joined((slack.col,))

    def put_curvature(self, unknowns: FloatArray, weights: FloatArray, slope: float, out: FloatArray) -> None:
        """The second derivatives of the Lagrangian."""
        out[:] = weights[-2] * self.slacks_of.data / self.live_work


def _joined(parts: Sequence[NDArray[np.integer[Any]]]) -> IntArray:
    return np.concatenate([part.astype(np.int64) for part in parts])


def _programme_of(problem: Problem) -> _Programme:
    """The programme of a wall.

    Raises:
        ValueError: a block has no chain of joints to a support.
    """
    m, first = problem.n_interfaces, np.sort(_determined_system(problem))
    second = np.setdiff1d(np.arange(m), first)
    rows1, rows2 = ((3 * part[:, None] + np.arange(3)).ravel() for part in (first, second))
    b1, b2 = problem.kinematic[rows1].tocsc(), problem.kinematic[rows2].tocsc()
    inverse = sparse_lu(b1).solve(np.eye(len(rows1)))
    transfer = np.where(abs(b2 @ inverse) > 1e-13, b2 @ inverse, 0.0)
    flow = block_diagonal(problem.law.flow)
    m1, m2 = flow[rows1].toarray(), flow[rows2].toarray()
    fixed_forces, forces_of = np.zeros(3 * m), np.zeros((3 * m, 1 + len(rows2)))
    fixed_forces[rows1] = -(inverse.T @ problem.dead)
    forces_of[rows1, 0] = -(inverse.T @ problem.live)
    forces_of[rows1, 1:] = -transfer.T
    forces_of[rows2, 1 + np.arange(len(rows2))] = 1.0
    rows = block_diagonal(problem.law.rows)
    return _Programme(
        rows2,
        fixed_forces,
        forces_of,
        rows @ fixed_forces,
        sp.csr_array(rows @ forces_of),
        sp.csr_array(transfer @ m1 - m2),
        (inverse.T @ problem.live) @ m1 / problem.live_work,
        problem.live_work,
    )


class PaperProgramme(LimitAnalysisFamily):
    """The paper's own programme (8)-(11) in reduced unknowns, by Ipopt (`la-paper`)."""

    def answer(self, assembly: Assembly, problem: Problem, newton: NewtonMatrix, settings: Any) -> Answer:
        """A local solution of the programme, made exact on the mechanism it ends at."""
        if assembly.n_free > settings.max_blocks:
            return Answer(
                Status.REFUSED,
                Finding.NONE,
                f"The programme of the paper is not reliable above {settings.max_blocks} blocks; "
                f"this wall has {assembly.n_free}. Use la, or raise max_blocks.",
            )
        start = None
        if settings.start == "fe":
            given = finite_element_answer(assembly, "fe")
            if given.finding is not Finding.COLLAPSES or given.forces is None:
                return without_start(given)
            start = given.forces / problem.unit_force
        try:
            result = _solve_paper_programme(problem, start, settings.max_iterations, settings.epsilons)
        except (ValueError, NumericalFailure) as error:
            return not_converged(f"The programme could not be set up or solved: {error}")
        return _paper_answer(problem, newton, result, settings.start, LA_PAPER.tolerance)


def _paper_answer(problem: Problem, newton: NewtonMatrix, result: _PaperResult, start: str, tolerance: float) -> Answer:
    """The exact state on the mechanism that the programme ends at, with what the programme itself said."""
    details: dict[str, Any] = {
        "unknowns": result.unknowns,
        "programme_value": result.multiplier * problem.unit_multiplier,
        "solver_message": result.message,
        "start": start,
    }
    if not (np.all(np.isfinite(result.forces)) and np.all(np.isfinite(result.rates))):
        return not_converged(f"Ipopt ended with {result.message}.", result.iterations, details)
    search = Search(problem, newton)
    state = search.nearest_state(problem.slacks(result.forces), result.rates)
    if state is None and not search.finds_motion():
        return unbounded_answer(NO_MOTION, result.iterations, details)
    if state is None:
        return not_converged(
            f"Ipopt ended with {result.message} and no collapse state lies near its end.", result.iterations, details
        )
    multiplier = problem.to_multiplier(state.multiplier)
    return collapse_answer(
        problem,
        polished(problem, newton, state),
        f"The programme of the paper leads to a collapse state at {multiplier:.7g}, a local solution.",
        tolerance,
        result.iterations,
        details,
    )
