"""Walls whose joints crush, as the tests of several methods need them."""

from __future__ import annotations

from typing import Any

from harness.engine.judge import answered
from harness.model.assembly import Assembly
from harness.model.method_registry import load_method
from harness.model.result import Result
from tests.walls import assembly


def found(name: str, wall: Assembly, **settings: Any) -> Result:
    """The answer of a method, which the judge accepts."""
    result, judgement = answered(load_method(name), wall, **settings)
    assert judgement.accepted, result.sentence + judgement.sentence
    return result


SEMICIRCLES = (
    (0.15, None, 0.1493502),
    (0.15, 100.0, 0.1434694),
    (0.15, 20.0, 0.1184576),
    (0.15, 5.0, 0.0247402),
    (0.2, None, 0.2856458),
    (0.2, 100.0, 0.2789968),
    (0.2, 20.0, 0.2530433),
    (0.2, 5.0, 0.1445606),
)
"""Thickness, compressive strength (None: joints do not crush) and multiplier of `arch`, by programmes of other code."""
DIGITS = 5e-8
"""Half a unit of the last digit of these multipliers."""


def arch(thickness: float, strength: float | None, friction: float = 1e3, **more: Any) -> Assembly:
    """A semicircle of mean radius 1 of 20 voussoirs; by default they do not slide."""
    ring = {"type": "ring", "inner_radius": 1.0 - thickness / 2, "outer_radius": 1.0 + thickness / 2, "count": 20}
    crushing = {} if strength is None else {"compressive_strength": strength}
    return assembly(ring, friction, unit_weight=1.0, **crushing, **more)
