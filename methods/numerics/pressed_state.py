"""The exact collapse state of joints that crush, near that of a wall within tangents of their stress blocks: Newton.

The state found says which joints open, at which end, and which slip. With these the limits of all joints are replaced
by their tangents at the forces F known so far: of a stress block

    (1 - a) m1 - a m2 + a^2 F0 / 2 >= 0,   m_i = n_i + T/2,   a = F / F0,

and the same with both ends exchanged. They are equations where the joint moves, else inequalities. Of all forces in
equilibrium those nearest to what was known follow, with the multiplier; and so on until F does not change. The rows are
the flow vectors too: a joint turns about the inner edge of its strip, and slips by its own dilatancy. A mechanism of
these, without motion elsewhere, completes the state.

Where self-stress leaves the forces a choice, the mechanism may leave none: it needs strips of certain widths. Forces
and mechanism are then solved for together, again by Newton: equilibrium, limits of the rows that move, compatibility

    C' r + f0 + lambda fL = 0,   S_i(a) r + s0_i(a) = 0,   C u = E(a) g,   fL . u = 1,   a = F(r) / F0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import lsqr

from harness.model.assembly import Assembly, BoolArray, FloatArray
from harness.model.joint_law import block_diagonal
from methods.numerics.stress_blocks import pressed_shares

_MOVING = 1e-7
"""Rate of a joint, beside the fastest, above which it moves; mechanisms of methods are good to 1e-8."""
_SETTLED = 1e-8
"""Change of a pressed share at which the tangents are those at the forces: the error is its square."""
_ASIDE = 1e3
"""Weight of strains that the rows of moving joints do not explain, beside differences of their rates. Where pressed
shares do not fit together to rounding, no motion but rest is without any."""
_ROUNDS = 12
"""Of tangents, at most. Each squares the change."""
_SOLVED = 1e-12
"""Of the equations of forces and mechanism, in mean weights of a block and shares of the live work."""
_VIOLATION = 5e-10
"""Of a limit, relative to the terms beside it, that forces and mechanism may have: half of what the judge tolerates.
Where more limits meet in one point than the mechanism has joints, as in a symmetric arch, vertices keep them to 1e-10
only, and so do mechanisms in which joints open that press nothing."""


@dataclass(frozen=True, eq=False)
class PressedState:
    """A collapse state: its multiplier, contact forces (m, 3) [force] and mechanism (n, 3)."""

    multiplier: float
    forces: FloatArray
    mechanism: FloatArray


def moving_rates(wall: Assembly, mechanism: FloatArray) -> FloatArray:
    """(m, 4) rates of the rows of the joint law along which the joints move in a mechanism (n, 3); zero at rest."""
    strains = (wall.kinematic_matrix @ mechanism[wall.free].ravel()).reshape(-1, 3)
    rates = wall.law.rates(strains)
    return np.where(rates > _MOVING * abs(strains).max(), rates, 0.0)


def exact_state(
    assembly: Assembly,
    forces: FloatArray,
    moving: BoolArray,
    empty: BoolArray | None = None,
    hinges: FloatArray | None = None,
) -> PressedState | None:
    """The collapse state in which the rows `moving` (m, 4) move, with forces near these (m, 3); None without any.

    Args:
        empty: (m,) joints of those that press nothing, since they turn about an end.
        hinges: (m,) shares that joints which turn press, as of `hinges_of_both`; None: as their forces say.
    """
    held = None if hinges is None else np.where(_turning(assembly, moving), hinges, np.nan)
    found = _settled_forces(assembly, forces, _reached(moving, empty), held=held)
    if found is None:
        return None
    known, multiplier = found
    mechanism = _mechanism(assembly, _shares(assembly, known, held), moving)
    return None if mechanism is None else PressedState(multiplier, known, mechanism)


def hinges_of_both(
    assembly: Assembly, state: PressedState, rates: FloatArray, empty: BoolArray | None = None
) -> FloatArray | None:
    """(m,) shares that the joints press in a state whose forces and mechanism are solved for together; None without.

    Args:
        assembly: the wall; state: where Newton begins, one of the wall within tangents.
        rates: (m, 4) of the rows of its mechanism, zero where they do not move; empty: as of `exact_state`.
    """
    m, n = assembly.n_interfaces, assembly.n_free
    column = assembly.velocity_units()
    unit = assembly.force_scale / n
    strains = sp.csr_matrix(assembly.kinematic_matrix @ sp.diags(column))
    dead, live = (part * column / unit for part in assembly.free_loads())
    live *= assembly.load_unit
    statics, along = sp.csr_matrix(strains.T), sp.csr_matrix(live[None, :])
    moving, reached = rates > 0.0, _reached(rates > 0.0, empty).ravel()
    movable, turns = moving.ravel(), _turning(assembly, moving)
    full = np.where(turns, assembly.crushing + assembly.constant[:, :2].sum(axis=1), 1.0) / unit
    velocity = state.mechanism[assembly.free].ravel() / column
    power = float(live @ velocity)
    forces, multiplier = state.forces.ravel() / unit, state.multiplier / assembly.load_unit
    velocity, speed = velocity / power, rates.ravel()[movable] / power
    sizes = np.cumsum([3 * m, 1, 3 * n])
    for _ in range(_ROUNDS):
        share = pressed_shares(assembly, forces.reshape(-1, 3) * unit)
        rows, constant, flow = _tangents(assembly, share)
        limits, flows = block_diagonal(rows)[reached], sp.csc_matrix(block_diagonal(flow))[:, movable]
        turning = np.zeros((m, 4))
        turning[moving] = speed
        wider = np.where(turns, turning[:, :2].sum(axis=1) / full, 0.0)
        widening = np.zeros((m, 3, 3))
        widening[:, :2, :2] = wider[:, None, None]
        left = [
            statics @ forces + dead + multiplier * live,
            limits @ forces + constant.ravel()[reached] / unit,
            strains @ velocity - flows @ speed,
            np.array([live @ velocity - 1.0]),
        ]
        if max(abs(part).max(initial=0.0) for part in left) <= _SOLVED:
            return share
        slopes: list[list[Any]] = [
            [statics, along.T, None, None],
            [limits, None, None, None],
            [block_diagonal(widening), None, strains, -flows],
            [None, None, along, None],
        ]
        matrix = sp.csr_matrix(sp.bmat(slopes))
        exact = 0.1 * _SOLVED
        step = lsqr(matrix, -np.concatenate(left), atol=exact, btol=exact, iter_lim=10 * matrix.shape[1])[0]
        by_force, by_load, by_motion, by_rate = np.split(step, sizes)
        forces, multiplier = forces + by_force, multiplier + float(by_load[0])
        velocity, speed = velocity + by_motion, speed + by_rate
    return None


def _reached(moving: BoolArray, empty: BoolArray | None) -> BoolArray:
    """(m, 4) rows that are at their limits: both ends of joints that press nothing."""
    return moving if empty is None else moving | (empty[:, None] & np.array([True, True, False, False]))


def _turning(assembly: Assembly, moving: BoolArray) -> BoolArray:
    """(m,) joints that crush and turn."""
    return np.asarray(moving[:, :2].any(axis=1) & np.isfinite(assembly.crushing))


def _shares(assembly: Assembly, forces: FloatArray, held: FloatArray | None) -> FloatArray:
    """(m,) shares that are held, and where they are not (nan) those of the forces (m, 3)."""
    share = pressed_shares(assembly, forces)
    return share if held is None else np.where(np.isnan(held), share, held)


def _tangents(assembly: Assembly, share: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Rows S (m, 4, 3), constants s0 (m, 4) and flow E (m, 3, 4) of the law, linear about pressed shares (m,)."""
    law = assembly.law
    rows, flow, constant = law.rows.copy(), law.flow.copy(), law.constant.copy()
    turn = np.stack([np.stack([1.0 - share, -share], axis=1), np.stack([-share, 1.0 - share], axis=1)], axis=1)
    rows[:, :2, :2] = turn
    flow[:, :2, :2] = turn.transpose(0, 2, 1)
    full = np.where(np.isfinite(assembly.crushing), assembly.crushing + constant[:, 0] + constant[:, 1], 0.0)
    constant[:, :2] = (turn * law.constant[:, None, :2]).sum(axis=2) + (0.5 * share**2 * full)[:, None]
    return rows, constant, flow


