"""The wall of 21 bricks whose joints have cohesion and tensile strength, as the tests of several methods need it."""

from __future__ import annotations

from harness.model.assembly import Assembly
from tests.walls import assembly

BOND = {"type": "running_bond", "block_length": 1.0, "block_height": 0.5, "count": 6, "bricks": 3}
"""The 21 bricks, of length one."""

ASSOCIATED = (
    (0.0, 0.0, 0.5844609),
    (0.05, 0.0, 0.6222349),
    (0.25, 0.0, 0.65 + 0.75 / 9.0),
    (0.5, 0.0, 0.65 + 1.5 / 9.0),
    (1.0, 0.0, 0.9707455),
    (0.05, 0.025, 0.6272891),
    (0.25, 0.125, 0.65 + 0.75 / 9.0),
    (1.0, 0.5, 0.9833333),
)
"""Cohesion, tensile strength and associated maximum at friction .65 and unit weight 1, by programmes of other code.

From a cohesion of .25 to .5 the base slides as a whole, at mu + 3 c / 9.
"""
PRINTED = 1e-7
"""Relative, of values that are known to seven digits."""


def bonded(cohesion: float, tension: float, dilatancy: float = 0.0) -> Assembly:
    """The wall with these strengths in all joints; with the dilatancy of the friction its limit is the associated."""
    law = {"default": 0.65, "dilatancy": dilatancy, "cohesion": cohesion, "tensile_strength": tension}
    return assembly(BOND, law, unit_weight=1.0)
