"""COMPAS JSON in and out: blocks of assemblies and models, 3D ones cut by a plane; no compas package is needed.

The format is that of compas 2: every object is {"dtype": "package/Class", "data": {...}}.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from harness.formats.drawing import PLANES, Asked, Drawing, finite, nested
from harness.model.assembly import FloatArray
from harness.model.errors import InputError
from harness.model.json_text import read_json

_SUPPORT = ("is_support", "is_fixed", "fixed")


def read_compas(path: Path, asked: Asked) -> Drawing:
    """The section of the blocks of a COMPAS JSON file, in the plane xz if none is asked for.

    Raises:
        InputError: no COMPAS JSON, or a face of vertices that are not there.
    """
    data = read_json(path)
    if not _looks_like_compas(data):
        raise InputError("it is no COMPAS JSON", "A wall needs no import: give it to `drystone run`")
    solids = list(_solids(data, {}, np.eye(4)))
    plane, at = asked.plane or "xz", asked.at
    first, second, across = PLANES[plane]
    drawing = Drawing()
    if not solids:
        return drawing
    for number, (points, faces, _) in enumerate(solids):
        finite(points, f"solid {number}")
        if any(not -len(points) <= vertex < len(points) for face in faces for vertex in face):
            raise InputError("a face of it names a vertex that it does not have", "Save it again", f"solid {number}")
    heights = np.concatenate([points[:, across] for points, _, _ in solids])
    level = float(0.5 * (heights.min() + heights.max())) if at is None else at
    for number, (points, faces, said) in enumerate(solids):
        name = str(said.get("key") or said.get("name") or said.get("node") or number)
        more: dict[str, Any] = {"name": name, "fixed": any(bool(said.get(word)) for word in _SUPPORT)}
        if np.ptp(points[:, across]) == 0.0:
            for face in faces:
                drawing.add("flat block", points[face][:, [first, second]], **more)
            continue
        lines = [_cut(points[face], across, level) for face in faces]
        segments = [line[:, [first, second]] for line in lines if line is not None]
        parts = (
            shapely.get_parts(shapely.polygonize([shapely.union_all(shapely.linestrings(segments))]))
            if segments
            else []
        )
        if len(parts) == 0:
            drawing.left_out[f"block that the plane {plane} at {level:g} does not cut"] += 1
        for outer, holes in nested([np.asarray(part.exterior.coords) for part in parts]):
            drawing.add(f"block cut by {plane} at {level:g}", outer, holes, **more)
    return drawing


def _looks_like_compas(data: Any) -> bool:
    """Whether JSON data is an object of COMPAS, or lists and dictionaries of such."""
    if isinstance(data, dict) and data.get("format") != "wall/1":
        return "dtype" in data or any(
            _looks_like_compas(item) for item in data.values() if isinstance(item, list | dict)
        )
    return isinstance(data, list) and any(_looks_like_compas(item) for item in data[:1])


def _cut(face: FloatArray, across: int, level: float) -> FloatArray | None:
    """The segment (2, 3) in which a plane cuts a convex face (k, 3); None if it does not."""
    off = face[:, across] - level
    points = []
    for (p, a), (q, b) in itertools.pairwise([*zip(face, off, strict=True), (face[0], off[0])]):
        if (a < 0.0) != (b < 0.0):
            points.append(p + (q - p) * (a / (a - b)))
    return np.array(points[:2]) if len(points) >= 2 and not np.array_equal(points[0], points[1]) else None


def _solids(
    value: Any, said: dict[str, Any], placed: FloatArray
) -> Iterator[tuple[FloatArray, list[list[int]], dict[str, Any]]]:
    """Every solid below a value: vertices (k, 3), faces, and what is said about it on the way down."""
    if isinstance(value, list):
        for item in value:
            yield from _solids(item, said, placed)
    if not isinstance(value, dict):
        return
    data = value.get("data", value)
    inherited = said | {key: value[key] for key in ("name", *_SUPPORT) if value.get(key) is not None}
    if isinstance(data, dict):
        inherited |= {key: data[key] for key in ("name", *_SUPPORT) if data.get(key) is not None}
        attributes = data.get("attributes")
        if isinstance(attributes, dict):
            inherited |= {key: attributes[key] for key in ("name", *_SUPPORT) if attributes.get(key) is not None}
        matrix = data.get("transformation")
        if isinstance(matrix, dict):
            placed = placed @ np.asarray(matrix.get("data", matrix)["matrix"], float)
    solid = _solid(str(value.get("dtype", "")), data)
    if solid is not None:
        points, faces = solid
        yield points @ placed[:3, :3].T + placed[:3, 3], faces, inherited
        return
    if isinstance(data, dict):
        for key, item in data.items():
            if key in ("node", "parts") and isinstance(item, dict):
                for node, inner in item.items():
                    # A key that is a word is written in quotes, and is a name before that of the mesh, as "Box".
                    word = node.strip("'\"")
                    yield from _solids(inner, inherited | ({"node": node} if word == node else {"key": word}), placed)
            elif key not in ("interface", "interfaces", "interactions", "edge"):
                yield from _solids(item, inherited, placed)


def _solid(dtype: str, data: Any) -> tuple[FloatArray, list[list[int]]] | None:
    """Vertices and faces of a COMPAS mesh, polyhedron, box or polygon; None of anything else."""
    if not isinstance(data, dict):
        return None
    if isinstance(data.get("vertex"), dict) and isinstance(data.get("face"), dict):
        keys = list(data["vertex"])
        points = np.array([[vertex.get(axis, 0.0) for axis in "xyz"] for vertex in data["vertex"].values()], float)
        index = {str(key): number for number, key in enumerate(keys)}
        return points, [[index[str(key)] for key in face] for face in data["face"].values()]
    if dtype.endswith("/Polyhedron"):
        return np.array(data["vertices"], float), [list(face) for face in data["faces"]]
    if dtype.endswith("/Polygon"):
        points = np.array([list(point) for point in data["points"]], float)
        return points, [list(range(len(points)))]
    if dtype.endswith("/Box"):
        frame = data["frame"].get("data", data["frame"])
        x, y = (np.asarray(frame[axis], float) for axis in ("xaxis", "yaxis"))
        axes = np.stack([x, y, np.cross(x, y)])
        half = 0.5 * np.array([data[size] for size in ("xsize", "ysize", "zsize")], float)
        corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3))) * half
        faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        return np.asarray(frame["point"], float) + corners @ axes, faces
    return None
