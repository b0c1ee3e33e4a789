"""Proof that a collapse state is the least: branch and bound on which contacts press and which move.

In a collapse state every contact k has y_k = 0 or g_k = 0. A node of the tree holds some contacts tight (y = 0) and
some still (g = 0), and two linear programmes bound the multipliers of all states within it: the least one of forces
with those slacks at zero; and, by virtual work, the least work -dead.u of mechanisms with those rates at zero and unit
live work, for friction only takes more. Where forces and mechanism are complementary the node is a collapse state;
elsewhere it is divided at the contact of the largest product y_k g_k. Neither bound needs one on forces or rates.
What the tree gives up is bounded again by vertices that are right to rounding of their own terms; without that it
proves nothing. The number of nodes grows exponentially with the interfaces.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np

from harness.model.assembly import BoolArray, FloatArray
from methods.la.core.problem import Problem
from methods.la.core.programmes import KinematicProgramme
from methods.la.core.state import CollapseState
from methods.la.core.vertex_programmes import ForceProgramme, rates_against_any_load, row_scaling
from methods.la.sources.search import Search
from methods.numerics.linear_programme import INFINITY
from methods.proof.search.options import CLOSED

_COMPLEMENTARY = 1e-9
"""Work of slacks on rates, in mean block weights, that is rounding."""
_AGREES = 1e-7
"""Difference of two scaled multipliers that linear programmes leave."""
_PER_LEAF = 3
"""Programmes that a leaf may take for a proof of its part of a tree that does not end."""


@dataclass(frozen=True)
class TreeProof:
    """What the tree shows.

    Attributes:
        state: the collapse state of least multiplier that is found by then.
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


