"""NAME conforms to the suite of Drystone, and finds the associated maximum of the paper's wall."""

import json
import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).parent


def drystone(*words: str, code: int = 0) -> str:
    command = [sys.executable, "-m", "drystone", "--methods-file", "methods.toml", *words]
    done = subprocess.run(command, cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout


def test_it_finds_what_the_method_of_drystone_finds() -> None:
    mine, other = (json.loads(drystone("run", name, "wall-21", "--json")) for name in ("NAME", "la-associated"))
    assert abs(mine["multiplier"] / other["multiplier"] - 1.0) < 1e-8
    assert mine["judge"]["accepted"]


def test_a_setting_is_checked_before_the_program_is_asked() -> None:
    drystone("run", "NAME", "slide", "--set", "pivots=0", code=2)
    few = json.loads(drystone("run", "NAME", "wall-21", "--set", "pivots=3", "--json", code=1))
    assert few["status"] == "not_converged"


def test_it_conforms() -> None:
    drystone("conformance", "NAME")
