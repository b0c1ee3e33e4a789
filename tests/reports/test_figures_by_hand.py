"""Figures for papers against values worked out by hand: sizes, limits, lines, rings, frames."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from PIL import Image

from harness.model.comparison import CaseResults, ComparisonRun
from reports.drawing.display_list import Arrows, Circles, DisplayList, Frame, Lines, Polygons, Text
from reports.drawing.looks import COLOURS, LOOKS
from reports.figures import animate, figures
from reports.figures.domain import domain_figure
from reports.figures.multipliers import multipliers_figure
from reports.figures.plot import plot
from reports.figures.profile import profile_figure
from reports.figures.settling import reaction_figure, settled_figure
from tests.reports import samples

COLUMN, PAGE = 88 / 25.4, 180 / 25.4
"""Widths of a journal's columns [inch]."""


def line_of(figure: Figure, axes: int = 0, line: int = 0) -> list[list[float]]:
    return np.asarray(figure.axes[axes].lines[line].get_xydata(), dtype=float).tolist()


def test_a_drawing_is_a_column_wide_or_a_page_and_as_high_as_it_needs():
    """The paper's block takes 5120 x 3600 units: the axes begin 560 units left of it and 560 above."""
    wall = samples.block().assembly
    page, axes = figures.blank(wall, 1, 1)
    assert page.get_size_inches() == pytest.approx((COLUMN, COLUMN * 3600 / 5120 + 0.28))
    assert axes[0][0].get_xlim() == pytest.approx((-0.14, 1.14))
    assert axes[0][0].get_ylim() == pytest.approx((0.5 - (3600 - 560) / 4000, 0.64))
    assert page.subplotpars.top == pytest.approx(1.0 - 0.22 / page.get_size_inches()[1])
    page, axes = figures.blank(wall, 2, 3, head="a line")
    assert axes.shape == (2, 3)
    assert page.get_size_inches() == pytest.approx((PAGE, 2 * (PAGE / 3 * 3600 / 5120 + 0.28) + 0.34))
    assert page.subplotpars.top == pytest.approx(1.0 - 0.56 / page.get_size_inches()[1])
    head = page.get_suptitle()
    assert head == "a line"
    page, _ = figures.blank(wall, 1, 1, box=(0, 0, 100, 200))
    assert page.get_size_inches()[1] == pytest.approx(COLUMN * 1.6 + 0.28), "no tower is higher than this"
    page, _ = figures.blank(wall, 5, 1, box=(0, 0, 100, 200))
    assert page.get_size_inches()[1] == 9.2, "of a page"


def test_a_long_head_is_broken_at_eighteen_letters_an_inch_and_has_room():
    wall = samples.block().assembly
    most = int(18 * COLUMN)
    for text, shown, above in (("a" * most, "a" * most, 0.56), ("a" * most + " b", "a" * most + "\nb", 0.73)):
        page, _ = figures.blank(wall, 1, 1, head=f"{text}\nshort")
        assert page.get_suptitle() == f"{shown}\nshort"
        assert page.subplotpars.top == pytest.approx(1.0 - above / page.get_size_inches()[1])


def test_the_domain_is_filled_where_it_is_exact_and_shown_with_a_margin():
    square = np.array([[1.0, 0.0], [0.0, 2.0], [-1.0, 0.0], [0.0, -2.0]])
    page = domain_figure(("wind", "thrust"), "head", square, np.empty((0, 2)), exact=True)
    (ax,) = page.axes
    assert ax.get_xlim() == pytest.approx((-1.15, 1.15))
    assert ax.get_ylim() == pytest.approx((-2.3, 2.3))
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_title()) == ("multiplier of wind", "multiplier of thrust", "head")
    assert line_of(page) == [*square.tolist(), square[0].tolist()]
    assert line_of(page, 0, 1) == square.tolist()
    assert line_of(page, 0, 2) == [[0.0, 0.0]]
    (filled,) = ax.patches
    assert isinstance(filled, Polygon)
    page = domain_figure(("a", "b"), "", square, np.empty((0, 2)), exact=False)
    assert (len(page.axes[0].lines), len(page.axes[0].patches)) == (2, 0)
    flat = domain_figure(("a", "b"), "", np.array([[1.0, 0.0], [-2.0, 0.0]]), np.empty((0, 2)), exact=True)
    assert flat.axes[0].get_ylim() == pytest.approx((-2.3, 2.3)), "as high as wide, not of no height"


