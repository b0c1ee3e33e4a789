"""The residuals by which the judge tells whether a claim holds; none shares a matrix with the methods.

They are relative to what acts where they arise (F, and what is small beside it, as in `harness.engine.measures`;
r = largest radius of a block; each independent component's mechanism scaled so that its fastest vertex has speed 1, or
so that its live work is that of the largest live load that does any, along the motion of its block at speed 1,
whichever makes it larger: a block that moves fast and does no work hides nothing, and the load of one at rest is
beside the point). Joints with cohesion c and tensile strength T = f_t A bear T/2 at each end and c A in shear besides
friction, and dissipate that as they open and slide; in dry joints both are zero. Joints with a compressive strength
bear what their stress block does, and may close where it crushes (`harness.engine.crushing`):

supports            fastest vertex of a fixed block, to the fastest of the wall
equilibrium         out-of-balance force or moment/r of a free block / what is small on that block; where its contact
                    forces are immense beside the loads, from sums in fractions
yield               tension beyond T/2 at an end, excess of |s| over mu (n1 + n2) + c A, or excess over the stress
                    block / what is small on either of the two blocks
interpenetration    closing velocity at a contact point (beyond what the flow rule asks for)
dilatancy           opening of a contact point that is not at its tensile strength: min(slack / smaller F, velocity);
                    of a joint that crushes, what its stress block would take more than its forces do / (F x velocity)
sliding             slip against slack of the shear strength, the same way
complementarity     work of these slacks where nothing should move, in live work at max(unit, |multiplier|)
bars                tension beyond the range of a bar, as yield; elongation of one below its greatest tension, or
                    shortening of one above its least, as sliding
virtual_work        |multiplier - (dissipation - dead work)/live work|, relative to max(unit, |multiplier|)
multiplier          |multiplier - that of the forces| / the larger of the two
live_work           not a residual to be small: live work of the mechanism of a component, must be positive

The unit is the multiplier at which the live load is as large as the dead load of the component: one for a tilt; or at
which the live work is as large as the dead loads times the speeds of their blocks, where that is less: a heavy block
that rests does not count. So a live load that is given ten times larger, with a multiplier ten times smaller, is judged
alike. An independent structure beside a wall, however heavy, however fast, changes no residual of the wall.
"""

from __future__ import annotations

import numpy as np

from harness.engine.bar_checks import bars_at_work, dissipated_by_bars
from harness.engine.crushing import block_excess, block_power
from harness.engine.judge_law import (
    beyond_lift,
    borne_by_friction,
    dissipated_by_friction,
    dissipated_by_strength,
    slacks,
)
from harness.engine.measures import Measures, between, exact_sum, magnitudes
from harness.model.assembly import Assembly, FloatArray
from harness.model.bars import Bars
from harness.model.components import Component, components_of
from harness.model.displaced import DisplacedState
from harness.model.result import fastest_vertex, relative_velocities

_AT_REST = 1e-12
"""A component slower than this beside the fastest of the wall is taken as at rest: rounding of its speeds; so is a
block beside the fastest of its component where the dead loads that move are summed.

Live work is none up to this share of what the live loads would do along the motions of their blocks."""

_NO_WORK = 1e-12
"""Share of all live work up to which that of a block is rounding of its rest: one of 1e12 weights moved by 1e-48."""
MOVED = 5e-3
"""Displacement, in sizes of a block, and rotation [rad] up to which a wall at rest shows what it bears as drawn.

Loads shift against the joints by as much, which changes a multiplier by a share of about this size: the accuracy that
methods state. The library's soft joints give by a thousandth at most."""
_TURNED = 0.5
"""Difference of a unit normal from that of its joint from on which it is that of another face."""
OVERLAP = 0.1
"""Depth, in sizes of a block, up to which soft blocks overlap at a contact point."""
GAP = 1e-3
"""Distance, in sizes of a block, within which a contact point outside a block is at its outline."""


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


