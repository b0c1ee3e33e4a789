"""A wall becomes its assembly: polygons checked, interfaces found or taken, friction and loads assigned."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from harness.model import geometry
from harness.model.assembly import Assembly, BoolArray, FloatArray, IntArray, polygon_area
from harness.model.contacts import TIMES, JointLimits, check_gap, find_contacts
from harness.model.errors import InputError, first_few, of_each, raise_faults
from harness.model.names import faults_of_wall
from harness.model.pattern import blocks_of, count_of
from harness.model.plausibility import contact_warnings, force_warnings, interface_warnings, near_misses, span
from harness.model.slips import slip_warnings, thickness_of
from harness.model.wall import (
    MOST_BLOCKS,
    Block,
    BodyForce,
    Detection,
    Friction,
    Inset,
    Interface,
    Load,
    Loads,
    PatternBase,
    Wall,
    coefficient_of,
)


@dataclass(frozen=True)
class Built:
    """An assembly with what a person should hear about it.

    Attributes:
        assembly: the numeric view of the wall.
        wall: the explicit form, with every block and interface written out.
        warnings: sentences about contacts at corners, very short interfaces, and points that lie off their block.
    """

    assembly: Assembly
    wall: Wall
    warnings: tuple[str, ...]


def build(wall: Wall, name: str = "wall") -> Built:
    """The assembly of a wall.

    Raises:
        InputError: naming the block, interface or load that is wrong.
    """
    blocks = blocks_of_wall(wall)
    names = tuple(block.id for block in blocks)
    index = {block_id: k for k, block_id in enumerate(names)}
    polygons = tuple(of_each(polygon_of, blocks))
    fixed = np.array([block.fixed for block in blocks], dtype=bool)
    if not fixed.any():
        raise InputError("no block is fixed", 'Mark the supports with "fixed": true', "blocks")
    if fixed.all():
        raise InputError("every block is fixed", "Leave at least one block free to move", "blocks")
    weight = np.array(of_each(lambda block: _weight(block, wall), blocks))
    centroids = np.array([geometry.centroid(polygon) for polygon in polygons])

    size = geometry.typical_size([polygon for polygon, still in zip(polygons, fixed, strict=True) if not still])
    joints_found = _found(wall.interfaces, polygons, names, fixed, size)
    interfaces = joints_found.interfaces
    block_a, block_b, face1, face2 = _faces(interfaces, index, fixed)
    _check_held(names, fixed, block_a, block_b, joints_found)
    trusted = joints_found.trusted
    normal = _normals(polygons, centroids, block_a, block_b, face1, face2, interfaces, trusted=trusted, size=size)
    joints = tuple(
        interface.joint or _inclination(start, end)
        for interface, start, end in zip(interfaces, face1, face2, strict=True)
    )
    friction = np.array(
        [_friction(wall, interface, joint, blocks, index) for interface, joint in zip(interfaces, joints, strict=True)]
    )
    end1, end2 = _set_in(interfaces, wall.contact_inset, face1, face2)
    assembly = Assembly(
        name=name,
        block_ids=names,
        polygons=polygons,
        centroid=centroids,
        weight=weight,
        fixed=fixed,
        block_a=block_a,
        block_b=block_b,
        end1=end1,
        end2=end2,
        face1=face1,
        face2=face2,
        normal=normal,
        friction=friction,
        joint=joints,
        dead=_dead_load(wall.loads, blocks, index, weight, centroids, fixed),
        live=_load(wall.loads.live or Load(), "loads.live", blocks, index, weight, centroids, fixed),
    )
    if wall.loads.live is not None and not assembly.has_live_load:
        raise InputError(
            "the live load puts no force on any free block",
            "Load a block, or leave loads.live out to ask only whether the wall stands",
            "loads.live",
        )
    if not math.isfinite(assembly.force_scale):
        raise InputError("its loads are too large to compute with", "Check the units", "loads")
    warnings = [
        *contact_warnings(assembly, joints_found.corners, size),
        *near_misses(names, joints_found.missed, joints_found.missed_gap, joints_found.gap),
        *force_warnings(assembly, wall.loads, size),
        *slip_warnings(wall, blocks, assembly),
    ]
    if trusted < len(interfaces):
        warnings += interface_warnings(assembly, size, trusted)
    return Built(assembly, _explicit(wall, blocks, weight, interfaces, joints, friction), tuple(warnings))


def typical_block_size(wall: Wall) -> float:
    """The length that tolerances are measured by: the median over the free blocks of the square root of the area.

    Raises:
        InputError: a block is no polygon.
    """
    return geometry.typical_size(of_each(polygon_of, [block for block in blocks_of_wall(wall) if not block.fixed]))


@dataclass(frozen=True)
class _Joints:
    """Interfaces of a wall, the first `trusted` of them found, and what was seen while they were looked for."""

    interfaces: list[Interface]
    trusted: int = 0
    gap: float = 0.0
    corners: IntArray = field(default_factory=lambda: np.empty((0, 2), dtype=np.int64))
    missed: IntArray = field(default_factory=lambda: np.empty((0, 2), dtype=np.int64))
    missed_gap: FloatArray = field(default_factory=lambda: np.empty(0))


def _found(
    asked: Detection | list[Interface],
    polygons: tuple[FloatArray, ...],
    names: tuple[str, ...],
    fixed: BoolArray,
    size: float,
) -> _Joints:
    """The interfaces that were asked for: found, found and given, or given.

    Raises:
        InputError: blocks overlap, or a gap is allowed that is as wide as a block.
    """
    detection = Detection() if isinstance(asked, list) else asked
    gap, overlap = detection.gap(size), detection.overlap(size)
    geometry.check_overlaps(polygons, names, fixed, overlap)
    if isinstance(asked, list):
        return _Joints(asked)
    check_gap(polygons, names, gap)
    sight = max(TIMES * gap, geometry.NEAR * size)
    limits = JointLimits(gap, overlap, math.radians(detection.greatest_angle), detection.contact(size), sight)
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
    return _Joints(
        [*interfaces, *detection.given],
        len(interfaces),
        gap,
        contacts.corners,
        contacts.missed[open_pairs],
        contacts.missed_gap[open_pairs],
    )


def blocks_of_wall(wall: Wall) -> list[Block]:
    """All blocks of a wall, those of its patterns first.

    Raises:
        InputError: there are none, too many, or names are wrong.
    """
    patterns: list[PatternBase] = (
        [] if wall.pattern is None else list(wall.pattern) if isinstance(wall.pattern, list) else [wall.pattern]
    )
    expected = sum(count_of(pattern) for pattern in patterns) + len(wall.blocks)
    if expected > MOST_BLOCKS:
        raise InputError(
            f"the wall has {expected:,} blocks, and at most {MOST_BLOCKS:,} are built",
            "Analyse a part of it",
            "pattern" if patterns else "blocks",
        )
    blocks = [block for pattern in patterns for block in blocks_of(pattern)] + list(wall.blocks)
    if not blocks:
        raise InputError("the wall has no blocks", 'Give "blocks" or a "pattern"', "blocks")
    raise_faults(faults_of_wall(wall, blocks))
    return blocks


def polygon_of(block: Block) -> FloatArray:
    """The outline (k, 2) of a block, counter-clockwise [length].

    Raises:
        InputError: it is no polygon.
    """
    polygon = np.array(block.polygon, dtype=float)
    geometry.check_polygon(polygon, f'block "{block.id}"')
    return geometry.counter_clockwise(polygon)


def _weight(block: Block, wall: Wall) -> float:
    if block.weight is not None:
        return block.weight
    unit_weight = block.unit_weight if block.unit_weight is not None else wall.unit_weight
    if unit_weight is None:
        if block.fixed:
            return 0.0
        raise InputError(
            "it has no weight",
            'Give it "weight", or "unit_weight" for it or for the wall',
            f'block "{block.id}"',
        )
    area = polygon_area(np.array(block.polygon, dtype=float))
    per_area = float(unit_weight) * area * thickness_of(block, wall)
    return per_area if wall.units.unit_weight is None else per_area * wall.units.unit_weight_factor


def _faces(
    interfaces: list[Interface], index: dict[str, int], fixed: np.ndarray
) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
    for number, interface in enumerate(interfaces):
        element = f"interfaces[{number}]"
        a, b = (index[block_id] for block_id in interface.between)
        if a == b:
            raise InputError("a block cannot touch itself", "Name two blocks", element)
        if interface.start == interface.end:
            raise InputError("its two ends coincide", 'Give a segment of some length in "from" and "to"', element)
        if fixed[a] and fixed[b]:
            raise InputError("both of its blocks are fixed", "Leave it out: it carries no unknown", element)
    pairs = np.array([[index[block_id] for block_id in interface.between] for interface in interfaces], dtype=np.int64)
    pairs = pairs.reshape(-1, 2)
    starts = np.array([interface.start for interface in interfaces], dtype=float).reshape(-1, 2)
    ends = np.array([interface.end for interface in interfaces], dtype=float).reshape(-1, 2)
    return pairs[:, 0], pairs[:, 1], starts, ends


def _check_held(
    names: tuple[str, ...], fixed: np.ndarray, block_a: IntArray, block_b: IntArray, joints: _Joints
) -> None:
    count = len(names)
    graph = sp.coo_matrix((np.ones(len(block_a)), (block_a, block_b)), shape=(count, count))
    _, component = connected_components(graph, directed=False)
    floating = ~np.isin(component, component[fixed])
    if not floating.any():
        return
    listed = [names[k] for k in np.flatnonzero(floating)]
    shown = first_few([f'"{name}"' for name in listed], 5)
    at_corner = bool(np.any(floating[joints.corners]))
    near = np.any(floating[joints.missed], axis=1)
    remedy = "Let faces meet along a length, or raise interfaces.greatest_gap if the drawing has gaps"
    if near.any():
        gaps, unlucky = joints.missed_gap[near], joints.missed[near]
        one, other = (names[k] for k in unlucky[int(np.argmin(gaps))])
        remedy = (
            f'Faces look at each other {span(gaps)} apart, those of "{one}" and "{other}" the nearest, '
            f"and joints are up to {joints.gap:.3g} wide: if they bear on each other, say "
            f'"interfaces": {{"tolerance": {1.02 * gaps.max():.3g}}}'
        )
    raise InputError(
        "no chain of interfaces joins "
        + ("it" if len(listed) == 1 else "them")
        + " to a fixed block: floating"
        + (" (a touch at a corner is no interface)" if at_corner else ""),
        remedy,
        f"block {shown}" if len(listed) == 1 else f"blocks {shown}",
    )


def _normals(
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
    import shapely

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


def _inclination(start: FloatArray, end: FloatArray) -> str:
    dx, dy = abs(end - start)
    return "bed" if dx >= dy else "head"


def _friction(wall: Wall, interface: Interface, joint: str, blocks: list[Block], index: dict[str, int]) -> float:
    if interface.friction is not None or interface.friction_angle is not None:
        return coefficient_of(interface.friction, interface.friction_angle)
    if not isinstance(wall.friction, Friction):
        return float(coefficient_of(wall.friction, wall.friction_angle))
    pair = set(interface.between)
    materials = sorted(blocks[index[block_id]].material for block_id in interface.between)
    by_kind: dict[str, float] = {}
    for rule in wall.friction.rules:
        if rule.between is not None and set(rule.between) == pair:
            by_kind["between"] = rule.coefficient
        elif rule.joint is not None and rule.joint == joint:
            by_kind["joint"] = rule.coefficient
        elif rule.materials is not None and sorted(rule.materials) == materials:
            by_kind["materials"] = rule.coefficient
    for kind in ("between", "joint", "materials"):
        if kind in by_kind:
            return by_kind[kind]
    return float(wall.friction.coefficient)


def _set_in(
    interfaces: list[Interface], general: Inset | None, face1: FloatArray, face2: FloatArray
) -> tuple[FloatArray, FloatArray]:
    length = np.linalg.norm(face2 - face1, axis=1)
    depth = np.zeros(len(interfaces))
    for number, interface in enumerate(interfaces):
        inset = interface.inset or general
        if inset is None:
            continue
        depth[number] = inset.length if inset.length is not None else (inset.fraction or 0.0) * length[number]
        if depth[number] >= 0.5 * length[number]:
            raise InputError(
                f"contact points set in by {depth[number]:.6g} at both ends leave nothing of its {length[number]:.6g}",
                "Give an inset below half of the shortest interface",
                f"interface between {' and '.join(interface.between)}",
            )
    step = (depth / length)[:, None] * (face2 - face1) if len(interfaces) else face1
    return face1 + step, face2 - step


def _dead_load(
    loads: Loads,
    blocks: list[Block],
    index: dict[str, int],
    weight: FloatArray,
    centroids: FloatArray,
    fixed: np.ndarray,
) -> FloatArray:
    """Gravity and what is dead besides it; a file of the time when a dead load stood for gravity is refused.

    Raises:
        InputError: the dead load presses every block down by a multiple of its weight and gravity is not spoken of.
    """
    gravity = BodyForce(per_weight=loads.gravity_per_weight)
    if loads.gravity is None and loads.dead.body:
        multiples = _load(
            Load(body=loads.dead.body), "loads.dead", blocks, index, np.ones(len(blocks)), centroids, fixed
        )
        if bool(np.all(multiples[~fixed, 1] < 0.0)):
            raise InputError(
                "the dead load presses every block down by a multiple of its weight, and gravity acts besides",
                'Leave it out; or say in loads "gravity": false if it stands for gravity, or true if it does not',
                "loads.dead.body",
            )
    whole = Load(body=[gravity, *loads.dead.body], points=loads.dead.points)
    return _load(whole, "loads.dead", blocks, index, weight, centroids, fixed, first=1)


def _load(
    load: Load,
    where: str,
    blocks: list[Block],
    index: dict[str, int],
    weight: FloatArray,
    centroids: FloatArray,
    fixed: np.ndarray,
    *,
    first: int = 0,
) -> FloatArray:
    """Generalised forces (n, 3) of a load; `first` is the number of its body forces that the file does not list."""
    generalised = np.zeros((len(blocks), 3))
    groups: dict[str, list[int]] = {}
    for k, block in enumerate(blocks):
        for group in block.groups:
            groups.setdefault(group, []).append(k)
    for number, body in enumerate(load.body):
        element = f"{where}.body[{number - first}]"
        if body.group is not None:
            if body.group not in groups:
                known = ", ".join(sorted(groups)) or "none"
                raise InputError(f'no block is in a group "{body.group}"', f"Groups of this wall: {known}", element)
            chosen = groups[body.group]
        elif body.blocks is not None:
            chosen = sorted({index[block_id] for block_id in body.blocks})
        else:
            chosen = list(range(len(blocks)))
        generalised[chosen, :2] += weight[chosen, None] * np.array(body.per_weight)
    for number, point in enumerate(load.points):
        element = f"{where}.points[{number}]"
        k = index[point.block]
        if fixed[k]:
            raise InputError(f'block "{point.block}" is fixed', "Load a block that is free to move", element)
        arm = np.array(point.at) - centroids[k]
        force = np.array(point.force)
        generalised[k] += [force[0], force[1], arm[0] * force[1] - arm[1] * force[0]]
    generalised[fixed] = 0.0
    return generalised


def _explicit(
    wall: Wall,
    blocks: list[Block],
    weight: FloatArray,
    interfaces: list[Interface],
    joints: tuple[str, ...],
    friction: FloatArray,
) -> Wall:
    return wall.model_copy(
        update={
            "pattern": None,
            "blocks": [
                block.model_copy(update={"weight": float(w), "unit_weight": None, "thickness": None})
                for block, w in zip(blocks, weight, strict=True)
            ],
            "interfaces": [
                interface.model_copy(update={"joint": joint, "friction": float(mu), "friction_angle": None})
                for interface, joint, mu in zip(interfaces, joints, friction, strict=True)
            ],
        }
    )
