"""Equilibrium under the dead load, and what is said where none is found."""

from __future__ import annotations

import numpy as np

from benchmarks.walls import drawn
from methods.springs.model.factor import make_factor
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import build_model
from methods.springs.rest.equilibrium import equilibrium, gravity_state


def test_wall_that_takes_long_to_come_to_rest_is_not_said_to_fall() -> None:
    """160 irregular blocks on springs soft in shear: undecided after few steps, in equilibrium after more."""
    model = build_model(drawn(10, 9, 16), GapSettings(stiffness_ratio=0.002))
    early = equilibrium(model, make_factor(model), np.zeros(model.n_unknowns), 0.0, model.history, 100)
    assert not early.found
    assert not np.any(early.rate)
    assert gravity_state(model, make_factor(model)).found


def test_wall_that_statics_does_not_let_stand_moves_without_end() -> None:
    model = build_model(drawn(3, 9, 16), GapSettings())
    fall = gravity_state(model, make_factor(model))
    assert not fall.found
    assert model.dead @ fall.rate > 0.0
