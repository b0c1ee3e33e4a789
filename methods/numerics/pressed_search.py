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
from methods.numerics.claims import growing_forces
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
        least: the method looks for the least state, so that any exact one is an answer, and the least of them the best.
    """

    agrees: float = 1e-6
    settled: float = 1e-12
    most: float = 0.999
    rounds: int = 20
    least: bool = False


def by_strips(assembly: Assembly, solve: Solve, options: StripTolerances = StripTolerances()) -> Answer:
    """The answer for a component whose joints crush.

    Args:
        assembly: the component; solve: answers for the same with joints that do not crush and are set in.
        options: when it is found.
    """
    share = stood = np.zeros(assembly.n_interfaces)
    answer, least = None, None
    for rounds in range(1, options.rounds + 1):
        wall = set_in(assembly, share)
        answer = solve(wall)
        if answer.finding is Finding.FALLS:
            proof = falling_mechanism(assembly)
            if proof is not None or not share.any():
                return answer if proof is None else replace(answer, mechanism=proof, flow="associated")
            share = 0.5 * (share + stood)
            continue
        if answer.finding is Finding.UNBOUNDED:
            return _without_end(assembly, answer)
        if answer.status is not Status.OK or answer.forces is None:
            return answer
        stood, forces = share, at_ends(share, answer.forces)
        if answer.finding is Finding.STANDS:
            share = np.minimum(pressed_shares(assembly, forces), options.most)
            if abs(share - stood).max() <= options.settled:
                return replace(answer, forces=forces)
            continue
        state = _state_beside(assembly, wall, answer, forces)
        if state is not None:
            if options.least and (least is None or state.multiplier < least[1].multiplier):
                least = answer, state
            if _agree(assembly, answer, state, options.agrees):
                return _with_state(*(least or (answer, state)), rounds)
            forces = state.forces
        share = np.minimum(pressed_shares(assembly, forces), options.most)
    return _with_state(*least, options.rounds) if least is not None else _not_found(answer, options.rounds)


def falling_mechanism(assembly: Assembly) -> FloatArray | None:
    """A dilatant mechanism (n, 3) on which the dead load does more work than the joints take; None if none is found."""
    own = greatest_by_chords(assembly, np.zeros_like(assembly.dead), assembly.dead, 2.0)
    return own.mechanism if own.upper < 1.0 else None


def _with_state(answer: Answer, state: PressedState, rounds: int) -> Answer:
    """The answer with an exact state of the stress blocks in place of that of a wall that is set in."""
    details = {name: value for name, value in answer.details.items() if name not in _OF_OTHER_JOINTS}
    return replace(
        answer,
        sentence=f"With joints that crush the wall collapses at {state.multiplier:.7g} times the live load: the one "
        f"state of the stress blocks that belongs to the last of {rounds} walls whose joints were set in by what they "
        "press.",
        multiplier=state.multiplier,
        forces=state.forces,
        forces_multiplier=state.multiplier,
        mechanism=state.mechanism,
        details=details | {"set_in_walls": rounds},
    )


_OF_OTHER_JOINTS = (
    *("proved_least", "lower_bound", "proof_nodes", "certificate", "certified_bound", "rational_confirmation"),
    *("associated", "starts_at_least_known", "starts_agree", "residuals", "work_multiplier", "plateau"),
)
"""Details of answers that are true of the wall that is set in alone."""


def _state_beside(assembly: Assembly, wall: Assembly, answer: Answer, forces: FloatArray) -> PressedState | None:
    """The exact state of the stress blocks by the mechanism of an answer for a wall set in; None without any."""
    if answer.mechanism is None or not answer.multiplier:
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
    return _nothing(
        answer,
        "the live load presses joints the more the greater it is, until they crush evenly, which is not followed; "
        "la-associated gives the upper bound",
    )


def _not_found(answer: Answer | None, rounds: int) -> Answer:
    """The answer where no state of the stress blocks belongs to the shares by which the joints were set in."""
    assert answer is not None
    near = "" if answer.multiplier is None else f"; the last of them collapses at {answer.multiplier:.6g}"
    return _nothing(
        answer,
        f"no collapse state of the joints that crush belongs to any of {rounds} walls whose joints were set in by what "
        f"they press{near}",
    )


def _nothing(answer: Answer, sentence: str) -> Answer:
    return replace(
        answer,
        status=Status.NOT_CONVERGED,
        finding=Finding.NONE,
        sentence=sentence,
        multiplier=None,
        bracket=None,
        forces=None,
        forces_multiplier=None,
        mechanism=None,
    )
