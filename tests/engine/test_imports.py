"""What commands import: lists and drawings no solver and no compiled loops."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from harness.engine.preload import shipped
from harness.model.method import Declared, load_method, method_names, prepared

SOLVERS = {"numba", "llvmlite", "highspy", "osqp", "pymunk", "casadi", "cvxpy", "mujoco"}
COMMAND = """
import json, sys
from drystone.cli.main import main
try:
    main(sys.argv[1:])
except SystemExit as end:
    assert not end.code, end.code
print(json.dumps(sorted(sys.modules)))
"""


def imported(program: str, *words: str | Path) -> set[str]:
    """Modules that a fresh interpreter has loaded at the end of a program, which prints them in its last line."""
    command = [sys.executable, "-c", program, *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    return set(json.loads(done.stdout.splitlines()[-1]))


@pytest.mark.parametrize(
    "words",
    [("list", "methods"), ("list", "methods", "--json"), ("list", "cases"), ("list", "suites"), ("show", "wall-21")],
    ids=" ".join,
)
def test_lists_and_drawings_import_no_solver(words: tuple[str, ...], tmp_path: Path):
    more = ("-o", tmp_path / "wall.svg") if words[0] == "show" else ()
    modules = imported(COMMAND, *words, *more)
    assert not modules & SOLVERS
    assert not {name for name in modules if name.startswith("methods.") and name.endswith(("adapter", "kernels"))}


def test_a_run_imports_the_solver_of_its_method_alone():
    modules = imported(COMMAND, "run", "la-associated", "single-block")
    assert {"scipy", "highspy", "methods.la.associated_adapter"} <= modules
    assert not modules & {"osqp", "pymunk", "sqlite3", "pandas", "matplotlib"}


@pytest.mark.parametrize("name", [name for name in shipped(method_names()) if name not in ("dummy", "de-mujoco")])
def test_what_declares_a_method_leads_to_what_solves_it(name: str):
    declared = load_method(name)
    assert isinstance(declared, Declared)
    module, _, solver = declared.solver.partition(":")
    prepared(declared)
    found = getattr(sys.modules[module], solver)
    assert issubclass(found, type(declared))
    assert found().name == name, "the solver answers under the same name"
