"""The report as a reader meets it: opens offline and fast, moves, sorts, filters, prints, and can be used by all."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from reports.page import build
from tests.browser.opened import DESKTOP, PHONE, TABLET, UNDER_MENU, WIDE, Opened, Pages
from tests.reports import samples

pytestmark = pytest.mark.browser
QUICK = ("phone-dark", "desktop-light")
"""Pages that are searched for faults of accessibility outside the full tier, six seconds each."""


@pytest.fixture
def opened(browser: Browser, report: Path) -> Iterator[Opened]:
    """A page of its own, for a test that changes it."""
    found = Opened(browser, report)
    found.unfold()
    yield found
    found.context.close()


def test_page_asks_for_nothing_and_complains_of_nothing(seen: Pages, report: Path):
    opened = seen(DESKTOP)
    assert opened.requests == [report.as_uri()]
    assert opened.complaints == []


def test_hostile_names_are_shown_as_text(opened: Opened):
    opened.look_at("#case-2 [data-kind=mechanism] svg")
    assert opened.page.locator("img").count() == 0
    assert opened.page.locator("main").get_by_text(samples.SCRIPT).filter(visible=True).count() > 0
    opened.page.locator("#case-2 [data-kind=mechanism] path[data-block='1']").first.hover()
    tip = opened.page.locator(".tip")
    assert samples.CLOSING in tip.inner_text()
    assert opened.complaints == []


def test_every_figure_is_drawn(seen: Pages):
    opened = seen(DESKTOP)
    figures = opened.page.locator("[data-kind] svg")
    assert figures.count() == 2 * (4 + 5 + 1) + opened.page.locator(".trio svg").count()
    empty = figures.evaluate_all("all => all.filter(svg => svg.childElementCount === 0).length")
    assert empty == 0


def test_slider_moves_the_blocks_of_all_methods(opened: Opened):
    section = opened.page.locator("#case-1")
    opened.look_at("#case-1 .tools")
    read = "all => all.map(path => path.getAttribute('transform')).filter(Boolean)"
    before = section.locator("path.moves").evaluate_all(read)
    section.locator("input[type=range]").evaluate(
        "slider => { slider.value = 300; slider.dispatchEvent(new Event('input', {bubbles: true})); }"
    )
    after = section.locator("path.moves").evaluate_all(read)
    assert len(before) == len(after) > 5
    assert all(first != second for first, second in zip(before, after, strict=True))
    assert section.locator("output").inner_text() == "300 %"


def test_slider_works_with_the_keyboard(opened: Opened):
    slider = opened.page.locator("#case-1 input[type=range]")
    slider.focus()
    opened.page.keyboard.press("ArrowRight")
    assert slider.input_value() == "105"


def test_slider_at_zero_puts_the_wall_back(opened: Opened):
    opened.look_at("#case-1 .tools")
    section = opened.page.locator("#case-1")
    section.locator("input[type=range]").evaluate(
        "slider => { slider.value = 0; slider.dispatchEvent(new Event('input', {bubbles: true})); }"
    )
    moving = section.locator("[data-kind] path.moves")
    transforms = moving.evaluate_all("all => all.map(path => path.getAttribute('transform'))")
    assert {tuple(float(x) for x in item[7:-1].split()) for item in transforms} == {(1, 0, 0, 1, 0, 0)}


def test_flow_of_forces_replaces_resultants(opened: Opened):
    opened.look_at("#case-1 .tools")
    section = opened.page.locator("#case-1")
    shown = {name: section.locator(f".panel .{name}") for name in ("force", "said", "ring", "thrust")}
    assert {name: found.first.is_visible() for name, found in shown.items() if found.count()} == {
        "force": True,
        "said": True,
        "thrust": False,
    }
    section.get_by_label("flow of forces").check()
    assert not shown["force"].first.is_visible()
    assert not shown["said"].first.is_visible()
    assert shown["thrust"].first.is_visible()


def test_resultants_are_arrows_with_their_size_and_a_scale(seen: Pages):
    opened = seen(DESKTOP)
    forces = opened.page.locator("#case-1 [data-kind=forces] svg").first
    groups = forces.locator("g[data-joint]")
    arrows = forces.locator("path:is(.force, .full)")
    assert groups.count() == arrows.count() >= forces.locator("text.said").count() > 0
    assert re.fullmatch(r"[0-9.]+ m[0-9.]+ kN", "".join(forces.locator("text:not(.said)").all_text_contents()))
    assert (opened.page.locator("#case-1 .sheet svg.wall text:not(.said)").last.text_content() or "").endswith(" m")


def test_a_mechanism_stays_in_its_picture_at_the_end_of_the_slider(opened: Opened):
    opened.look_at("#case-1 .tools")
    section = opened.page.locator("#case-1")
    section.locator("input[type=range]").evaluate(
        "slider => { slider.value = slider.max; slider.dispatchEvent(new Event('input', {bubbles: true})); }"
    )
    outside = section.locator("[data-kind=mechanism] svg").evaluate_all(
        """all => all.flatMap((svg) => {
          const frame = svg.getBoundingClientRect();
          const boxes = [...svg.querySelectorAll('path.moves')].map((path) => path.getBoundingClientRect());
          const beside = (box) => box.left < frame.left - 1 || box.right > frame.right + 1;
          return boxes.filter((box) => beside(box) || box.top < frame.top - 1 || box.bottom > frame.bottom + 1);
        }).length"""
    )
    assert outside == 0


def test_hover_shows_the_values_of_an_interface(opened: Opened):
    opened.look_at("#case-1 [data-kind=forces] svg")
    opened.page.locator("#case-1 [data-kind=forces] path.force").first.hover(force=True)
    text = opened.page.locator(".tip").inner_text()
    assert "kN" in text
    assert "friction used: 50 %" in text


def column(page: Page, number: int) -> list[str]:
    """The visible cells of a column of the table of runs."""
    cells = page.locator(f"#runs-table tbody tr:visible > :nth-child({number})")
    return [text.strip() for text in cells.all_inner_texts()]


def test_runs_are_sorted_by_a_click_on_the_head(opened: Opened):
    page = opened.page
    original = column(page, 2)
    button = page.locator("#runs-table thead").get_by_role("button", name="CPU time")
    button.click()
    head = page.locator("#runs-table thead th").filter(has_text="CPU time")
    assert head.get_attribute("aria-sort") == "ascending"
    times = [
        float(x)
        for x in page.locator("#runs-table tbody td:nth-child(9)").evaluate_all("a => a.map(c => c.dataset.sort)")
    ]
    assert times == sorted(times)
    button.click()
    assert head.get_attribute("aria-sort") == "descending"
    assert column(page, 2)[0] in ("fe-qp", "de"), "the runs that failed after 60 s"
    button.click()
    assert head.get_attribute("aria-sort") is None
    assert column(page, 2) == original


def test_runs_without_a_value_sort_last_either_way(opened: Opened):
    button = opened.page.locator("#runs-table thead").get_by_role("button", name="Multiplier")
    for _ in range(2):
        button.click()
        assert column(opened.page, 3)[-2:] == ["–", "–"]


def test_runs_are_filtered_by_word_method_and_trouble(opened: Opened):
    page = opened.page
    page.get_by_label("Words in the row").fill("timeout wall-21")
    assert column(page, 2) == ["fe-qp"]
    assert page.locator("#runs-count").inner_text() == "1 of 12 runs"
    page.get_by_role("button", name="Show all").click()
    page.wait_for_timeout(50)
    assert len(column(page, 2)) == 12
    page.get_by_label("Method", exact=True).select_option("la")
    assert set(column(page, 2)) == {"la"}
    page.get_by_role("button", name="Show all").click()
    page.get_by_label("Runs", exact=True).select_option("trouble")
    assert sorted(column(page, 2)) == ["de", "de", "fe-qp", "la-paper"]


@pytest.mark.parametrize("size", [PHONE, TABLET, DESKTOP, WIDE], ids=["phone", "tablet", "desktop", "wide"])
def test_page_never_scrolls_sideways(seen: Pages, size: Any):
    assert seen(size).page.evaluate("document.documentElement.scrollWidth") <= size["width"]


@pytest.mark.parametrize(
    ("size", "scheme"),
    [
        pytest.param(size, scheme, id=f"{name}-{scheme}", marks=[pytest.mark.slow] * (f"{name}-{scheme}" not in QUICK))
        for name, size in {"phone": PHONE, "tablet": TABLET, "desktop": DESKTOP, "wide": WIDE}.items()
        for scheme in ("light", "dark")
    ],
)
def test_no_serious_accessibility_fault(seen: Pages, size: Any, scheme: Any):
    page = seen(size).page
    page.emulate_media(color_scheme=scheme)
    page.evaluate(files("axe_core_python").joinpath("axe.min.js").read_text(encoding="utf-8"))
    found = page.evaluate("axe.run(document, {resultTypes: ['violations']})")
    page.emulate_media(color_scheme="null")
    faults = [
        (fault["id"], fault["impact"], [node["target"] for node in fault["nodes"]][:3]) for fault in found["violations"]
    ]
    assert [fault for fault in faults if fault[1] in ("serious", "critical")] == []
    assert len(found["passes"]) > 15, "axe has looked"


def test_report_prints_with_all_drawings(opened: Opened, tmp_path: Path):
    path = tmp_path / "report.pdf"
    content = opened.page.pdf(path=str(path), format="A4", print_background=True)
    assert content.startswith(b"%PDF")
    empty = opened.page.locator("[data-kind] svg").evaluate_all(
        "all => all.filter(s => s.childElementCount === 0).length"
    )
    assert empty == 0, "printing draws what was not scrolled to yet"


def test_packed_drawings_are_the_same_as_those_that_are_not(
    browser: Browser, report: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    read = "all => all.map(svg => svg.innerHTML)"
    plain = Opened(browser, report)
    expected = plain.page.locator("[data-kind] svg").evaluate_all(read)
    plain.context.close()
    monkeypatch.setattr(build, "INLINE", 0)
    path = tmp_path / "packed.html"
    path.write_text(build.render(samples.typical(), data_folder="report-data"), encoding="utf-8")
    opened = Opened(browser, path)
    figures = opened.page.locator("[data-kind] svg")
    assert figures.last.evaluate("svg => svg.childElementCount") == 0, "far off"
    opened.see_everything()
    assert figures.evaluate_all(read) == expected
    assert opened.complaints == []
    opened.page.reload()
    opened.page.wait_for_selector("#packed[data-unpacked]", state="attached")
    opened.page.pdf(path=str(tmp_path / "report.pdf"))
    assert figures.evaluate_all(read) == expected, "printing fills what was not scrolled to yet"
    opened.context.close()


def test_tables_stand_without_the_script(browser: Browser, report: Path):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(report.as_uri())
    page.evaluate("document.querySelectorAll('main details').forEach((fold) => { fold.open = true; })")
    assert page.locator("#runs-table tbody tr:visible").count() == 12
    assert page.locator("svg.wall").first.is_visible()
    drawn = page.locator("[data-kind] svg.wall:visible").count()
    assert drawn == page.locator("[data-kind] svg").count() > 0, "mechanisms and forces are drawn"
    assert not page.locator("#runs-filter").is_visible(), "no controls that would do nothing"
    context.close()


@pytest.mark.parametrize("size", [PHONE, DESKTOP], ids=["phone", "desktop"])
def test_links_lead_to_their_place(browser: Browser, report: Path, size: Any):
    opened = Opened(browser, report, size)
    for target in ("#case-2", "#provenance", "#case-1", "#how-run-1-2", "#run-0-1"):
        opened.page.locator(f"a[href='{target}']").first.evaluate("link => link.click()")
        opened.page.wait_for_timeout(400)
        top = opened.page.locator(target).evaluate("e => e.getBoundingClientRect().top") - UNDER_MENU
        bottom = opened.page.evaluate("document.documentElement.scrollHeight - window.scrollY - window.innerHeight")
        assert -3 <= top <= 3 or (0 <= top < size["height"] and bottom <= 3), target
    opened.context.close()


@pytest.mark.slow
def test_sixty_five_cases_by_eight_methods_open_fast(browser: Browser, tmp_path: Path):
    path = tmp_path / "large.html"
    path.write_text(build.render(samples.large(65), data_folder="large-data"), encoding="utf-8")
    context = browser.new_context(viewport=DESKTOP)
    page = context.new_page()
    session = context.new_cdp_session(page)
    session.send("Performance.enable", {"timeDomain": "threadTicks"})
    page.goto(path.as_uri())
    metrics = {item["name"]: item["value"] for item in session.send("Performance.getMetrics")["metrics"]}
    assert page.locator("#runs-count").text_content() == "520 runs"
    context.close()
    # CPU seconds of the page's thread, which other work on the machine does not count in. A second is the
    # requirement and 0.7 is usual; half as much again is left for a slower processor.
    assert 0.0 < metrics["TaskDuration"] < 1.5
    assert path.stat().st_size < 5_000_000


def test_policy_runs_the_scripts_of_the_page_and_no_other(browser: Browser, report: Path):
    context = browser.new_context(viewport=DESKTOP)
    page = context.new_page()
    complaints: list[str] = []
    page.on("console", lambda message: complaints.append(message.text))
    page.goto(report.as_uri())
    assert page.evaluate("document.querySelectorAll('[data-kind] svg').length") > 0
    page.evaluate("window.scrollTo({top: document.querySelector('[data-kind] svg').getBoundingClientRect().top})")
    page.wait_for_timeout(300)
    assert page.evaluate("document.querySelector('[data-kind] svg').childElementCount") > 0
    assert complaints == []
    page.evaluate(
        "() => { const s = document.createElement('script'); s.textContent = 'window.intruder = 1';"
        " document.body.append(s); const b = document.createElement('b');"
        " b.setAttribute('onclick', 'window.intruder = 2');"
        " document.body.append(b); b.click(); }"
    )
    assert page.evaluate("window.intruder === undefined")
    assert any("Content Security Policy" in text for text in complaints)
    context.close()
