"""Every format of drawings and answers, a row each: what reads it, what writes it, which package, why it is refused."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from harness.model.errors import InputError, of_those_there, optional

if TYPE_CHECKING:
    from harness.formats.drawing import Asked, Drawing
    from harness.model.build import Built
    from harness.model.result import Result

    Reader = Callable[[Path, Asked], Drawing]
    Writer = Callable[[Built, Result | None, Path], None]


@dataclass(frozen=True)
class Format:
    """One format.

    Attributes:
        suffixes: endings of its files' names.
        title: what it is called.
        reader: function of this package that reads a drawing, as "module.name"; empty: it is not read.
        stones: what of a drawing gives a stone.
        writer: function of this package that writes a wall and its answer, as "module.name"; empty: it is not written.
        holds: what a file that is written holds.
        package: of the extra `drawings` that it needs; empty: none.
        module: the package by its name for Python, where that is another.
        written_without: whether the package is needed to read a file only.
        refusal: why a file is not read, and what to do instead; empty for a format that is read or only written.
        only_imported: whether `drystone import` alone reads it: to other commands a .json is a WALL.json.
    """

    suffixes: tuple[str, ...]
    title: str
    reader: str = ""
    stones: str = ""
    writer: str = ""
    holds: str = ""
    package: str = ""
    module: str = ""
    written_without: bool = False
    refusal: str = ""
    only_imported: bool = False

    @property
    def read(self) -> Reader:
        """The reader."""
        reader: Reader = _named(self.reader)
        return reader

    @property
    def write(self) -> Writer:
        """The writer."""
        writer: Writer = _named(self.writer)
        return writer

    def refuse_without_package(self) -> None:
        """Refuse the format where the package that it needs is not installed.

        Raises:
            MissingPackage: naming the extra that brings it.
        """
        if self.package:
            optional(self.module or self.package, "drawings", self.title)

    def row(self) -> dict[str, Any]:
        """What `drystone list formats` shows of it."""
        return {
            "suffixes": list(self.suffixes),
            "title": self.title,
            "reads": self.stones,
            "writes": self.holds,
            "package": self.package,
            "refusal": self.refusal,
        }


FORMATS = (
    Format(
        (".vtu",),
        "VTK",
        writer="paraview.write_vtu",
        holds="ParaView: blocks with velocity and displacement, joints with n1, n2, s, state and margins",
        package="meshio",
    ),
    Format(
        (".pvd",),
        "series of VTK",
        writer="paraview.write_pvd",
        holds="a series of these: a collapse over time, load steps, or a growing mechanism",
        package="meshio",
    ),
    Format(
        (".dxf",),
        "DXF",
        reader="dxf.read_dxf",
        stones="closed polylines, lines and arcs that close, hatches, circles, blocks (INSERT) and their arrays",
        writer="exporting.write_dxf",
        holds="layers of blocks, supports, joints and mechanism",
        package="ezdxf",
    ),
    Format(
        (".svg",),
        "SVG",
        reader="svg.read_svg",
        stones="closed shapes and paths, clones (use, symbol); layers of Inkscape; y is turned upward",
        writer="exporting.write_svg",
        holds="layers of blocks, supports and mechanism",
        package="svgelements",
        written_without=True,
    ),
    Format(
        (".geojson",),
        "GeoJSON",
        reader="polygons.read_geojson",
        stones="polygons; properties id, layer, material, fixed; a projected crs",
        writer="exporting.write_geojson",
        holds="blocks and joints with their numbers",
    ),
    Format((".wkt",), "WKT", reader="polygons.read_wkt", stones="polygons"),
    Format(
        (".shp",),
        "shapefile",
        reader="polygons.read_shapefile",
        stones="polygons; fields id, layer, material, fixed; a projected .prj",
        package="pyshp",
        module="shapefile",
    ),
    Format(
        (".csv",),
        "CSV",
        reader="polygons.read_csv",
        stones="columns block, x, y, one row a vertex; or a column wkt",
        writer="exporting.write_csv",
        holds="one row a vertex",
    ),
    Format((".msh",), "gmsh mesh", reader="mesh.read_msh", stones="cells of one surface", package="meshio"),
    Format((".geo",), "gmsh geometry", reader="mesh.read_geo", stones="plane surfaces of straight lines"),
    Format(
        (".json",),
        "COMPAS",
        reader="compas.read_compas",
        stones="meshes, boxes and polyhedra, cut by a plane (only drystone import)",
        writer="exporting.write_compas",
        holds="meshes for compas.json_load, in their thickness",
        only_imported=True,
    ),
    Format(
        (".npz",),
        "NumPy",
        writer="exporting.write_npz",
        holds="C, dead, live, friction and the answer, for another solver",
    ),
    Format((".mat",), "MATLAB", writer="exporting.write_mat", holds="the same for MATLAB and Octave"),
    Format(
        (".ifc",),
        "IFC",
        refusal="IFC describes whole walls, not their stones; export the stones as DXF, or as COMPAS JSON",
    ),
    Format((".dwg",), "DWG", refusal="DWG is a closed format; save the drawing as DXF"),
    Format((".step", ".stp"), "STEP", refusal="STEP describes solids; export their outlines as DXF"),
    Format(
        (".pdf",),
        "PDF",
        refusal="outlines of a PDF cannot be distinguished from its lettering; open it in Inkscape and save it as SVG",
    ),
)
"""Every format, in the order in which they are listed."""

BY_SUFFIX = {suffix: item for item in FORMATS for suffix in item.suffixes}


def drawings() -> list[str]:
    """Endings of the files that every command takes for drawings, those that are refused with a reason among them."""
    return [suffix for suffix, item in BY_SUFFIX.items() if (item.reader or item.refusal) and not item.only_imported]


def format_read(path: Path) -> Format:
    """The format in which a drawing is read.

    Raises:
        InputError: none, naming those there are or why this one is refused; or its package is not installed.
    """
    suffix = path.suffix.lower()
    found = BY_SUFFIX.get(suffix)
    if found is not None and found.refusal:
        raise InputError(f"{suffix} is not read", found.refusal[0].upper() + found.refusal[1:], source=str(path))
    if found is None or not found.reader:
        known = [suffix for suffix, item in BY_SUFFIX.items() if item.reader]
        raise InputError(
            f'a file that ends in "{suffix}" is not read',
            f"{of_those_there(suffix, known)} (of COMPAS)",
            source=str(path),
        )
    found.refuse_without_package()
    return found


def format_written(path: Path) -> Format:
    """The format that the ending of a name asks for.

    Raises:
        InputError: none, naming those there are; or its package is not installed.
    """
    suffix = path.suffix.lower()
    found = BY_SUFFIX.get(suffix)
    if found is None or not found.writer:
        known = [suffix for suffix, item in BY_SUFFIX.items() if item.writer]
        problem = f'a file that ends in "{suffix}" is not written'
        raise InputError(problem, of_those_there(suffix, known), source=str(path))
    if not found.written_without:
        found.refuse_without_package()
    return found


def _named(place: str) -> Any:
    module, _, name = place.partition(".")
    return getattr(importlib.import_module(f"harness.formats.{module}"), name)