def force_residuals(
    assembly: Assembly,
    forces: FloatArray,
    multiplier: float,
    measures: Measures | None = None,
    beyond: FloatArray | None = None,
) -> dict[str, float]:
    """Equilibrium and yield of contact forces (m, 3) with dead + multiplier x live.

    Args:
        assembly: the wall; forces: (m, 3) contact forces (n1, n2, s) [force]; multiplier: of the live load.
        measures: what acts on every block, where it is known already.
        beyond: (k,) tensions of the bars beyond their prestress, which is in the dead load [force]; None: none.
    """
    measures = Measures.of(assembly, forces, multiplier, beyond) if measures is None else measures
    balance = block_sums(assembly, forces) + assembly.dead + multiplier * assembly.live
    if beyond is not None:
        balance += assembly.bars.generalised(beyond, assembly.centroid)
    for block in measures.immense(assembly):
        balance[block] = exact_sum(assembly, forces, multiplier, block, beyond)
    balance[:, 2] /= assembly.radius
    unbalanced = measures.relative(abs(balance).max(axis=1), measures.acting, measures.own)
    broken = np.maximum(0.0, -slacks(assembly, forces).min(axis=1))
    if assembly.crushes:
        broken = np.maximum(broken, block_excess(assembly, forces))
    violation = measures.relative(broken, between(assembly, measures.acting), between(assembly, measures.own))
    found = {
        "equilibrium": float(unbalanced[assembly.free].max(initial=0.0)),
        "yield": float(violation.max(initial=0.0)),
    }
    if beyond is not None:
        bars = assembly.bars
        outside = _outside_range(bars, beyond)
        acting, own = (between(assembly, part, bars) for part in (measures.acting, measures.own))
        found["bars"] = float(measures.relative(outside, acting, own).max(initial=0.0))
    return found


def displaced_residuals(assembly: Assembly, state: DisplacedState, multiplier: float) -> dict[str, float]:
    """Equilibrium and yield of a wall at rest where its blocks have moved to, under loads that keep their directions.

    These two are relative to the loads of the component: forces at measured places are no better than that. Cohesion
    and tensile strength do not count: what is left of them in joints that have moved is not known.

    Args:
        assembly: the wall before it moved; state: its contacts and forces; multiplier: of the live load.
    """
    balance = assembly.dead + multiplier * assembly.live
    loads = Measures.of(assembly, np.zeros((assembly.n_interfaces, 3)), multiplier).loads
    loads = np.where(loads > 0.0, loads, assembly.force_scale)
    a, b = assembly.block_a[state.interface], assembly.block_b[state.interface]
    for block, force in ((state.onto, state.force), (a + b - state.onto, -state.force)):
        arm = state.point - assembly.centroid[block] - state.places[block, :2]
        moment = arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
        np.add.at(balance, block, np.column_stack([force, moment]))
    balance[:, 2] /= assembly.length_scale
    normal = (state.force * state.normal).sum(axis=1)
    shear = abs(state.force[:, 1] * state.normal[:, 0] - state.force[:, 0] * state.normal[:, 1])
    excess = shear - borne_by_friction(assembly.friction[state.interface], normal)
    violation = np.maximum(0.0, np.maximum(-normal, excess)) / between(assembly, loads)[state.interface]
    return {
        "equilibrium": float((abs(balance).max(axis=1) / loads)[assembly.free].max(initial=0.0)),
        "yield": float(violation.max(initial=0.0)),
    }


def displaced_fault(assembly: Assembly, state: DisplacedState) -> str:
    """What makes a displaced state none of this wall, in words; empty where nothing does.

    Supports rest; every force acts where its two blocks touch, along the normal
    of their joint but for the rotations.
    """
    count = len(state.interface)
    shapes = [part.shape for part in (state.interface, state.onto, state.point, state.normal, state.force)]
    if shapes != [(count,), (count,), (count, 2), (count, 2), (count, 2)]:
        return "its contacts do not have one entry each of everything"
    if not ((state.interface >= 0) & (state.interface < assembly.n_interfaces)).all():
        return f"a contact belongs to none of the {assembly.n_interfaces} joints"
    finite = all(np.isfinite(part).all() for part in vars(state).values())
    if state.places.shape != (assembly.n_blocks, 3) or not finite:
        return f"its places are not {assembly.n_blocks} triples, or its numbers are not finite"
    if state.places[assembly.fixed].any():
        return "it moves the supports"
    a, b = assembly.block_a[state.interface], assembly.block_b[state.interface]
    if not ((state.onto == a) | (state.onto == b)).all():
        return "a force acts on a block that does not belong to its joint"
    if (abs(np.hypot(*state.normal.T) - 1.0) > _AT_REST).any():
        return "a normal is not a unit vector"
    onto_b = np.where(state.onto == b, 1.0, -1.0)[:, None]
    if (abs(state.normal - onto_b * assembly.normal[state.interface]).max(axis=1, initial=0.0) > _TURNED).any():
        return "a force acts across a face that does not belong to its joint"
    for p, point, force in zip(state.interface, state.point, state.force, strict=True):
        for block in (int(assembly.block_a[p]), int(assembly.block_b[p])):
            if force.any() and not _touches(assembly, state, block, point):
                return f"a force acts where block {assembly.block_ids[block]!r} does not touch its neighbour"
    return ""


