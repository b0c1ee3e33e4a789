"""DXF in, through ezdxf: closed polylines, lines that close, hatches, circles and blocks with their transforms.

What a CAD program does not show is left out: entities that are invisible or on a layer that is off or frozen.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
from ezdxf import path as paths
from ezdxf.lldxf.const import DXFError

from harness.formats.drawing import MOST_COPIES, PLANES, Asked, Drawing, finite, nested
from harness.model.assembly import FloatArray
from harness.model.errors import InputError
from harness.model.json_text import read_bytes, text_of

UNITS = {"in": 1, "ft": 2, "mm": 4, "cm": 5, "m": 6, "km": 7, "yd": 10, "dm": 14}
"""$INSUNITS of the DXF reference by units of length."""

_CLOSED = {"LWPOLYLINE", "POLYLINE", "CIRCLE", "ELLIPSE", "SPLINE", "SOLID", "TRACE", "3DFACE"}
_OPEN = {"LINE", "ARC", "LWPOLYLINE", "POLYLINE", "ELLIPSE", "SPLINE"}
_MOST_NESTED = 16
"""Depth of blocks within blocks that is followed; a drawing that goes deeper is likely to contain itself."""
_FINEST = 1e-6
"""Chords of a curve are no finer than this part of its extent: a thousand or two stand for a circle."""
_CLOSE = 1e-9
"""Ends of a curve are one point if they are no further apart than this part of its extent: rounding."""


def read_dxf(path: Path, asked: Asked) -> Drawing:
    """The outlines of the model space of a DXF file, ASCII or binary.

    Raises:
        InputError: a block that is not defined, contains itself or stands for too many entities.
    """
    content = read_bytes(path)
    if content.startswith(b"AutoCAD Binary DXF"):
        document = ezdxf.readfile(path)
    else:
        document = ezdxf.read(io.StringIO(text_of(content, str(path), "cp1252").replace("\r\n", "\n")))
    declared = int(document.header.get("$INSUNITS", 0))
    drawing = Drawing(unit=next((unit for unit, code in UNITS.items() if code == declared), ""))
    reading = _Reading(document, drawing, PLANES[asked.plane or "xy"], asked.chord(drawing.unit))
    if reading.count(document.modelspace()) > MOST_COPIES + len(document.modelspace()):
        raise InputError(
            f"its blocks stand for more than {MOST_COPIES:,} entities",
            "Leave out what is no stone, or write the blocks out (EXPLODE)",
        )
    for entity, layer in reading.entities(document.modelspace()):
        reading.add(entity, layer)
    drawing.add_lines(reading.lines)
    return drawing


@dataclass(eq=False)
class _Reading:
    """The reading of one file.

    Attributes:
        document: of ezdxf; drawing: what it becomes; axes: of the plane that is read, and the one across it.
        accuracy: of curves [length of the drawing].
        lines: that close nothing by themselves, with their layers.
    """

    document: Any
    drawing: Drawing
    axes: tuple[int, int, int]
    accuracy: float
    lines: list[tuple[FloatArray, str]] = field(default_factory=list)
    _counted: dict[str, int] = field(default_factory=dict)

    def count(self, holder: Any, depth: int = 0) -> int:
        """How many entities those of a holder stand for, its blocks written out.

        Raises:
            InputError: blocks are nested too deeply.
        """
        if depth > _MOST_NESTED:
            raise InputError(
                f"its blocks are nested deeper than {_MOST_NESTED}, or contain themselves",
                "Write them out (EXPLODE)",
                f'block "{getattr(holder, "name", "")}"',
            )
        total = 0
        for entity in holder:
            total += 1
            if entity.dxftype() != "INSERT":
                continue
            name = str(entity.dxf.get("name", ""))
            block = self.document.blocks.get(name)
            if name not in self._counted:
                self._counted[name] = 0 if block is None else self.count(block, depth + 1)
            total += max(1, entity.mcount) * (1 + self._counted[name])
        return total

    def entities(self, holder: Any, parent: str = "0", *, within: bool = False) -> Iterator[tuple[Any, str]]:
        """Entities that are shown, with their layer, those of blocks included; layer 0 in a block is that of the block.

        A block that is inserted on a layer that is off shows what lies on layers of its own; frozen, it shows nothing.

        Raises:
            InputError: a block that is not defined or cannot be placed.
        """
        for entity in holder:
            own = entity.dxf.get("layer", "0")
            layer = parent if own == "0" and within else own
            insert = entity.dxftype() == "INSERT"
            hidden = self._hidden(entity, layer, off=not insert)
            if hidden:
                self.drawing.left_out[f'{entity.dxftype()} on layer "{layer}": hidden, because {hidden}'] += 1
            elif not insert:
                yield entity, layer
            else:
                for copy in self._copies(entity):
                    yield from self.entities(copy, layer, within=True)

    def _hidden(self, entity: Any, layer: str, *, off: bool) -> str:
        """Why an entity on a layer is not shown; empty where it is."""
        if entity.dxf.get("invisible", 0):
            return "it is invisible"
        known = self.document.layers.get(layer) if self.document.layers.has_entry(layer) else None
        if known is not None and known.is_frozen():
            return "the layer is frozen"
        return "the layer is off" if off and known is not None and known.is_off() else ""

    def _copies(self, insert: Any) -> Iterator[list[Any]]:
        """The entities of every copy of a block that an INSERT makes, in their places."""
        name = insert.dxf.get("name", "")
        block = self.document.blocks.get(name)
        if block is not None and block.block.is_xref:
            self.drawing.left_out[f'INSERT of "{name}": it lies in another file, and is not read'] += 1
            return
        if block is None:
            raise InputError(
                f'it inserts the block "{name}", which it does not define',
                "Save it again from the program that drew it, or erase the insert",
                "INSERT",
            )
        try:
            for one in insert.multi_insert() if insert.mcount > 1 else (insert,):
                yield list(one.virtual_entities())
        except (DXFError, ArithmeticError, ValueError) as error:
            raise InputError(
                f'the block "{name}" cannot be placed ({error})', "Check its scale and direction", "INSERT"
            ) from None

    def add(self, entity: Any, layer: str) -> None:
        """Take an entity as outlines or lines, or note why it is none."""
        kind = entity.dxftype()
        if kind in ("HATCH", "MPOLYGON"):
            for outer, holes in nested([self._points(path) for path in paths.from_hatch(entity)]):
                self.drawing.add(kind, outer, holes, layer=layer)
            return
        if kind not in _CLOSED | _OPEN:
            self.drawing.left_out[f'{kind} on layer "{layer}": no outline'] += 1
            return
        try:
            path = paths.make_path(entity)
        except (TypeError, ValueError, DXFError) as error:
            self.drawing.left_out[f'{kind} on layer "{layer}": {error}'] += 1
            return
        points = self._points(path)
        if len(points) < 2:
            self.drawing.left_out[f'{kind} on layer "{layer}": it is a point'] += 1
        elif kind not in _CLOSED or not (
            bool(getattr(entity, "is_closed", False))
            or np.linalg.norm(points[-1] - points[0]) <= _CLOSE * np.ptp(points, axis=0).max()
        ):
            self.lines.append((points, layer))
        elif self._across(path, points):
            planes = " or ".join(f"--plane {name}" for name, axes in PLANES.items() if axes != self.axes)
            self.drawing.left_out[f'{kind} on layer "{layer}": it lies in another plane (import it with {planes})'] += 1
        else:
            self.drawing.add(kind, points, layer=layer)

    def _across(self, path: Any, points: FloatArray) -> bool:
        """Whether a closed line stands across the plane that is read: its points are on one line there."""
        depth = np.ptp([tuple(point)[self.axes[2]] for point in path.control_vertices()])
        return bool(depth > 0.0 and np.linalg.matrix_rank(points - points[0]) < 2)

    def _points(self, path: Any) -> FloatArray:
        """The points (k, 2) of a path in the plane that is read, curves as chords."""
        corners = finite(np.array([tuple(point) for point in path.control_vertices()], float), "a curve")
        if len(corners) == 0:
            return np.empty((0, 2))
        accuracy = max(self.accuracy, _FINEST * float(np.ptp(corners, axis=0).max()))
        points = np.array([tuple(point) for point in path.flattening(accuracy, segments=4)], float).reshape(-1, 3)
        return np.asarray(points[:, self.axes[:2]])
