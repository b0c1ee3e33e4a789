"""The wall with less friction in the joints that the dead load leaves unloaded, the head joints of a wall.

Without the shear that self-stress gives them, little of the non-associated problem is left that is not convex, and the
interior point ends low on walls of any size. The mechanisms are those of the wall itself.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from methods.la.core.problem import Problem

_ROUGHEST = 1.5
"""Friction of all joints at most, where unloaded ones are lowered further; above, starts end at self-stress."""


def with_reduced_friction(problem: Problem, factor: float) -> Problem | None:
    """The wall with friction of _ROUGHEST at most, times `factor` in the unloaded joints; None if all are loaded."""
    unloaded = problem.unloaded_joints
    if not unloaded.any():
        return None
    friction = np.minimum(problem.friction, _ROUGHEST)
    return replace(problem, law=problem.law.with_friction(np.where(unloaded, factor * friction, friction)))
