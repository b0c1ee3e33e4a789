"""Mechanisms as inline SVG: one as blocks with what its joints do, or two over each other with where they part."""

from __future__ import annotations

import numpy as np
from markupsafe import Markup

from harness.model.assembly import Assembly, FloatArray
from harness.model.case import Case
from harness.model.result import Result
from reports import joints, shapes
from reports.agreement import measure_of
from reports.drawing import DRAWN_INTERFACES, Frame, data_of, length_scale, paths_of, stroke_factor
from reports.once import once

MARK_CLASS = {
    joints.SLIDE: "slide",
    joints.ROCK: "rock",
    joints.BOTH: "both",
    joints.OPEN: "open",
    joints.DILATANT: "dilatant",
}
HEAVY = (joints.SLIDE, joints.BOTH, joints.DILATANT)
ELSEWHERE = 0.004
"""Share of the wall's longer side from which a block of the second mechanism stands elsewhere: half a line's width."""


def mechanism_svg(case: Case, result: Result, *, measured: bool = False) -> Markup:
    """The mechanism of a result (n, 3) as displaced blocks, with what its joints do.

    Args:
        case: the case.
        result: a result with a mechanism.
        measured: whether a bar of a length stands below, for a drawing that goes about alone.
    """
    bar = length_scale(Frame(case.assembly), case.wall.units.length) if measured else Markup("")
    return _mechanism(case, result) + bar + Markup("</svg>")


@once
def _mechanism(case: Case, result: Result) -> Markup:
    """The element without its end."""
    assembly, frame = case.assembly, Frame(case.assembly)
    mechanism = np.asarray(result.mechanism, dtype=float)
    drawn = _opened(case, frame, result.method)
    drawn += _blocks(frame, assembly, mechanism, shapes.amplitude(assembly, mechanism))
    if assembly.n_interfaces <= DRAWN_INTERFACES:
        drawn += _marks(frame, assembly, result)
    return drawn


def overlay_svg(case: Case, first: Result, second: Result) -> Markup:
    """Two mechanisms of a case: the first as blocks, the second dashed where its blocks stand elsewhere.

    The second is scaled to as much motion as the first has. Joints that slide or open in one of them only are drawn
    over it, those of the second dashed.

    Args:
        case: the case.
        first, second: results with a mechanism (n, 3).
    """
    assembly, frame = case.assembly, Frame(case.assembly)
    fields = [np.asarray(result.mechanism, dtype=float) for result in (first, second)]
    scale = shapes.amplitude(assembly, fields[0])
    scales = [scale, scale * _same_size(assembly, *fields)]
    drawn = _opened(case, frame, f"{first.method}, dashed that by {second.method}")
    drawn += _blocks(frame, assembly, fields[0], scale)
    places = [shapes.displaced(assembly, field, by) for field, by in zip(fields, scales, strict=True)]
    apart = ELSEWHERE * frame.extent.longest
    elsewhere = [b for a, b in zip(*places, strict=True) if float(np.abs(a - b).max()) > apart]
    data = "".join(paths_of(frame, elsewhere))
    drawn += Markup('<path class="other" d="{}"/>').format(data) if data else Markup("")
    drawn += _joints_of_one(frame, assembly, (first, second), scales)
    return drawn + length_scale(frame, case.wall.units.length) + Markup("</svg>")


def _opened(case: Case, frame: Frame, by: str) -> Markup:
    return Markup('<svg class="wall" style="--k:{}" viewBox="{}" role="img" aria-label="{}">').format(
        stroke_factor(case.assembly), frame.view_box, f"Mechanism of {case.id} by {by}"
    )


def _blocks(frame: Frame, assembly: Assembly, mechanism: FloatArray, scale: float) -> Markup:
    moves = shapes.moving(assembly, mechanism) & ~assembly.fixed
    paths, drawn = paths_of(frame, shapes.displaced(assembly, mechanism, scale)), Markup("")
    for name, members in (("held", assembly.fixed), ("still", ~assembly.fixed & ~moves), ("moves", moves)):
        drawn += Markup('<path class="{}" d="{}"/>').format(name, data_of(paths, members))
    return drawn


