"""The collapse state where joints crush, of any method: its answers for walls within tangents of the stress blocks.

A stress block bounds the moments about both ends of a joint by n_i + T/2 >= F^2 / (2 F0), F = n1 + n2 + T, of which
each tangent at a share a = F / F0 is a limit on the moment about a point of the joint,

    (1 - a) m1 - a m2 + a^2 F0 / 2 >= 0,   m_i = n_i + T/2,

the row of a joint in series (`methods.numerics.joints_in_series`). The method finds a state within the tangents known
so far; where its forces are outside of a stress block, a tangent at them is added (Kelley 1960), until its collapse
state is one of the stress blocks to rounding (`methods.numerics.pressed_state`). Its flow is theirs too: a joint
turns about the inner edge of its pressed strip. Source: Orduna and Lourenco (2003) for the stress block.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import Assembly, BoolArray, FloatArray, IntArray
from harness.model.deadline import OutOfTime, best_so_far
from harness.model.method import Answer, Finding, Status
from methods.numerics.claims import growing_forces
from methods.numerics.crushing_claims import ends_at, not_found
from methods.numerics.joints_in_series import FurtherLimits, in_series, without_limits
from methods.numerics.pressed_state import PressedState, exact_state, hinges_of_both, moving_rates
from methods.numerics.stress_blocks import BlockLimit, greatest_by_chords, pressed_shares

Solve = Callable[[Assembly], Answer]


@dataclass(frozen=True)
class TangentTolerances:
    """How tangents are added.

    Attributes:
        agrees: difference of the multipliers of a state within tangents and of the exact one of its mechanism, relative
            to them or to the load unit, at which they are the same to rounding.
        broken: slack of a stress block, in mean weights of a block, below which forces are outside.
        apart: relative difference of the shares of two tangents of one end below which the newer replaces the older.
        pressed: least share that has a tangent: below, the joint does as one that does not crush, to rounding.
        rounds: of searches, at most. Once the mechanism stays, each round squares the difference.
    """

    agrees: float = 1e-9
    broken: float = -1e-11
    apart: float = 1e-3
    pressed: float = 1e-6
    rounds: int = 10


def by_tangents(assembly: Assembly, solve: Solve, options: TangentTolerances = TangentTolerances()) -> Answer:
    """The answer for a component whose joints crush, with the least state that is found.

    The first tangents are those at the forces of the greatest multiplier of statics; what is found is within any.

    Args:
        assembly: the component; solve: answers for the same with joints that do not crush and have further limits.
        options: when it is found.
    """
    found: list[Answer] = []

    def known() -> Answer:
        if not found:
            raise OutOfTime
        answer = _least(found)
        return replace(answer, details=answer.details | {"stopped_by_limit": True})

    return best_so_far(lambda: _to_its_end(assembly, solve, options, found), known)


@dataclass(frozen=True, eq=False)
class Tangents:
    """k tangents: their joints (k,), the ends (k,), 0 or 1, whose limit they touch, and the shares (k,)."""

    joint: IntArray
    end: IntArray
    share: FloatArray

    @classmethod
    def at(cls, share: FloatArray, chosen: BoolArray) -> Tangents:
        """Tangents at shares (m,) of the joints, at the ends `chosen` (m, 2)."""
        joint, end = (index.astype(np.int64) for index in np.nonzero(chosen))
        return cls(joint, end, share[joint])

    def with_more(self, more: Tangents, apart: float) -> Tangents:
        """These and more, which replace those that are nearly the same."""
        same = (self.joint[:, None] == more.joint) & (self.end[:, None] == more.end)
        near = same & (abs(self.share[:, None] - more.share) <= apart * more.share)
        kept = ~near.any(axis=1)
        parts = ((getattr(self, name)[kept], getattr(more, name)) for name in ("joint", "end", "share"))
        return Tangents(*(np.concatenate(part) for part in parts))

    def where_outside(
        self, assembly: Assembly, forces: FloatArray, hinge: FloatArray | None, options: TangentTolerances
    ) -> Tangents | None:
        """These and one at every end where forces (m, 3) are outside of a stress block; None where all are within.

        Args:
            hinge: (m,) shares about which the joints turn, where tangents are added too.
        """
        outside = _slacks(assembly, forces) < options.broken * assembly.force_scale / assembly.n_free
        outside &= np.isfinite(assembly.crushing)[:, None]
        if not outside.any():
            return None
        tangents = self
        if hinge is not None:
            tangents = tangents.with_more(Tangents.at(np.maximum(hinge, options.pressed), outside), options.apart)
        share = np.minimum(pressed_shares(assembly, forces), 1.0)
        return tangents.with_more(Tangents.at(share, outside), options.apart)

    def where_all_is_pressed(self, assembly: Assembly, options: TangentTolerances) -> Tangents:
        """These and those that keep the forces of all joints finite, at both ends of each."""
        crushes = np.isfinite(assembly.crushing)[:, None] & np.ones(2, dtype=bool)
        return self.with_more(Tangents.at(np.ones(len(crushes)), crushes), options.apart)

    def limits(self, assembly: Assembly) -> FurtherLimits:
        """Their rows. The force at the other contact point and the shear, which they do not bound, never reach theirs.

        The contact points of a tangent are its point on the joint, and one a length of the joint further towards the
        end that it touches: the force there is the moment about the first, over that length.
        """
        joint, share, k = self.joint, self.share[:, None], len(self.joint)
        along = np.where(self.end == 0, 1.0, -1.0)[:, None] * (assembly.end2 - assembly.end1)[joint]
        about = np.where((self.end == 0)[:, None], assembly.end2[joint], assembly.end1[joint]) - share * along
        first = (self.end == 0)[:, None]
        tension = assembly.constant[joint, 0] + assembly.constant[joint, 1]
        unit = assembly.force_scale / assembly.n_free
        constant = np.empty((k, 4))
        full = assembly.crushing[joint] + tension
        constant[:, 2:] = assembly.constant[joint, 2:] + (assembly.friction[joint] * full + unit)[:, None]
        constant[np.arange(k), 1 - self.end] = tension * (0.5 + self.share) + unit
        constant[np.arange(k), self.end] = tension * (0.5 - self.share) + 0.5 * self.share**2 * full
        return FurtherLimits(
            joint,
            np.where(first, about - along, about),
            np.where(first, about, about - along),
            np.zeros(k),
            np.zeros(k),
            constant,
        )

    def wall(self, assembly: Assembly) -> tuple[Assembly, FurtherLimits]:
        """The wall whose joints do not crush and have these limits, and the limits."""
        limits = self.limits(assembly)
        return in_series(replace(assembly, crushing=np.full(assembly.n_interfaces, np.inf)), limits), limits

    def rates_of_joints(self, rates: FloatArray) -> FloatArray:
        """(m, 4) rates of the rows of the stress blocks, of those (m + k, 4) of a wall with these limits."""
        m = len(rates) - len(self.joint)
        own = rates[:m].copy()
        np.add.at(own, (self.joint, self.end), rates[m + np.arange(len(self.joint)), self.end])
        return own


def _to_its_end(assembly: Assembly, solve: Solve, options: TangentTolerances, found: list[Answer]) -> Answer:
    """As `by_tangents`, in as many rounds as there may be; `found` gets the answers with exact states."""
    greatest = greatest_of_statics(assembly)
    tangents, ended = first_tangents(assembly, greatest, options), ""
    answer = Answer(Status.NOT_CONVERGED, Finding.NONE, "")
    for rounds in range(1, options.rounds + 1):
        wall, limits = tangents.wall(assembly)
        of_wall = solve(wall)
        answer = without_limits(of_wall, assembly, limits)
        if answer.finding is Finding.UNBOUNDED and growing_forces(assembly) is None:
            tangents = tangents.where_all_is_pressed(assembly, options)
            continue
        ends = ends_at(answer, len(limits.joint))
        if ends is not None:
            if answer.finding in (Finding.UNBOUNDED, Finding.FALLS) or answer.status is Status.REFUSED:
                return ends
            ended = f" ({ends.sentence})"
            break
        assert answer.forces is not None
        hinge = None if answer.mechanism is None else _hinge_shares(assembly, answer.mechanism)
        if answer.finding is Finding.COLLAPSES and hinge is not None:
            assert of_wall.mechanism is not None
            rates = tangents.rates_of_joints(moving_rates(wall, of_wall.mechanism))
            state, hinge = _state_near(assembly, answer, rates, hinge, options)
            if state is not None and state.multiplier > 0.0:
                found.append(_with_state(answer, state, rounds))
                assert answer.multiplier is not None
                size = max(assembly.load_unit, state.multiplier)
                if abs(answer.multiplier - state.multiplier) <= options.agrees * size:
                    break
        further = tangents.where_outside(assembly, answer.forces, hinge, options)
        if further is None:
            break
        tangents = further
    if found:
        return _least(found)
    if answer.finding is Finding.STANDS:
        return answer
    sentence = (
        f"no collapse state of the joints that crush is known; {rounds} rounds of a search within tangents of their "
        f"stress blocks led to none{ended}"
    )
    return not_found(answer, sentence, greatest.upper)


def _state_near(
    assembly: Assembly, answer: Answer, rates: FloatArray, hinge: FloatArray, options: TangentTolerances
) -> tuple[PressedState | None, FloatArray]:
    """The exact state near an answer within tangents, if there is one, and the shares (m,) about which joints turn.

    Where the nearest forces leave no mechanism, forces and mechanism are solved for together.

    Args:
        rates: (m, 4) of the rows of its mechanism; hinge: (m,) shares about which its joints turn.
    """
    assert answer.forces is not None
    assert answer.multiplier is not None
    assert answer.mechanism is not None
    moving, turns = rates > 0.0, (rates[:, :2] > 0.0).any(axis=1)
    empty = np.isfinite(assembly.crushing) & turns & (hinge <= options.pressed)
    state = exact_state(assembly, answer.forces, moving, empty)
    if state is not None:
        return state, hinge
    both = hinges_of_both(assembly, PressedState(answer.multiplier, answer.forces, answer.mechanism), rates, empty)
    if both is None:
        return None, hinge
    return exact_state(assembly, answer.forces, moving, empty, both), np.where(turns, both, hinge)


def greatest_of_statics(assembly: Assembly) -> BlockLimit:
    """The greatest multiplier of statics; unknown where there is no live load."""
    if not assembly.has_live_load:
        return BlockLimit("unknown")
    return greatest_by_chords(assembly, assembly.dead, assembly.live)


def first_tangents(
    assembly: Assembly, greatest: BlockLimit, options: TangentTolerances = TangentTolerances()
) -> Tangents:
    """Tangents at the forces of the greatest multiplier of statics, each at the end that these are nearer to."""
    forces = np.zeros((assembly.n_interfaces, 3)) if greatest.forces is None else greatest.forces
    share = np.minimum(pressed_shares(assembly, forces), 1.0)
    return Tangents.at(share, (share > options.pressed)[:, None] & (forces[:, :2] <= forces[:, 1::-1]))


def _hinge_shares(assembly: Assembly, mechanism: FloatArray) -> FloatArray:
    """(m,) shares of the joints beyond the points about which they turn in a mechanism (n, 3), 0 to 1; 0 at rest."""
    strains = (assembly.kinematic_matrix @ mechanism[assembly.free].ravel()).reshape(-1, 3)
    opening = assembly.law.rates(strains)[:, :2]
    closing = np.maximum(-opening.min(axis=1), 0.0)
    turn = np.maximum(np.ptp(opening, axis=1), closing)
    return np.asarray(closing / np.where(turn > 0.0, turn, 1.0))


def _slacks(assembly: Assembly, forces: FloatArray) -> FloatArray:
    """(m, 2) slacks n_i + T/2 - F^2 / (2 F0) of contact forces (m, 3) [force]."""
    ends = assembly.constant[:, :2]
    full = np.where(np.isfinite(assembly.crushing), assembly.crushing + ends.sum(axis=1), 0.0)
    return np.asarray(forces[:, :2] + ends - (0.5 * pressed_shares(assembly, forces) ** 2 * full)[:, None])


def _least(found: list[Answer]) -> Answer:
    return min(found, key=lambda answer: answer.multiplier or 0.0)


def _with_state(answer: Answer, state: PressedState, rounds: int) -> Answer:
    """The answer with an exact state of the stress blocks, and without what is true of the wall within tangents."""
    details = {name: value for name, value in answer.details.items() if name not in _OF_TANGENTS}
    return replace(
        answer,
        sentence=f"The wall collapses at {state.multiplier:.7g} times the live load, with joints that crush: a state "
        f"of their stress blocks, found in round {rounds} of a search within tangents of them.",
        multiplier=state.multiplier,
        forces=state.forces,
        forces_multiplier=state.multiplier,
        mechanism=state.mechanism,
        details=details | {"searches": rounds},
    )


_OF_TANGENTS = (
    *("proved_least", "lower_bound", "proof_nodes", "certificate", "certified_bound", "rational_confirmation"),
    *("associated", "starts_at_least_known", "starts_agree", "residuals", "work_multiplier", "plateau"),
)
"""Details of answers that are true of the wall within tangents alone."""
