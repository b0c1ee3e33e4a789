"""Drawings against the wall: what a reader measures on them, whatever made them."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, pairwise

import matplotlib as mpl
import numpy as np
import pytest
import shapely
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.text import Text

import drystone
from cases.start import stack as column
from harness.model.case import Case
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.inspection import inspect
from harness.model.result import Result
from reports.drawing.display_list import Frame
from reports.drawing.force_drawing import force_drawing
from reports.drawing.looks import COLOURS, LOOKS, css
from reports.drawing.svg import inline
from reports.drawing.wall_drawing import wall_drawing
from reports.figures import figures
from reports.figures.animate import frames
from reports.figures.settling import settled_figure
from reports.figures.wall_check_figure import inspected_figure
from reports.geometry import shapes, thrust_lines
from reports.page import build
from reports.page.page_drawings import drawing_bytes, fields_drawn
from tests.reports import samples
from tests.reports.read_chart import NUMBER, points_of
from tests.walls import case as wall_case
from tests.walls import running_bond, stack

DIGIT = 0.55
"""Width of a letter in its size, about."""


@dataclass(frozen=True, eq=False)
class Part:
    """What an element of an SVG shows, where its group has moved it.

    Attributes:
        role: its classes.
        points: (k, 2) corners of a path, the box of a circle, or the place of a text.
        element: with its attributes.
    """

    role: str
    points: np.ndarray
    element: ET.Element

    def lines(self) -> Iterator[np.ndarray]:
        """The corners of each line or outline of a path."""
        for data in re.findall(r"M[^M]*", self.element.get("d", "")):
            yield points_of(data)


def read(svg: str) -> tuple[np.ndarray, list[Part]]:
    """The window (left, top, width, height) of a drawing and what stands in it."""
    root = ET.fromstring(svg)
    window = np.array([float(x) for x in root.get("viewBox", "").split()])
    return window, list(_parts(root, np.eye(2, 3)))


def _parts(element: ET.Element, motion: np.ndarray) -> Iterator[Part]:
    matrix = re.findall(NUMBER, element.get("transform", ""))
    if matrix:
        motion = np.array([float(x) for x in matrix]).reshape(3, 2).T
    points = points_of(element.get("d", ""))
    if element.tag == "circle":
        (x, y), r = (float(element.get(name, "")) for name in ("cx", "cy")), float(element.get("r", ""))
        points = np.array([(x - r, y - r), (x + r, y + r)])
    elif element.tag == "text":
        points = np.array([(float(element.get("x", "")), float(element.get("y", "")))])
    if len(points):
        yield Part(element.get("class", ""), points @ motion[:, :2].T + motion[:, 2], element)
    for child in element:
        yield from _parts(child, motion)


def forces_of(case: Case, result: Result) -> list[Part]:
    """What the drawing of contact forces shows."""
    return read(str(inline(force_drawing(case, result))))[1]


@pytest.mark.parametrize("pattern", [running_bond(6, 2), stack(5), running_bond(2, 9)])
def test_all_that_is_drawn_of_a_wall_lies_in_its_window_and_fills_it(pattern: dict[str, object]):
    case = wall_case(pattern)
    results = [samples.solved(case, "la", 0.4, turn=0.3), samples.solved(case, "fe", 0.5)]
    page = build.render(ComparisonRun("one", "", "", [CaseResults(case, results)]), data_folder="x")
    made = [read(svg) for svg in re.findall(r'<svg class="wall".*?</svg>', page, re.S)]
    assert len(made) >= 5, "the wall, the summary, and mechanisms and forces without a script"
    for (left, top, *size), parts in made:
        corners = np.concatenate([part.points for part in parts])
        assert (corners >= (left, top)).all()
        assert (corners <= np.add((left, top), size)).all()
        assert (np.ptp(corners, axis=0) / size).max() > 0.7


def width_at(arrow: shapely.Polygon, tail: np.ndarray, tip: np.ndarray, share: float) -> float:
    """Width of an arrow across it at a share of its length."""
    step, middle = tip - tail, (1.0 - share) * tail + share * tip
    side = np.array([-step[1], step[0]])
    return float(shapely.LineString([middle - side, middle + side]).intersection(arrow).length)


def test_arrows_of_forces_end_in_their_heads_and_are_as_wide_as_the_forces_are_large():
    case = samples.bond(courses=4, bricks=3)
    result = samples.solved(case, "la", 0.5)
    found = shapes.thrusts(case.assembly, np.asarray(result.forces), smallest=thrust_lines.SMALLEST)
    parts, frame = forces_of(case, result), Frame.of(case.assembly)
    arrows = [outline for part in parts if part.role in ("force", "full") for outline in part.lines()]
    lines = [(float(part.element.get("stroke-width", "")), part.points) for part in parts if part.role == "thrust"]
    assert len(arrows) == len(lines) == len(found.size) > 10
    widest = max(width for width, _ in lines)
    ends = frame.place(thrust_lines.drawn_ends(case.assembly, found))
    drawn = zip(arrows, lines, ends, frame.place(found.point), found.size / found.size.max(), strict=True)
    for outline, (width, line), (tail, tip), point, share in drawn:
        arrow, whole = shapely.Polygon(outline), np.linalg.norm(tip - tail)
        assert arrow.is_valid
        assert arrow.buffer(1.5).covers(shapely.LineString([tail, tip]))

        widths = {
            at: width_at(arrow, tail, tip, at) for at in (0.1, 0.4, *np.linspace(0.5, 1.0, 26), 1.0 - 4.0 / whole)
        }
        assert widths[0.1] == pytest.approx(widths[0.4], abs=2.0)
        assert widths[0.4] == pytest.approx(width, abs=2.5)  # whole units at both sides
        assert max(widths.values()) > 1.2 * width, "a head"
        assert widths[1.0 - 4.0 / whole] < 0.5 * width + 8.0, "the head ends in the tip"
        assert width / widest == pytest.approx(max(share, 0.125), abs=0.01)
        assert np.linalg.norm(line - point, axis=1).min() < 1.0


@pytest.mark.parametrize("case", [samples.bond(), samples.block(), *map(wall_case, (stack(5), running_bond(9, 1)))])
def test_the_scales_of_lengths_and_forces_cover_neither_each_other_nor_the_wall(case: Case):
    (left, top, wide, high), parts = read(str(inline(force_drawing(case, samples.solved(case, "la", 0.5)))))
    boxes = []
    for k, part in enumerate(parts):
        if part.role in ("scale", "force-scale"):
            thick, text = 0.5 * float(part.element.get("stroke-width", "14")), parts[k + 1]
            (x0, y0), (x1, y1) = part.points.min(axis=0), part.points.max(axis=0)
            boxes.append(shapely.box(x0, y0 - thick, x1, y1 + thick))
            (x, y), size = text.points[0], float(text.element.get("font-size", ""))
            boxes.append(shapely.box(x, y - 0.75 * size, x + DIGIT * size * len(text.element.text or ""), y))
    assert len(boxes) == 4
    assert all(shapely.box(left, top, left + wide, top + high).contains(box) for box in boxes)
    foot = max(part.points[:, 1].max() for part in parts if part.role in ("ground", "outline"))
    assert all(box.bounds[1] > foot for box in boxes)
    right = Frame.of(case.assembly).place(case.assembly.corners[0].max(axis=0))[0]
    assert boxes[2].bounds[2] == pytest.approx(right, abs=1)
    assert not any(one.intersects(other) for one, other in combinations(boxes, 2))


@pytest.mark.parametrize("width", [0.02, 0.05, 5.0])
def test_names_of_blocks_fit_into_upright_blocks(width: float):
    case = wall_case({"type": "stack", "width": width, "height": 20.0 * width, "count": 2})
    scale = Frame.of(case.assembly).scale
    titles = {part: part.element.findtext("title", "") for part in read(str(inline(wall_drawing(case))))[1]}
    labels = [part.element for part, title in titles.items() if title.startswith("block")]
    assert len(labels) >= 2
    for label in labels:
        assert DIGIT * float(label.get("font-size", "")) * len(label.text or "") < 1.25 * width * scale


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_forces_left_out_of_drawings_are_small_beside_the_largest_in_any_unit(unit: float):
    assembly = samples.bond().assembly
    forces = np.ones((assembly.n_interfaces, 3))
    forces[0] = 1e-4
    found = shapes.thrusts(assembly, unit * forces, smallest=1e-3)
    assert found.interface.tolist() == list(range(1, assembly.n_interfaces))


def test_forces_go_before_mechanisms_and_no_more_goes_than_has_to():
    run = samples.large(cases=3, methods=2)
    mechanisms, forces = zip(*(drawing_bytes(item) for item in run.cases), strict=True)
    order = sorted(range(3), key=lambda k: -(mechanisms[k] + forces[k]))
    budget, levels = sum(mechanisms) + sum(forces), ["all"] * 3
    assert fields_drawn(run, budget) == levels
    for level, saved in (("mechanism", forces), ("none", mechanisms)):
        for k in order:
            levels[k] = level
            assert fields_drawn(run, budget - 1) == levels
            budget -= saved[k]
            assert fields_drawn(run, budget) == levels
    assert budget == 0


def test_what_a_result_does_not_have_is_not_drawn():
    case = samples.bond("mine")
    whole = samples.solved(case, "la", 0.5)
    for without, kind in (("forces", "mechanism"), ("mechanism", "forces")):
        item = CaseResults(case, [whole.model_copy(update={without: None})])
        page = build.render(ComparisonRun("one", "", "", [item]), data_folder="x")
        drawn = page.split("<script")[0].split('<section id="cases">')
        assert re.findall(r'data-kind="(\w+)"', drawn[1]) == [kind]
        assert ('data-kind="mechanism"' in drawn[0]) is (without == "forces"), "of the first screen"


def texts_of(page: Figure) -> list[tuple[Text, tuple[float, float, float, float]]]:
    """Texts of a figure that are seen, with their boxes in pixels."""
    canvas = FigureCanvasAgg(page)
    canvas.draw()
    shown = [text for text in page.findobj(Text) if text.get_visible() and text.get_text().strip()]
    return [(text, text.get_window_extent(canvas.get_renderer()).extents) for text in shown]


def lines_of(ax: Axes) -> list[np.ndarray]:
    """All lines (k, 2) on axes, in their coordinates."""
    drawn = [item for item in ax.collections if isinstance(item, LineCollection)]
    return [np.asarray(line) for item in drawn for line in item.get_segments()]


def test_a_long_title_stays_on_the_page():
    case = samples.bond(title="a wall of many stones " * 12)
    page = figures.results_figure(case, [samples.solved(case, "la", 0.5)], "mechanism")
    with mpl.rc_context(), figures.style():
        heads = [box for text, box in texts_of(page) if text.get_text().startswith("a wall of")]
    ((left, _, right, _),) = heads
    assert 0.0 <= left < right <= page.bbox.width
    assert right - left > 0.8 * page.bbox.width


@pytest.mark.parametrize("kind", ["mechanism", "forces"])
def test_scales_of_a_figure_lie_within_it(kind: str):
    case = samples.bond()
    ax = figures.results_figure(case, [samples.solved(case, "la", 0.5)], kind).axes[0]
    window = shapely.box(ax.get_xlim()[0], ax.get_ylim()[0], ax.get_xlim()[1], ax.get_ylim()[1])
    below = min(polygon[:, 1].min() for polygon in case.assembly.polygons)
    drawn = [shapely.LineString(line) for line in lines_of(ax)]
    assert all(window.contains(line) for line in drawn)
    bars = [line for line in drawn if line.bounds[3] < below and np.ptp(line.xy[1]) < 1e-9 * line.length]
    assert len(bars) == (1 if kind == "mechanism" else 2), "the wall covers no scale"


def test_ids_fit_into_blocks_and_dimensions_onto_the_sheet_that_is_shown():
    looked = inspect(column(3, width=0.05, height=0.4))
    page = inspected_figure(looked, dimensions=True)
    ax = page.axes[0]
    low, high = (np.array([ax.get_xlim()[k], ax.get_ylim()[k]]) for k in (0, 1))
    corners = np.concatenate(looked.outlines)
    beyond = [line for line in lines_of(ax) if (line.min(axis=0) > corners.max(axis=0)).any()]
    assert len(beyond) == 4, "a line with two heads above the wall and one beside it"
    heads = [item for item in ax.collections if isinstance(item, PolyCollection)]
    tips = [
        np.asarray(path.vertices)
        for item in heads
        if np.allclose(item.get_facecolor(), to_rgba(COLOURS[LOOKS["size"].fill]))
        for path in item.get_paths()
    ]
    assert len(tips) == 4
    for points in (*beyond, *tips):
        assert (points > low).all()
        assert (points < high).all()
    spans = np.concatenate(tips)
    for k in (0, 1):
        along = spans[spans[:, 1 - k] > corners[:, 1 - k].max(), k]
        assert (along.min(), along.max()) == pytest.approx((corners[:, k].min(), corners[:, k].max()))
    free = next(k for k, fixed in enumerate(looked.fixed) if not fixed)
    with mpl.rc_context(), figures.style():
        sizes = {text.get_text().split("\n")[0]: box for text, box in texts_of(page)}
    left, _, right, _ = sizes[looked.names[free]]
    block = ax.transData.transform(looked.outlines[free])
    assert right - left < np.ptp(block[:, 0])


def test_supports_alone_are_hatched_in_a_wall_looked_over():
    looked = inspect(column(2, width=0.3, height=0.2))
    ax = inspected_figure(looked).axes[0]
    hatched = [len(item.get_paths()) for item in ax.collections if getattr(item, "get_hatch", lambda: None)()]
    assert hatched == [int(np.sum(looked.fixed))]


def shaded(case: Case, result: Result) -> list[np.ndarray]:
    """Left and right edge of what moves in each frame of an animation, in pixels; it touches no edge of the picture."""
    colour = np.array([int("#dfe8f1"[k : k + 2], 16) for k in (1, 3, 5)])
    seen = []
    for image in frames(case, result):
        columns = (np.abs(np.asarray(image, dtype=int) - colour).max(axis=2) < 3).any(axis=0)
        assert not columns[[0, -1]].any()
        seen.append(np.flatnonzero(columns)[[0, -1]])
    return seen


def test_an_animation_ends_at_twice_the_displacement_of_the_report_and_gathers_speed():
    case = samples.block()
    result = samples.solved(case, "la", 0.4)
    edges = np.array(shaded(case, result), dtype=float)
    moved = (edges - edges[0]) / np.ptp(edges[0])  # the block is 1 wide
    np.testing.assert_allclose(moved[:, 0], moved[:, 1], atol=0.01)
    assert moved[-1, 0] == pytest.approx(2.0 * shapes.amplitude(case.assembly, np.asarray(result.mechanism)), abs=0.02)
    assert all(second >= first for first, second in pairwise(moved[:, 0]))
    assert moved[len(moved) // 2, 0] == pytest.approx(0.25 * moved[-1, 0], abs=0.03)


def test_a_collapse_that_was_followed_stays_in_the_picture():
    case = samples.block()
    steps = [[[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.5 * k, 0.0, 0.0]] for k in range(7)]
    edges = np.array(shaded(case, samples.solved(case, "de-tilt", 0.5, details={"release": {"frames": steps}})))
    moved = (edges - edges[0]) / np.ptp(edges[0])
    np.testing.assert_allclose(moved, 0.5 * np.arange(7)[:, None] * [1.0, 1.0], atol=0.05)


def test_a_ring_encloses_the_arrow_of_a_force_at_the_limit_of_friction():
    case = samples.block()
    result = samples.solved(case, "la", 0.4)
    friction = case.assembly.friction
    result.forces = [(0.5, 0.5, mu) for mu in friction]
    parts = forces_of(case, result)
    rings = [np.ptp(part.points, axis=0)[0] for part in parts if part.role == "ring"]
    widths = [float(part.element.get("stroke-width", "")) for part in parts if part.role == "thrust"]
    assert len(rings) == len(widths) == len(friction)
    assert all(width < ring < 3.0 * width for ring, width in zip(rings, widths, strict=True))


@pytest.mark.parametrize("way", [(1.0, 0.0), (0.6, -0.8), (-1.0, 0.0)])
def test_arrows_of_loads_point_as_the_loads_do_and_stay_shorter_than_blocks(way: tuple[float, float]):
    data = running_bond(3, 2)
    case = wall_case(data, loads={"live": {"body": [{"per_weight": list(way)}]}})
    parts, frame = read(str(inline(wall_drawing(case))))[1], Frame.of(case.assembly)
    shafts = [line for part in parts if part.role == "live shaft" for line in part.lines()]
    assert len(shafts) == case.assembly.n_free
    for line in shafts:
        step = line[-1] - line[0]
        assert step / np.linalg.norm(step) == pytest.approx((way[0], -way[1]), abs=0.02)
        assert np.linalg.norm(step) < frame.block


def test_the_scale_of_lengths_ends_in_upright_strokes():
    parts = read(str(inline(wall_drawing(samples.bond()))))[1]
    (scale,) = (part for part in parts if part.role == "scale")
    bar, *ends = scale.lines()
    assert np.ptp(bar[:, 1]) == 0.0
    assert len(ends) == 2
    for stroke, x in zip(ends, sorted(bar[:, 0]), strict=True):
        assert stroke[:, 0].tolist() == [x, x]
        assert stroke[:, 1].min() < bar[0, 1] < stroke[:, 1].max()


def test_ids_are_shown_on_the_page_for_most_blocks_or_for_none_and_are_no_larger_than_a_head():
    for case in (
        samples.bond(),
        samples.block(),
        wall_case({"type": "ring", "inner_radius": 2.0, "outer_radius": 2.3, "count": 25}),
    ):
        labels = [part for part in read(str(inline(wall_drawing(case))))[1] if part.element.tag == "text"]
        ids = [part for part in labels if part.element.findtext("title", "").startswith("block")]
        shown = [part for part in ids if "fine" not in part.role]
        assert not shown or 2 * len(shown) >= len(ids)
        assert all(float(part.element.get("font-size", "")) <= 170.0 for part in ids)


def test_a_page_draws_in_the_colours_of_its_style_sheet_and_a_file_in_its_own():
    page, file = css(), css(1.0)
    assert "svg .stone { fill: var(--paper); stroke: var(--ink);" in page
    assert f"stroke: {COLOURS['ink']};" in file
    assert "var(" not in file


def test_a_wall_that_has_moved_is_drawn_with_its_holes_and_without_their_cuts():
    """Its stones are those of every drawing: an outline and a hole are two rings."""
    stone = {"id": "stone", "polygon": [[0, 0], [2, 0], [2, 2], [0, 2]]}
    hole = [[0.5, 0.5], [1.5, 0.5], [1.5, 1.5], [0.5, 1.5]]
    ground = {"id": "ground", "polygon": [[0, -1], [3, -1], [3, 0], [0, 0]], "fixed": True}
    blocks = [ground, stone | {"holes": [hole]}]
    wall = drystone.build_wall({"format": "wall/1", "unit_weight": 20, "friction": 0.5, "blocks": blocks})
    places = np.array([[0.0, 0.0, 0.0], [0.5, 0.2, -0.2]])
    ax = settled_figure(wall.assembly, places, (np.array([0.0, 1.0]), np.array([1.0, 0.5])), ("x", "y")).axes[1]
    rings = [len(path.to_polygons()) for drawn in ax.collections for path in drawn.get_paths()]
    assert rings == [1, 2]
    assert ax.patches[:] == []
