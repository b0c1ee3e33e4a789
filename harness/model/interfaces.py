"""The interfaces of a wall: found between faces, given, or both; the blocks they hold, and their normals."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from harness.model import geometry
from harness.model.assembly import BoolArray, FloatArray, IntArray
from harness.model.contacts import TIMES, JointLimits, find_contacts
from harness.model.errors import InputError, Spot, first_few
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