def _same_size(assembly: Assembly, first: FloatArray, second: FloatArray) -> float:
    """What the second field of velocities is multiplied by to be as large as the first, in the mean over the areas."""
    measure = measure_of(assembly)
    sizes = [float((measure * field * field).sum()) for field in (first, second)]
    return float(np.sqrt(sizes[0] / sizes[1])) if sizes[1] > 0.0 else 1.0


def _joints_of_one(frame: Frame, assembly: Assembly, results: tuple[Result, Result], scales: list[float]) -> Markup:
    """Joints that slide, or open, in one mechanism and not in the other; nothing of a measured field."""
    found = [joints.motion(assembly, result) for result in results]
    if found[0] is None or found[1] is None or assembly.n_interfaces > DRAWN_INTERFACES:
        return Markup("")
    size, drawn = mark_size(frame, assembly), Markup("")
    for number, (mine, other) in enumerate(((found[0], found[1]), (found[1], found[0]))):
        mechanism = np.asarray(results[number].mechanism, dtype=float)
        slides = mine.rubs & ~other.rubs
        opens = mine.opens & ~other.opens & ~slides
        for name, width, members in (("slide", size, slides), ("open", 0.6 * size, opens)):
            ends = shapes.moved_ends(assembly, mechanism, scales[number], np.flatnonzero(members))
            if len(ends):
                dashes = Markup(' stroke-dasharray="{0:.0f} {0:.0f}"').format(0.9 * size) if number else ""
                drawn += Markup('<path class="{}" stroke-width="{:.0f}"{} d="{}"/>').format(
                    name, width, dashes, _lines(frame, ends)
                )
    return drawn


def mark_size(frame: Frame, assembly: Assembly) -> float:
    """Width of the line of a joint that slides, in drawing units; as in static/draw.js."""
    return min(46.0, max(8.0, 0.07 * assembly.length_scale * frame.scale))


def _lines(frame: Frame, ends: FloatArray) -> str:
    pairs = zip(frame.places(ends[:, 0]), frame.places(ends[:, 1]), strict=True)
    return "".join(f"M{x0} {y0}L{x1} {y1}" for (x0, y0), (x1, y1) in pairs)


def _marks(frame: Frame, assembly: Assembly, result: Result) -> Markup:
    """What the joints of a mechanism do, drawn where their block a has moved, as static/draw.js does."""
    states = np.array(joints.joint_states(assembly, result) or [])
    mechanism = np.asarray(result.mechanism, dtype=float)
    scale = shapes.amplitude(assembly, mechanism)
    size = mark_size(frame, assembly)
    drawn = Markup("")
    for state, name in ((k, v) for k, v in MARK_CLASS.items() if (states == k).any()):
        chosen = np.flatnonzero(states == state)
        ends = shapes.moved_ends(assembly, mechanism, scale, chosen)
        data = _lines(frame, ends)
        width = size if state in HEAVY else 0.6 * size
        dashes = Markup(' stroke-dasharray="{0:.0f} {0:.0f}"').format(0.9 * size) if state == joints.OPEN else ""
        drawn += Markup('<path class="{}" stroke-width="{:.0f}"{} d="{}"/>').format(name, width, dashes, data)
        if state == joints.DILATANT:
            drawn += Markup('<path class="core" stroke-width="{:.0f}" d="{}"/>').format(0.4 * size, data)
        if state in (joints.ROCK, joints.BOTH):
            hinges = frame.places(shapes.hinges(assembly, mechanism, ends, chosen))
            drawn += Markup(
                "".join(f'<circle class="hinge" cx="{x}" cy="{y}" r="{1.1 * size:.0f}"/>' for x, y in hinges)
            )
    return drawn
