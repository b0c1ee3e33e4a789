"""What the pages for contributors say of the code is so."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PLACES = re.compile(r"`((?:drystone|harness|methods|reports|cases|docs|tests|benchmarks|examples)/[\w./-]*)`")


@pytest.mark.parametrize("page", ["CONTRIBUTING.md"])
def test_every_place_that_is_named_is_there(page: str):
    named = PLACES.findall((ROOT / page).read_text(encoding="utf-8"))
    assert len(named) > 15
    assert [place for place in named if not (ROOT / place).exists()] == []


def test_every_page_of_the_docs_is_in_the_index():
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    listed = {line.strip() for line in index.splitlines()}
    globs = [line for line in listed if "*" in line]
    pages = [path.relative_to(ROOT / "docs") for path in (ROOT / "docs").rglob("*.md") if "generated" not in path.parts]
    missing = [
        str(page)
        for page in pages
        if page.name != "index.md"
        and str(page.with_suffix("")) not in listed
        and not any(page.with_suffix("").match(pattern) for pattern in globs)
    ]
    assert missing == []