def held_forces(assembly: Assembly, forces: FloatArray, multiplier: float) -> FloatArray | None:
    """The contact forces (m, 3) within the stress blocks that bear a multiplier, near others; None without any."""
    rests = np.zeros((assembly.n_interfaces, 4), dtype=bool)
    found = _settled_forces(assembly, forces, rests, multiplier)
    return None if found is None else found[0]


def _settled_forces(
    assembly: Assembly,
    near: FloatArray,
    reached: BoolArray,
    multiplier: float | None = None,
    held: FloatArray | None = None,
) -> tuple[FloatArray, float] | None:
    """As `_nearest_forces`, within tangents at the forces that are found; None where these do not settle."""
    known = near
    for _ in range(_ROUNDS):
        share = _shares(assembly, known, held)
        found = _nearest_forces(assembly, share, reached, near, multiplier, held)
        if found is None:
            return None
        known, _ = found
        if abs(_shares(assembly, known, held) - share).max(initial=0.0) <= _SETTLED:
            return found
    return None


def _nearest_forces(
    assembly: Assembly,
    share: FloatArray,
    reached: BoolArray,
    near: FloatArray,
    multiplier: float | None,
    held: FloatArray | None,
) -> tuple[FloatArray, float] | None:
    """Forces (m, 3) nearest to others within tangents at shares (m,), and their multiplier, which may be given.

    Args:
        reached: (m, 4) rows that are at their limits.
        held: (m,) shares that the joints press; nan, or None, where their forces are free.
    """
    from methods.numerics.linear_programme import INFINITY, Programme  # HiGHS, which few answers need

    m, n = assembly.n_interfaces, assembly.n_free
    column = assembly.velocity_units()
    unit = assembly.force_scale / n
    rows, constant, _ = _tangents(assembly, share)
    statics = sp.csr_matrix((assembly.kinematic_matrix @ sp.diags(column)).T)
    dead, live = (part * column for part in assembly.free_loads())
    live = live * (assembly.load_unit / unit)
    apart = sp.identity(3 * m, format="csr")
    press = np.full(m, np.nan) if held is None else held
    pressing = np.flatnonzero(~np.isnan(press))
    tension = assembly.constant[pressing, 0] + assembly.constant[pressing, 1]
    pressed = press[pressing] * (assembly.crushing[pressing] + tension) - tension
    ends = block_diagonal(np.tile([[1.0, 1.0, 0.0]], (m, 1, 1)))[pressing]
    matrix = sp.bmat(
        [
            [statics, sp.csr_matrix(live[:, None]), None],
            [block_diagonal(rows), None, None],
            [ends, None, None],
            [apart, None, sp.hstack([-apart, apart])],
        ]
    )
    slack, target = -constant.ravel() / unit, near.ravel() / unit
    most = np.where(reached.ravel(), slack, INFINITY)
    at = (-INFINITY, INFINITY) if multiplier is None else (multiplier / assembly.load_unit,) * 2
    free, none, parts = np.full(3 * m, INFINITY), np.zeros(6 * m), np.full(6 * m, INFINITY)
    programme = Programme(
        sp.csc_matrix(matrix),
        np.append(np.zeros(3 * m + 1), np.ones(6 * m)),
        (np.concatenate([-free, at[:1], none]), np.concatenate([free, at[1:], parts])),
        (
            np.concatenate([-dead / unit, slack, pressed / unit, target]),
            np.concatenate([-dead / unit, most, pressed / unit, target]),
        ),
    )
    status, _, _ = programme.run()
    vertex = programme.vertex() if status == "optimal" else None
    if vertex is None or not vertex.primal <= _VIOLATION:
        return None
    return vertex.value[: 3 * m].reshape(-1, 3) * unit, float(vertex.value[3 * m]) * assembly.load_unit


