"""Measures of a collapse state of one block, by hand, and bounds in the units of the wall."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from harness.model.method import Answer, Finding, Status
from methods.la.answers import falls_answer, moving_blocks
from methods.la.bounds import bounded, certified, with_bound
from methods.la.certify.proof import TreeProof
from methods.la.core.exact import close_tight, exact_forces
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.core.state import CollapseState, local_residuals, residuals
from methods.la.core.vertex_programmes import ForceProgramme, RowScaling, row_scaling
from methods.la.find_certificate import certificate
from methods.la.interior.arc import ArcPath, Stepping
from methods.la.interior.associated import EndOfPath, by_interior_point, solve_associated
from methods.la.interior.interior_point import PathResult, start_point
from methods.la.interior.interior_starting_point import phase_one_forces
from methods.la.interior.newton_step import Direction, Point
from methods.la.interior.region import in_whole, moving_region
from methods.la.least import chosen_state, confirmed, of_uneven
from methods.la.search import LimitAnalysis
from methods.la.settings import BoundSettings, SearchSettings
from methods.la.sources.search import Search
from methods.proof.search.window_search import Bracket, Stop
from tests.known_walls import box, of_blocks, three
from tests.la.bodies import block_on_halves, running_bond, with_friction


@pytest.fixture(scope="module")
def problem() -> Problem:
    """One block 1 x .5 on two halves; scaled its weight and its live load are 1."""
    return make_problem(block_on_halves())


def state(problem: Problem, forces: list[list[float]], multiplier: float, motion: list[float]) -> CollapseState:
    """A state of the block with end forces (2, 3) in weights and a motion (3,) in scaled units."""
    return CollapseState(np.array(forces), multiplier, np.array(motion), np.zeros((2, 4), dtype=bool))


NONE = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]


def test_residuals_of_a_block_that_nothing_carries(problem: Problem) -> None:
    """Its whole weight is out of balance; it sinks into both halves as fast as it moves."""
    found = residuals(problem, state(problem, NONE, 0.0, [0.0, -2.0, 0.0]))
    assert found["equilibrium"] == pytest.approx(1.0)
    assert found["interpenetration"] == pytest.approx(1.0)
    assert (found["yield"], found["complementarity"]) == (0.0, np.inf)


def test_residuals_of_yield_and_complementarity_by_hand(problem: Problem) -> None:
    """A tension of a quarter weight at one end; pressed ends that lift at the speed at which the live load works."""
    pulled = residuals(problem, state(problem, [[-0.25, 0.5, 0.0], [0.5, 0.5, 0.0]], 0.0, [1.0, 0.0, 0.0]))
    assert pulled["yield"] == pytest.approx(0.25)
    lifted = residuals(problem, state(problem, [[0.25, 0.25, 0.0], [0.25, 0.25, 0.0]], 0.0, [1.0, 1.0, 0.0]))
    slip = float(problem.slacks(np.array([[0.25, 0.25, 0.0]] * 2))[:, 2].sum())  # both halves slip one way at rate 1
    assert lifted["complementarity"] == pytest.approx(1.0 + slip)


def test_forces_that_lack_are_relative_to_the_weight_of_the_whole_wall() -> None:
    """Two equal blocks without forces: half of the weight is out of balance at either; a tension of its tenth."""
    pair = make_problem(of_blocks([box("a", 0.0, 0.0), box("b", 4.0, 0.0)]))
    tenth = 0.1 * 40.0 / pair.unit_force
    none = CollapseState(np.zeros((2, 3)), 0.0, np.zeros(6), np.zeros((2, 4), dtype=bool))
    assert residuals(pair, none)["equilibrium"] == pytest.approx(0.5)
    pulled = replace(none, forces=np.array([[-tenth, 0.0, 0.0], [0.0, 0.0, 0.0]]))
    assert residuals(pair, pulled)["yield"] == pytest.approx(0.1)


def test_a_mechanism_of_a_part_is_one_of_the_whole_wall_with_the_rates_of_its_motion() -> None:
    """The second of two blocks slides; its motion in the part has another scale than the live work of the whole."""
    pair = make_problem(of_blocks([box("a", 0.0, 0.0), box("b", 4.0, 0.0, 2.0, 1.0)]))
    sliding = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0])
    region = moving_region(pair, sliding)
    assert region.kept.tolist() == [False, True]
    motion = np.array([7.0, 0.0, 0.0])
    rates = region.problem.rates_of_velocities(motion, associated=True)
    point = Point(np.ones((1, 4)), 0.5, motion, rates)
    whole = in_whole(pair, region, PathResult(point, True, 1, 0.0, 0.0, 0.0, [])).point
    assert float(pair.live @ whole.velocities) == pytest.approx(pair.live_work)
    assert whole.rates == pytest.approx(pair.rates_of_velocities(whole.velocities, associated=True), abs=1e-12)


def test_residuals_where_they_arise_are_shares_of_what_acts_there(problem: Problem) -> None:
    """Half the weight is carried; the wall sinks at both ends of one half and at none of the other when it turns."""
    carried = state(problem, [[0.25, 0.25, 0.0], [0.0, 0.0, 0.0]], 0.25, [0.0, -3.0, 0.0])
    equilibrium, tension, closing = local_residuals(problem, carried)
    balance = abs(problem.imbalance(carried.forces, 0.25)).max()
    size = max(0.5 + 1.0, 0.25 + 0.0)  # |forces| and |dead load| down; |live load| sideways
    turning = float((abs(problem.statics) @ np.array([0.25, 0.25, 0.0, 0.0, 0.0, 0.0]))[2])
    assert equilibrium == pytest.approx([balance / max(size, turning)])
    assert tension.tolist() == [0.0, 0.0]
    assert closing == pytest.approx([1.0, 1.0])
    pulled = local_residuals(problem, state(problem, [[-0.5, 0.0, 0.0], [0.0, 0.0, 0.0]], 0.0, [0.0, 3.0, 0.0]))
    assert pulled[1] == pytest.approx([0.5 / (0.5 + 1.0), 0.0])
    assert pulled[2].tolist() == [0.0, 0.0]


def test_blocks_that_move_are_counted_and_none_at_rest(problem: Problem) -> None:
    wall = problem.assembly
    motion = np.zeros((wall.n_blocks, 3))
    assert moving_blocks(wall, motion) == 0
    motion[~wall.fixed, 2] = 1.0
    assert moving_blocks(wall, motion) == 1


def test_a_search_may_be_told_to_give_up_after_one_failure() -> None:
    assert SearchSettings(failures=1).failures == 1
    with pytest.raises(ValueError, match="greater than or equal to 1"):
        SearchSettings(failures=0)


def test_a_bracket_in_scaled_units_bounds_the_multiplier_in_those_of_the_wall(problem: Problem) -> None:
    """Of the bound of the bracket and the one known before the higher stands."""
    scaled = replace(problem, unit_multiplier=4.0)
    known = Answer(Status.OK, Finding.COLLAPSES, "", multiplier=2.0, details={"lower_bound": 0.25})
    found = Bracket(lower=0.125, upper=0.5, windows=[0.125, 0.25], iterations=7, stopped=next(iter(Stop)))
    answer = bounded(scaled, known, found)
    assert answer.details["lower_bound"] == 0.5
    assert answer.details["bound_windows"] == [0.5, 1.0]
    assert "at least 0.5," in answer.sentence
    assert bounded(scaled, known, replace(found, lower=0.03)).details["lower_bound"] == 0.25


@pytest.fixture(scope="module")
def least() -> Answer:
    """What `la` finds of the block: it slides at .4, its smaller friction."""
    return LimitAnalysis().solve(block_on_halves(), SearchSettings())


def test_a_certificate_says_whether_the_least_state_is_proved_or_a_bound_below_it(least: Answer) -> None:
    """It proves 2/5: of an answer of .4 it proves all, of one of .5, which it is not of, it says nothing."""
    document = certificate(block_on_halves())
    assert document is not None
    proved = certified(least, document)
    assert proved.sentence.startswith("The minimum collapse multiplier is 2/5 to two millionths, proved in fractions:")
    assert "there is a collapse state there, and none below 0.39999" in proved.sentence
    assert proved.details["certified_bound"] == pytest.approx(0.4, rel=2.5e-6)
    assert certified(least, None) is least
    other = replace(least, multiplier=0.5)
    assert certified(other, document) is other


def test_a_bound_keeps_its_certificate_unless_it_is_too_long(problem: Problem, least: Answer) -> None:
    """By the tree, or by windows where the tree did not end; of a long certificate the bound alone stays."""
    wall = problem.assembly
    open_tree = replace(least, details=least.details | {"proved_least": False})
    for known in (least, open_tree):
        whole = with_bound(wall, problem, known, BoundSettings()).details["certificate"]
        length = len(json.dumps(whole))
        for most, kept in ((length, True), (length - 1, False)):
            answer = with_bound(wall, problem, known, BoundSettings(largest_certificate=most))
            assert ("certificate" in answer.details) is kept
            assert answer.details["certified_bound"] == pytest.approx(0.4, rel=2.5e-6)
    stopped = replace(least, details=least.details | {"stopped_by_limit": True})
    assert with_bound(wall, problem, stopped, BoundSettings()) is stopped


@pytest.mark.parametrize("greatest", [True, False])
def test_the_mechanism_beside_an_extreme_work_has_that_work_of_the_dead_load(problem: Problem, greatest: bool) -> None:
    """Where both ends of the left half open by one, it bears from none to all of the weight."""
    strains = np.zeros((2, 3))
    strains[0, :2] = 1.0
    found = ForceProgramme(problem).extreme_work(strains, greatest)
    assert not isinstance(found, str)
    forces, velocities = found
    work = float((forces * strains).sum())
    assert abs(float(problem.dead @ velocities)) == pytest.approx(abs(work), abs=1e-9)
    assert problem.imbalance(forces, 0.0) == pytest.approx(0.0, abs=1e-9)
    assert abs(work) == pytest.approx(1.0 if greatest else 0.0, abs=1e-9)


def test_exact_forces_bear_the_loads_at_the_multiplier_of_the_live_load_and_without_one(problem: Problem) -> None:
    """Near given forces whose shears add to .09 and that lack balance by some hundredths of the weight."""
    tight = np.zeros((2, 4), dtype=bool)
    near = np.array([[0.3, 0.2, -0.05], [0.2, 0.3, -0.04]])
    forces, multiplier = exact_forces(problem, NewtonMatrix(problem), near, 0.1, tight)
    assert abs(problem.imbalance(forces, multiplier)).max() < 1e-14
    assert multiplier == pytest.approx(0.09, abs=0.03)  # by as much as the given forces lack
    bare = replace(problem, live=np.zeros_like(problem.live))
    still, kept = exact_forces(bare, NewtonMatrix(bare), near, 0.1, tight)
    assert abs(bare.imbalance(still, 0.0)).max() < 1e-14
    assert kept == 0.1


@pytest.mark.parametrize("ratio", [1e9, 3.3e12])
def test_units_of_uneven_loads_are_the_powers_of_two_next_to_them(ratio: float) -> None:
    """A light stone beside a heavy one: the equilibrium of each is measured by the power of two next to its load."""
    wall = of_blocks([box("a", 0.0, 0.0, weight=1.0), box("b", 4.0, 0.0, weight=ratio)])
    problem = make_problem(wall)
    scaling = row_scaling(problem)
    assert scaling is not None
    own = abs(problem.dead).reshape(-1, 3).max(axis=1)
    assert np.log2(scaling.blocks) == pytest.approx(np.round(np.log2(own)), abs=1e-12)
    assert np.log2(scaling.blocks).tolist() == np.round(np.log2(scaling.blocks)).tolist()
    assert row_scaling(make_problem(of_blocks([box("a", 0.0, 0.0), box("b", 4.0, 0.0)]))) is None


def test_a_change_and_half_another_add_in_every_part() -> None:
    def change(k: float) -> Direction:
        return Direction(np.full((2, 3), k), np.full((2, 4), k), k, np.full(3, k), np.full((2, 4), k))

    both = change(3.0).plus(0.5, change(4.0))
    for name in ("forces", "slack", "multiplier", "velocities", "rates"):
        assert np.all(getattr(both, name) == 5.0), name


@pytest.mark.parametrize("friction", [0.3, 0.7])
def test_the_central_path_alone_ends_at_the_associated_maximum_of_the_simplex_method(friction: float) -> None:
    problem = make_problem(running_bond(3, 2, 0.2, friction))
    newton = NewtonMatrix(problem)
    ended, least = by_interior_point(problem, newton, EndOfPath()), solve_associated(problem, newton, "highs")
    assert ended is not None
    assert ended.state is not None
    assert least.state is not None
    assert ended.state.multiplier == pytest.approx(least.state.multiplier, rel=1e-9)


def test_an_end_of_the_central_path_that_is_not_exact_enough_is_left_to_the_simplex_method() -> None:
    """No state of this bond is exact to the last digit; to rounding it is, by contacts or beside the path's motion."""
    problem = make_problem(running_bond(2, 2, 0.2, 0.7))
    newton = NewtonMatrix(problem)
    never = EndOfPath(exact=0.0)
    assert by_interior_point(problem, newton, never) is None
    least, instead = (solve_associated(problem, newton, *how) for how in (("highs",), ("interior", never)))
    assert least.state is not None
    assert instead.state is not None
    assert instead.state.multiplier == pytest.approx(least.state.multiplier, rel=1e-12)
    for bias in EndOfPath().biases[:2]:
        ended = by_interior_point(problem, newton, EndOfPath(biases=(bias,)))
        assert ended is not None
        assert ended.state is not None
        assert ended.state.multiplier == pytest.approx(least.state.multiplier, rel=1e-9)