def moved_far(assembly: Assembly, state: DisplacedState) -> bool:
    """Whether a state shows another wall than the one drawn: `MOVED` is exceeded.

    By the displacement or the rotation of a block; or twice, by the rotations of two, by the normal of a joint.
    """
    sense = np.where(state.onto == assembly.block_b[state.interface], 1.0, -1.0)[:, None]
    turned = abs(state.normal - sense * assembly.normal[state.interface]).max(initial=0.0)
    shifted = abs(state.places[:, :2]).max(initial=0.0) / assembly.length_scale
    return bool(max(shifted, abs(state.places[:, 2]).max(initial=0.0), 0.5 * turned) > MOVED)


def _touches(assembly: Assembly, state: DisplacedState, block: int, point: FloatArray) -> bool:
    """Whether a point (2,) is at the outline of a block where it has moved to: hardly outside, not deep inside."""
    x, y, angle = state.places[block]
    cosine, sine = np.cos(angle), np.sin(angle)
    corners = assembly.polygons[block] - assembly.centroid[block]
    back = (point - assembly.centroid[block] - [x, y]) @ np.array([[cosine, -sine], [sine, cosine]])
    sides, arms = np.roll(corners, -1, axis=0) - corners, back - corners
    nearest = np.clip((arms * sides).sum(axis=1) / (sides**2).sum(axis=1), 0.0, 1.0)[:, None] * sides
    distance = float(np.hypot(*(arms - nearest).T).min())
    # A ray to the right of a point inside crosses an odd number of sides.
    straddles = (arms[:, 1] < 0.0) != (arms[:, 1] < sides[:, 1])
    left = arms[:, 0] * sides[:, 1] - arms[:, 1] * sides[:, 0]
    inside = int((straddles & (left * np.sign(sides[:, 1]) < 0.0)).sum()) % 2 == 1
    return distance <= (OVERLAP if inside else GAP) * assembly.length_scale


def power(load: FloatArray, mechanism: FloatArray) -> float:
    """Power of a generalised load (n, 3) on a mechanism (n, 3) [force x velocity]."""
    return float((load * mechanism).sum())


