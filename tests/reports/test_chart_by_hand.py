"""A whole line chart against coordinates worked out by hand, in units of which it is 560 wide."""

from __future__ import annotations

import math
import re
from xml.etree import ElementTree as ET

import pytest

from reports.charts import charts
from reports.charts.styles import SHAPES, Mark
from tests.reports.read_chart import points_of

LEFT, RIGHT = 72.0, 546.0
"""Ends of the axis across."""


def drawn(chart: charts.Chart) -> ET.Element:
    return ET.fromstring(str(charts.svg(chart)))


def texts(root: ET.Element) -> dict[str, tuple[float, float, str]]:
    """Place and class of each text."""
    return {e.text or "": (float(e.get("x", "")), float(e.get("y", "")), e.get("class", "")) for e in root.iter("text")}


def of_class(root: ET.Element, name: str) -> list[ET.Element]:
    return [e for e in root.iter("path") if (e.get("class") or "").split()[0] == name]


def placed(element: ET.Element) -> list[float]:
    """Shift and factor of a mark."""
    return [float(x) for x in re.findall(r"[\d.]+", element.get("transform", ""))]


def test_a_chart_of_one_series():
    """From 0 to 10 across and 0 to 1 up, with .06 of that as room: 42.32 units a unit across, 241.07 up."""
    root = drawn(charts.Chart("title", "across", "up", [charts.Series("a", [0.0, 5.0, 10.0], [0.0, 1.0, 0.5])]))
    assert (root.get("viewBox"), root.get("aria-label")) == ("0 0 560 354", "title")
    across, up = 474.0 / 11.2, 270.0 / 1.12

    def at(x: float, y: float) -> tuple[float, float]:
        return LEFT + (x + 0.6) * across, 308.0 - (y + 0.06) * up

    (line,) = of_class(root, "line")
    assert points_of(line.get("d", "").replace("L", " L")).ravel().tolist() == pytest.approx(
        [*at(0, 0), *at(5, 1), *at(10, 0.5)], abs=0.051
    )
    marks = of_class(root, "mark")
    assert [placed(mark) for mark in marks] == [
        pytest.approx([*at(x, y), 1.35], abs=0.051) for x, y in ((0, 0), (5, 1), (10, 0.5))
    ]
    assert [mark.findtext("title") for mark in marks] == ["a: 0, 0", "a: 5, 1", "a: 10, 0.5"]
    found = texts(root)
    below = [(float(e.get("x", "")), e.text) for e in root.iter("text") if e.get("class") == "mid"]
    assert [text for _, text in below] == ["0", "2.5", "5", "7.5", "10"]
    assert [x for x, _ in below] == pytest.approx([at(float(text or ""), 0)[0] for _, text in below], abs=0.051)
    assert {e.get("y") for e in root.iter("text") if e.get("class") == "mid"} == {"324"}
    for value in (0.25, 0.5, 0.75):
        x, y, side = found[f"{value:g}"]
        assert (x, side) == (65.0, "end")
        assert y == pytest.approx(at(0, value)[1] + 4.0, abs=0.051)
    assert found["across"] == (309.0, 346.0, "mid axis")
    assert found["up"] == (4.0, 26.0, "axis")
    (frame,) = of_class(root, "frame")
    assert frame.get("d") == "M72 38V308H546"
    (grid,) = of_class(root, "grid")
    assert len(re.findall("V308", grid.get("d", ""))) == 5
    assert len(re.findall("H546", grid.get("d", ""))) == 5


def test_names_stand_in_rows_of_three_at_most_with_a_sample_before_each():
    names = ["a", "b", "c", "d"]
    series = [charts.Series(name, [0.0, 1.0], [0.0, 1.0]) for name in names]
    root = drawn(charts.Chart("t", "x", "y", series))
    assert root.get("viewBox") == "0 0 560 394", "two rows of 20"
    found = texts(root)
    for number, name in enumerate(names):
        column, row = number % 3, number // 3
        assert found[name][:2] == (72.0 + 158.0 * column + 32.0, 14.0 + 20.0 * row - 2.0 + 4.0)
    samples = [e.get("d") for e in of_class(root, "line") if "h26" in e.get("d", "")]
    assert samples == ["M72 12h26", "M230 12h26", "M388 12h26", "M72 32h26"]
    marks = [placed(e) for e in of_class(root, "mark") if len(placed(e)) == 2]
    assert marks == [[85.0, 12.0], [243.0, 12.0], [401.0, 12.0], [85.0, 32.0]]
    sizes = {placed(e)[2] for e in of_class(root, "mark") if len(placed(e)) == 3}
    assert sizes == {1.35, 1.2, 1.05, 1.0}, "later ones smaller, so that points on one place show as rings"
    long = [charts.Series("a name of 23 letters ...", [0.0, 1.0], [0.0, 1.0]) for _ in range(4)]
    root = drawn(charts.Chart("t", "x", "y", long))
    assert root.get("viewBox") == f"0 0 560 {330 + 4 * 20 + 24}", "294 units each: one beside the other has no room"
    assert charts.Chart("t", "x", "y", [charts.Series("n" * 18, [], [])]).per_row == 2
    assert charts.Chart("t", "x", "y", [charts.Series("n" * 99, [], [])]).per_row == 1


