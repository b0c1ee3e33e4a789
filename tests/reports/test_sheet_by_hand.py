"""The figure of `drystone show` against numbers worked out by hand: page, axes, letters, dimensions, marks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.text import Annotation, Text

from harness.model.inspection import FaultMark, Inspection, inspect
from harness.model.reading import parse_wall
from reports.drawing.looks import COLOURS, LOOKS
from reports.figures.figures import PAGE
from reports.figures.wall_check_figure import Sheet, inspected_figure

BRICK = "brick-on-edge"


def looked() -> Inspection:
    """A ground of 2 x .5 m, a stone of 1.5 x .5 m and a slender brick of .1 x .4 m: 2 x 1 m in all, from (1, 3) on."""
    data = {
        "format": "wall/1",
        "units": {"length": "m", "force": "kN"},
        "unit_weight": 20.0,
        "friction": 0.6,
        "blocks": [
            {"id": "ground", "polygon": [[1, 3], [3, 3], [3, 3.5], [1, 3.5]], "fixed": True},
            {"id": "stone", "polygon": [[1, 3.5], [2.5, 3.5], [2.5, 4], [1, 4]]},
            {"id": BRICK, "polygon": [[2.7, 3.5], [2.8, 3.5], [2.8, 3.9], [2.7, 3.9]]},
        ],
        "loads": {"live": {"body": [{"per_weight": [1.0, 0.0]}]}},
    }
    return inspect(parse_wall(data, "wall.json"))


def texts(page: Figure) -> dict[str, Text]:
    """The texts of the axes by their words."""
    return {text.get_text(): text for text in page.axes[0].texts}


MARGIN = 0.09 * 2.0
FOOT = 0.35
TALL = PAGE * (1.0 + 2 * MARGIN) / (2.0 + 2 * MARGIN)
POINT = (2.0 + 2 * MARGIN) / (72 * 0.9 * PAGE)
"""Metres that a point of the page shows: the axes take nine tenths of its width."""


def test_the_sheet_is_a_page_wide_and_shows_the_wall_with_a_margin():
    page = inspected_figure(looked())
    (ax,) = page.axes
    assert page.get_size_inches() == pytest.approx((PAGE, TALL + FOOT))
    assert ax.get_position(original=True).bounds == pytest.approx(
        (0.08, FOOT / (TALL + FOOT), 0.9, TALL / (TALL + FOOT))
    )
    assert ax.get_xlim() == pytest.approx((1.0 - MARGIN, 3.0 + MARGIN))
    assert ax.get_ylim() == pytest.approx((3.0 - MARGIN, 4.0 + MARGIN))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [m]", "y [m]")
    assert {side for side, line in ax.spines.items() if line.get_visible()} == {"left", "bottom"}


def test_ids_stand_in_the_middle_of_their_blocks_as_large_as_these_allow():
    found = texts(inspected_figure(looked()))
    assert {"ground", "stone", BRICK} <= set(found)
    assert found["stone"].get_position() == pytest.approx((1.75, 3.75))
    assert found["ground"].get_position() == pytest.approx((2.0, 3.25))
    assert found[BRICK].get_position() == pytest.approx((2.75, 3.7))
    assert found["stone"].get_fontsize() == found["ground"].get_fontsize() == 6.0
    assert found[BRICK].get_fontsize() == pytest.approx(0.9 * (0.1 / POINT) / (0.62 * len(BRICK)))
    low = inspected_figure(looked(), sheet=Sheet(text=60.0))
    assert texts(low)["stone"].get_fontsize() == pytest.approx(0.5 * (0.5 / POINT) / 1.3), "half of its height"
    assert BRICK not in texts(inspected_figure(looked(), sheet=Sheet(least=0.9 * (0.1 / POINT) / (0.62 * 13) + 0.01)))


def test_dimensions_are_those_of_the_wall_and_of_its_blocks():
    page = inspected_figure(looked(), dimensions=True)
    found = texts(page)
    assert {"ground\n2 x 0.5", "stone\n1.5 x 0.5", f"{BRICK}\n0.1 x 0.4"} <= set(found)
    assert found["stone\n1.5 x 0.5"].get_va() == "center"
    large = texts(inspected_figure(looked(), dimensions=True, sheet=Sheet(text=60.0)))
    assert large["ground\n2 x 0.5"].get_fontsize() == pytest.approx(0.8 * (0.5 / POINT) / (1.7 * 2))
    assert found["2"].get_position() == pytest.approx((2.0, 4.0 + 0.6 * MARGIN))
    assert found["1"].get_position() == pytest.approx((3.0 + 0.6 * MARGIN, 3.5))
    assert found["1"].get_rotation() == 90.0
    heads = [item for item in page.axes[0].collections if isinstance(item, PolyCollection)][-1]
    tips = sorted((round(x, 6), round(y, 6)) for x, y in (path.vertices[0] for path in heads.get_paths()))
    beside, above = round(3.0 + 0.6 * MARGIN, 6), round(4.0 + 0.6 * MARGIN, 6)
    assert tips == [(1.0, above), (3.0, above), (beside, 3.0), (beside, 4.0)], "of the lines of dimension"


@pytest.mark.parametrize("turn", [0.5, -0.4, 2.0])
def test_length_and_height_of_a_turned_block_are_its_sides(turn: float):
    """The side that lies flatter is the length."""
    corners = np.array([[0.0, 0.0], [1.25, 0.0], [1.25, 0.5], [0.0, 0.5]])
    way = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    wall = looked()
    turned = replace(wall, outlines=(wall.outlines[0], corners @ way + [0.0, 3.5], wall.outlines[2]), built=None)
    words = [text for text in texts(inspected_figure(turned, dimensions=True)) if text.startswith("stone")]
    assert words == ["stone\n1.25 x 0.5" if abs(np.cos(turn)) > abs(np.sin(turn)) else "stone\n0.5 x 1.25"]


def test_letters_of_a_bent_block_stand_within_it():
    wall = looked()
    angle = np.array([[0.0, 3.5], [1.0, 3.5], [1.0, 4.5], [0.9, 4.5], [0.9, 3.6], [0.0, 3.6]])
    x, y = texts(inspected_figure(replace(wall, outlines=(wall.outlines[0], angle, wall.outlines[2]), built=None)))[
        "stone"
    ].get_position()
    assert 0.0 < x < 1.0
    assert 3.5 < y < 4.5
    assert x > 0.9 or y < 3.6


def test_an_outline_without_an_area_has_its_name_in_its_middle():
    wall = looked()
    line = np.array([[0.0, 3.5], [1.0, 4.0], [0.5, 3.75]])
    flat = replace(wall, outlines=(wall.outlines[0], line, wall.outlines[2]), built=None)
    assert texts(inspected_figure(flat))["stone"].get_position() == pytest.approx((0.5, 3.75))


def test_the_scale_below_the_wall_is_a_quarter_of_its_width_at_most_in_round_metres():
    page = inspected_figure(looked())
    (bar,) = (line for line in page.axes[0].lines if len(np.asarray(line.get_xdata())) == 2)
    assert np.asarray(bar.get_xdata()) == pytest.approx([1.0, 1.5])
    assert np.asarray(bar.get_ydata()) == pytest.approx([3.0 - 0.6 * MARGIN] * 2)
    said = texts(page)["  0.5 m"]
    assert said.get_position() == pytest.approx((1.5, 3.0 - 0.6 * MARGIN))


def test_a_tower_stays_on_the_page_and_its_letters_in_its_blocks():
    """Blocks .5 m wide in a tower of 10 m: the drawing is 1.4 times as high as the page is wide."""
    wall = looked()
    tower = tuple(np.array([[0, y], [0.5, y], [0.5, y + top], [0, y + top]]) for y, top in ((0, 1), (1, 4), (5, 5)))
    page = inspected_figure(replace(wall, outlines=tower, built=None), sheet=Sheet(text=60.0))
    assert page.get_size_inches()[1] == pytest.approx(1.4 * PAGE + FOOT)
    height = 10.0 + 2 * 0.9
    assert texts(page)["stone"].get_fontsize() == pytest.approx(0.9 * 0.5 / (height / (72 * 1.4 * PAGE)) / (0.62 * 5))


def test_marks_stand_at_their_places_in_their_colours_and_in_the_list():
    """Sixteen marks: the first two at one place, the last nowhere; fourteen are told, one of them in two lines."""
    at, other = (0.5, 3.5), (0.0, 3.25)
    marks = [
        FaultMark("doubt", "", "gap", at=at),
        FaultMark("fault", "", "word " * 40, at=at),
        *(FaultMark("fault", "", f"number {k}", blocks=("ground",), at=other) for k in range(3, 16)),
        FaultMark("fault", "", "nowhere"),
    ]
    page = inspected_figure(replace(looked(), marks=tuple(marks)))
    tags = {text.get_text(): text for text in page.axes[0].texts if isinstance(text, Annotation)}
    assert set(tags) == {"1, 2", ", ".join(str(k) for k in range(3, 16))}
    assert tags["1, 2"].xy == at
    for name, tint in (("1, 2", "doubt"), (", ".join(str(k) for k in range(3, 16)), "fault")):
        box = tags[name].get_bbox_patch()
        assert box is not None
        assert box.get_facecolor() == to_rgba(COLOURS[LOOKS[tint].stroke])
    crosses = [line for line in page.axes[0].lines if line.get_marker() == "x"]
    assert sorted(tuple(np.ravel(line.get_xydata())) for line in crosses) == [other, at]
    (told,) = page.texts
    lines = told.get_text().split("\n")
    assert len(lines) == 16
    assert lines[1].startswith("2. fault: word")
    assert lines[2].startswith("     word")
    assert max(map(len, lines)) <= 150
    assert lines[-1].startswith("and 2 more:")
    height = TALL + FOOT + 1.35 * 6.0 / 72 * 16
    assert page.get_size_inches()[1] == pytest.approx(height)
    assert told.get_position() == pytest.approx((0.02, 0.1 * 6.0 / 72 / height))
    whole = inspected_figure(replace(looked(), marks=tuple(marks[2:])))
    assert len(whole.texts[0].get_text().split("\n")) == 14, "none is left out"
    tinted = [item.get_facecolor()[0] for item in page.axes[0].collections[:1]]
    assert tuple(tinted[0])[:3] == to_rgba(COLOURS["faulty"])[:3], "the ground is concerned"
