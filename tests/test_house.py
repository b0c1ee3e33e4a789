"""The house holds: no import cycles, no private names of others, each thing made in one place, abilities declared."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import grimp
import pytest

ROOT = Path(__file__).parents[1]
ROOMS = ("drystone", "harness", "methods", "cases", "reports")


@cache
def parsed() -> dict[str, ast.Module]:
    """The modules of the house, by their path from its root."""
    paths = sorted(path for room in ROOMS for path in (ROOT / room).rglob("*.py"))
    return {str(path.relative_to(ROOT)): ast.parse(path.read_text(encoding="utf-8")) for path in paths}


@cache
def of_tests() -> dict[str, ast.Module]:
    """The tests and what they share, by their path from the root of the house."""
    paths = sorted((ROOT / "tests").rglob("*.py"))
    return {str(path.relative_to(ROOT)): ast.parse(path.read_text(encoding="utf-8")) for path in paths}


def nodes(*rooms: str) -> Iterator[tuple[str, ast.AST]]:
    """Every node of the modules of some rooms, with the place of its module."""
    for place, module in parsed().items():
        if place.startswith(rooms or ROOMS):
            yield from ((place, node) for node in ast.walk(module))


@pytest.mark.parametrize("room", ROOMS)
def test_no_two_packages_or_modules_import_each_other(room: str):
    """Be it inside a function; imports for types alone run never, so they may."""
    graph = grimp.build_graph(*ROOMS, cache_dir=None, exclude_type_checking_imports=True)
    packages = [room, *graph.find_descendants(room)]
    breakers = [graph.nominate_cycle_breakers(package) for package in packages]
    assert sorted(arrow for found in breakers for arrow in found) == []


def test_no_module_and_no_test_imports_a_private_name():
    private = [
        f"{place}: from {node.module} import {alias.name}"
        for place, module in (parsed() | of_tests()).items()
        for node in ast.walk(module)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
        if (alias.name.startswith("_") and not alias.name.startswith("__"))
        or any(part.startswith("_") and not part.startswith("__") for part in (node.module or "").split("."))
    ]
    assert private == []


PRIVATE = {
    "harness/engine/worker.py: os._exit",  # documented: ends a child without what its parent has registered
    "methods/de/engines/sequential_impulses.py: Rows._make",  # of named tuples, documented
    "methods/dummy.py: os._exit",
    "methods/numerics/forks.py: os._exit",
    "methods/de/engines/pymunk_joints.py: arbiter._arbiter",  # the impulse of each contact point, not of the pair alone
}
"""Private names of libraries that nothing public stands for, and those that are public in spite of their name."""


def test_no_private_name_is_asked_of_what_another_module_made():
    """Objects of one class may ask each other."""
    asked = set()
    for place, module in parsed().items():
        used = [node for node in ast.walk(module) if isinstance(node, ast.Attribute)]
        own = {node.attr for node in used if isinstance(node.ctx, ast.Store) and ast.unparse(node.value) == "self"}
        fields = [node.target for node in ast.walk(module) if isinstance(node, ast.AnnAssign)]
        own |= {field.id for field in fields if isinstance(field, ast.Name)}
        own |= {node.name for node in ast.walk(module) if isinstance(node, ast.FunctionDef)}
        for node in used:
            private = node.attr.startswith("_") and not node.attr.startswith("__") and node.attr not in own
            if private and ast.unparse(node.value) not in ("self", "cls"):
                asked.add(f"{place}: {ast.unparse(node)}")
    assert asked == PRIVATE


LISTED = re.compile(r"^( *)(?:Args|Attributes):\n((?:\1 +.*\n?|\n)*)", re.MULTILINE)


def _listed(docstring: str) -> Iterator[str]:
    """The first names of the lines under Args and Attributes of a docstring."""
    for _, lines in LISTED.findall(docstring + "\n"):
        indent = min((len(line) - len(line.lstrip()) for line in lines.split("\n") if line.strip()), default=0)
        for line in lines.split("\n"):
            found = re.match(rf" {{{indent}}}((?:\*{{0,2}}\w+(?:, )?)+):", line)
            yield from (name.strip("* ") for name in found[1].split(",")) if found else ()


def _names_of(node: ast.FunctionDef | ast.ClassDef) -> set[str]:
    """Arguments of a function; of a class what it or an object of it holds, and what it is made of."""
    if isinstance(node, ast.FunctionDef):
        given = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs, node.args.vararg, node.args.kwarg]
        return {argument.arg for argument in given if argument}
    inside = list(ast.walk(node))
    stored = {part.attr for part in inside if isinstance(part, ast.Attribute) and isinstance(part.ctx, ast.Store)}
    stored |= {part.id for part in inside if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store)}
    made = [part for part in node.body if isinstance(part, ast.FunctionDef) and part.name == "__init__"]
    stored |= {name for part in made for name in _names_of(part)}
    return stored | {part.name for part in inside if isinstance(part, ast.FunctionDef)}


def test_docstrings_describe_the_names_that_there_are():
    wrong = [
        f"{place}: {node.name}: {name}"
        for place, node in nodes()
        if isinstance(node, ast.FunctionDef | ast.ClassDef)
        for name in _listed(ast.get_docstring(node) or "")
        if name not in _names_of(node)
    ]
    assert wrong == []


MADE = {
    "Answer": ("methods/", "harness/model/", "harness/engine/", "drystone/skeletons/"),
    "Result": ("harness/model/result.py",),
    "Comparison": ("harness/engine/verdict.py", "drystone/comparing.py"),
    "ComparisonRun": ("harness/engine/compare.py",),
    "Judgement": ("harness/engine/",),
    "code_version": ("harness/engine/run.py", "harness/engine/provenance.py", "harness/engine/cluster.py"),
}
"""What is made of parts, or stands for the code in a run's key, and where. Two classes are called `Comparison`."""


