"""The judge: checks the claim that an answer makes from forces and block sums; it shares no matrix with the methods.

The claims, and exactly what proves each:

collapses at lambda  forces in equilibrium with dead + lambda x live at the multiplier that is reported, within yield;
                     a mechanism at rest on the supports, without interpenetration, of the stated flow rule,
                     complementary to the forces, on which the live load does positive work
bracket              (flow "approximate") forces in equilibrium within yield at its lower end or above; the upper end is
                     measured and is not judged
stands               forces in equilibrium within yield under the dead load, where no live load was given; with a live
                     load they show no multiplier, and the answer is not judged
falls                a dilatant mechanism, at rest on the supports, on which the dead load does positive work: no
                     equilibrium exists (Farkas); a measured motion is no proof and is not judged
unbounded            forces within yield that balance the live load alone, besides forces under the dead load: their sum
                     bears any multiplier

What proves nothing either way is not judged (`Judgement.accepted` is None), which never means accepted.

Residuals are relative to what acts where they arise (F = sum of the magnitudes of load and contact forces on a block,
r = its largest radius; each independent component's mechanism scaled so that its fastest vertex has speed 1):

supports            fastest vertex of a fixed block, to the fastest of the wall
equilibrium         out-of-balance force or moment/r of a free block / F of that block
yield               tension or excess of |s| over mu (n1 + n2) / the smaller F of the two blocks
interpenetration    closing velocity at a contact point (beyond what the flow rule asks for)
dilatancy           opening of a contact point that still carries force: min(force / smaller F, velocity)
sliding             slip against slack of the friction cone, the same way
complementarity     work of contact forces where nothing should move, in live work at max(unit, |multiplier|)
virtual_work        |multiplier - (dissipation - dead work)/live work|, relative to max(unit, |multiplier|)
multiplier          |multiplier - that of the forces|, relative to max(unit, |multiplier|)
live_work           not a residual to be small: live work of the mechanism of a component, must be positive

The unit is the multiplier at which the live load is as large as the dead load: one for a tilt. So a live load that is
given ten times larger, with a multiplier ten times smaller, is judged alike. An independent structure beside a wall,
however heavy, however fast, changes no residual of the wall.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.components import components_of
from harness.model.displaced import DisplacedState
from harness.model.method import Finding, Status
from harness.model.result import Judgement, Result, fastest_vertex, relative_velocities

AT_REST = 1e-12
"""A component slower than this beside the fastest of the wall is taken as at rest: rounding of its speeds."""


UNLOADED = 1e-6
"""Share of the largest sum of its component by which a block without load is measured at least.

