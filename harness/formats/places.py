"""Where on the globe a drawing lies: its system of coordinates, and whether its numbers are lengths or degrees."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from harness.formats.drawing import Drawing, Outline
from harness.model.errors import InputError
from harness.model.slips import SIZES

REMEDY = "Project it (QGIS: Export, Save Features As, a CRS in metres such as your UTM zone), and import that"
FAR = 100.0
"""Coordinates in degrees lie so many extents of the wall from the origin at least: 100 km from it, for a wall of 1."""


def reference_system(name: str, drawing: Drawing) -> None:
    """Take the unit of a system of coordinates for the drawing: a name of EPSG or OGC, or well-known text (.prj).

    Codes of EPSG from 4000 to 4999 are those of geographic systems, whose coordinates are degrees.

    Raises:
        InputError: a geographic system.
    """
    text = name.strip()
    code = re.search(r"EPSG(?:/\d+(?:\.\d+)*|[:/]*[\d.]*:)?[:/]*(\d+)$", text, re.IGNORECASE)
    geographic = text.upper().startswith(("GEOGCS", "GEOGCRS", "GEODCRS")) or re.search(r"CRS(84|83|27)h?$", text)
    if geographic or (code is not None and 4000 <= int(code[1]) <= 4999):
        raise InputError(
            f'its coordinates are degrees ("{text[:60]}")', f"{REMEDY}; or give lengths without a crs", "crs"
        )
    foot = re.search(r'UNIT\["[^"]*(foot|feet)|ftUS|\bft\b', text, re.IGNORECASE)
    drawing.unit = "ft" if foot else "m"
    said = (
        ""
        if text.upper().startswith(("PROJCS", "PROJCRS"))
        else ", which is taken to be in it (--units says otherwise)"
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
    if within and extent < SIZES[0] and float(np.abs(points).max()) > FAR * extent:
        x, y = points[0]
        raise InputError(
            f"its coordinates look like degrees: all lie within {extent:.2g} of ({x:.6g}, {y:.6g})",
            f"{REMEDY}; if they are lengths, say in which unit (--units)",
        )
