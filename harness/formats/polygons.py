"""Polygons in: GeoJSON and WKT through shapely, shapefiles through pyshp, and CSV with a row a vertex or a polygon."""

from __future__ import annotations

import csv
import io
import struct
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from harness.formats.drawing import Drawing
from harness.model.errors import InputError
from harness.model.reading import read_bytes, read_json, read_text

NAMES = ("id", "name", "block")
LAYERS = ("layer", "group")


def read_geojson(path: Path, _accuracy: float) -> Drawing:
    """The polygons of a GeoJSON file; properties id/name, layer/group, material and fixed are read.

    Raises:
        InputError: no GeoJSON.
    """
    data = read_json(path)
    features = data.get("features", [data]) if isinstance(data, dict) else None
    if not isinstance(features, list) or not all(isinstance(item, dict) for item in features):
        raise InputError("it is no GeoJSON", "Give a FeatureCollection of polygons", source=str(path))
    drawing = Drawing()
    for feature in features:
        properties = dict(feature.get("properties") or {})
        if "id" in feature:
            properties.setdefault("id", feature["id"])
        geometry = feature.get("geometry", feature)
        try:
            shape = _shape(geometry)
        except (AttributeError, KeyError, TypeError, ValueError, shapely.errors.ShapelyError) as error:
            drawing.left_out[f"feature without a readable geometry ({error})"] += 1
            continue
        _add(drawing, shape, properties)
    return drawing


def _shape(geometry: Any) -> Any:
    """The shapely geometry of a GeoJSON geometry."""
    from shapely.geometry import shape

    return shape(geometry)


def read_wkt(path: Path, _accuracy: float) -> Drawing:
    """The polygons of a text file with a WKT geometry a line.

    Raises:
        InputError: a line that is no WKT.
    """
    drawing = Drawing()
    for number, line in enumerate(read_text(path).splitlines(), start=1):
        if not line.strip():
            continue
        try:
            shape = shapely.from_wkt(line)
        except shapely.errors.ShapelyError as error:
            raise InputError(f"it is no WKT ({error})", "Give POLYGON ((...))", f"line {number}", str(path)) from None
        _add(drawing, shape, {})
    return drawing


def read_shapefile(path: Path, _accuracy: float) -> Drawing:
    """The polygons of a shapefile (.shp, with its .dbf if there is one)."""
    import shapefile

    parts = {"shp": io.BytesIO(read_bytes(path))}
    for suffix in ("dbf", "shx"):
        beside = path.with_suffix(f".{suffix}")
        if beside.exists():
            parts[suffix] = io.BytesIO(read_bytes(beside))
    drawing = Drawing()
    try:
        with shapefile.Reader(**parts) as reader:
            names = [item[0].lower() for item in reader.fields if item[0] != "DeletionFlag"]
            for number in range(len(reader)):
                properties = dict(zip(names, reader.record(number), strict=False)) if "dbf" in parts else {}
                _add(drawing, _shape(reader.shape(number).__geo_interface__), properties)
    except (shapefile.ShapefileException, OSError, ValueError, KeyError, IndexError, TypeError, struct.error) as error:
        raise InputError(f"it is no shapefile that can be read ({error})", source=str(path)) from None
    return drawing


def read_csv(path: Path, _accuracy: float) -> Drawing:
    """Polygons of a CSV file: columns block, x, y with a row a vertex, or a column wkt with a row a polygon.

    Columns layer, material and fixed are read where there are any; a column ring tells the outline of a block from its
    holes, the outline first.

    Raises:
        InputError: other columns, or a number that is none.
    """
    text = read_text(path)
    dialect = ";" if text.partition("\n")[0].count(";") else ","
    rows = [
        {(name or "").strip().lower(): value for name, value in row.items()}
        for row in csv.DictReader(io.StringIO(text), delimiter=dialect)
    ]
    drawing = Drawing()
    columns = set(rows[0]) if rows else set()
    if "wkt" in columns:
        for row in rows:
            try:
                _add(drawing, shapely.from_wkt(row["wkt"]), row)
            except (shapely.errors.ShapelyError, TypeError) as error:
                raise InputError(f"it is no WKT ({error})", element="wkt", source=str(path)) from None
        return drawing
    name = next((item for item in NAMES if item in columns), "")
    if not name or not {"x", "y"} <= columns:
        raise InputError(
            f"its columns are {', '.join(sorted(columns)) or 'none'}",
            "Give block, x, y with a row a vertex, or wkt with a row a polygon",
            source=str(path),
        )
    stones: dict[str, list[dict[str, str]]] = {}
    for row in rows:
        stones.setdefault(str(row[name]), []).append(row)
    for stone, vertices in stones.items():
        rings: dict[str, list[tuple[float, float]]] = {}
        try:
            for row in vertices:
                rings.setdefault(row.get("ring") or "0", []).append((float(row["x"]), float(row["y"])))
        except (TypeError, ValueError) as error:
            raise InputError(f"{error}", "Give numbers with a point", stone, str(path)) from None
        outer, *holes = rings.values()
        if any(len(ring) < 3 for ring in (outer, *holes)):
            drawing.left_out["stone of fewer than three vertices in a ring"] += 1
        else:
            _add(drawing, shapely.Polygon(outer, holes), vertices[0])
    return drawing


def _add(drawing: Drawing, shape: Any, properties: dict[str, Any]) -> None:
    """Add the polygons of a geometry with what its properties say."""
    said = {str(name).lower(): value for name, value in properties.items() if value not in (None, "")}
    more = {
        "name": str(next((said[item] for item in NAMES if item in said), "")),
        "layer": str(next((said[item] for item in LAYERS if item in said), "")),
        "material": str(said.get("material", "")),
        "fixed": str(said.get("fixed", "")).lower() in ("1", "true", "yes"),
    }
    for part in shapely.get_parts(shape):
        if part.geom_type != "Polygon":
            drawing.left_out[f"{part.geom_type}: no area"] += 1
            continue
        holes = [np.asarray(ring.coords) for ring in part.interiors]
        drawing.add("polygon", np.asarray(part.exterior.coords), holes, **more)
