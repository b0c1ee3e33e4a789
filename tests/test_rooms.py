"""A class name of the methods leads to one place, options are passed, and benchmarks run on one runner."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
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
    paths = [path for room in ("methods", "harness", "reports", "drystone") for path in (ROOT / room).rglob("*.py")]
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


TABLES = {
    "drystone/cli/options.py: Limits",
    "drystone/skeletons/python/MODULE.py: Traits",
    "harness/conformance/walls.py: ClosedForm",
    "harness/formats/registry.py: Format",
    "harness/model/bar_forces.py: TableColumn",
    "reports/charts/dots.py: Mark",
    "reports/charts/families.py: _Parameter",
    "reports/drawing/looks.py: Look",
    "reports/page/build.py: Mark",
    "reports/page/glance.py: Mark",
    *(f"methods/{of}/methods.py: {name}" for of in ("de", "fe", "la", "peers") for name in ("Listed", "Traits")),
}
"""Rows of tables that are data, looks of drawings, and the defaults that the help of commands prints."""
STARTS = ("methods/la/sources/__init__.py", "methods/la/sources/arcs.py")
"""Tables of the starting-point strategies in their order, which `explore` and `ArcPaths` take as arguments."""


def held_by(body: list[ast.stmt]) -> Iterator[str]:
    """What is called when a module or a class is made, be it within a tuple, a mapping, a branch or another call."""
    for line in body:
        if isinstance(line, ast.ClassDef):  # annotated fields have their own test below
            yield from held_by([part for part in line.body if not isinstance(part, ast.AnnAssign)])
        elif not isinstance(line, ast.FunctionDef):
            left: list[ast.AST] = [line]
            while left:
                node = left.pop()
                if not isinstance(node, ast.Lambda | ast.FunctionDef):
                    yield from [called(node)] if called(node) else []
                    left.extend(ast.iter_child_nodes(node))


def test_no_module_holds_an_instance_of_options():
    """Options are passed as arguments: neither a dataclass, nor a model of pydantic, nor a copy of one is held."""
    parsed = modules()
    fields = {
        node.name
        for _, module in parsed
        for node in ast.walk(module)
        if isinstance(node, ast.ClassDef) and any(isinstance(line, ast.AnnAssign) for line in node.body)
    }
    known = fields | dataclasses_of(parsed).keys() | {"replace", "model_copy", "model_validate", "SimpleNamespace"}
    held = {
        f"{path.relative_to(ROOT)}: {name}"
        for path, module in parsed
        for name in held_by(module.body)
        if name in known and str(path.relative_to(ROOT)) not in STARTS
    }
    assert len(known) > 300
    assert held == TABLES


def test_no_module_of_the_methods_holds_a_group_of_numbers_by_name():
    """That would be a tuning object of another kind: a mapping, or a class without fields."""
    groups = []
    for path, module in modules():
        if not path.is_relative_to(ROOT / "methods"):
            continue
        for line in module.body:
            body = line.body if isinstance(line, ast.ClassDef) else [line]
            for part in body:
                value = part.value if isinstance(part, ast.Assign | ast.AnnAssign) else None
                in_class = isinstance(line, ast.ClassDef) and isinstance(part, ast.Assign)
                mapping = isinstance(value, ast.Dict) and any(
                    isinstance(key, ast.Constant) and isinstance(key.value, str) for key in value.keys
                )
                numbers = [node for node in ast.walk(value) if _is_number(node)] if in_class or mapping else []
                groups += [f"{path.relative_to(ROOT)}: {ast.unparse(part)}" for _ in numbers[:1]]
    assert groups == ["methods/dummy.py: tolerance = 1e-09"]


def _is_number(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and type(node.value) in (int, float)


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
    # Calls that make no instance of our own, or an immutable one; the last two are frozen models of pydantic.
    plain = {"field", "Field", "PrivateAttr", "float", "Path", "TypeAdapter", "frozenset", "Traits", "SettlingSteps"}
    assert sorted({name for _, name in used} - known.keys() - plain) == []
