"""The engine and the report know no method by name: what a method is, it says itself, and `cases/` holds defaults."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from harness.model.library import library
from harness.model.method_registry import method_names

ROOT = Path(__file__).resolve().parents[2]
FILES = sorted(path for room in ("harness", "reports") for path in (ROOT / room).rglob("*.py"))
WORD = re.compile(r"(?<![\w-])[a-z]+(?:-[a-z]+)*(?![\w-])")


def _strings(path: Path) -> Iterator[tuple[int, str]]:
    """Strings of the code that are no docstrings."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    told = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in told:
            yield node.lineno, node.value


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_method_is_named(path: Path):
    names = {*method_names(), *library().families}
    found = [(line, text) for line, text in _strings(path) if names & set(WORD.findall(text))]
    assert found == []


def test_the_defaults_are_installed_methods():
    words = library()
    names = {*words.methods.compare, *words.methods.sweep, words.methods.one, words.methods.quick, *words.families}
    names |= {full.rpartition(".")[0] for full in words.settings.values()}
    assert names <= set(method_names())
