"""`drystone show`: sound and faulty walls drawn with ids, axes, scale, sizes and marks."""

from __future__ import annotations

import html
import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from matplotlib.collections import PathCollection

from cases.start import stack
from drystone.cli.main import main
from harness.model.inspection import inspect
from harness.model.reading import parse_wall
from harness.model.salvage import salvaged
from reports.figures.wall_check_figure import inspected_figure
from reports.geometry.thrust_lines import round_number
from tests.engine.test_validate import faulty


def test_faulty_wall_is_drawn_with_every_block_and_every_mark_at_its_place():
    wall, before = salvaged(faulty(), "wall.json")
    assert wall is not None
    looked = inspect(wall, "wall", before)
    (ax,) = inspected_figure(looked).axes
    drawn = [path.vertices for item in ax.collections if isinstance(item, PathCollection) for path in item.get_paths()]
    assert len(drawn) == len(wall.blocks)
    words = {text.get_text() for text in ax.texts}
    assert {"ground", "deeper", "on crossed", "twice (2)"} <= words  # ids as messages use them
    numbers = {label: text.xy for text in ax.texts if hasattr(text, "xy") for label in text.get_text().split(", ")}
    for number, mark in enumerate(looked.marks, start=1):
        assert (str(number) in numbers) == (mark.at is not None)
        if mark.at is not None:
            assert numbers[str(number)] == pytest.approx(mark.at)


def test_sizes_are_drawn_on_request_and_axes_unless_they_are_not_wanted():
    looked = inspect(stack(2, width=0.3, height=0.2))
    low, high = (max(float(outline[:, 0].max()) for outline in looked.outlines), 0.6)
    page = inspected_figure(looked, dimensions=True)
    words = {text.get_text() for text in page.axes[0].texts}
    assert any("0.3 x 0.2" in word for word in words)
    assert f"{high:g}" in words  # two blocks and the ground, each .2 high
    assert page.axes[0].get_xlabel() == "x [m]"
    assert low < page.axes[0].get_xlim()[1]
    plain = inspected_figure(looked, axes=False)
    assert not plain.axes[0].axison
    assert not any("x 0.2" in text.get_text() for text in plain.axes[0].texts)


@pytest.mark.parametrize(("longest", "expected"), [(0.26, 0.2), (0.99, 0.5), (1.0, 1.0), (37.0, 20.0), (5e3, 5e3)])
def test_scale_has_a_round_length(longest: float, expected: float):
    assert round_number(longest) == pytest.approx(expected)


def test_show_draws_a_faulty_file_tells_its_faults_and_ends_with_2(tmp_path: Path):
    (tmp_path / "wall.json").write_text(json.dumps(faulty()))
    run = CliRunner().invoke(main, ["show", str(tmp_path / "wall.json"), "-o", str(tmp_path / "wall.svg")])
    assert run.exit_code == 2
    assert "overlap" in run.output
    assert (tmp_path / "wall.svg").read_bytes().startswith(b"<?xml")


def test_drawing_of_a_wall_of_several_load_cases_names_the_one_it_shows_and_another_can_be_asked_for(tmp_path: Path):
    """It drew the loads of the first without a word."""
    path = tmp_path / "wall.json"
    own = {name: {"live": {"body": [{"per_weight": [way, 0]}]}} for name, way in (("right", 1), ("left", -1))}
    path.write_text(json.dumps(stack(2, width=0.3, height=0.2).document() | {"loads": {}, "load_cases": own}))

    def drawn(*arguments: str) -> str:
        run = CliRunner().invoke(main, ["show", str(path), "-o", str(tmp_path / "wall.svg"), *arguments])
        assert run.exit_code == 0, run.output
        return (tmp_path / "wall.svg").read_text(encoding="utf-8")

    assert 'Loads: load case "right", of 2 load cases' in html.unescape(drawn())
    assert 'Loads: load case "left", of 2 load cases' in html.unescape(drawn("--load-case", "left"))
    refused = CliRunner().invoke(main, ["show", str(path), "-o", str(tmp_path / "no.svg"), "--load-case", "lift"])
    assert refused.exit_code == 2
    assert f'{path}: load_cases: no load case is called "lift". Did you mean "left"?' in refused.output
    assert not (tmp_path / "no.svg").exists()


@pytest.mark.parametrize("name", ["left", "right"])
def test_loads_that_are_drawn_are_those_of_the_load_case(name: str):
    own = {each: {"live": {"body": [{"per_weight": [way, 0]}]}} for each, way in (("right", 1), ("left", -1))}
    described = stack(2, width=0.3, height=0.2).document() | {"loads": {}, "load_cases": own}
    looked = inspect(parse_wall(described, "wall.json"), load_case=name)
    assert looked.built is not None
    assert looked.load_case == name
    assert looked.built.assembly.live[:, 0].sum() * own[name]["live"]["body"][0]["per_weight"][0] > 0.0