def test_forces_show_that_a_wall_stands_only_if_they_are_balanced_to_the_limit_asked_for() -> None:
    """Forces of the first phase are within yield; rounding leaves them out of balance by some 1e-16 weights."""
    problem = make_problem(running_bond(3, 2, 0.2, 0.3))
    newton = NewtonMatrix(problem)
    forces = phase_one_forces(problem, newton)
    assert forces is not None
    assert problem.slacks(forces).min() > 0.0
    left = float(abs(problem.imbalance(forces, 0.0)).max())
    assert 0.0 < left < 1e-12
    assert phase_one_forces(problem, newton, imbalance=left) is not None
    assert phase_one_forces(problem, newton, imbalance=0.5 * left) is None


def test_a_joint_without_friction_bears_no_shear_either_way() -> None:
    """So both its shear limits are tight from the start, and its ends are not."""
    smooth = make_problem(with_friction(block_on_halves(), np.array([0.6, 0.0])))
    assert close_tight(smooth).tolist() == [[False] * 4, [False, False, True, True]]


SLIDING = np.array([[False, False, True, False]] * 2)
"""Contacts of the block that slide, both to one side."""
OPENING = np.ones((2, 4), dtype=bool)
"""All its contacts move, so that none bears it: no state has these."""


def test_states_are_confirmed_from_the_lowest_on_until_one_is_known_below_the_next(problem: Problem) -> None:
    """Sliding is confirmed at 2/5, the least multiplier of forces at the friction of both halves."""
    claims = [(0.5, SLIDING), (0.3, SLIDING), (0.1, OPENING), (0.35, SLIDING)]
    states = [replace(state(problem, NONE, at, [3.0, 0.0, 0.0]), moving=moving) for at, moving in claims]
    found = confirmed(problem, NewtonMatrix(problem), None, states)
    assert len(found) == 2  # of the claims at .3 and .35; at .1 nothing bears the block, and .5 is above 2/5
    for exact in found:
        assert exact.multiplier == pytest.approx(0.4, abs=1e-12)
        assert abs(problem.imbalance(exact.forces, exact.multiplier)).max() < 1e-12
        assert exact.velocities == pytest.approx([problem.live_work / problem.live[0], 0.0, 0.0], abs=1e-12)


