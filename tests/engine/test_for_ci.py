"""What the continuous integration of others uses: the plugin of pytest, and the jobs for GitHub and GitLab."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
import yaml

from tests.commands import drystone

ROOT = Path(__file__).parents[2]
CASE = """id = "{id}"
title = "A block"
kind = "multiplier"
wall = "wall.json"
source = "a test"

[[references]]
id = "slides"
type = "exact"
value = {value}
tolerance = 1e-9
tolerance_reason = "rounding"
applies_to = ["la-associated", "{other}"]
gate = true
source = "statics"
requirement = "It slides at its friction."
"""
WALL = """{"format": "wall/1", "unit_weight": 20, "friction": 0.3,
 "loads": {"live": {"body": [{"per_weight": [1, 0]}]}},
 "pattern": {"type": "stack", "width": 0.3, "height": 0.2, "count": 1}}"""


@pytest.fixture(autouse=True)
def mine(tmp_path: Path) -> Path:
    for name, value, other in (("right", 0.3, "fe"), ("wrong", 0.31, "fe")):
        folder = tmp_path / "mine" / name
        folder.mkdir(parents=True)
        (folder / "wall.json").write_text(WALL)
        (folder / "case.toml").write_text(CASE.format(id=name, value=value, other=other))
    return tmp_path


def collected(folder: Path, *words: str) -> tuple[int, str]:
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-v", *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def test_a_checked_reference_is_a_test(mine: Path):
    code, said = collected(mine, "--drystone", "quick", "mine")
    assert code == 1
    for name, outcome in (("right", "PASSED"), ("wrong", "FAILED")):
        for method in ("la-associated", "fe"):
            assert re.search(rf"mine/{name}/case.toml::slides\[{method}\] {outcome}", said), said
    assert "It slides at its friction. 0.3 - 0.31 = -0.01" in said
    assert "Traceback" not in said
    assert "2 failed, 2 passed" in said


def test_cases_are_collected_only_where_that_is_asked_for(mine: Path):
    code, said = collected(mine, "mine")
    assert (code, "no tests ran" in said) == (5, True)
    (mine / "pytest.ini").write_text("[pytest]\ndrystone = quick\n")
    assert collected(mine, "mine/right")[0] == 0


def test_a_wrong_case_is_told_in_a_sentence(mine: Path):
    path = mine / "mine" / "wrong" / "case.toml"
    path.write_text(path.read_text().replace("tolerance =", "tolerence ="))
    code, said = collected(mine, "--drystone", "quick", "mine/wrong")
    assert code == 2
    assert 'Did you mean "tolerance"?' in said
    assert "Traceback" not in said


def scripts(document: Any) -> list[str]:
    """The command lines of a job for GitHub or GitLab."""
    if isinstance(document, dict):
        own = document.get("run") or document.get("script") or []
        lines = [own] if isinstance(own, str) else own
        return [*lines, *(line for value in document.values() for line in scripts(value))]
    return [line for item in document for line in scripts(item)] if isinstance(document, list) else []


@pytest.mark.parametrize("path", [".github/workflows/walls.yml", ".gitlab/walls.yml"])
def test_the_jobs_for_others_install_and_check(path: str, mine: Path):
    install, check = scripts(yaml.safe_load((ROOT / path).read_text()))
    assert install == 'pip install "$DRYSTONE"'
    words = [{"$CASES": "mine", "$TIER": "quick"}.get(word, word) for word in shlex.split(check)]
    assert words[0] == "drystone"
    done = drystone(*words[1:], cwd=mine)
    assert done.returncode == 1, done.stderr
    (suite,) = ElementTree.parse(mine / "out" / "drystone.xml").getroot()
    assert (suite.get("tests"), suite.get("failures")) == ("4", "2")


def test_the_plugin_costs_other_projects_no_solver(mine: Path):
    done = subprocess.run(
        [sys.executable, "-X", "importtime", "-c", "import drystone.pytest_plugin"],
        capture_output=True,
        text=True,
        env=os.environ,
        cwd=mine,
    )
    assert done.returncode == 0
    assert not re.search(r"\| +(numpy|scipy|cvxpy|pandas)$", done.stderr, re.MULTILINE)
