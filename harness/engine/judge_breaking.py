"""The judge of walls that collapse as brittle joints break: what they bear before, and that nothing is left after."""

from __future__ import annotations

from dataclasses import replace

from harness.engine.brittle_checks import listed, unused_strength
from harness.engine.judge_dead_load import shown_to_fall
from harness.engine.judge_decision import NO_FORCES, apart, beyond_prestress, decide, said_of
from harness.engine.residuals import force_residuals
from harness.model.assembly import Assembly, FloatArray
from harness.model.details import AnswerDetails
from harness.model.result import Judgement, Result


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
    residuals["breaking"] = unused_strength(wall, forces, at, breaking)
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
