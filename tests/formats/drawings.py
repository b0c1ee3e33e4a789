"""Small drawings written by hand, and what is read of them, for the tests of formats."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np

from cases.start import flemish
from harness.formats.importing import Imported, Mapping, import_drawing

Box = tuple[float, float, float, float]
"""Left, bottom, right, top of a stone."""
DATA = Path(__file__).parents[1] / "data" / "drawings"
WALL = flemish(length=1.0, height=0.45)


def boxes(imported: Imported) -> list[Box]:
    """The boxes of the stones, sorted, to a millionth."""
    found = []
    for block in imported.wall.blocks:
        points = np.array(block.polygon)
        found.append(tuple(round(float(v), 6) + 0.0 for v in (*points.min(axis=0), *points.max(axis=0))))
    return sorted(found)  # type: ignore[arg-type]


def read(path: Path, text: str, **mapping: Any) -> Imported:
    """A drawing of this text, imported."""
    path.write_text(text, encoding="utf-8")
    return import_drawing(path, Mapping(**mapping))


def svg(body: str) -> str:
    """An SVG with y downward from 0 to 100."""
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{body}</svg>'


def csv(*stones: Box) -> str:
    """A CSV of rectangles a, b, c, ..."""
    rows = ["block,x,y"]
    for name, (left, low, right, high) in zip("abcdefghijklmnopqrstuvwxyz", stones, strict=False):
        rows += [f"{name},{x!r},{y!r}" for x, y in ((left, low), (right, low), (right, high), (left, high))]
    return "\n".join(rows)


def dxf(path: Path, draw: Callable[[Any, Any], None], **mapping: Any) -> Imported:
    """A DXF drawn by a function of its document and model space, imported."""
    document = ezdxf.new("R2010")  # type: ignore[attr-defined]
    draw(document, document.modelspace())
    document.saveas(path)
    return import_drawing(path, Mapping(**mapping))


def square(space: Any, x: float, y: float, size: float = 1.0, **attributes: Any) -> Any:
    """A closed square in a space or block of a DXF."""
    corners = [(x, y), (x + size, y), (x + size, y + size), (x, y + size)]
    return space.add_lwpolyline(corners, close=True, dxfattribs=attributes)
