"""The judge: checks the claim that an answer makes from forces and block sums; it shares no matrix with the methods.

The claims, and exactly what proves each:

collapses at lambda  forces in equilibrium with dead + lambda x live at the multiplier that is reported, within yield;
                     a mechanism at rest on the supports, without interpenetration, of the stated flow rule,
                     complementary to the forces, on which the live load does positive work
bracket              (flow "approximate") a live load; forces in equilibrium within yield at its lower end or above;
                     the upper end is measured and is not judged, but it lies no lower than what these forces bear;
                     nor is it shown that the motion is the one at collapse, but it must be one that the joints allow
                     and the loads drive (`harness.engine.measured_motion`); without a bracket, or with one so wide that
                     its lower end is zero beside the upper end within the tolerance, not judged
at its limit         multiplier 0; forces in equilibrium within yield under the dead load, and a dilatant mechanism of a
                     multiplier that the numbers of the wall do not tell from zero (`harness.model.limit`): no forces
                     bear more, whatever the flow
stands               forces in equilibrium within yield under the dead load, where no live load was given; with a live
                     load they show no multiplier, and the answer is not judged
falls                a dilatant mechanism, at rest on the supports, on which the dead load does more work than the
                     cohesion and tensile strength of the joints take and immense forces could do on its closings: no
                     equilibrium exists (Farkas); a measured motion is no proof and is not judged
unbounded            forces within the yield of dry joints that balance the live load alone, besides forces under the
                     dead load: their sum bears any multiplier; without them rejected where the live load does work on
                     a dilatant mechanism (`harness.engine.live_work`)

A wall with ties or props comes with their tensions in the detail `bar_forces`; equilibrium, yield, flow and virtual
work of all claims are those with them (`harness.engine.bar_checks`). A live load without end is borne by joints alone.

A wall with strength of its joints may come with the answer for the same wall without, in the detail
`without_strength`; it is judged on that wall by the same rules, and where it is rejected the whole answer is. In a wall
with brittle joints that is the wall without the strength of these.

A wall with brittle joints is judged with those dry that the answer calls broken (`harness.engine.brittle_checks`). It
collapses at lambda, too, by joints that break there: forces in equilibrium within yield, in which they are at their
strength, and a dilatant mechanism, on which without it dead + lambda x live does more work than the joints take. The
detail `with_strength` is judged as the answer for joints that keep their strength.

No multiplier that is claimed lies below zero, and none is claimed beside a finding that has none or outside its
bracket. A tolerance above `COARSEST` shows nothing. What proves nothing either way is not judged
(`Judgement.accepted` is None), which never means accepted.

The residuals are those of `harness.engine.residuals`.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from harness.engine.bar_checks import tensions_beyond
from harness.engine.brittle_checks import judge_breaking, listed, motion_of_whole
from harness.engine.judge_dead_load import judge_fall, judge_limit
from harness.engine.judge_decision import NO_FORCES, apart, beyond_prestress, countable, decide, said_of
from harness.engine.live_work import brings_down
from harness.engine.measured_motion import motion_faults
from harness.engine.residuals import (
    collapse_residuals,
    displaced_fault,
    displaced_residuals,
    force_residuals,
    moved_far,
)
from harness.model.answer_check import checked
from harness.model.assembly import Assembly, FloatArray
from harness.model.bars import Bars
from harness.model.details import AnswerDetails
from harness.model.displaced import DisplacedState
from harness.model.followed import COUNTABLE
from harness.model.method import Finding, Method, Status
from harness.model.method_registry import check_takes
from harness.model.result import Judgement, Result, bracket_is_wide, plastic_of, residual_of, result_of


def judge(
    assembly: Assembly, result: Result, tolerance: float, quantity: str = "multiplier", *, alone: bool = False
) -> Judgement:
    """What an independent check says of the claim that a result makes; see this module's docstring.

    Args:
        assembly: the wall.
        result: the answer as a result.
        tolerance: the largest residual that is acceptable for this method.
        quantity: what sentences call the multiplier, where that of this wall stands for another quantity.
        alone: leave out the answer for other strength of the joints that comes with it: where the wall as described is
            asked about, an undecided residual answer takes nothing from its proof.
    """
    if result.status is not Status.OK or result.finding is Finding.NONE:
        return Judgement(tolerance=tolerance, sentence="There is no answer to judge.")
    forces = None if result.forces is None else np.asarray(result.forces, dtype=float).reshape(-1, 3)
    mechanism = None if result.mechanism is None else np.asarray(result.mechanism, dtype=float).reshape(-1, 3)
    numbers: dict[str, Any] = {"forces": forces, "mechanism": mechanism, "bracket": result.bracket}
    numbers |= {quantity: result.multiplier, f"{quantity} of the forces": result.forces_multiplier}
    for name, value in numbers.items():
        if value is not None and not countable(value):
            return said_of(tolerance, False, f"Its {name}: not finite, or larger than {COUNTABLE:g}.")
    if forces is not None and isinstance(beyond := tensions_beyond(assembly, result.details), str):
        return said_of(tolerance, False, beyond)
    if forces is not None and beyond is not None and not countable(beyond):
        return said_of(tolerance, False, f"Its tensions of ties and props: larger than {COUNTABLE:g}.")
    if fault := _contradiction(assembly, result, tolerance, quantity):
        return said_of(tolerance, False, fault)
    judged = _judge_brittle if assembly.breaks else _judge_finding
    said = judged(assembly, forces, mechanism, result, tolerance, quantity)
    details = AnswerDetails(result.details)
    if assembly.strong and details.has_without_strength and not alone:
        said = _with_other(
            said, assembly.residual, residual_of(result), "Without cohesion and tensile strength", quantity
        )
    if assembly.breaks and details.has_with_strength and not alone:
        plastic = replace(assembly, brittle=np.zeros_like(assembly.brittle))
        said = _with_other(said, plastic, plastic_of(result), "With plastic strength", quantity)
    if said.accepted and tolerance > COARSEST:
        said.accepted = None
        said.sentence += f" A tolerance above {COARSEST:g} shows nothing."
    if result.flow == "approximate" and mechanism is not None and len(mechanism) == assembly.n_blocks:
        return _with_motion(said, *motion_faults(assembly, mechanism, _driving(result), result.details))
    return said


def _judge_finding(
    assembly: Assembly,
    forces: FloatArray | None,
    mechanism: FloatArray | None,
    result: Result,
    tolerance: float,
    quantity: str,
) -> Judgement:
    """What is said of the finding of a result."""
    match result.finding:
        case Finding.FALLS:
            return judge_fall(assembly, mechanism, result, tolerance)
        case Finding.STANDS:
            return _judge_standing(assembly, forces, result, tolerance)
        case Finding.UNBOUNDED:
            return _judge_unbounded(assembly, forces, result, tolerance)
        case Finding.AT_LIMIT:
            return judge_limit(assembly, forces, mechanism, result, tolerance)
    if result.flow == "approximate":
        return _judge_bracket(assembly, forces, result, tolerance, quantity)
    return _judge_collapse(assembly, forces, mechanism, result, tolerance, quantity)


def _judge_brittle(
    assembly: Assembly,
    forces: FloatArray | None,
    mechanism: FloatArray | None,
    result: Result,
    tolerance: float,
    quantity: str,
) -> Judgement:
    """What is said of the finding on a wall with brittle joints, those that the answer calls broken being dry."""
    details = AnswerDetails(result.details)
    broken = listed(assembly, details.broken, "broken")
    if isinstance(broken, str):
        return said_of(tolerance, False, broken)
    wall = assembly.with_broken(broken)
    if result.finding is Finding.COLLAPSES and details.has_breaking:
        return judge_breaking(wall, forces, mechanism, result, tolerance)
    said = _judge_finding(wall, forces, mechanism, result, tolerance, quantity)
    if broken.any():
        said.sentence += f" {int(broken.sum())} of {int(assembly.brittle.sum())} brittle joints are taken as broken."
        if result.finding is Finding.FALLS and said.accepted:
            whole = judge_fall(assembly, mechanism, result, tolerance)
            if not whole.accepted:
                said.accepted = None
                said.sentence += " That the dead load breaks them is not shown: were they whole, this proves no fall."
    if result.finding is not Finding.COLLAPSES or mechanism is None or len(mechanism) != assembly.n_blocks:
        return said
    moves = motion_of_whole(wall, mechanism)
    if moves <= tolerance:
        return said
    if result.flow == "associated":
        said.sentence += " Brittle joints that are whole move in it: the multiplier is an upper bound."
        return said
    said.residuals = said.residuals | {"whole": moves}
    said.accepted = False
    said.sentence += " A brittle joint that it calls whole moves."
    return said


def _with_other(said: Judgement, wall: Assembly, other: Result | None, words: str, quantity: str) -> Judgement:
    """The judgement of an answer, no better than that of the answer that comes with it, if that claims a thing.

    Args:
        said: of the answer; wall: the same with other strength; other: what is claimed of it, None if unreadable.
        words: what strength that is.
    """
    sizes = {"forces": wall.n_interfaces, "mechanism": wall.n_blocks}
    own = Judgement(accepted=False, sentence="The answer is none of this wall.")
    if other is not None and all(len(getattr(other, name) or [()] * n) == n for name, n in sizes.items()):
        if other.status is not Status.OK:
            if other.multiplier is None and other.bracket is None:
                return said
            own = said_of(said.tolerance, False, f'It gives a {quantity} beside the status "{other.status}".')
        else:
            own = judge(wall, other, said.tolerance, quantity)
    both = (said.accepted, own.accepted)
    accepted = False if False in both else None if None in both else True
    sentence = f"{said.sentence} {words}: {own.sentence}"
    return said.model_copy(update={"accepted": accepted, "sentence": sentence})


def _contradiction(assembly: Assembly, result: Result, tolerance: float, quantity: str) -> str:
    """What parts of a result say against each other or against the question, in words; empty where nothing does."""
    multiplier, bracket = result.multiplier, result.bracket
    if not result.finding.has_multiplier:
        if result.finding is Finding.UNBOUNDED and not assembly.has_live_load:
            return "It speaks of a live load that the wall does not have."
        if multiplier is not None or bracket is not None:
            return f'It gives a {quantity} or a bracket beside the finding "{result.finding}", which has none.'
        return ""
    if not assembly.has_live_load:
        return f"It gives a {quantity} of a live load that the wall does not have."
    lowest = min(0.0 if multiplier is None else multiplier, 0.0 if bracket is None else bracket[0])
    if lowest < 0.0:
        return (
            f"Its {quantity} or the lower end of its bracket lies below zero: no live load brings such a collapse "
            "about."
        )
    if bracket is not None and multiplier is not None:
        slack = tolerance * max(abs(bracket[0]), abs(bracket[1]))
        if not bracket[0] - slack <= multiplier <= bracket[1] + slack:
            return f"Its {quantity} {multiplier:.6g} lies outside its bracket [{bracket[0]:.6g}, {bracket[1]:.6g}]."
    return ""


def _driving(result: Result) -> float:
    """The multiplier under which the motion of a result was measured: the upper end of its bracket."""
    return (result.multiplier or 0.0) if result.bracket is None else result.bracket[1]


def _with_motion(said: Judgement, residuals: dict[str, float], fault: str) -> Judgement:
    """The judgement, with the residuals of a measured motion, and rejected where it is none of this wall."""
    said.residuals = said.residuals | residuals
    if fault:
        said.accepted = False
        said.sentence += f" {fault}"
    return said


def answered(method: Method, assembly: Assembly, **settings: Any) -> tuple[Result, Judgement]:
    """What a method answers in this process, and what the judge says of it."""
    check_takes(method, assembly)
    answer = checked(method.solve(assembly.copied(), method.Settings.model_validate(settings)), assembly)
    result = result_of(
        answer, assembly, case=assembly.name, method=method.name, family=method.family, traits=method.traits
    )
    return result, judge(assembly, result, method.tolerance)


WITHOUT_END = 1e-12
"""Largest residual of forces that balance the live load alone: what is violated by more ends, if far away."""
_GAPS = ("complementarity", "virtual_work", "dilatancy")
"""Residuals that are the distance between what the forces bear and what the mechanism takes."""
_CRUSHING_GAP = 1e-6
"""Largest such residual of a wall whose joints crush: its yield domain is round, and forces and mechanism of lines that
approach it are both admissible, and differ by as much. The error of the multiplier is no more."""
COARSEST = 1e-2
"""Largest tolerance that shows something: a hundredth of the loads. Ten times the coarsest of the library's methods."""
_MOVED_FAR = " Its blocks rest so far from where they were drawn that this shows nothing of the wall as drawn."


