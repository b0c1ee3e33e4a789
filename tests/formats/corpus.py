"""Drawings with the faults of real ones, made of walls whose answer is known.

A wall becomes a DXF; a trait is what happened to it on the way. The answer of the exact wall is that of the drawing, as
nearly as the trait allows.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import ezdxf
import numpy as np
import shapely

from cases.start import STARTS, bonded
from cases.useful import irregular_stones
from harness.formats.importing import Mapping
from harness.model.build import build
from harness.model.wall import Wall

Polygons = list[np.ndarray]


def door_under_rowlock() -> Wall:
    """A Flemish wall with a door under a semicircular rowlock arch; bricks are cut along the arch's back."""
    plain = bonded("flemish", 2.5, 1.95, (0.25, 0.075), 0.6, 0.25)
    inner, outer, springing, middle, count = 0.4, 0.52, 0.9, 1.25, 13

    def at(radius: float, k: int) -> tuple[float, float]:
        angle = math.pi * (1.0 - k / count)
        return middle + radius * math.cos(angle), springing + radius * math.sin(angle)

    backs = [at(outer, k) for k in range(count + 1)]
    hole = shapely.Polygon([*backs, (middle + inner, springing), (middle + inner, 0.0), (middle - inner, 0.0),
                            (middle - inner, springing)])  # fmt: skip
    blocks = []
    for block in plain.blocks:
        shape = shapely.Polygon(block.polygon)
        left = shape if block.fixed else shapely.difference(shape, hole, grid_size=1e-9)  # no spurs by rounding
        for number, part in enumerate(shapely.get_parts(left)):
            if part.geom_type == "Polygon" and part.area > 0.5 * 0.125 * 0.075:  # masons leave smaller bats out
                ring = [tuple(point) for point in part.exterior.coords[:-1]]
                blocks.append({"id": f"{block.id}/{number}", "polygon": ring, "fixed": block.fixed})
    for k in range(count):
        ring = [at(inner, k), at(inner, k + 1), at(outer, k + 1), at(outer, k)]
        blocks.append({"id": f"v{k}", "polygon": ring})
    return Wall.model_validate(plain.document() | {"title": "door", "blocks": blocks})


BASES: dict[str, Callable[[], Wall]] = {
    "door": door_under_rowlock,
    "irregular": lambda: irregular_stones(7, 3.0, 6),
    "bridge": STARTS["bridge"],
    "two-leaf": STARTS["two-leaf"],
    "facade": lambda: STARTS["facade"](storeys=1, openings=1, brick_length=0.5, brick_height=0.2),
    "english": lambda: STARTS["english"](length=1.25, height=0.6),
}


@dataclass(frozen=True)
class Trait:
    """What happened to a wall on its way to the drawing.

    Attributes:
        change: of the polygons [m].
        step: coordinates are rounded to this [m]; zero leaves them.
        angle: the sheet is turned by this [degrees].
        twice: outlines are drawn a second time, on another layer.
        lines: stones are drawn as four lines instead of polylines.
        blocks: stones are inserted as blocks (INSERT) with a scale and a shift.
    """

    change: Callable[[Polygons], Polygons] = lambda polygons: polygons
    step: float = 0.0
    angle: float = 0.0
    twice: bool = False
    lines: bool = False
    blocks: bool = False


def _hair(polygons: Polygons) -> Polygons:
    """Stones moved by up to .4 mm, so that they overlap or part by a hair."""
    dice = random.Random(5)
    return [polygon + np.array([dice.uniform(-4e-4, 4e-4) for _ in range(2)]) for polygon in polygons]


TRAITS: dict[str, Trait] = {
    "mm": Trait(step=1e-3),
    "turned-mm": Trait(step=1e-3, angle=17.0),
    "twice": Trait(twice=True),
    "hair": Trait(change=_hair, step=1e-3),
    "blocks": Trait(blocks=True),
    "lines": Trait(lines=True),
}


def drawn(wall: Wall, trait: Trait, path: Path) -> Mapping:
    """Write the drawing of a wall in millimetres, and give the mapping that says what it does not."""
    built = build(wall)
    turn = math.radians(trait.angle)
    matrix = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    polygons = [polygon @ matrix.T for polygon in trait.change(list(built.assembly.polygons))]
    if trait.step:
        polygons = [np.round(polygon / trait.step) * trait.step for polygon in polygons]
    polygons = [np.round(1e3 * p) if trait.step == 1e-3 else 1e3 * p for p in polygons]
    document = ezdxf.new("R2010")  # type: ignore[attr-defined]
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    for number, (polygon, fixed) in enumerate(zip(polygons, built.assembly.fixed, strict=True)):
        layer = {"layer": "GROUND" if fixed else "STONES"}
        if trait.lines:
            for start, end in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
                space.add_line(start.tolist(), end.tolist(), dxfattribs=layer)
        elif trait.blocks:
            block = document.blocks.new(f"STONE{number}")
            block.add_lwpolyline((polygon - polygon[0]).tolist(), close=True)
            space.add_blockref(f"STONE{number}", polygon[0].tolist(), dxfattribs=layer)
        else:
            space.add_lwpolyline(polygon.tolist(), close=True, dxfattribs=layer)
            if trait.twice:
                space.add_lwpolyline((polygon + 0.1).tolist(), close=True, dxfattribs={"layer": "COPY"})
    document.saveas(path)
    down = matrix @ [0.0, -1.0]
    side = matrix @ [1.0, 0.0]
    return Mapping(
        friction=wall.friction if isinstance(wall.friction, float) else None,
        unit_weight=wall.unit_weight,
        thickness=1e3 * (wall.thickness or 1.0),
        supports="layer GROUND",
        gravity=(float(down[0]), float(down[1])),
        live=(float(side[0]), float(side[1])),
        tolerance=2.0 if trait.change is _hair else (1e-3 if not trait.step else None),
    )
