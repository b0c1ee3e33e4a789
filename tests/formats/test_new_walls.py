"""Walls made from numbers build, are held, and go through the commands to an answer."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from cases.start import STARTS, facade, laid
from drystone.cli.main import main
from harness.model.build import build


@pytest.mark.parametrize("kind", STARTS)
def test_every_kind_of_new_wall_builds_and_every_block_is_held(kind: str) -> None:
    assembly = build(STARTS[kind]()).assembly  # refuses overlaps
    touched = {*assembly.block_a.tolist(), *assembly.block_b.tolist()}
    assert set(assembly.free.tolist()) <= touched


def test_headers_of_flemish_bond_lie_on_the_middle_of_stretchers() -> None:
    assert laid("flemish", 1, 0.0, 4.0) == [0.0, 1.0, 1.5, 2.5, 3.0, 4.0]
    assert laid("flemish", 2, 0.0, 4.0) == [0.0, 0.25, 0.75, 1.75, 2.25, 3.25, 3.75, 4.0]


def test_a_facade_has_openings_under_lintels() -> None:
    wall = facade(storeys=1, openings=2, opening_width=0.5, opening_height=0.3, spandrel_height=0.3)
    assert sum("lintel" in block.id for block in wall.blocks) == 2


def test_commands_go_from_numbers_to_drawing_to_answer(tmp_path: Path) -> None:
    run = CliRunner()
    wall, drawing = tmp_path / "wall.json", tmp_path / "wall.dxf"
    assert run.invoke(main, ["new", "stack", "--count", "2", "-o", str(wall)]).exit_code == 0
    assert run.invoke(main, ["export", str(wall), "-o", str(drawing)]).exit_code == 0
    done = run.invoke(main, ["run", "la-associated", str(drawing), "--json"])
    assert done.exit_code == 0, done.output
    assert "friction is given for the drawing" in done.output
    again = run.invoke(main, ["import", str(drawing), "--supports", "layer SUPPORTS", "-o", str(tmp_path / "a.json")])
    assert again.exit_code == 0, again.output
    assert json.loads((tmp_path / "a.json").read_text())["units"]["unit_weight"] == "kN/m3"
