"""Mechanisms as display lists: one as blocks with what its joints do, or two over each other with where they differ."""

from __future__ import annotations

import numpy as np

from harness.model.assembly import Assembly, FloatArray, IntArray
from harness.model.case import Case
from harness.model.result import Result, relative_velocities
from reports.drawing.display_list import Circles, DisplayList, Frame, Group, Lines, Polygons, Shape, chosen
from reports.drawing.wall_drawing import DRAWN_INTERFACES, bar_lines, length_scale, load_arrows
from reports.findings import joints
from reports.findings.agreement import measure_of
from reports.geometry import shapes
from reports.memo import memo

_ROLE = {
    joints.SLIDE: "slide",
    joints.ROCK: "rock",
    joints.BOTH: "both",
    joints.OPEN: "open",
    joints.DILATANT: "dilatant",
}
_OPENED = (joints.ROCK, joints.BOTH, joints.OPEN)
_HEAVY = (joints.SLIDE, joints.BOTH, joints.DILATANT)
_ELSEWHERE = 0.004
"""Share of the wall's longer side from which a block of the second mechanism stands elsewhere: half a line's width."""


@memo
def mechanism_drawing(case: Case, result: Result) -> DisplayList:
    """The mechanism of a result (n, 3) as displaced blocks, with what its joints do."""
    drawn = moved_wall(case.assembly, result)
    drawn.parts.extend(length_scale(drawn.frame, case.wall.units.length))
    return drawn


def moved_wall(assembly: Assembly, result: Result, scale: float | None = None) -> DisplayList:
    """Blocks displaced along a mechanism, over a trace of where they stood.

    Args:
        assembly: the wall.
        result: a result with a mechanism (n, 3).
        scale: displacement of the fastest vertex [length]; one that shows well by default.
    """
    mechanism = np.asarray(result.mechanism, dtype=float)
    scale = shapes.amplitude(assembly, mechanism) if scale is None else scale
    drawn = DisplayList(Frame.of(assembly), f"Mechanism of {result.case} by {result.method}")
    moves = shapes.moving(assembly, mechanism) & ~assembly.fixed
    placed = drawn.frame.place_all(assembly.polygons)
    motions = _motions(drawn.frame, assembly, scale * mechanism)
    drawn.parts.append(Polygons("ghost", chosen(placed, moves)))
    drawn.parts.extend(_cracks(drawn.frame, assembly, result, scale))
    for role, members in (("held", assembly.fixed), ("still", ~assembly.fixed & ~moves), ("moves", moves)):
        for k in np.flatnonzero(members).tolist():
            motion, values = (motions[k], tuple(mechanism[k].tolist())) if moves[k] else (None, ())
            drawn.parts.append(Group((Polygons(role, (placed[k],)),), motion, block=k, values=values))
    drawn.parts.extend(bar_lines(drawn.frame, assembly, scale * mechanism))
    if scale > 0.0 and assembly.n_interfaces <= DRAWN_INTERFACES:
        drawn.parts.extend(_marks(drawn.frame, assembly, result, moves, motions))
    return drawn


def loaded_mechanism(case: Case, result: Result) -> DisplayList:
    """The mechanism of a result (n, 3) as displaced blocks that stand still on a page, with the loads before it."""
    assembly, frame = case.assembly, Frame.of(case.assembly)
    mechanism = np.asarray(result.mechanism, dtype=float)
    scale = shapes.amplitude(assembly, mechanism)
    drawn = DisplayList(frame, f"Mechanism of {result.case} by {result.method}, with its loads")
    moves = shapes.moving(assembly, mechanism) & ~assembly.fixed
    drawn.parts.append(Polygons("ghost", chosen(frame.place_all(assembly.polygons), moves)))
    drawn.parts.extend(_cracks(frame, assembly, result, scale))
    placed = frame.place_all(shapes.displaced(assembly, mechanism, scale))
    for role, members in (("held", assembly.fixed), ("still", ~assembly.fixed & ~moves), ("moves", moves)):
        drawn.parts.append(Polygons(role, chosen(placed, members)))
    drawn.parts.extend(bar_lines(frame, assembly, scale * mechanism))
    drawn.parts.extend(load_arrows(frame, assembly))
    drawn.parts.extend(length_scale(frame, case.wall.units.length))
    return drawn


def overlay_drawing(case: Case, first: Result, second: Result) -> DisplayList:
    """Two mechanisms of a case: the first as blocks, the second dashed where its blocks stand elsewhere.

    The second is scaled to as much motion as the first has. Joints that slide or open in one of them only are drawn
    over it, those of the second dashed.

    Args:
        case: the case.
        first, second: results with a mechanism (n, 3).
    """
    assembly, frame = case.assembly, Frame.of(case.assembly)
    fields = [np.asarray(result.mechanism, dtype=float) for result in (first, second)]
    scale = shapes.amplitude(assembly, fields[0])
    scales = [scale, scale * _same_size(assembly, *fields)]
    drawn = DisplayList(frame, f"Mechanism of {first.case} by {first.method}, dashed that by {second.method}")
    places = [shapes.displaced(assembly, field, by) for field, by in zip(fields, scales, strict=True)]
    moves = shapes.moving(assembly, fields[0]) & ~assembly.fixed
    placed = frame.place_all(places[0])
    for role, members in (("held", assembly.fixed), ("still", ~assembly.fixed & ~moves), ("moves", moves)):
        drawn.parts.append(Polygons(role, chosen(placed, members)))
    apart = _ELSEWHERE * frame.extent.longest
    elsewhere = [b for a, b in zip(*places, strict=True) if float(np.abs(a - b).max()) > apart]
    drawn.parts.append(Polygons("other", tuple(frame.place_all(elsewhere))))
    drawn.parts.extend(_joints_of_one(frame, assembly, (first, second), scales))
    drawn.parts.extend(length_scale(frame, case.wall.units.length))
    return drawn


