"""The walls of the conformance suite: those whose multiplier follows from statics, and those of the other checks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class ClosedForm:
    """A wall whose multiplier follows from elementary statics."""

    name: str
    wall: dict[str, Any]
    multiplier: float
    formula: str


def _of_pattern(pattern: dict[str, Any], friction: Any, **more: Any) -> dict[str, Any]:
    """A wall of a pattern under a tilt, as JSON data."""
    live = {"live": {"body": [{"per_weight": [1, 0]}]}}
    return {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "pattern": pattern, "loads": live} | more


def _stack_of(count: int, **more: Any) -> dict[str, Any]:
    """A stack of blocks 0.3 x 0.2."""
    return {"type": "stack", "width": 0.3, "height": 0.2, "count": count} | more


def _bond_of(count: int, bricks: int) -> dict[str, Any]:
    """A running bond of bricks 0.4 x 0.2, in so many courses."""
    return {"type": "running_bond", "block_length": 0.4, "block_height": 0.2, "count": count, "bricks": bricks}


CLOSED_FORMS = (
    ClosedForm("slide", _of_pattern(_stack_of(1), 0.4), 0.4, "mu"),
    ClosedForm("topple", _of_pattern(_stack_of(1), 3.0), 1.5, "b / h"),
    ClosedForm("stack-topples", _of_pattern(_stack_of(5), 0.7), 0.3, "b / (n h)"),
    ClosedForm("stack-slides", _of_pattern(_stack_of(5), 0.25), 0.25, "mu"),
    ClosedForm("bond-slides", _of_pattern(_bond_of(4, 3), 0.3), 0.3, "mu"),
)
WITH_FEATURES = (
    ClosedForm("cohesion", _of_pattern(_stack_of(1), 0.4, cohesion=0.4), 0.5, "mu + c b / W"),
    ClosedForm("dilatancy", _of_pattern(_stack_of(1), {"default": 0.4, "dilatancy": 0.2}), 0.4, "mu, whatever psi"),
)
"""Walls that a method may refuse."""
VIEWED = {
    "arch": _of_pattern({"type": "ring", "inner_radius": 1.0, "outer_radius": 1.3, "count": 5}, 0.6),
    "stack": _of_pattern(_stack_of(3, offsets=[0.0, 0.03, -0.02]), 0.6),
}
"""Walls that are seen otherwise: the second for a method that refuses the first."""
PRESSED = _of_pattern(_stack_of(2), 0.5, loads={"live": {"body": [{"per_weight": [0, -1]}]}})
STANDING = _of_pattern(_stack_of(3), 0.5, loads={})
FALLING = _of_pattern(_stack_of(2, offsets=[0.0, 0.2]), 0.5)
LARGE = (_of_pattern(_bond_of(25, 10), 0.65), _of_pattern(_stack_of(100), 0.65))
"""Walls of 263 and 100 blocks for limits of time and memory: the second for a method that refuses the first."""


def odd_names() -> dict[str, Any]:
    """A column whose blocks have names that are hard to write: blanks, quotes, a backslash, letters beyond ASCII."""
    names = ["the ground", 'a "quoted" block', "back\\slash", "µ, ä and 石"]

    def block(k: int) -> dict[str, Any]:
        low, high = 0.2 * (k - 1), 0.2 * k
        corners = [[0.0, low], [0.3, low], [0.3, high], [0.0, high]]
        return {"id": names[k], "polygon": corners} | ({"fixed": True} if k == 0 else {})

    live = {"live": {"body": [{"per_weight": [1, 0]}]}}
    blocks = [block(k) for k in range(4)]
    return {"format": "wall/1", "unit_weight": 20.0, "friction": 0.3, "blocks": blocks, "loads": live}
