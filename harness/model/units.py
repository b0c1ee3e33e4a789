"""Units a wall may be written in. Lengths and forces stay as written; what a unit weight means is converted to them.

A multiplier of weight has no unit, and one of a force has the unit of that force, whatever the lengths are in; so a
wall is computed in the units of its file. They decide what a unit weight in other units amounts to, how thick a wall is
that gives no thickness (one metre), and whether its sizes and weights are plausible.
"""

from __future__ import annotations

import re
from typing import Literal, get_args

LengthUnit = Literal["m", "dm", "cm", "mm", "km", "in", "ft", "yd", "1"]
ForceUnit = Literal["N", "daN", "kN", "MN", "kgf", "kg", "tf", "t", "lbf", "kip", "1"]
DIMENSIONLESS = "1"
"""The unit of walls without units, as of closed forms."""

METRES = {
    "m": 1.0,
    "dm": 0.1,
    "cm": 0.01,
    "mm": 0.001,
    "km": 1000.0,
    "in": 0.0254,
    "ft": 0.3048,
    "yd": 0.9144,
}
"""One unit of length [m]."""
KILONEWTONS = {
    "N": 0.001,
    "daN": 0.01,
    "kN": 1.0,
    "MN": 1000.0,
    "kgf": 0.00980665,
    "kg": 0.00980665,
    "tf": 9.80665,
    "t": 9.80665,
    "lbf": 0.0044482216152605,
    "kip": 4.4482216152605,
}
"""One unit of force [kN]; a mass stands for its weight under standard gravity, 9.80665 m/s2."""

_UNIT_WEIGHT = re.compile(r"\s*([A-Za-z]+)\s*/\s*([a-z]+)\s*(?:\^?3|³)\s*")


def unit_weight_in_kn_m3(unit: str) -> float:
    """One unit of weight per volume, written like "kN/m3", "N/mm3" or "kg/m3" [kN/m3].

    Raises:
        ValueError: it is not written so, or of a unit that is not known.
    """
    match = _UNIT_WEIGHT.fullmatch(unit)
    if match is None or match[1] not in KILONEWTONS or match[2] not in METRES:
        forces = ", ".join(name for name in get_args(ForceUnit) if name != DIMENSIONLESS)
        raise ValueError(f'a unit of weight is FORCE/LENGTH3, as "kN/m3" or "kg/m3"; forces: {forces}')
    return KILONEWTONS[match[1]] / METRES[match[2]] ** 3
