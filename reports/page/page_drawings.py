"""The drawings of a page: the first stand in it as they are, the others packed, and those of the largest walls not.

What is packed takes a tenth of its room; the script of the page unpacks it and changes nothing in it.
"""

from __future__ import annotations

import base64
import json
import zlib

from markupsafe import Markup

from harness.model.comparison import CaseResults, ComparisonRun
from reports.drawing.display_list import DisplayList
from reports.drawing.svg import body, element
from reports.geometry import shapes

BLOCK, JOINT = 42, 38
"""Bytes that a block of a mechanism and a joint with its force take in a page, packed, about."""


class PageDrawings:
    """The drawings of one page.

    Args:
        room: bytes of drawings that stand in the page as they are, for readers without scripts.
    """

    def __init__(self, room: int) -> None:
        self._room, self._packed = room, list[tuple[str, int, str]]()

    def put(self, drawing: DisplayList) -> Markup:
        """A drawing as an element of the page; one that is packed is empty and has the number of its content."""
        content = body(drawing)
        self._room -= len(content)
        if self._room >= 0:
            return element(drawing, content)
        number = len(self._packed)
        self._packed.append((drawing.label, number, content))
        return element(drawing, "", packed=number)

    def packed(self) -> str:
        """The contents that are packed by number: JSON, deflated, in base 64; nothing without any."""
        if not self._packed:
            return ""
        # What looks alike stands side by side, for the sake of its size.
        text = json.dumps({number: content for _, number, content in sorted(self._packed)}, ensure_ascii=False)
        return base64.b64encode(zlib.compress(text.encode(), 9)).decode()


def fields_drawn(run: ComparisonRun, budget: int) -> list[str]:
    """What the page draws of each case: "all", "mechanism" (no forces) or "none" (the wall only).

    The largest cases are cut first, until about `budget` bytes are left.
    """
    sizes = [(0, 0) if shapes.problem(item.case) else drawing_bytes(item) for item in run.cases]
    fields, total = ["all"] * len(sizes), sum(sum(size) for size in sizes)
    for place, level in ((1, "mechanism"), (0, "none")):
        for number in sorted(range(len(sizes)), key=lambda k: -sum(sizes[k])):
            if total <= budget:
                return fields
            fields[number] = level
            total -= sizes[number][place]
    return fields


def drawing_bytes(item: CaseResults) -> tuple[int, int]:
    """Bytes of the mechanisms and of the contact forces of a case, about."""
    mechanisms = sum(BLOCK * len(result.mechanism) for result in item.results if result.mechanism is not None)
    return mechanisms, sum(JOINT * len(result.forces) for result in item.results if result.forces is not None)
