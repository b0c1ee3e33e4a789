"""A collapse that goes on: the multiplier of the live load that a wall bears where its mechanism has carried it.

In the wall as it stands at a point of the way, whose opened joints are pins, the greatest multiplier of statics is
found with the mechanism dual to it, as drawn of the associated programme. The wall follows that mechanism by finite
rotations (`settling`). Mechanisms that slide are not followed, so that the flow does not matter beyond the first state.
The multiplier falls to zero where the wall falls under its dead load.

Sources: Heyman (1995) on rocking blocks; Makris and Vassiliou (2013) on the portal.
"""

from __future__ import annotations

import numpy as np

from harness.model.result import fastest_vertex
from methods.la.core.problem import make_problem
from methods.la.core.vertex_programmes import force_programme
from methods.la.moved_wall import MovedWall
from methods.la.settling import FALLS, STUCK, StandingState


def with_multiplier(wall: MovedWall) -> StandingState | str:
    """The greatest multiplier of a wall as it stands, and its mechanism with a fastest vertex of speed one.

    Returns:
        The state; `FALLS` where its multiplier is below zero; `STUCK` where it has moved and no multiplier balances it;
        or how the programme of the wall as drawn ended.
    """
    assembly = wall.assembly
    problem = make_problem(assembly)
    tight = np.zeros((assembly.n_interfaces, 4), dtype=bool)
    tight[:, :2] = ~wall.closed
    found = force_programme(problem).extreme(greatest=True, tight=tight)
    if isinstance(found, str):
        return STUCK if np.any(wall.places) else found
    multiplier = problem.to_multiplier(found.statics.multiplier)
    if multiplier < 0.0:
        return FALLS
    mechanism = np.zeros((assembly.n_blocks, 3))
    mechanism[assembly.free] = problem.velocities_of_blocks(found.kinematics.velocities)
    return StandingState(
        wall, multiplier, problem.to_forces(found.statics.forces), mechanism / fastest_vertex(assembly, mechanism)
    )
