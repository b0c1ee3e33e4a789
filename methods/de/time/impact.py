"""Whether the engine loses the energy that a rocking block loses: a test of the engine, made before it is believed."""

from __future__ import annotations

import functools

import numpy as np

from harness.model.build import build
from harness.model.wall import Wall
from methods.de.engines.pymunk_blocks import PymunkBlocks
from methods.de.settings import TimeSteps
from methods.de.time.history import tuning

_SLENDERNESS = 0.2
"""Width over height of the block that rocks."""
HOUSNER = 1.0 - 1.5 * _SLENDERNESS**2 / (1.0 + _SLENDERNESS**2)
"""Angular velocity after an impact over that before, 1 - (3/2) sin^2(alpha) (Housner 1963)."""
WITHIN = 0.01
"""Relative error of e^2 from which the engine is refused: thresholds of toppling follow it to first order."""
_LONGEST = 30.0
"""Time in which a block released at half its angle alpha turns back twice: three times what it takes, 8.8."""


@functools.cache
def measured_impact(steps: TimeSteps) -> float:
    """Ratio e of the angular velocities of a block at an impact, by the energies before and after it.

    A block of .4 x 2 is released at half its angle of toppling. Its energy is taken as it turns back on the other side,
    and again after the impact that follows. Not a number where it does not come so far.
    """
    stack = {"type": "stack", "width": 2.0 * _SLENDERNESS, "height": 2.0, "count": 1}
    block = build(Wall.model_validate({"format": "wall/1", "unit_weight": 1.0, "friction": 100.0, "pattern": stack}))
    wall = block.assembly
    space = PymunkBlocks(wall, iterations=steps.iterations, options=tuning(steps), weighed=True)
    (free,) = wall.free
    turn = -0.5 * np.arctan(_SLENDERNESS)
    arm = np.array([-_SLENDERNESS, 1.0])  # from the right edge to the centroid
    turned = np.array([np.cos(turn) * arm[0] - np.sin(turn) * arm[1], np.sin(turn) * arm[0] + np.cos(turn) * arm[1]])
    places = np.zeros((wall.n_blocks, 3))
    places[free] = *(turned - arm), turn
    space.put(places)
    first, furthest = 0.0, 0.0
    for _ in range(int(_LONGEST / steps.time_step)):
        space.advance(1)
        angle = space.places()[free, 2] if first == 0.0 else -space.places()[free, 2]
        if furthest > 0.0 and angle < furthest:
            if first > 0.0:
                return float(np.sqrt(space.energy() / first))
            first, furthest = space.energy(), 0.0
        else:
            furthest = max(furthest, angle)
    return float("nan")
