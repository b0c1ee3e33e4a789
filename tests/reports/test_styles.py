"""A method is drawn alike in every chart, whether it is ours or a stranger's, and told apart without colour."""

from __future__ import annotations

import itertools

import shapely

from harness.model.comparison import CaseResults, ComparisonRun
from harness.model.method import Traits
from harness.model.method_registry import load_method, method_names
from harness.model.result import Result
from reports.charts import charts, styles
from reports.page import build
from tests.reports import samples
from tests.reports.read_chart import points_of

CASE = samples.block()


def of(method: str, traits: Traits | None = None) -> Result:
    found = samples.solved(CASE, method, 0.4)
    return found.model_copy(update={"traits": traits or Traits()})


def test_methods_installed_are_told_apart_without_colour():
    looks = [styles.mark_of(of(name, load_method(name).traits)) for name in method_names()]
    assert all(look.shape and look.colour.startswith("#") for look in looks)
    assert len({(look.marker, look.line) for look in looks}) == len(looks)


def test_own_method_without_traits_keeps_its_look_and_few_share_one():
    names = [f"mine-{k}" for k in range(12)]
    looks = {name: styles.mark_of(of(name)) for name in names}
    assert looks == {name: styles.mark_of(of(name)) for name in reversed(names)}
    assert len(set(looks.values())) >= 11


def test_chart_draws_the_mark_of_its_method_whatever_its_place():
    mark = styles.mark_of(of("la", Traits(colour="#a8431e", marker="s", line="dashed")))
    series = charts.Series("la", [1.0, 2.0], [1.0, 2.0], mark=mark)
    other = charts.Series("x", [1.0, 2.0], [2.0, 1.0])
    for drawn in ([series, other], [other, series]):
        page = str(charts.svg(charts.Chart("t", "x", "y", drawn)))
        assert page.count('style="color:#a8431e" stroke-dasharray="7 3"') == 2
        assert page.count('class="mark" style="color:#a8431e"') == 3
        assert page.count(styles.SHAPES["s"]) == 3


def test_answer_nobody_judged_says_so_in_the_overview():
    result = of("la")
    for accepted in (None, True):
        result.judge.accepted = accepted
        page = build.render(ComparisonRun("mine", "", "", [CaseResults(CASE, [result])]), data_folder="x")
        overview = page.split('class="matrix"')[1].split("</table>")[0]
        assert ("not judged" in overview) == (accepted is None)


def test_every_marker_is_another_figure():
    figures = {name: shapely.Polygon(points_of(path)) for name, path in styles.SHAPES.items() if "a" not in path}
    figures["o"] = shapely.Point(0.0, 0.0).buffer(3.5)
    assert figures.keys() == styles.SHAPES.keys()
    for (name, one), (other, two) in itertools.combinations(figures.items(), 2):
        apart = one.symmetric_difference(two).area / one.union(two).area
        assert apart > 0.1, f"{name} and {other} cannot be told apart"


def test_markers_are_alike_in_size_and_point_where_their_names_say():
    for name, path in styles.SHAPES.items():
        if name != "o":
            assert 3.0 <= abs(points_of(path)).max() <= 4.9, name
    for name, way in {"^": (0, -1), "v": (0, 1), "<": (-1, 0), ">": (1, 0)}.items():
        corners = points_of(styles.SHAPES[name])
        along = corners @ way
        assert along.max() == max(abs(corners).max(axis=0)) > -along.min(), name
    narrow = points_of(styles.SHAPES["d"])
    assert len(narrow) == 4
    assert abs(narrow[:, 0]).max() < abs(narrow[:, 1]).max()