Rounding leaves forces of 1e-16 to 1e-14 of that sum (measured on walls with weightless blocks), which then count as
1e-10 to 1e-8."""


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


def radii(assembly: Assembly) -> FloatArray:
    """Largest distance (n,) of a vertex of every block from its centroid [length]."""
    pairs = zip(assembly.polygons, assembly.centroid, strict=True)
    return np.array([float(np.hypot(*(polygon - centroid).T).max()) for polygon, centroid in pairs])


def acting(assembly: Assembly, forces: FloatArray, multiplier: float) -> FloatArray:
    """Sum (n,) of the magnitudes of the loads at a multiplier and of the contact forces (m, 3) on every block [force].

    A block without any load has nothing of its own to measure by, and may bear nothing but rounding of the others'
    forces: for it the sum is at least `UNLOADED` of the largest of its component.
    """
    radius = radii(assembly)
    total = np.zeros(assembly.n_blocks)
    for load in (assembly.dead, multiplier * assembly.live):
        total += np.hypot(load[:, 0], load[:, 1]) + abs(load[:, 2]) / radius
    unloaded = total == 0.0
    size = abs(forces).sum(axis=1)
    np.add.at(total, assembly.block_a, size)
    np.add.at(total, assembly.block_b, size)
    if unloaded[assembly.free].any():
        for part in components_of(assembly):
            own = part.blocks[unloaded[part.blocks]]
            total[own] = np.maximum(total[own], UNLOADED * total[part.blocks].max())
    return np.where(total > 0.0, total, 1.0)


def between(assembly: Assembly, scale: FloatArray) -> FloatArray:
    """The smaller (m,) of a measure (n,) of the two blocks of every interface, of the free one where one is fixed."""
    movable = np.where(assembly.fixed, np.inf, scale)
    smaller = np.minimum(movable[assembly.block_a], movable[assembly.block_b])
    both = np.minimum(scale[assembly.block_a], scale[assembly.block_b])
    return np.where(np.isfinite(smaller), smaller, both)


def equilibrium_residual(assembly: Assembly, forces: FloatArray, multiplier: float) -> float:
    """Largest out-of-balance force, or moment / radius, of a free block, relative to what acts on that block."""
    balance = block_sums(assembly, forces) + assembly.dead + multiplier * assembly.live
    balance[:, 2] /= radii(assembly)
    relative = abs(balance).max(axis=1) / acting(assembly, forces, multiplier)
    return float(relative[assembly.free].max(initial=0.0))


def yield_violation(assembly: Assembly, forces: FloatArray, multiplier: float) -> float:
    """Largest tension, or excess of shear over friction, relative to what acts on the blocks of that interface."""
    normal = forces[:, :2]
    excess = abs(forces[:, 2]) - assembly.friction * normal.sum(axis=1)
    worst = np.maximum((-normal).max(axis=1), excess) / between(assembly, acting(assembly, forces, multiplier))
    return float(worst.max(initial=0.0))


def force_residuals(assembly: Assembly, forces: FloatArray, multiplier: float) -> dict[str, float]:
    """Equilibrium and yield of contact forces (m, 3) with dead + multiplier x live."""
    return {
        "equilibrium": equilibrium_residual(assembly, forces, multiplier),
        "yield": yield_violation(assembly, forces, multiplier),
    }


def displaced_residuals(assembly: Assembly, state: DisplacedState, multiplier: float) -> dict[str, float]:
    """Equilibrium and yield of a wall at rest where its blocks have moved to, under loads that keep their directions.

    These two are relative to the whole wall: forces at measured places are no better than that.

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


def moving_parts(
    assembly: Assembly, mechanism: FloatArray
) -> tuple[float, list[tuple[Assembly, IntArray, FloatArray]]]:
    """The speed of the supports beside the fastest vertex, and the components that move.

    A component comes with the indices of its interfaces and its motion, whose fastest vertex has speed 1.

    Args:
        assembly: the wall; mechanism: (n, 3) block velocities at any scale.
    """
    largest = float(abs(mechanism).max(initial=0.0))
    if largest == 0.0:
        return 0.0, []
    motion = mechanism / largest
    ground = np.where(assembly.fixed[:, None], motion, 0.0)
    supports = fastest_vertex(assembly, ground) / fastest_vertex(assembly, motion)
    motion = motion - ground
    parts = [(part, motion[part.blocks]) for part in components_of(assembly)]
    speeds = [fastest_vertex(part.assembly, own) for part, own in parts]
    fastest = max(speeds, default=0.0)
    return supports, [
        (part.assembly, part.interfaces, own / speed)
        for (part, own), speed in zip(parts, speeds, strict=True)
        if speed > AT_REST * fastest
    ]


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
    supports, parts = moving_parts(assembly, mechanism)
    scale = between(assembly, acting(assembly, forces, multiplier))
    residuals = force_residuals(assembly, forces, multiplier) | {"supports": supports}
    works: list[float] = []
    for part, interfaces, motion in parts:
        own = _mechanism_residuals(part, forces[interfaces], scale[interfaces], multiplier, motion, flow)
        works.append(own.pop("live_work"))
        for name, value in own.items():
            residuals[name] = max(residuals.get(name, 0.0), value)
    return residuals | {"live_work": max(works, default=0.0)}


