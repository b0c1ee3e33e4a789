"""Joints that crush in distinct elements: walls whose contact points are set in by what is held between two brackets.

The contacts of a joint stand in the middles of its pressed strips (`methods.numerics.pressed_strips`), by the forces of
the load that was held before. Once the multiplier stays, the forces held are made to fit the stress blocks to rounding,
and the motion measured to joints that turn about the inner edges of their strips, which are half a share further in.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.details import MOVING_FORCES
from harness.model.method import Answer, Finding, Status
from methods.numerics.claims import no_answer
from methods.numerics.crushing_claims import ends_at, falling_mechanism, not_found
from methods.numerics.pressed_state import held_forces, nearest_motion
from methods.numerics.pressed_strips import at_ends, pressed_shares, set_in


@dataclass(frozen=True)
class HeldStrips:
    """When the brackets of walls that are set in end.

    Attributes:
        settled: relative change of the multiplier between two brackets: a fifth of the accuracy that is stated.
        most: share above which a joint has no length left to set in.
        rounds: of brackets, at most.
    """

    settled: float = 1e-3
    most: float = 0.999
    rounds: int = 12


def held_by_strips(
    assembly: Assembly, solve: Callable[[Assembly], Answer], options: HeldStrips = HeldStrips()
) -> Answer:
    """The answer for a component whose joints crush; `solve` answers for walls that are set in and do not crush."""
    share = stood = np.zeros(assembly.n_interfaces)
    before = np.nan
    answer = Answer(Status.NOT_CONVERGED, Finding.NONE, "")
    for rounds in range(1, options.rounds + 1):
        answer = solve(set_in(assembly, share))
        if abs(share - stood).max() > 0.0 and _is_lost(assembly, answer):
            share = 0.5 * (share + stood)  # pressed by forces of a load that is further from this one
            continue
        ends = ends_at(assembly, answer, "as its joints are set in" if share.any() else "")
        if ends is not None:
            return ends
        assert answer.forces is not None
        stood, forces = share, at_ends(share, answer.forces)
        multiplier = answer.multiplier or 0.0
        if answer.finding is Finding.STANDS or abs(multiplier - before) <= options.settled * multiplier:
            held = held_forces(assembly, forces, answer.forces_multiplier or 0.0)
            if held is not None:
                return _with_held(assembly, share, answer, held, rounds)
        share, before = np.minimum(pressed_shares(assembly, forces), options.most), multiplier
    sentence = f"the multiplier did not settle over {options.rounds} walls whose joints were set in"
    return not_found(assembly, answer, sentence)


def _is_lost(assembly: Assembly, answer: Answer) -> bool:
    """Whether a wall set in has no state to follow, although statics does not show that the wall itself falls."""
    lost = answer.finding in (Finding.FALLS, Finding.NONE) and answer.status is not Status.REFUSED
    return lost and falling_mechanism(assembly) is None


def _with_held(assembly: Assembly, share: FloatArray, answer: Answer, held: FloatArray, rounds: int) -> Answer:
    """The answer with forces (m, 3) held within the stress blocks, and with the motion that these allow."""
    details = answer.details | {"set_in_walls": rounds}
    if answer.mechanism is None or MOVING_FORCES not in details:
        return replace(answer, forces=held, details=details)
    wall, borne = set_in(assembly, share), np.asarray(details[MOVING_FORCES])
    moving = at_ends(share, borne)
    rates = wall.law.rates((wall.kinematic_matrix @ answer.mechanism[wall.free].ravel()).reshape(-1, 3))
    # An end opens that bears less than it opens, relative to a block and to the fastest rate; the rest is noise.
    bears = wall.law.slacks(borne)[:, :2] * wall.n_free / wall.force_scale
    rates[:, :2] = np.where(bears <= rates[:, :2] / rates.max(), rates[:, :2], 0.0)
    shares = np.clip(pressed_shares(assembly, moving), 0.0, 1.0)
    motion = nearest_motion(assembly, shares, rates)
    if motion is None or motion[1] > 0.5 * shares.max():
        return no_answer(
            answer,
            "the wall whose joints are set in moves as one whose joints crush does not: about the inner edges of their "
            "strips they would turn otherwise, by more than these are apart from the middles",
        )
    details[MOVING_FORCES] = moving.tolist()
    return replace(answer, forces=held, mechanism=motion[0], details=details)
