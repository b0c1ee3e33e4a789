"""Incremental Newton and the convex steps beside the exact continuation."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.sensitivity import main
from benchmarks.walls import running_bond
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method import Finding, Status
from harness.model.wall import Wall
from methods.fe.gap_springs import ConvexSteps, GapSprings, IncrementalNewton
from methods.fe.settings import ConvexSettings, GapSpringsSettings, NewtonSettings
from methods.springs.warm_up import block_on_halves


def test_newton_reaches_the_plateau_of_the_single_block() -> None:
    answer = IncrementalNewton().solve(block_on_halves((0.6, 0.4)), NewtonSettings())
    assert answer.multiplier == pytest.approx(0.5 / 1.05, rel=1e-9)


@pytest.mark.parametrize(("courses", "bricks", "value"), [(10, 5, 0.5056146), (20, 10, 0.4484451)])
def test_newton_passes_snaps_by_controlling_the_block_that_moved_farthest(
    courses: int, bricks: int, value: float
) -> None:
    """Controlled by the mean displacement along the live load, with whole Newton steps, it stopped on both walls."""
    answer = IncrementalNewton().solve(running_bond(courses, bricks, 0.65), NewtonSettings())
    assert answer.multiplier == pytest.approx(value, rel=1e-6)
    assert answer.details["load_control_limit"] < 0.99 * value


def test_newton_starts_where_load_control_finds_no_step_at_all() -> None:
    """All three steps of load control are beyond the strength of the wall."""
    answer = IncrementalNewton().solve(running_bond(10, 5, 0.65), NewtonSettings(first_step=5.0, cuts=2))
    assert answer.details["load_control_limit"] == 0.0
    assert answer.multiplier == pytest.approx(0.5056146, rel=1e-6)


@pytest.mark.parametrize(("cuts", "reached"), [(0, 0.4), (2, 0.4), (3, 0.475), (8, 0.475)])
def test_newton_halves_a_step_of_the_load_each_time_it_finds_no_equilibrium(cuts: int, reached: float) -> None:
    """The block collapses at .476: after .4 the step is .6, and its eighth is the first that it bears."""
    answer = IncrementalNewton().solve(block_on_halves((0.6, 0.4)), NewtonSettings(first_step=0.4, cuts=cuts))
    assert answer.details["load_control_limit"] == pytest.approx(reached, rel=1e-12)
    assert answer.multiplier == pytest.approx(0.5 / 1.05, rel=1e-9)


def test_newton_that_stops_says_so_and_gives_no_number() -> None:
    answer = IncrementalNewton().solve(running_bond(10, 5, 0.65), NewtonSettings(displacement_steps=0))
    assert (answer.status, answer.finding, answer.multiplier) == (Status.NOT_CONVERGED, Finding.NONE, None)
    assert "no proof of collapse" in answer.sentence
    assert answer.details["load_control_limit"] < 0.5056


def test_convex_steps_bracket_the_multiplier_of_the_exact_continuation() -> None:
    answer = ConvexSteps().solve(running_bond(6, 3, 0.65), ConvexSettings())
    assert answer.bracket is not None
    lower, upper = answer.bracket
    assert lower * (1 - 0.01) <= 13 / 23 <= upper * (1 + 0.01)


@pytest.mark.parametrize(
    ("layout", "cell", "friction", "live"),
    [
        pytest.param(["AABCD", "EABDD", "EFGGG"], (0.5, 0.2), 0.973, [-1.0, -0.05], id="limits settle slowly"),
        pytest.param(["ABCDD", "EEFFG", "HIJKG", "LMNNO"], (0.8, 0.2), 0.94, [1.0, -0.43], id="limits grow with it"),
    ],
)
def test_convex_steps_bracket_the_multiplier_of_blocks_of_any_shape(
    layout: list[str], cell: tuple[float, float], friction: float, live: list[float]
) -> None:
    """Brackets of 0.1 % lay 9 and 3 % too low where limits of the last step began the next, and 60 repeats ended it."""
    floor = "_" * len(layout[0])
    wall = Wall.model_validate(
        {
            "format": "wall/1",
            "unit_weight": 20.0,
            "friction": friction,
            "pattern": {"type": "panel", "cell_length": cell[0], "cell_height": cell[1], "layout": [*layout, floor]}
            | {"fixed": "_"},
            "loads": {"live": {"body": [{"per_weight": live}]}},
        }
    )
    assembly = build(wall, "panel").assembly
    exact = GapSprings().solve(assembly, GapSpringsSettings()).multiplier
    assert ConvexSteps().solve(assembly, ConvexSettings()).multiplier == pytest.approx(exact, rel=1e-3)


def ring(count: int, friction: float, live: dict[str, object]) -> Assembly:
    pattern = {"type": "ring", "inner_radius": 1.0, "outer_radius": 1.6, "count": count}
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": friction, "pattern": pattern, "loads": {"live": live}}
    return build(Wall.model_validate(wall), "ring").assembly


def test_convex_steps_whose_limits_do_not_settle_give_no_multiplier() -> None:
    answer = ConvexSteps().solve(running_bond(6, 3, 0.65), ConvexSettings(fixed_points=1))
    assert (answer.status, answer.finding, answer.multiplier) == (Status.NOT_CONVERGED, Finding.NONE, None)
    assert "no proof of collapse" in answer.sentence


def test_convex_steps_that_never_end_show_forces_under_the_dead_load() -> None:
    """OSQP's accuracy is relative to the load: at 1e5 times the live load the forces miss whole block weights."""
    answer = ConvexSteps().solve(ring(5, 0.9, {"body": [{"per_weight": [0.0, -1.0]}]}), ConvexSettings())
    assert (answer.status, answer.finding) == (Status.OK, Finding.UNBOUNDED)
    assert answer.forces_multiplier == 0.0


