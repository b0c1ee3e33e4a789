"""Contact forces as an inline SVG, as static/draw.js draws them: for pages without scripts and for vector files."""

from __future__ import annotations

import math
from collections import defaultdict

import numpy as np
from markupsafe import Markup, escape

from harness.model.assembly import Assembly, FloatArray
from harness.model.case import Case
from harness.model.result import Result
from reports import flow, numbers, shapes
from reports.drawing import BELOW, Frame, data_of, length_scale, outlines, stroke_factor
from reports.once import once

WIDEST, THINNEST = 0.16, 0.02
"""Width of the largest and of the smallest force, in block sizes."""
WIDTHS = 12
"""Widths are rounded to so many steps, so that forces of nearly one size share an element of the page."""


@once
def forces_svg(case: Case, result: Result) -> Markup:
    """Resultants of the contact forces (m, 3) of a result at their centres of pressure, with lengths and forces told.

    Args:
        case: the case.
        result: one of its results, with forces.
    """
    assembly = case.assembly
    frame = Frame(assembly)
    forces = np.asarray(result.forces, dtype=float)
    drawn = Markup('<svg class="wall" style="--k:{}" viewBox="{}" role="img" aria-label="{}">').format(
        stroke_factor(assembly), frame.view_box, f"Contact forces of {case.id} by {result.method}"
    )
    for still, name in ((True, "outline held"), (False, "outline")):
        data = data_of(outlines(assembly), assembly.fixed == still)
        drawn += Markup('<path class="{}" d="{}"/>').format(name, data)
    found = shapes.thrusts(assembly, forces, smallest=flow.STYLE.smallest)
    drawn += length_scale(frame, case.wall.units.length)
    if len(found.size):
        drawn += _arrows(frame, assembly, found, forces)
        drawn += _force_scale(frame, assembly, float(found.size.max()), case.wall.units.force)
    return drawn + Markup("</svg>")


def _width(frame: Frame, assembly: Assembly, share: float) -> float:
    """Width of the line of a force that is a share of the largest, in drawing units."""
    block = assembly.length_scale * frame.scale
    return max(THINNEST, WIDEST * math.ceil(WIDTHS * share) / WIDTHS) * block


def _arrows(frame: Frame, assembly: Assembly, found: shapes.Thrusts, forces: FloatArray) -> Markup:
    block = assembly.length_scale * frame.scale
    full = flow.at_friction_limit(assembly, forces)[found.interface]
    ends, way = flow.drawn_ends(assembly, found), flow.towards_ground(found) * [1.0, -1.0]
    bars: dict[tuple[bool, float], str] = defaultdict(str)
    heads, rings = {True: "", False: ""}, ""
    width = np.array([_width(frame, assembly, share) for share in (found.size / found.size.max()).tolist()])
    size = np.maximum(0.2 * block, 1.7 * width)[:, None]
    tail, tip = (np.array(frame.places(ends[:, end]), dtype=float) for end in (0, 1))
    neck, side = tip - size * way, 0.4 * size * np.column_stack([-way[:, 1], way[:, 0]])
    lines = np.column_stack([tail, 0.3 * tip + 0.7 * neck, tip, neck + side, neck - side]).tolist()
    for at_limit, wide, line, (x, y) in zip(
        full.tolist(), width.tolist(), lines, frame.places(found.point), strict=True
    ):
        bars[at_limit, wide] += "M{:.0f} {:.0f}L{:.0f} {:.0f}".format(*line[:4])
        heads[at_limit] += "M{:.0f} {:.0f}L{:.0f} {:.0f}L{:.0f} {:.0f}z".format(*line[4:])
        if at_limit:
            rings += f'<circle cx="{x}" cy="{y}" r="{max(0.05 * block, 0.5 * wide + 9):.0f}"/>'
    drawn = {True: Markup(rings), False: Markup("")}
    for (at_limit, wide), data in bars.items():
        drawn[at_limit] += Markup('<path stroke-width="{:.0f}" d="{}"/>').format(wide, data)
    for at_limit, data in heads.items():
        if data:
            drawn[at_limit] += Markup('<path class="tip-of" d="{}"/>').format(data)
    groups = Markup('<g class="full">{}</g><g>{}</g>').format(drawn[True], drawn[False])
    return Markup('<g class="bars">{}{}</g>').format(groups, _sizes(frame, assembly, found))


def _sizes(frame: Frame, assembly: Assembly, found: shapes.Thrusts) -> Markup:
    """The size of each force beside it, where there is room for all of them."""
    if len(found.size) > flow.STYLE.labelled:
        return Markup("")
    block, texts = assembly.length_scale * frame.scale, ""
    levels = abs(assembly.normal[found.interface, 1]) > 0.5
    for (x, y), size, level in zip(frame.places(found.point), found.size.tolist(), levels.tolist(), strict=True):
        across, up = (0.09, 0.05) if level else (0.0, 0.1)
        anchor = ' style="text-anchor:start"' if level else ""
        place = f'x="{x + across * block:.0f}" y="{y - up * block:.0f}"'
        texts += f"<text {place}{anchor}>{escape(numbers.given(size, 3))}</text>"
    return Markup('<g font-size="{:.0f}">{}</g>').format(min(110.0, 0.17 * block), Markup(texts))


def _force_scale(frame: Frame, assembly: Assembly, largest: float, unit: str) -> Markup:
    """A line as wide as a round force is drawn, below the wall on the right."""
    force = flow.round_number(largest)
    x = round(frame.extent.width * frame.scale)
    y = round(frame.extent.height * frame.scale) + BELOW // 2
    return Markup(
        '<g class="forces-scale"><path stroke-width="{:.0f}" d="M{} {}h330"/>'
        '<text x="{}" y="{}" font-size="110" style="text-anchor:start">{}</text></g>'
    ).format(_width(frame, assembly, force / largest), x - 330, y, x + 60, y + 38, numbers.quantity(force, unit))
