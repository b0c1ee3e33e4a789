"""The judge of brittle joints: an answer lists those that it calls broken, and is judged with these dry.

`details["broken"]` has the numbers of the joints that have lost their cohesion and tensile strength, none where it is
missing. Forces bear no tension and no cohesion there. In a mechanism without dilatancy a joint that is called whole
rests: one that opened or slipped would be broken. `details["breaking"]` has those that break at the multiplier of a
collapse; each is at its strength in the forces at this multiplier. That loading leads there depends on the stiffness of
joints, and is not judged.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from harness.engine.judge_dead_load import shown_to_fall
from harness.engine.judge_decision import NO_FORCES, apart, beyond_prestress, decide, said_of
from harness.engine.judge_law import slacks
from harness.engine.measures import Measures, between
from harness.engine.residuals import force_residuals, moving_parts, scaled_to_live_work
from harness.model.assembly import Assembly, BoolArray, FloatArray
from harness.model.details import AnswerDetails
from harness.model.result import Judgement, Result, relative_velocities


def listed(assembly: Assembly, numbers: Any, name: str) -> BoolArray | str:
    """(m,) joints whose numbers an answer lists under a name; or what is wrong with the list."""
    mask = np.zeros(assembly.n_interfaces, dtype=bool)
    if not isinstance(numbers, list) or any(type(p) is not int for p in numbers):
        return f"`{name}` is no list of numbers of joints."
    for p in numbers:
        if not 0 <= p < len(mask):
            return f"`{name}` names the joint {p}, of {len(mask)}."
        if not assembly.brittle[p]:
            ends = (assembly.block_ids[side[p]] for side in (assembly.block_a, assembly.block_b))
            return f"`{name}` names the joint between {' and '.join(ends)}, which is not brittle, or broken before."
        mask[p] = True
    return mask


def motion_of_whole(assembly: Assembly, mechanism: FloatArray) -> float:
    """The fastest opening or slip of a joint that is brittle and whole, each component scaled as for its residuals."""
    fastest = 0.0
    for part, motion in moving_parts(assembly, mechanism)[1]:
        opening, slip = relative_velocities(part.assembly, scaled_to_live_work(part.assembly, motion)[0])
        rates = np.maximum(abs(opening).max(axis=1, initial=0.0), abs(slip))
        fastest = max(fastest, float(rates[part.assembly.brittle].max(initial=0.0)))
    return fastest


def _unused_strength(assembly: Assembly, forces: FloatArray, multiplier: float, joints: BoolArray) -> float:
    """What the joint furthest from its strength would still bear of tension at an end, or of shear, as yield counts.

    A joint that has no shear strength in these forces cannot break by shear.

    Args:
        assembly: the wall; forces: (m, 3) contact forces at the multiplier.
        joints: (m,) whose strength is asked for.
    """
    scale = between(assembly, Measures.of(assembly, forces, multiplier).acting)
    slack = slacks(assembly, forces)
    of_tension, ways = slack[:, :2].min(axis=1), slack[:, 2:]
    of_shear = np.where(ways.max(axis=1) > 1e-6 * scale, ways.min(axis=1), np.inf)
    left = np.minimum(of_tension, of_shear) / scale
    return float(abs(left)[joints].max(initial=0.0))


def judge_breaking(
    wall: Assembly, forces: FloatArray | None, mechanism: FloatArray | None, result: Result, tolerance: float
) -> Judgement:
    """Collapse at the multiplier at which joints of the wall break: what it bears before, and no longer after."""
    multiplier = result.multiplier
    breaking = listed(wall, AnswerDetails(result.details).breaking, "breaking")
    if isinstance(breaking, str):
        return said_of(tolerance, False, breaking)
    if multiplier is None or not breaking.any():
        return said_of(tolerance, False, "It gives no multiplier, or no joint that breaks there.")
    if result.flow == "approximate":
        return said_of(tolerance, False, "It measures a bracket, while joints break at one multiplier.")
    if forces is None:
        return said_of(tolerance, None, NO_FORCES)
    at = multiplier if result.forces_multiplier is None else result.forces_multiplier
    residuals = force_residuals(wall, forces, at, beyond=beyond_prestress(wall, result))
    residuals["breaking"] = _unused_strength(wall, forces, at, breaking)
    residuals["multiplier"] = apart(multiplier, at)
    said = decide(
        residuals, tolerance, f"The forces at multiplier {at:.6g}, with the joints that break at their strength, were"
    )
    if not said.accepted:
        return said
    if mechanism is None or mechanism.shape != (wall.n_blocks, 3):
        said.accepted = None
        said.sentence += " It gives no mechanism, so that nothing bears this once they have broken is not shown."
        return said
    alone = wall.with_broken(breaking)
    alone = replace(alone, dead=alone.dead + multiplier * alone.live)
    proved, own = shown_to_fall(alone, mechanism, tolerance)
    said.residuals = said.residuals | own
    if proved:
        said.sentence += (
            " Without that strength the loads do positive work on the mechanism, with dilatant flow: no equilibrium is "
            "left. That loading breaks these joints depends on their stiffness and is not judged."
        )
        return said
    said.accepted = False
    said.sentence += " The mechanism does not show that no equilibrium is left without that strength."
    return said
