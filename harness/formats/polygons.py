"""Polygons in: GeoJSON and WKT through shapely, shapefiles through pyshp, and CSV with a row a vertex or a polygon."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from harness.formats.drawing import Asked, Drawing
from harness.formats.places import reference_system
from harness.model.errors import InputError
from harness.model.json_text import read_bytes, read_json, read_text
from harness.model.writing import uncelled

_NAMES = ("id", "name", "block")
_LAYERS = ("layer", "group")


def read_geojson(path: Path, _asked: Asked) -> Drawing:
    """The polygons of a GeoJSON file; properties id/name, layer/group, material and fixed are read, and a member crs.

    Raises:
        InputError: no GeoJSON, or a geographic system of coordinates.
    """
    data = read_json(path)
    features = data.get("features", [data]) if isinstance(data, dict) else None
    if not isinstance(features, list) or not all(isinstance(item, dict) for item in features):
        raise InputError("it is no GeoJSON", "Give a FeatureCollection of polygons", source=str(path))
    drawing = Drawing()
    if data.get("crs") is not None:
        reference_system(_named_system(data["crs"], path), drawing)
    for number, feature in enumerate(features):
        properties = feature.get("properties") or {}
        if not isinstance(properties, dict):
            raise InputError("it should be an object, in braces", "", f"features[{number}].properties", str(path))
        if "id" in feature:
            properties = {"id": feature["id"]} | properties
        geometry = feature.get("geometry", feature)
        if geometry is None:
            drawing.left_out["feature without a geometry"] += 1
        else:
            _add(drawing, _shape(geometry, f"features[{number}].geometry"), properties)
    return drawing


def _named_system(system: Any, path: Path) -> str:
    """The name of a GeoJSON member crs (GeoJSON 1.0, Butler et al. 2008, section 3)."""
    named = system.get("properties") if isinstance(system, dict) else None
    name = named.get("name") if isinstance(named, dict) else None
    if not isinstance(name, str) or not name.strip():
        raise InputError(
            "it names no system of coordinates",
            'Give {"type": "name", "properties": {"name": "EPSG:32632"}} with your system, or leave crs out',
            "crs",
            str(path),
        )
    return name


def _no_position(value: Any) -> Any:
    """What stands in the coordinates of a GeoJSON geometry and is no number; None where all are numbers."""
    if isinstance(value, list | tuple):
        return next((found for item in value if (found := _no_position(item)) is not None), None)
    return None if isinstance(value, int | float) and not isinstance(value, bool) else json.dumps(value)


def _shape(geometry: Any, element: str) -> Any:
    """The shapely geometry of a GeoJSON geometry."""
    from shapely.geometry import shape

    members = [geometry, *(geometry.get("geometries") or [])] if isinstance(geometry, dict) else []
    for member in members:
        wrong = _no_position(member.get("coordinates", [])) if isinstance(member, dict) else None
        if wrong is not None:
            raise InputError(f"its coordinates hold {wrong[:40]}", "Give positions as [x, y], numbers both", element)
    try:
        return shape(geometry)
    except (AttributeError, KeyError, TypeError, ValueError, IndexError, shapely.errors.ShapelyError) as error:
        raise InputError(f"its geometry cannot be read ({error})", "Give a Polygon", element) from None


def _from_wkt(text: str, element: str) -> Any:
    try:
        return shapely.from_wkt(text)
    except (NotImplementedError, TypeError, ValueError, shapely.errors.ShapelyError) as error:
        raise InputError(f"it is no WKT that is read ({error})", "Give POLYGON ((...))", element) from None


def read_wkt(path: Path, _asked: Asked) -> Drawing:
    """The polygons of a text file with a WKT geometry a line.

    Raises:
        InputError: a line that is no WKT.
    """
    drawing = Drawing()
    for number, line in enumerate(read_text(path).splitlines(), start=1):
        if line.strip():
            _add(drawing, _from_wkt(line, f"line {number}"), {})
    return drawing


def read_shapefile(path: Path, _asked: Asked) -> Drawing:
    """The polygons of a shapefile (.shp, with its .dbf and .prj if there are)."""
    import shapefile

    parts = {"shp": io.BytesIO(read_bytes(path))}
    for suffix in ("dbf", "shx"):
        beside = path.with_suffix(f".{suffix}")
        if beside.exists():
            parts[suffix] = io.BytesIO(read_bytes(beside))
    drawing = Drawing()
    system = path.with_suffix(".prj")
    if system.exists():
        reference_system(read_text(system), drawing)
    with shapefile.Reader(**parts) as reader:
        for number in range(len(reader)):
            properties = reader.record(number).as_dict() if "dbf" in parts else {}
            _add(drawing, _shape(reader.shape(number).__geo_interface__, f"shape {number}"), properties)
    return drawing


def read_csv(path: Path, _asked: Asked) -> Drawing:
    """Polygons of a CSV file: columns block, x, y with a row a vertex, or a column wkt with a row a polygon.

    Columns layer, material and fixed are read where there are any; a column ring tells the outline of a block from its
    holes, the outline first.

    Raises:
        InputError: other columns, or a number that is none.
    """
    text = read_text(path)
    dialect = ";" if text.partition("\n")[0].count(";") else ","
    table = csv.DictReader(io.StringIO(text, newline=None), delimiter=dialect)
    rows = [
        {(name or "").strip().lower(): uncelled(value) for name, value in row.items() if isinstance(value, str)}
        for row in table
    ]
    drawing = Drawing()
    if table.fieldnames and not rows:
        raise InputError("no row stands below the names of its columns", "Give a row a vertex", source=str(path))
    columns = set(rows[0]) if rows else set()
    if "wkt" in columns:
        for number, row in enumerate(rows, start=1):
            _add(drawing, _from_wkt(row.get("wkt", ""), f"row {number}"), row)
        return drawing
    name = next((item for item in _NAMES if item in columns), "")
    if not name or not {"x", "y"} <= columns:
        raise InputError(
            f"its columns are {', '.join(sorted(columns)) or 'none'}",
            "Give block, x, y with a row a vertex, or wkt with a row a polygon",
            source=str(path),
        )
    stones: dict[str, list[tuple[int, dict[str, str]]]] = {}
    for number, row in enumerate(rows, start=1):
        stones.setdefault(str(row.get(name)), []).append((number, row))
    for stone, vertices in stones.items():
        rings: dict[str, list[tuple[float, float]]] = {}
        for number, row in vertices:
            point = (_number(row, "x", number, stone), _number(row, "y", number, stone))
            rings.setdefault(row.get("ring") or "0", []).append(point)
        outer, *holes = rings.values()
        drawing.add("polygon", outer, holes, **_said(vertices[0][1]))
    return drawing


def _number(row: dict[str, str], column: str, number: int, stone: str) -> float:
    value = row.get(column)
    try:
        return float(value or "")
    except ValueError:
        given = "is missing" if not value else f'is "{value}"'
        raise InputError(
            f"{column} {given}", "Give a number with a point", f'row {number} of block "{stone}"'
        ) from None


def _add(drawing: Drawing, shape: Any, properties: dict[str, Any]) -> None:
    """Add the polygons of a geometry with what its properties say."""
    more = _said(properties)
    for part in shapely.get_parts(shape):
        if part.geom_type != "Polygon":
            drawing.left_out[f"{part.geom_type}: no area"] += 1
            continue
        holes = [np.asarray(ring.coords) for ring in part.interiors]
        drawing.add("polygon", np.asarray(part.exterior.coords), holes, **more)


def _said(properties: dict[str, Any]) -> dict[str, Any]:
    """What the properties of a polygon say of the stone."""
    said = {str(name).lower(): value for name, value in properties.items() if value not in (None, "")}
    return {
        "name": str(next((said[item] for item in _NAMES if item in said), "")),
        "layer": str(next((said[item] for item in _LAYERS if item in said), "")),
        "material": str(said.get("material", "")),
        "fixed": str(said.get("fixed", "")).lower() in ("1", "true", "yes"),
    }
