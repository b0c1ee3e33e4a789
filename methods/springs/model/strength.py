"""Joints with cohesion and tensile strength as gap springs: a clamped dry joint with a cohesion spring beside it.

With the clamping N' = N + T of a joint of tensile strength T the yield domain |s| <= mu N + c A is that of a dry joint,
|s| <= mu N', and of a shear c A - mu T besides, which no compression changes. So the joint is a dry one under the
constant force T, half of it at each end, and a tangential spring in parallel that slips at c A - mu T (the overlay
model of Besseling 1958). Both keep their strength however far the joint moves: it is plastic. At collapse the joint is
exactly that of `harness.model.joint_law`; the parts of the stiffness decide only the way there.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from methods.springs.model.wall_model import WallModel


def with_strength(model: WallModel) -> WallModel:
    """The wall with the cohesion and tensile strength that its assembly gives its joints.

    The springs are compressed by the clamping before anything has moved. A cohesion spring is a gap point without
    opening, under a compression that makes its friction what the cohesion bears; it takes the share of the tangential
    stiffness that it has of the shear strength under the mean weight of a block.
    """
    assembly, m = model.assembly, model.assembly.n_interfaces
    constant = assembly.law.constant / model.force
    tension = 2.0 * constant[:, 0]
    friction = model.mu[np.searchsorted(model.interface, np.arange(m))]
    shear = np.maximum(constant[:, 2] - assembly.law.with_friction(friction).by_friction(tension), 0.0)
    joint = np.flatnonzero(shear)
    stiffness = np.bincount(model.interface, model.kn, m)
    tangential = np.bincount(model.interface, model.kt, m)
    own = shear / (shear + friction)  # the mean weight of a block is the unit of force
    left = np.where(friction > 0.0, 1.0 - own, 1.0)[model.interface]  # without friction those springs never stick
    count = len(joint)
    along = model.rows[joint].copy()
    along[:, :2] = 0.0
    clamped = -(tension / stiffness)[model.interface]
    return replace(
        model,
        unknown=np.concatenate([model.unknown, model.unknown[joint]]),
        rows=np.concatenate([model.rows, along]),
        slot=np.concatenate([model.slot, model.slot[joint]]),
        interface=np.concatenate([model.interface, m + np.arange(count)]),
        position=np.concatenate([model.position, np.zeros(count)]),
        kn=np.concatenate([model.kn, stiffness[joint]]),
        kt=np.concatenate([model.kt * left, (tangential * own)[joint]]),
        mu=np.concatenate([model.mu, np.ones(count)]),
        psi=np.concatenate([model.psi, np.zeros(count)]),
        history=np.zeros(model.n_points + count),
        initial_opening=np.concatenate([clamped, -(shear / stiffness)[joint]]),
        dead=model.dead + _clamping(model, tension),
        cohesive=joint,
    )


def _clamping(model: WallModel, tension: np.ndarray) -> np.ndarray:
    """(N,) loads of the clamping: half the tension (m,) at each end of every joint pulls its two blocks together."""
    loads = np.zeros(model.n_unknowns)
    ends = model.rows[:, 0] + model.rows[:, 1]
    np.add.at(loads, model.unknown, -0.5 * tension[:, None] * ends)
    return loads