def test_bars_of_several_series_stand_beside_each_other_with_their_points():
    series = [charts.Series(n, [1.0, 2.0], [0.5, 0.5], [0.0, 0.25], [1.0, 0.75]) for n in "ab"]
    series.insert(1, charts.Series("c", [1.0, 2.0], [0.5, 0.5]))
    chart = charts.Chart("t", "x", "y", series)
    assert [chart.aside(k) for k in range(3)] == [-3.5, 0.0, 3.5]
    root = drawn(chart)
    bars = [points_of(e.get("d", "")) for e in of_class(root, "bar")]
    plot = charts.Plot.of(chart)
    expected = [
        (plot.across.place(x) + aside, plot.up.place(low), plot.up.place(high))  # type: ignore[operator]
        for aside in (-3.5, 3.5)
        for x, low, high in ((1.0, 0.0, 1.0), (2.0, 0.25, 0.75))
    ]
    assert len(bars) == 4
    assert [re.findall(r"[\d.]+", e.get("d", "")) for e in of_class(root, "bar")] == [
        [f"{value:.1f}" for value in entry] for entry in expected
    ]
    marks = [placed(e)[0] for e in of_class(root, "mark") if len(placed(e)) == 3]
    one, two = plot.across.place(1.0) or 0.0, plot.across.place(2.0) or 0.0
    assert marks == pytest.approx([one - 3.5, two - 3.5, one, two, one + 3.5, two + 3.5], abs=0.051)


def test_a_fitted_curve_has_its_band_and_its_points_have_no_bars():
    x = [1.0, 2.0, 3.0]
    series = charts.Series("a", x, [0.2, 0.4, 0.9], [0.1, 0.3, 0.7], [0.4, 0.6, 1.0], curve=[0.25, 0.45, 0.85])
    chart = charts.Chart("t", "x", "y", [series])
    root, plot = drawn(chart), charts.Plot.of(chart)

    def at(value: float, y: float) -> str:
        return f"{plot.across.place(value):.1f} {plot.up.place(y):.1f}"

    (band,), (line,) = of_class(root, "band"), of_class(root, "line")
    low = [at(*pair) for pair in zip(x, series.low, strict=True)]
    high = [at(*pair) for pair in zip(x, series.high, strict=True)]
    assert band.get("d") == f"M{'L'.join([*low, *reversed(high)])}Z"
    assert line.get("d") == f"M{'L'.join(at(*pair) for pair in zip(x, series.curve, strict=True))}"
    assert of_class(root, "bar") == []
    assert len(of_class(root, "mark")) == 3


def test_names_of_levels_stand_above_their_lines_at_either_end_and_below_where_both_are_taken():
    """Ten to one is 24.1 units for a tenth: of four levels .02 apart the third goes below the first."""
    levels = [("one", 0.50), ("two", 0.49), ("three", 0.48), ("far", 0.9)]
    chart = charts.Chart("t", "x", "y", [charts.Series("a", [0.0, 1.0], [0.0, 1.0])], levels=levels)
    root, plot = drawn(chart), charts.Plot.of(chart)
    found = texts(root)
    heights = {name: plot.up.place(value) or 0.0 for name, value in levels}
    assert found["far"][:2] == (78.0, pytest.approx(heights["far"] - 4.0, abs=0.051))
    assert found["one"][:2] == (78.0, pytest.approx(heights["one"] - 4.0, abs=0.051))
    assert found["two"][:2] == (542.0, pytest.approx(heights["two"] - 4.0, abs=0.051))
    assert found["three"][0] == 78.0
    assert found["three"][1] == pytest.approx(heights["one"] - 4.0 + 19.0, abs=0.051), "a line further down"
    lines = [e.get("d") for e in of_class(root, "level")]
    assert sorted(lines) == sorted(f"M72 {height:.1f}H546" for height in heights.values())


@pytest.mark.parametrize(
    ("low", "high", "found"),
    [
        (0.0, 1.0, [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]),
        (0.0, 12.0, [0.0, 2.5, 5.0, 7.5, 10.0]),
        (-3.0, 18.0, [0.0, 5.0, 10.0, 15.0]),
        (0.0, 45.0, [0.0, 10.0, 20.0, 30.0, 40.0]),
        (0.31, 0.39, [0.32, 0.34, 0.36, 0.38]),
        (2.0, 2.0, [2.0]),
    ],
)
def test_ticks_are_round_and_about_five(low: float, high: float, found: list[float]):
    assert charts.ticks(low, high) == pytest.approx(found)