def test_of_states_of_an_uneven_wall_the_least_that_forces_confirm_is_chosen() -> None:
    """Blocks of 1, 1e6 and 1e12: the lightest slides at its friction .3; at .1 nothing would bear it."""
    wall = three((1.0, 1e6, 1e12))
    problem = make_problem(wall)
    search = Search(problem, NewtonMatrix(problem))
    slides, lifts = np.zeros((3, 4), dtype=bool), np.zeros((3, 4), dtype=bool)
    slides[0, 3] = lifts[0] = True
    motion = np.array([1.0, *[0.0] * 8])
    claimed = CollapseState(np.zeros((3, 3)), 0.1, motion, lifts)
    with search.record.trying("by hand", search.budget.spent) as tried:
        tried.states.append(claimed)
        assert chosen_state(search) is None
        tried.states.append(replace(claimed, multiplier=0.3, moving=slides))
    chosen = chosen_state(search)
    assert chosen is not None
    least = chosen[0]
    assert problem.to_multiplier(least.multiplier) == pytest.approx(0.3, rel=1e-12)
    weight = wall.weight[wall.free] / problem.unit_force
    assert least.forces[:, :2].sum(axis=1) / weight == pytest.approx(np.ones(3), rel=1e-12)
    assert least.forces[:, 2] / weight == pytest.approx(np.full(3, 0.3), rel=1e-12)


