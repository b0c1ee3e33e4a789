"""What `drystone new method` writes works as it stands: compared, judged and reported beside ours, and its tests pass.

These are the worked examples of methods in C, JavaScript and Python by entry point.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.commands import drystone

TOOLS = {"c": "cc", "javascript": "node", "python": sys.executable}
FILES = {"c": "methods.toml", "javascript": "methods.toml", "python": "pyproject.toml"}


def made(language: str, folder: Path) -> Path:
    """The folder of a method that is new, compiled where it must be."""
    if shutil.which(TOOLS[language]) is None:
        pytest.skip(f"{TOOLS[language]} is not installed")
    done = drystone("new", "method", "my-own", "--language", language, cwd=folder)
    assert done.returncode == 0, done.stderr
    place = folder / "my-own"
    if language == "c":
        command = ["cc", "-O2", "-Wall", "-Wextra", "-Werror", "-o", "my_own", "my_own.c", "-lm"]
        subprocess.run(command, cwd=place, check=True)
    return place


@pytest.mark.parametrize("language", list(TOOLS))
def test_no_place_is_left_open_and_what_exists_is_not_written_over(language: str, tmp_path: Path):
    place = made(language, tmp_path)
    assert {"README.md", FILES[language]} <= {path.name for path in place.iterdir()}
    for path in place.iterdir():
        if path.suffix:  # the program is none
            assert not {"NAME", "MODULE", "CLASS"} & set(path.read_text().replace('"', " ").split()), path
    again = drystone("new", "method", "my-own", "--language", language, cwd=tmp_path)
    assert again.returncode == 2
    assert "exists already" in again.stderr


@pytest.mark.parametrize(
    ("language", "wall", "other"),
    [
        ("c", "column-5-rocking", "la"),
        ("javascript", "wall-21-friction-075", "la-associated"),
        ("javascript", "arch-100-tilt", "la-associated"),
    ],
)
def test_a_program_is_compared_judged_and_reported_beside_ours(language: str, wall: str, other: str, tmp_path: Path):
    place = made(language, tmp_path)
    done = drystone("compare", wall, "--methods", f"my-own,{other}", "--json", cwd=place)
    assert done.returncode == 0, done.stdout + done.stderr
    mine, ours = json.loads(done.stdout)["cases"][0]["results"]
    assert mine["multiplier"] == pytest.approx(ours["multiplier"], rel=1e-8)
    assert mine["judge"]["accepted"] is True
    assert mine["versions"]["my-own"] == "1.0"
    assert "my-own" in (place / "out" / "report.html").read_text()


@pytest.mark.parametrize("language", ["c", "javascript"])
def test_a_program_conforms(language: str, tmp_path: Path):
    place = made(language, tmp_path)
    done = drystone("conformance", "my-own", "--json", cwd=place)
    (document,) = json.loads(done.stdout)
    assert [row for row in document["checks"] if row["outcome"] == "fails"] == []
    assert document["conforms"] is True
    assert done.returncode == 0
    answered = {row["check"] for row in document["checks"] if row["outcome"] == "conforms"}
    assert {"slide", "topple", "view-rotated", "stands", "falls", "unbounded", "memory", "repeats"} <= answered


def test_a_package_in_python_is_found_by_its_entry_point_and_conforms(tmp_path: Path):
    """As `pip install` leaves it: the module and its entry point on Python's path."""
    place = made("python", tmp_path)
    about = place / "my_own-0.1.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: my-own\nVersion: 0.1\n")
    points = (
        (place / "pyproject.toml").read_text().split('[project.entry-points."drystone.methods"]\n')[1].splitlines()[0]
    )
    (about / "entry_points.txt").write_text(f"[drystone.methods]\n{points.replace(chr(34), '')}\n")
    environment = {
        "PATH": "/usr/bin:/bin",
        "PYTHONPATH": f"{place}:{Path(__file__).parents[2]}",
        "OMP_NUM_THREADS": "1",
    }
    done = drystone("conformance", "my-own", "--json", cwd=tmp_path, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr
    rows = json.loads(done.stdout)[0]["checks"]
    assert {row["check"] for row in rows if row["outcome"] == "refused"} == {"cohesion", "dilatancy"}
    compared = drystone(
        "compare", "wall-21-friction-075", "--methods", "my-own,la-associated", "--json", cwd=tmp_path, env=environment
    )
    mine, ours = json.loads(compared.stdout)["cases"][0]["results"]
    assert mine["multiplier"] == pytest.approx(ours["multiplier"], rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("language", list(TOOLS))
def test_its_own_tests_pass(language: str, tmp_path: Path):
    place = made(language, tmp_path)
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q"], cwd=place, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout
