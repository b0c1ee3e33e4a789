"""Walls: read from files and drawings, built from data, made from a few numbers, or taken from the library."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from harness import formats
from harness.engine.plan import find_cases
from harness.model import reading
from harness.model.assembly import Assembly
from harness.model.case import Case, CaseFile, case_folders, case_of_wall, id_of, shipped_cases
from harness.model.errors import InputError, of_those_there, raise_faults
from harness.model.load_cases import load_cases_of
from harness.model.wall import Wall as Description
from harness.model.writing import write_whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure

formats.register()


@dataclass(frozen=True)
class Wall:
    """A wall that is ready to be analysed. In a notebook it draws itself.

    Attributes:
        case: the wall as the engine runs it, with the references it is compared with, if it has any.
    """

    case: Case

    @property
    def name(self) -> str:
        """The name under which its results are listed."""
        return self.case.id

    @property
    def title(self) -> str:
        """What it is, in a few words."""
        return self.case.file.title

    @property
    def assembly(self) -> Assembly:
        """Its numeric view: blocks, interfaces, loads; `Assembly` has the sign conventions."""
        return self.case.assembly

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences about what is doubtful in it, under any of its load cases."""
        return tuple(dict.fromkeys(sentence for each in load_cases_of(self.case) for sentence in each.warnings))

    @property
    def units(self) -> dict[str, str]:
        """Names of its units of force and length."""
        return {"force": self.case.wall.units.force, "length": self.case.wall.units.length}

    @property
    def load_cases(self) -> dict[str, Wall]:
        """The wall under each of its named load cases; empty if its file names none."""
        return {
            each.load_case: Wall(each)
            for each in load_cases_of(self.case)
            if each.load_case and self.case.wall.load_case_fields
        }

    def called(self, name: str) -> Wall:
        """The same wall under another name."""
        return Wall(self.case.called(id_of(name)))

    def document(self, *, explicit: bool = False) -> dict[str, Any]:
        """The wall as JSON data in the format wall/1.

        Args:
            explicit: every block with its weight and every interface with its friction, in place of patterns and rules.
        """
        return (self.case.built.wall if explicit else self.case.wall).document()

    def save(self, path: str | Path) -> None:
        """Write the wall as a WALL.json."""
        write_whole(Path(path), reading.wall_json(self.case.wall))

    def plot(self) -> Figure:
        """A figure of the blocks with their names, joints, supports and loads."""
        from reports.figures.figures import wall_figure

        return wall_figure(self.case.built, self.title)

    def _repr_html_(self) -> str:
        from reports.drawing.svg import html
        from reports.drawing.wall_drawing import wall_drawing

        free, joints = self.assembly.n_free, self.assembly.n_interfaces
        return html(f"{self.title}: {free} free blocks, {joints} interfaces", wall_drawing(self.case))

    def __repr__(self) -> str:
        if named := self.case.wall.load_case_fields:
            return f"<Wall {self.name}: load cases {', '.join(named)}>"
        free, joints = self.assembly.n_free, self.assembly.n_interfaces
        return f"<Wall {self.name}: {free} free blocks, {joints} interfaces>"


def read_wall(path: str | Path) -> Wall:
    """The wall of a WALL.json or of a drawing (DXF, SVG, GeoJSON, WKT, shapefile, CSV, gmsh, COMPAS).

    Raises:
        InputError: naming the file, the element and what would be right.
    """
    wall = Wall(case_of_wall(Path(path)))
    _check(wall.case)
    return wall


def build_wall(document: Mapping[str, Any] | Description, name: str = "wall") -> Wall:
    """The wall of JSON data in the format wall/1.

    >>> stone = {"id": "a", "polygon": [[0, 0], [0.4, 0], [0.4, 0.2], [0, 0.2]]}
    >>> ground = {"id": "g", "fixed": True, "polygon": [[0, -0.1], [0.4, -0.1], [0.4, 0], [0, 0]]}
    >>> build_wall({"format": "wall/1", "unit_weight": 20, "friction": 0.5, "blocks": [ground, stone]})
    <Wall wall: 1 free blocks, 1 interfaces>

    Raises:
        InputError: naming the element and what would be right.
    """
    if not isinstance(document, Description | Mapping):
        remedy = "Give the data of a wall; drystone.read_wall reads a file"
        raise InputError(f"{document!r:.80} is no wall", remedy, "document")
    wall = document if isinstance(document, Description) else reading.parse_wall(dict(document), name)
    title = wall.title or name
    file = CaseFile(id=id_of(name), title=title, source=str(wall.metadata.get("source", "the user")))
    made = Wall(Case(file, wall, name))
    _check(made.case)
    return made


def checked_wall(given: object) -> Wall:
    """What a user gives as a wall, which must be one.

    Raises:
        InputError: it is something else, as the path of a file.
    """
    if isinstance(given, Wall):
        return given
    called = f"{given!r:.80}"
    path = isinstance(given, str | Path)
    remedy = f"Give drystone.read_wall({called})" if path else "Give what read_wall or build_wall returns"
    raise InputError(f"{called} is no wall", remedy, "wall")


def checked_walls(given: Any) -> list[Wall]:
    """What a user gives as one wall or several. Raises InputError as `checked_wall`."""
    several = isinstance(given, Iterable) and not isinstance(given, str)
    return [checked_wall(each) for each in (given if several else [given])]


def _check(case: Case) -> None:
    """Faults are reported when a wall is made and not at its first use."""
    for each in load_cases_of(case):
        _ = each.built


def new_wall(kind: str, **numbers: Any) -> Wall:
    """A wall of a kind from a few numbers, as `drystone new` makes it; `drystone new --help` lists the kinds.

    >>> new_wall("stack", count=4)
    <Wall stack: 4 free blocks, 4 interfaces>

    Raises:
        InputError: an unknown kind, an unknown number, or numbers of which no wall can be made.
    """
    from cases.start import STARTS

    if kind not in STARTS:
        raise InputError(f'no kind of wall is called "{kind}"', of_those_there(kind, STARTS))
    known = signature(STARTS[kind]).parameters
    if unknown := [name for name in numbers if name not in known]:
        raise InputError(f'it has no number "{unknown[0]}"', of_those_there(unknown[0], known), kind)
    return build_wall(started(STARTS[kind], kind, numbers), kind)


def started(maker: Callable[..., Description], kind: str, numbers: Mapping[str, Any]) -> Description:
    """What a maker of walls of a kind makes of numbers.

    Raises:
        InputError: numbers of which no wall can be made.
    """
    from cases.start import MAY_BE_ZERO

    odd = [
        InputError(f"it should be {'at least' if name in MAY_BE_ZERO else 'above'} 0 (given: {value})", "", name)
        for name, value in numbers.items()
        if isinstance(value, int | float)
        and not (math.isfinite(value) and (value > 0 or (value == 0 and name in MAY_BE_ZERO)))
    ]
    raise_faults(odd, kind)
    try:
        return maker(**numbers)
    except ValidationError as error:
        reading.raise_found(error, Description, {}, kind)
        raise AssertionError("a validation error has faults") from None
    except (TypeError, ValueError) as error:
        raise InputError(f"the wall cannot be made ({error})", "Give other numbers", kind) from None


def library_wall(name: str) -> Wall:
    """A wall of the library, with its published references.

    >>> library_wall("wall-21")
    <Wall wall-21: 21 free blocks, 49 interfaces>

    Raises:
        InputError: no case is called so.
    """
    (case,) = find_cases([name], None, ())
    return Wall(case)


def library_walls() -> list[str]:
    """Names of all walls of the library."""
    return list(case_folders([shipped_cases()]))
