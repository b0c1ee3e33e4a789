"""The picture of the README shows the first screen as it is now."""

from __future__ import annotations

import importlib.util
import io
import re
from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from playwright.sync_api import Browser

pytestmark = pytest.mark.browser
ROOT = Path(__file__).resolve().parents[2]


def figures() -> Any:
    spec = importlib.util.spec_from_file_location("figures", ROOT / "docs" / "figures.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_picture_of_the_first_screen_says_what_the_report_says_now(browser: Browser, store: Path):
    """`python docs/figures.py` draws it again where this fails."""
    kept = Image.open(ROOT / "docs" / "first-screen.png")
    words, picture = figures().first_screen(browser, store)
    assert kept.text["Description"].split() == words.split()
    assert kept.width == 1280
    assert abs(kept.height - Image.open(io.BytesIO(picture)).height) <= 60, "fonts differ, nothing else"


def test_readme_says_what_its_picture_says():
    words = Image.open(ROOT / "docs" / "first-screen.png").text["Description"]
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    told = readme[readme.index("What came of the paper's wall") : readme.index("The associated maximum, 0.58446")]
    numbers = re.findall(r"0\.\d{4,}", told)
    assert len(numbers) == 5
    assert all(number in words for number in numbers)
    assert readme.count("](docs/") + readme.count("](CONTRIBUTING") <= 12
