"""Drawings and charts of the report as vector files of their own: SVG that other programs read, with what it shows."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache
from importlib.resources import files

from harness.model.case import Case
from harness.model.comparison import CaseResults
from harness.model.result import Result
from harness.model.result_texts import strength_in_words
from reports.drawing.display_list import DisplayList, Text
from reports.drawing.force_drawing import force_drawing
from reports.drawing.mechanism_drawing import mechanism_drawing
from reports.drawing.svg import standalone
from reports.drawing.wall_drawing import wall_drawing
from reports.geometry import shapes
from reports.labels.wall_summary import given_in_words, value_in_words
from reports.page.summary import figure_of

LETTERS = 120
"""Size of the letters of the text above a drawing, in drawing units."""

LINE = 170
"""From one line of that text to the next."""
_MOST_BLOCKS = 2000
"""Walls with more blocks are drawn on demand only (`drystone figure`): a drawing takes some 100 bytes a block."""


def drawings(item: CaseResults) -> dict[str, str]:
    """The wall of a case, the mechanism and the forces of each result, and two mechanisms over each other, by name."""
    case = item.case
    if shapes.problem(case) or case.assembly.n_blocks > _MOST_BLOCKS:
        return {}
    found = {"wall": headed(case, wall_drawing(case), "")}
    for result in item.results:
        if _fits(result.mechanism, case.assembly.n_blocks):
            found[f"{result.method}-mechanism"] = headed(
                case, mechanism_drawing(case, result), _drawn_in_words(result, "mechanism")
            )
        if _fits(result.forces, case.assembly.n_interfaces):
            found[f"{result.method}-forces"] = headed(
                case, force_drawing(case, result), _drawn_in_words(result, "contact forces")
            )
    overlay, caption = figure_of(item)
    if overlay is not None:
        found["overlay"] = headed(case, overlay, caption)
    return found


def _fits(field: Sequence[object] | None, rows: int) -> bool:
    return field is not None and len(field) == rows


def headed(case: Case, drawing: DisplayList, said: str) -> str:
    """A drawing as a file, under the title of its case, its friction and live load, and what is drawn.

    Args:
        case: the case.
        drawing: its display list; the file is higher by the heading.
        said: what is drawn, in a line or more; may be empty.
    """
    left, top, width, _ = drawing.frame.box
    lines = [line for text in (case.file.title, given_in_words(case), said) for line in _broken(text, width)]
    above = LINE * len(lines)
    heading = [
        Text("", (left + 60, top - above + LINE * (k + 1)), line, LETTERS, "start") for k, line in enumerate(lines)
    ]
    return standalone(drawing, heading, above)


def alone(chart: str) -> str:
    """The SVG element of a chart as a file."""
    opened, rest = chart.split(">", 1)
    return f"{_rooted(opened)}><style>{_chart_style()}</style>{rest}"


def _rooted(opened: str) -> str:
    return opened.replace("<svg", '<svg xmlns="http://www.w3.org/2000/svg"', 1)


def _broken(text: str, width: float) -> list[str]:
    """A text in lines that fit; a letter is about 0.55 of its size wide."""
    most, lines = int(width / (0.55 * LETTERS)), [""]
    for word in text.split():
        if len(lines[-1]) + 1 + len(word) > most:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return [line for line in lines if line]


@cache
def _chart_style() -> str:
    """Rules of the page for charts, with its variables worked out: few programs that read SVG know these."""
    css = files("reports").joinpath("static/report.css").read_text(encoding="utf-8")
    known = dict(re.findall(r"--([a-z]+): ([^;]+);", css[: css.index("}")]))
    part = css[css.index("/* Charts */") : css.index("footer {")]
    return re.sub(r"var\(--([a-z]+)\)", lambda found: known[found.group(1)], part).strip()


def _drawn_in_words(result: Result, what: str) -> str:
    """The method, its value, what of the strength of joints is counted in it, and what is drawn."""
    return f"{result.method}, {value_in_words(result)}{strength_in_words(result)}: {what}"
