"""The answer of a method for a wall whose joints crush, from its answers for walls whose joints are set in.

The forces that a method finds tell how far joints are pressed, `methods.numerics.pressed_strips` sets them in by that,
and the method answers again. At the end the collapse state of the wall that is set in is that of the stress blocks too:
`methods.numerics.pressed_state` finds no other multiplier beside it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.method import Answer, Finding, Status
from methods.numerics.claims import growing_forces, no_answer
from methods.numerics.pressed_state import PressedState, exact_state, moving_rows
from methods.numerics.pressed_strips import at_ends, pressed_shares, set_in
from methods.numerics.stress_blocks import greatest_by_chords

Solve = Callable[[Assembly], Answer]


@dataclass(frozen=True)
class StripTolerances:
    """When shares and answers belong to each other.

    Attributes:
        agrees: difference of the multipliers of a wall that is set in and of the stress blocks, relative to them or to
            the load unit; the second is exact, and their distance shows that its shares lead to it.
        settled: change of shares at which forces of rest are within the stress blocks to rounding.
        most: share above which a joint has no length left to set in.
        rounds: of answers, at most.
    """

    agrees: float = 1e-6
    settled: float = 1e-12
    most: float = 0.999
    rounds: int = 20


def by_strips(assembly: Assembly, solve: Solve, options: StripTolerances = StripTolerances()) -> Answer:
    """The answer for a component whose joints crush.

    Args:
        assembly: the component; solve: answers for the same with joints that do not crush and are set in.
        options: when it is found.
    """
    share = stood = np.zeros(assembly.n_interfaces)
    way, distance = 1.0, np.inf
    answer = Answer(Status.NOT_CONVERGED, Finding.NONE, "")
    for rounds in range(1, options.rounds + 1):
        wall = set_in(assembly, share)
        answer = solve(wall)
        if abs(share - stood).max() > 0.0 and is_lost(assembly, answer):
            share = 0.5 * (share + stood)  # pressed by forces of a state that is further from this one
            continue
        ends = ends_at(assembly, answer, share)
        if ends is not None:
            return ends
        assert answer.forces is not None
        stood, forces = share, at_ends(share, answer.forces)
        if answer.finding is Finding.COLLAPSES:
            state = _state_beside(assembly, wall, answer, forces)
            if state is not None:
                if _agree(assembly, answer, state, options.agrees):
                    return _with_state(answer, state, rounds)
                forces = state.forces
        towards = np.minimum(pressed_shares(assembly, forces), options.most) - share
        # Two states that lead to each other would take turns for ever: half the way, then, and half of that.
        way = 0.5 * way if abs(towards).max() > 0.7 * distance else way
        distance = abs(towards).max()
        share = share + way * towards
        if answer.finding is Finding.STANDS and abs(share - stood).max() <= options.settled:
            return replace(answer, forces=forces)
    near = "" if answer.multiplier is None else f"; the last of them collapses at {answer.multiplier:.6g}"
    return not_found(
        assembly,
        answer,
        f"no collapse state of the joints that crush belongs to any of {options.rounds} walls whose joints were set in "
        f"by what they press{near}",
    )


def is_lost(assembly: Assembly, answer: Answer) -> bool:
    """Whether a wall set in has no state to follow, although statics does not show that the wall itself falls."""
    lost = answer.finding in (Finding.FALLS, Finding.NONE) and answer.status is not Status.REFUSED
    return lost and _falling_mechanism(assembly) is None


def ends_at(assembly: Assembly, answer: Answer, share: FloatArray) -> Answer | None:
    """The answer where that for a wall set in by shares (m,) leaves nothing to follow; None where it has forces.

    A wall that falls although nothing crushes falls. One that falls as it is set in need not.
    """
    if answer.finding is Finding.FALLS:
        proof = _falling_mechanism(assembly)
        if proof is not None:
            return _falls(answer, proof)
        sentence = "the wall falls as its joints are set in, which does not show that it falls: statics finds no proof"
        return no_answer(answer, sentence) if np.any(share) else answer
    if answer.finding is Finding.UNBOUNDED:
        return _without_end(assembly, answer)
    goes_on = answer.status is Status.OK and answer.forces is not None and answer.flow != "associated"
    if goes_on or answer.status is Status.REFUSED:
        return None if goes_on else answer
    return no_answer(answer, f"a wall whose joints are set in has no answer to go on from: {answer.sentence}")


def _falling_mechanism(assembly: Assembly) -> FloatArray | None:
    """A dilatant mechanism (n, 3) on which the dead load does more work than the joints take; None if none is found."""
    own = greatest_by_chords(assembly, np.zeros_like(assembly.dead), assembly.dead, 2.0)
    return own.mechanism if own.upper < 1.0 else None


def _with_state(answer: Answer, state: PressedState, rounds: int) -> Answer:
    """The answer with an exact state of the stress blocks in place of that of a wall that is set in."""
    sentence = (
        f"The wall collapses at {state.multiplier:.7g} times the live load, with joints that crush: a state of "
        f"their stress blocks, found in round {rounds} of setting joints in to the middle of what they press."
    )
    answer = at_state(answer, state)
    return replace(answer, sentence=sentence, details=answer.details | {"set_in_walls": rounds})


def at_state(answer: Answer, state: PressedState) -> Answer:
    """An answer with a state of the stress blocks in place of its own, and without what is true of that alone."""
    return replace(
        answer,
        multiplier=state.multiplier,
        forces=state.forces,
        forces_multiplier=state.multiplier,
        mechanism=state.mechanism,
        details={name: value for name, value in answer.details.items() if name not in _OF_OTHER_JOINTS},
    )


_OF_OTHER_JOINTS = (
    *("proved_least", "lower_bound", "proof_nodes", "certificate", "certified_bound", "rational_confirmation"),
    *("associated", "starts_at_least_known", "starts_agree", "residuals", "work_multiplier", "plateau"),
)
"""Details of answers that are true of the wall that is set in alone."""


def _state_beside(assembly: Assembly, wall: Assembly, answer: Answer, forces: FloatArray) -> PressedState | None:
    """The exact state of the stress blocks by the mechanism of an answer for a wall set in; None without any."""
    if answer.mechanism is None:
        return None
    state = exact_state(assembly, forces, moving_rows(wall, answer.mechanism))
    return state if state is not None and state.multiplier > 0.0 else None


def _agree(assembly: Assembly, answer: Answer, state: PressedState, within: float) -> bool:
    assert answer.multiplier is not None
    size = max(assembly.load_unit, state.multiplier)
    return abs(answer.multiplier - state.multiplier) <= within * size


def _without_end(assembly: Assembly, answer: Answer) -> Answer:
    """The answer where the live load grows for ever in joints that do not crush; else nothing is known."""
    if growing_forces(assembly) is not None:
        return replace(answer, forces=None, forces_multiplier=None)
    return no_answer(
        answer,
        "the live load presses joints the more the greater it is, until they crush evenly, which is not followed; "
        "la-associated gives the upper bound",
    )


def _falls(answer: Answer, mechanism: FloatArray) -> Answer:
    """The answer where statics shows that the dead load is not borne, by a dilatant mechanism (n, 3)."""
    sentence = "the wall falls under its dead load: no equilibrium within the stress blocks exists, whatever the flow"
    return replace(
        no_answer(answer, sentence), status=Status.OK, finding=Finding.FALLS, mechanism=mechanism, flow="associated"
    )


def not_found(assembly: Assembly, answer: Answer, sentence: str) -> Answer:
    """The answer of a run that came to none, in a sentence; unless statics shows that the wall falls."""
    proof = _falling_mechanism(assembly)
    return no_answer(answer, sentence) if proof is None else _falls(answer, proof)
