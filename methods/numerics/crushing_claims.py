"""What is claimed of walls whose joints crush, from answers for walls within tangents of their stress blocks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import best_so_far
from harness.model.method import Answer, Finding, Status, none_above
from methods.numerics.claims import no_answer
from methods.numerics.stress_blocks import greatest_by_chords


def falling_mechanism(assembly: Assembly) -> FloatArray | None:
    """A dilatant mechanism (n, 3) on which the dead load does more work than the joints take; None if none is found."""
    own = greatest_by_chords(assembly, np.zeros_like(assembly.dead), assembly.dead, 2.0)
    return own.mechanism if own.upper < 1.0 else None


_WITHIN = "within tangents of its stress blocks"


def ends_at(assembly: Assembly, answer: Answer, tangents: int) -> Answer | None:
    """The answer where that for a wall within so many tangents leaves nothing to follow; None where it has forces.

    A wall that falls although nothing crushes falls. One that falls within tangents is shown to by statics.
    """
    if answer.finding is Finding.FALLS:
        proof = falling_mechanism(assembly)
        if proof is not None:
            return falls(answer, proof)
        sentence = f"the wall falls {_WITHIN}, which does not show that it falls: statics finds no proof"
        return no_answer(answer, sentence) if tangents else answer
    if answer.finding is Finding.UNBOUNDED:
        return replace(answer, forces=None, forces_multiplier=None)
    goes_on = answer.status is Status.OK and answer.forces is not None and answer.flow != "associated"
    if goes_on or answer.status is Status.REFUSED:
        return None if goes_on else answer
    return no_answer(answer, f"the wall {_WITHIN} has no answer to go on from: {answer.sentence}")


def falls(answer: Answer, mechanism: FloatArray) -> Answer:
    """The answer where statics shows that the dead load is not borne, by a dilatant mechanism (n, 3)."""
    sentence = "the wall falls under its dead load: no equilibrium within the stress blocks exists, whatever the flow"
    return replace(
        no_answer(answer, sentence), status=Status.OK, finding=Finding.FALLS, mechanism=mechanism, flow="associated"
    )


def falls_by_statics(assembly: Assembly) -> Answer | None:
    """The answer for a wall whose dead load is not borne whatever the flow; None where statics does not show that."""
    proof = falling_mechanism(assembly)
    return None if proof is None else falls(Answer(Status.NOT_CONVERGED, Finding.NONE, ""), proof)


def not_found(assembly: Assembly, answer: Answer, sentence: str) -> Answer:
    """The answer of a run that came to none, in a sentence; unless statics shows that the wall falls."""
    proof = falling_mechanism(assembly)
    return _below_greatest(assembly, answer, sentence) if proof is None else falls(answer, proof)


def _below_greatest(assembly: Assembly, answer: Answer, sentence: str) -> Answer:
    """The answer of a run that came to none, in a sentence, with what statics bears at most where there is time."""
    upper = best_so_far(lambda: greatest_by_chords(assembly, assembly.dead, assembly.live).upper, lambda: np.inf)
    if not np.isfinite(upper):
        return no_answer(answer, sentence)
    bounded = no_answer(answer, f"{sentence}; {none_above(upper)}")
    return replace(bounded, details=answer.details | {"upper_bound": upper})
