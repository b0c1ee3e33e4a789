"""Blocks of a wall and the joints between them, before anything loads them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import shapely

from harness.model import geometry
from harness.model.assembly import BoolArray, FloatArray, IntArray
from harness.model.blocks import polygons_of, support_faults, weight_of
from harness.model.contacts import check_gap
from harness.model.errors import InputError, Spot, raise_faults, sorted_out
from harness.model.interfaces import Faces, Joints, faults_of_given, floating, floating_groups, joints_of, limits_of
from harness.model.wall import Block, Detection, Interface, Wall


class _NamesBlocks(Protocol):
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

    def named(self, given: _NamesBlocks) -> IntArray | None:
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
    faults, weights = sorted_out(lambda block: weight_of(block, wall), blocks)
    raise_faults(faults)
    weight = np.array(list(weights.values()))
    centroids = geometry.centroids(polygons)
    shapes = geometry.shapes_of(polygons)
    size = geometry.typical_size(shapes[~fixed])
    found = joints or _find_joints(wall.interfaces, polygons, names, fixed, shapes, size)
    block_a, block_b, face1, face2 = _faces_of(found, index, fixed)
    _check_held(names, fixed, block_a, block_b, found)
    normal = _normals_of(
        polygons, centroids, block_a, block_b, face1, face2, found.interfaces, trusted=found.trusted, size=size
    )
    limits = limits_of(Detection() if isinstance(wall.interfaces, list) else wall.interfaces, size)
    _check_single(names, fixed, (block_a, block_b, face1, face2), max(limits.gap, limits.overlap))
    return Laid(blocks, index, polygons, fixed, weight, centroids, size, found, block_a, block_b, face1, face2, normal)


def _find_joints(
    asked: Detection | list[Interface],
    polygons: tuple[FloatArray, ...],
    names: tuple[str, ...],
    fixed: BoolArray,
    shapes: np.ndarray,
    size: float,
) -> Joints:
    """The interfaces that were asked for: found, found and given, or given; `shapes` (n,) are those of the polygons.

    Raises:
        InputError: blocks overlap, or a gap is allowed that is as wide as a block.
    """
    limits = limits_of(Detection() if isinstance(asked, list) else asked, size)
    geometry.check_overlaps(shapes, names, fixed, limits.overlap)
    if isinstance(asked, list):
        return Joints(asked)
    check_gap(shapes, names, limits.gap)
    return joints_of(asked, polygons, names, fixed, limits)


def _faces_of(joints: Joints, index: dict[str, int], fixed: np.ndarray) -> Faces:
    """Blocks and faces of interfaces.

    Raises:
        InputError: one of those given joins a block to itself or two fixed ones, or has no length.
    """
    interfaces = joints.interfaces
    raise_faults(faults_of_given(joints, index, fixed))
    pairs = np.array([[index[block_id] for block_id in interface.between] for interface in interfaces], dtype=np.int64)
    pairs = pairs.reshape(-1, 2)
    starts = np.array([interface.start for interface in interfaces], dtype=float).reshape(-1, 2)
    ends = np.array([interface.end for interface in interfaces], dtype=float).reshape(-1, 2)
    return pairs[:, 0], pairs[:, 1], starts, ends


def _check_single(names: Sequence[str], fixed: BoolArray, laid: Faces, most: float) -> None:
    """Refuse two joints on one stretch of a free block: it would bear the strength of both, which is there once.

    Args:
        names, fixed: of the blocks.
        laid: blocks and ends of the joints.
        most: distance across and common length up to which two joints are beside each other [length].

    Raises:
        InputError: naming the two pairs of blocks, and where.
    """
    block_a, block_b, face1, face2 = laid
    lines = shapely.linestrings(np.stack([face1, face2], axis=1))
    low, high = np.minimum(face1, face2) - most, np.maximum(face1, face2) + most
    i, j = shapely.STRtree(lines).query(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))
    one_of = [(block[i] == other[j]) & ~fixed[block[i]] for block in (block_a, block_b) for other in (block_a, block_b)]
    kept = (i < j) & np.any(one_of, axis=0)
    i, j = i[kept], j[kept]
    length = np.linalg.norm(face2 - face1, axis=1)[i]
    along = (face2[i] - face1[i]) / length[:, None]
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1)
    places = [((end[j] - face1[i]) * along).sum(axis=1) for end in (face1, face2)]
    heights = [abs(((end[j] - face1[i]) * normal).sum(axis=1)) for end in (face1, face2)]
    first, last = np.maximum(np.minimum(*places), 0.0), np.minimum(np.maximum(*places), length)
    twice = np.flatnonzero((np.maximum(*heights) <= most) & (last - first > most))
    if len(twice):
        k = twice[0]
        x, y = (face1[i[k]] + 0.5 * (first[k] + last[k]) * along[k]).tolist()
        pairs = [(names[block_a[m]], names[block_b[m]]) for m in (i[k], j[k])]
        raise InputError(
            f"they lie on each other for a length of {last[k] - first[k]:.3g} and would bear twice there",
            "Let supports meet and not overlap, and list each part of a face in one interface",
            f"the joints of {' and of '.join(f'{a}/{b}' for a, b in pairs)}",
            spot=Spot(tuple(dict.fromkeys([*pairs[0], *pairs[1]])), (x, y)),
        )


def _check_held(
    names: tuple[str, ...], fixed: np.ndarray, block_a: IntArray, block_b: IntArray, joints: Joints
) -> None:
    """Refuse blocks that no chain of interfaces joins to a fixed one.

    Raises:
        InputError: naming them, and the faces they look at from a little further off.
    """
    groups = floating_groups(fixed, np.stack([block_a, block_b], axis=1))
    if groups:
        raise floating(names, np.sort(np.concatenate(groups)), joints)


def _normals_of(
    polygons: tuple[FloatArray, ...],
    centroids: FloatArray,
    block_a: IntArray,
    block_b: IntArray,
    face1: FloatArray,
    face2: FloatArray,
    interfaces: list[Interface],
    *,
    trusted: int,
    size: float,
) -> FloatArray:
    """Unit normals from a into b: those found run counter-clockwise round a, given ones are tested at midpoint."""
    tangent = face2 - face1
    tangent = tangent / np.linalg.norm(tangent, axis=1)[:, None]
    outward = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
    if trusted == len(interfaces):
        return outward
    middle = 0.5 * (face1 + face2)
    step = 1e-3 * np.minimum(np.linalg.norm(face2 - face1, axis=1), size)[:, None] * outward
    shapes = geometry.shapes_of(polygons)
    inside = {
        (side, way): shapely.contains_xy(shapes[block], *(middle + way * step).T)
        for side, block in (("a", block_a), ("b", block_b))
        for way in (1.0, -1.0)
    }
    votes = (
        inside["b", 1.0].astype(int)
        + inside["a", -1.0].astype(int)
        - inside["b", -1.0].astype(int)
        - inside["a", 1.0].astype(int)
    )
    unclear = votes == 0
    across = np.einsum("kd,kd->k", centroids[block_b] - centroids[block_a], outward)
    same_side = unclear & (
        (inside["a", 1.0] & inside["b", 1.0]) | (inside["a", -1.0] & inside["b", -1.0]) | (abs(across) < 1e-9 * size)
    )
    same_side[:trusted] = False
    if same_side.any():
        number = int(np.flatnonzero(same_side)[0])
        raise InputError(
            "its blocks do not lie on opposite sides of the segment",
            'Let "from" and "to" run along the faces that touch',
            f"interfaces[{number - trusted}] between {' and '.join(interfaces[number].between)}",
        )
    sign = np.where(unclear, np.sign(across), np.sign(votes))
    sign[:trusted] = 1.0
    return np.asarray(outward * sign[:, None])
