"""The answer for a wall whose joints have strength, with that for the same wall without: plastic and residual."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from harness.model.assembly import Assembly
from harness.model.deadline import best_so_far
from harness.model.details import BAR_FORCES, DEAD_BAR_FORCES, MOVING_FORCES
from harness.model.method import Answer, Finding, Status


def plastic_and_residual(assembly: Assembly, solve: Callable[[Assembly], Answer]) -> Answer:
    """The answer for a wall, and where its joints have strength, that for the wall without it too.

    Args:
        assembly: the wall; solve: answers for a wall.
    """
    plastic = solve(assembly)
    if not assembly.strong or plastic.status is not Status.OK:
        return plastic
    said = "The time was over before the wall without strength was solved."
    residual = best_so_far(
        lambda: solve(assembly.without_strength), lambda: Answer(Status.NOT_CONVERGED, Finding.NONE, said)
    )
    return with_residual(plastic, residual)


def with_residual(plastic: Answer, residual: Answer) -> Answer:
    """The answer of a wall whose joints keep their strength, with that of the same wall without.

    Joints of mortar are brittle: what is left of them once they have moved is friction, the residual strength. Its
    whole answer goes along as `details["without_strength"]`, so that the judge can tell whether it is right.
    """
    own = {
        "status": str(residual.status),
        "finding": str(residual.finding),
        "sentence": residual.sentence,
        "multiplier": residual.multiplier,
        "bracket": None if residual.bracket is None else list(residual.bracket),
        "bracket_meaning": residual.bracket_meaning,
        "forces": None if residual.forces is None else residual.forces.tolist(),
        "forces_multiplier": residual.forces_multiplier,
        "mechanism": None if residual.mechanism is None else residual.mechanism.tolist(),
        "flow": residual.flow,
        "details": {
            name: residual.details[name]
            for name in ("live_forces", "dilatant_mechanism", "dead_forces", MOVING_FORCES, BAR_FORCES, DEAD_BAR_FORCES)
            if name in residual.details
        },
    }
    if residual.status is not Status.OK:
        said = "what it bears without cohesion and tensile strength was not found"
    elif residual.multiplier is not None:
        said = f"without cohesion and tensile strength it is {residual.multiplier:.7g}, the residual multiplier"
    else:
        said = f"without cohesion and tensile strength the answer is: {residual.finding}"
    rely = "Rely on the residual answer"
    if residual.flow == "associated" and residual.finding is not Finding.FALLS:
        rely = "Both are upper bounds: rely on the least residual multiplier (`la`)"
    sentence = (
        f"{plastic.sentence} That is with plastic strength of the joints; {said}. {rely}, because joints of mortar are "
        "brittle."
    )
    return replace(plastic, sentence=sentence, details=plastic.details | {"without_strength": own})
