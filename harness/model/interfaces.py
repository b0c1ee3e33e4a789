"""The interfaces of a wall: found between faces, given, or both; the blocks they hold, and their normals."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import shapely

from harness.model import geometry
from harness.model.assembly import BoolArray, FloatArray, IntArray
from harness.model.contacts import TIMES, JointLimits, check_gap, find_contacts
from harness.model.errors import InputError, Spot, first_few, raise_faults
from harness.model.groups import groups_of
from harness.model.plausibility import allowing, span
from harness.model.wall import Detection, Interface

DEFAULT_TOLERANCE = 1e-6
"""Greatest gap and overlap of the faces of a joint, in typical block sizes, where a wall does not say."""
_LEAST_CONTACT = 0.01
"""Least length of a contact, in typical block sizes, where the gap may be larger: 3 mm on a brick of 300."""


Faces = tuple[IntArray, IntArray, FloatArray, FloatArray]
"""Blocks (m,) and (m,), and ends of the faces (m, 2) and (m, 2) [length], of interfaces."""


@dataclass(frozen=True)
class Joints:
    """Interfaces of a wall, the first `trusted` of them found, and what was seen while they were looked for."""

    interfaces: list[Interface]
    trusted: int = 0
    gap: float = 0.0
    corners: IntArray = field(default_factory=lambda: np.empty((0, 2), dtype=np.int64))
    missed: IntArray = field(default_factory=lambda: np.empty((0, 2), dtype=np.int64))
    missed_gap: FloatArray = field(default_factory=lambda: np.empty(0))
    missed_at: FloatArray = field(default_factory=lambda: np.empty((0, 2)))


def limits_of(detection: Detection, size: float) -> JointLimits:
    """What may be the two faces of one joint, for a typical block size [length]."""
    gap = detection.greatest_gap or detection.tolerance or DEFAULT_TOLERANCE * size
    return JointLimits(
        gap=gap,
        overlap=detection.greatest_overlap or detection.tolerance or DEFAULT_TOLERANCE * size,
        angle=math.radians(detection.greatest_angle),
        length=detection.least_contact or min(gap, _LEAST_CONTACT * size),
        sight=detection.sight or max(TIMES * gap, geometry.NEAR * size),
    )


def find_joints(
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


def joints_of(
    detection: Detection,
    polygons: Sequence[FloatArray],
    names: Sequence[str],
    fixed: BoolArray,
    limits: JointLimits,
) -> Joints:
    """The interfaces between blocks as they lie, whether or not they overlap; those given stand at the end."""
    contacts = find_contacts(polygons, fixed, limits)
    said = {frozenset(item.between) for item in detection.given} | {frozenset(pair) for pair in detection.removed}
    interfaces = [
        Interface.model_validate({"between": (names[a], names[b]), "from": tuple(start), "to": tuple(end)})
        for a, b, start, end in zip(
            contacts.block_a.tolist(),
            contacts.block_b.tolist(),
            contacts.start.tolist(),
            contacts.end.tolist(),
            strict=True,
        )
        if frozenset((names[a], names[b])) not in said
    ]
    open_pairs = np.array(
        [frozenset((names[a], names[b])) not in said for a, b in contacts.missed.tolist()], dtype=bool
    )
    return Joints(
        [*interfaces, *detection.given],
        len(interfaces),
        limits.gap,
        contacts.corners,
        contacts.missed[open_pairs],
        contacts.missed_gap[open_pairs],
        contacts.missed_at[open_pairs],
    )


def faces_of(joints: Joints, index: dict[str, int], fixed: np.ndarray) -> Faces:
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


def faults_of_given(joints: Joints, index: dict[str, int], fixed: np.ndarray) -> list[InputError]:
    """Given interfaces that join a block to itself or two fixed ones, or have no length, by their number in the file.

    Those of blocks without an index are left out.
    """
    faults = []
    for number, interface in enumerate(joints.interfaces[joints.trusted :]):
        if not set(interface.between) <= index.keys():
            continue
        a, b = (index[block_id] for block_id in interface.between)
        if a == b:
            wrong = ("a block cannot touch itself", "Name two blocks")
        elif np.linalg.norm(np.subtract(interface.end, interface.start)) == 0.0:
            wrong = ("its two ends coincide", 'Give a segment of some length in "from" and "to"')
        elif fixed[a] and fixed[b]:
            wrong = ("both of its blocks are fixed", "Leave it out: it carries no unknown")
        else:
            continue
        faults.append(InputError(*wrong, f"interfaces[{number}]", spot=Spot(interface.between, interface.start)))
    return faults


def check_single(names: Sequence[str], fixed: BoolArray, laid: Faces, most: float) -> None:
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


def check_held(names: tuple[str, ...], fixed: np.ndarray, block_a: IntArray, block_b: IntArray, joints: Joints) -> None:
    """Refuse blocks that no chain of interfaces joins to a fixed one.

    Raises:
        InputError: naming them, and the faces they look at from a little further off.
    """
    groups = floating_groups(fixed, np.stack([block_a, block_b], axis=1))
    if groups:
        raise floating(names, np.sort(np.concatenate(groups)), joints)


def floating_groups(fixed: BoolArray, pairs: IntArray) -> list[IntArray]:
    """Blocks that no chain of joined pairs (k, 2) leads from to a fixed one, those joined to each other together."""
    component = groups_of(len(fixed), pairs[:, 0], pairs[:, 1])
    return [np.flatnonzero(component == label) for label in np.setdiff1d(component, component[fixed])]


def floating(names: Sequence[str], blocks: IntArray, joints: Joints) -> InputError:
    """What is wrong with blocks of these numbers (k,) that float, and the faces they look at from a little off."""
    listed = [names[k] for k in blocks.tolist()]
    shown = first_few([f'"{name}"' for name in listed], 5)
    at_corner = bool(np.isin(joints.corners, blocks).any())
    near = np.isin(joints.missed, blocks).any(axis=1)
    remedy = "Let faces meet along a length, or raise interfaces.greatest_gap if the drawing has gaps"
    if near.any():
        gaps, unlucky = joints.missed_gap[near], joints.missed[near]
        one, other = (names[k] for k in unlucky[int(np.argmin(gaps))])
        remedy = (
            f'Faces lie opposite each other {span(gaps)} apart, those of "{one}" and "{other}" the nearest, '
            f"and joints are up to {joints.gap:.3g} wide: if they are in contact, write {allowing(gaps.max())}"
        )
    return InputError(
        "no chain of interfaces joins "
        + ("it" if len(listed) == 1 else "them")
        + " to a fixed block: floating"
        + (" (a touch at a corner is no interface)" if at_corner else ""),
        remedy,
        f"block {shown}" if len(listed) == 1 else f"blocks {shown}",
        spot=Spot(tuple(listed)),
    )


def normals_of(
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
