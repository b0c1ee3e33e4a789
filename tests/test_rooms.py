"""A class name of the methods leads to one place, options are passed, and benchmarks run on one runner."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
MODULES = [path for path in (ROOT / "methods").rglob("*.py") if path.name != "__init__.py"]


def test_no_two_classes_of_the_methods_have_one_name():
    classes = [
        node.name
        for path in MODULES
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_")
    ]
    assert len(MODULES) > 80
    assert len(classes) > 100
    assert [name for name, count in Counter(classes).items() if count > 1] == []


def test_a_class_name_has_one_meaning_in_the_whole_house():
    """A name of two classes misleads. Public classes may refine one of the engine by its name."""
    public = {"Comparison", "Result", "Wall"}
    places: dict[str, list[str]] = {}
    for room in ("methods", "harness", "drystone", "reports", "cases"):
        for path in (ROOT / room).rglob("*.py"):
            for node in ast.parse(path.read_text(encoding="utf-8")).body:
                if isinstance(node, ast.ClassDef):
                    places.setdefault(node.name, []).append(str(path.relative_to(ROOT)))
    twice = {name: found for name, found in places.items() if len(found) > 1}
    assert set(twice) <= public, twice
    assert all(len([path for path in found if path.startswith("drystone/")]) == 1 for found in twice.values()), twice


def benchmarks(*words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "benchmarks", *words]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def test_benchmarks_are_listed_with_what_they_measure():
    done = benchmarks()
    assert done.returncode == 0, done.stderr
    listed = {line.split()[0] for line in done.stdout.splitlines()}
    assert listed == {path.stem for path in (ROOT / "benchmarks").glob("[a-z]*.py")} - {"walls"}
    assert all(len(line.split(maxsplit=1)[1]) > 20 for line in done.stdout.splitlines())


def test_unknown_benchmark_is_refused_with_the_list_of_those_there_are():
    done = benchmarks("speed")
    assert done.returncode == 2
    assert "overhead" in done.stdout


def test_list_of_benchmarks_ends_without_a_word_where_its_reader_has_left():
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks"], cwd=ROOT, stdout=writing, stderr=subprocess.PIPE, check=False
    )
    os.close(writing)
    assert (done.returncode, done.stderr) == (0, b"")


def modules() -> list[tuple[Path, ast.Module]]:
    """The modules in which options are passed, parsed."""
    paths = [path for room in ("methods", "harness", "reports") for path in (ROOT / room).rglob("*.py")]
    return [(path, ast.parse(path.read_text(encoding="utf-8"))) for path in paths]


def dataclasses_of(parsed: list[tuple[Path, ast.Module]]) -> dict[str, tuple[bool, set[str]]]:
    """By name of each dataclass whether it is frozen, and its fields with a default."""
    found: dict[str, tuple[bool, set[str]]] = {}
    for _, module in parsed:
        for node in ast.walk(module):
            if not isinstance(node, ast.ClassDef):
                continue
            made_by = [ast.unparse(decorator) for decorator in node.decorator_list]
            if any(word.startswith("dataclass") for word in made_by):
                fields = [line for line in node.body if isinstance(line, ast.AnnAssign) and line.value is not None]
                names = {ast.unparse(line.target) for line in fields if "ClassVar" not in ast.unparse(line.annotation)}
                found[node.name] = any("frozen=True" in word for word in made_by), names
    return found


def called(node: ast.AST | None) -> str:
    """The name of what an expression calls; empty where it is no call."""
    return ast.unparse(node.func).split(".")[-1] if isinstance(node, ast.Call) else ""


def test_no_module_holds_an_instance_of_a_dataclass():
    """Options are passed as arguments. The row of a method (`Listed`), a look (`Mark`) and tables of rows are data."""
    parsed = modules()
    known = dataclasses_of(parsed).keys() - {"Listed", "Mark"}
    held = []
    for path, module in parsed:
        for line in module.body:
            if isinstance(line, ast.Assign | ast.AnnAssign) and line.value is not None:
                several = isinstance(line, ast.Assign) and isinstance(line.targets[0], ast.Tuple)
                values = line.value.elts if several and isinstance(line.value, ast.Tuple) else [line.value]
                held += [f"{path.relative_to(ROOT)}: {called(value)}" for value in values if called(value) in known]
    assert len(known) > 200
    assert held == []


def test_no_default_of_an_option_is_read_from_its_class():
    """Read so, it would be the same for all who pass another."""
    parsed = modules()
    defaults = {name: fields for name, (_, fields) in dataclasses_of(parsed).items()}
    read = [
        f"{path.relative_to(ROOT)}: {node.value.id}.{node.attr}"
        for path, module in parsed
        for node in ast.walk(module)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name)
        if node.attr in defaults.get(node.value.id, ())
    ]
    assert read == []


def test_defaults_of_arguments_and_fields_that_are_instances_are_frozen():
    """One instance serves all calls, so none may change it."""
    parsed = modules()
    known = dataclasses_of(parsed)
    used = []
    for path, module in parsed:
        for node in ast.walk(module):
            if isinstance(node, ast.FunctionDef):
                values: list[ast.expr | None] = [*node.args.defaults, *node.args.kw_defaults]
            elif isinstance(node, ast.ClassDef):
                values = [line.value for line in node.body if isinstance(line, ast.AnnAssign)]
            else:
                continue
            used += [(f"{path.relative_to(ROOT)}: {called(value)}", called(value)) for value in values if called(value)]
    given = [(where, name) for where, name in used if name in known]
    assert len(given) > 40
    assert [where for where, name in given if not known[name][0]] == []
    # Calls that make no instance of our own, or an immutable one; `Traits` is a frozen model of pydantic.
    plain = {"field", "Field", "PrivateAttr", "float", "Path", "TypeAdapter", "frozenset", "Traits"}
    assert sorted({name for _, name in used} - known.keys() - plain) == []
