"""Solves with the tangent, judged by the tangent itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.walls import running_bond
from methods.fe.settings import GapSpringsSettings
from methods.springs.model.factor import DenseFactor, Factor, SingularTangent, SparseFactor, refactor_any
from methods.springs.model.gap_law import OPEN, STICK, neighbour_states
from methods.springs.model.options import SpringOptions
from methods.springs.model.wall_model import WallModel, build_model


@pytest.fixture(scope="module")
def model() -> WallModel:
    return build_model(running_bond(6, 3, 0.6), GapSpringsSettings())


@pytest.fixture(params=[DenseFactor, SparseFactor])
def factor(request: pytest.FixtureRequest, model: WallModel) -> Factor:
    made: Factor = request.param(model)
    return made


def sliding_states(model: WallModel, seed: int, share: float = 0.2) -> np.ndarray:
    """States of which a share slides: the tangent is unsymmetric and, for the seeds used here, regular."""
    rng = np.random.default_rng(seed)
    state = np.full(model.n_points, STICK)
    slides = rng.random(model.n_points) < share
    state[slides] = rng.choice(neighbour_states(STICK), int(slides.sum()))
    return state


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("shift", [0.0, 0.3])
@pytest.mark.parametrize("careful", [False, True])
@pytest.mark.parametrize("bordered", [(), (4,)])
def test_a_fresh_factor_solves_with_the_tangent(
    model: WallModel, factor: Factor, seed: int, shift: float, careful: bool, bordered: tuple[int, ...]
) -> None:
    state = sliding_states(model, seed)
    right = np.random.default_rng(seed + 100).normal(size=model.n_unknowns)
    factor.refactor(state, shift, careful, bordered)
    x = factor.solve(right)
    tangent = model.tangent(state, shift).toarray()
    for border in bordered:
        tangent[border, border] += 1.0
    assert np.abs(tangent @ x - right).max() < 1e-11 * max(1.0, np.abs(x).max())


def test_changes_of_state_follow_by_updates(model: WallModel, factor: Factor) -> None:
    state = sliding_states(model, 2)
    factor.refactor(state)
    for point in range(0, model.n_points, 3):
        new = neighbour_states(int(state[point]))[0]
        change = point, int(state[point]), new
        index, _, b = model.change(*change)
        factor.foresee([change])
        y = factor.solve_change(change)
        denominator = 1.0 + float(b @ y[index])
        if abs(denominator) < 1e-3:
            continue
        factor.update(y, index, b, denominator)
        state[point] = new
    x = factor.solve(model.live)
    assert np.abs(model.tangent(state) @ x - model.live).max() < 1e-9 * max(1.0, np.abs(x).max())


def test_rows_are_exchanged_where_block_pivots_are_not_trusted(model: WallModel) -> None:
    model = replace(model, options=SpringOptions(growth=0.0))
    factor, state = SparseFactor(model), sliding_states(model, 3)
    factor.refactor(state, 0.1)
    assert factor._exchanged is not None
    tangent = model.tangent(state, 0.1)
    np.testing.assert_allclose(tangent @ factor.solve(model.live), model.live, atol=1e-10)


def test_a_wall_in_the_air_has_no_inverse(model: WallModel, factor: Factor) -> None:
    with pytest.raises(SingularTangent):
        _solve_with_all_open(model, factor)


def _solve_with_all_open(model: WallModel, factor: Factor) -> None:
    factor.refactor(np.full(model.n_points, OPEN))
    factor.solve(model.live)


def test_a_loose_brick_stays_on_its_footing_and_the_others_bear_the_load(model: WallModel, factor: Factor) -> None:
    """The tangent is singular whatever rounding makes of the pivots that should be zero."""
    loose = model.assembly.n_blocks - 1
    assert model.order.tolist().count(loose) == 1
    own = (model.assembly.block_a == loose) | (model.assembly.block_b == loose)
    state = np.where(own[model.interface], OPEN, STICK)
    with pytest.raises(SingularTangent):
        factor.refactor(state)
    refactor_any(factor, state)
    assert factor.is_regularised
    unloaded = model.live.copy()
    place = 3 * model.order.tolist().index(loose)
    unloaded[place : place + 3] = 0.0
    x, tangent = np.zeros_like(unloaded), model.tangent(state)
    for _ in range(3):
        x += factor.solve(unloaded - tangent @ x)
    assert not x[place : place + 3].any()
    # One solve would miss the loads by the share of the regularisation, 1e-8.
    assert np.abs(tangent @ x - unloaded).max() < 1e-13 * max(1.0, np.abs(x).max())


def test_changes_that_were_foreseen_are_solved_for_like_any_other(model: WallModel, factor: Factor) -> None:
    state = sliding_states(model, 1)
    factor.refactor(state)
    changes = [(p, int(state[p]), neighbour_states(int(state[p]))[0]) for p in range(0, model.n_points, 5)][:5]
    factor.foresee(changes)
    for change in changes:
        assert factor.foresees(change)
        index, a, b = model.change(*change)
        right = np.zeros(model.n_unknowns)
        np.add.at(right, index, a)
        y = factor.solve(right)
        np.testing.assert_allclose(factor.solve_change(change), y, rtol=1e-11, atol=1e-12)
        factor.update(y, index, b, 1.0 + float(b @ y[index]))
