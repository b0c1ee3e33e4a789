"""What commands import: lists and drawings no solver and no compiled loops."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from importlib.metadata import EntryPoint
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

import pytest
from click.testing import CliRunner

import drystone
from drystone.cli.main import main
from harness.engine.preload import shipped
from harness.engine.provenance import code_version
from harness.model.assembly import Assembly
from harness.model.errors import InputError
from harness.model.method import GROUP, Answer, Finding, Listed, Method, Solver, Status, Traits, method_points
from harness.model.method_registry import load_method, method_names, prepared
from methods.dummy import Dummy

SOLVERS = {"numba", "llvmlite", "highspy", "osqp", "pymunk", "ipyopt", "cvxpy", "mujoco"}
COMMAND = """
import json, sys
from drystone.cli.main import main
try:
    main(sys.argv[1:])
except SystemExit as end:
    assert not end.code, end.code
print(json.dumps(sorted(sys.modules)))
"""


class Plain(Method):
    """What the base class asks for, and no more."""

    name, family, title, tolerance = "plain", "hand", "Plain", 1e-9

    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        return Answer(Status.NOT_CONVERGED, Finding.NONE, "Nothing was looked for.")


class Alone:
    """A class like a method that does not inherit from it."""

    name, family, title, tolerance = "alone", "hand", "Alone", 1e-9

    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        return Plain().solve(assembly, settings)


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
    methods = map(load_method, method_names())
    assert not modules & {method.solver.partition(":")[0] for method in methods if isinstance(method, Listed)}
    assert not {name for name in modules if name.startswith("methods.") and name.endswith("kernels")}


def test_a_run_imports_the_solver_of_its_method_alone():
    modules = imported(COMMAND, "run", "la-associated", "single-block")
    assert {"scipy", "highspy", "methods.la.associated"} <= modules
    assert not modules & {"osqp", "pymunk", "sqlite3", "pandas", "matplotlib"}


@pytest.mark.parametrize("name", [name for name in shipped(method_names()) if name not in ("dummy", "de-mujoco")])
def test_a_listed_method_leads_to_what_solves_it(name: str):
    listed = load_method(name)
    assert isinstance(listed, Listed)
    assert listed.name == name
    found = resolve_name(listed.solver)
    package = getattr(found, "package", None)
    if package is None or importlib.util.find_spec(package) is not None:
        prepared(listed)
    assert issubclass(found, Solver)
    takes_motions = found.solve_from is not Solver.solve_from
    assert takes_motions == listed.follows_motions


@pytest.mark.parametrize("given", ["tests.engine.test_imports:Alone", "tests.engine.test_imports:GROUP"])
def test_what_an_entry_point_leads_to_must_be_a_method(given: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("harness.model.method_registry.method_points", lambda: (EntryPoint("alone", given, GROUP),))
    with pytest.raises(InputError, match=r"method alone.* is no method.*inherits from"):
        load_method("alone")


def test_of_two_packages_that_bring_a_method_of_one_name_none_answers(monkeypatch: pytest.MonkeyPatch):
    """The second one would have taken the place of `la` in every command, without a word."""
    own = next(point for point in method_points() if point.name == "la")
    points = (EntryPoint("la", "tests.engine.test_imports:Plain", GROUP), own)
    for place in ("harness.model.method_registry", "harness.engine.provenance"):
        monkeypatch.setattr(f"{place}.method_points", lambda: points)
    with pytest.raises(InputError, match="method la: it is brought by drystone and tests"):
        load_method("la")
    version = code_version.__wrapped__("la")
    monkeypatch.setattr("harness.engine.provenance.method_points", lambda: (own,))
    assert code_version.__wrapped__("la") != version, "a refusal would be found in the store when one is gone"


class Nameless(Method):
    """A method whose author stopped half-way."""

    name = "nameless"
    title = "of no family"

    def solve(self, assembly: Assembly, settings: Any) -> Answer:
        raise NotImplementedError


def test_a_method_that_lacks_what_it_must_say_is_refused_and_the_list_goes_on(monkeypatch: pytest.MonkeyPatch):
    """`drystone list methods` ended in an AttributeError and listed none."""
    point = EntryPoint("nameless", "tests.engine.test_imports:Nameless", GROUP)
    monkeypatch.setattr("harness.model.method_registry.method_points", lambda: (point,))
    with pytest.raises(InputError, match=r"method nameless: it has no family. Give its class family, tolerance;"):
        load_method("nameless")
    done = CliRunner().invoke(main, ["list", "methods"])
    assert done.exit_code == 0
    assert "it has no family" in " ".join(done.stdout.split())


@pytest.mark.parametrize("given", [Alone(), Dummy, None])
def test_what_is_given_in_place_of_a_name_must_be_a_method(given: object):
    with pytest.raises(InputError, match=r"is no method.*inherits from"):
        drystone.analyse(drystone.library_wall("single-block"), given)


def test_a_method_has_defaults_for_all_but_what_it_says_and_solves():
    method = Plain()
    assert prepared(method) is method
    assert (method.fresh_process, method.shares_work, method.follows_motions) == (False, False, False)
    assert method.traits == Traits()
    assert method.Settings().model_dump() == {}
    with pytest.raises(NotImplementedError):
        method.solve_from(drystone.library_wall("single-block").assembly, method.Settings(), [])
    assert drystone.analyse(drystone.library_wall("single-block"), method).finding is Finding.NONE
