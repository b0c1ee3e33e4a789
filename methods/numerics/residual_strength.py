"""The answer for a wall whose joints have strength, with that for the same wall without: plastic and residual."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from harness.model.assembly import Assembly
from harness.model.deadline import best_so_far
from harness.model.details import BAR_FORCES, DEAD_BAR_FORCES, MOVING_FORCES
from harness.model.errors import as_sentence
from harness.model.method import Answer, Finding, Status
from harness.model.result import bears_less_with_strength
from methods.numerics.claims import analysed


def plastic_and_residual(assembly: Assembly, solve: Callable[[Assembly], Answer], *, most: bool = False) -> Answer:
    """The answer for a wall, and where its joints have strength, that for the wall without it too.

    Args:
        assembly: the wall; solve: answers for a wall.
        most: whether it answers with the most that statics allows, as an associated maximum.
    """
    plastic = solve(assembly)
    if not assembly.strong or plastic.status is not Status.OK:
        return plastic
    said = "The time was over before the wall without strength was solved."
    residual = best_so_far(lambda: solve(assembly.residual), lambda: Answer(Status.NOT_CONVERGED, Finding.NONE, said))
    return _between(assembly, plastic, residual, most) if assembly.breaks else _with_residual(plastic, residual)


def by_component(assembly: Assembly, solve: Callable[[Assembly], Answer]) -> Answer:
    """As `plastic_and_residual`, where `solve` answers for an independent component of the wall."""
    return plastic_and_residual(assembly, lambda wall: analysed(wall, solve))


def _with_residual(plastic: Answer, residual: Answer) -> Answer:
    """The answer of a wall whose joints keep their strength, with that of the same wall without.

    Joints of mortar are brittle: what is left of them once they have moved is friction, the residual strength. Its
    whole answer goes along as `details["without_strength"]`, so that the judge can tell whether it is right.
    """
    rely = "Rely on the residual answer"
    if residual.flow == "associated" and residual.finding is not Finding.FALLS:
        rely = "Both are upper bounds: rely on the least residual multiplier (`la`)"
    if residual.status is not Status.OK:
        rely = "Rely on the residual answer of another method"
    reason = "because joints of mortar are brittle"
    if bears_less_with_strength(plastic, residual):
        rely, reason = (
            "Rely on the lower one, with strength",
            "which a wall without dilatancy may need less to collapse",
        )
    said = _residual_in_words(residual, "cohesion and tensile strength")
    sentence = f"{as_sentence(plastic.sentence)} That is with plastic strength of the joints; {said}. {rely}, {reason}."
    return replace(plastic, sentence=sentence, details=plastic.details | {"without_strength": _as_detail(residual)})


def _between(assembly: Assembly, plastic: Answer, residual: Answer, most: bool) -> Answer:
    """One of the two answers for a wall with brittle joints, with the other: a safe and an upper estimate.

    An associated maximum is an upper bound if its joints keep their strength, so that is the one returned, with
    `details["without_strength"]`. The least collapse state known is one in which all brittle joints are broken:
    `details["broken"]` lists them, and the plastic answer is `details["with_strength"]`. Proofs that no state of the
    broken wall lies lower say nothing of states in which joints are whole, and are left out.
    """
    number = int(assembly.brittle.sum())
    because = f"Because {number} of the joints {'is' if number == 1 else 'are'} brittle"
    follows = "" if assembly.crushes or assembly.dilates else "; `fe` follows how they break"
    if most or residual.status is not Status.OK:
        said = _residual_in_words(residual, "the strength of brittle joints")
        sentence = (
            f"{as_sentence(plastic.sentence)} That is as if all joints kept their strength, an upper estimate; {said}. "
            f"{because}, the answer of the wall lies between the least residual one (`la`) and this{follows}."
        )
        return replace(plastic, sentence=sentence, details=plastic.details | {"without_strength": _as_detail(residual)})
    kept = {name: value for name, value in residual.details.items() if name not in _OF_PROOFS}
    estimate, this = "a safe estimate", "this"
    if bears_less_with_strength(plastic, residual):
        estimate, this = "which is no safe estimate", "that"
    known = "upper bound" if plastic.flow == "associated" else "least known"
    whole = f"the {known} would be {plastic.multiplier:.7g}" if plastic.multiplier is not None else (
        f"the answer would be: {plastic.finding}"
    )  # fmt: skip
    between = f" {because}, the answer of the wall lies between {this} and that of `la-associated`{follows}."
    broken = as_sentence(residual.sentence)
    sentence = (
        f"With all brittle joints broken, {estimate}: {broken[:1].lower()}{broken[1:]} If all joints kept their "
        f"strength, {whole}.{'' if plastic.finding is residual.finding is Finding.FALLS else between}"
    )
    own = {"broken": np.flatnonzero(assembly.brittle).tolist(), "with_strength": _as_detail(plastic)}
    return replace(residual, sentence=sentence, details=kept | own)


_OF_PROOFS = ("proved_least", "lower_bound", "certificate", "certified_bound")
"""Details that prove no state to lie lower."""


def _residual_in_words(residual: Answer, without: str) -> str:
    """The residual multiplier or finding, in the middle of a sentence."""
    if residual.status is not Status.OK:
        return f"what it bears without {without} was not found"
    if residual.multiplier is not None:
        return f"without {without} it is {residual.multiplier:.7g}, the residual multiplier"
    return f"without {without} the answer is: {residual.finding}"


def _as_detail(answer: Answer) -> dict[str, Any]:
    """An answer as JSON values in the details of another, with what its proof needs."""
    return {
        "status": str(answer.status),
        "finding": str(answer.finding),
        "sentence": answer.sentence,
        "multiplier": answer.multiplier,
        "bracket": None if answer.bracket is None else list(answer.bracket),
        "bracket_meaning": answer.bracket_meaning,
        "forces": None if answer.forces is None else answer.forces.tolist(),
        "forces_multiplier": answer.forces_multiplier,
        "mechanism": None if answer.mechanism is None else answer.mechanism.tolist(),
        "flow": answer.flow,
        "details": {
            name: answer.details[name]
            for name in ("live_forces", "dilatant_mechanism", "dead_forces", MOVING_FORCES, BAR_FORCES, DEAD_BAR_FORCES)
            if name in answer.details
        },
    }
