"""A page in a browser with what it asked for and complained about, and the sizes of screens."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, Page

PHONE, DESKTOP = {"width": 360, "height": 780}, {"width": 1280, "height": 900}
TABLET, WIDE = {"width": 768, "height": 1024}, {"width": 1920, "height": 1080}
UNDER_MENU = 48
"""Where the target of a link stands: below the menu, which stays in sight."""


class Opened:
    """A page with what it asked for and complained about."""

    def __init__(self, browser: Browser, path: Path, size: Any = None) -> None:
        self.context = browser.new_context(viewport=size or DESKTOP, bypass_csp=True)
        self.page: Page = self.context.new_page()
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("dialog", lambda dialog: (self.complaints.append(f"dialog {dialog.message}"), dialog.dismiss()))
        self.page.goto(path.as_uri())

    def unfold(self) -> None:
        """Open all that is folded."""
        self.page.evaluate("document.querySelectorAll('main details').forEach((fold) => { fold.open = true; })")

    def see_everything(self) -> None:
        """Unfold and scroll through the page, so that every figure is drawn."""
        self.unfold()
        top = 0
        # The page grows as it is seen, because sections far off are laid out only when they come near.
        while top < int(self.page.evaluate("document.documentElement.scrollHeight")):
            self.page.evaluate(f"window.scrollTo({{top: {top}, behavior: 'instant'}})")
            self.page.wait_for_timeout(20)
            top += 700

    def look_at(self, selector: str) -> None:
        """Go to the first element that a selector finds, so that what lies about it is drawn."""
        self.unfold()
        # What is laid out on the way moves the element.
        for _ in range(3):
            self.page.locator(selector).first.evaluate("e => e.scrollIntoView({block: 'center', behavior: 'instant'})")
            self.page.wait_for_timeout(100)


Pages = Callable[[Any], Opened]
"""The page on a screen of a size, which a test leaves as it is."""
