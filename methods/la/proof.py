"""Proof that a collapse state is the least: branch and bound on which contacts press and which move.

In a collapse state every contact k has y_k = 0 or g_k = 0. A node of the tree holds some contacts tight (y = 0) and
some still (g = 0), and two linear programmes bound the multipliers of all states within it: the least one of forces
with those slacks at zero; and, by virtual work, the least work -dead.u of mechanisms with those rates at zero and unit
live work, for friction only takes more. Where forces and mechanism are complementary the node is a collapse state;
elsewhere it is divided at the contact of the largest product y_k g_k. Neither bound needs one on forces or rates.
What the tree gives up is bounded again by vertices that are right to rounding of their own terms; without that it
proves nothing. The number of nodes grows exponentially with the interfaces: a ring of 25 voussoirs takes a thousand,
blocks of any shape reach that at six or seven blocks.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field

import numpy as np

from harness.model.assembly import BoolArray
from methods.bound.tuning import WINDOWS
from methods.la.extremes import ForceProgramme, Units, bears_no_load, units_of
from methods.la.problem import Problem
from methods.la.programmes import KinematicProgramme
from methods.la.search import Search
from methods.la.state import CollapseState
from methods.numerics.linear_programme import INFINITY

CLOSE = WINDOWS.closed
"""Relative distance below the least multiplier known within which no other is sought."""
COMPLEMENTARY = 1e-9
"""Work of slacks on rates, in mean block weights, that is rounding."""
AGREES = 1e-7
"""Difference of two scaled multipliers that linear programmes leave."""


@dataclass(frozen=True)
class Proof:
    """What the tree shows.

    Attributes:
        state: the collapse state of least multiplier that is known after it.
        lower_bound: scaled multiplier below which there is no collapse state.
        nodes: of the tree, two linear programmes each.
        leaves: slacks held at zero and rates held at zero, (m, 4) each, of every part that was given up.
    """

    state: CollapseState
    lower_bound: float
    nodes: int
    leaves: tuple[tuple[BoolArray, BoolArray], ...] = ()

    @property
    def complete(self) -> bool:
        """Whether the bound meets the state."""
        return self.lower_bound >= _below(self.state.multiplier)


def prove(search: Search, known: CollapseState, most: int) -> Proof:
    """The least collapse state and the bound that a tree of `most` nodes proves.

    Args:
        search: of the wall, which stands under its dead load; known: its least collapse state so far.
        most: with none, all that is said is that no multiplier is negative.
    """
    if most == 0:
        return Proof(known, 0.0, 0)
    tree = _Tree(search, known)
    shape = (search.problem.n_interfaces, 4)
    nothing = np.zeros(shape, dtype=bool)
    tree.add(nothing, nothing, 0.0)
    while tree.open and tree.nodes < most and tree.open[0].bound < _below(tree.known.multiplier):
        node = heapq.heappop(tree.open)
        held = np.zeros(shape, dtype=bool)
        held[node.contact] = True
        tree.add(node.tight | held, node.still, node.bound, node.least_work)
        tree.add(node.tight, node.still | held, node.bound)
    search.tally.programmes += 2 * tree.nodes
    bound = min([tree.undecided, _below(tree.known.multiplier), *(node.bound for node in tree.open[:1])])
    if bound <= 0.0 or not tree.certified():  # a bound of zero needs no certificate
        return Proof(tree.known, 0.0, tree.nodes)
    leaves = tree.closed + [(node.tight, node.still) for node in tree.open]
    return Proof(tree.known, bound, tree.nodes, tuple(leaves))


def _below(multiplier: float) -> float:
    return multiplier - CLOSE * abs(multiplier) - 1e-12


@dataclass(order=True)
class _Node:
    bound: float
    number: int
    tight: BoolArray = field(compare=False)
    still: BoolArray = field(compare=False)
    contact: tuple[int, int] = field(compare=False)
    least_work: float = field(compare=False)


class _Tree:
    """The nodes still open, least bound first; the least bound of nodes that no programme decided."""

    def __init__(self, search: Search, known: CollapseState) -> None:
        self._search = search
        self._work = _DeadWork(search.problem)
        self.known = known
        self.open: list[_Node] = []
        self.closed: list[tuple[BoolArray, BoolArray]] = []
        self.undecided = np.inf
        self.nodes = 0

    def add(self, tight: BoolArray, still: BoolArray, bound: float, least_work: float | None = None) -> None:
        """Bound a node; close it, or keep it with the contact to divide it at.

        Args:
            tight, still: (m, 4) contacts; bound: of its parent; least_work: of its `still`, if known.
        """
        self.nodes += 1
        limit = _below(self.known.multiplier)
        statics = self._search.static.solve(tight)
        if statics == "infeasible" or (not isinstance(statics, str) and statics.multiplier >= limit):
            self.closed.append((tight, still))
            return
        least_work = self._work.least(~still) if least_work is None else least_work
        if least_work >= limit:
            self.closed.append((tight, still))
            return
        if isinstance(statics, str):
            self.undecided = min(self.undecided, bound)
            return
        bound = max(bound, statics.multiplier, least_work)
        slack = np.maximum(self._search.problem.slacks(statics.forces), 0.0)
        mechanism = self._search.kinematic.solve(~still, slack)
        if mechanism is None:
            self.undecided = min(self.undecided, bound)
            return
        work = np.where(tight | still, 0.0, slack * mechanism.rates)
        if work.sum() > COMPLEMENTARY:
            row, column = np.unravel_index(int(work.argmax()), work.shape)
            node = _Node(bound, self.nodes, tight, still, (int(row), int(column)), least_work)
            heapq.heappush(self.open, node)
            return
        self.closed.append((tight, still))
        state = self._search.state_of(mechanism.velocities, mechanism.rates)
        if state is None or state.multiplier > statics.multiplier + AGREES:
            self.undecided = min(self.undecided, bound)
        if state is not None and state.multiplier < self.known.multiplier:
            self.known = state

    def certified(self) -> bool:
        """Whether every part of the tree that is given up has a bound computed to rounding of its own terms.

        The tree itself trusts programmes that round at 1e-9 of a mean block weight.
        """
        problem, limit = self._search.problem, _below(self.known.multiplier)
        if self.undecided < limit:
            return True  # nothing is proved beyond that
        units = units_of(problem)
        programme = ForceProgramme(problem, units)
        given_up = self.closed + [(node.tight, node.still) for node in self.open if node.bound >= limit]
        return all(_bounded(problem, programme, units, tight, still, limit) for tight, still in given_up)


def _bounded(
    problem: Problem,
    programme: ForceProgramme,
    units: Units | None,
    tight: BoolArray,
    still: BoolArray,
    limit: float,
) -> bool:
    """Whether no state with these slacks and rates at zero has a multiplier below the limit, by exact vertices."""
    least = programme.extreme(greatest=False, tight=tight)
    if not isinstance(least, str) and least.statics.multiplier >= limit:
        return True
    if least == "infeasible" and bears_no_load(problem, units, tight):
        return True
    work = programme.least_dead_work(still)
    return work == "unbounded" if isinstance(work, str) else work >= limit


class _DeadWork(KinematicProgramme):
    """min -dead.u of mechanisms without dilatancy and with unit live work."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self._programme.set_costs(0, -problem.dead)

    def least(self, allowed: BoolArray) -> float:
        """The least work in the allowed contacts (m, 4): inf without a mechanism, -inf where it is not known."""
        self._programme.set_columns(self._n, np.zeros(allowed.size), np.where(allowed.ravel(), INFINITY, 0.0))
        status, value, _ = self._programme.run()
        if status == "infeasible":
            return np.inf
        return -float(self.problem.dead @ value[: self._n]) / self.problem.live_work if status == "optimal" else -np.inf
