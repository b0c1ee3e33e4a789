"""Where a drawing lies: on the globe, in lengths or degrees; on its sheet, with a frame; and which way is down."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import shapely

from harness.formats.drawing import Drawing, Outline
from harness.model.assembly import FloatArray
from harness.model.errors import InputError
from harness.model.input_checks import SIZES

_REMEDY = "Project it (QGIS: Export, Save Features As, a CRS in metres such as your UTM zone), and import that"
_MOST_NAMED = 10_000
"""Letters of a system of coordinates that are read."""
_FAR = 100.0
"""Coordinates in degrees lie so many extents of the wall from the origin at least: 100 km from it, for a wall of 1."""


def reference_system(name: str, drawing: Drawing) -> None:
    """Take the unit of a system of coordinates for the drawing: a name of EPSG or OGC, or well-known text (.prj).

    Codes of EPSG from 4000 to 4999 are those of geographic systems, whose coordinates are degrees.

    Raises:
        InputError: a geographic system.
    """
    text = name.strip()[:_MOST_NAMED]
    code = re.search(r"EPSG(?:/\d+(?:\.\d+)*|[:/]*[\d.]*:)?[:/]*(\d+)$", text, re.IGNORECASE)
    geographic = text.upper().startswith(("GEOGCS", "GEOGCRS", "GEODCRS")) or re.search(r"CRS(84|83|27)h?$", text)
    if geographic or (code is not None and 4000 <= int(code[1]) <= 4999):
        raise InputError(
            f'its coordinates are degrees ("{text[:60]}")', f"{_REMEDY}; or give lengths without a crs", "crs"
        )
    foot = re.search(r'UNIT\["[^"]*(foot|feet)|ftUS|\bft\b', text, re.IGNORECASE)
    drawing.unit = "ft" if foot else "m"
    said = (
        ""
        if text.upper().startswith(("PROJCS", "PROJCRS"))
        else ", which is assumed for the drawing (--units gives another)"
    )
    drawing.notes.append(f'unit of length: {drawing.unit}, of the system of coordinates "{text[:60]}"{said}')


def refuse_degrees(outlines: Sequence[Outline]) -> None:
    """Refuse coordinates that look like degrees: a wall too small to be one if they were metres, far from the origin.

    Raises:
        InputError: they do.
    """
    points = np.concatenate([item.polygon for item in outlines])
    extent = float(np.ptp(points, axis=0).max())
    within = bool((np.abs(points) <= (180.0, 90.0)).all())
    if within and extent < SIZES[0] and float(np.abs(points).max()) > _FAR * extent:
        x, y = points[0]
        raise InputError(
            f"its coordinates look like degrees: all lie within {extent:.2g} of ({x:.6g}, {y:.6g})",
            f"{_REMEDY}; if they are lengths, say in which unit (--units)",
        )


def refuse_frame(outlines: Sequence[Outline]) -> None:
    """Refuse outlines that enclose all others: the frame of a sheet is no stone.

    Raises:
        InputError: naming the outermost, and what would mend the drawing.
    """
    shapes = shapely.polygons(shapely.get_exterior_ring([item.shape for item in outlines]))
    size = shapely.area(shapes)
    order = np.argsort(-size, kind="stable")
    frames = 0
    # The largest is a frame if it covers all that are smaller, and so on inward while more than one stone is left.
    while frames < len(order) - 2 and shapely.covers(shapes[order[frames]], shapes[order[frames + 1 :]]).all():
        frames += 1
    if not frames:
        return
    outer = outlines[order[0]]
    (x, y), (wide, high) = outer.polygon.min(axis=0).tolist(), np.ptp(outer.polygon, axis=0).tolist()
    of_frames = {outlines[k].layer for k in order[:frames].tolist()}
    alone = of_frames.isdisjoint(outlines[k].layer for k in order[frames:].tolist())
    table = " and ".join(f'[layers."{layer}"] use = "ignore"' for layer in sorted(of_frames))
    mend = f"Ignore it by its layer, in the TOML beside the drawing: {table}"
    raise InputError(
        f"{frames} outline(s) enclose all {len(order) - frames} others, the outer from ({x:g}, {y:g}) on {wide:g} wide "
        f"and {high:g} high: the frame of a sheet is no stone",
        mend if alone and "" not in of_frames else "Erase it, or draw it on a layer of its own, and ignore that",
    )


def down_of(gravity: tuple[float, float]) -> FloatArray:
    """The direction (2,) of gravity, given as a multiple (x, y) of every weight.

    Raises:
        InputError: it has none.
    """
    size = float(np.hypot(*gravity))
    if size == 0.0:
        raise InputError("it has no direction", "Give the direction in which stones fall", "gravity")
    return np.array(gravity) / size


def across(down: FloatArray) -> tuple[float, float]:
    """The horizontal direction that is to the right: of the sheet, or where it has none, when its foot is down."""
    right = np.array([-down[1], down[0]]) + 0.0
    x, y = (right if right[0] >= 0.0 else 0.0 - right).tolist()
    return x, y
