"""Drawings against the wall: what a reader measures on them, whatever made them."""

from __future__ import annotations

import re
from itertools import pairwise

import matplotlib as mpl
import numpy as np
import pytest
import shapely
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

from cases.start import stack as column
from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.inspection import inspect
from reports import drawing
from reports.drawing import Frame, figures
from reports.drawing.animate import frames
from reports.drawing.force_drawing import forces_svg
from reports.drawing.wall_check_figure import inspected_figure
from reports.geometry import shapes, thrust_lines
from reports.page import build
from tests.reports import samples
from tests.reports.read_chart import NUMBER, points_of
from tests.walls import case as wall_case
from tests.walls import running_bond, stack

DIGIT = 0.55
"""Width of a letter in its size, about."""


def drawings_of(text: str) -> list[tuple[np.ndarray, np.ndarray]]:
    """The window (left, top, width, height) and every corner (k, 2) of each drawing of a wall in a page."""
    made = []
    for svg in re.findall(r'<svg class="wall".*?</svg>', text, re.S):
        window = np.array([float(x) for x in re.findall(NUMBER, re.search(r'viewBox="([^"]*)"', svg)[1])])  # type: ignore[index]
        made.append((window, np.concatenate([points_of(path) for path in re.findall(r' d="([^"]+)"', svg)])))
    return made


@pytest.mark.parametrize("pattern", [running_bond(6, 2), stack(5), running_bond(2, 9)])
def test_all_that_is_drawn_of_a_wall_lies_in_its_window_and_fills_it(pattern: dict[str, object]):
    case = wall_case(pattern)
    results = [samples.solved(case, "la", 0.4, turn=0.3), samples.solved(case, "fe", 0.5)]
    page = build.render(ComparisonRun("one", "", "", [CaseResults(case, results)]), data_folder="x")
    made = drawings_of(page)
    assert len(made) >= 5, "the wall, the opening, and mechanisms and forces without a script"
    for window, corners in made:
        low, size = window[:2], window[2:]
        assert (corners >= low).all()
        assert (corners <= low + size).all()
        assert (np.ptp(corners, axis=0) / size).max() > 0.7


def test_lines_of_forces_end_in_their_heads_and_are_as_wide_as_the_forces_are_large():
    case = samples.bond(courses=4, bricks=3)
    result = samples.solved(case, "la", 0.5)
    found = shapes.thrusts(case.assembly, np.asarray(result.forces), smallest=thrust_lines.STYLE.smallest)
    drawn = forces_svg(case, result)
    heads = [points_of(path) for data in re.findall(r'class="tip-of" d="([^"]*)"', drawn) for path in data.split("z")]
    triangles = shapely.union_all([shapely.Polygon(head).buffer(1.5) for head in heads if len(head) == 3])
    frame = Frame(case.assembly)
    tails = {
        frame.place(end): size
        for end, size in zip(thrust_lines.drawn_ends(case.assembly, found)[:, 0], found.size, strict=True)
    }
    lines = [
        (float(width), points_of(line))
        for width, data in re.findall(r'<path stroke-width="(\d+)" d="(M[^h"]*)"/>', drawn)
        for line in re.findall(r"M[^M]*", data)
    ]
    assert len(lines) == len(found.size) > 10
    widest = max(width for width, _ in lines)
    for width, line in lines:
        assert triangles.contains(shapely.Point(line[1]))
        share = tails[round(line[0, 0]), round(line[0, 1])] / found.size.max()
        assert share - 0.01 <= width / widest <= max(share + 1.0 / 12.0, 0.15) + 0.01  # in twelfths, and whole units


def test_the_scales_of_lengths_and_forces_stand_beside_each_other():
    case = samples.bond()
    drawn = forces_svg(case, samples.solved(case, "la", 0.5))
    (length,) = re.findall(r'<g class="scale">.*?</g>', drawn)
    (force,) = re.findall(r'<g class="forces-scale">.*?</g>', drawn)
    place, size, text = re.search(r'<text x="(\d+)"[^>]*font-size="(\d+)"[^>]*>([^<]*)<', length).groups()  # type: ignore[union-attr]
    ends = points_of(re.search(r' d="([^"]+)"', force)[1])  # type: ignore[index]
    assert ends[:, 0].min() > float(place) + DIGIT * float(size) * len(text)
    right = Frame(case.assembly).place(case.assembly.corners[0].max(axis=0))[0]
    assert ends[:, 0].max() == pytest.approx(right, abs=1)


