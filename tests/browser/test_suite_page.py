"""The page of suite small as it is handed round: short, light, fast, on few sheets, and whole on a phone."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from tests.browser.opened import DESKTOP, PHONE, Opened
from tests.commands import drystone

pytestmark = pytest.mark.browser
WORDS = """() => {
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  let words = 0;
  while (texts.nextNode()) {
    const text = texts.currentNode;
    if (text.parentElement.checkVisibility()) words += text.data.split(/\\s+/).filter(Boolean).length;
  }
  return words;
}"""
"""How many words are shown before anything is unfolded, those further down included."""


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory, store: Path) -> Path:
    """The page that `drystone compare --suite small` writes."""
    path = tmp_path_factory.mktemp("small") / "report.html"
    done = drystone("compare", "--suite", "small", "--report", path, "--store", store)
    assert done.returncode == 0, done.stderr
    return path


def test_page_is_short_and_light(browser: Browser, small: Path):
    opened = Opened(browser, small)
    words = opened.page.evaluate(WORDS)
    opened.context.close()
    assert 2_000 < words < 9_000, "half of the words of the first report"
    assert small.stat().st_size < 1_500_000


def test_page_is_ready_within_half_a_second_of_work(browser: Browser, small: Path):
    context = browser.new_context(viewport=DESKTOP)
    page = context.new_page()
    session = context.new_cdp_session(page)
    session.send("Performance.enable", {"timeDomain": "threadTicks"})
    page.goto(small.as_uri())
    metrics = {item["name"]: item["value"] for item in session.send("Performance.getMetrics")["metrics"]}
    context.close()
    assert 0.0 < metrics["TaskDuration"] < 0.5, "0.14 s on 28 November 2026, for 34,000 nodes"


@pytest.mark.parametrize("paper", ["A4", "Letter"])
def test_page_prints_on_at_most_fifteen_sheets(browser: Browser, small: Path, paper: str):
    opened = Opened(browser, small)
    printed = opened.page.pdf(format=paper, print_background=True)
    opened.context.close()
    assert 5 < len(re.findall(rb"/Type\s*/Page\b", printed)) <= 15


def test_drawings_and_charts_are_seen_whole_on_a_phone(browser: Browser, small: Path):
    opened = Opened(browser, small, PHONE)
    opened.unfold()
    figures = opened.page.locator("figure:visible")
    count = figures.count()
    wider = figures.evaluate_all("all => all.filter((figure) => figure.scrollWidth > figure.clientWidth + 1).length")
    charts = opened.page.locator("svg.chart:visible").count()
    opened.context.close()
    assert count > 60
    assert charts > 20
    assert wider == 0
