"""What the search of large walls is made of, on walls small enough to know the outcome."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import block_diag

from benchmarks.la_and_fe import ABOVE, facade, solved
from harness.model.method import Finding
from methods.la.associated import AssociatedLimitAnalysis
from methods.la.core.exact import close_tight
from methods.la.core.newton_matrix import NewtonMatrix
from methods.la.core.problem import Problem, make_problem
from methods.la.core.state import residuals
from methods.la.interior.arc import ArcPath, Stepping
from methods.la.interior.associated import EndOfPath
from methods.la.interior.interior_point import PathSettings, follow_path, start_point
from methods.la.interior.interior_starting_point import FEASIBLE, interior_starting_point
from methods.la.interior.newton_step import NewtonStep, Point
from methods.la.interior.region import with_all_above
from methods.la.least import least_of
from methods.la.search import LimitAnalysis
from methods.la.settings import AssociatedSettings, SearchSettings
from methods.la.sources import explore
from methods.la.sources.arcs import NEAR, ArcPaths
from methods.la.sources.budget import Budget, SearchLimits
from methods.la.sources.dilatancy_continuation import DilatancyContinuation
from methods.la.sources.search import Choices, Search, Source
from methods.la.sources.springs import LowPrestress
from tests.la.bodies import running_bond


def path_from_pair(stepping: Stepping = Stepping()) -> ArcPath:
    """A path from a pair of forces and mechanism of zero dilatancy."""
    problem = make_problem(running_bond(28, 16, 0.175, 0.65))
    newton = NewtonMatrix(problem)
    start, _ = interior_starting_point(problem, newton, 1e-2)
    assert start is not None
    return ArcPath(problem, newton, start, stepping=stepping)


def test_path_by_arc_length_leads_from_its_beginning_to_complementarity() -> None:
    """In two stretches, as the search follows it; the second goes on in the sense of the first."""
    path = path_from_pair()
    middle, end = path.follow(1e-2, 500), path.follow(1e-6, 500)
    assert middle.converged
    assert end.converged
    assert end.gap <= 1e-6 < middle.gap <= 1e-2
    # What the search asks of a path before it reads a mechanism from it; the state itself is made exact afterwards.
    assert max(end.statics, end.kinematics) <= Stepping().residual


def test_path_that_stays_beside_its_beginning_is_given_up() -> None:
    end = path_from_pair(Stepping(trial=5, left=1e3)).follow(1e-6, 500)
    assert not end.converged
    assert end.iterations == 5


def test_path_that_comes_back_to_its_beginning_is_given_up() -> None:
    end = path_from_pair(Stepping(left=0.0, back=1e3)).follow(1e-6, 500)
    assert not end.converged
    assert end.iterations <= 5


def path_from_associated_flow(problem: Problem, faded: float) -> ArcPath:
    """A path from a point that is left early on the associated one."""
    newton = NewtonMatrix(problem)
    start = follow_path(problem, newton, start_point(problem), PathSettings(dilatancy=1.0, gap=0.1, residual=1e-6))
    assert start.converged
    return ArcPath(problem, newton, start.point, 1.0, faded)


def test_path_leads_from_associated_flow_to_zero_dilatancy() -> None:
    problem = make_problem(running_bond(28, 16, 0.175, 0.65))
    path = path_from_associated_flow(problem, 1e-3)
    middle, end = path.follow(1e-3, 1000), path.follow(1e-6, 1000)
    assert middle.converged
    assert end.converged
    assert end.gap <= 1e-6 < middle.gap <= 1e-3
    # The strains are measured by what neither the path nor its steps compute: no slip lifts.
    strains = problem.strains(end.point.velocities)
    assert abs(strains[:, :2] - end.point.rates[:, :2]).max() <= Stepping().residual
    assert end.statics <= Stepping().residual


def test_path_does_not_arrive_before_its_dilatancy_has_faded() -> None:
    """The gap alone would end it in associated flow, whose mechanism lifts."""
    problem = make_problem(running_bond(28, 16, 0.175, 0.65))
    end = path_from_associated_flow(problem, 1e-9).follow(1e-2, 40)
    assert end.gap <= 1e-2
    assert not end.converged


def test_tangent_of_the_path_is_that_of_finite_differences() -> None:
    """Two points of the path at neighbouring tau, each found by Newton steps at a dilatancy of its own."""
    problem = make_problem(running_bond(6, 3, 0.175, 0.65))
    newton, tight = NewtonMatrix(problem), close_tight(problem)
    target = np.full((problem.n_interfaces, 4), 1e-2)

    def on_path(point: Point, share: float, tau: float) -> Point:
        for _ in range(40):
            step = NewtonStep(problem, point, share, tight).factorised(newton)
            change = step.direction(tau * target)
            length = min(step.lengths(change, 0.9))
            point = step.advance(change, length, length)
        return point

    settings = PathSettings(dilatancy=1.0, gap=0.1, residual=1e-6)
    here = on_path(follow_path(problem, newton, start_point(problem), settings).point, 0.5, 1.0)
    growth, small = 0.2, 1e-4
    there = on_path(here, 0.5 + growth * small, float(np.exp(small)))
    step = NewtonStep(problem, here, 0.5, tight).factorised(newton)
    tangent = step.direction(2.0 * target, growth).plus(-1.0, step.direction(target))
    assert tangent.multiplier == pytest.approx((there.multiplier - here.multiplier) / small, rel=1e-2)
    difference = (there.rates - here.rates) / small
    assert abs(tangent.rates - difference).max() <= 1e-2 * abs(difference).max()


def test_path_begins_with_forces_and_mechanism_of_the_true_wall() -> None:
    """The sums are those of zero-dilatancy flow, which neither of the two programmes behind the pair solves."""
    problem = make_problem(running_bond(14, 7, 0.175, 0.65))
    pair, steps = interior_starting_point(problem, NewtonMatrix(problem), 1e-2)
    assert pair is not None
    assert steps > 0
    assert np.all(pair.slack > 0.0)
    assert np.all(pair.rates > 0.0)
    assert problem.live @ pair.velocities == pytest.approx(problem.live_work, rel=1e-9)
    # In mean weights of a block, and for velocities of order one.
    assert abs(problem.imbalance(problem.forces_of_slacks(pair.slack), pair.multiplier)).max() <= FEASIBLE
    assert abs(problem.strains(pair.velocities) - problem.strains_of_rates(pair.rates, 0.0)).max() <= FEASIBLE


@pytest.mark.parametrize(("courses", "bricks"), [(6, 3), (14, 16)])
def test_orientation_of_the_path_is_the_sign_of_the_determinant(courses: int, bricks: int) -> None:
    """Of K bordered by the live load, by dense LU; the two sizes are factorised by different libraries."""
    problem = make_problem(running_bond(courses, bricks, 0.2, 2.0))
    newton = NewtonMatrix(problem)
    generator = np.random.default_rng(0)
    signs = set()
    for _ in range(6):
        slack, rates = np.exp(generator.normal(0.0, 3.0, (2, problem.n_interfaces, 4)))
        point = Point(slack, 0.0, np.zeros(problem.n_velocities), rates)
        step = NewtonStep(problem, point, 0.0, close_tight(problem)).factorised(newton)
        dense = problem.statics @ block_diag(*step.compliance.matrices) @ problem.kinematic.toarray()
        live = problem.live[:, None]
        sign = np.linalg.slogdet(np.block([[dense, -live], [live.T, np.zeros((1, 1))]]))[0]
        assert step.orientation() == sign
        signs.add(sign)
    assert len(signs) == 2


def test_path_to_a_tiny_gap_stays_in_equilibrium() -> None:
    """Sliding joints under pressure are what rounding disturbs most; without refined forces it is 1e-3 here."""
    problem = make_problem(running_bond(28, 16, 0.175, 0.65))
    settings = PathSettings(dilatancy=1.0, gap=1e-12, residual=1e-9)
    end = follow_path(problem, NewtonMatrix(problem), start_point(problem), settings)
    assert end.converged
    # In mean weights of a block; rounding of 448 blocks' forces alone is about 1e-13.
    assert end.statics <= 1e-9


def test_vertical_force_on_one_block_of_a_large_wall_is_unbounded() -> None:
    """The interior point meets no end there; forces that bear the live load alone tell."""
    end = EndOfPath(above=40)
    search = LimitAnalysis(Choices(vertices_up_to=40, associated=end))
    wall = running_bond(6, 4, 0.2, 0.65)
    live = np.zeros_like(wall.live)
    live[wall.centroid[:, 1].argmax(), 1] = -1.0
    wall = replace(wall, live=live)
    assert make_problem(wall).n_interfaces > 40
    for method, settings in ((AssociatedLimitAnalysis(end), AssociatedSettings()), (search, SearchSettings())):
        answer = method.solve(wall, settings)
        assert answer.finding == Finding.UNBOUNDED, answer.sentence


def test_what_rests_on_a_moving_block_moves() -> None:
    wall = running_bond(3, 2, 0.2, 0.65)
    lowest = int(np.flatnonzero(~wall.fixed)[np.argmin(wall.centroid[~wall.fixed, 1])])
    moves = with_all_above(wall, np.arange(wall.n_blocks) == lowest)
    above = wall.centroid[moves, 1] > wall.centroid[lowest, 1]
    assert above.sum() == moves.sum() - 1 > 0
    assert not moves[wall.fixed].any()


@pytest.mark.parametrize(
    "source", [ArcPaths(least=100), DilatancyContinuation(least=100)], ids=lambda source: source.name
)
def test_search_of_the_part_that_collapses_gives_states_of_the_whole_wall(source: Source) -> None:
    # With half of the blocks some of these paths arrive with one arithmetic of a processor and not with another.
    problem = make_problem(running_bond(20, 11, 0.175, 0.65))
    search = Search(problem, NewtonMatrix(problem), budget=Budget(SearchLimits(descents=0)))
    explore(search, [source])
    states = search.record.states
    assert states
    for state in states:
        assert state.multiplier <= search.associated.greatest
        assert max(residuals(problem, state).values()) <= 1e-10


@pytest.mark.parametrize("starts", [0, 2])
def test_settings_mean_the_same_where_the_interior_point_solves_the_programmes(starts: int) -> None:
    """Above so many interfaces; `starts` and `failures` were read on smaller walls only."""
    answer = LimitAnalysis(Choices(vertices_up_to=50)).solve(
        running_bond(10, 5, 0.175, 0.65), SearchSettings(effort="quick", starts=starts, failures=3)
    )
    assert answer.finding == Finding.COLLAPSES
    assert answer.multiplier is not None
    assert answer.multiplier <= 0.557416  # of the prototypes, with vertices
    count = {row["source"]: row["states"] for row in answer.details["sources"]}
    assert ("other block weights" in count) is (starts > 0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("courses", "bricks", "by_springs"),
    # Slender, with sharp folds, and wide, with more than a thousand; safe forces led along springs end higher on both.
    [(70, 35, 0.43116), (100, 70, 0.42109)],
)
def test_wall_of_thousands_of_blocks_has_an_exact_state(courses: int, bricks: int, by_springs: float) -> None:
    answer = LimitAnalysis().solve(running_bond(courses, bricks, 0.175, 0.65), SearchSettings())
    assert answer.multiplier is not None
    assert answer.multiplier < by_springs
    assert max(answer.details["residuals"].values()) <= 1e-12


@pytest.mark.slow
def test_facade_is_not_above_the_plateau_of_springs() -> None:
    """It was by a hundredth: no path of springs from gravity was followed above 2,000 interfaces."""
    wall = facade(1, 4, "running", 0.6)
    plateau, _ = solved("fe", wall, histories=(0.0,))
    least, _ = solved("la", wall)
    assert wall.n_interfaces > 2000
    assert plateau.multiplier is not None
    assert least.multiplier is not None
    assert least.multiplier <= plateau.multiplier * (1.0 + ABOVE)


def test_least_state_is_the_most_exact_of_those_that_differ_by_rounding_only() -> None:
    """It was the lowest to the last digit, and a wall had no answer where that one state was not exact enough."""
    problem = make_problem(running_bond(7, 3, 0.4, 0.65))
    state = Search(problem, NewtonMatrix(problem)).interior()
    assert state is not None
    rough = replace(state, multiplier=state.multiplier * (1.0 - 1e-12), velocities=state.velocities * (1.0 + 1e-9))
    lower = replace(rough, multiplier=0.9 * state.multiplier)
    assert max(residuals(problem, state).values()) < max(residuals(problem, rough).values())
    assert least_of(problem, [rough, state]) is state
    assert least_of(problem, [rough, state, lower]) is lower


def test_springs_of_gravity_are_left_out_where_paths_by_arc_length_arrive_on_large_walls() -> None:
    """They took as long as the rest of the search on 990 bricks, and ended higher wherever the others arrived."""
    problem = make_problem(running_bond(20, 11, 0.175, 0.65))
    gravity = LowPrestress(vertices_up_to=10, one_path=100)
    breakpoints = []
    for sources in ([gravity], [ArcPaths(least=100, near=NEAR[1:2]), gravity]):
        search = Search(problem, NewtonMatrix(problem), budget=Budget(SearchLimits(descents=0)))
        explore(search, sources)
        assert search.record.known
        breakpoints.append(search.budget.spent.breakpoints)
    assert breakpoints[0] > 0 == breakpoints[1]


def test_dilatancy_continuation_has_a_state_where_joints_press_under_the_live_load_only() -> None:
    """Between the openings of a facade head joints press that the dead load leaves unloaded."""
    problem = make_problem(facade(1, 4, "running", 0.6))
    search = Search(problem, NewtonMatrix(problem), budget=Budget(SearchLimits(descents=0)))
    explore(search, [ArcPaths(near=NEAR[1:2])])
    assert not search.record.known
    explore(search, [DilatancyContinuation()])
    state = search.record.improvements[-1].state
    assert state.multiplier <= search.associated.greatest
    assert max(residuals(problem, state).values()) <= 1e-10
