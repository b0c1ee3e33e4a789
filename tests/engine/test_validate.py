"""`drystone validate`: faults, doubts, and what joints and answers a drawing has over the tolerance."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from click.testing import CliRunner

from harness.cli import main
from harness.model.build import build
from harness.model.wall import Wall
from tests.walls import running_bond, wall_data


def off(by: float, **more: Any) -> dict[str, Any]:
    """Running bond of 4 courses with one brick lower than it is meant to be."""
    wall = build(Wall.model_validate(wall_data(running_bond(3, 4), 0.65))).wall.model_dump(by_alias=True, mode="json")
    wall = wall | {"pattern": None, "interfaces": more}
    wall["blocks"][7]["polygon"] = [[x, y - by] for x, y in wall["blocks"][7]["polygon"]]
    return wall


def validated(tmp_path: Path, wall: dict[str, Any]) -> tuple[int, dict[str, Any]]:
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(wall))
    run = CliRunner().invoke(main, ["validate", str(path), "--json"])
    return run.exit_code, json.loads(run.stdout)


def test_brick_a_little_low_is_told_with_the_tolerance_that_finds_its_joints(tmp_path: Path):
    wall = off(0.001, greatest_overlap=0.002)
    code, told = validated(tmp_path, wall)
    assert code == 0
    assert any("look at each other" in warning for warning in told["warnings"])
    most = max(told["tolerances"], key=lambda item: item["joints"] or 0)
    assert most["joints"] > told["joints"]
    assert most["low"] <= told["suggested_tolerance"] <= most["high"]
    code, mended = validated(tmp_path, off(0.001, tolerance=told["suggested_tolerance"]))
    assert (code, mended["joints"], mended["warnings"]) == (0, most["joints"], [])


def test_wall_that_cannot_be_built_is_shown_over_the_tolerance_all_the_same(tmp_path: Path):
    code, told = validated(tmp_path, off(0.001))
    assert code == 2
    assert told["joints"] is None
    assert "overlap" in told["fault"]
    assert told["tolerances"][-1]["joints"]


def test_sound_wall_has_one_plateau(tmp_path: Path):
    code, told = validated(tmp_path, off(0.0))
    assert code == 0
    assert told["warnings"] == []
    assert [item["joints"] for item in told["tolerances"]] == [told["joints"]]
