"""Load the compiled kernels when a method is imported, so that the first wall does not pay for it."""

from __future__ import annotations

from functools import cache

import numpy as np

from harness.model.assembly import Assembly
from methods.springs.model.exact_rates import exact_gap_rates
from methods.springs.model.factor import SparseFactor
from methods.springs.model.gap_law import STICK, neighbour_states
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import build_model
from methods.springs.path.breakpoints import live_rate, strain_rates
from methods.springs.path.continuation import PathFollower
from methods.springs.path.path_record import PathRecord
from methods.springs.path.plateau import finish
from methods.springs.rest.equilibrium import first_step, gravity_state


def block_on_halves(friction: tuple[float, float]) -> Assembly:
    """The block of Baggio and Trovalusci (1995): L x L/2 on two contact halves with different friction, L = 1."""
    base = np.array([[0.0, -0.5], [1.0, -0.5], [1.0, 0.0], [0.0, 0.0]])
    block = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]])
    end1, end2 = np.array([[0.0, 0.0], [0.5, 0.0]]), np.array([[0.5, 0.0], [1.0, 0.0]])
    return Assembly(
        name="block on two halves",
        block_ids=("base", "block"),
        polygons=(base, block),
        centroid=np.array([[0.5, -0.25], [0.5, 0.25]]),
        weight=np.array([0.0, 1.0]),
        fixed=np.array([True, False]),
        block_a=np.array([0, 0]),
        block_b=np.array([1, 1]),
        end1=end1,
        end2=end2,
        face1=end1,
        face2=end2,
        normal=np.array([[0.0, 1.0], [0.0, 1.0]]),
        friction=np.array(friction),
        dilatancy=np.zeros(2),
        joint=("bed", "bed"),
        dead=np.array([[0.0, 0.0, 0.0], [0.0, -1.0, 0.0]]),
        live=np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
    )


@cache
def load_kernels() -> None:
    """Trace a single block to its collapse with the sparse factor, and call what that leaves out, once in a process."""
    model = build_model(block_on_halves((0.6, 0.4)), GapSettings())
    factor = SparseFactor(model)
    gravity = gravity_state(model, factor)
    first = first_step(model, factor, gravity, 1.0)
    follower = PathFollower.from_rest(model, factor, first)
    follower.run(PathRecord(), 100)
    finish(model, follower.present(), follower.kept)
    rates = np.empty(model.n_points), np.empty(model.n_points)
    kinematics = model.unknown, model.rows, model.interface, model.position
    exact_gap_rates(*kinematics, model.kt, gravity.u, np.zeros(model.n_unknowns), *rates)
    strain_rates(*rates, model.kt, model.lift, gravity.state)
    live_rate(model.live, gravity.u)
    for new in neighbour_states(STICK):
        factor.refactor(np.full(model.n_points, STICK), 1.0)
        change = 0, STICK, new
        factor.foresee([change])
        index, _, b = model.change(*change)
        y = factor.solve_change(change)
        factor.update(y, index, b, 1.0 + float(b @ y[index]))
        factor.solve(model.live)
