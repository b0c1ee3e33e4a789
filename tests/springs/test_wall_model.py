"""The gap-spring model of a wall against the kinematics and statics that every method shares."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from benchmarks.walls import running_bond
from harness.model.assembly import Assembly, FloatArray
from methods.fe.settings import GapSpringsSettings
from methods.springs.model.exact_rates import add_product, exact_gap_rates
from methods.springs.model.gap_law import OPEN, SLIP_MINUS, SLIP_PLUS, STICK, neighbour_states
from methods.springs.model.points import GapSettings
from methods.springs.model.wall_model import WallModel, build_model, load_scale
from methods.springs.path.path_record import PathRecord, PathStep
from methods.springs.path.plateau import check
from methods.springs.warm_up import block_on_halves
from tests.known_walls import box, of_blocks

SETTINGS: list[dict[str, Any]] = [
    {},
    {"rule": "lobatto", "points": 3, "weighting": "length", "stiffness_ratio": 0.75, "normal_stiffness": 300.0},
]


@pytest.fixture(scope="module", params=SETTINGS, ids=["two points", "three points"])
def model(request: pytest.FixtureRequest) -> WallModel:
    return build_model(running_bond(3, 2, 0.6), GapSettings(**request.param))


def moved(model: WallModel, seed: int = 3) -> FloatArray:
    return np.random.default_rng(seed).normal(size=model.n_unknowns)


def states(model: WallModel) -> Any:
    """All four, in turn."""
    return np.arange(model.n_points) % 4


def test_gaps_are_those_of_the_joints_between_their_ends(model: WallModel) -> None:
    wall, u = model.assembly, moved(model)
    blocks = model.block_displacements(u)
    assert not blocks[wall.fixed].any()
    strains = (wall.kinematic_matrix @ blocks[wall.free].ravel()).reshape(-1, 3) / model.displacement
    ends, x = strains[model.interface], model.position
    opening, slip = model.strains(u)
    np.testing.assert_allclose(opening, (1.0 - x) * ends[:, 0] + x * ends[:, 1], atol=1e-12)
    np.testing.assert_allclose(slip, ends[:, 2], atol=1e-12)
    closed = replace(model, initial_opening=np.full(model.n_points, -0.5))
    np.testing.assert_allclose(closed.strains(u)[0], opening - 0.5, atol=1e-15)


def test_out_of_balance_forces_are_those_of_the_contact_forces_and_loads(model: WallModel) -> None:
    wall, u, state = model.assembly, moved(model), states(model)
    history = np.linspace(-1.0, 1.0, model.n_points)
    contact = model.end_forces(*model.forces(u, history, state))
    balance = (
        wall.kinematic_matrix.T @ contact.ravel() + wall.dead[wall.free].ravel() + 0.5 * wall.live[wall.free].ravel()
    )
    scaled = balance.reshape(-1, 3) / model.force / np.array([1.0, 1.0, model.length])
    place = {int(block): k for k, block in enumerate(model.order)}
    found = model.residual(u, 0.5, history, state).reshape(-1, 3)
    np.testing.assert_allclose(found[[place[int(block)] for block in wall.free]], scaled, atol=1e-12)


def test_forces_of_points_follow_their_stiffness_and_history(model: WallModel) -> None:
    u, history = moved(model), np.linspace(-1.0, 1.0, model.n_points)
    opening, slip = model.strains(u)
    normal, shear = model.forces(u, history, np.full(model.n_points, STICK))
    np.testing.assert_allclose(normal, -model.kn * opening)
    np.testing.assert_allclose(shear, model.kt * slip + history)
    found = model.states(u, history)
    limit = model.mu * normal
    expected = np.where(
        opening > 0.0, OPEN, np.where(abs(shear) <= limit, STICK, np.where(shear >= 0, SLIP_PLUS, SLIP_MINUS))
    )
    assert found.tolist() == expected.tolist()
    assert set(found.tolist()) == {OPEN, STICK, SLIP_PLUS, SLIP_MINUS}


def test_the_tangent_is_what_forces_change_by_in_given_states(model: WallModel) -> None:
    u, step, state, history = moved(model), moved(model, 4), states(model), np.zeros(model.n_points)
    tangent = model.tangent(state)
    change = model.residual(u + step, 0.0, history, state) - model.residual(u, 0.0, history, state)
    np.testing.assert_allclose(tangent @ step, -change, atol=1e-11)
    shifted = model.tangent(state, 0.25, regularised=True) - tangent
    np.testing.assert_allclose(shifted.toarray(), np.diag(0.25 * model.inertia + model.regularised), atol=1e-12)


def test_a_change_of_state_changes_the_tangent_by_its_vectors(model: WallModel) -> None:
    state = states(model)
    changes = [(p, int(state[p]), neighbour_states(int(state[p]))[p % 2]) for p in range(0, model.n_points, 3)]
    columns = np.zeros((model.n_unknowns, len(changes)))
    first = model.add_changes(changes, columns)
    assert first == np.flatnonzero(columns.any(axis=1))[0]
    for column, (point, old, new) in zip(columns.T, changes, strict=True):
        after = state.copy()
        after[point] = new
        index, a, b = model.change(point, old, new)
        left, right = np.zeros(model.n_unknowns), np.zeros(model.n_unknowns)
        np.add.at(left, index, a)
        np.add.at(right, index, b)
        difference = (model.tangent(after) - model.tangent(state)).toarray()
        np.testing.assert_allclose(difference, np.outer(left, right), atol=1e-12)
        np.testing.assert_allclose(column, left)


def test_units_stiffness_and_masses_of_bricks_by_hand() -> None:
    """Bricks .4 x .2 and halves, of weight .08 and .04; a block is as long as the mean root of their areas."""
    wall = running_bond(2, 1, 0.6)
    assert wall.n_free == 3
    length, force = (2.0 * np.sqrt(0.04) + np.sqrt(0.08)) / 3.0, 0.16 / 3.0
    model = build_model(wall, GapSettings(normal_stiffness=50.0))
    assert (model.length, model.force) == (pytest.approx(length), pytest.approx(force))
    assert model.displacement == pytest.approx(force / 50.0)
    assert build_model(wall, GapSettings()).displacement == pytest.approx(length / 1000.0)
    assert model.kn.tolist() == [1.0] * model.n_points
    assert model.kt.tolist() == [0.5] * model.n_points
    by_length = build_model(wall, GapSettings(weighting="length", points=4))
    assert np.bincount(by_length.interface, by_length.kn) == pytest.approx(wall.length / length)
    assert build_model(wall, GapSettings(), friction_cap=0.25).mu.tolist() == [0.25] * model.n_points
    inertia, regularised = model.inertia.reshape(-1, 3), model.regularised.reshape(-1, 3)
    for block, masses, springs in zip(model.order, inertia, regularised, strict=True):
        width, height = np.ptp(wall.polygons[block], axis=0)
        mass, turning = wall.weight[block] / force, (width**2 + height**2) / 12.0 / length**2
        assert masses == pytest.approx([mass, mass, mass * turning])
        assert springs / springs[0] == pytest.approx([1.0, 1.0, turning])
    assert load_scale(model, -3.0) == pytest.approx(4.0 * 0.08 / force)
    assert load_scale(replace(model, dead=0.0 * model.dead), 0.0) == 1.0


def test_blocks_move_that_are_not_much_slower_than_the_fastest(model: WallModel) -> None:
    names = model.assembly.block_ids
    motion = np.zeros((len(names), 3))
    motion[1], motion[2], motion[3] = [0.0, 1.0, 0.0], [0.0, 0.0, 1.1e-6 / model.length], [0.9e-6, 0.0, 0.0]
    assert model.moving_blocks(motion) == [names[1], names[2]]
    assert model.moving_blocks(0.0 * motion) == []


def test_a_wall_whose_blocks_are_all_fixed_has_no_model() -> None:
    wall = block_on_halves((0.5, 0.5))
    with pytest.raises(ValueError, match="no block that can move"):
        build_model(replace(wall, fixed=np.array([True, True])), GapSettings())


def test_sums_of_products_keep_what_rounding_takes() -> None:
    high, low, exact = 0.0, 0.0, Fraction(0)
    for a, b in np.random.default_rng(7).normal(size=(40, 2)) * 10.0 ** np.arange(40)[:, None]:
        high, low = add_product(high, low, float(a), float(b))
        exact += Fraction(float(a)) * Fraction(float(b))
    assert high == pytest.approx(float(exact), rel=1e-15)
    assert abs(Fraction(high) + Fraction(low) - exact) <= abs(exact) / 2**96


def test_gap_rates_of_a_wall_that_moves_almost_freely_are_exact(model: WallModel) -> None:
    """As one body the wall moves 1e12 times as far as its joints open."""
    u = moved(model)
    free = np.tile([1e12, -3e12, 0.0], model.n_unknowns // 3)
    tail = 1e-4 * moved(model, 5)
    velocity = free + u
    opening, trial = np.empty(model.n_points), np.empty(model.n_points)
    exact_gap_rates(
        model.unknown, model.rows, model.interface, model.position, model.kt, velocity, tail, opening, trial
    )
    whole = [Fraction(float(v)) + Fraction(float(t)) for v, t in zip(velocity, tail, strict=True)]
    for p, (k, x) in enumerate(zip(model.interface, model.position, strict=True)):
        e0, e1, e2 = (
            float(sum(Fraction(float(c)) * whole[d] for c, d in zip(row, model.unknown[k], strict=True)))
            for row in model.rows[k]
        )
        assert opening[p] == pytest.approx((1.0 - x) * e0 + x * e1, rel=1e-13, abs=1e-13)
        assert trial[p] == pytest.approx(model.kt[p] * e2, rel=1e-13, abs=1e-13)


def pushed() -> tuple[Assembly, FloatArray, FloatArray]:
    """A block of 2 x 2 and weight 10, pushed at its middle: it slides at .5, bearing 2.5 and 7.5 at its corners."""
    wall = of_blocks([box("a", 0.0, 0.0, 2.0, 2.0, weight=10.0)], 0.5)
    assert [wall.block_ids[k] for k in (wall.block_a[0], wall.block_b[0])] == ["g", "a"]
    left_first = wall.end1[0, 0] < wall.end2[0, 0]
    ends = [2.5, 7.5] if left_first else [7.5, 2.5]
    shear = -5.0 if wall.tangent[0, 0] > 0.0 else 5.0  # of the ground on the block, against its slip
    return wall, np.array([[*ends, shear]]), np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])


def test_a_collapse_state_has_no_residual_and_its_work_is_its_multiplier() -> None:
    wall, forces, motion = pushed()
    for size in (1.0, 1e-6, 1e6):
        state = check(wall, 0.5, forces, size * motion)
        assert max(state.residuals.values()) <= 1e-15
        assert (state.multiplier, state.work_multiplier) == (0.5, pytest.approx(0.5))


@pytest.mark.parametrize(
    ("force", "velocity", "expected"),
    [
        ([0.5, 0.5, 0.0], [1, 0, 0], {"equilibrium": 0.1, "yield": 0.0, "both": 0.05, "work": 0.05}),
        ([0.0, 0.0, 2.0], [1, 0, 0], {"yield": 0.2, "equilibrium": 0.2}),
        ([-3.5, 3.5, 0.0], [1, 0, 0], {"yield": 0.1, "equilibrium": 0.35}),
        ([0.0, 0.0, 0.0], [1, -0.25, 0], {"dilatancy": 0.25, "complementarity": 0.25, "work": 0.25}),
        ([0.0, 0.0, 0.0], [1, 0.25, 0], {"dilatancy": 0.0, "both": 0.25, "complementarity": 0.25, "work": 0.25}),
        ([0.0, 0.0, 0.0], [-1, 0, 0], {"complementarity": np.inf, "work": 1.0}),
        ([0.0, 0.0, 0.0], [0, 0, 0], {"complementarity": np.inf, "work": 1.0, "dilatancy": 0.0}),
    ],
)
def test_residuals_of_a_false_collapse_state_by_hand(force: Any, velocity: Any, expected: dict[str, float]) -> None:
    """Forces change by `force`, at the left and the right corner and along the friction; ten is one weight."""
    wall, forces, motion = pushed()
    left, right, along = force
    ends = [left, right] if wall.end1[0, 0] < wall.end2[0, 0] else [right, left]
    change = np.array([[*ends, along * np.sign(forces[0, 2])]])
    motion[1] = velocity
    found = check(wall, 0.5, forces + change, motion).residuals
    assert {name: found[name] for name in expected} == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(("most", "kept"), [(0, []), (1, [0, 8]), (2, [0, 4, 8]), (20, [*range(11)])])
def test_points_of_a_path_are_kept_whole_evenly_and_no_more_than_asked_for(most: int, kept: list[int]) -> None:
    record, none = PathRecord(most=most), np.zeros(0)
    for number in range(11):
        record.keep(lambda number=number: PathStep(number, none, none, none, none))  # type: ignore[misc]
    assert [step.multiplier for step in record.steps] == kept
    record.keep(lambda: PathStep(11, none, none, none, none), always=True)
    assert [step.multiplier for step in record.steps][-1:] == ([11] if most else [])


def test_settings_of_the_continuation_have_those_of_the_springs() -> None:
    assert set(GapSettings.model_fields) <= set(GapSpringsSettings.model_fields)
