"""No method of a user ends a comparison, whatever it does or answers: its row says what it did."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.commands import drystone
from tests.faults.test_processes import environment
from tests.faults.unruly import ACTS, ANSWERS

STATUS = {
    "print_without_end": "crashed", "ignore_signals": "timeout", "announce_a_record": "crashed", "change_folder": "ok",
    "leave_a_thread": "ok", "answer": "ok", "many forces": "crashed",
}  # fmt: skip
"""How runs end that neither crash nor are refused as no answer."""
SAID = {
    "write_everywhere": "channel",
    "say_loaded_again": "channel",
    "announce_a_record": "channel",
    "close_all": "exit code",
    "leave": "exit code 0",
    "print_without_end": "File too large",
    "raise_what_is_no_exception": "SystemExit: enough",
    "half a character": r"\ud800",
    "half a character in details": r"\udfff",
    "complex": "complex128",
    "finding": "banana",
    "many forces": "(10000000, 3)",
    "nothing": "NoneType",
    "deep details": "nested",
    "unknowns": "unknowns",
    "live forces": "live_forces",
}
"""Words of the sentence."""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder on Python's path where the unruly method is installed."""
    folder = tmp_path_factory.mktemp("site")
    shutil.copy(Path(__file__).with_name("unruly.py"), folder)
    about = folder / "unruly-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: unruly\nVersion: 1.0\n")
    points = "unruly = unruly:Unruly\nleaving = leaving:Leaving\n"
    (about / "entry_points.txt").write_text(f"[drystone.methods]\n{points}")
    (folder / "leaving.py").write_text("import sys\nsys.exit('it leaves as it is imported')\n")
    return folder


@pytest.fixture(scope="module")
def rows(installed: Path) -> dict[str, list[list[str]]]:
    given = environment(PYTHONPATH=f"{installed}:{Path(__file__).parents[2]}")
    command = [sys.executable, str(installed / "unruly.py")]
    done = subprocess.run(command, cwd=installed, env=given, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr[-2000:]
    assert done.stderr == ""
    told: dict[str, list[list[str]]] = json.loads(done.stdout)
    return told


@pytest.mark.parametrize("kind", [*ANSWERS, *ACTS, "nothing", "answer"])
def test_what_a_method_does_costs_its_own_row_and_no_other(rows: dict[str, list[list[str]]], kind: str):
    (status, sentence), (next_status, _) = rows[kind]
    assert status == STATUS.get(kind, "crashed"), sentence
    assert SAID.get(kind, "") in sentence
    assert sentence.isprintable()
    assert next_status == "ok"


def test_a_method_that_leaves_as_it_is_imported_is_refused_with_a_sentence(installed: Path, tmp_path: Path):
    given = environment(PYTHONPATH=f"{installed}:{Path(__file__).parents[2]}")
    words = ("compare", "slide", "--methods", "la-associated,leaving", "--json")
    done = drystone(*words, cwd=tmp_path, env=given)
    sound, leaving = json.loads(done.stdout)["cases"][0]["results"]
    assert sound["status"] == "ok"
    assert leaving["status"] == "refused"
    assert "it leaves as it is imported" in leaving["sentence"]


def test_a_script_without_a_guard_compares_once(tmp_path: Path):
    script = tmp_path / "script.py"
    script.write_text(
        "import drystone\nprint('begun')\nwalls = [drystone.library_wall(n) for n in ('slide', 'stack-2')]\n"
        "print([row.multiplier for row in drystone.compare(walls, ['la-associated']).results])\n"
    )
    given = environment(PYTHONPATH=str(Path(__file__).parents[2]))
    command = [sys.executable, str(script)]
    done = subprocess.run(command, cwd=tmp_path, env=given, capture_output=True, text=True, timeout=120)
    assert done.stderr == ""
    begun, multipliers = done.stdout.splitlines()
    assert begun == "begun"
    assert [round(value, 9) for value in json.loads(multipliers)] == [0.3, 0.75]
