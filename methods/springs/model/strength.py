"""Joints with cohesion and tensile strength as gap springs: a clamped dry joint with a cohesion spring beside it; bars.

With the clamping N' = N + T of a joint of tensile strength T the yield domain |s| <= mu N + c A is that of a dry joint,
|s| <= mu N', and of a shear c A - mu T besides, which no compression changes. So the joint is a dry one under the
constant force T, at each end what this bears of tension, and a tangential spring in parallel that slips at c A - mu T
(the overlay model of Besseling 1958). Both keep their strength however far the joint moves: it is plastic. At collapse
the joint is exactly that of `harness.model.joint_law`; the parts of the stiffness decide only the way there.

A tie or prop is such a spring alone: beyond the prestress its tension goes from 0 at rest to the one end of its range,
where it yields, or stays at the other, where it is slack. Half of the range is what the spring slips at; the middle of
it is constant, as the clamping is.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from harness.model.assembly import FloatArray

if TYPE_CHECKING:
    from methods.springs.model.wall_model import WallModel


def with_strength(model: WallModel, bar_stiffness: FloatArray) -> WallModel:
    """The wall with the cohesion and tensile strength that its assembly gives its joints, and with its ties and props.

    The springs are compressed by the clamping before anything has moved. A cohesion spring is a gap point without
    opening, under a compression that makes its friction what the cohesion bears; it takes the share of the tangential
    stiffness that it has of the shear strength under the mean weight of a block.

    Args:
        model: the wall without strength; bar_stiffness: (m,) dimensionless, of the rows that are bars.
    """
    assembly, m = model.assembly, model.assembly.n_interfaces
    constant, bar = assembly.law.constant / model.force, assembly.is_bar
    tension, uneven = constant[:, 0] + constant[:, 1], constant[:, 1] - constant[:, 0]
    friction, stiffness, tangential = np.zeros(m), np.ones(m), bar_stiffness.copy()
    friction[model.interface] = model.mu
    stiffness[~bar] = np.bincount(model.interface, model.kn, m)[~bar]
    tangential[~bar] = np.bincount(model.interface, model.kt, m)[~bar]
    middle = 0.5 * (constant[:, 2] - constant[:, 3])
    shear = np.maximum(constant[:, 2] - middle - assembly.law.with_friction(friction).by_friction(tension), 0.0)
    joint = np.concatenate([np.flatnonzero((shear > 0.0) & ~bar), np.flatnonzero((shear > 0.0) & bar)])
    own = np.where(bar, 1.0, shear / np.where(shear > 0.0, shear + friction, 1.0))  # under the unit of force
    left = np.where(own < 1.0, 1.0 - own, 1.0)[model.interface]  # with friction of none those springs never stick
    count = len(joint)
    along = model.rows[joint].copy()
    along[:, :2] = 0.0
    arm = model.position - 0.5
    turn = np.ones(m)
    turn[~bar] = np.bincount(model.interface, model.kn * arm**2, m)[~bar]
    clamped = -(tension / stiffness)[model.interface] - (0.5 * uneven / turn)[model.interface] * arm
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
        history=np.concatenate([model.history, 0.0 - middle[joint]]),
        initial_opening=np.concatenate([clamped, -(shear / stiffness)[joint]]),
        middle=np.concatenate([model.middle, middle[joint]]),
        dead=model.dead + _constant_loads(model, tension, uneven, middle),
        cohesive=joint,
    )


def _constant_loads(model: WallModel, tension: FloatArray, uneven: FloatArray, middle: FloatArray) -> FloatArray:
    """(N,) loads of the clamping (m,) at the ends of every joint, and of the middle (m,) of the shear range.

    The second end bears `uneven` (m,) more of the clamping than the first.
    """
    loads = np.zeros(model.n_unknowns)
    ends = model.rows[:, 0] + model.rows[:, 1]
    np.add.at(loads, model.unknown, -0.5 * tension[:, None] * ends)
    if uneven.any():
        np.add.at(loads, model.unknown, -0.5 * uneven[:, None] * (model.rows[:, 1] - model.rows[:, 0]))
    if middle.any():
        np.add.at(loads, model.unknown, -middle[:, None] * model.rows[:, 2])
    return loads
