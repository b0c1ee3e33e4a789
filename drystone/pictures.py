"""Figures inside the HTML that a notebook shows."""

from __future__ import annotations

import io
from html import escape

from matplotlib.figure import Figure

from reports.drawing.figures import style


def html(words: str, figure: Figure | None, table: str = "") -> str:
    """A heading, a table and a figure as HTML; the words are escaped, the table is taken as it is."""
    return f"<p>{escape(words)}</p>{table}{'' if figure is None else svg(figure)}"


def svg(figure: Figure) -> str:
    """A figure as an SVG element."""
    with style():
        drawn = io.StringIO()
        figure.savefig(drawn, format="svg", metadata={"Date": None, "Creator": "Drystone"})
    text = drawn.getvalue()
    return text[text.index("<svg") :]