def _called(node: ast.AST) -> str:
    """The last name of what is called; empty where nothing is."""
    return ast.unparse(node.func).split("[")[0].split(".")[-1] if isinstance(node, ast.Call) else ""


@pytest.mark.parametrize("name", MADE)
def test_each_thing_is_made_in_one_place(name: str):
    places = {place for place, node in nodes() if _called(node) == name}
    assert places
    assert [place for place in places if not place.startswith(MADE[name])] == []


def test_shapes_of_a_wall_are_drawn_by_the_display_list_alone():
    """One module draws polygons with matplotlib and one writes them as SVG; files of walls are data (`exporting`)."""
    shapes = ("matplotlib.patches", "matplotlib.collections", "matplotlib.path")
    by_matplotlib = {
        place
        for place, node in nodes()
        if (isinstance(node, ast.ImportFrom) and node.module in shapes) or _called(node) == "add_patch"
    }
    assert by_matplotlib == {"reports/figures/plot.py"}
    as_svg = {
        place
        for place, node in nodes("reports/drawing", "drystone", "harness", "methods")
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and "<path" in node.value
    }
    assert as_svg == {"reports/drawing/svg.py", "reports/drawing/looks.py", "harness/formats/exporting.py"}


ASKED_OF_OTHERS = {
    "harness/model/foreign/description.py: Settings",
    "harness/model/json_text.py: os",
    "harness/model/writing.py: error",
    "harness/model/method_registry.py: found",
    "harness/formats/dxf.py: holder",
    "harness/formats/dxf.py: entity",
}
"""Objects of the standard library, pydantic, ezdxf and other packages that may lack an attribute."""


def test_what_an_object_may_do_is_declared_and_not_asked_by_getattr():
    asked = {
        f"{place}: {ast.unparse(node.args[0])}"
        for place, node in nodes()
        if _called(node) == "hasattr" or (_called(node) == "getattr" and isinstance(node, ast.Call) and node.args[2:])
    }
    tried = {
        place
        for place, node in nodes()
        if isinstance(node, ast.ExceptHandler) and node.type and ast.unparse(node.type) == "AttributeError"
    }
    assert (asked, tried) == (ASKED_OF_OTHERS, set())


def _reads_details(node: ast.AST) -> bool:
    """Whether it asks an answer's details for a name."""
    match node:
        case ast.Subscript(value=of) | ast.Call(func=ast.Attribute(value=of, attr="get" | "pop" | "setdefault")):
            return ast.unparse(of).split(".")[-1] == "details"
        case ast.Compare(ops=[ast.In() | ast.NotIn()], comparators=[of]):
            return ast.unparse(of).split(".")[-1] == "details"
    return False


def test_only_typed_readers_know_the_names_of_details():
    readers = {place for place, node in nodes("harness", "reports", "drystone", "cases") if _reads_details(node)}
    typed = {f"harness/model/{name}.py" for name in ("displaced", "followed", "load_steps")}
    assert readers == typed | {"harness/model/foreign/result_document.py"}
