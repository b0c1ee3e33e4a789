"""The steps of a load path as a reader meets them: by pointer, by keyboard, and as a list where there is no script."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from harness.model.comparison import CaseResults, ComparisonRun
from reports.page.build import write_report
from tests.browser.opened import Opened
from tests.reports.test_steps import results

pytestmark = pytest.mark.browser
NAMES = ["0.1: ", "0.2: ", "0.35: "]


@pytest.fixture(scope="module")
def stepped(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A report with one load path of three steps."""
    path = tmp_path_factory.mktemp("steps") / "report.html"
    case, item = results()
    write_report(ComparisonRun("one", "", "", [CaseResults(case, item.results)]), path)
    return path


@pytest.fixture
def opened(browser: Browser, stepped: Path) -> Iterator[Opened]:
    found = Opened(browser, stepped)
    found.look_at("figure.stepped")
    yield found
    found.context.close()


def lit(opened: Opened) -> tuple[list[str], str | None, str | None]:
    """The step that is named, the place of the ring in the chart, and the line of the joint in the wall."""
    figure = opened.page.locator("figure.stepped")
    named = figure.locator(".steps li:visible").all_inner_texts()
    return named, figure.locator(".here").get_attribute("d"), figure.locator(".lit").get_attribute("d")


def test_arrow_keys_walk_along_the_path_and_light_the_joint_of_each_step(opened: Opened):
    opened.page.locator("figure.stepped").focus()
    seen = [lit(opened)]
    for key in ("ArrowRight", "ArrowRight", "ArrowRight", "Home", "End", "ArrowLeft"):
        opened.page.keyboard.press(key)
        seen.append(lit(opened))
    order = [next(k for k, name in enumerate(NAMES) if named[0].startswith(name)) for named, _, _ in seen]
    assert all(len(named) == 1 for named, _, _ in seen)
    assert order == [0, 1, 2, 2, 0, 2, 1]
    assert len({ring for _, ring, _ in seen}) == 3
    assert seen[0][2] == seen[2][2] != seen[1][2], "the first joint, another, and the first again"
    assert opened.complaints == []


def test_pointer_over_a_dot_names_its_step(opened: Opened):
    page = opened.page
    for wanted in (2, 0, 1):
        x, y = (float(v) for v in (page.locator(".steps li").nth(wanted).get_attribute("data-at") or "").split())
        to = page.locator("figure.stepped svg.chart").evaluate(
            "(svg, [x, y]) => { const p = new DOMPoint(x, y).matrixTransform(svg.getScreenCTM()); return [p.x, p.y]; }",
            [x, y],
        )
        page.mouse.move(*to)
        assert lit(opened)[0][0].startswith(NAMES[wanted])


def test_joint_is_lit_on_the_wall_itself(opened: Opened):
    figure = opened.page.locator("figure.stepped")
    box, line = (figure.locator(name).bounding_box() for name in (".spot", ".lit"))
    assert box
    assert line
    assert box["x"] <= line["x"] + line["width"] / 2 <= box["x"] + box["width"]
    assert box["y"] <= line["y"] + line["height"] / 2 <= box["y"] + box["height"]
    assert figure.locator("use").evaluate("use => use.getBBox().width") > 1000.0, "the wall is drawn below"


def test_all_steps_are_listed_without_the_script(browser: Browser, stepped: Path):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(stepped.as_uri())
    page.evaluate("document.querySelectorAll('main details').forEach((fold) => { fold.open = true; })")
    steps = page.locator(".steps li")
    assert steps.count() == 3
    assert all(steps.nth(k).is_visible() for k in range(3))
    assert not page.locator(".spot").first.is_visible()
    context.close()