def _judge_collapse(
    assembly: Assembly,
    forces: FloatArray | None,
    mechanism: FloatArray | None,
    result: Result,
    tolerance: float,
    quantity: str,
) -> Judgement:
    """Collapse at the multiplier that is reported, by a whole collapse state."""
    multiplier = result.multiplier
    if multiplier is None:
        return said_of(tolerance, False, f"It gives no {quantity}.")
    if forces is None:
        return said_of(tolerance, None, NO_FORCES)
    at = multiplier if result.forces_multiplier is None else result.forces_multiplier
    beyond = beyond_prestress(assembly, result)
    if mechanism is None:
        found = force_residuals(assembly, forces, at, beyond=beyond)
        said = decide(found, tolerance, f"The contact forces at {quantity} {at:.6g} were")
        said.accepted = None if said.accepted else said.accepted
        said.sentence += " It gives no mechanism, so that it collapses there is not shown."
        return said
    residuals = collapse_residuals(assembly, forces, at, mechanism, result.flow, beyond)
    residuals["multiplier"] = apart(multiplier, at)
    wider = dict.fromkeys(_GAPS, _CRUSHING_GAP) if assembly.crushes else None
    said = decide(residuals, tolerance, f"The collapse state ({result.flow} flow) was", wider=wider)
    if said.accepted:
        size = max(assembly.load_unit, abs(multiplier))
        error = abs(multiplier - at) + size * (residuals["complementarity"] + residuals["virtual_work"])
        said.multiplier_error = float(error)
        said.sentence += f" By virtual work the {quantity} of this mechanism is known to within {error:.1g}."
    return said


