"""Blocks of a wall and the joints between them, before anything loads them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from harness.model import geometry
from harness.model.assembly import BoolArray, FloatArray, IntArray
from harness.model.blocks import polygons_of, support_faults, weight_of
from harness.model.errors import of_each, raise_faults
from harness.model.interfaces import Joints, check_held, check_single, faces_of, find_joints, limits_of, normals_of
from harness.model.wall import Block, Detection, Wall


class NamesBlocks(Protocol):
    """Whatever acts on blocks by their names or by a group: a body force, a pressure, a fill, a settlement."""

    @property
    def blocks(self) -> list[str] | None:
        """Ids of blocks."""

    @property
    def group(self) -> str | None:
        """A group of blocks."""


@dataclass(frozen=True, eq=False)
class Laid:
    """Blocks of a wall and the joints between them: what is the same under all of its loads.

    Attributes:
        blocks: all n of it; index: their numbers by id; polygons, fixed, weight, centroids: theirs.
        size: typical block size [length].
        joints: its m interfaces; block_a, block_b, face1, face2, normal: theirs, as of `Assembly`.
    """

    blocks: list[Block]
    index: dict[str, int]
    polygons: tuple[FloatArray, ...]
    fixed: BoolArray
    weight: FloatArray
    centroids: FloatArray
    size: float
    joints: Joints
    block_a: IntArray
    block_b: IntArray
    face1: FloatArray
    face2: FloatArray
    normal: FloatArray

    @cached_property
    def _groups(self) -> dict[str, IntArray]:
        """Numbers of the blocks of every group."""
        groups: dict[str, list[int]] = {}
        for k, block in enumerate(self.blocks):
            for group in block.groups:
                groups.setdefault(group, []).append(k)
        return {group: np.array(members) for group, members in groups.items()}

    def named(self, given: NamesBlocks) -> IntArray | None:
        """Numbers of the blocks that a load or a settlement names, by themselves or by a group; None: it names none."""
        if given.blocks is None and given.group is None:
            return None
        by_name = np.array([self.index[name] for name in given.blocks or ()], dtype=np.int64)
        return np.union1d(by_name, self._groups.get(given.group or "", by_name))


def lay(wall: Wall, blocks: list[Block], joints: Joints | None = None) -> Laid:
    """The blocks of a wall, as `blocks_of_wall` gives them, with their joints.

    Args:
        wall: as described; blocks: of it.
        joints: of blocks that are known not to overlap, where they were found before.

    Raises:
        InputError: naming the block or the interface that is wrong.
    """
    names = tuple(block.id for block in blocks)
    index = {block_id: k for k, block_id in enumerate(names)}
    polygons = tuple(polygons_of(blocks))
    fixed = np.array([block.fixed for block in blocks], dtype=bool)
    raise_faults(support_faults(fixed))
    weight = np.array(of_each(lambda block: weight_of(block, wall), blocks))
    centroids = geometry.centroids(polygons)
    shapes = geometry.shapes_of(polygons)
    size = geometry.typical_size(shapes[~fixed])
    found = joints or find_joints(wall.interfaces, polygons, names, fixed, shapes, size)
    block_a, block_b, face1, face2 = faces_of(found, index, fixed)
    check_held(names, fixed, block_a, block_b, found)
    normal = normals_of(
        polygons, centroids, block_a, block_b, face1, face2, found.interfaces, trusted=found.trusted, size=size
    )
    limits = limits_of(Detection() if isinstance(wall.interfaces, list) else wall.interfaces, size)
    check_single(names, fixed, (block_a, block_b, face1, face2), max(limits.gap, limits.overlap))
    return Laid(blocks, index, polygons, fixed, weight, centroids, size, found, block_a, block_b, face1, face2, normal)
