"""Continuation in friction: mechanisms found at lower friction are carried up a ladder to the friction of the wall.

The mechanisms of zero-dilatancy flow do not depend on friction, only the forces that fit them do. At high friction
the low collapse states have small basins; at lower friction the same mechanisms are found at once.

Best of all is to lower it in the joints alone that the dead load leaves unloaded, the head joints of a wall: without
the shear that self-stress gives them, little of the non-associated problem is left that is not convex, and the
interior point ends low on walls of any size.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from methods.la.problem import Problem
from methods.la.search import Effort, Search
from methods.la.state import CollapseState

POOL = 24
"""Mechanisms carried from one rung to the next."""


ROUGH = 1.0
"""Friction above which the rungs are shares of this instead: much higher, most starts end at self-stress."""
ROUGHEST = 1.5
"""Friction to which all joints are lowered where unloaded ones are lowered further."""
ROUGH_RUNGS = (1.0, 1.5, 2.25)
"""Friction of the rungs added for joints that are rougher still."""


def climb(search: Search, ladder: tuple[float, ...], effort: Effort, descents: int) -> Search | None:
    """The search at the last rung of the ladder below the wall's own friction, with all it knows; None without rungs.

    Rough joints add rungs of their own.

    Args:
        search: of the wall itself.
        ladder: factors on all friction coefficients, and on ROUGH where they are higher, in order.
        effort: of each ray descent.
        descents: lowest states a rung descends from.
    """
    below: Search | None = None
    friction = search.problem.friction
    rungs = [factor * np.minimum(friction, ROUGH) for factor in ladder]
    rungs += [np.minimum(friction, most) for most in ROUGH_RUNGS if most < float(friction.max(initial=0.0))]
    for lowered in rungs:
        rung = Search(replace(search.problem, friction=lowered), search.newton, parent=search)
        states = [rung.interior()]
        if below is not None:
            states += rung.adopt(below, POOL)
        descend_from([state for state in states if state is not None], rung, effort, descents)
        below = rung
    return below


def descend_from(states: list[CollapseState], search: Search, effort: Effort, most: int) -> list[CollapseState]:
    """Where ray descent leads from the lowest of the states that differ in multiplier."""
    reached: list[CollapseState] = []
    seen: set[int] = set()
    for state in sorted(states, key=lambda s: s.multiplier):
        place = round(state.multiplier * 1e9)
        if place in seen or len(reached) >= most:
            continue
        seen.add(place)
        reached.append(search.descend(state, effort))
    return reached


def smooth_joints(search: Search, factor: float) -> Search | None:
    """The search of the wall whose unloaded joints have `factor` times their friction; None if all are loaded."""
    guide = smoothed(search.problem, factor)
    if guide is None:
        return None
    smooth = Search(guide, search.newton, parent=search)
    smooth.interior()
    return smooth


def smoothed(problem: Problem, factor: float) -> Problem | None:
    """The wall with friction of ROUGHEST at most, times `factor` in the unloaded joints; None if all are loaded."""
    unloaded = problem.unloaded_joints
    friction = np.minimum(problem.friction, ROUGHEST)
    return replace(problem, friction=np.where(unloaded, factor * friction, friction)) if unloaded.any() else None
