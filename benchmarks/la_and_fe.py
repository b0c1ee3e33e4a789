"""The least state known and the plateau of `fe` on large walls: `python -m benchmarks la_and_fe [WORD]`.

The plateau is a collapse state too, so `la` may not lie above it; a wall is run where WORD is in its name. Coordinates
of walls from `drystone new` are rounded to whole millimetres, as drawings are. CPU seconds of one thread.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from benchmarks.walls import bond, irregular_wall
from cases.start import STARTS
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method import Answer
from harness.model.method_registry import load_method
from harness.model.wall import Wall

ABOVE = 1e-6
"""Relative difference above which a multiplier counts as higher."""
BRICK = {"brick_length": 0.2475, "brick_height": 0.0737}


def in_millimetres(kind: str, **numbers: Any) -> Assembly:
    """A wall of `drystone new` with its corners at whole millimetres."""
    made = STARTS[kind](**numbers)
    data = made.model_dump(exclude_none=True, exclude_unset=True)
    for block in data["blocks"]:
        block["polygon"] = [[round(1000.0 * x), round(1000.0 * y)] for x, y in block["polygon"]]
    data["units"] = {"length": "mm", "force": "kN", "unit_weight": "kN/m3"}
    data["thickness"] = 1000.0 * data["thickness"]
    return build(Wall.model_validate(data)).assembly


def facade(storeys: int, openings: int, laid: str, friction: float) -> Assembly:
    """A facade of bricks of 247.5 by 73.7 mm."""
    return in_millimetres(
        "facade", storeys=storeys, openings=openings, bond=laid, friction=friction, thickness=0.25, **BRICK
    )


WALLS: dict[str, Callable[[], Assembly]] = {
    "facade of 2 storeys, 4 openings each": partial(facade, 2, 4, "running", 0.6),
    "facade, 4 openings": partial(facade, 1, 4, "running", 0.6),
    "facade, 3 openings, Flemish bond": partial(facade, 1, 3, "flemish", 0.75),
    "facade of 2 storeys, 2 openings each, English bond": partial(facade, 2, 2, "english", 0.4),
    "facade of 2 storeys, 2 openings each": partial(facade, 2, 2, "running", 0.9),
    "English bond": partial(in_millimetres, "english", length=3.0, **BRICK),
    "Flemish bond": partial(in_millimetres, "flemish", length=4.0, height=2.0, friction=0.5, **BRICK),
    "ashlar of 20 courses": partial(in_millimetres, "ashlar", length=12.0, courses=20, course_height=0.25),
    "ashlar of 30 courses": partial(
        in_millimetres, "ashlar", length=16.0, courses=30, course_height=0.25, seed=3, friction=0.8
    ),
    "running bond, 40 courses of 30": partial(bond, 40, 30, 0.65),
    "running bond, 60 courses of 42": partial(bond, 60, 42, 0.65),
    "irregular, 20 courses of 20": partial(irregular_wall, 3, 20, 20, 0.6),
    "irregular, 30 courses of 30": partial(irregular_wall, 1, 30, 30, 0.6),
}


def solved(method: str, wall: Assembly, **settings: Any) -> tuple[Answer, float]:
    """The answer of a method and its CPU seconds."""
    began, found = time.process_time(), load_method(method)
    return found.solve(wall, found.Settings(**settings)), time.process_time() - began


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; the number of walls on which `la` lies above `fe`."""
    word = " ".join(sys.argv[1:] if arguments is None else arguments)
    above = 0
    print("| wall | blocks | interfaces | friction | `la` | s | `fe` | s | `la`/`fe` - 1 | source |\n|" + "---|" * 10)
    for name, make in WALLS.items():
        if word not in name:
            continue
        wall = make()
        least, spent = solved("la", wall)
        plateau, spent_fe = solved("fe", wall, histories=(0.0,))
        difference = float("nan")
        if least.multiplier is not None and plateau.multiplier:
            difference = least.multiplier / plateau.multiplier - 1.0
        above += plateau.multiplier is not None and not difference <= ABOVE
        improvements = least.details.get("improvements") or [{"source": "none"}]
        shown = ("none" if answer.multiplier is None else f"{answer.multiplier:.7f}" for answer in (least, plateau))
        known, ended = shown
        size = f"{wall.n_free} | {wall.n_interfaces} | {wall.friction.max():g}"
        values = f"{known} | {spent:.0f} | {ended} | {spent_fe:.0f} | {difference:.1e}"
        print(f"| {name} | {size} | {values} | {improvements[-1]['source']} |", flush=True)
    return above


if __name__ == "__main__":
    sys.exit(main())
