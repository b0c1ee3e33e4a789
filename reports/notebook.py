"""What a notebook shows of a wall, an answer or a table: words, rows and a drawing as HTML."""

from __future__ import annotations

from base64 import b64encode
from html import escape

from reports.drawing.display_list import DisplayList
from reports.drawing.svg import standalone


def html(words: str, drawing: DisplayList | None = None, table: str = "") -> str:
    """A sentence, a table and a drawing as HTML.

    The drawing is an image, so that the rules of its looks stay its own in a page of many.

    Args:
        words: the sentence, which is escaped.
        drawing: a display list; None: nothing is drawn.
        table: HTML, which is taken as it is.
    """
    image = ""
    if drawing is not None:
        content = b64encode(standalone(drawing, (), 0.0).encode()).decode()
        image = f'<img alt="{escape(drawing.label)}" style="max-width: 40em" src="data:image/svg+xml;base64,{content}">'
    return f"<p>{escape(words)}</p>{table}{image}"
