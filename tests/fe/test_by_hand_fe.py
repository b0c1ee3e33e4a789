"""What the path of gap springs counts and undoes, and a motion on which the live load does no work."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from pydantic import ValidationError

from benchmarks.walls import running_bond
from harness.model.load_steps import STATES
from methods.fe.answers import joint_states
from methods.fe.settings import ConvexSettings, GapSpringsSettings, NewtonSettings
from methods.springs.model.factor import DenseFactor, Factor, SingularTangent, make_factor, refactor_any
from methods.springs.model.gap_law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK
from methods.springs.model.options import SpringOptions
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import WallModel, build_model
from methods.springs.path.continuation import PathFollower
from methods.springs.path.direction import PathDirection
from methods.springs.path.path_record import PathEnd, PathRecord
from methods.springs.path.plateau import PlateauState, check, of_many_mechanisms, solve_last_piece
from methods.springs.rest.equilibrium import gravity_state
from methods.springs.warm_up import block_on_halves
from tests.known_walls import box, of_blocks


def at_rest(model: WallModel, factor: Factor) -> PathFollower:
    """A path from the state under the dead load."""
    return PathFollower.from_rest(model, factor, gravity_state(model, factor))


def test_open_and_slipping_points_of_a_path_are_those_of_its_states() -> None:
    model = build_model(running_bond(4, 2, 0.5), GapSpringsSettings())
    record = PathRecord(most=1000)
    follower = at_rest(model, make_factor(model))
    opened = [int(np.count_nonzero(follower.state == OPEN))]
    assert opened == [follower.n_open]
    assert follower.run(record, 5000) == PathEnd.PLATEAU
    assert follower.n_open == np.count_nonzero(follower.state == OPEN)
    assert follower.n_slip == np.count_nonzero(follower.state >= SLIP_PLUS)
    for step, slipping, n_open in zip(record.steps, record.slipping, record.open, strict=True):
        assert n_open == np.count_nonzero(step.state == OPEN)
        assert slipping == np.count_nonzero(step.state >= SLIP_PLUS)


def test_the_first_limit_of_a_path_is_the_multiplier_from_which_it_first_falls() -> None:
    """55 bricks have a peak before their plateau, on a jagged path."""
    model = build_model(running_bond(10, 5, 0.65), GapSpringsSettings())
    record = PathRecord()
    assert at_rest(model, make_factor(model)).run(record, 5000) == PathEnd.PLATEAU
    path = np.array(record.multiplier)
    highest = np.maximum.accumulate(path)
    falls = int(np.argmax(path < highest * (1.0 - 1e-9)))
    assert falls > 0
    assert record.first_limit == highest[falls]
    assert record.peak == path.max()
    assert path[-1] < record.peak * (1.0 - 1e-4)


def test_a_correction_that_does_not_bring_a_path_nearer_to_equilibrium_is_undone() -> None:
    """Corrections of springs a tenth as stiff go ten times too far."""
    model = build_model(block_on_halves((0.6, 0.4)), GapSpringsSettings())
    follower = at_rest(model, make_factor(model))
    soft = replace(model, kn=0.1 * model.kn, kt=0.1 * model.kt)
    factor = make_factor(soft)
    refactor_any(factor, follower.state, False, [])
    follower.direction.factor = factor
    follower.multiplier += 0.01
    before = [values.copy() for values in (follower.u, follower.opening, follower.trial)]
    with pytest.raises(SingularTangent, match="lost to rounding"):
        follower._remove_drift()
    for values, old in zip((follower.u, follower.opening, follower.trial), before, strict=True):
        np.testing.assert_allclose(values, old, atol=1e-12)


def test_each_further_pin_has_the_response_to_a_unit_force_at_it() -> None:
    """In the pinned wall, the tangent with a spring of stiffness one at each pin."""
    model = build_model(running_bond(4, 2, 0.5), GapSpringsSettings())
    state = np.full(model.n_points, STICK)
    way = PathDirection(model, DenseFactor(model))
    way.solve_anew(state, 100.0)
    way.elastic *= 1e-14  # beside so small a first response every motion counts as soft
    way.solve_anew(state, 100.0)
    assert len(way.bordered) == SpringOptions().pins
    assert [response.border for response in way.unit_responses] == way.bordered[1:]
    pinned = model.tangent(state).toarray()
    pinned[way.bordered, way.bordered] += 1.0
    for response in way.unit_responses:
        force = np.zeros(model.n_unknowns)
        force[response.border] = 1.0
        np.testing.assert_allclose(pinned @ (response.value + response.tail), force, atol=1e-10)


def test_a_wall_that_does_not_move_is_no_collapse_state() -> None:
    """Half a weight at either edge bears the block; without motion no work says which multiplier it is."""
    wall = block_on_halves((0.6, 0.4))
    forces = np.array([[0.5, 0.0, 0.0], [0.0, 0.5, 0.0]])
    state = check(wall, 0.0, forces, np.zeros((2, 3)))
    assert state.residuals["equilibrium"] == pytest.approx(0.0)
    assert state.residuals["work"] == 1.0
    assert state.residuals["complementarity"] == np.inf
    assert state.work_multiplier == np.inf


def test_a_rising_block_is_no_collapse_state_under_a_horizontal_load() -> None:
    """The block rises under a horizontal live load, at any speed."""
    wall = block_on_halves((0.6, 0.4))
    forces = np.array([[0.5, 0.0, 0.0], [0.0, 0.5, 0.0]])
    for speed in (1.0, 3.0):
        state = check(wall, 0.25, forces, np.array([[0.0, 0.0, 0.0], [0.0, speed, 0.0]]))
        # Half a weight presses an end that opens at the speed of the block; nothing closes.
        assert (state.residuals["both"], state.residuals["dilatancy"]) == (0.5, 0.0)
        assert state.residuals["work"] == 1.0
        assert state.residuals["complementarity"] == np.inf
        assert state.work_multiplier == np.inf


def test_a_mechanism_on_which_the_live_load_does_no_work_is_no_collapse_of_a_path() -> None:
    """Two blocks slide side by side at their friction; a live load on neither would not drive them."""
    model = build_model(of_blocks([box("a", 0.0, 0.0), box("b", 4.0, 0.0)]), GapSpringsSettings())
    follower = at_rest(model, make_factor(model))
    assert follower.run(PathRecord(), 5000) == PathEnd.PLATEAU
    assert follower.multiplier == pytest.approx(0.5)
    without_end = 1e20
    assert follower._is_collapse(without_end)
    follower.model = replace(model, live=np.zeros_like(model.live))
    assert not follower._is_collapse(without_end)


@pytest.mark.parametrize("solve", [solve_last_piece, of_many_mechanisms])
def test_a_state_beside_the_plateau_is_brought_to_it(solve: Callable[..., PlateauState]) -> None:
    """Two blocks twice as high as wide topple at .5; springs along joints are .4 times as stiff as across."""
    wall = of_blocks([box("a", 0.0, 0.0, 1.0, 2.0), box("b", 4.0, 0.0, 1.0, 2.0)], 0.9)
    model = build_model(wall, GapSpringsSettings(stiffness_ratio=0.4))
    follower = at_rest(model, make_factor(model))
    assert follower.run(PathRecord(), 5000) == PathEnd.PLATEAU
    opening, slip = model.strains(1e-3 * np.random.default_rng(1).normal(size=model.n_unknowns))
    there = follower.present()
    beside = replace(
        there,
        multiplier=there.multiplier + 0.01,
        opening=there.opening + opening,
        trial=there.trial + model.kt * slip,
    )
    state = solve(model, beside)
    assert state.multiplier == pytest.approx(0.5, abs=1e-12)
    assert state.worst <= 1e-12
    # Toppling about their right corners, which bear the weight and, by friction, the live load.
    pressed, sheared = state.forces[:, :2].max(axis=1), abs(state.forces[:, 2])
    assert pressed == pytest.approx(wall.weight[wall.free])
    assert sheared == pytest.approx(0.5 * wall.weight[wall.free])


@pytest.mark.parametrize(
    ("settings", "least", "refused"),
    [
        (GapSpringsSettings, {"max_events": 1, "load_steps": 0}, {"max_events": 0, "load_steps": -1}),
        (GapSpringsSettings, {"load_steps": 1000, "friction_cap": 1e-9}, {"load_steps": 1001, "friction_cap": 0.0}),
        (NewtonSettings, {"cuts": 0, "displacement_steps": 0}, {"cuts": -1, "displacement_steps": -1}),
        (ConvexSettings, {"fixed_points": 1, "max_blocks": 1}, {"fixed_points": 0, "max_blocks": 0}),
    ],
)
def test_settings_reach_to_their_ends_and_no_further(
    settings: type[GapSettings], least: dict[str, float], refused: dict[str, float]
) -> None:
    assert settings(**least).model_dump(include=set(least)) == least
    for name, value in refused.items():
        with pytest.raises(ValidationError, match=name):
            settings(**{name: value})


def test_states_of_a_joint_are_those_of_its_points() -> None:
    """It rocks where an end is open, opens where all points are, and slips where all that touch do."""
    model = build_model(block_on_halves((0.6, 0.4)), GapSettings(points=4))
    first = np.flatnonzero(model.interface == 0)
    ends = [int(first[model.position[first] == place][0]) for place in (0.0, 1.0)]
    inner = first[(model.position[first] > 0.0) & (model.position[first] < 1.0)]
    assert len(inner) > 0

    def named(others: int, at: object = (), there: int = STICK) -> str:
        state = np.full(model.n_points, STICK)
        state[first] = others
        state[np.array(at, dtype=int)] = there
        names = joint_states(model, state)
        assert STATES[names[1]] == "stick"  # the other joint
        return STATES[names[0]]

    assert [named(state) for state in (STICK, SLIP_PLUS, SLIP_MINUS, OPEN)] == ["stick", "slip", "slip", "open"]
    for end in ends:
        assert named(STICK, end, OPEN) == named(SLIP_PLUS, end, OPEN) == "rock"
        assert named(STICK, end, SLIP_PLUS) == "stick"
    assert named(STICK, inner, OPEN) == "stick"
    assert named(SLIP_PLUS, inner, OPEN) == "slip"
    assert named(OPEN, inner, STICK) == "rock"
