"""DXF in, through ezdxf: closed polylines, lines that close, hatches, circles and blocks with their transforms."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
from ezdxf import path as paths
from ezdxf.lldxf.const import DXFError

from harness.formats.drawing import Drawing, nested
from harness.model.assembly import FloatArray
from harness.model.errors import InputError
from harness.model.reading import read_bytes

UNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m"}
"""$INSUNITS of the DXF reference."""

CLOSED = {"LWPOLYLINE", "POLYLINE", "CIRCLE", "ELLIPSE", "SPLINE", "SOLID", "TRACE", "3DFACE"}
OPEN = {"LINE", "ARC", "LWPOLYLINE", "POLYLINE", "ELLIPSE", "SPLINE"}
MOST_NESTED = 16
"""Depth of blocks within blocks that is followed; a drawing that goes deeper is likely to contain itself."""


def read_dxf(path: Path, accuracy: float) -> Drawing:
    """The outlines of the model space of a DXF file.

    Args:
        path: an ASCII or binary DXF.
        accuracy: greatest distance of a curve from the chords that stand for it [length of the drawing].

    Raises:
        InputError: no DXF that can be read.
    """
    content = read_bytes(path)
    try:
        if content.startswith(b"AutoCAD Binary DXF"):
            document = ezdxf.readfile(path)
        else:
            document = ezdxf.read(io.StringIO(_text(content)))
    except (DXFError, OSError, ValueError, KeyError, IndexError, TypeError, AttributeError) as error:
        raise InputError(
            f"it is no DXF that can be read ({error})", "Save it as DXF R12 or later", source=str(path)
        ) from None
    drawing = Drawing(unit=UNITS.get(int(document.header.get("$INSUNITS", 0)), ""))
    lines: list[tuple[FloatArray, str]] = []
    for entity, layer in _entities(document.modelspace(), drawing):
        _read(entity, layer, accuracy, drawing, lines)
    drawing.add_lines(lines)
    return drawing


def _text(content: bytes) -> str:
    try:
        return content.decode("utf-8").replace("\r\n", "\n")
    except UnicodeDecodeError:
        return content.decode("cp1252", errors="replace").replace("\r\n", "\n")


def _entities(holder: Any, drawing: Drawing, depth: int = 0, parent: str = "0") -> Iterator[tuple[Any, str]]:
    """Entities with their layer, those of blocks included; layer 0 within a block is the layer of the block."""
    for entity in holder:
        layer = entity.dxf.get("layer", "0")
        layer = parent if layer == "0" and depth else layer
        if entity.dxftype() != "INSERT":
            yield entity, layer
        elif depth == MOST_NESTED:
            drawing.left_out[f"INSERT of {entity.dxf.name}: blocks nested deeper than {MOST_NESTED}"] += 1
        else:
            inserts = entity.multi_insert() if entity.mcount > 1 else (entity,)
            for insert in inserts:
                yield from _entities(insert.virtual_entities(), drawing, depth + 1, layer)


def _read(entity: Any, layer: str, accuracy: float, drawing: Drawing, lines: list[tuple[FloatArray, str]]) -> None:
    kind = entity.dxftype()
    if kind in ("HATCH", "MPOLYGON"):
        for outer, holes in nested([_points(path, accuracy) for path in paths.from_hatch(entity)]):
            drawing.add(kind, outer, holes, layer=layer)
        return
    if kind not in CLOSED | OPEN:
        drawing.left_out[f'{kind} on layer "{layer}": no outline'] += 1
        return
    try:
        path = paths.make_path(entity)
    except (TypeError, ValueError, DXFError) as error:
        drawing.left_out[f'{kind} on layer "{layer}": {error}'] += 1
        return
    points = _points(path, accuracy)
    if len(points) < 2:
        drawing.left_out[f'{kind} on layer "{layer}": it is a point'] += 1
    elif kind in CLOSED and (path.is_closed or bool(getattr(entity, "is_closed", False))):
        drawing.add(kind, points, layer=layer)
    else:
        lines.append((points, layer))


def _points(path: Any, accuracy: float) -> FloatArray:
    return np.array([(point.x, point.y) for point in path.flattening(accuracy, segments=4)], float).reshape(-1, 2)
