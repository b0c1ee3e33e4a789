"""Associated limit analysis of walls whose joints crush: what the greatest multipliers of dead and live load say."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.method import Answer, Finding, Status
from methods.la.answers import falls_answer, not_converged, unbounded_answer
from methods.numerics.stress_blocks import BlockLimit, Greatest

_ROUGH = (
    " The solver ended without the accuracy asked of it: the answer is as good as the two multipliers agree and the "
    "judge finds."
)
_STATED = 1e-6
"""Gap between the multipliers of forces and mechanism, relative to the larger or to the load unit, that is accepted."""


def crushing_answer(assembly: Assembly, greatest: Greatest) -> Answer:
    """The associated answer for a component with joints that crush; `greatest` solves for a greatest multiplier."""
    own = dead_load_decides(assembly, greatest)
    if isinstance(own, Answer):
        return own
    found = greatest(assembly, assembly.dead, assembly.live, np.inf)
    if found.outcome == "unbounded":
        answer = unbounded_answer("Statically the live load can grow without limit.", found.rounds)
        answer.forces, answer.forces_multiplier = own, 0.0
        return answer
    return _collapse(assembly, found)


def dead_load_decides(assembly: Assembly, greatest: Greatest) -> Answer | FloatArray:
    """The answer where the dead load decides, else the contact forces (m, 3) by which it is borne.

    Unloaded joints are within yield and the domain is convex, so that the dead load is borne if and only if its own
    greatest multiplier is one or more; where it is less, the mechanism shows the fall.

    Args:
        assembly: the component; greatest: solves for a greatest multiplier.
    """
    none = np.zeros_like(assembly.dead)
    own = greatest(assembly, none, assembly.dead, 2.0)  # twice the dead load is enough to know
    if own.outcome != "optimal" or own.forces is None:
        return not_converged(f"Whether the wall stands under its dead load was not decided: {own.outcome}.", own.rounds)
    if own.multiplier < 1.0:
        if own.mechanism is not None and own.upper < 1.0:
            return falls_answer(assembly, own.mechanism)
        return not_converged("The dead load is at the limit of what the wall bears, to rounding.", own.rounds)
    forces = own.forces / own.multiplier
    if not assembly.has_live_load:
        return Answer(
            Status.OK,
            Finding.STANDS,
            "Under its dead load the wall has an equilibrium within yield; no live load is given."
            + (_ROUGH if own.inaccurate else ""),
            forces=forces,
            forces_multiplier=0.0,
            iterations=own.rounds,
        )
    return forces


def _collapse(assembly: Assembly, found: BlockLimit) -> Answer:
    gap = (found.upper - found.multiplier) / max(assembly.load_unit, abs(found.upper))
    if found.outcome != "optimal" or not gap <= _STATED:
        return not_converged(f"The programme ended as {found.outcome}, with the gap {gap:.2g}.", found.rounds)
    multiplier = max(found.multiplier, 0.0)
    return Answer(
        Status.OK,
        Finding.COLLAPSES,
        f"The greatest multiplier within statics and yield, crushing included, is {multiplier:.7g}, an upper bound "
        f"whatever the flow; by virtual work on its mechanism none is above {found.upper:.7g}."
        f"{_ROUGH if found.inaccurate else ''}",
        multiplier=multiplier,
        forces=found.forces,
        forces_multiplier=multiplier,
        mechanism=found.mechanism,
        flow="associated",
        iterations=found.rounds,
        details={"duality_gap": gap, "upper_bound": found.upper, "unknowns": 3 * assembly.n_interfaces + 1},
    )
