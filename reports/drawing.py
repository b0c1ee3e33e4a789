"""Walls as inline SVG, and the compact numbers from which the page draws mechanisms and contact forces.

Drawing units: the longer side of a wall is 4000 units, y points down, all coordinates are integers. The wall itself
is drawn here, so that the page shows it without any script; mechanisms and forces are drawn by static/draw.js.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from markupsafe import Markup, escape

from harness.model.assembly import Assembly, FloatArray, polygon_area
from harness.model.case import Case
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.result import Result
from harness.model.rings import rings_of
from reports import flow, joints, numbers, shapes
from reports.once import once

SIZE = 4000
MARGIN = 560
BELOW = 240
FORCE_STEPS = 10_000
LABELLED_BLOCKS = 160
DOTTED_INTERFACES = 240
DRAWN_INTERFACES = 4000


class Frame:
    """The change from the wall's lengths to drawing units."""

    def __init__(self, assembly: Assembly) -> None:
        self.extent = shapes.extent(assembly)
        self.scale = SIZE / self.extent.longest

    def place(self, point: FloatArray) -> tuple[int, int]:
        """A point in drawing units."""
        return (
            round((float(point[0]) - self.extent.left) * self.scale),
            round((self.extent.top - float(point[1])) * self.scale),
        )

    def places(self, points: FloatArray) -> list[tuple[int, int]]:
        """Points (k, 2) in drawing units."""
        away = np.column_stack([points[:, 0] - self.extent.left, self.extent.top - points[:, 1]])
        return [(x, y) for x, y in np.rint(away * self.scale).astype(int).tolist()]

    @property
    def view_box(self) -> str:
        """The part of the plane to show: the wall and room round it for loads and motion."""
        width, height = self.extent.width * self.scale, self.extent.height * self.scale
        return f"{-MARGIN} {-MARGIN} {width + 2 * MARGIN:.0f} {height + MARGIN + BELOW:.0f}"


def stroke_factor(assembly: Assembly) -> float:
    """How much thinner than usual lines are drawn, so that small blocks are not buried under them."""
    block = assembly.length_scale * SIZE / shapes.extent(assembly).longest
    return round(min(1.0, max(0.3, block / 450.0)), 2)


def paths_of(frame: Frame, polygons: Sequence[FloatArray]) -> list[str]:
    """Polygons as SVG path data, relative after the first vertex; holes are rings that run the other way round."""
    rings = [rings_of(polygon) for polygon in polygons]
    each = [ring for of_one in rings for ring in of_one]
    places = iter(frame.places(np.concatenate(each)) if each else [])
    return ["".join(_ring(list(itertools.islice(places, len(ring)))) for ring in of_one) for of_one in rings]


def data_of(paths: Sequence[str], members: Iterable[bool]) -> str:
    """Path data of those polygons that are members."""
    return "".join(itertools.compress(paths, members))


@once
def outlines(assembly: Assembly) -> list[str]:
    """The path data of every block of a wall."""
    return paths_of(Frame(assembly), assembly.polygons)


def _ring(points: list[tuple[int, int]]) -> str:
    text = f"M{points[0][0]} {points[0][1]}"
    for (x0, y0), (x1, y1) in itertools.pairwise(points):
        if (x0, y0) != (x1, y1):
            text += f"l{x1 - x0} {y1 - y0}"
    return text + "z"


def block_labels(assembly: Assembly) -> list[str]:
    """What stands in each block: its id where all ids are short, its number otherwise."""
    if all(len(name) <= 5 for name in assembly.block_ids):
        return list(assembly.block_ids)
    return [str(number) for number in range(1, assembly.n_blocks + 1)]


@once
def wall_svg(case: Case) -> Markup:
    """The wall as an inline SVG element: blocks with numbers, interfaces, contact points, loads."""
    assembly = case.assembly
    frame = Frame(assembly)
    parts = [
        Markup('<svg class="wall" style="--k:{}" viewBox="{}" role="img" aria-label="{}">').format(
            stroke_factor(assembly),
            frame.view_box,
            f"The wall {case.id}: {numbers.count(assembly.n_free, 'free block')}, "
            f"{numbers.count(assembly.n_interfaces, 'interface')}, with its loads",
        )
    ]
    for still, name in ((True, "held"), (False, "stone")):
        data = data_of(outlines(assembly), assembly.fixed == still)
        parts.append(Markup('<path class="{}" d="{}"/>').format(name, data))
    parts.append(_joints(frame, assembly))
    parts.append(_labels(frame, assembly))
    parts.append(_arrows(frame, assembly, shapes.extra_dead_load(assembly), "dead"))
    parts.append(_arrows(frame, assembly, assembly.live, "live"))
    parts.append(length_scale(frame, case.wall.units.length))
    parts.append(Markup("</svg>"))
    return Markup("").join(parts)


