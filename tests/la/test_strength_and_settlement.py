"""Joints with cohesion and tensile strength, and supports that move, in the associated programme.

Values without a remark are closed forms; those of the wall of 21 bricks are by linear programmes of other code.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.engine.symmetry import VIEWS
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.components import components_of
from harness.model.errors import InputError
from harness.model.method import Answer, Method
from harness.model.method_registry import check_takes, load_method, method_names, methods_with
from harness.model.wall import Wall
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import make_problem
from methods.la.core.programmes import StaticProgramme, StaticSolution
from methods.la.core.reaction import ExtremeReaction, extreme_reaction
from methods.la.interior.associated import solve_associated, solve_with_cvxpy
from tests.bonded_walls import ASSOCIATED, BOND, PRINTED
from tests.walls import assembly, beside, stack, wall_data

EXACT = 1e-9
"""Relative accuracy of a multiplier of the associated programme, as its method declares."""


def with_strength(wall: Assembly, cohesion: float, tension: float = 0.0) -> Assembly:
    """The wall with these strengths [force / length^2] in all its joints of thickness one."""
    parts = np.array([tension / 2.0, tension / 2.0, cohesion, cohesion])
    return replace(wall, constant=wall.length[:, None] * parts)


def greatest(wall: Assembly, solver: str = "highs") -> float:
    """The associated maximum, proved by its own mechanism."""
    problem = make_problem(wall)
    found = solve_associated(problem, NewtonMatrix(problem), solver)
    assert found.state is not None
    assert found.gap <= EXACT
    return problem.to_multiplier(found.state.multiplier)


def single(width: float, height: float, friction: float) -> Assembly:
    """A block of unit weight 20 on a base, pushed by its own weight."""
    return assembly(stack(1, width, height), friction)


BLOCKS = [
    pytest.param(single(1.0, 0.2, 0.5), 1.0, 0.0, 0.75, id="slides"),
    pytest.param(single(0.4, 2.0, 1.0), 8.0, 4.0, 0.22, id="topples"),
]


@pytest.mark.parametrize("solver", ["highs", "interior"])
@pytest.mark.parametrize(("wall", "cohesion", "tension", "value"), BLOCKS)
def test_block_with_strength(wall: Assembly, cohesion: float, tension: float, value: float, solver: str):
    """It slides at mu + c A / W and topples at (b/h) (1 + T/W)."""
    assert greatest(with_strength(wall, cohesion, tension), solver) == pytest.approx(value, rel=EXACT)


@pytest.mark.parametrize(("cohesion", "tension", "value"), ASSOCIATED)
@pytest.mark.parametrize("solver", ["highs", "interior"])
def test_wall_of_21_bricks_with_strength(cohesion: float, tension: float, value: float, solver: str):
    wall = assembly(BOND, 0.65, unit_weight=1.0)
    assert greatest(with_strength(wall, cohesion, tension), solver) == pytest.approx(value, rel=PRINTED)


def test_programme_written_for_reading_agrees():
    wall = with_strength(assembly(BOND, 0.65, unit_weight=1.0), 0.05, 0.025)
    problem = make_problem(wall)
    outcome, _, multiplier = solve_with_cvxpy(problem, "CLARABEL")
    assert outcome == "optimal"
    assert problem.to_multiplier(multiplier) == pytest.approx(greatest(wall), rel=1e-6)  # of CLARABEL


def test_programme_over_slacks_agrees():
    wall = with_strength(assembly(BOND, 0.65, unit_weight=1.0), 0.05, 0.025)
    problem = make_problem(wall)
    found = StaticProgramme(problem).solve(greatest=True)
    assert isinstance(found, StaticSolution)
    assert problem.to_multiplier(found.multiplier) == pytest.approx(greatest(wall), rel=1e-8)  # of HiGHS
    assert problem.slacks(found.forces).min() >= -1e-8
    assert abs(problem.imbalance(found.forces, found.multiplier)).max() <= 1e-8


def test_strength_does_not_bound_a_load_that_friction_bears_alone():
    """A live load straight down can be multiplied for ever, whatever the joints can bear besides."""
    wall = single(1.0, 0.2, 0.5)
    wall = with_strength(replace(wall, live=wall.dead), 1.0, 1.0)
    problem = make_problem(wall)
    assert solve_associated(problem, NewtonMatrix(problem), "highs").outcome == "unbounded"


def test_strength_bounds_a_load_that_only_it_bears():
    """Lifted by its own weight, the block of weight 4 leaves its base at 1 + T/W, T = 2."""
    wall = single(1.0, 0.2, 0.5)
    assert greatest(with_strength(replace(wall, live=-wall.dead), 1.0, 2.0)) == pytest.approx(1.5, rel=EXACT)


def on_split_ground(wall: dict[str, Any], at: float) -> Assembly:
    """The wall on a base in two parts, of which the one beyond x = `at` gives way downwards by one."""
    explicit = build(Wall.model_validate(wall)).explicit().model_dump(exclude_none=True)
    (ground,) = (block for block in explicit["blocks"] if block.get("fixed"))
    x, y = np.array(ground["polygon"]).T
    halves = [
        ground | {"id": name, "polygon": [[a, y.min()], [b, y.min()], [b, y.max()], [a, y.max()]]}
        for name, a, b in (("left", x.min(), at), ("right", at, x.max()))
    ]
    explicit["blocks"] = halves + [block for block in explicit["blocks"] if block is not ground]
    explicit.pop("interfaces")
    built = build(Wall.model_validate(explicit | {"friction": wall["friction"]})).assembly
    motion = np.zeros((built.n_blocks, 3))
    motion[built.block_ids.index("right"), 1] = -1.0
    return replace(built, support_motion=motion)


def reactions(wall: Assembly) -> tuple[float, float]:
    """The least and the greatest reaction, each proved by a mechanism of associated flow and virtual work."""
    found = []
    for most in (False, True):
        answer = extreme_reaction(wall, most)
        assert isinstance(answer, ExtremeReaction)
        law, motion = wall.law.associated, answer.mechanism
        sense = -1.0 if most else 1.0
        strains = (wall.kinematic_matrix @ motion[wall.free].ravel()).reshape(-1, 3) + sense * wall.support_strains
        lift = law.friction * abs(strains[:, 2])
        openings = strains[:, :2] - lift[:, None]
        assert openings.min() >= -EXACT
        slips = np.maximum(strains[:, 2:] * [1.0, -1.0], 0.0)
        work = float((wall.dead * motion).sum()) - law.dissipation(np.column_stack([openings, slips]))
        assert sense * work == pytest.approx(answer.reaction, rel=EXACT)
        assert law.slacks(answer.forces).min() >= -EXACT * wall.force_scale
        balance = wall.kinematic_matrix.T @ answer.forces.ravel() + wall.dead[wall.free].ravel()
        assert abs(balance).max() <= EXACT * wall.force_scale
        found.append(answer.reaction)
    return found[0], found[1]


@pytest.mark.parametrize("at", [0.1, 0.3, 0.45, 0.6, 0.8])
def test_block_on_a_base_that_settles(at: float):
    """Width 1 on [0, a] that rests and [a, 1] that settles: W (1/2 - a)/(1 - a) to W, from a = 1/2 on 0 to W/(2a)."""
    wall = on_split_ground(wall_data(stack(1, 1.0, 0.2), 0.5), at)
    values = (max((0.5 - at) / (1.0 - at), 0.0), min(1.0, 0.5 / at))
    assert np.array(reactions(wall)) / 4.0 == pytest.approx(np.array(values), abs=EXACT)


def test_tensile_strength_widens_the_reactions_of_a_base_that_settles():
    """Half of T a and of T (1 - a) can be drawn at either end of the parts.

    Equilibrium of the two ends of each part gives W/2 - T (1 - a)/2 - a (W + T a)/(2 (1 - a)) and W + T a.
    """
    at, tension, weight = 0.3, 1.0, 4.0
    wall = with_strength(on_split_ground(wall_data(stack(1, 1.0, 0.2), 2.0), at), 10.0, tension)
    resting, moving = tension * at, tension * (1.0 - at)
    least = 0.5 * (weight - moving - at * (weight + resting) / (1.0 - at))
    assert reactions(wall) == pytest.approx((least, weight + resting), rel=EXACT)


@pytest.mark.parametrize(
    ("friction", "least", "most"),
    [(0.4, 1.2931034, 7.7068966), (0.65, 1.0544815, 7.9455185), (1.0, 0.75, 8.25)],
)
def test_wall_of_21_bricks_on_a_base_that_settles(friction: float, least: float, most: float):
    wall = on_split_ground(wall_data(BOND, friction, unit_weight=1.0), 1.5)
    assert wall.n_free == 21
    assert reactions(wall) == pytest.approx((least, most), rel=PRINTED)


def spreading_arch(thickness: float, count: int, friction: float) -> Assembly:
    """A semicircular arch of centreline radius one, whose right abutment gives way outwards by one."""
    ring = {"type": "ring", "inner_radius": 1.0 - thickness / 2, "outer_radius": 1.0 + thickness / 2, "count": count}
    wall = assembly(ring, friction, unit_weight=1.0)
    motion = np.zeros((wall.n_blocks, 3))
    motion[np.flatnonzero(wall.fixed)[wall.centroid[wall.fixed, 0].argmax()], 0] = 1.0
    return replace(wall, support_motion=motion)


ROUGH = 20.0
"""Friction at which no voussoir slides."""


@pytest.mark.parametrize(
    ("thickness", "count", "friction", "least", "most"),
    [
        (0.12, 20, ROUGH, 0.1912256, 0.2079935),
        (0.15, 20, ROUGH, 0.1756349, 0.2277179),
        (0.2, 20, ROUGH, 0.1542448, 0.2553107),
        (0.2, 100, 0.4, 0.1540326, 0.2),
        (0.2, 100, 0.5, 0.1540326, 0.25),
        (0.2, 100, 0.7, 0.1540326, 0.2545831),
    ],
)
def test_thrust_of_an_arch_whose_abutments_move(
    thickness: float, count: int, friction: float, least: float, most: float
):
    """The least and greatest thrust over the weight; where the springings slide the greatest is mu/2."""
    wall = spreading_arch(thickness, count, friction)
    thrust = np.array(reactions(wall)) / float(wall.weight[wall.free].sum())
    np.testing.assert_allclose(thrust, (least, most), rtol=5e-7)  # of values that are known to seven decimals


def test_arch_that_no_thrust_holds_has_no_reaction():
    assert extreme_reaction(spreading_arch(0.2, 100, 0.3), greatest=False) == "infeasible"


@pytest.mark.parametrize("view", sorted(VIEWS))
def test_views_of_a_wall_keep_strength_and_motion(view: str):
    wall = with_strength(on_split_ground(wall_data(BOND, 0.65, unit_weight=1.0), 1.5), 0.05, 0.025)
    seen = VIEWS[view](wall)
    force, length = seen.force_scale / wall.force_scale, seen.length_scale / wall.length_scale
    assert greatest(seen) == pytest.approx(greatest(wall), rel=EXACT)
    np.testing.assert_allclose(reactions(seen), np.array(reactions(wall)) * force * length, rtol=EXACT)


def test_supports_at_rest_have_no_reaction_to_find():
    with pytest.raises(ValueError, match="no support with a joint, a tie or a prop moves"):
        extreme_reaction(single(1.0, 0.2, 0.5), greatest=False)


def test_only_fixed_blocks_are_moved():
    wall = single(1.0, 0.2, 0.5)
    with pytest.raises(ValueError, match="support_motion moves a block that is not fixed"):
        replace(wall, support_motion=np.ones((wall.n_blocks, 3)))


@pytest.mark.parametrize("name", method_names())
def test_methods_take_or_refuse_strength_and_refuse_moving_supports(name: str):
    wall, method = single(1.0, 0.2, 0.5), load_method(name)
    check_takes(method, wall)
    if method.traits.any_strength:
        check_takes(method, with_strength(wall, 1.0))
    else:
        with pytest.raises(InputError, match=f"{name} takes dry joints only.*fe-qp, la, la-associated"):
            check_takes(method, with_strength(wall, 1.0))
    with pytest.raises(InputError, match=f"{name} takes supports at rest only; .* moves"):
        check_takes(method, replace(wall, support_motion=np.where(wall.fixed[:, None], [0.0, -1.0, 0.0], 0.0)))


def test_a_method_that_says_nothing_of_strength_refuses_it():
    class Stranger(Method):
        name, family, title, tolerance = "stranger", "own", "A stranger", 1e-6

        def solve(self, assembly: Assembly, settings: Any) -> Answer:
            raise NotImplementedError

    with pytest.raises(InputError, match="stranger takes dry joints only"):
        check_takes(Stranger(), with_strength(single(1.0, 0.2, 0.5), 1.0))
    assert methods_with("any_strength") == [
        "de",
        "fe",
        "fe-newton",
        "fe-qp",
        "la",
        "la-associated",
        "la-associated-cvxpy",
    ]


def test_components_of_a_wall_keep_strength_and_motion():
    wall = with_strength(on_split_ground(wall_data(BOND, 0.65, unit_weight=1.0), 1.5), 0.05, 0.025)
    first, second = components_of(beside(wall, 0.5))
    np.testing.assert_array_equal(first.assembly.constant, wall.constant)
    np.testing.assert_array_equal(first.assembly.support_motion, wall.support_motion)
    assert not second.assembly.constant.any()
    assert not second.assembly.support_motion.any()
