"""What the exact continuation must find."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.walls import irregular_wall, random_wall, running_bond
from harness.engine.isolate import run_isolated
from harness.engine.judge import answered
from harness.engine.worker import Task
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.method import Answer, Finding, Status
from harness.model.method_registry import load_method
from harness.model.reading import parse_wall
from methods.fe.gap_springs import GapSprings
from methods.fe.methods import FE
from methods.fe.settings import GapSpringsSettings
from methods.springs.model.factor import make_factor
from methods.springs.model.gap_law import SLIP_MINUS, SLIP_PLUS
from methods.springs.model.wall_model import build_model
from methods.springs.path.continuation import PathFollower
from methods.springs.path.plateau import check
from methods.springs.rest.equilibrium import gravity_state
from methods.springs.rest.newton import newton
from methods.springs.warm_up import block_on_halves
from tests.walls import assembly, stack, wall_data

CASES = Path(__file__).parents[2] / "cases"
EXACT = 1e-9  # closed forms are met to rounding; this leaves room for other linear algebra libraries
THREE = GapSpringsSettings(histories=(0.0, 0.01, 0.002))


def solve(wall: Assembly, **settings: object) -> Answer:
    return GapSprings().solve(wall, GapSpringsSettings.model_validate(settings))


def load_control_limit(wall: Assembly, commits: bool) -> float:
    """The multiplier at which Newton under load control no longer converges, in steps of 0.002 halved at the end.

    With commits every point carries on from the shear it has; the multipliers are not those of `fe`'s commits.
    """
    model = build_model(wall, GapSpringsSettings())
    factor = make_factor(model)
    rest = gravity_state(model, factor)
    multiplier, step = 0.0, 0.002
    while step > 2e-5:
        after = newton(model, factor, rest.u, multiplier + step, rest.history)
        if not after.found:
            step *= 0.5
            continue
        multiplier += step
        shear = model.forces(after.u, after.history, after.state)[1]
        history = shear - model.kt * model.strains(after.u)[1] if commits else after.history
        rest = replace(after, history=history)
    return multiplier


@pytest.mark.parametrize("stiffness", [1e2, 1e5, 1e8])
@pytest.mark.parametrize("ratio", [0.01, 1.0, 100.0])
def test_fe_single_block_is_stiffness_independent(stiffness: float, ratio: float) -> None:
    answer = solve(block_on_halves((0.6, 0.4)), normal_stiffness=stiffness, stiffness_ratio=ratio)
    assert answer.multiplier == pytest.approx(0.5 / 1.05, rel=EXACT)


def test_fe_single_block_with_three_lobatto_points() -> None:
    answer = solve(block_on_halves((0.6, 0.4)), rule="lobatto", points=3)
    assert answer.multiplier == pytest.approx(0.5 / 1.075, rel=EXACT)


@pytest.mark.parametrize(
    ("friction", "value"), [(0.3, 0.3), (0.5, 0.5), (0.65, 13 / 23), (0.75, 13 / 23), (1.0, 13 / 23)]
)
def test_fe_21_bricks_slide_or_rock(friction: float, value: float) -> None:
    answer = solve(running_bond(6, 3, friction))
    assert answer.multiplier == pytest.approx(value, rel=1e-8)
    assert answer.details["spread"] < 1e-8


def test_fe_55_bricks_reach_the_plateau_below_the_peak() -> None:
    answer = solve(running_bond(10, 5, 0.65))
    details = answer.details
    assert answer.multiplier == pytest.approx(0.5056, rel=1e-3)
    assert details["peak"] == pytest.approx(0.50574, rel=1e-3)
    assert details["plateau"] <= details["peak"]
    assert 0.0 < details["spread"] < 0.025


def test_fe_answer_is_an_exact_collapse_state() -> None:
    wall = running_bond(10, 5, 0.65)
    answer = solve(wall, histories=(0.0,))
    assert answer.multiplier is not None
    assert answer.forces is not None
    assert answer.mechanism is not None
    state = check(wall, answer.multiplier, answer.forces, answer.mechanism)
    assert state.worst < FE.tolerance
    assert state.work_multiplier == pytest.approx(answer.multiplier, rel=1e-8)


def test_check_notices_wrong_forces_and_wrong_mechanisms() -> None:
    wall = running_bond(6, 3, 0.65)
    answer = solve(wall, histories=(0.0,))
    assert answer.forces is not None
    assert answer.mechanism is not None
    assert check(wall, 0.5, answer.forces, answer.mechanism).worst > 1e-3
    assert check(wall, 13 / 23, answer.forces * 1.01, answer.mechanism).worst > 1e-3
    assert check(wall, 13 / 23, answer.forces, -answer.mechanism).worst > 1e-3


def test_fe_multiplier_is_the_same_however_the_wall_is_looked_at(view: Callable[[Assembly], Assembly]) -> None:
    wall = running_bond(8, 4, 0.6)
    ours, theirs = solve(wall, histories=(0.0,)), solve(view(wall), histories=(0.0,))
    assert ours.multiplier is not None
    assert theirs.multiplier == pytest.approx(ours.multiplier, rel=1e-6)


def test_fe_multiplier_does_not_depend_on_the_normal_stiffness_of_a_wall() -> None:
    values = [
        solve(running_bond(8, 4, 0.65), normal_stiffness=kn, histories=(0.0,)).multiplier for kn in (1e2, 1e4, 1e8)
    ]
    assert values[0] == pytest.approx(values[1], rel=1e-9)
    assert values[0] == pytest.approx(values[2], rel=1e-9)


def test_fe_same_run_gives_the_same_numbers() -> None:
    wall = running_bond(8, 4, 0.65)
    assert solve(wall).multiplier == solve(wall).multiplier


def test_fe_wall_without_live_load_stands() -> None:
    wall = running_bond(4, 3, 0.65)
    answer = solve(replace(wall, live=np.zeros_like(wall.live)))
    assert (answer.status, answer.finding, answer.multiplier) == (Status.OK, Finding.STANDS, None)


def test_fe_live_load_that_presses_down_is_unbounded() -> None:
    wall = running_bond(4, 3, 0.65)
    answer = solve(replace(wall, live=wall.dead.copy()))
    assert (answer.finding, answer.multiplier) == (Finding.UNBOUNDED, None)


def test_fe_floating_block_is_a_gravity_failure_that_names_it() -> None:
    wall = running_bond(3, 3, 0.65)
    top = wall.n_blocks - 1
    keep = (wall.block_a != top) & (wall.block_b != top)
    answer = solve(wall.with_joints(keep))
    assert answer.finding is Finding.FALLS
    assert answer.details["path_status"] == "gravity_failure"
    assert answer.details["moving_blocks"] == [wall.block_ids[top]]
    assert wall.block_ids[top] in answer.sentence


@pytest.mark.parametrize("friction", [0.3, 0.5, 0.708])
def test_fe_motion_of_a_fall_gains_work_of_the_dead_load(friction: float) -> None:
    """At 0.5 and 0.708 the springs are followed until rounding is all that moves."""
    layout = ["AABBCCD", "AABBCCE", "FGHHH.E", "FFJJ...", "F.....N", "_______"]
    panel = {"type": "panel", "cell_length": 0.5, "cell_height": 0.3, "layout": layout, "fixed": "_"}
    wall = build(parse_wall(wall_data(panel, friction), "panel.json")).assembly
    answer = solve(wall)
    assert answer.finding is Finding.FALLS
    assert answer.mechanism is not None
    assert float((wall.dead * answer.mechanism).sum()) > 0.0
    assert "J" in answer.details["moving_blocks"]


def test_fe_goes_on_beside_a_block_without_weight_that_comes_loose() -> None:
    """A panel whose weight is neglected, under a loading beam: block a leaves its neighbours, and nothing holds it.

    One history ends where it does, and says so. Two go on to the collapse, which is what statics allows at most.
    """
    wall = {
        "format": "wall/1",
        "unit_weight": 0.0,
        "friction": 0.58,
        "pattern": {
            "type": "panel",
            "cell_length": 1.0,
            "cell_height": 1.0,
            "layout": ["jklm", "ghhi", "eeff", "abcd", "####"],
            "fixed": "#",
        },
        "blocks": [{"id": "beam", "polygon": [[0.0, 5.0], [4.0, 5.0], [4.0, 6.0], [0.0, 6.0]], "weight": 96.0}],
        "loads": {"live": {"points": [{"block": "beam", "at": [2.0, 5.5], "force": [4.0, 0.0]}]}},
    }
    panel = build(parse_wall(wall, "panel")).assembly
    answer = solve(panel)
    assert answer.multiplier == pytest.approx(32 / 3, rel=1e-9)
    assert answer.multiplier == pytest.approx(answered(load_method("la-associated"), panel)[0].multiplier, rel=1e-9)
    assert "blocks without weight or load move freely (a)" in str(answer.details["histories"])


def test_fe_path_columns_have_equal_length_and_end_at_the_plateau() -> None:
    answer = solve(running_bond(8, 4, 0.65))
    lengths = {len(column) for column in answer.path.values()}
    assert len(lengths) == 1
    assert lengths.pop() <= 300
    assert answer.path["multiplier"][-1] == pytest.approx(answer.multiplier, rel=1e-6)


@pytest.mark.slow
def test_fe_210_bricks_within_a_thousandth() -> None:
    answer = solve(running_bond(20, 10, 0.65))
    assert answer.multiplier == pytest.approx(0.4484, rel=1e-3)
    assert answer.details["spread"] < 0.025


def test_a_path_left_at_the_time_limit_says_where_it_was() -> None:
    wall = running_bond(60, 30, 0.65)
    result = run_isolated(Task("fe", wall, {}, 6.0, 2**31), "large").result
    assert result.status is Status.NOT_CONVERGED
    assert result.multiplier is None
    assert "stopped by the time limit, at 0." in result.sentence


def test_fe_history_whose_path_runs_in_a_loop_is_taken_out_of_it() -> None:
    answer = GapSprings().solve(random_wall(384), THREE)
    ends = [history["end"] for history in answer.details["histories"]]
    assert ends == ["plateau"] * 3
    assert answer.details["spread"] < 1e-9


@pytest.mark.parametrize(("seed", "lost"), [(176, 2), (639, 2), (685, 1)])
def test_fe_history_that_late_commits_lose_is_committed_up_to_less_of_the_multiplier(seed: int, lost: int) -> None:
    """From a commit near the peak their paths run in a closed loop, or break down."""
    histories = GapSprings().solve(random_wall(seed), THREE).details["histories"]
    assert [history["step"] for history in histories] == [0.0, 0.01, 0.002]
    assert [history["committed_up_to"] is not None for history in histories] == [k == lost for k in range(3)]
    assert histories[lost]["commits"] > 50
    assert histories[lost]["committed_up_to"] == pytest.approx(0.97 * histories[0]["plateau"], rel=1e-3)
    assert "plastic slip updated up to" in histories[lost]["sentence"]
    assert [history["plateau"] for history in histories] == pytest.approx([histories[0]["plateau"]] * 3, rel=1e-3)


def test_fe_commits_stay_in_equilibrium_beside_a_nearly_singular_tangent() -> None:
    """Seed 2302: a committed step by way of displacements of 1e15 ended out of balance by twice the load."""
    committed = GapSprings().solve(random_wall(2302), GapSpringsSettings()).details["histories"][1]
    assert (committed["end"], committed["committed_up_to"]) == ("plateau", None)
    assert committed["path_residual"] < EXACT
    assert committed["plateau"] == pytest.approx(0.32823, rel=1e-4)


def test_fe_histories_that_end_far_apart_are_met_by_plain_load_control() -> None:
    """Seed 44: 11.6 % lie between two laws of friction, not between two accuracies of one."""
    wall = random_wall(44)
    without, with_commits, finer = GapSprings().solve(wall, GapSpringsSettings()).details["histories"]
    assert load_control_limit(wall, commits=False) == pytest.approx(without["plateau"], abs=1e-4)
    assert load_control_limit(wall, commits=True) == pytest.approx(with_commits["plateau"], abs=1e-4)
    assert finer["plateau"] == pytest.approx(with_commits["plateau"], rel=1e-9)


def test_a_third_history_is_traced_where_the_first_two_differ_by_more_than_a_thousandth() -> None:
    """A stack ends at one multiplier whatever the history; two of 55 bricks end within .09 %; seed 75 at 2.6 %."""
    walls = assembly(stack(5), 0.7), running_bond(10, 5, 0.65), random_wall(75)
    found = [[h["plateau"] for h in solve(wall).details["histories"]] for wall in walls]
    assert [len(plateaus) for plateaus in found] == [2, 2, 3]
    assert 1e-4 < abs(found[1][1] / found[1][0] - 1.0) < 1e-3
    assert abs(found[2][1] / found[2][0] - 1.0) > 1e-3


@pytest.mark.slow
def test_fe_990_bricks_end_in_an_exact_collapse_state_on_soft_pieces() -> None:
    answer = solve(running_bond(44, 22, 0.65), histories=(0.0,))
    assert answer.multiplier == pytest.approx(0.4158961784, abs=1e-9)
    assert max(answer.details["residuals"].values()) < 1e-9


@pytest.mark.slow
def test_fe_400_irregular_blocks_come_to_one_plateau_under_three_histories() -> None:
    """They ended 102 % apart, the first after 60,000 breakpoints, while jumps kept the friction history before them."""
    answer = GapSprings().solve(irregular_wall(1, 20, 20, 1.0), THREE)
    plateaus = [history["plateau"] for history in answer.details["histories"]]
    assert plateaus == pytest.approx([0.1599892] * 3, rel=1e-6)


def test_fe_path_of_too_many_breakpoints_is_begun_where_the_load_can_be_raised_to() -> None:
    """55 bricks, whose exact path has 376 breakpoints: 94 are left, to a state with another history of the motion.

    The histories after it begin at the same rest.
    """
    answer = solve(running_bond(10, 5, 0.65), histories=(0.0, 0.01), max_events=150)
    history, committed = answer.details["histories"]
    assert history["raised_to"] == pytest.approx(0.9 * history["plateau"], rel=0.1)
    assert "raised in finite steps" in history["sentence"]
    assert "raised in finite steps" in answer.sentence
    assert history["events"] < 150
    assert answer.details["peak"] >= history["raised_to"]
    assert max(answer.details["residuals"].values()) < 1e-9
    assert answer.multiplier == pytest.approx(0.505615, rel=2e-3)
    assert committed["raised_to"] == history["raised_to"]
    assert committed["plateau"] == pytest.approx(0.505615, rel=2e-3)
    assert answer.path["multiplier"][0] < answer.path["multiplier"][-1]


def test_fe_point_load_at_the_end_of_a_beam_has_the_multiplier_of_limit_analysis() -> None:
    # A jump from a path that had turned down led to a state whose tangent is singular, and the method raised.
    data = json.loads((CASES / "panel-4x4-3-f0" / "wall.json").read_text(encoding="utf-8"))
    data["loads"]["live"]["points"][0]["at"][0] = 0.002
    wall = build(parse_wall(data, "panel")).assembly
    answer = solve(wall)
    assert answer.finding is Finding.COLLAPSES
    assert answer.multiplier == pytest.approx(407 / 36, rel=1e-8)


@pytest.mark.parametrize("friction", [3.0, 10.0, 1000.0])
def test_fe_very_rough_bricks_rock_alike(friction: float) -> None:
    assert solve(running_bond(6, 3, friction)).multiplier == pytest.approx(13 / 23, rel=EXACT)


def test_fe_path_counts_the_points_that_slip_whichever_way_they_do() -> None:
    """A block on two joints of two points each, far too low to rock: when the fourth slips too, it collapses."""
    wall = block_on_halves((0.5, 0.5))
    paths = [solve(replace(wall, live=way * wall.live)).path for way in (1.0, -1.0)]
    for path in paths:
        assert (path["slipping_points"][0], path["slipping_points"][-1]) == (0.0, 3.0)
        assert set(path["open_points"]) == {0.0}
    np.testing.assert_allclose(paths[0]["multiplier"], paths[1]["multiplier"], atol=1e-12)
    np.testing.assert_allclose(paths[0]["live_displacement"], paths[1]["live_displacement"], atol=1e-12)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_fe_path_that_begins_loaded_counts_the_points_that_slip_there(way: float) -> None:
    """On halves of friction .6 and .2 the smoother one slips first, and before a collapse at .2 at least."""
    wall = block_on_halves((0.6, 0.2))
    model = build_model(replace(wall, live=way * wall.live), GapSpringsSettings())
    factor = make_factor(model)
    rest = gravity_state(model, factor)
    loaded = newton(model, factor, rest.u, 0.25, rest.history)
    assert loaded.found
    follower = PathFollower.from_rest(model, factor, loaded)
    slips = np.isin(loaded.state, [SLIP_PLUS, SLIP_MINUS])
    assert model.interface[slips].tolist() == [1, 1]
    assert (follower.n_slip, follower.n_open) == (2, 0)
    assert follower.may_commit()