@pytest.mark.parametrize("turn", [0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
def test_an_unbounded_domain_goes_off_the_page_along_its_open_edges(turn: float):
    """A strip of half-width 1 that begins at 0 and goes on to the right, turned: its edges go on from its corners."""
    way = np.array([np.cos(turn), np.sin(turn)])
    side = np.array([-way[1], way[0]])
    points = np.array([-side, side])
    points = points[np.argsort(np.arctan2(points[:, 1], points[:, 0]))]
    around = 0.3  # the open edges part a little, so that each has a vertex of its own
    ways = np.array([np.cos(around) * way - np.sin(around) * side, np.cos(around) * way + np.sin(around) * side])
    ring = np.array(line_of(domain_figure(("a", "b"), "", points, ways, exact=True)))
    far = 10.0 * np.abs(points).max()
    expected = [points[0], points[1], -side + far * ways[0], side + far * ways[1]]
    assert len(ring) == 5
    assert ring[0].tolist() == ring[-1].tolist()
    for corner in expected:
        assert np.linalg.norm(ring - corner, axis=1).min() < 1e-9
    edges = [frozenset(int(np.argmin(np.linalg.norm(expected - p, axis=1))) for p in pair) for pair in pairwise(ring)]
    own = {int(np.argmin(np.linalg.norm(expected - p, axis=1))) for p in (-side, side)}
    low = next(k for k in own if np.allclose(expected[k], -side))
    high = next(k for k in own if np.allclose(expected[k], side))
    assert set(edges) == {frozenset(own), frozenset((low, 2)), frozenset((2, 3)), frozenset((high, 3))}


def test_reactions_are_drawn_to_half_as_far_again_as_where_they_stay():
    curves = [
        ("first", np.array([0.0, 1.0, 2.0]), np.array([5.0, 3.0, 2.0]), 2.0),
        ("second", np.array([0.0, 1.0]), np.array([6.0, 4.0]), None),
    ]
    page = reaction_figure(curves, (1.0, 7.0), "head")
    assert page.get_size_inches() == pytest.approx((COLUMN, 0.8 * COLUMN))
    assert line_of(page) == [[0.0, 5.0], [1.0, 3.0], [2.0, 2.0], [3.0, 2.0]]
    assert line_of(page, 0, 1) == [[0.0, 6.0], [1.0, 4.0], [3.0, 4.0]]
    assert page.axes[0].get_xlim() == (0.0, 3.0)
    assert [line[0][1] for line in (line_of(page, 0, 2), line_of(page, 0, 3))] == [1.0, 7.0]
    page = reaction_figure([("still", np.array([0.0]), np.array([5.0]), None)], (1.0, 7.0), "head")
    assert page.axes[0].get_xlim() == (0.0, 1.0), "of a support that did not move"


def test_a_settled_wall_stands_where_its_motion_has_carried_it():
    wall = samples.block().assembly
    places = np.array([[0.0, 0.0, 0.0], [0.1, -0.2, 0.0], [0.0, 0.0, np.pi / 2]])
    page = settled_figure(wall, places, (np.array([0.0, 0.5, 1.5]), np.array([3.0, 2.0, 1.0])), ("x", "y"))
    assert page.get_size_inches() == pytest.approx((PAGE, 0.4 * PAGE))
    assert line_of(page) == [[0.0, 3.0], [0.5, 2.0], [1.5, 1.0]]
    assert line_of(page, 0, 1) == [[1.5, 1.0]]
    assert page.axes[1].get_title() == "the wall at 1.5"
    held, free = page.axes[1].collections
    outlines = [path.vertices[:-1] for path in (*held.get_paths(), *free.get_paths())]
    np.testing.assert_allclose(outlines[1], wall.polygons[1] + np.array([0.1, -0.2]), atol=1e-12)
    # A quarter turn about (.5, .25): a corner (x, y) goes to (.5 - (y - .25), .25 + (x - .5)).
    np.testing.assert_allclose(outlines[2], [[0.75, -0.25], [0.75, 0.75], [0.25, 0.75], [0.25, -0.25]], atol=1e-12)
    assert len(held.get_paths()) == 2
    assert not np.allclose(held.get_facecolor(), free.get_facecolor()), "supports are told apart"


def test_a_performance_profile_begins_at_one_and_shows_no_height_below_rounding():
    table = pd.DataFrame(
        {
            "method": ["la", "la", "la", "fe"],
            "correct": [True, True, False, True],
            "cpu_seconds": [1.0, 2.0, 3.0, 4.0],
            "above_least": [0.0, 0.25, 0.5, np.nan],
        }
    )
    page = profile_figure({"la": ([1.0, 3.0], [0.5, 1.0]), "fe": ([2.0], [0.25])}, table)
    assert page.get_size_inches() == pytest.approx((PAGE, 0.45 * PAGE))
    assert line_of(page) == [[1.0, 0.0], [1.0, 0.5], [3.0, 1.0], [6.0, 1.0]]
    assert line_of(page, 0, 1) == [[1.0, 0.0], [2.0, 0.25], [6.0, 0.25]]
    assert line_of(page, 1) == [[1.0, 1e-12], [2.0, 0.25]]
    assert page.axes[0].get_ylim()[0] == 0.0
    assert 1.0 < page.axes[0].get_ylim()[1] < 1.1


def test_marks_of_methods_stand_beside_each_other_about_the_row_of_their_wall():
    """Of three methods, a fifth of a row below, on and above it; a bracket is a bar at the height of its mark."""
    case = samples.bond("a")
    bracket = samples.solved(case, "de", 0.45, bracket=(0.4, 0.5), flow="approximate")
    doubted = samples.solved(case, "la", 0.4)
    doubted.judge = doubted.judge.model_copy(update={"accepted": False})
    run = ComparisonRun("t", "", "", [CaseResults(case, [samples.solved(case, "fe", 0.5), doubted, bracket])] * 2)
    page = multipliers_figure(run)
    assert page.get_size_inches() == pytest.approx((COLUMN, 0.9 + 0.32 * 2))
    assert page.axes[0].get_ylim() == (1.6, -0.6), "the first wall on top"
    marks = {}
    for line in page.axes[0].lines:
        if len(line.get_xydata()):
            marks.setdefault(tuple(np.ravel(line.get_xdata())), []).append((np.ravel(line.get_ydata()).tolist(), line))
    assert set(marks) == {(0.5,), (0.4,), (0.45,), (0.4, 0.5)}
    for x, shift in (((0.5,), -0.2), ((0.4,), 0.0), ((0.45,), 0.2), ((0.4, 0.5), 0.2)):
        heights = [y for y, _ in marks[x]]
        np.testing.assert_allclose(heights, [[row + shift] * len(x) for row in (0, 1)], atol=1e-9)
    hollow = {x: line.get_markerfacecolor() == "none" for x, ((_, line), _) in marks.items() if len(x) == 1}
    assert hollow == {(0.5,): False, (0.4,): True, (0.45,): False}
    tall = multipliers_figure(ComparisonRun("t", "", "", run.cases * 20))
    assert tall.get_size_inches()[1] == 9.2


def shown(*parts: Polygons | Lines | Circles | Arrows | Text) -> Figure:
    """Parts over the paper's block on a page where a point is 20 units: 5120 units are 256 points."""
    frame = Frame.of(samples.block().assembly)
    page = Figure(figsize=(256 / 72, 180 / 72))
    ax = page.add_axes((0, 0, 1, 1))
    ax.set_xlim(-0.14, 1.14)
    ax.set_ylim(-0.26, 0.64)
    plot(ax, DisplayList(frame, "", list(parts)))
    return page


def test_lines_are_as_wide_on_paper_as_their_units_say_and_never_too_thin_to_print():
    line = (np.array([[0.0, 0.0], [4000.0, 2000.0]]),)
    parts = [Lines("joint", line), Lines("slide", line, 40.0, 60.0), Lines("slide", line, 1.0), Lines("dead", line)]
    drawn = [item for item in shown(*parts).axes[0].collections if isinstance(item, LineCollection)]
    assert [item.get_linewidths()[0] for item in drawn] == pytest.approx([0.8, 2.0, 0.3, 0.6])
    for item in drawn:
        np.testing.assert_allclose(item.get_segments(), [[[0.0, 0.5], [1.0, 0.0]]])
    assert tuple(drawn[0].get_colors()[0]) == to_rgba(COLOURS[LOOKS["joint"].stroke])
    # Dashes on paper: 60 units are 3 points, and a dash of a load is 30 units with gaps of 18.
    assert [tuple(item.get_linestyle()[0][1] or ()) for item in drawn] == [(), (3.0, 3.0), (), (1.5, 0.9)]
    assert [item.get_zorder() for item in drawn] == sorted({item.get_zorder() for item in drawn}), "in their order"


def test_outlines_circles_and_arrows_are_drawn_in_the_lengths_of_the_wall():
    square = np.array([[0.0, 0.0], [400.0, 0.0], [400.0, 400.0], [0.0, 400.0]])
    arrow = Arrows("live", np.array([[0.0, 0.0]]), np.array([[400.0, 0.0]]), np.array([100.0]))
    page = shown(Polygons("held", (square,)), Circles("hinge", np.array([[2000.0, 1000.0]]), 200.0), arrow)
    (filled,) = (item for item in page.axes[0].collections if isinstance(item, PathCollection))
    np.testing.assert_allclose(filled.get_paths()[0].vertices, [[0, 0.5], [0.1, 0.5], [0.1, 0.4], [0, 0.4], [0, 0.5]])
    assert filled.get_hatch() == "/////"
    circle, head = (item for item in page.axes[0].collections if isinstance(item, PolyCollection))
    places = np.asarray(circle.get_paths()[0].vertices) - [0.5, 0.25]
    np.testing.assert_allclose(np.hypot(*places.T), 0.05)
    assert len(places) > 20
    np.testing.assert_allclose(head.get_paths()[0].vertices[:3], [[0.1, 0.5], [0.075, 0.49], [0.075, 0.51]])
    (shaft,) = (item for item in page.axes[0].collections if isinstance(item, LineCollection))
    np.testing.assert_allclose(shaft.get_segments(), [[[0.0, 0.5], [0.075, 0.5]]])


def test_contact_points_are_dots_and_letters_are_large_enough_to_read():
    page = shown(
        Lines("contact", (np.array([[2000.0, 2000.0]] * 2),)),
        Text("", (1000.0, 500.0), "large", 200.0, "start"),
        Text("", (1000.0, 500.0), "small", 20.0, "end"),
    )
    (dot,) = (item for item in page.axes[0].collections if isinstance(item, PolyCollection))
    np.testing.assert_allclose(np.hypot(*(np.asarray(dot.get_paths()[0].vertices) - [0.5, 0.0]).T), 21.0 / 4000)
    large, small = page.axes[0].texts
    assert (large.get_position(), large.get_fontsize(), large.get_ha()) == ((0.25, 0.375), 10.0, "left")
    assert (small.get_fontsize(), small.get_ha()) == (4.5, "right")


def test_an_animation_shows_all_places_of_its_blocks_with_room_around_them():
    wall = samples.block().assembly
    still = animate._box(wall, [list(wall.polygons)])
    assert still == Frame.of(wall).box
    moved = [polygon + np.array([0.5, 0.25]) for polygon in wall.polygons]
    far = [polygon - [0.25, 0.5] for polygon in wall.polygons]
    left, top, wide, high = animate._box(wall, [moved, far])
    assert (left, top) == pytest.approx((-1000 - 60, -1000 - 60))
    assert (left + wide, top + high) == pytest.approx((6000 + 60, 4800 + 60))


def test_frames_gather_speed_up_to_twice_the_displacement_that_the_report_draws():
    case = samples.block()
    scales: list[float] = []
    result = samples.solved(case, "la", 0.4)
    drawn = animate.moved_wall
    try:
        animate.moved_wall = lambda wall, answer, scale: (scales.append(scale), drawn(wall, answer, scale))[1]  # type: ignore[assignment]
        pictures = animate.frames(case, result)
    finally:
        animate.moved_wall = drawn
    np.testing.assert_allclose(scales, 0.25 * np.linspace(0.0, 1.0, 28) ** 2)
    assert len(pictures) == 28
    assert pictures[0].size[0] == pytest.approx(160 * COLUMN, abs=1)


def test_an_animation_stands_still_at_both_ends_and_runs_at_seventeen_frames_a_second(tmp_path: Path):
    case = samples.block()
    steps = [[[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.5 * k, 0.0, 0.0]] for k in range(4)]
    result = samples.solved(case, "de-tilt", 0.5, details={"release": {"frames": steps}})
    animate.animate(case, result, tmp_path / "a.gif")
    durations = []
    with Image.open(tmp_path / "a.gif") as image:
        for frame in range(image.n_frames):
            image.seek(frame)
            durations.append(image.info["duration"])
    assert durations == [900, 60, 60, 900]  # milliseconds
