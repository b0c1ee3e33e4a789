"""Drawings and charts of the report as vector files of their own: SVG that other programs read, told what it shows."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from markupsafe import Markup, escape

from harness.model.case import Case
from harness.model.comparison import CaseResults
from harness.model.result import Result
from reports import shapes
from reports.drawing import stroke_factor, wall_svg
from reports.facts import friction_text, value_in_words
from reports.force_drawing import forces_svg
from reports.mechanism_drawing import mechanism_svg
from reports.opening import figure_of

HATCH = (
    '<defs><pattern id="hatch" width="90" height="90" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
    '<rect width="90" height="90" fill="#fff"/><path d="M0 0V90" stroke="#14202b" stroke-width="14"/></pattern></defs>'
)


@dataclass(frozen=True)
class Heading:
    """The lines of text above a drawing, in drawing units.

    Attributes:
        size: of the letters.
        line: from one line to the next.
    """

    size: int = 120
    line: int = 170


HEADING = Heading()
MOST_BLOCKS = 2000
"""Walls with more blocks are drawn on demand only (`drystone figure`): a drawing takes some 100 bytes a block."""


def drawings(item: CaseResults) -> dict[str, str]:
    """The wall of a case, the mechanism and the forces of each result, and two mechanisms over each other, by name."""
    case = item.case
    if shapes.problem(case) or case.assembly.n_blocks > MOST_BLOCKS:
        return {}
    found = {"wall": headed(case, wall_svg(case), "")}
    for result in item.results:
        if _fits(result.mechanism, case.assembly.n_blocks):
            drawn = mechanism_svg(case, result, measured=True)
            found[f"{result.method}-mechanism"] = headed(case, drawn, _told(result, "mechanism"))
        if _fits(result.forces, case.assembly.n_interfaces):
            found[f"{result.method}-forces"] = headed(case, forces_svg(case, result), _told(result, "contact forces"))
    overlay, caption = figure_of(item)
    if overlay:
        found["overlay"] = headed(case, overlay, caption)
    return found


def _fits(field: Sequence[object] | None, rows: int) -> bool:
    return field is not None and len(field) == rows


def _told(result: Result, what: str) -> str:
    return f"{result.method}, {value_in_words(result)}: {what}"


def headed(case: Case, drawing: Markup, said: str) -> str:
    """An SVG element of the page as a file, under the title of its case, its friction and what is drawn.

    Args:
        case: the case.
        drawing: the element; its `viewBox` grows by the heading.
        said: what is drawn, in a line or more; may be empty.
    """
    left, top, width, height = (float(x) for x in re.findall(r'viewBox="([^"]*)"', drawing)[0].split())
    lines = [case.file.title, f"tan φ = {friction_text(case.assembly)}", *_broken(said, width)]
    above = HEADING.line * len(lines)
    texts = "".join(
        f'<text x="{left + 60:.0f}" y="{top - above + HEADING.line * (k + 1):.0f}" font-size="{HEADING.size}" '
        f'style="text-anchor:start">{escape(line)}</text>'
        for k, line in enumerate(lines)
    )
    box = f'viewBox="{left:.0f} {top - above:.0f} {width:.0f} {height + above:.0f}"'
    opened, rest = re.sub(r'viewBox="[^"]*"', box, drawing, count=1).split(">", 1)
    style = _style("/* Drawings */", "/* Charts */", stroke_factor(case.assembly))
    return f"{_rooted(opened)}>{HATCH}<style>{style}</style>{texts}{rest}"


def alone(chart: str) -> str:
    """The SVG element of a chart as a file."""
    opened, rest = chart.split(">", 1)
    return f"{_rooted(opened)}><style>{_style('/* Charts */', 'footer {', 1.0)}</style>{rest}"


def _rooted(opened: str) -> str:
    return opened.replace("<svg", '<svg xmlns="http://www.w3.org/2000/svg"', 1)


def _broken(text: str, width: float) -> list[str]:
    """A text in lines that fit; a letter is about 0.55 of its size wide."""
    most, lines = int(width / (0.55 * HEADING.size)), [""]
    for word in text.split():
        if len(lines[-1]) + 1 + len(word) > most:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return [line for line in lines if line]


@cache
def _style(start: str, end: str, thinner: float) -> str:
    """Rules of the page, with its variables and sums worked out: few programs that read SVG know these.

    Args:
        start, end: the part of the style sheet.
        thinner: factor of the width of lines.
    """
    css = files("reports").joinpath("static/report.css").read_text(encoding="utf-8")
    known = dict(re.findall(r"--([a-z]+): ([^;]+);", css[: css.index("}")]))
    part = css[css.index(start) + len(start) : css.index(end)]
    part = re.sub(r"calc\((\d+)px \* var\(--k, 1\)\)", lambda found: f"{float(found.group(1)) * thinner:.4g}px", part)
    return re.sub(r"var\(--([a-z]+)\)", lambda found: known[found.group(1)], part).strip()
