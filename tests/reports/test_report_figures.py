"""Figures for papers and animations: every kind and format, the same bytes every time, clear refusals."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
import shapely
from PIL import Image

from harness.model.errors import InputError
from harness.model.method import Status
from harness.model.result import Result
from reports.figures import figures
from reports.figures.animate import FRAMES, animate
from reports.geometry import shapes, thrust_lines
from tests.reports import samples
from tests.walls import case as wall_case
from tests.walls import running_bond, stack

CASE = samples.bond(title=samples.SCRIPT, prefix="$x^")
MAGIC = {"pdf": b"%PDF", "svg": b"<?xml", "png": b"\x89PNG"}


def results() -> list[Result]:
    return [samples.solved(CASE, "fe", 0.5), samples.solved(CASE, "la", 0.4, turn=0.4)]


@pytest.mark.parametrize("ending", ["pdf", "svg", "png"])
@pytest.mark.parametrize("kind", figures.KINDS)
def test_figure_has_the_same_bytes_every_time(kind: str, ending: str, tmp_path: Path):
    first, second = tmp_path / f"a.{ending}", tmp_path / "deep" / f"b.{ending}"
    figures.figure(CASE, results(), kind, first)
    with mpl.rc_context({"lines.linewidth": 9.0, "font.size": 30.0, "svg.hashsalt": "other"}):
        figures.figure(CASE, results(), kind, second)
    assert first.read_bytes().startswith(MAGIC[ending])
    assert first.read_bytes() == second.read_bytes()


def test_figure_is_as_wide_as_a_journal_column(tmp_path: Path):
    path = tmp_path / "a.png"
    figures.figure(CASE, results()[:1], "mechanism", path)
    with Image.open(path) as image:
        assert image.width == pytest.approx(88 / 25.4 * 300, abs=1)


def test_wall_is_drawn_before_anything_is_run(tmp_path: Path):
    figures.show_wall(CASE.built, tmp_path / "wall.svg")
    assert (tmp_path / "wall.svg").stat().st_size > 1000


def test_refusals_say_what_would_be_right(tmp_path: Path):
    stopped = samples.failed(CASE, "de", Status.TIMEOUT, "too long")
    with pytest.raises(InputError, match="gave no mechanism"):
        figures.figure(CASE, [stopped], "mechanism", tmp_path / "a.pdf")
    with pytest.raises(InputError, match=r"\.pdf, \.svg, \.png"):
        figures.figure(CASE, results(), "mechanism", tmp_path / "a.docx")
    with pytest.raises(InputError, match="mechanism, forces"):
        figures.figure(CASE, results(), "cartoon", tmp_path / "a.pdf")
    with pytest.raises(InputError, match="too long"):
        animate(CASE, stopped, tmp_path / "a.gif")
    with pytest.raises(InputError, match=r"\.gif"):
        animate(CASE, results()[0], tmp_path / "a.mp4")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("ending", ["gif", "apng", "webp"])
def test_animation_moves(ending: str, tmp_path: Path):
    path = tmp_path / f"a.{ending}"
    animate(CASE, results()[1], path)
    with Image.open(path) as image:
        assert getattr(image, "n_frames", 1) == FRAMES
        image.seek(0)
        first = image.convert("RGB").tobytes()
        image.seek(FRAMES - 1)
        assert image.convert("RGB").tobytes() != first


def test_animation_shows_a_collapse_that_was_followed(tmp_path: Path):
    case = samples.bond()
    steps = [[[0.01 * k * (not fixed), 0.0, 0.05 * k] for fixed in case.assembly.fixed] for k in range(5)]
    result = samples.solved(case, "de-tilt", 0.5, details={"release": {"frames": steps}})
    animate(case, result, tmp_path / "a.gif")
    with Image.open(tmp_path / "a.gif") as image:
        assert getattr(image, "n_frames", 1) == 5


def test_without_a_display_the_window_is_refused_with_the_way_out(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(InputError, match=r"no window.*-o wall\.svg"):
        figures.show_window(figures.wall_figure(CASE.built), "wall")


@pytest.mark.parametrize("kind", ["mechanism", "forces", "thrust"])
def test_figure_says_what_wall_friction_method_and_scale_it_shows(kind: str, tmp_path: Path):
    with mpl.rc_context():
        page = figures.results_figure(CASE, results(), kind)
    told = [text.get_text() for text in page.findobj(mpl.text.Text)]
    assert any("tan φ = " in text for text in told)
    assert any(text.startswith("fe, 0.5") for text in told)
    assert any(text.endswith(" m") for text in told), "no scale of lengths"
    assert any(text.endswith(" kN") for text in told) is (kind != "mechanism")


def test_line_of_thrust_is_called_so_only_where_there_is_one():
    titles = {}
    for name, pattern in (("column", stack(3)), ("bond", running_bond(3, 2))):
        case = wall_case(pattern)
        forces = [(1.0, 1.0, 0.1)] * case.assembly.n_interfaces
        result = samples.solved(case, "fe", 0.5).model_copy(update={"forces": forces})
        titles[name] = figures.results_figure(case, [result], "thrust").axes[0].get_title()
    assert titles["column"].endswith("line of thrust")
    assert titles["bond"].endswith("flow of forces")


def test_no_arrow_of_a_force_enters_a_support():
    for pattern in (
        stack(3),
        running_bond(4, 2),
        {"type": "ring", "inner_radius": 1.0, "outer_radius": 1.2, "count": 9},
    ):
        wall = wall_case(pattern).assembly
        found = shapes.thrusts(wall, np.tile([0.2, 1.0, 0.6], (wall.n_interfaces, 1)))
        ends = thrust_lines.drawn_ends(wall, found)
        supports = [shapely.Polygon(wall.polygons[k]).buffer(-1e-6) for k in np.flatnonzero(wall.fixed)]
        assert not any(shapely.LineString(arrow).intersects(held) for arrow in ends for held in supports)
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / wall.length_scale
        assert length.max() == pytest.approx(0.72)
        assert length.min() >= 0.72 * thrust_lines.SHORTEST - 1e-9


@pytest.mark.parametrize("sizes", [(3.0, 2.0), (2.0, 3.0)])
def test_of_two_arrows_that_cross_the_smaller_stops_short_of_the_greater(sizes: tuple[float, float]):
    wall = wall_case(stack(2)).assembly
    joint = int(np.flatnonzero(~wall.fixed[wall.block_a] & ~wall.fixed[wall.block_b])[0])
    x, unit = float(wall.end1[joint, 0]), wall.length_scale
    points = np.array([[x - 0.2 * unit, 1.0], [x + 0.2 * unit, 1.0]])
    towards = np.array([[0.6, -0.8], [-0.6, -0.8]])  # they meet 0.333 units of length from both points
    found = shapes.Thrusts(np.array([joint, joint]), points, towards * np.array(sizes)[:, None], np.array(sizes))
    arrows = [shapely.LineString(arrow) for arrow in thrust_lines.drawn_ends(wall, found)]
    assert not arrows[0].intersects(arrows[1])
    lengths = [arrow.length / unit for arrow in arrows]
    assert lengths[np.argmax(sizes)] == pytest.approx(0.72), "the greater keeps its length"
    assert lengths[np.argmin(sizes)] == pytest.approx(2.0 * 0.8 * 0.2 / 0.6)
