"""Drawings in and answers out: DXF, SVG, GeoJSON, WKT, shapefile, CSV, COMPAS, gmsh; VTU, NumPy and MATLAB.

Knows the wall description and nothing of methods or the engine. The model asks it for a wall through
`harness.model.reading.DRAWINGS`, which `register` fills.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

SUFFIXES = (".dxf", ".svg", ".geojson", ".wkt", ".shp", ".csv", ".msh", ".geo", ".ifc", ".dwg", ".step", ".stp", ".pdf")


def register() -> None:
    """Let every command that takes a wall file take a drawing too."""
    from harness.model import reading

    reading.DRAWINGS.update(dict.fromkeys(SUFFIXES, _document))


def _document(path: Path) -> dict[str, Any]:
    from harness.formats.importing import import_drawing

    return import_drawing(path).wall.document()
