"""The judge: checks an answer from contact forces and block sums, sharing no matrix with the methods.

Residuals, all relative and dimensionless (W = total dead load, l = typical block size, mechanism scaled so that the
fastest vertex has speed 1):

equilibrium         largest out-of-balance force or moment/l of a free block / W
yield               largest tension or excess of |s| over mu (n1 + n2) / W
interpenetration    largest closing velocity at a contact point (beyond what the flow rule asks for)
dilatancy           largest opening of a contact point that still carries force: min(force/mean block weight, velocity)
sliding             largest slip against slack of the friction cone, the same way
complementarity     work of contact forces where nothing should move, in live work at max(unit, |multiplier|)
virtual_work        |multiplier - (dissipation - dead work)/live work|, relative to max(unit, |multiplier|)
live_work           not a residual to be small: live work of the mechanism, must be positive

The unit is the multiplier at which the live load is as large as the dead load: one for a tilt. So a live load that is
given ten times larger, with a multiplier ten times smaller, is judged alike.
"""

from __future__ import annotations

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from harness.model.displaced import DisplacedState
from harness.model.method import Finding, Status
from harness.model.result import Judgement, Result, normalised_mechanism, relative_velocities


def block_sums(assembly: Assembly, forces: FloatArray) -> FloatArray:
    """(n, 3) sums (fx, fy, moment about the centroid) of the contact forces (m, 3) on every block.

    The two normal forces act at the contact points; the shear acts half at each, along the line that joins them.
    """
    sums = np.zeros((assembly.n_blocks, 3))
    shear = 0.5 * forces[:, 2:3] * assembly.tangent
    for point, normal_force in ((assembly.end1, forces[:, 0:1]), (assembly.end2, forces[:, 1:2])):
        force = normal_force * assembly.normal + shear
        for block, sign in ((assembly.block_b, 1.0), (assembly.block_a, -1.0)):
            arm = point - assembly.centroid[block]
            moment = arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
            np.add.at(sums, block, sign * np.column_stack([force, moment]))
    return sums


def equilibrium_residual(assembly: Assembly, forces: FloatArray, multiplier: float) -> float:
    """Largest out-of-balance force, or moment / block size, of a free block, relative to the total dead load."""
    balance = block_sums(assembly, forces) + assembly.dead + multiplier * assembly.live
    balance[:, 2] /= assembly.length_scale
    return float(abs(balance[assembly.free]).max(initial=0.0)) / assembly.force_scale


def yield_violation(assembly: Assembly, forces: FloatArray) -> float:
    """Largest tension, or excess of shear over friction, relative to the total dead load."""
    normal = forces[:, :2]
    excess = abs(forces[:, 2]) - assembly.friction * normal.sum(axis=1)
    worst = max(0.0, float((-normal).max(initial=0.0)), float(excess.max(initial=0.0)))
    return worst / assembly.force_scale


def displaced_residuals(assembly: Assembly, state: DisplacedState, multiplier: float) -> dict[str, float]:
    """Equilibrium and yield of a wall at rest where its blocks have moved to, under loads that keep their directions.

    Args:
        assembly: the wall before it moved; state: its contacts and forces; multiplier: of the live load.
    """
    balance = assembly.dead + multiplier * assembly.live
    a, b = assembly.block_a[state.interface], assembly.block_b[state.interface]
    for block, force in ((state.onto, state.force), (a + b - state.onto, -state.force)):
        arm = state.point - assembly.centroid[block] - state.places[block, :2]
        moment = arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
        np.add.at(balance, block, np.column_stack([force, moment]))
    balance[:, 2] /= assembly.length_scale
    normal = (state.force * state.normal).sum(axis=1)
    shear = abs(state.force[:, 1] * state.normal[:, 0] - state.force[:, 0] * state.normal[:, 1])
    excess = shear - assembly.friction[state.interface] * normal
    worst = max(0.0, float((-normal).max(initial=0.0)), float(excess.max(initial=0.0)))
    return {
        "equilibrium": float(abs(balance[assembly.free]).max(initial=0.0)) / assembly.force_scale,
        "yield": worst / assembly.force_scale,
    }


def power(load: FloatArray, mechanism: FloatArray) -> float:
    """Power of a generalised load (n, 3) on a mechanism (n, 3) [force x velocity]."""
    return float((load * mechanism).sum())


def collapse_residuals(
    assembly: Assembly, forces: FloatArray, multiplier: float, mechanism: FloatArray, flow: str
) -> dict[str, float]:
    """The residuals of a collapse state, by the names of this module's docstring.

    Args:
        assembly: the wall.
        forces: (m, 3) contact forces (n1, n2, s) [force].
        multiplier: of the live load.
        mechanism: (n, 3) block velocities at any scale.
        flow: "non-associated" or "associated".
    """
    mechanism = normalised_mechanism(assembly, mechanism)
    opening, slip = relative_velocities(assembly, mechanism)
    if flow == "associated":
        opening = opening - (assembly.friction * abs(slip))[:, None]
    normal, shear = forces[:, :2], forces[:, 2]
    strength = assembly.friction * normal.sum(axis=1)
    forward, backward = np.maximum(slip, 0.0), np.maximum(-slip, 0.0)
    slack_forward, slack_backward = strength + shear, strength - shear
    mean_weight = assembly.force_scale / max(assembly.n_free, 1)
    live_work = power(assembly.live, mechanism)
    idle_work = float(
        abs(normal * opening).sum() + abs(slack_forward * forward).sum() + abs(slack_backward * backward).sum()
    )
    # Virtual work: contact forces do work r.q on the mechanism; friction dissipates, openings do not.
    dissipation = 0.0 if flow == "associated" else float((strength * abs(slip)).sum())
    residuals = {
        "equilibrium": equilibrium_residual(assembly, forces, multiplier),
        "yield": yield_violation(assembly, forces),
        "interpenetration": max(0.0, float((-opening).max(initial=0.0))),
        "dilatancy": float(np.minimum(abs(normal) / mean_weight, np.maximum(opening, 0.0)).max(initial=0.0)),
        "sliding": float(
            max(
                np.minimum(abs(slack_forward) / mean_weight, forward).max(initial=0.0),
                np.minimum(abs(slack_backward) / mean_weight, backward).max(initial=0.0),
            )
        ),
        "live_work": live_work / (assembly.force_scale or 1.0),
    }
    if live_work > 0.0:
        by_virtual_work = (dissipation - power(assembly.dead, mechanism)) / live_work
        size = max(assembly.load_unit, abs(multiplier))
        residuals["complementarity"] = idle_work / live_work / size
        residuals["virtual_work"] = abs(by_virtual_work - multiplier) / size
    return residuals


