"""The page of two sets of answers side by side: what is worse, gone, slower, better or new, and times by method."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from markupsafe import Markup

from harness.model.difference import Difference
from harness.model.writing import write_whole
from reports.environment import environment
from reports.labels import numbers

GLYPH = {"worse": "✗", "gone": "∅", "slower": "…", "better": "✓", "new": "+", "same": "="}


def write_diff(found: Difference, path: Path) -> None:
    """Write the page of a comparison of two sets as one HTML file that works offline."""
    write_whole(path, render(found))


def render(found: Difference) -> str:
    """The page as text."""
    return (
        environment()
        .get_template("diff.html.j2")
        .render(
            found=found,
            style=Markup(files("reports").joinpath("static/report.css").read_text(encoding="utf-8")),
            changed=[row for row in found.rows if str(row.kind) != "same"],
            same=[row for row in found.rows if str(row.kind) == "same"],
            counts=[(str(kind), number) for kind, number in found.counts.items() if number],
            glyph=GLYPH,
            numbers=numbers,
        )
    )
