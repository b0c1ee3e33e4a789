"""Whether a measured field of velocities can be a motion of the wall, by arithmetic of its own.

A method that measures (flow "approximate") proves its multiplier by forces at rest; its field of velocities is what
pictures, joint states and comparisons of mechanisms are made of. It must obey the law of the joints: rigid blocks
on supports at rest do not penetrate each other; and where the contact forces of the motion itself are given
(`details["moving_forces"]`, (m, 3)), a contact that opens carries none of them, and a joint slips only where friction
is at its limit, against it; strength
counts as force. The forces at rest below are not those: they change before a wall moves.

All are relative: velocities to the fastest vertex of the component, forces to the loads and contact forces on the
lighter of the two blocks. A force times nothing and a velocity under no force count for nothing, so of each force and
velocity the smaller counts.

motion_supports         fastest vertex of a fixed block
motion_interpenetration closing velocity at a contact point
motion_opening          opening of a contact point that carries force: min(force, velocity)
motion_crushing         end of a joint that crushes whose force is not that of the stresses on its motion:
                        min(difference, velocity); without forces such a joint counts as one that does not crush
motion_sliding          slip of a joint whose friction is not at its limit against it: min(slack, velocity)
motion_against_loads    power that the loads lose, to what they would have if nothing cancelled: only they drive a wall

Source: the conditions of Signorini and Coulomb in velocities; J. J. Moreau, Unilateral contact and dry friction in
finite freedom dynamics, 1988.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from harness.engine.crushing import block_forces
from harness.engine.judge_law import beyond_lift, slacks
from harness.engine.measures import Measures, between
from harness.engine.residuals import moving_parts, power
from harness.model.assembly import Assembly, FloatArray
from harness.model.details import MOVING_FORCES, AnswerDetails
from harness.model.limit import gross_power
from harness.model.result import relative_velocities

TOLERANCE = 0.02
"""Of a field with the forces of the motion: it is a mean over time steps, they are those of the last, and contacts
chatter in between. A block that rocks with its rotation wrong by a quarter exceeds it."""
TOLERANCE_ALONE = 0.1
"""Of a field without: it may stand for a displacement of a quarter of a block, in which contacts of blocks that
turn and slide seem to close by the product of both."""

_NOISE = 1e-4
"""Speed of a component, beside the fastest of the wall, up to which its measured motion is the noise of rest."""


class _NotOfThisWall(ValueError):
    """The forces of a motion are not three finite numbers an interface."""


def motion_faults(
    assembly: Assembly, mechanism: FloatArray, multiplier: float, details: dict[str, Any]
) -> tuple[dict[str, float], str]:
    """Residuals of a measured motion by name, and what of them is too large in words; empty where nothing is.

    Args:
        assembly: the wall.
        mechanism: (n, 3) velocities (ux, uy, omega) of the blocks [length, length, radian] at any scale.
        multiplier: of the live load under which it moves.
        details: of the answer, which may hold the contact forces of the motion.
    """
    given = AnswerDetails(details).moving_forces
    try:
        forces = None if given is None else _forces(assembly, given)
    except _NotOfThisWall as error:
        return {}, str(error)
    if not mechanism.any():
        return {}, "Its measured motion moves no block."
    residuals = motion_residuals(assembly, mechanism, multiplier, forces)
    tolerance = TOLERANCE_ALONE if forces is None else TOLERANCE
    failed = [f"{name} {value:.3g}" for name, value in residuals.items() if not value <= tolerance]
    if not failed:
        return residuals, ""
    return residuals, f"Its measured motion does not fit this wall within {tolerance:g}: {', '.join(failed)}."


def _forces(assembly: Assembly, given: Any) -> FloatArray:
    """The forces of a motion as an array (m, 3).

    Raises:
        _NotOfThisWall: they are no such array.
    """
    count = assembly.n_interfaces
    try:
        forces = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        forces = np.empty(0)
    if forces.shape != (count, 3) or not np.isfinite(forces).all():
        raise _NotOfThisWall(f"`{MOVING_FORCES}` are not {count} finite triples.")
    return forces


def motion_residuals(
    assembly: Assembly, mechanism: FloatArray, multiplier: float, forces: FloatArray | None
) -> dict[str, float]:
    """The residuals of a measured motion, see this module's docstring.

    Args:
        assembly: the wall; mechanism, multiplier: as for `motion_faults`.
        forces: (m, 3) contact forces (n1, n2, s) measured with the motion [force], or None.
    """
    supports, parts = moving_parts(assembly, mechanism, _NOISE)
    loaded = replace(assembly, dead=assembly.dead + multiplier * assembly.live)
    gross = gross_power(loaded, mechanism)
    lost = max(0.0, -power(loaded.dead, mechanism)) / gross if gross > 0.0 else 0.0
    residuals = {"motion_supports": supports, "motion_interpenetration": 0.0, "motion_against_loads": lost}
    scale = None if forces is None else between(assembly, Measures.of(assembly, forces, multiplier).acting)
    for component, motion in parts:
        part, interfaces = component.assembly, component.interfaces
        opening, slip = relative_velocities(part, motion)
        opening = beyond_lift(part, opening, slip, "non-associated")
        closing = -opening if forces is None else -opening[np.isinf(part.crushing)]
        found = {"motion_interpenetration": max(0.0, float(closing.max(initial=0.0)))}
        if forces is not None and scale is not None:
            own = scale[interfaces, None]
            found |= _under_force(part, slacks(part, forces[interfaces]) / own, opening, slip)
            if part.crushes:
                found |= _on_strips(part, forces[interfaces], own, opening)
        for name, value in found.items():
            residuals[name] = max(residuals.get(name, 0.0), value)
    return residuals


def _under_force(assembly: Assembly, slack: FloatArray, opening: FloatArray, slip: FloatArray) -> dict[str, float]:
    """What opens under force and what slips within its strength.

    Args:
        assembly: the wall; slack: (m, 4) yield slacks, relative; opening: (m, 2) and slip: (m,) velocities.
    """
    opposing = np.where(slip > 0.0, slack[:, 2], slack[:, 3])  # slip > 0 goes with s = -mu (n1 + n2) - c A
    pressed = np.where(np.isinf(assembly.crushing)[:, None], abs(slack[:, :2]), 0.0)
    return {
        "motion_opening": float(np.minimum(pressed, np.maximum(opening, 0.0)).max(initial=0.0)),
        "motion_sliding": float(np.minimum(abs(opposing), abs(slip)).max(initial=0.0)),
    }


def _on_strips(assembly: Assembly, forces: FloatArray, scale: FloatArray, opening: FloatArray) -> dict[str, float]:
    """What moves in joints that crush under forces (m, 3) which are not those of the stresses on openings (m, 2)."""
    crushes = np.isfinite(assembly.crushing)
    apart = abs(forces[:, :2] - block_forces(assembly, opening)).max(axis=1) / scale[:, 0]
    moves = abs(opening).max(axis=1)
    return {"motion_crushing": float(np.minimum(apart, moves)[crushes].max(initial=0.0))}