def _mechanism_residuals(
    assembly: Assembly, forces: FloatArray, scale: FloatArray, multiplier: float, mechanism: FloatArray, flow: str
) -> dict[str, float]:
    """Residuals of the mechanism of one component, of fastest vertex 1; `scale` (m,) is what acts at its interfaces."""
    opening, slip = relative_velocities(assembly, mechanism)
    if flow == "associated":
        opening = opening - (assembly.friction * abs(slip))[:, None]
    normal, shear = forces[:, :2], forces[:, 2]
    strength = assembly.friction * normal.sum(axis=1)
    forward, backward = np.maximum(slip, 0.0), np.maximum(-slip, 0.0)
    slack_forward, slack_backward = strength + shear, strength - shear
    live_work = power(assembly.live, mechanism)
    idle_work = float(
        abs(normal * opening).sum() + abs(slack_forward * forward).sum() + abs(slack_backward * backward).sum()
    )
    # Virtual work: contact forces do work r.q on the mechanism; friction dissipates, openings do not.
    dissipation = 0.0 if flow == "associated" else float((strength * abs(slip)).sum())
    residuals = {
        "interpenetration": max(0.0, float((-opening).max(initial=0.0))),
        "dilatancy": float(np.minimum(abs(normal) / scale[:, None], np.maximum(opening, 0.0)).max(initial=0.0)),
        "sliding": float(
            max(
                np.minimum(abs(slack_forward) / scale, forward).max(initial=0.0),
                np.minimum(abs(slack_backward) / scale, backward).max(initial=0.0),
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
    """What an independent check says of the claim that a result makes; see this module's docstring.

    Args:
        assembly: the wall.
        result: the answer as a result.
        tolerance: the largest residual that is acceptable for this method.
    """
    if result.status is not Status.OK or result.finding is Finding.NONE:
        return Judgement(tolerance=tolerance, sentence="There is no answer to judge.")
    forces = None if result.forces is None else np.asarray(result.forces, dtype=float).reshape(-1, 3)
    mechanism = None if result.mechanism is None else np.asarray(result.mechanism, dtype=float).reshape(-1, 3)
    for name, array in (("forces", forces), ("mechanism", mechanism)):
        if array is not None and not np.isfinite(array).all():
            return _said(tolerance, False, f"Its {name} hold numbers that are not finite.")
    match result.finding:
        case Finding.FALLS:
            return _judge_fall(assembly, mechanism, result.flow, tolerance)
        case Finding.STANDS:
            return _judge_standing(assembly, forces, result, tolerance)
        case Finding.UNBOUNDED:
            return _judge_unbounded(assembly, forces, result, tolerance)
    if result.flow == "approximate":
        return _judge_bracket(assembly, forces, result, tolerance)
    return _judge_collapse(assembly, forces, mechanism, result, tolerance)


def _said(tolerance: float, accepted: bool | None, sentence: str) -> Judgement:
    return Judgement(tolerance=tolerance, accepted=accepted, sentence=sentence)


NO_FORCES = "It gives no contact forces, so it cannot be checked."


def _judge_collapse(
    assembly: Assembly, forces: FloatArray | None, mechanism: FloatArray | None, result: Result, tolerance: float
) -> Judgement:
    """Collapse at the multiplier that is reported, by a whole collapse state."""
    multiplier = result.multiplier
    if forces is None or multiplier is None:
        return _said(tolerance, False, NO_FORCES if forces is None else "It gives no multiplier.")
    at = multiplier if result.forces_multiplier is None else result.forces_multiplier
    if mechanism is None:
        said = _said(tolerance, False, "It gives no mechanism, so the collapse state cannot be checked.")
        return said.model_copy(update={"residuals": force_residuals(assembly, forces, at)})
    residuals = collapse_residuals(assembly, forces, at, mechanism, result.flow)
    size = max(assembly.load_unit, abs(multiplier))
    residuals["multiplier"] = abs(multiplier - at) / size
    said = _decide(residuals, tolerance, f"The collapse state ({result.flow} flow)")
    if said.accepted:
        error = size * sum(residuals[name] for name in ("complementarity", "virtual_work", "multiplier"))
        said.sentence += f" By virtual work the multiplier of this mechanism is known to within {error:.1g}."
    return said


def _judge_bracket(assembly: Assembly, forces: FloatArray | None, result: Result, tolerance: float) -> Judgement:
    """A measured collapse: forces show its lower end; its upper end and its motion are not judged."""
    lower = result.multiplier if result.bracket is None else result.bracket[0]
    at = result.multiplier if result.forces_multiplier is None else result.forces_multiplier
    if lower is None or at is None:
        return _said(tolerance, False, "It gives no multiplier.")
    if forces is not None:
        residuals = force_residuals(assembly, forces, at)
        what = f"Equilibrium and yield of the contact forces at multiplier {at:.6g}"
    else:
        moved = DisplacedState.of(result.details)
        if moved is None:
            return _said(tolerance, None, NO_FORCES)
        residuals = displaced_residuals(assembly, moved, at)
        what = f"Equilibrium and yield of the contact forces where the blocks have moved to, at multiplier {at:.6g},"
    residuals["multiplier"] = max(0.0, lower - at) / max(assembly.load_unit, abs(lower))
    said = _decide(residuals, tolerance, what)
    if said.accepted:
        said.sentence += " They show the lower end; that the wall collapses above it is measured and not judged."
    return said


def _judge_standing(assembly: Assembly, forces: FloatArray | None, result: Result, tolerance: float) -> Judgement:
    """Stands under its dead load, where nothing more was asked."""
    what = "Equilibrium and yield of the contact forces under the dead load"
    if forces is not None:
        residuals = force_residuals(assembly, forces, 0.0)
    elif (moved := DisplacedState.of(result.details)) is not None:
        residuals = displaced_residuals(assembly, moved, 0.0)
        what += ", where the blocks have moved to,"
    elif assembly.n_free == 0:
        return _said(tolerance, True, "Every block is fixed: nothing can move.")
    else:
        return _said(tolerance, False, NO_FORCES)
    said = _decide(residuals, tolerance, what)
    if said.accepted and assembly.has_live_load:
        said.accepted = None
        said.sentence = "The wall stands under its dead load; no multiplier of the live load was shown."
    return said


def _judge_unbounded(assembly: Assembly, forces: FloatArray | None, result: Result, tolerance: float) -> Judgement:
    """Forces under the dead load, and forces that balance the live load alone: together they bear any multiplier."""
    growth = result.details.get("live_forces")
    if forces is None or growth is None:
        lacking = "forces under the dead load" if forces is None else "forces that balance the live load alone"
        return _said(tolerance, None, f"That no multiplier is too high was not shown: it gives no {lacking}.")
    ray = np.asarray(growth, dtype=float).reshape(-1, 3)
    if ray.shape != forces.shape or not np.isfinite(ray).all():
        return _said(tolerance, False, f"`live_forces` are not {len(forces)} finite triples.")
    at = 0.0 if result.forces_multiplier is None else result.forces_multiplier
    residuals = force_residuals(assembly, forces, at)
    alone = replace(assembly, dead=np.zeros_like(assembly.dead))
    residuals |= {f"live_{name}": value for name, value in force_residuals(alone, ray, 1.0).items()}
    return _decide(residuals, tolerance, f"Forces at multiplier {at:.6g} and forces that balance the live load alone")


def _judge_fall(assembly: Assembly, mechanism: FloatArray | None, flow: str, tolerance: float) -> Judgement:
    """No equilibrium: a dilatant mechanism of a component, supports at rest, on which the dead load does work."""
    if flow == "approximate" or mechanism is None:
        told = "The motion was measured, which is no proof" if mechanism is not None else "It gives no mechanism"
        return _said(tolerance, None, f"{told}; that no equilibrium exists was not shown.")
    supports, parts = moving_parts(assembly, mechanism)
    best = {"supports": supports, "interpenetration": 0.0, "dead_work": 0.0}
    proved = False
    for part, _, motion in parts:
        opening, slip = relative_velocities(part, motion)
        closing = max(0.0, float(((part.friction * abs(slip))[:, None] - opening).max(initial=0.0)))
        gain = power(part.dead, motion) / part.force_scale
        # A gain within the tolerance may be made of the closing that the tolerance allows.
        if supports <= tolerance and closing <= tolerance < gain:
            proved = True
        if best["dead_work"] <= 0.0 or (closing <= tolerance and gain > 0.0):
            best |= {"interpenetration": closing, "dead_work": gain}
    sentence = (
        "The mechanism gains dead work with dilatant flow and supports at rest: no equilibrium exists, which proves "
        "the fall."
        if proved
        else "The mechanism proves no fall: it gains no dead work, is not dilatant, or moves the supports."
    )
    return Judgement(residuals=best, tolerance=tolerance, accepted=proved, sentence=sentence)


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
