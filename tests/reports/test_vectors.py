"""Drawings as vector files of their own, and contact forces drawn without a script."""

from __future__ import annotations

import re
from importlib.resources import files
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from reports.drawing.display_list import Frame
from reports.drawing.force_drawing import force_drawing
from reports.drawing.looks import LOOKS, css
from reports.drawing.mechanism_drawing import mechanism_drawing
from reports.drawing.svg import inline
from reports.drawing.wall_drawing import wall_drawing
from reports.geometry import shapes, thrust_lines
from reports.page import vectors
from reports.page.export import export
from tests.reports import samples

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("data")
    export(samples.typical(), path)
    return path


def test_every_drawing_of_the_report_is_a_vector_file(folder: Path):
    names = {path.name for path in (folder / "wall-21").glob("*.svg")}
    assert {"wall.svg", "overlay.svg", "fe-mechanism.svg", "fe-forces.svg", "la-mechanism.svg"} <= names


def test_vector_files_say_what_they_show_and_need_no_page(folder: Path):
    for path in folder.glob("*/*-mechanism.svg"):
        text = path.read_text(encoding="utf-8")
        root = ElementTree.fromstring(text)
        told = [element.text or "" for element in root.iter(f"{SVG}text")]
        method = path.stem.removesuffix("-mechanism")
        assert any(line.startswith("tan φ = ") for line in told), path
        assert any(re.match(rf"{re.escape(method)}, .*: mechanism", line) for line in told), path
        assert any(re.fullmatch(r"[0-9.]+( m)?", line) for line in told), f"{path}: no scale of lengths"
        assert "var(" not in text
        assert "calc(" not in text, "other programs know no sums"


def test_forces_are_drawn_where_they_act_with_their_size_and_a_scale():
    case = samples.bond()
    result = samples.solved(case, "la", 0.5)
    drawn = inline(force_drawing(case, result))
    found = shapes.thrusts(case.assembly, np.asarray(result.forces), smallest=thrust_lines.SMALLEST)
    arrows = re.findall(r'class="(?:force|full)" d="M(-?\d+) (-?\d+)', drawn)
    tips = np.rint(Frame.of(case.assembly).place(thrust_lines.drawn_ends(case.assembly, found)[:, 1]))
    assert np.array(arrows, dtype=int).tolist() == tips.tolist()
    assert drawn.count("<text") == len(found.size) + 2, "a size each, and two scales"
    assert " kN</text>" in drawn


def test_force_at_the_limit_of_friction_is_circled():
    case = samples.bond(courses=1, bricks=1)
    one = [(1.0, 1.0, 0.65 * 2.0)] * case.assembly.n_interfaces
    below = [(1.0, 1.0, 0.5)] * case.assembly.n_interfaces
    result = samples.solved(case, "la", 0.5)
    drawn = [inline(force_drawing(case, result.model_copy(update={"forces": forces}))) for forces in (one, below)]
    assert [text.count("<circle") for text in drawn] == [case.assembly.n_interfaces, 0]


def test_long_words_are_broken_into_lines_of_the_drawing():
    case = samples.bond(title="A wall")
    text = vectors.headed(case, force_drawing(case, samples.solved(case, "la", 0.5)), "one word after another " * 12)
    root = ElementTree.fromstring(text)
    box = [float(x) for x in root.attrib["viewBox"].split()]
    lines = [e for e in root.iter(f"{SVG}text") if (e.text or "").startswith(("one", "word", "after", "another"))]
    assert len(lines) > 3
    assert all(0.55 * vectors.LETTERS * len(line.text or "") <= box[2] for line in lines)
    assert all(float(line.attrib["y"]) > box[1] for line in lines)


def test_the_script_of_the_page_draws_nothing():
    script = files("reports").joinpath("static/move.js").read_text(encoding="utf-8")
    assert "createElementNS" not in script
    assert not re.search(r"\b(path|circle|polygon|stroke|friction|limit)\b", script)


def test_every_shape_that_a_page_shows_has_a_look():
    run = samples.typical()
    for item in run.cases:
        drawings = [wall_drawing(item.case)]
        drawings += [mechanism_drawing(item.case, result) for result in item.results if result.mechanism is not None]
        drawings += [force_drawing(item.case, result) for result in item.results if result.forces is not None]
        shown = {shape.role for drawing in drawings for shape in drawing.flat()} - {"", "said"}
        assert shown <= set(LOOKS)
        assert all(f"svg .{role} {{" in css() for role in shown)
