"""Collapse states of the largest walls: safe contact forces led to a mechanism along an exact path.

A point on the associated path somewhat before its end has contact forces in equilibrium, within yield by a margin; with
the joints smooth that the dead load leaves unloaded, they lead to low collapse states. Springs in the contacts carry
them as they stand, and the live load changes along the equilibrium path of the wall
(`methods.springs`) until a mechanism moves without any change of force: an exact collapse state under zero dilatancy,
whatever the stiffness of the springs. Where no forces fit the mechanisms that the central path ends at, this one has
both from the start.
"""

from __future__ import annotations

from dataclasses import dataclass

from methods.la.continuation import smoothed
from methods.la.interior_point import PathSettings, follow_path, start_point
from methods.la.newton_matrix import NewtonMatrix
from methods.la.problem import Problem
from methods.la.state import CollapseState, moving_contacts
from methods.springs.factor import make_factor
from methods.springs.path_record import PathEnd, PathRecord
from methods.springs.plateau import finish
from methods.springs.preload import preloaded
from methods.springs.settings import GapSettings
from methods.springs.wall_model import build_model

SAFE = PathSettings(dilatancy=1.0, gap=0.1, residual=1e-7)
"""Where the associated path is left. Full steps meet the equilibrium at a gap of half a percent or so."""
CERTIFICATE = 1e-12
"""Residual of a mechanism at which the path ends."""
MOST_KINKS = 5
"""Changes of state per gap point after which the path is given up."""


@dataclass(frozen=True)
class PrestressedResult:
    """The collapse state at the end of the path, or None; Newton steps before it, kinks along it."""

    state: CollapseState | None
    steps: int
    kinks: int


def prestressed_state(problem: Problem, newton: NewtonMatrix) -> PrestressedResult:
    """The collapse state that safe forces of the wall lead to.

    Args:
        problem: the scaled wall, which stands under its dead load and has a live load.
        newton: its Newton matrix.
    """
    guide = smoothed(problem, 0.0) or problem
    safe = follow_path(guide, newton, start_point(guide), SAFE)
    if not safe.converged:
        return PrestressedResult(None, safe.iterations, 0)
    forces = problem.to_forces(guide.forces_of_slacks(safe.point.slack))
    multiplier = safe.point.multiplier * problem.unit_multiplier
    model = build_model(problem.assembly, GapSettings())
    tracer = preloaded(model, make_factor(model), multiplier, forces, CERTIFICATE)
    record = PathRecord()
    end = tracer.run(record, MOST_KINKS * model.n_points)
    found = finish(model, tracer.present(), tracer.kept) if end in (PathEnd.PLATEAU, PathEnd.BREAKDOWN) else None
    if found is None:
        return PrestressedResult(None, safe.iterations, record.events)
    velocities = problem.from_mechanism(found.mechanism)
    velocities *= problem.live_work / float(problem.live @ velocities)
    moving = moving_contacts(problem.rates_of_velocities(velocities, False))
    state = CollapseState(
        found.forces / problem.unit_force, found.multiplier / problem.unit_multiplier, velocities, moving
    )
    return PrestressedResult(state, safe.iterations, record.events)