def nearest_motion(assembly: Assembly, share: FloatArray, rates: FloatArray) -> FloatArray | None:
    """The motion (n, 3) of joints that press shares (m,) nearest to rates (m, 4), along rows that move in these.

    Strains aside from these rows are weighted by `_ASIDE`. None where the programme fails.
    """
    from methods.numerics.linear_programme import INFINITY, Programme

    m, n = assembly.n_interfaces, assembly.n_free
    column = assembly.velocity_units()
    _, _, flow = _tangents(assembly, share)
    strains = sp.csr_matrix(assembly.kinematic_matrix @ sp.diags(column))
    own = sp.identity(4 * m, format="csr")
    aside = sp.identity(3 * m, format="csr")
    matrix = sp.bmat(
        [
            [strains, -block_diagonal(flow), None, sp.hstack([-aside, aside])],
            [None, own, sp.hstack([-own, own]), None],
        ]
    )
    target = np.maximum(rates, 0.0).ravel() / rates.max()
    speeds, none, parts = np.full(3 * n, INFINITY), np.zeros(18 * m), np.full(14 * m, INFINITY)
    right = np.append(np.zeros(3 * m), target)
    programme = Programme(
        sp.csc_matrix(matrix),
        np.concatenate([np.zeros(3 * n + 4 * m), np.ones(8 * m), np.full(6 * m, _ASIDE)]),
        (np.append(-speeds, none), np.concatenate([speeds, np.where(target > 0.0, INFINITY, 0.0), parts])),
        (right, right),
    )
    status, value, _ = programme.run()
    if status != "optimal":
        return None
    mechanism = np.zeros((assembly.n_blocks, 3))
    mechanism[assembly.free] = (value[: 3 * n] * column).reshape(-1, 3)
    return mechanism


