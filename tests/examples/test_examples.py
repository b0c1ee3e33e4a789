"""Every example prints what its docstring promises."""

from __future__ import annotations

import ast
import re
import runpy
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = sorted((ROOT / "examples").glob("*.py"))
NUMBER = re.compile(r"-?\d+(?:\.(\d+))?")


def expected(script: Path) -> list[str]:
    """The lines below "Expected:" in the docstring of a script."""
    text = ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))) or ""
    question, _, lines = text.partition("\n\nExpected:\n\n")
    assert question.split("\n")[0].endswith("?"), "an example starts with its question, in one sentence"
    return [line.strip() for line in lines.splitlines()]


def test_there_are_about_twenty():
    assert len(SCRIPTS) >= 20


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_an_example_prints_what_it_promises(
    script: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [str(script)])
    promised = expected(script)
    runpy.run_path(str(script), run_name="__main__")
    printed = capsys.readouterr().out.splitlines()
    assert [NUMBER.sub("#", line) for line in printed] == [NUMBER.sub("#", line) for line in promised]
    for line, promise in zip(printed, promised, strict=True):
        for found, value in zip(NUMBER.finditer(line), NUMBER.finditer(promise), strict=True):
            rounding = 1.01 * 10.0 ** -len(value[1]) if value[1] else 0.0  # one unit of the last digit printed
            assert abs(float(found[0]) - float(value[0])) <= rounding, line


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_an_example_is_short_and_shown_in_the_docs(script: Path):
    assert 10 <= len(script.read_text(encoding="utf-8").splitlines()) <= 50
    page = (ROOT / "docs" / "examples.md").read_text(encoding="utf-8")
    assert f"```{{literalinclude}} ../examples/{script.name}\n" in page
