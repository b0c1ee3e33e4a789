"""What is claimed of walls whose joints crush, from answers for walls within tangents of their stress blocks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Status, none_above
from methods.numerics.claims import no_answer
from methods.numerics.stress_blocks import greatest_by_chords

_WITHIN = "within tangents of its stress blocks"


def falls_by_statics(assembly: Assembly) -> Answer | None:
    """The answer for a wall whose dead load is not borne whatever the flow; None where statics does not show that.

    It comes first: a wall within tangents may bear a dead load that crushes this one, which a live load may lift again.
    Its mechanism is a dilatant one on which the dead load does more work than the joints take.
    """
    own = greatest_by_chords(assembly, np.zeros_like(assembly.dead), assembly.dead, 2.0)
    if own.mechanism is None or not own.upper < 1.0:
        return None
    sentence = "the wall falls under its dead load: no equilibrium within the stress blocks exists, whatever the flow"
    return Answer(Status.OK, Finding.FALLS, sentence, mechanism=own.mechanism, flow="associated")


def ends_at(answer: Answer, tangents: int) -> Answer | None:
    """The answer where that for a wall within so many tangents leaves nothing to follow; None where it has forces.

    A wall that falls although nothing crushes falls. One that falls within tangents, of which statics finds no proof,
    does not show that it falls.
    """
    if answer.finding is Finding.FALLS:
        sentence = f"the wall falls {_WITHIN}, which does not show that it falls: statics finds no proof"
        return no_answer(answer, sentence) if tangents else answer
    if answer.finding is Finding.UNBOUNDED:
        return replace(answer, forces=None, forces_multiplier=None)
    goes_on = answer.status is Status.OK and answer.forces is not None and answer.flow != "associated"
    if goes_on or answer.status is Status.REFUSED:
        return None if goes_on else answer
    return no_answer(answer, f"the wall {_WITHIN} has no answer to go on from: {answer.sentence}")


def not_found(answer: Answer, sentence: str, upper: float) -> Answer:
    """The answer of a run that came to none, in a sentence, with what statics bears at most, if that is finite."""
    if not np.isfinite(upper):
        return no_answer(answer, sentence)
    bounded = no_answer(answer, f"{sentence}; {none_above(upper)}")
    return replace(bounded, details=answer.details | {"upper_bound": upper})