@pytest.mark.parametrize("width", [0.02, 0.05, 5.0])
def test_names_of_blocks_fit_into_upright_blocks(width: float):
    case = wall_case({"type": "stack", "width": width, "height": 20.0 * width, "count": 2})
    page = build.render(ComparisonRun("one", "", "", [CaseResults(case, [])]), data_folder="x")
    wall = re.search(r'<svg class="wall".*?</svg>', page, re.S)[0]  # type: ignore[index]
    scale = Frame(case.assembly).scale
    labels = re.findall(r'<text x="-?\d+" y="-?\d+" font-size="(\d+)">([^<]*)<title>block', wall)
    for size, label in labels:
        assert DIGIT * float(size) * len(label) < 1.25 * width * scale


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_forces_left_out_of_drawings_are_small_beside_the_largest_in_any_unit(unit: float):
    assembly = samples.bond().assembly
    forces = np.ones((assembly.n_interfaces, 3))
    forces[0] = 1e-4
    found = shapes.thrusts(assembly, unit * forces, smallest=1e-3)
    assert found.interface.tolist() == list(range(1, assembly.n_interfaces))


def cut(run: ComparisonRun, budget: int) -> list[str]:
    return drawing.fields_drawn(run, budget)


def test_forces_go_before_mechanisms_and_no_more_goes_than_has_to():
    run = samples.large(cases=3, methods=2)
    geometry, mechanisms, forces = zip(*(drawing._sizes(item) for item in run.cases), strict=True)
    whole = sum(geometry) + sum(mechanisms) + sum(forces)
    order = sorted(range(3), key=lambda k: -(geometry[k] + mechanisms[k] + forces[k]))
    budget, levels = whole, ["all"] * 3
    assert cut(run, budget) == levels
    for level, saved in (("mechanism", forces), ("none", [a + b for a, b in zip(geometry, mechanisms, strict=True)])):
        for k in order:
            levels[k] = level
            assert cut(run, budget - 1) == levels
            budget -= saved[k]
            assert cut(run, budget) == levels
    assert budget == 0


def test_what_a_result_does_not_have_is_not_drawn():
    case = samples.bond("mine")
    whole = samples.solved(case, "la", 0.5)
    for without, kind in (("forces", "mechanism"), ("mechanism", "forces")):
        item = CaseResults(case, [whole.model_copy(update={without: None})])
        page = build.render(ComparisonRun("one", "", "", [item]), data_folder="x")
        assert re.findall(r'data-kind="(\w+)"', page.split("<script")[0]) == [kind]


def texts_of(page: Figure) -> list[tuple[Text, tuple[float, float, float, float]]]:
    """Texts of a figure that are seen, with their boxes in pixels."""
    canvas = FigureCanvasAgg(page)
    canvas.draw()
    shown = [text for text in page.findobj(Text) if text.get_visible() and text.get_text().strip()]
    return [(text, text.get_window_extent(canvas.get_renderer()).extents) for text in shown]


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
    bars = [line.get_xydata() for line in ax.lines if len(line.get_xydata()) == 2]
    assert len(bars) >= (1 if kind == "mechanism" else 2)
    assert all(window.contains(shapely.LineString(bar)) for bar in bars)
    below = min(polygon[:, 1].min() for polygon in case.assembly.polygons)
    assert all(np.asarray(bar)[:, 1].max() < below for bar in bars), "the wall covers no scale"


def test_ids_fit_into_blocks_and_dimensions_onto_the_sheet_that_is_shown():
    looked = inspect(column(3, width=0.05, height=0.4))
    page = inspected_figure(looked, dimensions=True)
    ax = page.axes[0]
    for note in ax.texts:
        if note.get_text() == "":  # an arrow of a line of dimension
            for x, y in (note.xy, note.xyann):
                assert ax.get_xlim()[0] < x < ax.get_xlim()[1]
                assert ax.get_ylim()[0] < y < ax.get_ylim()[1]
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


def test_an_animation_ends_at_twice_the_displacement_of_the_report_and_gathers_speed():
    case = samples.block()
    result = samples.solved(case, "la", 0.4)
    colour = np.array([int("#dfe8f1"[k : k + 2], 16) for k in (1, 3, 5)])
    seen = []  # left and right edge of the block; the right one may leave the picture
    for image in frames(case, result):
        shaded = (np.abs(np.asarray(image, dtype=int) - colour).max(axis=2) < 3).any(axis=0)
        seen.append(np.flatnonzero(shaded)[[0, -1]])
    moved = np.array([float(left - seen[0][0]) for left, _ in seen]) / float(np.ptp(seen[0]))  # the block is 1 wide
    assert moved[-1] == pytest.approx(2.0 * shapes.amplitude(case.assembly, np.asarray(result.mechanism)), abs=0.02)
    assert all(second >= first for first, second in pairwise(moved))
    assert moved[len(moved) // 2] == pytest.approx(0.25 * moved[-1], abs=0.03)
