"""The sliders of the page for teaching."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from reports.page.learn import block_answers
from tests.reports.test_learn import page


@pytest.mark.browser
def test_sliders_follow_the_closed_forms(browser: Browser, tmp_path: Path):
    path = tmp_path / "learn.html"
    path.write_text(page(), encoding="utf-8")
    opened = browser.new_page(viewport={"width": 360, "height": 700})
    faults: list[str] = []
    opened.on("console", lambda message: faults.append(message.text))
    opened.on("pageerror", lambda error: faults.append(str(error)))
    opened.goto(path.as_uri())
    for rear, front in ((0.8, 0.2), (0.3, 0.7)):
        for name, value in (("rear", rear), ("front", front)):
            opened.locator(f"#{name}").fill(str(value))
        expected = block_answers(rear, front)
        for name in ("least", "greatest", "springs"):
            assert opened.locator(f"#{name}").inner_text() == f"{getattr(expected, name):.4f}"
    before = opened.locator("#springs").inner_text()
    opened.locator("#stiffness").fill("3")
    assert opened.locator("#springs").inner_text() == before
    assert opened.evaluate("document.documentElement.scrollWidth") == 360
    assert faults == []
    opened.close()
