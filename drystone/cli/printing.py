"""Pages to PDF through a browser that is installed, since pages are made for one."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path


class PrintError(Exception):
    """A page that could not be printed; the message says why and what can be done."""


@dataclass(frozen=True)
class Browsers:
    """What prints.

    Attributes:
        names: commands that are looked for, in this order; all of them print by the same options.
        seconds: longest time for one page; a cold start of a browser takes five.
    """

    names: tuple[str, ...] = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "microsoft-edge")
    seconds: float = 120.0


def print_pdf(page: Path, pdf: Path, browsers: Browsers | None = None) -> None:
    """Print a page as PDF.

    Args:
        page: the HTML file.
        pdf: the file to write.
        browsers: what prints; None: `Browsers()`.

    Raises:
        PrintError: no browser is installed, or it does not print.
    """
    asked = browsers or Browsers()
    found = next((path for name in asked.names if (path := shutil.which(name))), None)
    if found is None:
        raise PrintError(f"no browser is installed to print it as PDF: install chromium, or open {page} and print it")
    part = pdf.absolute().with_name(f".{pdf.name}.part")
    with tempfile.TemporaryDirectory(prefix="drystone-print-", ignore_cleanup_errors=True) as profile:
        command = [
            *(found, "--headless", "--disable-gpu", "--disable-background-networking", f"--user-data-dir={profile}"),
            *(("--no-sandbox",) if os.geteuid() == 0 else ()),
            *("--no-pdf-header-footer", f"--print-to-pdf={part}", page.absolute().as_uri()),
        ]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=asked.seconds, check=False)
        except subprocess.TimeoutExpired:
            part.unlink(missing_ok=True)
            raise PrintError(f"{found} did not print within {asked.seconds:.0f} s: open {page} and print it") from None
    if done.returncode or not part.exists():
        reason = (done.stderr.strip().splitlines() or ["without a message"])[-1]
        part.unlink(missing_ok=True)
        raise PrintError(f"{found} did not print ({reason}): open {page} and print it")
    os.replace(part, pdf)
