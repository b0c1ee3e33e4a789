"""SVG in, through svgelements: shapes and paths with their transforms, layers of Inkscape; y is turned upward."""

from __future__ import annotations

import io
import math
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import svgelements as svg

from harness.formats.drawing import Asked, Drawing, nested
from harness.formats.svg_shown import LABEL, shown
from harness.model.assembly import FloatArray
from harness.model.errors import InputError
from harness.model.json_text import read_text

_WIDTH = re.compile(r"\s*([0-9.]+)\s*(mm|cm|in)\s*")
_MOST_CHORDS = 256
"""Chords of one curved segment at most."""


def read_svg(path: Path, asked: Asked) -> Drawing:
    """The outlines of an SVG file, in user units of the picture.

    Raises:
        InputError: no SVG, or one that is nested or cloned beyond what is read.
    """
    text = read_text(path)
    if "<!ENTITY" in text:
        raise InputError("it defines entities", "Save it as plain SVG", source=str(path))
    root = ElementTree.fromstring(text)
    drawing = Drawing(unit=_unit(root))
    plain = ElementTree.tostring(shown(root, drawing), encoding="unicode")
    picture = svg.SVG.parse(io.StringIO(plain), reify=True, ppi=96.0)
    lines: list[tuple[FloatArray, str]] = []
    _walk(picture, "", asked.chord(drawing.unit), drawing, lines)
    drawing.add_lines(lines)
    return drawing


def _unit(root: ElementTree.Element) -> str:
    """The unit that a picture is drawn in, empty if it does not tell: a page of "210mm" with a viewBox 210 wide."""
    width, box = _WIDTH.fullmatch(root.get("width", "")), root.get("viewBox", "").replace(",", " ").split()
    scaled = width is not None and len(box) == 4 and math.isclose(float(width[1]), float(box[2]), rel_tol=1e-6)
    return width[2] if width is not None and scaled else ""


def _walk(
    holder: svg.Group, layer: str, accuracy: float, drawing: Drawing, lines: list[tuple[FloatArray, str]]
) -> None:
    for element in holder:
        if isinstance(element, svg.Group):
            label = element.values.get(LABEL) or element.values.get("attributes", {}).get(LABEL)
            _walk(element, str(label or layer or element.id or ""), accuracy, drawing, lines)
        elif isinstance(element, svg.Shape):
            parts = [_points(svg.Path(part), accuracy) for part in abs(svg.Path(element)).as_subpaths()]
            for outer, holes in nested([points for points, closed in parts if closed and len(points) > 2]):
                drawing.add(type(element).__name__, outer, holes, layer=layer, name=str(element.id or ""))
            lines += [(points, layer) for points, closed in parts if not closed and len(points) > 1]
        else:
            drawing.left_out[f"{type(element).__name__}: no outline"] += 1


def _points(path: svg.Path, accuracy: float) -> tuple[FloatArray, bool]:
    """Vertices (k, 2) of a path with y upward, and whether it closes."""
    points: list[tuple[float, float]] = []
    closed = False
    for segment in path:
        if isinstance(segment, svg.Move):
            points.append((segment.end.x, segment.end.y))
        elif isinstance(segment, svg.Close):
            closed = True
        elif isinstance(segment, svg.Line):
            points.append((segment.end.x, segment.end.y))
        else:
            count = _chords(segment, accuracy)
            points.extend((p.x, p.y) for p in (segment.point((k + 1) / count) for k in range(count)))
    array = np.array(points, float).reshape(-1, 2) * (1.0, -1.0)
    closed = closed or (len(array) > 3 and bool(np.allclose(array[0], array[-1], atol=1e-12 + 1e-9 * np.ptp(array))))
    return array, closed


def _chords(segment: svg.Curve, accuracy: float) -> int:
    """Chords that stay within `accuracy` of a curve: the sag of one chord falls with the square of their number."""
    samples = [segment.point(k / 16) for k in range(17)]
    sag = max(
        math.hypot(
            samples[k].x - 0.5 * (samples[k - 1].x + samples[k + 1].x),
            samples[k].y - 0.5 * (samples[k - 1].y + samples[k + 1].y),
        )
        for k in range(1, 16)
    )
    return max(1, math.ceil(min(_MOST_CHORDS, 8.0 * math.sqrt(sag / accuracy))))
