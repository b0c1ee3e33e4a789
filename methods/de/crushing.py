"""Joints that crush in distinct elements: brackets of walls within tangents of the stress blocks.

The tangents are joints in series (`methods.numerics.tangent_search`), with a block between that has the mass of its
neighbour and no weight. Those at the forces of the load that was held before are added until the multiplier stays. Then
the forces held are made to fit the stress blocks to rounding, and the motion measured to joints that turn about the
inner edges of their strips.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from harness.model.assembly import Assembly
from harness.model.details import MOVING_FORCES
from harness.model.method import Answer, Finding, Status
from methods.numerics.claims import growing_forces, no_answer
from methods.numerics.crushing_claims import ends_at, not_found
from methods.numerics.joints_in_series import without_limits
from methods.numerics.pressed_state import held_forces, nearest_motion
from methods.numerics.stress_blocks import pressed_shares
from methods.numerics.tangent_search import Tangents, TangentTolerances, first_tangents, greatest_of_statics

_SETTLED = 1e-3
"""Relative change of the multiplier between two brackets at which they end: a fifth of the accuracy that is stated."""
_ROUNDS = 12
"""Brackets at most."""


def held_within_tangents(assembly: Assembly, solve: Callable[[Assembly], Answer]) -> Answer:
    """The answer for a component whose joints crush; `solve` answers for walls that do not and have further limits."""
    greatest, tolerances = greatest_of_statics(assembly), TangentTolerances()
    tangents, before = first_tangents(assembly, greatest, tolerances), np.nan
    answer = Answer(Status.NOT_CONVERGED, Finding.NONE, "")
    for rounds in range(1, _ROUNDS + 1):
        wall, limits = tangents.wall(assembly)
        of_wall = solve(wall)
        answer = without_limits(of_wall, assembly, limits)
        if answer.finding is Finding.UNBOUNDED and growing_forces(assembly) is None:
            tangents = tangents.where_all_is_pressed(assembly, tolerances)
            continue
        ends = ends_at(answer, len(limits.joint))
        if ends is not None:
            return ends
        assert answer.forces is not None
        multiplier = answer.multiplier or 0.0
        further = tangents.where_outside(assembly, answer.forces, None, tolerances)
        settled = abs(multiplier - before) <= _SETTLED * multiplier
        if answer.finding is Finding.STANDS or settled or further is None:
            held = held_forces(assembly, answer.forces, answer.forces_multiplier or 0.0)
            if held is not None:
                answer = replace(answer, forces=held, details=answer.details | {"searches": rounds})
                return _with_motion(assembly, wall, tangents, of_wall, answer)
        tangents, before = further or tangents, multiplier
    sentence = f"the multiplier did not settle over {_ROUNDS} walls within tangents of their stress blocks"
    return not_found(answer, sentence, greatest.upper)


def _with_motion(assembly: Assembly, wall: Assembly, tangents: Tangents, of_wall: Answer, answer: Answer) -> Answer:
    """The answer with the motion, nearest to that measured, of joints that turn about the edges of their strips.

    Args:
        assembly: whose joints crush; wall: that within these tangents; of_wall: the answer for it, as it was measured;
        answer: that for the wall whose joints crush.
    """
    if of_wall.mechanism is None or MOVING_FORCES not in of_wall.details:
        return answer
    borne = np.asarray(of_wall.details[MOVING_FORCES])
    rates = wall.law.rates((wall.kinematic_matrix @ of_wall.mechanism[wall.free].ravel()).reshape(-1, 3))
    # An end opens that bears less than it opens, relative to a block and to the fastest rate; the rest is noise.
    bears = wall.law.slacks(borne)[:, :2] * wall.n_free / wall.force_scale
    rates[:, :2] = np.where(bears <= rates[:, :2] / rates.max(), rates[:, :2], 0.0)
    share = np.clip(pressed_shares(assembly, borne[: assembly.n_interfaces]), 0.0, 1.0)
    motion = nearest_motion(assembly, share, tangents.rates_of_joints(rates))
    if motion is None:
        return no_answer(
            answer, "the wall within tangents of its stress blocks moves as one whose joints crush does not"
        )
    return replace(answer, mechanism=motion)