def test_texts_of_ticks_tell_one_from_the_next():
    near = charts.Axis([1.00001, 1.00005], 0.0, 1.0, log=False)
    assert len({near.text(value) for value in near.ticks}) == len(near.ticks) > 2
    assert charts.Axis([0.5, 2.0], 0.0, 1.0, log=True).text(0.5) == "0.5"
    assert charts.Axis([1e-3, 1e4], 0.0, 1.0, log=True).text(1e-3) == "10⁻³"
    wide = charts.Axis([-0.5, 1e6], 0.0, 1.0, log=False)
    assert [wide.text(value) for value in (0.0, -0.25, 200000.0, 0.0005)] == ["0", "−0.25", "2.0×10⁵", "5.0×10⁻⁴"]


@pytest.mark.parametrize(("values", "ends"), [([2.0], (1.9, 2.1)), ([0.0], (-0.5, 0.5)), ([], (0.46, 10.54))])
def test_an_axis_of_one_value_or_none_has_some_width(values: list[float], ends: tuple[float, float]):
    axis = charts.Axis(values, 0.0, 1.0, log=False)
    assert (axis.low, axis.high) == pytest.approx(ends)
    near = charts.Axis([1.0, 1.0 + 1e-12], 0.0, 1.0, log=False)
    assert (near.low, near.high) == pytest.approx((0.95, 1.05)), "values that differ by rounding are one"


def test_an_axis_from_zero_begins_there_and_none_else_does():
    assert charts.Axis([2.0, 4.0], 0.0, 1.0, log=False, zero=True).low == 0.0
    assert charts.Axis([2.0, 4.0], 0.0, 1.0, log=False).low == pytest.approx(1.88)
    below = charts.Axis([-2.0, 4.0], 0.0, 1.0, log=False, zero=True)
    assert (below.low, below.high) == pytest.approx((-2.36, 4.36))


def test_markers_are_polygons_and_stars_of_one_size_about_their_point():
    """All reach 4.2 to 4.8 units from their point, but discs, which are as large as they look."""
    corners = {"s": 4, "^": 3, "v": 3, "<": 3, ">": 3, "D": 4, "d": 4, "p": 5, "h": 6, "8": 8, "*": 10, "X": 8, "x": 8}
    for name, number in corners.items():
        points = points_of(SHAPES[name])
        assert len(points) == number
        reach = [math.hypot(x, y) for x, y in points]
        assert max(reach) == pytest.approx(4.8 if name in "*Xx" else 4.3, abs=0.01)
        assert abs(sum(x for x, _ in points)) < 0.1
        if name in "*Xx":
            inner = {"*": 0.4, "X": 0.45, "x": 0.22}[name]
            assert min(reach) == pytest.approx(4.8 * inner, abs=0.01)
            assert [r > 4.0 for r in reach] == [True, False] * (number // 2)
        elif name != "d":
            assert max(reach) - min(reach) < 0.02
    ways = {"^": (0, -1), "v": (0, 1), "<": (-1, 0), ">": (1, 0)}  # y points down
    for name, (x, y) in ways.items():
        assert any(p == pytest.approx((4.3 * x, 4.3 * y), abs=0.01) for p in points_of(SHAPES[name]).tolist())
    square = points_of(SHAPES["s"])
    assert sorted({round(abs(v), 2) for v in square.ravel()}) == [3.04], "it stands on a side"
    diamond, slim = points_of(SHAPES["D"]), points_of(SHAPES["d"])
    assert sorted({round(abs(v), 2) for v in diamond.ravel()}) == [0.0, 4.3], "and this on a corner"
    assert abs(slim[:, 0]).max() == pytest.approx(0.6 * 4.3, abs=0.01)
    assert abs(points_of(SHAPES["8"])[0, 0]) == pytest.approx(4.3 * math.sin(math.pi / 8), abs=0.01)


def test_a_point_alone_is_marked_and_points_of_a_line_where_that_is_wanted():
    for x, marks, number in (([1.0], False, 1), ([1.0, 2.0], False, 0), ([1.0, 2.0], True, 2), ([1.0], True, 1)):
        root = drawn(charts.Chart("t", "x", "y", [charts.Series("a", x, x, marks=marks)]))
        assert len(of_class(root, "mark")) == number
        assert len(of_class(root, "line")) == (len(x) > 1)


def test_a_series_of_a_method_has_its_colour_marker_and_dashes():
    mark = Mark("#123456", "s", "dashed")
    root = drawn(charts.Chart("t", "x", "y", [charts.Series("a", [0.0, 1.0], [0.0, 1.0], mark=mark)]))
    (line,) = of_class(root, "line")
    assert (line.get("style"), line.get("stroke-dasharray")) == ("color:#123456", "7 3")
    assert {(e.get("style"), e.get("d")) for e in of_class(root, "mark")} == {("color:#123456", SHAPES["s"])}
    series = [charts.Series(f"{k}", [0.0, 1.0], [0.0, 1.0]) for k in range(8)]
    root = drawn(charts.Chart("t", "x", "y", series))
    names = [(e.get("class") or "").split()[1] for e in of_class(root, "line") if "h26" not in e.get("d", "")]
    assert names == ["s0", "s1", "s2", "s3", "s4", "s5", "s0", "s1"]
