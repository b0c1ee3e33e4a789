"""What an answer claims, with what shows it: by statics alone, whichever method the answer comes from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from harness.model.assembly import Assembly, FloatArray
from harness.model.components import analysed_apart
from harness.model.limit import accuracy, gross_power, least_told, strengthened
from harness.model.method import Answer, Finding, OutOfTime, Status
from methods.numerics.statics import admissible_forces, dilatant_mechanism, greatest_multiplier


def bear(assembly: Assembly, answer: Answer, multiplier: float) -> FloatArray | None:
    """Forces (m, 3) with which a component bears its dead load and `multiplier` times the live load; None if none.

    Where the answer holds forces at a higher multiplier, those between it and the dead load do: the cone is convex.
    """
    highest = answer.forces_multiplier
    if answer.forces is not None and highest is not None and highest > multiplier >= 0.0:
        dead = admissible_forces(assembly, assembly.dead)
        if dead is not None:
            share = multiplier / highest
            return (1.0 - share) * dead + share * answer.forces
    return admissible_forces(assembly, assembly.dead + multiplier * assembly.live)


def analysed(assembly: Assembly, solve: Callable[[Assembly], Answer]) -> Answer:
    """The answer of a method for a wall from those for its independent components, with what shows it."""
    return with_proof(assembly, analysed_apart(assembly, lambda part: at_limit(part, solve(part)), bear))


def limit_state(assembly: Assembly) -> tuple[FloatArray, FloatArray] | None:
    """Contact forces (m, 3) and dilatant mechanism (n, 3) of a wall whose greatest multiplier is zero as far as told.

    None for other walls. Where rounding leaves no equilibrium at any multiplier, the strengthened wall has one.
    """
    for wall in (assembly, strengthened(assembly)):
        found = greatest_multiplier(wall)
        if found is not None:
            multiplier, forces, mechanism = found
            return (forces, mechanism) if abs(multiplier) <= least_told(assembly, mechanism) else None
    return None


def at_limit(assembly: Assembly, answer: Answer) -> Answer:
    """The answer, of the finding "at its limit" where that is what it comes to, and without a multiplier below zero.

    A collapse state shows the limit by its own multiplier. A fall by less than the numbers of the wall tell, a motion
    that was only measured at no live load, and a run without an end leave it to statics (`limit_state`).
    """
    try:
        return _at_limit(assembly, answer) if assembly.has_live_load else answer
    except OutOfTime:
        return answer


def _at_limit(assembly: Assembly, answer: Answer) -> Answer:
    """As `at_limit`; raises OutOfTime where the time is over."""
    multiplier, mechanism = answer.multiplier, answer.mechanism
    measured = answer.flow == "approximate"
    if answer.finding is Finding.COLLAPSES and multiplier is not None and mechanism is not None and not measured:
        if abs(multiplier) <= least_told(assembly, mechanism):
            return _zero(answer, answer.forces)
        if multiplier > 0.0:
            return answer
        answer = _below_zero(assembly, answer)
    if not _leaves_open(assembly, answer):
        return answer
    state = limit_state(assembly)
    if state is None:
        return answer
    forces, dilatant = state
    if measured:
        return _zero(answer, forces if answer.forces is None else answer.forces)
    return _zero(replace(answer, mechanism=dilatant, flow="associated"), forces)


def _leaves_open(assembly: Assembly, answer: Answer) -> bool:
    """Whether an answer without an exact collapse state may be that of a wall at its limit."""
    if answer.details.get("stopped_by_limit") or answer.status is Status.REFUSED:
        return False
    if answer.finding is Finding.FALLS and answer.flow == "associated" and answer.mechanism is not None:
        gain = float((assembly.dead * answer.mechanism).sum())
        return gain <= accuracy(assembly) * gross_power(assembly, answer.mechanism)
    nothing_held = answer.bracket is not None and answer.bracket[0] <= 0.0
    return answer.finding in (Finding.FALLS, Finding.NONE) or nothing_held


def _zero(answer: Answer, forces: FloatArray | None) -> Answer:
    """The answer of a wall at its limit, with its contact forces (m, 3) under the dead load."""
    own = answer.sentence.rstrip(".")
    if answer.multiplier is None:
        said = f" Of itself the method says: {own}."
    else:
        said = "" if answer.multiplier < 0.0 else f" {own[:1].upper()}{own[1:]}."
    return replace(
        answer,
        status=Status.OK,
        finding=Finding.AT_LIMIT,
        sentence=f"The wall is at its limit under its dead load: its multiplier is zero within the accuracy of the "
        f"numbers that describe it.{said}",
        multiplier=0.0,
        forces=forces,
        forces_multiplier=0.0,
    )


def _below_zero(assembly: Assembly, answer: Answer) -> Answer:
    """The answer for a collapse state below zero: the wall falls where statics has no other, and else nothing is known.

    The live load did not bring such a state about.
    """
    cleared = replace(answer, multiplier=None, bracket=None, forces=None, forces_multiplier=None)
    falling = dilatant_mechanism(assembly, assembly.dead)
    if falling is not None:
        sentence = "the wall falls under its dead load: what it would bear lies below zero"
        return replace(cleared, finding=Finding.FALLS, sentence=sentence, mechanism=falling, flow="associated")
    sentence = "the run ended in a collapse state below zero, which the live load does not bring about"
    return replace(cleared, status=Status.NOT_CONVERGED, finding=Finding.NONE, sentence=sentence, mechanism=None)


def with_proof(assembly: Assembly, answer: Answer) -> Answer:
    """An answer with what proves its claim where statics alone can: forces that grow for ever, a dilatant mechanism.

    `details["live_forces"]` (m, 3) balance the live load alone, so that with forces under the dead load they bear any
    multiplier; `details["dilatant_mechanism"]` (n, 3) shows that a wall falls whose motion was measured only. Where
    there is none, or no time is left to find it, the answer stays as it is, and is not judged. A wall at its limit
    whose motion was measured has such a mechanism, and `details["dead_forces"]` (m, 3) dual to it.
    """
    if answer.status is not Status.OK:
        return answer
    try:
        return _proved(assembly, answer)
    except OutOfTime:
        return answer


def _proved(assembly: Assembly, answer: Answer) -> Answer:
    """As `with_proof`; raises OutOfTime where the time is over."""
    if answer.finding is Finding.UNBOUNDED:
        growth = admissible_forces(assembly, assembly.live)
        own = (answer.forces, answer.forces_multiplier)
        forces, at = own if answer.forces is not None else (admissible_forces(assembly, assembly.dead), 0.0)
        if growth is None or forces is None:
            return answer
        return replace(
            answer, forces=forces, forces_multiplier=at, details=answer.details | {"live_forces": growth.tolist()}
        )
    if answer.finding is Finding.AT_LIMIT and answer.flow == "approximate":
        state = limit_state(assembly)
        if state is None:
            return answer
        shown = {"dead_forces": state[0].tolist(), "dilatant_mechanism": state[1].tolist()}
        return replace(answer, details=answer.details | shown)
    if answer.finding is Finding.FALLS and answer.flow == "approximate":
        proof = dilatant_mechanism(assembly, assembly.dead)
        if proof is not None:
            return replace(answer, details=answer.details | {"dilatant_mechanism": proof.tolist()})
    return answer
