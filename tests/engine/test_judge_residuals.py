"""Residuals of states worked out by hand: what each is relative to, and that units and bystanders change none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from harness.engine.judge import judge
from harness.engine.judge_dead_load import IMMENSE
from harness.engine.judge_decision import apart
from harness.engine.measured_motion import TOLERANCE, TOLERANCE_ALONE, motion_faults, motion_residuals
from harness.engine.measures import UNLOADED, Measures, between, magnitudes
from harness.engine.residuals import (
    GAP,
    MOVED,
    OVERLAP,
    collapse_residuals,
    displaced_fault,
    displaced_residuals,
    force_residuals,
    moved_far,
    moving_parts,
)
from harness.model.assembly import Assembly
from harness.model.details import MOVING_FORCES
from harness.model.displaced import DisplacedState
from harness.model.method import Answer, Finding, Status
from harness.model.result import Judgement, result_of
from tests.known_walls import box, of_blocks, push

WEIGHT, WIDTH, HEIGHT = 20.0, 2.0, 1.0
RADIUS = np.hypot(WIDTH, HEIGHT) / 2.0


def block(friction: float = 0.5, tilt: float = 1.0) -> Assembly:
    """A block on the ground, whose live load is a tilt or a part of it."""
    loads = {"live": {"body": [{"per_weight": [tilt, 0.0]}]}}
    return of_blocks([box("a", 0.0, 0.0, WIDTH, HEIGHT, weight=WEIGHT)], friction, loads)


def bed(wall: Assembly, upper: str, left: float, right: float, shear: float) -> np.ndarray:
    """Forces of the joint below a block alone: compression at its left and right end, shear on it to the right."""
    number = wall.block_ids.index(upper)
    p = next(p for p in range(wall.n_interfaces) if number in (wall.block_a[p], wall.block_b[p]))
    onto = 1.0 if wall.block_b[p] == number else -1.0
    ends = [left, right] if wall.end1[p, 0] < wall.end2[p, 0] else [right, left]
    forces = np.zeros((wall.n_interfaces, 3))
    forces[p] = [*ends, onto * np.sign(wall.tangent[p, 0]) * shear]
    return forces


def moving(wall: Assembly, **motions: list[float]) -> np.ndarray:
    mechanism = np.zeros((wall.n_blocks, 3))
    for name, motion in motions.items():
        mechanism[wall.block_ids.index(name)] = motion
    return mechanism


def said(wall: Assembly, answer: Answer, tolerance: float = 1e-9) -> Judgement:
    return judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), tolerance)


@pytest.mark.parametrize("tilt", [1.0, 0.1, 10.0])
def test_sliding_below_the_limit_by_hand_in_any_unit_of_the_live_load(tilt: float):
    """Friction bears .5 of the weight; held at .4 of it, a tenth of the weight is slack where the block slips."""
    wall = block(tilt=tilt)
    forces = bed(wall, "a", 10.0 - 0.4 * WEIGHT * 0.25, 10.0 + 0.4 * WEIGHT * 0.25, -0.4 * WEIGHT)
    found = collapse_residuals(wall, forces, 0.4 / tilt, moving(wall, a=[3.0, 0.0, 0.0]), "non-associated")
    assert found["equilibrium"] == pytest.approx(0.0, abs=1e-15)
    assert found["complementarity"] == pytest.approx(0.1)
    assert found["virtual_work"] == pytest.approx(0.1)
    assert found["sliding"] == pytest.approx(2.0 / 28.0)  # of the loads, weight and .4 of it
    assert found["live_work"] == pytest.approx(tilt)
    answer = Answer(Status.OK, Finding.COLLAPSES, "", 0.4 / tilt, forces=forces, mechanism=moving(wall, a=[3.0, 0, 0]))
    judgement = said(wall, answer, 0.11)
    assert judgement.accepted is None  # a tolerance of a tenth shows nothing
    assert judgement.multiplier_error == pytest.approx((0.1 + 0.1) / tilt)
    beside = replace(answer, multiplier=0.41 / tilt, forces_multiplier=0.4 / tilt)
    assert said(wall, beside, 0.11).multiplier_error == pytest.approx((0.01 + 0.1 + 0.1) / tilt)
    assert said(wall, beside, 0.11).residuals["multiplier"] == pytest.approx(0.01 / 0.41)


@pytest.mark.parametrize("back", [False, True])
def test_slack_counts_on_the_side_that_slips(back: bool):
    wall = block(tilt=-1.0 if back else 1.0)
    way = -1.0 if back else 1.0
    forces = bed(wall, "a", 10.0 - way * 2.0, 10.0 + way * 2.0, -way * 8.0)
    found = collapse_residuals(wall, forces, 0.4, moving(wall, a=[way, 0.0, 0.0]), "non-associated")
    assert found["sliding"] == pytest.approx(2.0 / 28.0)


def test_what_a_rotation_does_is_measured_by_the_farthest_vertex():
    """A heavy block rests beneath one that tips at 2 and is held at 1: only what moves is the unit."""
    low = box("b", 0.0, 0.0, WIDTH, HEIGHT, weight=99.0 * WEIGHT)
    wall = of_blocks([low, box("a", 0.0, HEIGHT, WIDTH, HEIGHT, weight=WEIGHT)], 3.0, push("a"))
    forces = bed(wall, "a", 5.0, 15.0, -WEIGHT)
    below = [p for p in range(2) if not forces[p].any()]
    forces[below] = bed(wall, "b", 985.0, 1015.0, -WEIGHT)[below]
    found = collapse_residuals(wall, forces, 1.0, moving(wall, a=[0.5, 1.0, -1.0]), "non-associated")
    assert found["equilibrium"] == pytest.approx(0.0, abs=1e-15)
    moved = WEIGHT * (np.hypot(0.5, 1.0) + RADIUS)
    live_work = WEIGHT * 0.5
    size = moved / live_work
    assert found["complementarity"] == pytest.approx(5.0 * WIDTH / live_work / size)
    assert found["virtual_work"] == pytest.approx((2.0 - 1.0) / size)


def test_closing_is_relative_to_the_block_that_works_whatever_flies():
    """A block turns about a point a quarter of its width from its right end, which it drives into the ground."""
    high = box("c", 0.0, HEIGHT, WIDTH, HEIGHT, weight=1.0)
    wall = of_blocks([box("a", 0.0, 0.0, WIDTH, HEIGHT, weight=WEIGHT), high], 0.5, push("a"))
    mechanism = moving(wall, a=[0.5, 0.5, -1.0], c=[0.0, 1e6, 0.0])
    found = collapse_residuals(wall, np.zeros((2, 3)), 1.0, mechanism, "non-associated")
    assert found["interpenetration"] == pytest.approx(0.5 / (np.hypot(0.5, 0.5) + RADIUS), rel=1e-6)


def test_unbalanced_moment_tension_and_friction_by_hand():
    wall = block()
    turned = force_residuals(wall, bed(wall, "a", 11.0, 9.0, 0.0), 0.0)
    assert turned == {"equilibrium": pytest.approx(2.0 / RADIUS / WEIGHT), "yield": 0.0}
    assert force_residuals(wall, bed(wall, "a", -1.0, 21.0, 0.0), 0.0)["yield"] == pytest.approx(1.0 / WEIGHT)
    shear = 0.55 * WEIGHT  # .5 of it is friction; loads are weight and tilt
    sheared = force_residuals(wall, bed(wall, "a", 10.0 - 0.25 * shear, 10.0 + 0.25 * shear, -shear), 0.55)
    assert sheared == {"equilibrium": pytest.approx(0.0, abs=1e-15), "yield": pytest.approx(1.0 / (WEIGHT + shear))}


def test_measure_of_a_joint_is_that_of_its_lighter_free_block():
    wall = of_blocks([box("a", 0.0, 0.0), box("b", 0.0, 1.0)])
    scale = np.zeros(3)
    scale[[wall.block_ids.index(name) for name in "gab"]] = [1.0, 5.0, 3.0]
    lower = [p for p in range(2) if wall.fixed[wall.block_a[p]] or wall.fixed[wall.block_b[p]]]
    expected = [3.0, 3.0]
    expected[lower[0]] = 5.0
    assert between(wall, scale).tolist() == expected


def test_loads_that_are_rounding_are_none_and_unloaded_components_have_their_forces():
    wall = of_blocks([box("a", 0.0, 0.0, weight=3.0), box("b", 0.0, 1.0, weight=1e-15), box("c", 0.0, 2.0, weight=7.0)])
    assert Measures.of(wall, np.zeros((3, 3)), 0.0).own[wall.free].tolist() == [3.0, 3.0, 7.0]
    least = of_blocks([box("a", 0.0, 0.0, weight=1e-3), box("b", 0.0, 1.0, weight=2e-15)])
    assert Measures.of(least, np.zeros((2, 3)), 0.0).own[least.free].tolist() == [1e-3, 2e-15]
    bare = replace(wall, dead=np.zeros_like(wall.dead), live=np.zeros_like(wall.live))
    acting = Measures.of(bare, bed(bare, "a", 3.0, 1.0, 2.0), 0.0).acting
    names = dict(zip(bare.block_ids, acting.tolist(), strict=True))
    assert names == {"g": 6.0, "a": 6.0, "b": 6.0 * UNLOADED, "c": 6.0 * UNLOADED}


def test_forces_of_a_thousand_loads_are_summed_in_fractions():
    wall = block()
    for force, immense in ((0.99e3 * WEIGHT, []), (1.01e3 * WEIGHT, [1])):
        assert Measures.of(wall, bed(wall, "a", force, 0.0, 0.0), 0.0).immense(wall).tolist() == immense


def at_rest(wall: Assembly, places: list[float], left: float, right: float, shear: float = 0.0) -> DisplacedState:
    """The single block where it has moved to, borne at both ends of its bed, in the frame of the ground."""
    own = wall.block_ids.index("a")
    moved = np.zeros((wall.n_blocks, 3))
    moved[own] = places
    points = np.array([[0.0, 0.0], [WIDTH, 0.0]]) + places[:2]
    force = np.array([[shear / 2.0, left], [shear / 2.0, right]])
    up = np.array([[0.0, 1.0], [0.0, 1.0]])
    return DisplacedState(moved, np.zeros(2, dtype=np.int64), np.full(2, own), points, up, force)


def test_displaced_forces_have_their_arms_where_the_block_has_moved_to():
    wall = block()
    still = displaced_residuals(wall, at_rest(wall, [0.3, 0.0, 0.0], 10.0, 10.0), 0.0)
    assert still == {"equilibrium": pytest.approx(0.0, abs=1e-15), "yield": 0.0}
    turned = displaced_residuals(wall, at_rest(wall, [0.3, 0.0, 0.0], 11.0, 9.0), 0.0)
    assert turned["equilibrium"] == pytest.approx(2.0 / np.sqrt(WIDTH * HEIGHT) / WEIGHT)
    held = displaced_residuals(wall, at_rest(wall, [0.3, 0.0, 0.0], 8.0, 12.0, -8.0), 0.4)
    assert held == {"equilibrium": pytest.approx(0.0, abs=1e-15), "yield": 0.0}
    lacking = displaced_residuals(wall, at_rest(wall, [0.3, 0.0, 0.0], 8.0, 12.0, 0.0), 0.4)
    assert lacking["equilibrium"] == pytest.approx(8.0 / 28.0)
    torn = displaced_residuals(wall, at_rest(wall, [0.0, 0.0, 0.0], -1.0, 21.0), 0.0)
    assert torn["yield"] == pytest.approx(1.0 / WEIGHT)
    rough = displaced_residuals(wall, at_rest(wall, [0.0, 0.0, 0.0], 10.0, 10.0, -12.0), 0.0)
    assert rough["yield"] == pytest.approx((6.0 - 5.0) / WEIGHT)  # at each of the two contacts


SIZE = np.sqrt(WIDTH * HEIGHT)


@pytest.mark.parametrize("on_ground", [False, True])
@pytest.mark.parametrize(
    ("x", "lift", "touches"),
    [
        (0.0, 0.0, True),
        (0.9, 0.0, True),
        (0.9, 0.9, True),
        (0.9, 1.1, False),
        (-0.1, 0.0, False),
        (WIDTH + 0.1, 0.0, False),
    ],
)
def test_a_force_acts_where_both_blocks_are(x: float, lift: float, touches: bool, on_ground: bool):
    """On the ground or on the block, which is lifted by so much of the gap that counts as a touch."""
    wall = block()
    lift *= GAP * SIZE
    point = np.array([[x, 0.0 if on_ground else lift]] * 2)
    state = replace(at_rest(wall, [0.0, lift, 0.0], 20.0, 0.0), point=point)
    assert (displaced_fault(wall, state) == "") is touches


@pytest.mark.parametrize(("depth", "touches"), [(0.9 * OVERLAP, True), (1.1 * OVERLAP, False)])
def test_soft_blocks_overlap_by_so_much_and_no_more(depth: float, touches: bool):
    wall = block()
    state = at_rest(wall, [0.0, -depth * SIZE, 0.0], 10.0, 10.0)  # the points at its lower ends lie in the ground
    assert (displaced_fault(wall, state) == "") is touches


def test_inside_is_told_at_the_height_of_a_vertex_too():
    """A block with a vertex half-way up each side: its middle is deep within it, wherever vertices lie level."""
    outline = [[0.0, 0.0], [2.0, 0.0], [2.2, 1.0], [2.0, 2.0], [0.0, 2.0], [-0.2, 1.0]]
    wall = of_blocks([{"id": "a", "polygon": outline}], 0.5, {})
    for height in (0.5, 1.0, 1.5):
        state = at_rest(wall, [0.0, -height, 0.0], 10.0, 10.0)
        state = replace(state, point=np.array([[1.0, 0.0], [1.0, 0.0]]))
        assert "does not touch" in displaced_fault(wall, state)


@pytest.mark.parametrize("place", [[SIZE, 0.0, 0.0], [0.0, SIZE, 0.0], [-SIZE, 0.0, 0.0], [0.0, 0.0, -1.0]])
def test_a_state_that_has_moved_by_more_than_the_stated_accuracy_is_of_another_wall(place: list[float]):
    wall = block()
    for share, far in ((0.95, False), (1.05, True)):
        assert moved_far(wall, at_rest(wall, (share * MOVED * np.array(place)).tolist(), 10.0, 10.0)) is far


def test_difference_of_multipliers_is_relative_to_the_larger():
    assert [apart(2.0, 1.0), apart(1.0, 2.0), apart(-1.0, 1.0), apart(0.0, 0.0)] == [0.5, 0.5, 2.0, 0.0]


def test_standing_is_shown_by_forces_unless_nothing_can_move():
    wall = of_blocks([box("a", 0.0, 0.0)], 0.5, {})
    stands = Answer(Status.OK, Finding.STANDS, "")
    assert said(wall, stands).accepted is None
    held = replace(wall, fixed=np.ones(wall.n_blocks, dtype=bool))
    assert said(held, stands).accepted is True


def test_what_an_answer_without_end_lacks_is_named():
    wall = block()
    wall = replace(wall, live=wall.dead)
    forces = bed(wall, "a", 10.0, 10.0, 0.0)
    bare = Answer(Status.OK, Finding.UNBOUNDED, "", forces=forces)
    assert "forces that balance the live load alone" in said(wall, bare).sentence
    loaded = replace(bare, forces=None, details={"live_forces": forces.tolist()})
    assert "forces under the dead load" in said(wall, loaded).sentence
    assert said(wall, loaded).accepted is None


@pytest.mark.parametrize("tilt", [1.0, 1e-3])
def test_an_answer_without_end_is_rejected_where_its_live_load_drives_a_mechanism(tilt: float):
    """A push to the right and down within 0.1 % of the cone of friction, mu .5, is borne 1000 times only."""
    wall = block()
    wall.live[wall.free] = WEIGHT * np.array([0.5 * (1.0 + tilt), -1.0, 0.0])
    claim = Answer(Status.OK, Finding.UNBOUNDED, "", forces=bed(wall, "a", 10.0, 10.0, 0.0), forces_multiplier=0.0)
    assert said(wall, claim).accepted is False
    wall.live[wall.free, 0] *= (1.0 - tilt) / (1.0 + tilt)
    assert said(wall, claim).accepted is None


def test_collapse_without_forces_or_without_a_multiplier_names_what_lacks():
    wall = block()
    forces = bed(wall, "a", 10.0, 10.0, 0.0)
    for answer, words, accepted in (
        (Answer(Status.OK, Finding.COLLAPSES, "", 0.5), "no contact forces", None),
        (Answer(Status.OK, Finding.COLLAPSES, "", None, forces=forces), "no multiplier", False),
        (
            Answer(Status.OK, Finding.COLLAPSES, "", 0.5, forces=forces),
            "no mechanism",
            False,
        ),  # and they do not balance
    ):
        assert said(wall, answer).accepted is accepted
        assert words in said(wall, answer).sentence


def test_a_mechanism_without_live_work_has_no_multiplier():
    wall = block()
    forces = bed(wall, "a", 10.0, 10.0, 0.0)
    found = collapse_residuals(wall, forces, 0.0, moving(wall, a=[0.0, 1.0, 0.0]), "non-associated")
    assert found["live_work"] == 0.0
    assert "virtual_work" not in found
    claim = Answer(Status.OK, Finding.COLLAPSES, "", 0.0, forces=forces, mechanism=moving(wall, a=[0.0, 1.0, 0.0]))
    assert "no work" in said(wall, claim, 10.0).sentence


def falling() -> tuple[Assembly, np.ndarray]:
    """Two smooth supports and a block between that sinks at speed 1 without closing a joint."""
    blocks = [box("l", -1.0, 0.0, fixed=True), box("a", 0.0, 0.0), box("r", 1.0, 0.0, fixed=True)]
    wall = of_blocks([*blocks, box("f", 0.0, -2.0, fixed=True)], 0.0, {})
    return wall, moving(wall, a=[0.0, -1.0, 0.0])


def test_gain_and_closing_of_a_fall_by_hand():
    wall, sinking = falling()
    answer = Answer(Status.OK, Finding.FALLS, "", mechanism=sinking)
    judgement = said(wall, answer)
    assert judgement.accepted
    assert judgement.residuals == {"supports": 0.0, "interpenetration": 0.0, "dead_work": 1.0, "closing_work": 0.0}
    aside = said(wall, replace(answer, mechanism=moving(wall, a=[1e-10, -1.0, 0.0])))
    assert aside.residuals["interpenetration"] == pytest.approx(1e-10)
    assert aside.residuals["closing_work"] == pytest.approx(IMMENSE * 2e-10)  # both ends of the joint on the right
    assert aside.accepted
    wider = said(wall, replace(answer, mechanism=moving(wall, a=[1e-7, -1.0, 0.0])), 1e-3)
    assert wider.residuals["closing_work"] == pytest.approx(2.0)
    assert wider.accepted is False


@pytest.mark.parametrize(("tolerance", "accepted"), [(1e-9, False), (0.0024, False), (0.0025, True)])
def test_a_fall_moves_no_support_by_more_than_the_tolerance(tolerance: float, accepted: bool):
    wall, sinking = falling()
    sinking[wall.block_ids.index("f"), 0] = 0.0025
    judgement = said(wall, Answer(Status.OK, Finding.FALLS, "", mechanism=sinking), tolerance)
    assert judgement.residuals["supports"] == 0.0025
    assert judgement.accepted is accepted


@pytest.mark.parametrize(("share", "accepted"), [(1e-13, True), (1e-10, False)])
def test_what_forces_without_end_violate_is_held_to_rounding_whatever_the_tolerance(share: float, accepted: bool):
    wall = of_blocks(
        [box("a", 0.0, 0.0, WIDTH, HEIGHT, weight=WEIGHT)], 0.5, {"live": {"body": [{"per_weight": [0, -1]}]}}
    )
    forces = bed(wall, "a", 10.0, 10.0, 0.0)
    answer = Answer(Status.OK, Finding.UNBOUNDED, "", forces=forces, forces_multiplier=0.0)
    answer.details = {"live_forces": ((1.0 + share) * forces).tolist()}
    judgement = said(wall, answer, 1e-3)
    assert judgement.accepted is accepted
    assert ("live_equilibrium" in judgement.sentence) is not accepted


def test_magnitude_of_a_load_counts_its_moment_at_the_farthest_vertex():
    wall = block()
    load = np.zeros((wall.n_blocks, 3))
    load[wall.block_ids.index("a")] = [3.0, -4.0, -2.0 * RADIUS]
    assert magnitudes(wall, load).sum() == pytest.approx(5.0 + 2.0)


def test_components_at_rest_are_none_that_move():
    wall = of_blocks([box("a", 0.0, 0.0), box("b", 4.0, 0.0)])
    slides = moving(wall, a=[2.0, 0.0, 0.0])
    supports, parts = moving_parts(wall, slides, 0.0)
    assert supports == 0.0
    assert [abs(motion).max() for _, motion in parts] == [1.0]
    assert moving_parts(wall, moving(wall, g=[1.0, 0.0, 0.0]), 0.0) == (1.0, [])


def test_loads_lose_nothing_on_a_block_without_load():
    bare = of_blocks([box("a", 0.0, 0.0, weight=0.0), box("b", 4.0, 0.0)])
    residuals = motion_residuals(bare, moving(bare, a=[1.0, 0.0, 0.0]), 0.4, None)
    assert residuals == {"motion_supports": 0.0, "motion_interpenetration": 0.0, "motion_against_loads": 0.0}


def test_measured_motion_by_hand():
    """A block that is held at .4 of its weight by friction of .5 slides: what is slack is 2 of 28."""
    wall = block()
    forces = bed(wall, "a", 8.0, 12.0, -8.0)
    slides = motion_residuals(wall, moving(wall, a=[2.0, 0.0, 0.0]), 0.4, forces)
    assert slides == pytest.approx(
        {
            **{"motion_supports": 0, "motion_interpenetration": 0, "motion_against_loads": 0},
            **{"motion_opening": 0, "motion_sliding": 2.0 / 28.0},
        }
    )
    lifts = motion_residuals(wall, moving(wall, a=[0.0, 1.0, 0.0]), 0.4, forces)
    assert lifts["motion_opening"] == pytest.approx(12.0 / 28.0)
    slow = motion_residuals(wall, moving(wall, a=[1.0, 0.01, 0.0]), 0.4, forces)
    assert slow["motion_opening"] == pytest.approx(0.01, rel=1e-3)
    sinks = motion_residuals(wall, moving(wall, a=[1.0, -0.01, 0.0]), 0.4, None)
    assert sinks == pytest.approx(
        {"motion_supports": 0, "motion_interpenetration": 0.01, "motion_against_loads": 0}, rel=1e-3
    )
    # The weight 20 and the load 8 add 21.54; driven back, the load loses 8 on it.
    back = motion_residuals(wall, moving(wall, a=[-1.0, 0.0, 0.0]), 0.4, None)
    assert back["motion_against_loads"] == pytest.approx(8.0 / np.hypot(20.0, 8.0))


def test_a_motion_with_its_forces_is_held_to_more():
    wall = block()
    share = 0.5 * (TOLERANCE + TOLERANCE_ALONE)
    sinks = moving(wall, a=[1.0, -share, 0.0])
    forces = bed(wall, "a", 7.5, 12.5, -10.0)
    assert motion_faults(wall, sinks, 0.5, {})[1] == ""
    assert "motion_interpenetration" in motion_faults(wall, sinks, 0.5, {MOVING_FORCES: forces.tolist()})[1]
