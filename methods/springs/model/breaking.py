"""Brittle joints of the gap springs: when one has reached its strength, and the wall once it has broken.

A joint breaks as a whole. Its blocks are rigid: when it opens at one end it turns about the other, so that all of it
has parted but an edge without area; when it slips, all of it does. What is left is the dry joint, whose springs bear
what compression and shear the joint bore before, as far as friction allows. The rest of the force is released.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import BoolArray, FloatArray, IntArray
from methods.springs.model.gap_law import gap_forces
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import WallModel, build_model


def joints_at_strength(
    model: WallModel, opening: FloatArray, trial: FloatArray, state: IntArray, within: float
) -> IntArray:
    """The brittle joints (k,) that have reached their tensile strength at an end, or their shear strength one way.

    Args:
        model: the wall.
        opening, trial: (P,) gaps g and trial shears of the gap points; state: (P,) their states.
        within: dimensionless force up to which a joint is at its strength.
    """
    assembly = model.assembly
    if not assembly.breaks:
        return np.empty(0, dtype=np.int64)
    normal, shear = np.empty_like(opening), np.empty_like(opening)
    gap_forces(opening, trial, model.kn, model.mu, model.lift, state, normal, shear)
    slacks = assembly.law.slacks(model.end_forces(normal, shear)) / model.force
    opens, slips = slacks[:, :2].min(axis=1) <= within, slacks[:, 2:].min(axis=1) <= within
    has_shear_strength = slacks[:, 2:].max(axis=1) > within
    return np.flatnonzero(assembly.brittle & (opens | (slips & has_shear_strength)))


def broken_model(
    model: WallModel, broken: BoolArray, u: FloatArray, history: FloatArray, state: IntArray, settings: GapSettings
) -> WallModel:
    """The wall whose joints `broken` (m,) have just lost their strength, with the friction history that goes on.

    Its displacements are those of before. Springs of other joints carry what they did. Those of a broken joint carry
    its compression, and its shear in proportion to that; where friction does not bear so much they slip.

    Args:
        model: the wall before; u: (N,) displacements; history, state: (P,) of its gap points.
        broken: (m,) joints that break now.
        settings: of the model.
    """
    after = build_model(model.assembly.with_broken(broken), settings)
    m, contacts = model.assembly.n_interfaces, model.n_contacts
    normal, shear = model.forces(u, history, state)
    borne = -model.end_forces(normal, shear)[:, 2] / model.force
    opening, slip = after.strains(u)
    pressed = np.maximum(-after.kn * opening, 0.0)[:contacts]
    interface = after.interface[:contacts]
    total = np.bincount(interface, pressed, m)
    share = pressed / np.where(total > 0.0, total, 1.0)[interface]
    own = np.where(broken[interface], borne[interface] * share - (after.kt * slip)[:contacts], history[:contacts])
    glued = history[contacts:][~broken[model.cohesive]]
    return replace(after, history=np.concatenate([own, glued]), options=model.options, deadline=model.deadline)
