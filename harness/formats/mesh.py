"""gmsh in: surfaces of a .msh through meshio, and plane surfaces of straight lines of a .geo."""

from __future__ import annotations

import re
from collections import defaultdict
from pathlib import Path

import numpy as np
import shapely

from harness.formats.drawing import Asked, Drawing, without_comments
from harness.model.errors import InputError
from harness.model.json_text import read_bytes, read_text

_ENTITY = re.compile(
    r"([A-Za-z][A-Za-z ]{0,40}?)\s*\(\s*(\"[^\"\n]*\"|\d+)\s*(?:,\s*\d+\s*)?\)\s*\+?=\s*\{([^{}]*)\}\s*;"
)
_COMMENT = re.compile(r"//[^\n]*")


def read_msh(path: Path, _asked: Asked) -> Drawing:
    """The surfaces of a gmsh mesh: cells of one geometrical entity are one block, physical groups are layers.

    Raises:
        InputError: no mesh that can be read.
    """
    import meshio

    read_bytes(path)
    try:
        mesh = meshio.read(path, file_format="gmsh")
    except SystemExit as error:
        raise ValueError("gmsh mesh expected") from error
    groups = {int(tag): name for name, (tag, dimension) in mesh.field_data.items() if dimension == 2}
    surfaces: dict[tuple[int, int], list[shapely.Polygon]] = defaultdict(list)
    drawing = Drawing()
    alone = 0
    for number, block in enumerate(mesh.cells):
        if block.type not in ("triangle", "quad", "polygon"):
            if block.dim > 1:
                drawing.left_out[f"{block.type} cells: not flat, or of higher order"] += len(block.data)
            continue
        tags = [
            mesh.cell_data[name][number] if name in mesh.cell_data else None
            for name in ("gmsh:geometrical", "gmsh:physical")
        ]
        for cell, corners in enumerate(block.data):
            alone += 1
            entity = -alone if tags[0] is None or tags[0][cell] == 0 else int(tags[0][cell])
            group = 0 if tags[1] is None else int(tags[1][cell])
            surfaces[entity, group].append(shapely.Polygon(mesh.points[corners, :2]))
    for (entity, group), cells in surfaces.items():
        whole = shapely.union_all(cells)
        for part in shapely.get_parts(whole):
            name = str(entity) if entity > 0 else ""
            holes = [np.asarray(ring.coords) for ring in part.interiors]
            drawing.add("surface", np.asarray(part.exterior.coords), holes, name=name, layer=groups.get(group, ""))
    return drawing


def read_geo(path: Path, _asked: Asked) -> Drawing:
    """The plane surfaces of a gmsh .geo whose points are numbers and whose curves are straight lines.

    Raises:
        InputError: a surface with something else in it.
    """
    drawing = Drawing()
    found: dict[str, dict[str, list[str]]] = defaultdict(dict)
    for kind, tag, content in _ENTITY.findall(_COMMENT.sub("", without_comments(read_text(path)))):
        found[" ".join(kind.split())][tag.strip('"')] = [item.strip() for item in content.split(",")]
    lines = found["Line"]
    loops = found["Curve Loop"] | found["Line Loop"]
    layers = {surface: name for name, members in found["Physical Surface"].items() for surface in members}
    for surface, members in found["Plane Surface"].items():
        try:
            outer, *holes = (_loop(loops[member], lines, found["Point"]) for member in members)
        except (KeyError, ValueError, IndexError) as error:
            raise InputError(
                f"what it is made of cannot be read ({error})",
                "Give points as numbers and straight lines, or mesh it and give the .msh",
                f"Plane Surface({surface})",
                str(path),
            ) from None
        drawing.add("Plane Surface", outer, holes, name=surface, layer=layers.get(surface, ""))
    return drawing


def _loop(curves: list[str], lines: dict[str, list[str]], points: dict[str, list[str]]) -> list[tuple[float, float]]:
    """Vertices of a loop of straight lines; a line with a minus is run from its end."""
    vertices = []
    for curve in curves:
        ends = lines[curve.lstrip("-+ ")]
        x, y = points[ends[-1] if curve.startswith("-") else ends[0]][:2]
        vertices.append((float(x), float(y)))
    return vertices