def test_a_tree_proves_nothing_of_an_uneven_wall_if_its_own_state_is_not_confirmed(problem: Problem) -> None:
    """Its bound holds for a state as low as its own; a state that no forces confirm is none."""
    newton, units = NewtonMatrix(problem), RowScaling(np.full(2, 0.5), np.ones(1))
    sliding = replace(state(problem, NONE, 0.4, [1.0, 0.0, 0.0]), moving=SLIDING)
    opening = replace(sliding, multiplier=0.1, moving=OPENING)
    best, proof = of_uneven(problem, newton, units, [sliding], TreeProof(sliding, 0.4, 7))
    assert best.multiplier == pytest.approx(0.4, abs=1e-12)
    assert (proof.state, proof.lower_bound, proof.nodes) == (best, 0.4, 7)
    best, proof = of_uneven(problem, newton, units, [sliding], TreeProof(opening, 0.1, 7))
    assert best.multiplier == pytest.approx(0.4, abs=1e-12)
    assert (proof.state, proof.lower_bound, proof.nodes) == (best, 0.0, 7)
    best, proof = of_uneven(problem, newton, units, [opening], TreeProof(opening, 0.1, 7))
    assert best is opening
    assert proof.lower_bound == 0.1


def test_a_path_that_is_taken_up_again_goes_on_with_half_the_stride_and_lengthens_it_later() -> None:
    """Were the stride doubled at once, the path would meet the fold that it could not pass as before."""
    problem = make_problem(running_bond(3, 2, 0.2, 0.65))
    newton = NewtonMatrix(problem)
    path = ArcPath(problem, newton, start_point(problem))
    path.follow(0.0, 10)
    longest = Stepping().stride
    assert path._stride == longest
    assert path._take_up_again()
    path.follow(0.0, 0)  # one step
    assert path._stride == 0.5 * longest
    path.follow(0.0, 10)
    assert path._stride == longest


def test_the_associated_maximum_is_found_by_the_solver_asked_for_or_by_size() -> None:
    problem = make_problem(running_bond(2, 2, 0.2, 0.7))
    newton = NewtonMatrix(problem)
    ended = by_interior_point(problem, newton, EndOfPath())
    assert ended is not None
    size = problem.n_interfaces
    for solver, above, by_path in (
        ("highs", 0, False),
        ("interior", size, True),
        ("auto", size, False),
        ("auto", size - 1, True),
    ):
        found = solve_associated(problem, newton, solver, EndOfPath(above=above))
        assert (found.iterations == ended.iterations) is by_path, (solver, above)


@pytest.mark.parametrize(("count", "said"), [(1, "a mechanism of 1 block:"), (2, "a mechanism of 2 blocks:")])
def test_a_fall_is_told_with_the_number_of_blocks_that_move(count: int, said: str) -> None:
    wall = block_on_halves()
    motion = np.zeros((wall.n_blocks, 3))
    motion[:count, 1] = -1.0
    assert said in falls_answer(wall, motion).sentence