def length_scale(frame: Frame, unit: str) -> Markup:
    """A bar of a round length below the wall."""
    length = flow.round_number(0.3 * frame.extent.longest)
    y = round(frame.extent.height * frame.scale) + BELOW // 2
    text = numbers.quantity(length, unit)
    return Markup(
        '<g class="scale"><path d="M0 {0}H{1}M0 {2}v80M{1} {2}v80"/><text x="{3}" y="{4}" font-size="110" '
        'style="text-anchor:start">{5}</text></g>'
    ).format(y, round(length * frame.scale), y - 40, round(length * frame.scale) + 60, y + 38, text)


def polygons_svg(case: Case, polygons: list[FloatArray]) -> Markup:
    """Blocks of a case at other places, as an inline SVG element."""
    assembly = case.assembly
    frame = Frame(assembly)
    drawn = Markup('<svg class="wall" style="--k:{}" viewBox="{}" role="img" aria-label="{}">').format(
        stroke_factor(assembly), frame.view_box, f"Displaced blocks of {case.id}"
    )
    paths = paths_of(frame, polygons)
    for still, name in ((True, "held"), (False, "moves")):
        data = data_of(paths, assembly.fixed == still)
        drawn += Markup('<path class="{}" d="{}"/>').format(name, data)
    return drawn + Markup("</svg>")


def _joints(frame: Frame, assembly: Assembly) -> Markup:
    if assembly.n_interfaces > DRAWN_INTERFACES:
        return Markup("")
    lines, dots = "", ""
    for (x0, y0), (x1, y1) in zip(frame.places(assembly.end1), frame.places(assembly.end2), strict=True):
        lines += f"M{x0} {y0}l{x1 - x0} {y1 - y0}"
        dots += f"M{x0} {y0}h0M{x1} {y1}h0"
    drawn = Markup('<path class="joint" d="{}"/>').format(lines)
    if assembly.n_interfaces <= DOTTED_INTERFACES:
        drawn += Markup('<path class="contact" d="{}"/>').format(dots)
    return drawn


def _labels(frame: Frame, assembly: Assembly) -> Markup:
    if assembly.n_blocks > LABELLED_BLOCKS:
        return Markup("")
    texts = ""
    for label, name, polygon, (x, y), fixed in zip(
        block_labels(assembly),
        assembly.block_ids,
        assembly.polygons,
        frame.places(assembly.centroid),
        assembly.fixed,
        strict=True,
    ):
        box = (polygon.max(axis=0) - polygon.min(axis=0)) * frame.scale
        slender = 2.0 * polygon_area(polygon) / _perimeter(polygon) * frame.scale
        size = min(170.0, 0.38 * float(box[1]), 1.2 * slender / max(1.0, 0.55 * len(label)))
        if size < 44.0:
            continue
        place = f'x="{x}" y="{round(y + (0.35 if fixed else -0.22) * size)}"'
        named = f"{escape(label)}<title>block {escape(name)}</title>"
        texts += f'<text {place} font-size="{size:.0f}">{named}</text>'
    return Markup(texts)


def _perimeter(polygon: FloatArray) -> float:
    return float(np.linalg.norm(polygon - np.roll(polygon, -1, axis=0), axis=1).sum())


def _arrows(frame: Frame, assembly: Assembly, load: FloatArray, kind: str) -> Markup:
    arrows = shapes.load_arrows(assembly, load)
    arrows = arrows[:: shapes.drawn_every(len(arrows))]
    if not arrows:
        return Markup("")
    largest = max(float(np.linalg.norm(arrow.force)) for arrow in arrows)
    longest = min(420.0, max(90.0, 0.8 * assembly.length_scale * frame.scale))
    shafts, heads = "", ""
    for arrow in arrows:
        size = float(np.linalg.norm(arrow.force))
        way = np.array([arrow.force[0], -arrow.force[1]]) / size
        length = longest * (0.35 + 0.65 * math.sqrt(size / largest))
        head = min(90.0, 0.4 * length)
        tail = np.array(frame.place(arrow.point))
        tip = tail + length * way
        neck, side = tip - head * way, 0.4 * head * np.array([-way[1], way[0]])
        shafts += f"M{tail[0]:.0f} {tail[1]:.0f}L{neck[0]:.0f} {neck[1]:.0f}"
        heads += "M{:.0f} {:.0f}L{:.0f} {:.0f}L{:.0f} {:.0f}z".format(*tip, *(neck + side), *(neck - side))
    return Markup('<path class="{} shaft" d="{}"/><path class="{} head" d="{}"/>').format(kind, shafts, kind, heads)


