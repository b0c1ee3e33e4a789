"""The first screen and the walls as they are seen: nothing too small, nothing over something else, and what moves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser

from tests.browser.opened import DESKTOP, PHONE, UNDER_MENU, WIDE, Opened, Pages

pytestmark = pytest.mark.browser
SMALLEST = 10.9
"""Least size of letters [px]: 11, less what a browser rounds."""
SEEN = """() => {
  const aside = ".sr, .skip, [hidden], title, script, style";
  const seen = (e) => e.checkVisibility({ checkVisibilityCSS: true }) && !e.closest(aside);
  const written = (e) => [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
  return [...document.body.querySelectorAll("*")].filter((e) => seen(e) && written(e)).map((e) => {
    const matrix = e instanceof SVGTextElement ? e.getScreenCTM() : null;
    const size = Number.parseFloat(getComputedStyle(e).fontSize) * (matrix ? Math.hypot(matrix.a, matrix.b) : 1);
    return [size, e.textContent.trim().slice(0, 30), e.getAttribute("class") || e.tagName];
  });
}"""
COVERED = """() => [...document.querySelectorAll("svg.wall, svg.chart")].flatMap((svg) => {
  const texts = [...svg.querySelectorAll("text")].filter((t) => t.checkVisibility() && t.getBoundingClientRect().width);
  const boxes = texts.map((t) => [t.getBoundingClientRect(), t.textContent]);
  const frame = svg.getBoundingClientRect();
  const out = boxes.filter(([b]) => b.left < frame.left - 1 || b.right > frame.right + 1 || b.bottom > frame.bottom + 2)
    .map(([, text]) => `clipped: ${text}`);
  /* The box of a line of text is a third higher than its letters: only what overlaps by more is a fault. */
  const over = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1
    && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 0.35 * Math.min(a.height, b.height);
  boxes.forEach(([a, text], k) => boxes.slice(k + 1).forEach(([b, other]) => {
    if (over(a, b)) out.push(`${svg.getAttribute("aria-label")}: ${text} over ${other}`);
  }));
  return out;
})"""

CROSSED = """() => [...document.querySelectorAll(".panel svg.wall")].flatMap((svg) => {
  const arrows = [...svg.querySelectorAll("path:is(.force, .full)")].filter((p) => p.checkVisibility());
  return [...svg.querySelectorAll("text.said")].filter((t) => t.checkVisibility()).filter((text) => {
    const box = text.getBBox();
    /* The letters stand in the middle half of the box of their line. */
    const points = [0.05, 0.35, 0.65, 0.95].flatMap((x) => [0.35, 0.6].map((y) =>
      new DOMPoint(box.x + x * box.width, box.y + y * box.height)));
    return arrows.some((arrow) => points.some((point) => arrow.isPointInFill(point)));
  }).map((text) => `${svg.getAttribute("aria-label")}: ${text.textContent}`);
})"""
AREAS = """all => all.map((path) => {
  const numbers = path.getAttribute("d").match(/-?[0-9.]+(e-?[0-9]+)?/g).map(Number);
  let area = 0;
  for (let i = 0; i < numbers.length; i += 8) {
    const [, , a, b, c, d, e, f] = numbers.slice(i, i + 8);
    area += Math.abs(a * (b + d) - b * (a + c) + (a + c) * (b + d + f) - (b + d) * (a + c + e)) / 2;
  }
  return area;
})"""


@pytest.mark.parametrize("size", [DESKTOP, WIDE], ids=["desktop", "wide"])
def test_first_screen_holds_the_three_mechanisms_at_one_scale_beside_the_papers_values(untouched: Pages, size: Any):
    opened = untouched(size)
    pictures = opened.page.locator(".trio svg.wall")
    boxes = [box for k in range(pictures.count()) if (box := pictures.nth(k).bounding_box())]
    assert len(boxes) == 3
    assert all(box["y"] + box["height"] <= size["height"] for box in boxes)
    assert len({round(box["y"]) for box in boxes}) == 1, "side by side"
    scales = pictures.evaluate_all("all => all.map(svg => svg.getScreenCTM().a)")
    assert max(scales) - min(scales) < 1e-6
    assert opened.page.locator(".glance .dots").count() == 2
    assert all(
        opened.page.locator(".glance .dots").nth(k).evaluate("e => e.getBoundingClientRect().bottom") <= size["height"]
        for k in range(2)
    )


@pytest.mark.parametrize("size", [DESKTOP, PHONE, WIDE], ids=["desktop", "phone", "wide"])
def test_letters_are_large_enough_to_read(seen: Pages, size: Any):
    found = seen(size).page.evaluate(SEEN)
    assert len(found) > 200
    assert [entry for entry in found if entry[0] < SMALLEST] == []


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_labels_cover_neither_each_other_nor_the_edge(seen: Pages, size: Any):
    assert seen(size).page.evaluate(COVERED) == []


def test_no_number_of_a_force_lies_over_an_arrow(seen: Pages):
    page = seen(DESKTOP).page
    assert page.locator(".panel text.said").count() > 20
    assert page.evaluate(CROSSED) == []


def test_cracks_open_with_the_slider_and_are_closed_at_rest(browser: Browser, report: Path):
    opened = Opened(browser, report)
    opened.look_at("#case-1 .tools")
    areas = []
    for amplitude in (0, 100, 300):
        opened.page.locator("#case-1 input[type=range]").evaluate(
            "(slider, to) => { slider.value = to; slider.dispatchEvent(new Event('input', {bubbles: true})); }",
            amplitude,
        )
        areas.append(opened.page.locator("#case-1 [data-kind=mechanism] path.crack").evaluate_all(AREAS))
    opened.context.close()
    assert len(areas[0]) > 0
    assert max(areas[0]) < 1e-6
    assert min(areas[1]) > 0.0
    assert all(far > 2.0 * near for near, far in zip(areas[1], areas[2], strict=True))


@pytest.mark.parametrize("size", [DESKTOP, WIDE], ids=["desktop", "wide"])
def test_no_table_is_wider_than_its_box(seen: Pages, size: Any):
    found = (
        seen(size)
        .page.locator(".scroll")
        .evaluate_all("all => all.map((box) => [box.scrollWidth - box.clientWidth, box.getAttribute('aria-label')])")
    )
    assert len(found) > 5
    assert [entry for entry in found if entry[0] > 1] == []


def test_menu_stays_in_sight_and_leads_back_to_the_top(browser: Browser, report: Path):
    opened = Opened(browser, report)
    opened.page.locator("a[href='#provenance']").first.click()
    opened.page.wait_for_timeout(400)
    menu = opened.page.locator("nav")
    assert menu.evaluate("e => e.getBoundingClientRect().top") == 0
    assert menu.evaluate("e => e.getBoundingClientRect().height") <= UNDER_MENU
    opened.page.get_by_role("link", name="Top").click()
    opened.page.wait_for_timeout(400)
    assert opened.page.evaluate("window.scrollY") < UNDER_MENU
    opened.context.close()


def test_link_opens_what_its_target_is_folded_into(browser: Browser, report: Path):
    opened = Opened(browser, report)
    row = opened.page.locator("#run-0-1")
    assert not row.is_visible()
    opened.page.goto(f"{report.as_uri()}#run-0-1")
    opened.page.wait_for_timeout(400)
    assert row.is_visible()
    opened.context.close()


def test_mechanism_moves_on_request_and_not_where_the_reader_wants_no_motion(browser: Browser, report: Path):
    opened = Opened(browser, report)
    button = opened.page.locator("#findings .play")
    read = "all => all.map(path => path.getAttribute('transform')).join()"
    moving = opened.page.locator("#findings path.moves")
    before = moving.evaluate_all(read)
    button.click()
    opened.page.wait_for_timeout(300)
    assert moving.evaluate_all(read) != before
    assert button.get_attribute("aria-pressed") == "true"
    button.click()
    assert button.get_attribute("aria-pressed") == "false"
    placed = moving.evaluate_all("all => all.map(path => path.transform.baseVal.consolidate().matrix.e)")
    opened.page.reload()
    again = moving.evaluate_all("all => all.map(path => path.transform.baseVal.consolidate().matrix.e)")
    assert placed == pytest.approx(again), "it stands as it was drawn"
    opened.page.emulate_media(reduced_motion="reduce")
    assert not button.is_visible()
    opened.context.close()


def test_overview_is_sorted_by_difference(browser: Browser, report: Path):
    opened = Opened(browser, report)
    names = opened.page.locator("#dots li > :first-child")
    first = names.all_inner_texts()
    opened.page.get_by_label("Order").select_option("spread")
    spreads = opened.page.locator("#dots li").evaluate_all("all => all.map(row => Number(row.dataset.spread))")
    assert spreads == sorted(spreads, reverse=True)
    assert spreads[0] > 0.0
    opened.page.get_by_label("Order").select_option("place")
    assert names.all_inner_texts() == first
    names.first.click()
    opened.page.wait_for_timeout(400)
    top = opened.page.locator(names.first.get_attribute("href") or "").evaluate("e => e.getBoundingClientRect().top")
    assert abs(top - UNDER_MENU) <= 3
    opened.context.close()


@pytest.mark.parametrize("size", [DESKTOP, PHONE, WIDE], ids=["desktop", "phone", "wide"])
def test_the_overview_says_what_it_counts_from(untouched: Pages, size: Any):
    labels = untouched(size).page.locator("#dots .ticks span span")
    shown = labels.evaluate_all(
        "all => all.filter((e) => e.checkVisibility({ checkVisibilityCSS: true })).map((e) => e.textContent)"
    )
    assert "least" in shown
    assert len(shown) > 1
