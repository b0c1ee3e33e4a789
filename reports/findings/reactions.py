"""What supports bear: the sum of the contact forces on each, and whether they balance the loads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from harness.model.assembly import Assembly, FloatArray
from reports.geometry import shapes


@dataclass(frozen=True)
class Reaction:
    """The force that the wall puts on one support.

    Attributes:
        support: id of the fixed block.
        force: (x, y) on the support [force].
        moment: about the origin [force length].
        x: where the line of action meets the level of the support's highest contact [length]; None if it is level.
    """

    support: str
    force: tuple[float, float]
    moment: float
    x: float | None


def reactions(assembly: Assembly, forces: FloatArray) -> list[Reaction]:
    """The force on each support that touches the wall.

    Args:
        assembly: the wall.
        forces: contact forces (m, 3).
    """
    found = shapes.thrusts(assembly, forces, smallest=0.0)
    listed = []
    for block in np.flatnonzero(assembly.fixed):
        on_b, on_a = assembly.block_b[found.interface] == block, assembly.block_a[found.interface] == block
        chosen = np.flatnonzero(on_a | on_b)
        if not len(chosen):
            continue
        vectors = np.where(on_b[chosen][:, None], 1.0, -1.0) * found.force[chosen]
        points = found.point[chosen]
        force = vectors.sum(axis=0)
        moment = float((points[:, 0] * vectors[:, 1] - points[:, 1] * vectors[:, 0]).sum())
        level = float(points[:, 1].max())
        steep = abs(float(force[1])) > 1e-9 * float(np.hypot(*force))
        x = (moment + level * float(force[0])) / float(force[1]) if steep else None
        listed.append(Reaction(assembly.block_ids[block], (float(force[0]), float(force[1])), moment, x))
    return listed


def out_of_balance(assembly: Assembly, listed: list[Reaction], multiplier: float) -> float:
    """Largest part of the loads on free blocks that the reactions do not take, relative to the loads."""
    loads = (assembly.dead + multiplier * assembly.live)[assembly.free]
    applied = loads[:, :2].sum(axis=0)
    taken = np.array([reaction.force for reaction in listed]).reshape(-1, 2).sum(axis=0)
    return float(np.linalg.norm(taken - applied) / max(float(np.linalg.norm(loads[:, :2], axis=1).sum()), 1e-300))
