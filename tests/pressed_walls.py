"""Walls whose joints crush, as the tests of several methods need them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from harness.engine.judge import answered
from harness.model.assembly import Assembly, FloatArray
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


def set_in(assembly: Assembly, share: FloatArray) -> Assembly:
    """The wall whose joints do not crush, and whose ends are in the middles of strips of these shares (m,), below 1."""
    along = 0.5 * share[:, None] * (assembly.end2 - assembly.end1)
    never = np.full(assembly.n_interfaces, np.inf)
    return replace(assembly, end1=assembly.end1 + along, end2=assembly.end2 - along, crushing=never)


def at_ends(share: FloatArray, forces: FloatArray) -> FloatArray:
    """The contact forces (m, 3) of a wall that is set in, as forces on the ends of its whole joints."""
    near, far = 1.0 - 0.5 * share, 0.5 * share
    first, second, shear = forces.T
    return np.column_stack([near * first + far * second, far * first + near * second, shear])


def column_off_its_axis(own: float, full: float, eccentricity: float) -> float:
    """The force at which a column of weight `own` crushes at its base, whose block bears `full` over the whole [force].

    N (1 - N / F0) = |e| P with N = W + P, the eccentricity e in halves of the width.
    """
    linear = 1.0 - abs(eccentricity) - 2.0 * own / full
    return 0.5 * full * (linear + float(np.sqrt(linear**2 + 4.0 * (own - own**2 / full) / full)))