def test_convex_steps_say_when_a_multiplier_is_too_small_for_them() -> None:
    """Limits that settled to 1e-4 of the loads put the slide of a block at 0.003 2 % outside its bracket."""
    answer = ConvexSteps().solve(block_on_halves((0.02, 0.02)), ConvexSettings())
    assert answer.multiplier == pytest.approx(0.02, rel=2e-3)
    answer = ConvexSteps().solve(block_on_halves((0.003, 0.003)), ConvexSettings())
    assert (answer.status, answer.finding, answer.multiplier) == (Status.NOT_CONVERGED, Finding.NONE, None)
    assert "not accurate enough for so small a multiplier" in answer.sentence


def test_convex_steps_refuse_walls_that_are_too_large_for_them() -> None:
    answer = ConvexSteps().solve(running_bond(20, 10, 0.65), ConvexSettings())
    assert (answer.status, answer.finding) == (Status.REFUSED, Finding.NONE)
    assert "210 blocks" in answer.sentence


def test_convex_steps_show_the_block_that_overhangs_too_far_to_stay() -> None:
    """Two blocks of one width on each other, the upper shifted by more than half of it, turns over its edge."""
    answer = ConvexSteps().solve(column_with_overhang(0.6), ConvexSettings())
    assert (answer.status, answer.finding) == (Status.OK, Finding.FALLS)
    assert answer.details["moving_blocks"] == ["upper"]
    assert answer.mechanism is not None
    assert ConvexSteps().solve(column_with_overhang(0.4), ConvexSettings()).finding is Finding.STANDS


def column_with_overhang(shift: float) -> Assembly:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    blocks = [("ground", [-1.0, -1.0], True), ("lower", [0.0, 0.0], False), ("upper", [shift, 1.0], False)]
    stretch = {"ground": [3.0, 1.0]}
    wall = Wall.model_validate(
        {
            "format": "wall/1",
            "unit_weight": 1.0,
            "friction": 0.7,
            "blocks": [
                {"id": name, "polygon": (square * stretch.get(name, [1.0, 1.0]) + place).tolist(), "fixed": fixed}
                for name, place, fixed in blocks
            ],
        }
    )
    return build(wall).assembly


@pytest.mark.slow
def test_sensitivity_study_writes_its_table_and_plot(tmp_path: Path) -> None:
    assert main([str(tmp_path)]) == 0
    assert {p.name for p in tmp_path.iterdir()} == {"fe_sensitivity.csv", "fe_sensitivity.svg"}