def judge(assembly: Assembly, result: Result, tolerance: float) -> Judgement:
    """What an independent check says of a result.

    Collapse: the whole state is checked (a measured velocity field, flow "approximate", is left out). Stands: the
    forces must be in equilibrium at multiplier 0 within yield. Falls: the mechanism must gain dead work without
    interpenetration. Unbounded: forces, where given, must be an equilibrium at their multiplier.

    Args:
        assembly: the wall.
        result: the answer as a result.
        tolerance: the largest residual that is acceptable for this method.
    """
    if result.status is not Status.OK or result.finding is Finding.NONE:
        return Judgement(tolerance=tolerance, sentence="There is no answer to judge.")
    forces = None if result.forces is None else np.asarray(result.forces, dtype=float).reshape(-1, 3)
    mechanism = None if result.mechanism is None else np.asarray(result.mechanism, dtype=float).reshape(-1, 3)
    if result.finding is Finding.FALLS:
        return _judge_fall(assembly, mechanism, result.flow, tolerance)
    at = result.forces_multiplier
    if result.finding is Finding.STANDS or at is None:
        at = 0.0
    if forces is None:
        moved = DisplacedState.of(result.details)
        if moved is not None:
            what = (
                f"Equilibrium and yield of the contact forces where the blocks have moved to, at multiplier {at:.6g},"
            )
            return _decide(displaced_residuals(assembly, moved, at), tolerance, what)
        return Judgement(
            tolerance=tolerance,
            accepted=None if result.finding is Finding.UNBOUNDED or result.flow == "approximate" else False,
            sentence="It gives no contact forces, so it cannot be checked.",
        )
    residuals = {
        "equilibrium": equilibrium_residual(assembly, forces, at),
        "yield": yield_violation(assembly, forces),
    }
    what = f"Equilibrium and yield of the contact forces at multiplier {at:.6g}"
    if result.finding is Finding.COLLAPSES and result.flow != "approximate":
        if mechanism is None:
            return Judgement(
                residuals=residuals,
                tolerance=tolerance,
                accepted=False,
                sentence="It gives no mechanism, so the collapse state cannot be checked.",
            )
        residuals = collapse_residuals(assembly, forces, at, mechanism, result.flow)
        what = f"The collapse state ({result.flow} flow)"
    return _decide(residuals, tolerance, what)


def _judge_fall(assembly: Assembly, mechanism: FloatArray | None, flow: str, tolerance: float) -> Judgement:
    if mechanism is None:
        return Judgement(tolerance=tolerance, accepted=None, sentence="It gives no mechanism of the fall to check.")
    mechanism = normalised_mechanism(assembly, mechanism)
    opening, slip = relative_velocities(assembly, mechanism)
    dilatant = opening - (assembly.friction * abs(slip))[:, None]
    gain = power(assembly.dead, mechanism) / assembly.force_scale
    residuals = {"interpenetration": max(0.0, float((-opening).max(initial=0.0))), "dead_work": gain}
    proved = float((-dilatant).max(initial=0.0)) <= tolerance and gain > 0.0
    measured = flow == "approximate"
    accepted = gain > 0.0 and (measured or residuals["interpenetration"] <= tolerance)
    if proved:
        sentence = "The mechanism gains dead work with dilatant flow: no equilibrium exists, which proves the fall."
    elif accepted and measured:
        sentence = "The measured motion gains dead work; its flow is not judged."
    elif accepted:
        sentence = "The mechanism gains dead work without interpenetration; an equilibrium may exist all the same."
    else:
        sentence = "The mechanism gains no dead work, or blocks pass through each other."
    return Judgement(residuals=residuals, tolerance=tolerance, accepted=accepted, sentence=sentence)


def _decide(residuals: dict[str, float], tolerance: float, what: str) -> Judgement:
    failed = [
        f"{name} {value:.3g}" for name, value in residuals.items() if name != "live_work" and not value <= tolerance
    ]
    if "live_work" in residuals and not residuals["live_work"] > 0.0:
        failed.append("the live load does no work on the mechanism")
    sentence = f"{what} was checked from block sums"
    sentence += (
        f"; not within {tolerance:.3g}: {', '.join(failed)}." if failed else f" and holds within {tolerance:.3g}."
    )
    return Judgement(residuals=residuals, tolerance=tolerance, accepted=not failed, sentence=sentence)


def worst_residual(judgement: Judgement) -> float | None:
    """The largest of the residuals that ought to vanish, or None if nothing was judged."""
    values = [value for name, value in judgement.residuals.items() if name not in ("live_work", "dead_work")]
    return max(values) if values else None