def _judge_bracket(
    assembly: Assembly, forces: FloatArray | None, result: Result, tolerance: float, quantity: str
) -> Judgement:
    """A measured collapse: forces show its lower end; its upper end and its motion are not judged."""
    lower = result.multiplier if result.bracket is None else result.bracket[0]
    at = result.multiplier if result.forces_multiplier is None else result.forces_multiplier
    if lower is None or at is None:
        return said_of(tolerance, False, f"It gives no {quantity}.")
    if result.bracket is not None and at > result.bracket[1] + tolerance * abs(at):
        return said_of(tolerance, False, f"Its forces bear {at:.6g}, above the upper end of its bracket.")
    far = False
    if forces is not None:
        residuals = force_residuals(assembly, forces, at, beyond=beyond_prestress(assembly, result))
        what = f"Equilibrium and yield of the contact forces at {quantity} {at:.6g} were"
    else:
        moved = DisplacedState.of(result.details)
        if moved is None:
            return said_of(tolerance, None, NO_FORCES)
        if fault := displaced_fault(assembly, moved):
            return said_of(tolerance, False, f"The state of rest is no proof: {fault}.")
        residuals, far = displaced_residuals(assembly, moved, at), moved_far(assembly, moved)
        what = f"Equilibrium and yield of the contact forces on the displaced blocks, at {quantity} {at:.6g}, were"
    residuals["multiplier"] = apart(lower, at) if lower > at else 0.0
    said = decide(residuals, tolerance, what)
    if said.accepted and far:
        said.accepted, said.sentence = None, said.sentence + _MOVED_FAR
    elif said.accepted and result.bracket is None:
        said.accepted = None
        said.sentence += " It gives no bracket: how far above them the wall collapses was not measured."
    elif said.accepted and result.bracket is not None:
        upper = result.bracket[1]
        if bracket_is_wide(result, result.traits) and lower <= tolerance * upper:
            said.accepted = None
            said.sentence += (
                f" The lower end of its bracket is zero beside the upper end {upper:.6g}, within the tolerance of the "
                f"judge: it states no {quantity}."
            )
        else:
            said.sentence += " They prove the lower end; the collapse above it is measured and not judged."
    return said


