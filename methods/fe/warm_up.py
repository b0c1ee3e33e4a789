"""Load the compiled kernels when the methods are imported, so that the first wall does not pay for it."""

from __future__ import annotations

import numpy as np

from methods.fe.commits import change_states
from methods.fe.histories import gravity_state, trace_history
from methods.fe.patterns import block_on_halves
from methods.fe.settings import GapSpringsSettings
from methods.springs.exact_rates import exact_gap_rates
from methods.springs.factor import SparseFactor
from methods.springs.gap_law import STICK, neighbour_states
from methods.springs.kinks import live_rate, strain_rates
from methods.springs.wall_model import build_model


def load_kernels() -> None:
    """Trace a single block to its collapse with the sparse factor, and call what that leaves out."""
    model = build_model(block_on_halves((0.6, 0.4)), GapSpringsSettings())
    factor = SparseFactor(model)
    gravity = gravity_state(model, factor)
    trace_history(model, factor, gravity, 0.0, 1.0, 100)
    rates = np.empty(model.n_points), np.empty(model.n_points)
    kinematics = model.unknown, model.rows, model.interface, model.position
    exact_gap_rates(*kinematics, model.kt, gravity.u, np.zeros(model.n_unknowns), *rates)
    strain_rates(*rates, model.kt, gravity.state)
    live_rate(model.live, gravity.u)
    for new in neighbour_states(STICK):
        state = np.full(model.n_points, STICK)
        factor.refactor(state, 1.0)
        wanted = state.copy()
        wanted[0] = new
        change_states(model, factor, state, wanted)
        factor.solve(model.live)
