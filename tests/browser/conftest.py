"""A report in Debian's chromium, through playwright: no request leaves the machine."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, sync_playwright

from harness.engine.store import open_store
from harness.model.errors import InputError
from reports.page.build import write_report
from tests.browser.opened import Opened, Pages
from tests.reports import samples

CHROMIUM = "/usr/bin/chromium"
COMPARED = Path(__file__).parents[2] / "out" / "drystone.sqlite"
"""Where `make compare` keeps its results; what this code has not answered is not taken from it."""


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """One browser for all tests."""
    if not Path(CHROMIUM).exists():
        pytest.skip(f"there is no {CHROMIUM}: apt-get install chromium")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu", "--disable-background-networking"]
        )
        yield started
        started.close()


@pytest.fixture(scope="session")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A typical report, a hostile case included."""
    path = tmp_path_factory.mktemp("report") / "report.html"
    write_report(samples.typical(), path)
    return path


def _pages(browser: Browser, report: Path, prepare: Callable[[Opened], None]) -> Iterator[Pages]:
    """Pages of a report by the size of their screen, each opened once."""
    kept: dict[tuple[int, ...], Opened] = {}

    def page(size: Any) -> Opened:
        key = tuple(size.values())
        if key not in kept:
            kept[key] = Opened(browser, report, size)
            prepare(kept[key])
        return kept[key]

    yield page
    for opened in kept.values():
        opened.context.close()


@pytest.fixture(scope="session")
def seen(browser: Browser, report: Path) -> Iterator[Pages]:
    """The typical report unfolded and seen to its end, for tests that only read."""
    yield from _pages(browser, report, Opened.see_everything)


@pytest.fixture(scope="session")
def untouched(browser: Browser, report: Path) -> Iterator[Pages]:
    """The typical report as it opens, for tests that only read."""
    yield from _pages(browser, report, lambda opened: None)


@pytest.fixture(scope="session")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store for comparisons of shipped cases, with what `make compare` left if it ran before."""
    path = tmp_path_factory.mktemp("store") / "store.sqlite"
    if COMPARED.exists():
        with (
            closing(sqlite3.connect(f"{COMPARED.as_uri()}?mode=ro", uri=True)) as there,
            closing(sqlite3.connect(path)) as here,
        ):
            there.backup(here)
        try:
            with open_store(path):
                pass
        except InputError:  # of another version
            path.unlink()
    return path
