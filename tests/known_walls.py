"""Walls of which it is known by hand, by enumeration and in fractions what is true, with right answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np

from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method import Answer, Finding, Status
from harness.model.method_registry import load_method
from harness.model.wall import Wall
from tests.exact_programme import greatest_multiplier
from tests.walls import PUSH, assembly, running_bond, stack

LEAN = {"offsets": [0.0, 0.2, 0.3]}


@dataclass(frozen=True, eq=False)
class Item:
    """A wall, what is true of it, and right states of it.

    Attributes:
        wall: the wall.
        falls: whether it falls under its dead load.
        least, greatest: multipliers that a collapse state can have; None where there is none, infinite without end.
        condition: relative change of the multiplier by one of the forces: how far the load is from one without end.
        states: answers of methods.
    """

    wall: Assembly
    falls: bool
    least: float | None
    greatest: float | None
    condition: float
    states: tuple[Answer, ...]

    def denies(self, answer: Answer, slack: float) -> bool:
        """Whether an answer is false, by more than a relative slack of its multiplier."""
        match answer.finding:
            case Finding.FALLS:
                return not self.falls
            case Finding.STANDS:
                return self.falls
            case Finding.UNBOUNDED:
                return self.falls or self.greatest != np.inf
        assert answer.multiplier is not None
        if self.greatest is None or not self.wall.has_live_load:
            return True
        slack *= self.condition
        if answer.flow == "approximate":
            lower = answer.multiplier if answer.bracket is None else answer.bracket[0]
            return lower > self.greatest * (1.0 + slack)
        if self.least is None:
            return True
        lowest = self.greatest if answer.flow == "associated" else self.least
        return not lowest * (1.0 - slack) <= answer.multiplier <= self.greatest * (1.0 + slack)


def box(name: str, x: float, y: float, width: float = 1.0, height: float = 1.0, **more: Any) -> dict[str, Any]:
    """A block that is a rectangle, by its lower left corner."""
    return {"id": name, "polygon": [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]} | more


def of_blocks(blocks: list[dict[str, Any]], friction: Any = 0.5, loads: Any = PUSH) -> Assembly:
    """The wall of blocks upon a wide support."""
    low = min(point[1] for block in blocks for point in block["polygon"])
    left = min(point[0] for block in blocks for point in block["polygon"])
    ground = box("g", left - 2.0, low - 1.0, 20.0, 1.0, fixed=True)
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "blocks": [ground, *blocks], "loads": loads}
    return build(Wall.model_validate(data)).assembly


def push(*blocks: str) -> dict[str, Any]:
    """A tilt of some blocks alone."""
    return {"live": {"body": [{"per_weight": [1.0, 0.0], "blocks": list(blocks)}]}}


def smooth(*pairs: tuple[str, str]) -> dict[str, Any]:
    """Friction .5, but none between some pairs of blocks."""
    return {"default": 0.5, "rules": [{"between": list(pair), "value": 0.0} for pair in pairs]}


def jammed(heavy: float = 0.0, **upper: Any) -> Assembly:
    """A block on the ground under one held between smooth supports; with a heavy one that leans against the first."""
    blocks = [
        box("a", 0.0, 0.0),
        box("l", -1.0, 1.0, fixed=True),
        box("b", 0.0, 1.0, **upper),
        box("r", 1.0, 1.0, fixed=True),
    ]
    pairs = [("b", "l"), ("b", "r")]
    if heavy:
        blocks.append(box("h", -1.0, 0.0, weight=heavy))
        pairs += [("a", "h"), ("h", "l")]
    return of_blocks(blocks, smooth(*pairs), push("a"))


def between(loads: Any, friction: float = 0.0) -> Assembly:
    """A block between two supports: it falls, unless they are rough and the live load presses it."""
    blocks = [box("l", -1.0, 0.0, fixed=True), box("a", 0.0, 0.0), box("r", 1.0, 0.0, fixed=True)]
    data = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "blocks": blocks}
    return build(Wall.model_validate(data | ({"loads": loads} if loads else {}))).assembly


def wedge(slope: float) -> Assembly:
    """A block between two smooth supports that lean against it by so little: it stands by forces of 1 / (2 slope)."""
    block = {"id": "a", "polygon": [[0.0, 0.0], [1.0, 0.0], [1.0 + slope, 1.0], [-slope, 1.0]]}
    left = {"id": "l", "polygon": [[-1.0, 0.0], [0.0, 0.0], [-slope, 1.0], [-1.0, 1.0]], "fixed": True}
    right = {"id": "r", "polygon": [[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0 + slope, 1.0]], "fixed": True}
    return build(
        Wall.model_validate({"format": "wall/1", "unit_weight": 20.0, "friction": 0.0, "blocks": [left, block, right]})
    ).assembly


def three(weights: tuple[float, float, float]) -> Assembly:
    """Three blocks of their own weights that do not touch, of frictions .3, .5 and .7."""
    blocks = [box(name, x, 0.0, weight=weight) for name, x, weight in zip("abc", (0.0, 4.0, 8.0), weights, strict=True)]
    rules = [{"between": ["g", name], "value": mu} for name, mu in (("a", 0.3), ("b", 0.5), ("c", 0.7))]
    return of_blocks(blocks, {"default": 0.5, "rules": rules})


ARCH = {"type": "ring", "inner_radius": 1.0, "outer_radius": 1.3, "count": 3}
PANEL = {"type": "panel", "cell_length": 0.5, "cell_height": 0.2, "layout": ["CC", "AB", "__"], "fixed": "_"}
LEAST = {
    "stack that slides": 0.25,
    "stack that topples": 0.5,
    "stack in map coordinates": 0.3,
    "light upon heavy": 0.3,
    "heavy upon light": 0.3,
    "pushed upon heavy": 0.3,
    "bonded": 0.5,
    "arch": 0.3252885728627275,
    "jammed": 1.5,
    "jammed without weight": 0.5,
    "jammed beside a heavy block": 1.5,
    "heavy bystander": 0.5,
    "three": 0.3,
    "three of uneven weights": 0.3,
    "falls between supports, drawn up": 1.0,
    "drawn down, hardly beyond friction": 1e6,
}
"""Least multipliers, by hand (mu, b / (n h), 3 mu under the weight of another); of the arch by enumeration."""
WALLS: dict[str, Callable[[], Assembly]] = {
    "stack that slides": lambda: assembly(stack(3), 0.25),
    "stack that topples": lambda: assembly(stack(3), 0.9),
    "stack in map coordinates": lambda: of_blocks([box("a", 5e6, 5e6), box("b", 5e6, 5e6 + 1.0)], 0.3),
    "light upon heavy": lambda: of_blocks([box("a", 0.0, 0.0, weight=2e9), box("b", 0.0, 1.0, weight=1.0)], 0.3),
    "heavy upon light": lambda: of_blocks([box("a", 0.0, 0.0, weight=1.0), box("b", 0.0, 1.0, weight=2e9)], 0.3),
    "pushed upon heavy": lambda: of_blocks(
        [box("a", 0.0, 0.0, weight=2e10), box("b", 0.0, 1.0, weight=20.0)], 0.3, push("b")
    ),
    "bonded": lambda: assembly(PANEL, 0.5),
    "arch": lambda: assembly(ARCH, 0.6),
    "jammed": jammed,
    "jammed beside a heavy block": lambda: jammed(1e12),
    "jammed without weight": lambda: jammed(weight=0.0),
    "wedge of a hair": lambda: wedge(3e-7),
    "held by its live load": lambda: between(PUSH, 0.5),
    "heavy bystander": lambda: of_blocks(
        [box("a", 0.0, 0.0), box("h", 4.0, 0.0, 2.0, 2.0, weight=2e11)], 0.5, push("a")
    ),
    "three": lambda: three((20.0, 20.0, 20.0)),
    "three of uneven weights": lambda: three((1.0, 1e6, 1e12)),
    "falls between supports": lambda: between(None),
    "falls between supports, drawn up": lambda: between({"live": {"body": [{"per_weight": [0.0, 1.0]}]}}),
    "stands": lambda: assembly(stack(3), 0.5, loads={}),
    "stands, smooth on top": lambda: of_blocks(
        [box("a", 0.0, 0.0), box("b", 0.0, 1.0), box("c", 0.0, 2.0)], smooth(("b", "c")), {}
    ),
    "leans and falls": lambda: assembly(stack(3) | LEAN, 0.5),
    "drawn down": lambda: assembly(running_bond(2, 1), 0.5, loads={"live": {"body": [{"per_weight": [0.0, -1.0]}]}}),
    "drawn down, hardly beyond friction": lambda: of_blocks(
        [box("a", 0.0, 0.0)], 0.5, {"live": {"body": [{"per_weight": [0.5 * (1.0 + 1e-6), -1.0]}]}}
    ),
}


@cache
def item(name: str) -> Item:
    """A wall by its name, with what is true of it."""
    wall = WALLS[name]()
    greatest = greatest_multiplier(wall)
    falls = greatest_multiplier(replace(wall, live=np.zeros_like(wall.live))) is None
    answers = []
    for method in ("la", "la-associated", "fe"):
        chosen = load_method(method)
        answer = chosen.solve(wall, chosen.Settings())
        if answer.status is Status.OK:
            answers.append(answer)
    condition = 1e6 if name == "drawn down, hardly beyond friction" else 1.0
    return Item(wall, falls, LEAST.get(name), None if greatest is None else float(greatest), condition, tuple(answers))
