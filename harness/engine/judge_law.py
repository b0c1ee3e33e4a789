"""The law of joints as the judge reads it, written apart from that of the methods (`harness.model.joint_law`).

Joints bear friction mu (n1 + n2), cohesion c A in shear and T/2 of tension at each end. A slip lifts both ends by the
dilatancy, which is the friction for associated flow. What opens beyond that lift, and what slips, takes the work of
cohesion and tensile strength; joints with a compressive strength bear what their stress block does.
Sources: Coulomb (1776); Drucker (1954); Baggio and Trovalusci (1995); Orduna and Lourenco (2003).
"""

from __future__ import annotations

import numpy as np

from harness.engine.crushing import block_power
from harness.model.assembly import Assembly, FloatArray


def borne_by_friction(friction: FloatArray, compression: FloatArray) -> FloatArray:
    """(m,) shear that friction (m,) bears at compressions (m,) [force]."""
    return np.asarray(friction * compression)


def slacks(assembly: Assembly, forces: FloatArray) -> FloatArray:
    """(m, 4) what forces (m, 3) leave of the tension at both ends and of the shear both ways, negative beyond yield."""
    normal, shear = forces[:, :2], forces[:, 2]
    borne = borne_by_friction(assembly.friction, normal.sum(axis=1))
    tension, cohesion = _own_strength(assembly)
    return np.column_stack([normal + tension, borne + shear + cohesion[:, 0], borne - shear + cohesion[:, 1]])


def _own_strength(assembly: Assembly) -> tuple[FloatArray, FloatArray]:
    """(m, 2) tension T/2 that each end bears, and (m, 2) cohesion c A against negative and against positive shear."""
    return assembly.constant[:, :2], assembly.constant[:, 2:]


def _lift(assembly: Assembly, slip: FloatArray, flow: str = "associated") -> FloatArray:
    """(m,) opening of both ends by slips (m,): "associated", of the friction; else of the dilatancy of the wall."""
    return np.asarray((assembly.friction if flow == "associated" else assembly.dilatancy) * abs(slip))


def beyond_lift(assembly: Assembly, opening: FloatArray, slip: FloatArray, flow: str = "associated") -> FloatArray:
    """(m, 2) openings of the ends beyond the `_lift` of the slips (m,); negative where they close below it."""
    return np.asarray(opening - _lift(assembly, slip, flow)[:, None])


def dissipated_by_friction(assembly: Assembly, forces: FloatArray, slip: FloatArray, flow: str = "associated") -> float:
    """Power that friction takes on slips (m,) under forces (m, 3), less what the lift gives back [force x velocity]."""
    compression = forces[:, :2].sum(axis=1)
    borne = borne_by_friction(assembly.friction, compression)
    return float((borne * abs(slip) - compression * _lift(assembly, slip, flow)).sum())


def dissipated_by_strength(assembly: Assembly, opening: FloatArray, slip: FloatArray) -> float:
    """Power that tensile strength, cohesion and compressive strength take [force x velocity].

    Args:
        assembly: the wall.
        opening: (m, 2) openings of the ends beyond what the flow lifts; closings count as none but in joints that
            crush.
        slip: (m,) slips.
    """
    tension, cohesion = _own_strength(assembly)
    ways, crushed = np.maximum(np.column_stack([slip, -slip]), 0.0), 0.0
    if assembly.crushes:
        tension = np.where(np.isfinite(assembly.crushing)[:, None], 0.0, tension)
        crushed = float(block_power(assembly, opening).sum())
    return float((tension * np.maximum(opening, 0.0)).sum() + (cohesion * ways).sum()) + crushed