def moving_parts(
    assembly: Assembly, mechanism: FloatArray, at_rest: float = _AT_REST
) -> tuple[float, list[tuple[Component, FloatArray]]]:
    """The speed of the supports beside the fastest vertex, and the components that move.

    A component comes with its motion, whose fastest vertex has speed 1.

    Args:
        assembly: the wall; mechanism: (n, 3) block velocities at any scale.
        at_rest: speed, beside the fastest of the wall, up to which a component is taken as at rest.
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
        (part, own / speed) for (part, own), speed in zip(parts, speeds, strict=True) if speed > at_rest * fastest
    ]


def collapse_residuals(
    assembly: Assembly,
    forces: FloatArray,
    multiplier: float,
    mechanism: FloatArray,
    flow: str,
    beyond: FloatArray | None = None,
) -> dict[str, float]:
    """The residuals of a collapse state, by the names of this module's docstring.

    Args:
        assembly: the wall.
        forces: (m, 3) contact forces (n1, n2, s) [force].
        multiplier: of the live load.
        mechanism: (n, 3) block velocities at any scale.
        flow: "non-associated" (of the dilatancy that the wall gives its joints) or "associated" (of their friction).
        beyond: (k,) tensions of the bars beyond their prestress [force]; None: there are none.
    """
    supports, parts = moving_parts(assembly, mechanism)
    measures = Measures.of(assembly, forces, multiplier, beyond)
    scale = between(assembly, measures.acting)
    residuals = force_residuals(assembly, forces, multiplier, measures, beyond) | {"supports": supports}
    works: list[float] = []
    for part, motion in parts:
        joints = part.interfaces
        tensions = np.zeros(len(part.bars)) if beyond is None else beyond[part.bars]
        acting = between(assembly, measures.acting, assembly.bars)[part.bars]
        own = _mechanism_residuals(
            part.assembly, forces[joints], scale[joints], multiplier, motion, flow, (tensions, acting)
        )
        works.append(own.pop("live_work"))
        for name, value in own.items():
            residuals[name] = max(residuals.get(name, 0.0), value)
    return residuals | {"live_work": max(works, default=0.0)}


def _largest_working(assembly: Assembly, mechanism: FloatArray) -> float:
    """The largest live load of a block that does work [force], by its share along the motion (n, 3) of that block."""
    speed = np.hypot(*mechanism[:, :2].T) + abs(mechanism[:, 2]) * assembly.radius
    work = abs((assembly.live * mechanism).sum(axis=1))
    does = work > _NO_WORK * work.sum()
    return float((work[does] / speed[does]).max(initial=0.0))


def scaled_to_live_work(assembly: Assembly, mechanism: FloatArray) -> tuple[FloatArray, float]:
    """The motion (n, 3) of a component of fastest vertex 1, larger where its live work is small, and that work."""
    live_work = power(assembly.live, mechanism)
    largest = _largest_working(assembly, mechanism)
    if 0.0 < live_work < _AT_REST * largest:
        return mechanism, 0.0
    if 0.0 < live_work < largest:
        return mechanism * (largest / live_work), largest
    return mechanism, live_work


def _mechanism_residuals(
    assembly: Assembly,
    forces: FloatArray,
    scale: FloatArray,
    multiplier: float,
    mechanism: FloatArray,
    flow: str,
    bars: tuple[FloatArray, FloatArray],
) -> dict[str, float]:
    """Residuals of the mechanism of one component, of fastest vertex 1; `scale` (m,) is what acts at its interfaces.

    `bars` are the tensions (k,) beyond their prestress, and what acts at them (k,).
    """
    mechanism, live_work = scaled_to_live_work(assembly, mechanism)
    opening, slip = relative_velocities(assembly, mechanism)
    opening = beyond_lift(assembly, opening, slip, flow)
    forward, backward = np.maximum(slip, 0.0), np.maximum(-slip, 0.0)
    slack = slacks(assembly, forces)
    slack_normal, slack_forward, slack_backward = slack[:, :2], slack[:, 2], slack[:, 3]
    stays = abs(slack_normal * opening)
    rigid = np.isinf(assembly.crushing)
    unused = np.zeros(len(opening))
    if assembly.crushes:
        unused = np.where(rigid, 0.0, block_power(assembly, opening) + (forces[:, :2] * opening).sum(axis=1))
    stays, closing = stays[rigid], -opening[rigid]
    idle_work = float(stays.sum() + abs(slack_forward * forward).sum() + abs(slack_backward * backward).sum())
    idle_work += float(abs(unused).sum())
    bars_at_fault, idle_in_bars = bars_at_work(assembly, *bars, mechanism)
    idle_work += idle_in_bars
    # Virtual work: contact forces do work r.q on the mechanism; friction dissipates what lifting does not give back.
    dissipation = dissipated_by_friction(assembly, forces, slip, flow)
    dissipation += dissipated_by_strength(assembly, opening, slip) + dissipated_by_bars(assembly, mechanism)
    residuals = {
        "interpenetration": max(0.0, float(closing.max(initial=0.0))),
        "dilatancy": max(
            float(np.minimum(abs(slack_normal) / scale[:, None], np.maximum(opening, 0.0))[rigid].max(initial=0.0)),
            float((abs(unused) / scale).max(initial=0.0)),
        ),
        "sliding": float(
            max(
                np.minimum(abs(slack_forward) / scale, forward).max(initial=0.0),
                np.minimum(abs(slack_backward) / scale, backward).max(initial=0.0),
            )
        ),
        "live_work": live_work / (assembly.force_scale or 1.0),
    }
    if len(assembly.bars):
        residuals["bars"] = bars_at_fault
    if live_work > 0.0:
        by_virtual_work = (dissipation - power(assembly.dead, mechanism)) / live_work
        speed = np.hypot(*mechanism[:, :2].T) + abs(mechanism[:, 2]) * assembly.radius
        speed[speed <= _AT_REST * speed.max()] = 0.0
        moved = float((magnitudes(assembly, assembly.dead) * speed).sum())
        unit = min(assembly.load_unit, moved / live_work) if moved > 0.0 else assembly.load_unit  # weightless blocks
        size = max(unit, abs(multiplier))
        residuals["complementarity"] = idle_work / live_work / size
        residuals["virtual_work"] = abs(by_virtual_work - multiplier) / size
    return residuals


def _outside_range(bars: Bars, beyond: FloatArray) -> FloatArray:
    """(k,) tension beyond the range of each bar [force]."""
    return np.asarray(np.maximum(0.0, np.maximum(bars.least - beyond, beyond - bars.greatest)))
