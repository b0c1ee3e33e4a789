"""The direction of the path, judged by the dense tangent."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.walls import running_bond
from harness.model.assembly import FloatArray, IntArray
from methods.fe.settings import GapSpringsSettings
from methods.springs.model.factor import DenseFactor, SparseFactor
from methods.springs.model.gap_law import OPEN, SLIP_PLUS, STICK, neighbour_states
from methods.springs.model.options import SpringOptions
from methods.springs.model.wall_model import WallModel, build_model
from methods.springs.path.direction import PathDirection
from methods.springs.warm_up import block_on_halves

Kind = type[DenseFactor] | type[SparseFactor]
EXTENT = 100.0


@pytest.fixture(scope="module")
def rough() -> WallModel:
    """A wall on whose joints sliding turns the sign of the determinant."""
    return build_model(running_bond(6, 3, 2.0), GapSpringsSettings())


def sticking(model: WallModel) -> IntArray:
    return np.full(model.n_points, STICK)


def defect(model: WallModel, state: IntArray, way: PathDirection) -> float:
    tangent = model.tangent(state).toarray()
    return float(np.abs(tangent @ (way.velocity + way.tail) - way.speed * model.live).max())


def change(way: PathDirection, state: IntArray, point: int, new: int) -> tuple[FloatArray, float]:
    """Turn at a change of state; the gradient b of its breakpoint function in full length, and its rate before."""
    model = way.model
    old = int(state[point])
    index, _, b = model.change(point, old, new)
    gradient = np.zeros(model.n_unknowns)
    np.add.at(gradient, index, b)
    crossing = float(gradient @ way.velocity)
    way.factor.foresee([(point, old, new)])
    state[point] = new
    if not way.update((point, old, new), crossing, state, EXTENT):
        way.solve_anew(state, EXTENT, ((point, old, new), crossing))
    return gradient, crossing


@pytest.mark.parametrize("kind", [DenseFactor, SparseFactor])
@pytest.mark.parametrize(("shrink", "bordered"), [(1.0, 0), (1e-6, 1), (1e-14, SpringOptions().pins)])
@pytest.mark.parametrize("seed", range(4))
def test_each_piece_is_in_equilibrium_and_leads_on_into_the_new_cell(
    rough: WallModel, kind: Kind, shrink: float, bordered: int, seed: int
) -> None:
    state, generator = sticking(rough), np.random.default_rng(seed)
    way = PathDirection(rough, kind(rough))
    way.solve_anew(state, EXTENT)
    way.elastic *= shrink
    way.solve_anew(state, EXTENT)
    assert len(way.bordered) == bordered
    for point in generator.permutation(rough.n_points)[:40]:
        before = way.speed
        gradient, crossing = change(way, state, int(point), neighbour_states(STICK)[int(generator.integers(2))])
        assert defect(rough, state, way) < 1e-9 * np.abs(way.velocity).max()
        assert float(gradient @ way.velocity) * crossing > 0.0
        determinants = [np.linalg.slogdet(rough.tangent(s).toarray())[0] for s in (state, with_sticking(state, point))]
        assert np.sign(way.speed * before) == determinants[0] * determinants[1]


@pytest.mark.parametrize("shrink", [1.0, 1e-6])
def test_a_velocity_whose_sense_was_lost_to_rounding_gets_it_from_the_breakpoint(
    rough: WallModel, shrink: float
) -> None:
    """Where 1 - b'w nearly vanishes rounding may turn the estimate round; the new direction must not follow it."""
    state = sticking(rough)
    way = PathDirection(rough, SparseFactor(rough))
    way.solve_anew(state, EXTENT)
    way.elastic *= shrink
    point, crossed = 3, (3, STICK, SLIP_PLUS)
    gradient, crossing = change(way, state, point, SLIP_PLUS)
    way.velocity, way.speed = -way.velocity, -way.speed
    way.solve_anew(state, EXTENT, (crossed, crossing))
    assert float(gradient @ way.velocity) * crossing > 0.0


def with_sticking(state: IntArray, point: int) -> IntArray:
    other = state.copy()
    other[point] = STICK
    return other


@pytest.mark.parametrize("kind", [DenseFactor, SparseFactor])
def test_where_the_tangent_is_singular_the_velocity_is_its_null_vector(kind: Kind) -> None:
    model = build_model(block_on_halves((0.6, 0.4)), GapSpringsSettings())
    state = sticking(model)
    way = PathDirection(model, kind(model))
    way.solve_anew(state, EXTENT)
    for point in range(model.n_points):
        change(way, state, point, SLIP_PLUS)
    tangent = model.tangent(state).toarray()
    assert np.linalg.matrix_rank(tangent) == len(tangent) - 1
    assert way.bordered
    assert abs(way.speed) < 1e-25
    assert np.abs(tangent @ way.velocity).max() < 1e-14 * np.abs(way.velocity).max()


@pytest.mark.parametrize("kind", [DenseFactor, SparseFactor])
def test_a_motion_without_stiffness_is_pinned_before_a_soft_one(rough: WallModel, kind: Kind) -> None:
    """The brick at the upper right comes loose and slides freely where another motion is pinned already."""
    state = sticking(rough)
    way = PathDirection(rough, kind(rough))
    way.solve_anew(state, EXTENT)
    way.elastic *= 1e-6
    way.solve_anew(state, EXTENT)
    assembly = rough.assembly
    block = int(assembly.free[np.argmax(assembly.centroid[assembly.free].sum(axis=1))])
    own = ((assembly.block_a == block) | (assembly.block_b == block))[rough.interface]
    bed = (np.abs(assembly.normal[:, 1]) > 0.5)[rough.interface]
    state[own & bed], state[own & ~bed] = SLIP_PLUS, OPEN
    way.solve_anew(state, EXTENT)
    speeds = np.abs(rough.block_displacements(way.velocity)).max(axis=1)
    assert np.flatnonzero(speeds > 1e-9 * speeds.max()).tolist() == [block]
    assert abs(way.speed) < 1e-20
