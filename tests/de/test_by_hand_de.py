"""Contacts of one block by hand: springs in its gaps, a corner that it stands on, and what a search cut short says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from pydantic import ValidationError

from harness.model.assembly import IntArray
from harness.model.method import Answer, Finding, Status
from methods.de.answers import solve_by_holds
from methods.de.damped_holds import DampedHolds, ReleasedCollapse
from methods.de.engines.edges import FacingEdges
from methods.de.engines.engine import Engine
from methods.de.engines.mass_scaling import MassScaling, number_of_courses
from methods.de.engines.pymunk_blocks import PymunkBlocks, convex_parts
from methods.de.engines.pymunk_joints import PymunkJoints
from methods.de.engines.sequential_impulses import SequentialImpulses
from methods.de.engines.soft_wall import SoftWall
from methods.de.engines.strips import CannotModel, require_lengths
from methods.de.settings import ReleaseSettings, SoftSettings, SweepSettings
from methods.de.soft import SHARE, DeformableJoints, Holds, fall_above, saying_soft
from methods.de.uneven.gapped import GappedTuning, GappedWall
from methods.de.uneven.settled_contacts import POINT, with_contacts
from tests.walls import assembly, running_bond, stack


@pytest.mark.parametrize("size", [0.2, 200.0])
def test_contacts_with_gaps_bear_the_loads_of_two_blocks_at_rest(size: float):
    """Each of weight W and twice as wide as high, pushed by W / 4, which their joints bear by friction .5."""
    wall = assembly(stack(2, 2.0 * size, size), 0.5)
    gapped = GappedWall(wall, wall.polygons, np.zeros((wall.n_blocks, 3)), 0.5)
    assert gapped.rests(0.25)
    state = gapped.state()
    assert state.interface.tolist() == [0, 0, 1, 1]
    borne = np.zeros((wall.n_blocks, 2))
    pairs = np.stack([wall.block_a, wall.block_b], axis=1)[state.interface]
    for onto, pair, force in zip(state.onto, pairs, state.force, strict=True):
        borne[onto] += force
        borne[pair[pair != onto]] -= force
    loads = wall.dead + 0.25 * wall.live
    assert borne[wall.free] == pytest.approx(-loads[wall.free, :2], rel=1e-6)
    # Springs of 1e4 W a length scale: W on each below, half of W on each above; so little is found in one motion.
    sinks = np.array([1.0, 1.5]) / GappedTuning().stiffness
    assert not gapped.rest.places.any()
    assert -gapped.rest.moved[wall.free, 1] / wall.length_scale == pytest.approx(sinks, rel=1e-6)
    assert gapped.drift >= sinks[1] * (1.0 - 1e-6)


def test_a_block_on_its_corner_has_a_short_contact_about_that_corner():
    """Turned by a hundredth about its lower left corner; methods need two contact points, so the joint is short."""
    wall = assembly(stack(1, 0.4, 0.2), 0.5)
    block, turn = int(wall.free[0]), 0.01
    corner = wall.polygons[block].min(axis=0)
    arm = wall.centroid[block] - corner
    turned = np.array([np.cos(turn) * arm[0] - np.sin(turn) * arm[1], np.sin(turn) * arm[0] + np.cos(turn) * arm[1]])
    places = np.zeros((wall.n_blocks, 3))
    places[block] = [*(turned - arm), turn]
    space = PymunkBlocks(wall)
    space.put(places)
    space.advance(1)
    structure, single = with_contacts(wall, space, space.places())
    assert (single, structure.n_interfaces) == (1, 1)
    assert structure.length == pytest.approx([POINT * wall.length_scale])
    middle = 0.5 * (structure.end1[0] + structure.end2[0])
    assert middle == pytest.approx(corner, abs=0.01 * wall.length_scale)
    along = structure.end2[0] - structure.end1[0]
    assert along @ structure.normal[0] == pytest.approx(0.0, abs=1e-12)


def test_a_search_that_runs_out_of_work_says_how_wide_its_brackets_are():
    """The widest of the brackets, beside the highest multiplier at which the wall moved: held at .4, moved at .8."""
    wall = assembly(stack(1, 0.4, 0.2), 0.5)
    coarse = SweepSettings(orders=1, load_step=0.4, load_growth=0.5, work=100)
    answer = DampedHolds().solve(wall, coarse)
    (row,) = answer.details["orders"]
    assert (row["held"], row["moving"]) == pytest.approx((0.4, 0.8))
    assert answer.status is Status.NOT_CONVERGED
    assert answer.sentence.endswith("0 orders without a moving state, widest bracket 50 %")
    more = DampedHolds().solve(wall, coarse.model_copy(update={"work": 10_000}))
    assert more.status is Status.OK
    assert "not converged" not in more.sentence


def test_of_tunings_that_do_not_converge_the_one_with_the_narrower_bracket_is_reported():
    """One holds all it is asked until its work is over, on a wall with a tenth of the live load; one moves at .8."""
    wall = assembly(stack(1, 0.4, 0.2), 0.5)
    little = replace(wall, live=0.1 * wall.live)
    slow, quick = MassScaling(0.4, 0.98), MassScaling(0.0, 0.95)
    coarse = SweepSettings(orders=1, load_step=0.4, load_growth=0.5, work=50)

    def engine(blocks: IntArray, joints: IntArray, tuning: MassScaling) -> Engine:
        return SequentialImpulses(little if tuning == slow else wall, blocks, joints, coarse.iterations, tuning)

    for candidates in ([slow, quick], [quick, slow]):
        answer = solve_by_holds(wall, coarse, engine, 1e-6, candidates)
        assert answer.bracket == pytest.approx((0.4, 0.8))
    assert solve_by_holds(wall, coarse, engine, 1e-6, [slow]).bracket is None


@pytest.mark.parametrize("kind", [PymunkJoints, SequentialImpulses])
def test_a_moment_on_a_block_presses_one_end_of_its_joint(kind: type[PymunkJoints] | type[SequentialImpulses]):
    """A block of width b and weight W under a moment W b / 8: its ends bear W / 2 less and more an eighth of W."""
    wall = assembly(stack(1, 0.4, 0.2), 0.5)
    block = int(wall.free[0])
    weight = float(wall.weight[block])
    live = np.zeros_like(wall.live)
    live[block, 2] = 0.4 * weight / 8.0
    turned = replace(wall, live=live)
    engine = kind(turned, wall.free, np.arange(wall.n_interfaces), 50, MassScaling(0.0, 0.9))
    engine.load(1.0)
    engine.advance(300)
    forces = engine.contact_forces()[0]
    assert np.sort(forces[:2]) == pytest.approx([0.375 * weight, 0.625 * weight], rel=1e-3)
    assert forces[2] == pytest.approx(0.0, abs=1e-3 * weight)


def test_a_wall_that_stands_is_not_released():
    wall = assembly(stack(1, 0.4, 0.2), 0.5, loads={"live": None})
    answer = ReleasedCollapse().solve(wall, ReleaseSettings(orders=1))
    assert answer.finding is Finding.STANDS
    assert "release" not in answer.details


def test_an_interface_without_length_is_refused():
    wall = assembly(stack(2, 0.4, 0.2), 0.5)
    require_lengths(wall)
    with pytest.raises(CannotModel, match="length"):
        require_lengths(replace(wall, end2=wall.end1.copy()))


def test_a_tenth_of_the_live_load_is_raised_in_ten_times_the_steps_of_its_multiplier():
    wall = assembly(stack(1, 0.4, 0.2), 0.5)
    whole = DeformableJoints().solve(wall, SoftSettings())
    tenth = DeformableJoints().solve(replace(wall, live=0.1 * wall.live), SoftSettings())
    assert tenth.path["multiplier"] == pytest.approx(10.0 * np.array(whole.path["multiplier"]), rel=1e-9)
    assert tenth.bracket == pytest.approx(10.0 * np.array(whole.bracket), rel=1e-9)


def test_edges_of_blocks_that_have_not_moved_are_the_joints_of_the_wall_upright_ones_too():
    wall = assembly(running_bond(2, 2), 0.5)
    assert (wall.normal == 0.0).any(axis=0).all()
    where, openings = FacingEdges.of(wall, wall.polygons).at(np.zeros((wall.n_blocks, 3)))
    assert where.normal == pytest.approx(wall.normal, abs=1e-12)
    assert np.sort([where.end1, where.end2], axis=0) == pytest.approx(np.sort([wall.end1, wall.end2], axis=0))
    assert openings == pytest.approx(np.zeros((wall.n_interfaces, 2)), abs=1e-12)


def test_a_convex_outline_is_its_own_part_and_others_are_divided_without_loss():
    rectangle = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])
    assert convex_parts(rectangle) == [[tuple(point) for point in rectangle.tolist()]]
    hook = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]])
    parts = [shapely.Polygon(part) for part in convex_parts(hook)]
    assert len(parts) > 1
    assert all(part.convex_hull.area == pytest.approx(part.area) for part in parts)
    assert sum(part.area for part in parts) == pytest.approx(4.0)
    assert shapely.union_all(parts).equals(shapely.Polygon(hook))


def test_a_wall_has_as_many_courses_as_its_tallest_part_and_at_least_one():
    courses = [np.array(course, dtype=np.int64) for course in ([1, 2, 3, 1], [1, 1], [])]
    assert [number_of_courses(course) for course in courses] == [3, 1, 1]


@pytest.mark.parametrize("name", ["held_residual", "moving_residual", "force_residual"])
def test_residuals_that_a_user_may_ask_for_are_shares_of_the_weight(name: str):
    assert getattr(SweepSettings(**{name: 0.999}), name) == 0.999
    for value in (0.0, 1.0, 1.5):
        with pytest.raises(ValidationError, match=name):
            SweepSettings(**{name: value})


@pytest.mark.parametrize(("lean", "words"), [(0.052, "rigid ones would bear about +5.2 %"), (-0.031, "about -3.1 %")])
def test_an_answer_says_by_how_much_rigid_joints_would_change_it(lean: float, words: str):
    """The lean is the share of the multiplier that the deformation of the joints takes."""
    found = Answer(Status.OK, Finding.COLLAPSES, "fell", 0.4, details={"lean": lean})
    assert words in saying_soft(found, SoftSettings(lean=0.03)).sentence
    assert found.details["soft_joints"] is True
    firm = Answer(Status.OK, Finding.COLLAPSES, "fell", 0.4, details={"lean": lean})
    assert saying_soft(firm, SoftSettings(lean=0.06)).sentence == "fell"
    assert firm.details["soft_joints"] is False


def test_the_fall_above_a_multiplier_is_sought_by_rises_that_double():
    """From .45 by .9e-3, 1.8e-3 and so on: the block slides at .5, between .45 + 28.8e-3 and .45 + 57.6e-3."""
    wall = assembly(stack(1, 0.4, 0.2), 0.5)
    holds = Holds(SoftWall(wall, 1e4, 0.5, 1e-3), SoftSettings())
    assert holds.rests(0.0)
    assert fall_above(holds, 0.45, 1.0) == pytest.approx(0.45 + 64 * SHARE * 0.45)
    assert fall_above(holds, 0.45, 0.48) is None
