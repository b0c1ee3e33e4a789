"""Contact forces within yield that balance given loads, for all methods: C' r + f = 0, S r + s0 >= 0.

The greatest multiplier is the programme of Livesley (1978), max lambda with f = f0 + lambda fL.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp

from harness.model.assembly import Assembly, FloatArray
from methods.numerics.shear_rows import COST, least_shear_slacks, rows_of_blocks, shear_limits
from methods.numerics.stress_blocks import greatest_by_chords

if TYPE_CHECKING:
    from methods.numerics.vertex import Vertex

_LEAST_WORK = 1e-7
"""Work of the dead load that shows a fall, as total weight times speed: a programme to 1e-9 makes up less."""
_LEAST_EXACT_WORK = 1e-8
"""The same of a mechanism to rounding: on its closings, some 1e-16 a contact, forces of 1e7 dead loads do no more."""


def admissible_forces(assembly: Assembly, load: FloatArray) -> FloatArray | None:
    """Contact forces (m, 3) within yield in equilibrium with a load, every block to rounding of its own; None if none.

    Args:
        assembly: the wall.
        load: (n, 3) generalised loads on the blocks [force, force, moment].
    """
    m = assembly.n_interfaces
    if not np.any(load[assembly.free]):
        return np.zeros((m, 3))
    if m == 0:
        return None
    if assembly.crushes:
        return _borne_forces(assembly, load)
    vertex, unit = _vertex_of_forces(assembly, load)
    return None if vertex is None else assembly.law.in_units(unit).within(vertex.value.reshape(-1, 3)) * unit


def greatest_multiplier(assembly: Assembly) -> tuple[float, FloatArray, FloatArray] | None:
    """The greatest multiplier of statics, its contact forces (m, 3) and the dilatant mechanism (n, 3) dual to them.

    None where no forces within yield bear any multiplier, or any multiplier is borne, or the programme fails; and where
    joints crush, for which `methods.numerics.stress_blocks` has it.
    """
    if assembly.crushes:
        return None
    if assembly.n_interfaces == 0 or not (np.any(assembly.dead[assembly.free]) and assembly.has_live_load):
        return None
    vertex, unit = _vertex_of_forces(assembly, assembly.dead, assembly.live)
    if vertex is None:
        return None
    forces = assembly.law.in_units(unit).within(vertex.value[:-1].reshape(-1, 3)) * unit
    motion = np.zeros((assembly.n_blocks, 3))
    motion[assembly.free] = (-vertex.dual[: 3 * assembly.n_free] * assembly.velocity_units()).reshape(-1, 3)
    return float(vertex.value[-1]) * assembly.load_unit, forces, motion


def _vertex_of_forces(
    assembly: Assembly, load: FloatArray, live: FloatArray | None = None
) -> tuple[Vertex | None, float]:
    """A vertex of the contact forces within yield that balance a load (n, 3), None without any; the unit of force.

    With a live load (n, 3) its greatest multiplier, in `Assembly.load_unit`, is the last column, and it bears a cost
    that makes the speeds of the dual mechanism far greater than what HiGHS rounds off.
    """
    from methods.numerics.linear_programme import INFINITY, Programme  # HiGHS, which few answers need

    column = assembly.velocity_units()
    own = load[assembly.free].ravel() * column
    unit = float(abs(own).sum()) / max(assembly.n_free, 1)
    m = assembly.n_interfaces
    statics = (assembly.kinematic_matrix @ sp.diags(column)).T
    law, cost = assembly.law.in_units(unit), np.zeros(3 * m)
    lower = np.column_stack([law.least_normal, np.full(m, -INFINITY)]).ravel()
    limits = least_shear_slacks(law)
    matrix = sp.csc_matrix(sp.vstack([sp.csc_matrix(statics), shear_limits(law)]))
    if live is not None:
        acting = live[assembly.free].ravel() * column * (assembly.load_unit / unit)
        matrix = sp.csc_matrix(sp.hstack([matrix, sp.csc_matrix(np.append(acting, np.zeros(2 * m))[:, None])]))
        lower, cost = np.append(lower, -INFINITY), np.append(cost, -COST * assembly.n_free)
    programme = Programme(
        matrix,
        cost,
        (lower, np.full(len(lower), INFINITY)),
        (np.append(-own / unit, limits), np.append(-own / unit, np.full(2 * m, INFINITY))),
    )
    status, _, _ = programme.run()
    vertex = programme.vertex(rows_of_blocks(assembly.n_free, m)) if status == "optimal" else None
    return (vertex if vertex is not None and vertex.optimal else None), unit


def dilatant_mechanism(
    assembly: Assembly,
    load: FloatArray,
    about: FloatArray | None = None,
    within: float = 1.0,
    exact: bool = False,
) -> FloatArray | None:
    """A mechanism (n, 3) of dilatant flow on which a load does positive work, so that no equilibrium exists under it.

    It is that of the greatest work near `about`, less what cohesion, tensile strength and bars take; None where that is
    `_LEAST_WORK` or less, or where the programme fails: exactly no work would mean an equilibrium (Farkas' lemma), but
    the programme holds to its tolerances only. None too where joints crush.

    Args:
        assembly: the wall.
        load: (n, 3) generalised loads on the blocks [force, force, moment].
        about: (n, 3) velocities [length, length, radian], or None for rest.
        within: largest difference from `about` of a speed, or of a rotation times the length scale.
        exact: ask for a vertex to rounding, whose work may be as small as `_LEAST_EXACT_WORK`.
    """
    from methods.numerics.linear_programme import INFINITY, Programme  # HiGHS, which few answers need

    if assembly.crushes:
        return None
    column = assembly.velocity_units()
    pull = load[assembly.free].ravel() * column / assembly.force_scale
    centre = np.zeros(len(pull)) if about is None else about[assembly.free].ravel() / column
    strains = (assembly.kinematic_matrix @ sp.diags(column)).tocsr()
    rows, most, taken = _flow_limits(assembly, strains) if assembly.strong else _dry_flow_limits(assembly, strains)
    slips = np.zeros(rows.shape[1] - len(pull))
    gain = np.append(pull, slips) - taken
    programme = Programme(
        sp.csc_matrix(rows),
        -gain,
        (np.append(centre - within, slips), np.append(centre + within, slips + INFINITY)),
        (np.zeros(rows.shape[0]), most),
    )
    status, motion, _ = programme.run()
    if status != "optimal":
        return None
    if exact:
        vertex = programme.vertex()
        if vertex is None or not vertex.feasible:
            return None
        motion = vertex.value
    if not gain @ motion > (_LEAST_EXACT_WORK if exact else _LEAST_WORK):
        return None
    motion = motion[: len(pull)]
    mechanism = np.zeros((assembly.n_blocks, 3))
    mechanism[assembly.free] = (motion * column).reshape(-1, 3)
    return mechanism


def _borne_forces(assembly: Assembly, load: FloatArray) -> FloatArray | None:
    """Contact forces (m, 3) within yield in equilibrium with a load (n, 3); None if there are none.

    No forces are within yield, which is convex: so those of the greatest multiple of the load, if it is one or more,
    divided by it.
    """
    found = greatest_by_chords(assembly, np.zeros_like(load), load, 2.0)
    if found.forces is None or not found.multiplier >= 1.0:
        return None
    return found.forces / found.multiplier


def _dry_flow_limits(assembly: Assembly, strains: sp.csr_matrix) -> tuple[sp.csr_matrix, FloatArray, FloatArray]:
    """Rows of dilatant flow of velocities (3n,) where joints are dry, their upper bounds, and what joints take: none.

    Every end opens by friction times the slip or more. The lower bounds are zero.
    """
    slip = sp.diags(assembly.friction) @ strains[2::3]
    rows = sp.vstack([strains[end::3] + sign * slip for end in (0, 1) for sign in (1.0, -1.0)])
    return sp.csr_matrix(rows), np.full(rows.shape[0], np.inf), np.zeros(strains.shape[1])


def _flow_limits(assembly: Assembly, strains: sp.csr_matrix) -> tuple[sp.csr_matrix, FloatArray, FloatArray]:
    """The same of velocities (3n,) and slips (2m,) of both signs where joints have strength, and the power they take.

    With the rates g = (o1 - mu (g3 + g4), o2 - mu (g3 + g4), g3, g4) of associated flow, q3 = g3 - g4, it is s0 . g.
    """
    m, unit = assembly.n_interfaces, assembly.force_scale
    friction, own = sp.diags(assembly.friction), sp.identity(m, format="csr")
    lift, none = sp.hstack([friction, friction]), np.zeros(m)
    rows = sp.vstack([*(sp.hstack([strains[end::3], -lift]) for end in (0, 1)), sp.hstack([strains[2::3], -own, own])])
    constant = assembly.law.constant / unit
    slips = constant[:, 2:] - (assembly.friction * constant[:, :2].sum(axis=1))[:, None]
    taken = sum(strains[end::3].T @ constant[:, end] for end in (0, 1))
    return (
        sp.csr_matrix(rows),
        np.concatenate([np.full(2 * m, np.inf), none]),
        np.concatenate([taken, slips[:, 0], slips[:, 1]]),
    )
