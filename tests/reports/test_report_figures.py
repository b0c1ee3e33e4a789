"""Figures for papers and animations: every kind and format, the same bytes every time, clear refusals."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import pytest
from PIL import Image

from harness.model.errors import InputError
from harness.model.method import Status
from harness.model.result import Result
from reports import figures
from reports.animate import FRAMES, animate
from tests.reports import samples

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
    with pytest.raises(InputError, match="left no mechanism"):
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
