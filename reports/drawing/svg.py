"""Display lists as SVG: inline in a page, or as a file of its own."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Sequence

import numpy as np
from markupsafe import Markup, escape

from harness.model.assembly import FloatArray
from harness.model.rings import rings_of
from reports.drawing.display_list import Arrows, Circles, DisplayList, Group, Lines, Polygons, Shape, Text
from reports.drawing.looks import HATCH, css
from reports.labels import numbers
from reports.memo import memo


@memo
def inline(drawing: DisplayList) -> Markup:
    """A drawing as an SVG element of a page; its looks are rules of the page."""
    return element(drawing, body(drawing))


def element(drawing: DisplayList, content: str, packed: int | None = None) -> Markup:
    """The SVG element of a drawing with a content of `body`, or with the number of one that stands elsewhere."""
    number = "" if packed is None else Markup(' data-packed="{}"').format(packed)
    head = Markup('<svg class="wall"{} style="--k:{}" viewBox="{}" role="img" aria-label="{}">').format(
        number, drawing.frame.thinner, " ".join(f"{x:.0f}" for x in drawing.frame.box), drawing.label
    )
    return Markup(f"{head}{content}</svg>")


def standalone(drawing: DisplayList, heading: Sequence[Text], above: float) -> str:
    """A drawing as a file that other programs read.

    Args:
        drawing: the display list.
        heading: lines of text above it.
        above: room for them.
    """
    left, top, width, height = drawing.frame.box
    head = Markup(
        '<svg xmlns="http://www.w3.org/2000/svg" class="wall" viewBox="{}" role="img" aria-label="{}">'
    ).format(f"{left:.0f} {top - above:.0f} {width:.0f} {height + above:.0f}", drawing.label)
    looks = f"<defs>{HATCH}</defs><style>{css(drawing.frame.thinner)}</style>"
    return f"{head}{looks}{''.join(_element(text) for text in heading)}{body(drawing)}</svg>"


@memo
def body(drawing: DisplayList) -> str:
    """What stands in the element."""
    return "".join(_group(part) if isinstance(part, Group) else _element(part) for part in drawing.parts)


def _group(group: Group) -> str:
    """A group, or its only part with the attributes of the group."""
    more = ""
    if group.block is not None:
        more += f' data-block="{group.block}"'
    if group.joint is not None:
        more += f' data-joint="{group.joint}"'
    if group.values:
        more += f' data-values="{escape("|".join(_value(value) for value in group.values))}"'
    if group.motion is not None:
        turn, x, y = group.motion
        more += f' transform="matrix(1 {_short(turn)} {_short(-turn)} 1 {x:.0f} {y:.0f})"'
    if len(group.parts) == 1:
        return _element(group.parts[0], more)
    return f"<g{more}>{''.join(_element(part) for part in group.parts)}</g>"


def _value(value: float | str | None) -> str:
    if value is None or isinstance(value, str):
        return value or ""
    return numbers.given(value, 3)


def _short(turn: float) -> str:
    """A rotation to a ten-thousandth, which is less than half a unit at the far side of a wall."""
    return f"{turn:.4f}".rstrip("0").rstrip(".").replace("-0.", "-.").removeprefix("0") or "0"


def _element(shape: Shape, more: str = "") -> str:
    match shape:
        case Polygons() if shape.rest:
            return f'<path class="{shape.role}"{more} data-rest="{_steps(shape.rest)}" d="{_steps(shape.outlines)}"/>'
        case Polygons():
            rings = [ring for outline in shape.outlines for ring in rings_of(outline)]
            return f'<path class="{shape.role}"{more} d="{_data(rings, "z")}"/>' if rings else ""
        case Lines():
            if shape.width is not None:
                more += f' stroke-width="{shape.width:.0f}"'
            if shape.dash is not None:
                more += f' stroke-dasharray="{shape.dash:.0f} {shape.dash:.0f}"'
            return f'<path class="{shape.role}"{more} d="{_data(shape.points)}"/>' if shape.points else ""
        case Circles():
            each = f'<circle class="{shape.role}"{more} cx="{{:.0f}}" cy="{{:.0f}}" r="{shape.radius:.0f}"/>'
            return "".join(each.format(x, y) for x, y in shape.centres.tolist())
        case Arrows():
            shafts, heads = shape.outlines()
            drawn = f'<path class="{shape.role} shaft"{more} d="{_data(shafts)}"/>'
            return drawn + f'<path class="{shape.role} head"{more} d="{_data(heads, "z")}"/>'
        case Text():
            side = "" if shape.anchor == "middle" else f' style="text-anchor:{shape.anchor}"'
            place = f'x="{shape.at[0]:.0f}" y="{shape.at[1]:.0f}" font-size="{shape.size:.0f}"'
            said = f"<title>{escape(shape.title)}</title>" if shape.title else ""
            role = f' class="{shape.role}"' if shape.role else ""
            return f"<text{role}{more} {place}{side}>{escape(shape.text)}{said}</text>"


def _steps(lines: Iterable[FloatArray]) -> str:
    """Path data of lines (k, 2) in whole units, two numbers for every point, so that a script can move each of them."""
    parts = []
    for line in lines:
        (x, y), *steps = np.diff(np.rint(line), axis=0, prepend=0.0).astype(int).tolist()
        parts.append(f"M{x} {y}{''.join(f'l{dx} {dy}' for dx, dy in steps)}")
    return "".join(parts)


def _data(lines: Iterable[FloatArray], end: str = "") -> str:
    """Path data of lines (k, 2) in whole units, relative after the first point."""
    text = []
    for line in lines:
        (x0, y0), *rest = [(round(x), round(y)) for x, y in line.tolist()]
        text.append(f"M{x0} {y0}")
        for x, y in rest:
            if y != y0:
                text.append(f"v{y - y0}" if x == x0 else f"l{x - x0} {y - y0}")
            elif x != x0 or not end:
                text.append(f"h{x - x0}")
            x0, y0 = x, y
        text.append(end)
    return "".join(text)


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
