"""`fe` on walls whose joints have cohesion and tensile strength, held by the judge.

Closed forms and associated values as in `tests/la/test_strength.py`; a path without dilatancy ends at or below the
associated maximum and, in these walls, above the value without strength.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import answered
from harness.model.assembly import Assembly
from harness.model.load_steps import STATES
from harness.model.method import Finding
from harness.model.method_registry import load_method
from harness.model.result import Result, residual_of
from methods.fe.answers import joint_states
from methods.fe.settings import GapSpringsSettings
from methods.springs.model.gap_law import OPEN, SLIP_PLUS, STICK
from methods.springs.model.wall_model import WallModel, build_model
from tests.bonded_walls import ASSOCIATED, BOND, PRINTED, bonded
from tests.walls import assembly, running_bond, stack

ROUND_OFF = 1e-9


def found(wall: Assembly, name: str = "fe", **settings: Any) -> Result:
    """The answer of a method, which the judge accepts."""
    result, judgement = answered(load_method(name), wall, **settings)
    assert judgement.accepted, judgement.sentence
    return result


@pytest.mark.parametrize("name", ["fe", "fe-newton"])
@pytest.mark.parametrize(
    ("width", "height", "friction", "cohesion", "tension", "value"),
    [
        (1.0, 0.2, 0.5, 1.0, 0.0, 0.75),
        (1.0, 0.2, 0.0, 1.0, 0.0, 0.25),
        (1.0, 0.2, 1e-300, 1.0, 0.0, 0.25),
        (0.4, 2.0, 1.0, 8.0, 4.0, 0.22),
        (0.4, 2.0, 1.0, 4.0, 4.0, 0.22),
    ],
)
def test_one_block(
    name: str, width: float, height: float, friction: float, cohesion: float, tension: float, value: float
):
    """It slides at mu + c A / W or topples at (b / h)(1 + T / W), also where no cohesion is left beside the tension."""
    wall = assembly(stack(1, width, height), friction, cohesion=cohesion, tensile_strength=tension)
    assert found(wall, name).multiplier == pytest.approx(value, rel=ROUND_OFF)


@pytest.mark.parametrize("settings", [{}, {"points": 5}, {"rule": "lobatto", "points": 4}])
def test_ends_of_a_joint_may_bear_unequal_tension(settings: dict[str, Any]):
    """A block topples to the right where the left end has reached its tension t: (b / h)(1 + 2 t / W)."""
    wall = assembly(stack(1, 0.4, 2.0), 1.0, cohesion=8.0)
    for tension in ([3.0, 1.0], [1.0, 3.0], [0.0, 2.0]):
        constant = wall.constant.copy()
        constant[0, :2] = tension
        uneven = replace(wall, constant=constant)
        left = tension[0] if wall.end1[0, 0] < wall.end2[0, 0] else tension[1]
        assert found(uneven, "fe", **settings).multiplier == pytest.approx(0.2 * (1.0 + left / 8.0), rel=ROUND_OFF)


@pytest.mark.parametrize(
    "settings",
    [{"points": 5}, {"rule": "lobatto", "points": 4}, {"stiffness_ratio": 0.05}, {"normal_stiffness": 7.0}],
)
def test_neither_gap_points_nor_stiffness_move_the_limit_of_a_block(settings: dict[str, Any]):
    slides = assembly(stack(1, 1.0, 0.2), 0.5, cohesion=1.5, tensile_strength=1.0)
    topples = assembly(stack(1, 0.4, 2.0), 1.0, cohesion=8.0, tensile_strength=4.0)
    assert found(slides, **settings).multiplier == pytest.approx(0.875, rel=ROUND_OFF)
    assert found(topples, **settings).multiplier == pytest.approx(0.22, rel=ROUND_OFF)


@pytest.mark.parametrize(("cohesion", "tension", "associated"), ASSOCIATED[1:])
def test_wall_of_21_bricks_lies_between_residual_and_associated(cohesion: float, tension: float, associated: float):
    result = found(bonded(cohesion, tension))
    residual = residual_of(result)
    assert residual is not None
    assert residual.multiplier is not None
    assert result.multiplier is not None
    assert residual.multiplier == found(assembly(BOND, 0.65, unit_weight=1.0)).multiplier
    assert residual.multiplier < result.multiplier <= associated * (1.0 + PRINTED)


@pytest.mark.parametrize(("cohesion", "tension", "value"), ASSOCIATED)
def test_wall_of_21_bricks_that_lifts_by_its_friction(cohesion: float, tension: float, value: float):
    assert found(bonded(cohesion, tension, 0.65)).multiplier == pytest.approx(value, rel=PRINTED)


def test_base_that_slides_as_a_whole_bears_its_cohesion():
    """Nine weights on a base of three areas: mu + 3 c / 9, which every flow rule shares."""
    result = found(assembly(BOND, 0.65, unit_weight=1.0, cohesion=0.25))
    assert result.multiplier == pytest.approx(0.65 + 0.75 / 9.0, rel=ROUND_OFF)


@pytest.mark.parametrize("seed", range(6))
def test_random_strength_is_never_above_the_associated_maximum(seed: int):
    generator = np.random.default_rng(seed)
    friction = float(generator.uniform(0.3, 0.9))
    cohesion = float(generator.uniform(0.0, 2.0))
    tension = float(generator.uniform(0.0, 1.0)) * cohesion / friction
    wall = assembly(running_bond(3, 2), friction, cohesion=cohesion, tensile_strength=tension)
    greatest = found(wall, "la-associated").multiplier
    multiplier = found(wall).multiplier
    assert multiplier is not None
    assert greatest is not None
    assert multiplier <= greatest * (1.0 + 1e-8)


@pytest.mark.parametrize("name", ["fe", "fe-newton", "fe-qp"])
def test_block_glued_below_another_hangs_by_its_tensile_strength(name: str):
    """Weight W = 4 on T = f_t A = 6: it bears half its weight more, and falls without strength."""
    panel = {"type": "panel", "cell_length": 1.0, "cell_height": 0.2, "layout": ["L", "B"], "fixed": "L"}
    loads = {"live": {"body": [{"per_weight": [0, -1]}]}}
    wall = assembly(panel, 0.5, cohesion=10.0, tensile_strength=6.0, loads=loads)
    result, judgement = answered(load_method(name), wall)
    assert judgement.accepted is not False, judgement.sentence
    width = 2e-3 if name == "fe-qp" else ROUND_OFF  # its bracket is narrowed to a thousandth
    assert result.multiplier == pytest.approx(0.5, rel=width)
    residual = residual_of(result)
    assert residual is not None
    assert residual.finding is Finding.FALLS


def test_load_that_friction_bears_at_any_size_stays_unbounded():
    loads = {"live": {"body": [{"per_weight": [0, -1]}]}}
    assert found(assembly(stack(1, 1.0, 0.2), 0.5, cohesion=1.0, loads=loads)).finding is Finding.UNBOUNDED


def test_joint_slips_only_when_its_cohesion_does_too():
    model: WallModel = build_model(assembly(stack(1, 1.0, 0.2), 0.5, cohesion=1.0), GapSpringsSettings())
    assert model.n_contacts == 2
    assert model.n_points == 3
    names = [
        STATES[int(joint_states(model, np.array(state))[0])]
        for state in (
            [STICK, STICK, STICK],
            [SLIP_PLUS, SLIP_PLUS, STICK],
            [SLIP_PLUS, SLIP_PLUS, SLIP_PLUS],
            [STICK, OPEN, SLIP_PLUS],
            [OPEN, OPEN, STICK],
        )
    ]
    assert names == ["stick", "stick", "slip", "rock", "open"]


def test_springs_of_an_unloaded_bonded_joint_bear_nothing_before_it_moves():
    """The clamping is taken by springs that it has compressed before: no force, no out-of-balance force."""
    model = build_model(assembly(stack(2, 0.4, 2.0), 1.0, cohesion=8.0, tensile_strength=4.0), GapSpringsSettings())
    u, state = np.zeros(model.n_unknowns), np.full(model.n_points, STICK)
    forces = model.end_forces(*model.forces(u, model.history, state))
    assert abs(forces).max() < 1e-12 * model.force
    dead = model.assembly.dead[model.order] * np.array([1.0, 1.0, 1.0 / model.length]) / model.force
    assert model.residual(u, 0.0, model.history, state) == pytest.approx(dead.ravel(), abs=1e-12)