def case_data(case: Case) -> dict[str, Any]:
    """Geometry of a wall for the page's script: polygons, centroids, interfaces, units."""
    assembly = case.assembly
    frame = Frame(assembly)
    return {
        "box": frame.view_box,
        "ids": list(assembly.block_ids),
        "path": outlines(assembly),
        "c": [x for place in frame.places(assembly.centroid) for x in place],
        "fixed": "".join("1" if fixed else "0" for fixed in assembly.fixed),
        "a": assembly.block_a.tolist(),
        "b": assembly.block_b.tolist(),
        "e": [
            x
            for start, end in zip(frame.places(assembly.end1), frame.places(assembly.end2), strict=True)
            for x in (*start, *end)
        ],
        "n": [round(1000 * float(x)) for normal in assembly.normal for x in (normal[0], -normal[1])],
        "mu": _run_lengths([round(float(x), 6) for x in assembly.friction]),
        "joint": _run_lengths(list(assembly.joint)),
        "force": case.wall.units.force,
        "block": round(assembly.length_scale * frame.scale),
    }


def _run_lengths(values: list[Any]) -> list[Any]:
    """One value if all are equal, else all of them."""
    return values[:1] if len(set(values)) <= 1 else values


def result_data(case: Case, result: Result, force_unit: float, *, fields: str = "all") -> dict[str, Any]:
    """Fields of one result for the page's script.

    Args:
        case: the case.
        result: one of its results.
        force_unit: the force that is written as FORCE_STEPS [force]; one for all methods of a case.
        fields: "all", "mechanism" (no forces) or "none".
    """
    data: dict[str, Any] = {}
    assembly = case.assembly
    if fields != "none" and result.mechanism is not None and len(result.mechanism) == assembly.n_blocks:
        frame = Frame(assembly)
        mechanism = np.asarray(result.mechanism, dtype=float)
        scale = shapes.amplitude(assembly, mechanism)
        # Displacement in drawing units and rotation in 1/10000 rad, at the amplitude the slider starts from.
        shift = np.rint(mechanism[:, :2] * scale * frame.scale * [1.0, -1.0] * 10.0).astype(int)
        turn = np.rint(-mechanism[:, 2] * scale * 1e4).astype(int)
        data["m"] = np.column_stack([shift, turn]).ravel().tolist()
        data["speed"] = 1.0 / (10.0 * scale * frame.scale)
        data["spin"] = 1.0 / (1e4 * scale)
        data["s"] = "".join(joints.LETTER[state] for state in joints.joint_states(assembly, result) or [])
    if fields == "all" and result.forces is not None and len(result.forces) == assembly.n_interfaces:
        forces = np.asarray(result.forces, dtype=float)
        data["f"] = np.rint(forces / force_unit * FORCE_STEPS).astype(int).ravel().tolist()
        data["used"] = _percent_used(assembly, forces)
    return data


def _percent_used(assembly: Assembly, forces: FloatArray) -> list[int]:
    """Friction used at every interface in whole percent: 100 exactly where it is at its limit, -1 without friction."""
    used = flow.friction_used(assembly, forces)
    below = np.minimum(99, np.rint(100.0 * np.nan_to_num(used, nan=-0.01)))
    at_limit = flow.at_friction_limit(assembly, forces)
    return [int(percent) for percent in np.where(at_limit, 100, below)]


def force_unit(results: list[Result]) -> float:
    """The largest contact force of any result of a case [force], or 1."""
    largest = 0.0
    for result in results:
        if result.forces:
            largest = max(largest, float(abs(np.asarray(result.forces, dtype=float)).max()))
    return largest or 1.0


def fields_drawn(run: ComparisonRun, budget: int) -> list[str]:
    """What the page draws of each case: "all", "mechanism" (no forces) or "none" (the wall only).

    The largest cases are cut first, until about `budget` bytes are left; sizes are estimates per number written.
    """
    sizes = [(0, 0, 0) if shapes.problem(item.case) else _sizes(item) for item in run.cases]
    fields = ["all"] * len(sizes)
    total = sum(sum(size) for size in sizes)
    for level in ("mechanism", "none"):
        for number in sorted(range(len(sizes)), key=lambda k: -sum(sizes[k])):
            if total <= budget:
                return fields
            fields[number] = level
            total -= sizes[number][2] if level == "mechanism" else sum(sizes[number][:2])
    return fields


def _sizes(item: CaseResults) -> tuple[int, int, int]:
    """Bytes of the geometry, the mechanisms and the contact forces of a case, about."""
    assembly = item.case.assembly
    geometry = 45 * assembly.n_blocks + 40 * assembly.n_interfaces
    mechanisms = sum(13 * len(result.mechanism) for result in item.results if result.mechanism is not None)
    forces = sum(14 * len(result.forces) for result in item.results if result.forces is not None)
    return geometry, mechanisms, forces
