"""NAME conforms to the suite of Drystone, and finds a value computed by hand."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent
WALL = {
    "format": "wall/1",
    "unit_weight": 20.0,
    "friction": 0.7,
    "pattern": {"type": "stack", "width": 0.3, "height": 0.2, "count": 5},
    "loads": {"live": {"body": [{"per_weight": [1, 0]}]}},
}


def drystone(*words: str, code: int = 0) -> str:
    command = [sys.executable, "-m", "drystone", "--methods-file", "methods.toml", *words]
    done = subprocess.run(command, cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module", autouse=True)
def compiled() -> None:
    subprocess.run(["cc", "-O2", "-Wall", "-o", "MODULE", "MODULE.c", "-lm"], cwd=FOLDER, check=True)


def test_column_topples_at_width_over_height(tmp_path: Path) -> None:
    wall = tmp_path / "wall.json"
    wall.write_text(json.dumps(WALL))
    result = json.loads(drystone("run", "NAME", str(wall), "--json"))
    assert abs(result["multiplier"] - 0.3 / (5 * 0.2)) < 1e-12
    assert result["judge"]["accepted"]


def test_a_wall_outside_its_scope_is_refused(tmp_path: Path) -> None:
    result = json.loads(drystone("run", "NAME", "wall-21", "--json", code=2))
    assert result["status"] == "refused"


def test_it_conforms() -> None:
    drystone("conformance", "NAME")
