"""Pages are short to read, and the Python they show runs."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import drystone

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    path
    for path in (*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"))
    if "generated" not in path.relative_to(ROOT).parts
]
LONGEST = 100
"""Words of a paragraph at most: what is read at one go."""
FENCED = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
BREAK = re.compile(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.)\s)|\n(?=#)|\n(?=\|)")
WITH_PYTHON = [path for path in PAGES if "```python\n" in path.read_text(encoding="utf-8")]


@pytest.mark.parametrize("page", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_paragraph_has_over_a_hundred_words(page: Path):
    paragraphs = BREAK.split(FENCED.sub("", page.read_text(encoding="utf-8")))
    long = [(len(text.split()), text.strip()[:60]) for text in paragraphs if not text.lstrip().startswith("|")]
    assert [item for item in long if item[0] > LONGEST] == []


@pytest.mark.parametrize("page", WITH_PYTHON, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_python_of_a_page_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """The snippets of a page, one after the other as a reader would type them."""
    monkeypatch.chdir(tmp_path)
    scope: dict[str, object] = {}
    for snippet in re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE):
        exec(compile(snippet, str(page), "exec"), scope)


def test_page_of_the_package_has_all_its_functions_and_their_results():
    page = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    listed = {name for line in re.findall(r":members:(.*)", page) for name in line.replace(",", " ").split()}
    made = {name: getattr(drystone, name) for name in drystone.__all__}
    own = {name for name, thing in made.items() if getattr(thing, "__module__", "").startswith("drystone.")}
    assert sorted(own - listed) == []