def prove(search: Search, known: CollapseState, most: int, leaves: int | None = None) -> TreeProof:
    """The least collapse state and the bound that a tree of `most` nodes proves, as far as the budget goes.

    A tree that does not come to an end is cut back to its first divisions where the whole takes too many programmes to
    be bounded to rounding.

    Args:
        search: of the wall, which stands under its dead load; known: its least collapse state so far.
        most: with none, all that is said is that no multiplier is negative.
        leaves: of a tree that does not come to an end, which are bounded to rounding at most; None as the budget says.
    """
    if most == 0:
        return TreeProof(known, 0.0, 0)
    tree = _Tree(search, known)
    nothing = np.zeros((search.problem.n_interfaces, 4), dtype=bool)
    tree.add(nothing, nothing, 0.0)
    while tree.open and len(tree.parts) < most and search.budget.programmes and tree.open[0][0] < tree.limit:
        tree.divide()
    limits = search.budget.limits
    ended = tree.bound() >= tree.limit and search.budget.programmes >= _PER_LEAF * len(tree.leaves())
    allowed = min(limits.leaves if leaves is None else leaves, search.budget.programmes // _PER_LEAF)
    first = (min(tree.divisions, max(allowed - 1, 0)), _PER_LEAF * allowed)
    whole = (tree.divisions, search.budget.programmes if ended else min(limits.certificates, search.budget.programmes))
    for divisions, programmes in (whole,) if ended else (whole, first) if leaves is None else (first,):
        bound = min(tree.bound(divisions), tree.limit)
        if not ended:
            bound = _below(bound)
        given_up = tree.leaves(divisions)
        if bound <= 0.0:  # It needs no certificate, and the first divisions prove no more than all.
            break
        if _bounded_to_rounding(search, given_up, bound, programmes):
            return TreeProof(tree.known, bound, len(tree.parts), tuple((part.tight, part.still) for part in given_up))
    return TreeProof(tree.known, 0.0, len(tree.parts))


def _below(multiplier: float) -> float:
    """From where on no other multiplier is sought."""
    return multiplier - CLOSED * abs(multiplier) - 1e-12


@dataclass
class TreePart:
    """The states with slacks `tight` and rates `still` (m, 4) at zero.

    Attributes:
        bound: on their multipliers; infinite where it is closed.
        born, divided: number of divisions of the tree before it was there, and when it was divided itself.
        contact: to divide it at; least_work: the bound of its rates alone, which its first half shares.
    """

    tight: BoolArray
    still: BoolArray
    bound: float
    born: int
    divided: float = np.inf
    contact: tuple[int, int] = (0, 0)
    least_work: float = -np.inf


class _Tree:
    """Parts of all states there are; the open ones with the least bound first."""

    def __init__(self, search: Search, known: CollapseState) -> None:
        self._search = search
        self._work = _DeadWork(search.problem)
        self.known = known
        self.parts: list[TreePart] = []
        self.open: list[tuple[float, int]] = []
        self.divisions = 0

    @property
    def limit(self) -> float:
        """Multiplier from which on no other state is sought."""
        return _below(self.known.multiplier)

    def leaves(self, divisions: int | None = None) -> list[TreePart]:
        """The parts that there were after so many divisions, by default after all."""
        count = self.divisions if divisions is None else divisions
        return [part for part in self.parts if part.born <= count < part.divided]

    def bound(self, divisions: int | None = None) -> float:
        """The least bound of these."""
        return min(part.bound for part in self.leaves(divisions))

    def divide(self) -> None:
        """Divide the open part of the least bound at its contact: no slack there, or no rate."""
        parent = self.parts[heapq.heappop(self.open)[1]]
        held = np.zeros(parent.tight.shape, dtype=bool)
        held[parent.contact] = True
        parent.divided = self.divisions = self.divisions + 1
        self.add(parent.tight | held, parent.still, parent.bound, parent.least_work)
        self.add(parent.tight, parent.still | held, parent.bound)

    def add(self, tight: BoolArray, still: BoolArray, bound: float, least_work: float | None = None) -> None:
        """Bound a part; close it, or keep it with the contact to divide it at.

        Args:
            tight, still: (m, 4) contacts; bound: of its parent; least_work: of its `still`, if known.
        """
        part = TreePart(tight, still, bound, self.divisions)
        self.parts.append(part)
        if self._decide(part, least_work):
            heapq.heappush(self.open, (part.bound, len(self.parts) - 1))

    def _decide(self, part: TreePart, least_work: float | None) -> bool:
        """Bound a part; whether it is to be divided. One that no programme decides keeps the bound of its parent."""
        search, spent = self._search, self._search.budget.spent
        spent.programmes += 1
        statics = search.static.solve(part.tight)
        if statics == "infeasible" or (not isinstance(statics, str) and statics.multiplier >= self.limit):
            part.bound = np.inf
            return False
        if least_work is None:
            spent.programmes += 1
            least_work = self._work.least(~part.still)
        part.least_work = least_work
        if least_work >= self.limit:
            part.bound = np.inf
            return False
        if isinstance(statics, str):
            return False
        part.bound = max(part.bound, statics.multiplier, least_work)
        slack = np.maximum(search.problem.slacks(statics.forces), 0.0)
        spent.programmes += 1
        mechanism = search.kinematic.solve(~part.still, slack)
        if mechanism is None:
            return False
        work = np.where(part.tight | part.still, 0.0, slack * mechanism.rates)
        if work.sum() > _COMPLEMENTARY:
            row, column = np.unravel_index(int(work.argmax()), work.shape)
            part.contact = (int(row), int(column))
            return True
        state = search.state_of(mechanism.velocities, mechanism.rates)
        if state is not None and state.multiplier <= statics.multiplier + _AGREES:
            part.bound = np.inf
        if state is not None and state.multiplier < self.known.multiplier:
            self.known = state
        return False


def _bounded_to_rounding(search: Search, parts: list[TreePart], limit: float, programmes: int) -> bool:
    """Whether every part is found to have a bound of at least `limit` that is computed to rounding of its own terms.

    The tree itself trusts programmes that round at 1e-9 of a mean block weight.

    Args:
        search: of the wall; parts: of the tree; limit: scaled multiplier; programmes: after which it is given up.
    """
    certificates, spent = LeafCertificates(search, limit), search.budget.spent
    last = spent.programmes + programmes
    return all(spent.programmes < last and certificates.bound(part) for part in sorted(parts, key=_held))


def _held(part: TreePart) -> int:
    return int((part.tight | part.still).sum())


class LeafCertificates:
    """Exact vertices that bound parts of a tree from below, each wherever it holds.

    By weak duality a vertex bounds every part that holds at zero the contacts where its multipliers have a sign that
    only these allow: often a few, so that one vertex bounds many parts.

    Args:
        search: of the wall; limit: scaled multiplier that is to be proved.

    Attributes:
        tight, still: contacts (m, 4) without slack, and without rate, that each vertex needs.
    """

    def __init__(self, search: Search, limit: float) -> None:
        self._problem = search.problem
        self._spent = search.budget.spent
        self._units = row_scaling(search.problem)
        self._programme = ForceProgramme(search.problem, self._units)
        self._limit = limit
        self.tight: list[BoolArray] = []
        self.still: list[BoolArray] = []

    def bound(self, part: TreePart) -> bool:
        """Whether no state of a part has a multiplier below the limit: by a vertex known, or else a new one."""
        if _covers(self.tight, part.tight) or _covers(self.still, part.still):
            return True
        first = part.least_work >= self._limit  # What the tree took the bound from is likelier to hold.
        return any(self._by_work(part) if work else self._by_forces(part) for work in (first, not first))

    def _by_forces(self, part: TreePart) -> bool:
        """Whether the multiplier of forces bounds a part; where it does, the contacts that this needs are kept."""
        rates = self._rates(part.tight)
        if rates is not None:
            self.tight.append(part.tight & (rates < 0.0))
        return rates is not None

    def _rates(self, tight: BoolArray) -> FloatArray | None:
        """Rates (m, 4) whose virtual work bounds the multiplier of forces with slacks `tight` at zero, if any do."""
        self._spent.programmes += 1
        least = self._programme.extreme(greatest=False, tight=tight)
        if not isinstance(least, str):
            return least.kinematics.rates if least.statics.multiplier >= self._limit else None
        if least != "infeasible":
            return None
        self._spent.programmes += 1
        return rates_against_any_load(self._problem, self._units, tight)

    def _by_work(self, part: TreePart) -> bool:
        """Whether the work of mechanisms bounds a part; where it does, the contacts that this needs are kept."""
        self._spent.programmes += 1
        found = self._programme.least_dead_work(part.still)
        if found == "unbounded":
            self.still.append(part.still)
            return True
        if isinstance(found, str) or found.work < self._limit:
            return False
        self.still.append(part.still & found.needs)
        return True


def _covers(needed: list[BoolArray], held: BoolArray) -> bool:
    return any(bool(np.all(held[contacts])) for contacts in needed)


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
