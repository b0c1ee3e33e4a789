"""Imperfect contacts: seeded defects of block faces that move contact points, and the contacts that stay closed.

The geometry of the blocks is left alone; what changes is where faces touch. The result is an assembly again, so every
method can analyse the imperfect wall. Sources: C. Baggio, P. Trovalusci (1995) blame defects of planarity for an
experimental load 20 % below the computed one, and ask for the contacts of the imperfect structure to be found first.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from harness.model.assembly import Assembly, BoolArray, FloatArray
from methods.de.settings import Faces


def block_height(assembly: Assembly) -> float:
    """Median height of the free blocks [length]: the unit of the size of a defect."""
    heights = [float(np.ptp(assembly.polygons[i][:, 1])) for i in assembly.free]
    return float(np.median(heights))


def affected(assembly: Assembly, faces: Faces) -> BoolArray:
    """(m,) interfaces whose faces are imperfect: by the name of their joint; other names count as beds."""
    head = np.array([name == "head" for name in assembly.joint], dtype=np.bool_)
    return {"beds": ~head, "heads": head, "both": np.ones_like(head)}[faces]


def cut_corners(assembly: Assembly, size: float, faces: Faces = "both", seed: int = 0) -> Assembly:
    """Cut every corner of every free block back along its faces by U(0, size x block height).

    An end of an interface moves inward by the cut of the corner it lies on, by the larger one if corners of both
    blocks meet there, and stays if it lies on no corner. A contact never shrinks below a hundredth of its length.

    Args:
        assembly: the perfect wall.
        size: greatest cut as a part of the block height; 0 returns the same contact points.
        faces: which joints are imperfect.
        seed: seed of the cuts; each corner has one cut for each of its two faces.
    """
    generator = np.random.default_rng(seed)
    height = block_height(assembly)
    cuts = [generator.uniform(0.0, size * height, (len(polygon), 2)) for polygon in assembly.polygons]
    move = np.zeros((assembly.n_interfaces, 2))
    for p in np.flatnonzero(affected(assembly, faces)):
        for block in (int(assembly.block_a[p]), int(assembly.block_b[p])):
            if assembly.fixed[block]:
                continue
            for k, end in enumerate((assembly.face1[p], assembly.face2[p])):
                move[p, k] = max(move[p, k], corner_cut(assembly, block, end, assembly.tangent[p], cuts[block]))
    return set_in(assembly, move)


def corner_cut(assembly: Assembly, block: int, end: FloatArray, tangent: FloatArray, cuts: FloatArray) -> float:
    """Cut (a length) at the corner of this block on which `end` lies, along the face with this tangent; 0 if none."""
    corners = assembly.polygons[block]
    distance = np.linalg.norm(corners - end, axis=1)
    k = int(np.argmin(distance))
    if distance[k] > 1e-6 * assembly.length_scale:
        return 0.0
    onward = corners[(k + 1) % len(corners)] - corners[k]
    along = abs(float(onward @ tangent)) > 0.7 * float(np.linalg.norm(onward))
    return float(cuts[k, 0 if along else 1])


def crown(assembly: Assembly, part: float, faces: Faces = "beds") -> Assembly:
    """Crowned faces: the contact points of these joints move inward by `part` of the length from either end.

    Raises:
        ValueError: `part` is not from 0 to below a half.
    """
    if not 0.0 <= part < 0.5:
        raise ValueError(f"a crown moves contact points by 0 to below 0.5 of the length, not by {part}")
    move = np.where(affected(assembly, faces), part * assembly.length, 0.0)
    return set_in(assembly, np.column_stack([move, move]))


def set_in(assembly: Assembly, move: FloatArray) -> Assembly:
    """Move contact points inward by (m, 2) lengths, leaving at least a hundredth of each contact."""
    total = move.sum(axis=1)
    allowed = np.minimum(1.0, 0.99 * assembly.length / np.maximum(total, 1e-300))
    inward = assembly.tangent * allowed[:, None]
    return replace(assembly, end1=assembly.end1 + move[:, :1] * inward, end2=assembly.end2 - move[:, 1:] * inward)


def lose_contacts(assembly: Assembly, chance: float, faces: Faces = "beds", seed: int = 0) -> Assembly:
    """Drop each of these joints with this chance, as where a stone does not touch its neighbour."""
    drawn = np.random.default_rng(seed).uniform(size=assembly.n_interfaces)
    return assembly.with_joints(~(affected(assembly, faces) & (drawn < chance)))


def closed_contacts(assembly: Assembly, forces: FloatArray, threshold: float = 1e-9) -> BoolArray:
    """(m,) interfaces that carry a force (m, 3) above `threshold` of the mean dead load of a block."""
    closed: BoolArray = forces[:, 0] + forces[:, 1] > threshold * assembly.force_scale / assembly.n_free
    return closed