def _mechanism(assembly: Assembly, share: FloatArray, moving: BoolArray) -> FloatArray | None:
    """A mechanism (n, 3) of positive live work whose joints move along the rows `moving` (m, 4) alone; None if none."""
    from methods.numerics.linear_programme import INFINITY, Programme

    m, n = assembly.n_interfaces, assembly.n_free
    column = assembly.velocity_units()
    _, _, flow = _tangents(assembly, share)
    live = assembly.free_loads()[1] * column
    strains = sp.csr_matrix(assembly.kinematic_matrix @ sp.diags(column))
    work = sp.csr_matrix(live[None, :] / abs(live).sum())
    matrix = sp.vstack([sp.hstack([strains, -block_diagonal(flow)]), sp.hstack([work, sp.csr_matrix((1, 4 * m))])])
    speeds = np.full(3 * n, INFINITY)
    right = np.append(np.zeros(3 * m), 1.0)
    programme = Programme(
        sp.csc_matrix(matrix),
        np.zeros(3 * n + 4 * m),
        (np.append(-speeds, np.zeros(4 * m)), np.append(speeds, np.where(moving.ravel(), INFINITY, 0.0))),
        (right, right),
    )
    status, _, _ = programme.run()
    vertex = programme.vertex() if status == "optimal" else None
    if vertex is None or not vertex.primal <= _VIOLATION:
        return None
    mechanism = np.zeros((assembly.n_blocks, 3))
    mechanism[assembly.free] = (vertex.value[: 3 * n] * column).reshape(-1, 3)
    return mechanism
