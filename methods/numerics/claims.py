"""What an answer claims, with what shows it: by statics alone, whichever method the answer comes from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.bars import with_bar_forces, with_bars_as_joints
from harness.model.components import analysed_apart
from harness.model.deadline import best_so_far
from harness.model.errors import as_sentence
from harness.model.limit import accuracy, gross_power, smallest_resolved, strengthened
from harness.model.method import Answer, Finding, Status
from methods.numerics.statics import admissible_forces, dilatant_mechanism, greatest_multiplier

_SMALL = 1e-3
"""Live load, as a part of the dead load, below which a load that was measured leaves the limit to statics."""


def _bear(assembly: Assembly, answer: Answer, multiplier: float) -> FloatArray | None:
    """Forces (m, 3) with which a component bears its dead load and `multiplier` times the live load; None if none.

    Where the answer holds forces at a higher multiplier, those between it and the dead load do: yield is convex.
    """
    highest = answer.forces_multiplier
    if answer.forces is not None and highest is not None and highest > multiplier >= 0.0:
        dead = admissible_forces(assembly, assembly.dead)
        if dead is not None:
            share = multiplier / highest
            return (1.0 - share) * dead + share * answer.forces
    return admissible_forces(assembly, assembly.dead + multiplier * assembly.live)


def analysed(assembly: Assembly, solve: Callable[[Assembly], Answer]) -> Answer:
    """The answer of a method for a wall from those for its independent components, with what shows it.

    Components have the ties and props of the wall as further joints (`harness.model.bars.with_bars_as_joints`).
    """
    rows, bars = with_bars_as_joints(assembly), assembly.bars
    answer = with_proof(
        rows, analysed_apart(rows, lambda part: _if_unbounded(part, at_limit(part, solve(part))), _bear)
    )
    return with_bar_forces(answer, bars, assembly.n_interfaces) if len(bars) else answer


@dataclass(frozen=True, eq=False)
class _Statics:
    """What statics alone says of a wall.

    Attributes:
        multiplier: the greatest, whatever the flow; forces: (m, 3) at it; mechanism: (n, 3) dilatant, dual to them.
        at_limit: whether the numbers of the wall allow that it is zero.
    """

    multiplier: float
    forces: FloatArray
    mechanism: FloatArray
    at_limit: bool


def _statics_of(assembly: Assembly) -> _Statics | None:
    """What statics says of a wall, or None where it has no greatest multiplier.

    Where rounding leaves no equilibrium at any multiplier, the strengthened wall shows one that is at its limit.
    """
    for wall in (assembly, strengthened(assembly)):
        found = greatest_multiplier(wall)
        if found is not None:
            multiplier, forces, mechanism = found
            near = abs(multiplier) <= smallest_resolved(assembly, mechanism)
            return _Statics(multiplier, forces, mechanism, near) if near or wall is assembly else None
    return None


def at_limit(assembly: Assembly, answer: Answer) -> Answer:
    """The answer, of the finding "at its limit" where that is what it comes to, and without a multiplier below zero.

    Statics decides for all methods alike: a wall is at its limit where its greatest multiplier is zero as far as its
    numbers tell. It is asked where an answer leaves that open: a multiplier near zero, a fall that is measured or by
    less than the numbers tell, and a run without an end.
    """
    if not _leaves_open(assembly, answer):
        return answer
    return best_so_far(lambda: _at_limit(assembly, answer), lambda: answer)


def _leaves_open(assembly: Assembly, answer: Answer) -> bool:
    """Whether an answer may be that of a wall at its limit, or claims a multiplier below zero."""
    multiplier, mechanism = answer.multiplier, answer.mechanism
    if not assembly.has_live_load or answer.status is Status.REFUSED or assembly.crushes:
        return False
    if multiplier is not None:
        low = multiplier if answer.bracket is None else answer.bracket[0]
        if mechanism is None or answer.flow == "approximate":
            return low <= _SMALL * assembly.load_unit
        return low <= smallest_resolved(assembly, mechanism)
    if answer.finding is Finding.FALLS and answer.flow == "associated" and mechanism is not None:
        gain = float((assembly.dead * mechanism).sum()) - _strength_power(assembly, mechanism)
        return gain <= accuracy(assembly) * gross_power(assembly, mechanism)
    stopped = bool(answer.details.get("stopped_by_limit"))
    return answer.finding is Finding.FALLS or (answer.finding is Finding.NONE and not stopped)


def _at_limit(assembly: Assembly, answer: Answer) -> Answer:
    """As `at_limit`, of an answer that leaves it open; raises OutOfTime where the time is over."""
    statics = _statics_of(assembly)
    if statics is not None and statics.at_limit:
        return _with_limit(answer, statics)
    bears = 0.0 if statics is None else statics.multiplier
    if abs(bears) <= np.finfo(float).eps * assembly.load_unit:
        bears = 0.0  # rounding, of a mechanism on which the dead load does no work
    near = -_SMALL * assembly.load_unit <= bears < 0.0 and answer.finding is not Finding.FALLS
    if statics is not None and bears < 0.0 and (near or answer.multiplier is not None):
        return _falls(answer, statics.mechanism)
    if answer.multiplier is not None and answer.multiplier < 0.0:
        return _below_zero(assembly, answer)
    if answer.finding is Finding.FALLS and bears > 0.0:
        if admissible_forces(assembly, assembly.dead) is None:
            return answer  # the live load holds it up
        if (assembly.dilatancy >= assembly.friction).all():
            return _stands_though_joints_give(answer, bears)
        return _falls_by_its_joints(answer, bears)
    elif answer.multiplier == 0.0 and answer.bracket is None and bears > 0.0:
        reason = "the multiplier depends on the self-stress in its joints; fe and de start without any"
    else:
        return answer
    own = answer.sentence.rstrip(".")
    return replace(answer, sentence=f"{own}. Statics alone would bear up to {bears:.7g}: {reason}.")


def _falls_by_its_joints(answer: Answer, bears: float) -> Answer:
    """The answer where a fall was computed of a wall that has an equilibrium within yield: it is not proved.

    Joints without self-stress share the load as their stiffness says, and with friction that is not associated several
    shares can be in equilibrium, others not.
    """
    own = answer.sentence.rstrip(".")
    sentence = (
        f"Not proved: {own}. Statics alone would bear up to {bears:.7g}, so the wall may also stand: that depends on "
        "the self-stress in its joints and on their stiffness."
    )
    return replace(answer, sentence=sentence)


def _stands_though_joints_give(answer: Answer, bears: float) -> Answer:
    """The answer where a fall was measured of a wall that stands by theory, as every slip lifts by the whole friction.

    By normality of the flow (Drucker 1954) rigid blocks stand wherever some equilibrium exists; so do smooth ones.
    """
    own = answer.sentence.rstrip(".")
    return replace(
        answer,
        status=Status.NOT_CONVERGED,
        finding=Finding.NONE,
        sentence=f"Rigid blocks stand under the dead load and bear up to {bears:.7g}, since equilibrium exists and no "
        f"slip works against friction; only with deformable joints does the wall not come to rest: {own}.",
        multiplier=None,
        bracket=None,
        forces=None,
        forces_multiplier=None,
        mechanism=None,
    )


def _with_limit(answer: Answer, statics: _Statics) -> Answer:
    """The answer of a wall at its limit; one that has no forces or no mechanism takes those of statics."""
    if answer.multiplier is None:
        said = f" The method's own sentence: {answer.sentence.rstrip('.')}."
    else:
        said = "" if answer.multiplier < 0.0 else f" {as_sentence(answer.sentence)}"
    return replace(
        answer,
        status=Status.OK,
        finding=Finding.AT_LIMIT,
        sentence="The wall is at its limit under its dead load: its multiplier is zero within the accuracy of the "
        f"wall's data.{said}",
        multiplier=0.0,
        bracket=None if answer.bracket is None else (0.0, answer.bracket[1]),
        forces=statics.forces if answer.forces is None else answer.forces,
        forces_multiplier=0.0,
        mechanism=statics.mechanism if answer.mechanism is None else answer.mechanism,
        flow=answer.flow if answer.mechanism is not None else "associated",
    )


def _falls(answer: Answer, mechanism: FloatArray) -> Answer:
    """The answer where statics bears nothing: a dilatant mechanism (n, 3) shows that the wall falls."""
    return replace(
        answer,
        status=Status.OK,
        finding=Finding.FALLS,
        sentence="The wall falls under its dead load, by less than the method can resolve: no equilibrium within "
        "yield exists, whatever the flow rule.",
        multiplier=None,
        bracket=None,
        forces=None,
        forces_multiplier=None,
        mechanism=mechanism,
        flow="associated",
    )


def _below_zero(assembly: Assembly, answer: Answer) -> Answer:
    """The answer for a collapse state below zero, which the live load does not cause, of a wall that stands."""
    assert answer.multiplier is not None
    if answer.mechanism is not None and -answer.multiplier <= smallest_resolved(assembly, answer.mechanism):
        return replace(answer, multiplier=0.0, forces_multiplier=0.0)
    sentence = "the run ended in a collapse state below zero, which the live load does not cause"
    return no_answer(answer, sentence)


def no_answer(answer: Answer, sentence: str) -> Answer:
    """The answer of a run that came to none, in a sentence; its way and its details stay."""
    return replace(
        answer,
        status=Status.NOT_CONVERGED,
        finding=Finding.NONE,
        sentence=sentence,
        multiplier=None,
        bracket=None,
        forces=None,
        forces_multiplier=None,
        mechanism=None,
    )


def with_proof(assembly: Assembly, answer: Answer) -> Answer:
    """An answer with what proves its claim where statics alone can: forces that grow for ever, a dilatant mechanism.

    `details["live_forces"]` (m, 3) balance the live load alone, so that with forces under the dead load they bear any
    multiplier; without them it is not converged. `details["dilatant_mechanism"]` (n, 3) shows that a wall falls whose
    motion was measured only. Where there is none, or no time is left to find it, the answer stays as it is, and is not
    judged. A wall at its limit has such a mechanism, whose multiplier is zero, and `details["dead_forces"]` (m, 3) dual
    to it.
    """
    if answer.status is not Status.OK:
        return answer
    return best_so_far(lambda: _proved(assembly, answer), lambda: _if_asked(answer))


def _proved(assembly: Assembly, answer: Answer) -> Answer:
    """As `with_proof`; raises OutOfTime where the time is over."""
    if answer.finding is Finding.UNBOUNDED:
        growth = growing_forces(assembly)
        if growth is None:
            return _only_held(assembly, answer)
        forces = answer.forces if answer.forces_multiplier == 0.0 else admissible_forces(assembly, assembly.dead)
        if forces is None:
            return answer
        return replace(
            answer, forces=forces, forces_multiplier=0.0, details=answer.details | {"live_forces": growth.tolist()}
        )
    if answer.finding is Finding.AT_LIMIT:
        statics = _statics_of(assembly)
        if statics is None or not statics.at_limit:
            return answer
        shown = {"dead_forces": statics.forces.tolist(), "dilatant_mechanism": statics.mechanism.tolist()}
        return replace(answer, details=answer.details | shown)
    if answer.finding is Finding.FALLS and answer.flow == "approximate":
        tries = (dilatant_mechanism(assembly, assembly.dead, exact=exact) for exact in (True, False))
        proof = next((found for found in tries if found is not None), None)
        if proof is not None:
            return replace(answer, details=answer.details | {"dilatant_mechanism": proof.tolist()})
    return answer


def _if_unbounded(assembly: Assembly, answer: Answer) -> Answer:
    """The answer, not converged where it is "unbounded" and statics does not say so."""
    if answer.status is not Status.OK or answer.finding is not Finding.UNBOUNDED:
        return answer
    return best_so_far(
        lambda: _only_held(assembly, answer) if growing_forces(assembly) is None else answer, lambda: _if_asked(answer)
    )


def _if_asked(answer: Answer) -> Answer:
    """The answer where no time is left to ask statics: not converged where it is "unbounded"."""
    if answer.finding is not Finding.UNBOUNDED:
        return answer
    return _not_shown(answer, "The time was over before forces were sought that balance the live load alone")


def _only_held(assembly: Assembly, answer: Answer) -> Answer:
    """The answer of a wall that was held at every load tried, but whose live load alone no forces within yield bear."""
    statics = best_so_far(lambda: greatest_multiplier(assembly), lambda: None)
    reason = "Statics does not bear every multiplier: no forces within yield balance the live load alone"
    return _not_shown(answer, reason if statics is None else f"{reason}, and up to {statics[0]:.7g} are in equilibrium")


def _not_shown(answer: Answer, reason: str) -> Answer:
    """The answer, not converged for a reason; the load that was held, if any, and its forces stay."""
    sentence = f"not converged: {answer.sentence.rstrip('.')}. {reason}."
    return replace(answer, status=Status.NOT_CONVERGED, finding=Finding.NONE, sentence=sentence)


def growing_forces(assembly: Assembly) -> FloatArray | None:
    """Forces (m, 3) that bear the live load and any multiple of it, as no strength of a joint does; None if none.

    What is rounding of the largest is zero: blocks that the live load does not reach are then in equilibrium exactly.
    """
    rigid = np.isinf(assembly.crushing)
    dry = assembly.without_strength.with_joints(rigid)
    found = admissible_forces(dry, assembly.live)
    if found is None:
        return None
    found[abs(found) <= 8.0 * np.finfo(float).eps * abs(found).max(initial=0.0)] = 0.0
    growth = np.zeros((assembly.n_interfaces, 3))
    growth[rigid] = dry.law.within(found)
    return growth


def _strength_power(assembly: Assembly, mechanism: FloatArray) -> float:
    """Power that cohesion and tensile strength take on a dilatant mechanism (n, 3) [force x velocity]."""
    strains = (assembly.kinematic_matrix @ mechanism[assembly.free].ravel()).reshape(-1, 3)
    return assembly.law.associated.dissipation(assembly.law.associated.rates(strains))