def _motions(frame: Frame, assembly: Assembly, shift: FloatArray) -> list[tuple[float, float, float]]:
    """Displacements (n, 3) of blocks about their centroids, as those of groups."""
    centre, turn = frame.place(assembly.centroid), -shift[:, 2]
    x = shift[:, 0] * frame.scale + turn * centre[:, 1]
    y = -shift[:, 1] * frame.scale - turn * centre[:, 0]
    return [(float(a), float(b), float(c)) for a, b, c in zip(turn, x, y, strict=True)]


def _same_size(assembly: Assembly, first: FloatArray, second: FloatArray) -> float:
    """What the second field of velocities is multiplied by to be as large as the first, in the mean over the areas."""
    measure = measure_of(assembly)
    sizes = [float((measure * field * field).sum()) for field in (first, second)]
    return float(np.sqrt(sizes[0] / sizes[1])) if sizes[1] > 0.0 else 1.0


def _joints_of_one(
    frame: Frame, assembly: Assembly, results: tuple[Result, Result], scales: list[float]
) -> list[Shape]:
    """Joints that slide, or open, in one mechanism and not in the other; nothing of a measured field."""
    found = [joints.motion(assembly, result) for result in results]
    if found[0] is None or found[1] is None or assembly.n_interfaces > DRAWN_INTERFACES:
        return []
    size, drawn = _mark_size(frame), list[Shape]()
    for number, (mine, other) in enumerate(((found[0], found[1]), (found[1], found[0]))):
        mechanism = np.asarray(results[number].mechanism, dtype=float)
        slides = mine.rubs & ~other.rubs
        opens = mine.opens & ~other.opens & ~slides
        for role, width, members in (("slide", size, slides), ("open", 0.6 * size, opens)):
            ends = _moved_ends(assembly, mechanism, scales[number], np.flatnonzero(members))
            drawn.append(Lines(role, tuple(frame.place(ends)), width, 0.9 * size if number else None))
    return drawn


def _cracks(frame: Frame, assembly: Assembly, result: Result, scale: float) -> list[Shape]:
    """What lies between the faces of joints that open, shaded: the crack pattern."""
    states = np.array(joints.joint_states(assembly, result) or [], dtype=object)
    opened = np.flatnonzero(np.isin(states, _OPENED))
    if not len(opened) or assembly.n_interfaces > DRAWN_INTERFACES:
        return []
    mechanism = np.asarray(result.mechanism, dtype=float)
    outlines = frame.place(_separated_faces(assembly, mechanism, scale, opened))
    ends = frame.place(np.stack([assembly.end1[opened], assembly.end2[opened]], axis=1))
    return [Polygons("crack", tuple(outlines), tuple(ends))]


def _mark_size(frame: Frame) -> float:
    """Width of the line of a joint that slides."""
    return min(46.0, max(8.0, 0.07 * frame.block))


def _marks(
    frame: Frame, assembly: Assembly, result: Result, moves: np.ndarray, motions: list[tuple[float, float, float]]
) -> list[Group]:
    """What the joints of a mechanism do, each moved with its block a."""
    mechanism = np.asarray(result.mechanism, dtype=float)
    opening, slip = relative_velocities(assembly, mechanism)
    ends, size = frame.place(np.stack([assembly.end1, assembly.end2], axis=1)), _mark_size(frame)
    drawn = []
    for p, state in enumerate(joints.joint_states(assembly, result) or []):
        if state == joints.STICK:
            continue
        line, wide = (ends[p],), size if state in _HEAVY else 0.6 * size
        parts: list[Shape] = [Lines(_ROLE[state], line, wide, 0.9 * size if state == joints.OPEN else None)]
        if state == joints.DILATANT:
            parts.append(Lines("core", line, 0.4 * size))
        if state in (joints.ROCK, joints.BOTH):
            hinge = int(opening[p, 1] < opening[p, 0])
            parts.append(Circles("hinge", ends[p, hinge][None], 1.1 * size))
        a = int(assembly.block_a[p])
        values = (state, *opening[p].tolist(), float(slip[p]))
        drawn.append(Group(tuple(parts), motions[a] if moves[a] else None, joint=p, values=values))
    return drawn


def _moved_ends(
    assembly: Assembly, mechanism: FloatArray, scale: float, chosen: IntArray, blocks: IntArray | None = None
) -> FloatArray:
    """Both contact points (p, 2, 2) of some interfaces, moved with the blocks (m,) given, their block a by default."""
    points = np.stack([assembly.end1[chosen], assembly.end2[chosen]], axis=1)
    block = (assembly.block_a if blocks is None else blocks)[chosen]
    arm = points - assembly.centroid[block][:, None]
    turned = mechanism[block, 2][:, None, None] * np.stack([-arm[..., 1], arm[..., 0]], axis=-1)
    return np.asarray(points + scale * (mechanism[block, :2][:, None] + turned))


def _separated_faces(assembly: Assembly, mechanism: FloatArray, scale: float, chosen: IntArray) -> FloatArray:
    """Outlines (p, 4, 2) between the faces of some interfaces: both contact points with block a, back with block b."""
    faces = [_moved_ends(assembly, mechanism, scale, chosen, side) for side in (assembly.block_a, assembly.block_b)]
    return np.concatenate([faces[0], faces[1][:, ::-1]], axis=1)
