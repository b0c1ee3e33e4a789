"""The judge on the dead load alone: walls at their limit, and walls that fall."""

from __future__ import annotations

import numpy as np

from harness.engine.bar_checks import dissipated_by_bars, tensions_beyond
from harness.engine.judge_decision import countable, decide, said_of
from harness.engine.judge_law import beyond_lift, dissipated_by_strength
from harness.engine.residuals import collapse_residuals, moving_parts, power
from harness.model.assembly import Assembly, FloatArray
from harness.model.details import BAR_FORCES, DEAD_BAR_FORCES, AnswerDetails
from harness.model.limit import accuracy, gross_power, smallest_resolved
from harness.model.result import Judgement, Result, relative_velocities

IMMENSE = 1e7
"""Contact forces, in dead loads of the component, that no equilibrium needs.

A fall is proved unless the wall stands by such forces. Falls that methods find leave at least ten times more."""


_MOST_OPEN = 4.0
"""Largest multiplier that a wall at its limit can have, in load units times the accuracy of its numbers.

A block that turns about its corner leaves three times its weight open; more is a motion beside the point."""


GAIN = 1e-12
"""Share of the power that the dead load would have if nothing cancelled, up to which its power is rounding."""


def judge_limit(
    assembly: Assembly, forces: FloatArray | None, mechanism: FloatArray | None, result: Result, tolerance: float
) -> Judgement:
    """At its limit: forces under the dead load, and a dilatant mechanism whose multiplier is zero within accuracy.

    No forces bear a multiplier above that of such a mechanism. Both may be those of statics, beside the forces and the
    motion of the method: `details["dead_forces"]` and `details["dilatant_mechanism"]`. What is tolerated is what the
    numbers of the wall leave open, whatever the tolerance of the method; so the forces may be those of the multiplier
    of the mechanism instead of zero, if it is as small as that.
    """
    if result.multiplier != 0.0:
        return said_of(tolerance, False, "A wall at its limit has the multiplier 0.")
    details = AnswerDetails(result.details)
    by_statics = [details.dead_forces, details.dilatant_mechanism]
    forces, mechanism = (
        own if shown is None else np.asarray(shown, dtype=float).reshape(-1, 3)
        for own, shown in zip((forces, mechanism), by_statics, strict=True)
    )
    if forces is None or mechanism is None:
        return said_of(tolerance, None, "There is no proof of the limit: the answer gives no forces or no mechanism.")
    sizes = [(assembly.n_interfaces, 3), (assembly.n_blocks, 3)]
    if [forces.shape, mechanism.shape] != sizes or not (np.isfinite(forces).all() and np.isfinite(mechanism).all()):
        return said_of(tolerance, False, "Its forces or its mechanism are not finite triples of all joints and blocks.")
    stated = DEAD_BAR_FORCES if by_statics[0] is not None else BAR_FORCES
    if isinstance(beyond := tensions_beyond(assembly, result.details, stated), str):
        return said_of(tolerance, False, beyond)
    within, smallest = accuracy(assembly), smallest_resolved(assembly, mechanism)
    what = "The collapse state (associated flow) under the dead load"
    residuals = collapse_residuals(assembly, forces, 0.0, mechanism, "associated", beyond)
    if smallest > 0.0:
        residuals["virtual_work"] *= within * assembly.load_unit / smallest
    said = decide(residuals, within, f"{what} was")
    at = _multiplier_of(assembly, mechanism)
    if said.accepted or not 0.0 < abs(at) <= min(smallest, _MOST_OPEN * within * assembly.load_unit):
        return said
    return decide(
        collapse_residuals(assembly, forces, at, mechanism, "associated", beyond),
        within,
        f"{what}, but for {at:.1g}, was",
    )


def _multiplier_of(assembly: Assembly, mechanism: FloatArray) -> float:
    """The multiplier of a dilatant mechanism (n, 3) by virtual work; zero without live work.

    Dry joints dissipate nothing then, others by their cohesion and tensile strength.
    """
    live = power(assembly.live, mechanism)
    opening, slip = relative_velocities(assembly, mechanism)
    taken = dissipated_by_strength(assembly, beyond_lift(assembly, opening, slip), slip)
    taken += dissipated_by_bars(assembly, mechanism)
    return (taken - power(assembly.dead, mechanism)) / live if live > 0.0 else 0.0


def judge_fall(assembly: Assembly, mechanism: FloatArray | None, result: Result, tolerance: float) -> Judgement:
    """No equilibrium: a dilatant mechanism of a component, supports at rest, on which the dead load does work.

    A method that measured the motion may hand it over beside it, as `details["dilatant_mechanism"]`.
    """
    shown = AnswerDetails(result.details).dilatant_mechanism
    if shown is not None:
        mechanism = np.asarray(shown, dtype=float).reshape(-1, 3)
        if mechanism.shape != (assembly.n_blocks, 3) or not countable(mechanism):
            return said_of(tolerance, False, f"`dilatant_mechanism` is not {assembly.n_blocks} finite triples.")
    elif result.flow == "approximate" or mechanism is None:
        reason = "The motion was measured, which is no proof" if mechanism is not None else "It gives no mechanism"
        return said_of(tolerance, None, f"{reason}; there is no proof that no equilibrium exists.")
    proved, residuals = shown_to_fall(assembly, mechanism, tolerance)
    sentence = (
        "The dead load does positive work on the mechanism, with dilatant flow and supports at rest: no equilibrium "
        "exists, which proves the fall."
        if proved
        else "The mechanism proves no fall: the work of the dead load does not exceed the possible work of its "
        "closings, or it is not dilatant, or it moves the supports."
    )
    return Judgement(residuals=residuals, tolerance=tolerance, accepted=proved, sentence=sentence)


def shown_to_fall(assembly: Assembly, mechanism: FloatArray, tolerance: float) -> tuple[bool, dict[str, float]]:
    """Whether a mechanism (n, 3) proves that a wall falls under its dead load; residuals of the component that does."""
    supports, parts = moving_parts(assembly, mechanism)
    shown = [_fall_of(part.assembly, motion, tolerance) for part, motion in parts]
    proves, gain, closing, work = max(shown, default=(False, 0.0, 0.0, 0.0))
    residuals = {"supports": supports, "interpenetration": closing, "dead_work": gain, "closing_work": work}
    return proves and supports <= tolerance, residuals


def _fall_of(part: Assembly, motion: FloatArray, tolerance: float) -> tuple[bool, float, float, float]:
    """Whether the motion (n, 3) of a component proves its fall; its gain, its largest closing, and `closing_work`.

    The gain is the dead work less what cohesion and tensile strength take. Were there forces in equilibrium under the
    dead load, within yield, then gain <= sum of n c over the contact points, n their normal forces and c their closings
    beyond dilatant flow.
    So the forces of any equilibrium would have to exceed gain / sum of c. Where that is `IMMENSE` times the dead load
    there is none. `closing_work` is what forces so large may do on the closings, in dead loads like the gain.
    """
    opening, slip = relative_velocities(part, motion)
    opening = beyond_lift(part, opening, slip)
    closings = np.maximum(0.0, -opening)[np.isinf(part.crushing)]  # joints that crush close at a cost, see gain
    closing = float(closings.max(initial=0.0))
    taken = dissipated_by_strength(part, opening, slip) + dissipated_by_bars(part, motion)
    gain = (power(part.dead, motion) - taken) / part.force_scale
    work = IMMENSE * float(closings.sum())
    beyond_rounding = gain * part.force_scale > GAIN * gross_power(part, motion)
    return closing <= tolerance and beyond_rounding and work < gain, gain, closing, work