def _judge_standing(assembly: Assembly, forces: FloatArray | None, result: Result, tolerance: float) -> Judgement:
    """Stands under its dead load, where nothing more was asked."""
    what, far = "Equilibrium and yield of the contact forces under the dead load", False
    if forces is not None:
        residuals = force_residuals(assembly, forces, 0.0, beyond=beyond_prestress(assembly, result))
    elif (moved := DisplacedState.of(result.details)) is not None:
        if fault := displaced_fault(assembly, moved):
            return said_of(tolerance, False, f"The state of rest is no proof: {fault}.")
        residuals, far = displaced_residuals(assembly, moved, 0.0), moved_far(assembly, moved)
        what += ", in the displaced position of the blocks,"
    elif assembly.n_free == 0:
        return said_of(tolerance, True, "Every block is fixed: nothing can move.")
    else:
        return said_of(tolerance, None, NO_FORCES)
    said = decide(residuals, tolerance, f"{what} were")
    if said.accepted and far:
        said.accepted, said.sentence = None, said.sentence + _MOVED_FAR
    elif said.accepted and assembly.has_live_load:
        said.accepted = None
        said.sentence = "The wall stands under its dead load; the answer proves no multiplier of the live load."
    return said


def _judge_unbounded(assembly: Assembly, forces: FloatArray | None, result: Result, tolerance: float) -> Judgement:
    """Forces under the dead load, and forces that balance the live load alone: together they bear any multiplier."""
    growth = AnswerDetails(result.details).live_forces
    if forces is None or result.forces_multiplier or growth is None:
        if brings_down(assembly):
            sentence = "The live load does work on a dilatant mechanism, so that some multiplier brings the wall down."
            return said_of(tolerance, False, sentence)
        lacking = "forces that balance the live load alone" if growth is None else "forces under the dead load"
        return said_of(
            tolerance, None, f"There is no proof that every live load is borne: the answer gives no {lacking}."
        )
    ray = np.asarray(growth, dtype=float).reshape(-1, 3)
    if ray.shape != forces.shape or not countable(ray):
        return said_of(tolerance, False, f"`live_forces` are not {len(forces)} finite triples.")
    residuals = force_residuals(assembly, forces, 0.0, beyond=beyond_prestress(assembly, result))
    none = np.where(np.isinf(assembly.crushing), np.inf, 0.0)  # nor does what crushes bear any more
    alone = replace(
        assembly,
        dead=np.zeros_like(assembly.dead),
        constant=np.zeros_like(assembly.constant),
        crushing=none,
        bars=Bars(),
    )
    residuals |= {f"live_{name}": value for name, value in force_residuals(alone, ray, 1.0).items()}
    what = "Forces under the dead load and forces that balance the live load alone were"
    return decide(residuals, tolerance, what, dict.fromkeys(("live_equilibrium", "live_yield"), WITHOUT_END))
