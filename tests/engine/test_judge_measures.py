"""What residuals are relative to: loads, whatever contact forces balance each other. Fractions; displaced states."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from harness.engine.judge import judge
from harness.engine.judge_dead_load import IMMENSE
from harness.engine.measures import Measures, exact_sum
from harness.engine.residuals import block_sums, displaced_fault, displaced_residuals, force_residuals
from harness.model.assembly import Assembly
from harness.model.displaced import DisplacedState
from harness.model.method import Answer, Finding, Status
from harness.model.result import Judgement, result_of
from tests.known_walls import WALLS, between, box, of_blocks, wedge
from tests.walls import assembly, stack


def said(wall: Assembly, tolerance: float = 1e-9, **more: object) -> Judgement:
    answer = Answer(Status.OK, Finding.STANDS, "", **more)  # type: ignore[arg-type]
    return judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), tolerance)


def pressed(friction: float, press: float, shear: float) -> tuple[Assembly, np.ndarray]:
    """A block of weight 20 between two supports that press it, with the shear that bears it on either side."""
    wall = between(None, friction)
    onto_b = np.where(wall.block_b == 1, 1.0, -1.0)
    upwards = onto_b * wall.tangent[:, 1]
    return wall, np.column_stack([np.full((2, 2), press / 2.0), shear * upwards])


@pytest.mark.parametrize("press", [40.0, 2.0**20, 2.0**40])
def test_self_stress_of_any_size_is_accepted_if_it_bears_the_loads_exactly(press: float):
    wall, forces = pressed(0.5, press, 10.0)
    assert said(wall, forces=forces).accepted


@pytest.mark.parametrize("press", [40.0, 2.0**20, 2.0**40, 2.0**53])
@pytest.mark.parametrize("missing", [1e-7, 1.0, 20.0])
def test_what_a_load_lacks_is_relative_to_the_load_whatever_presses(press: float, missing: float):
    wall, forces = pressed(0.5, press, 10.0 - missing / 2.0)
    residual = force_residuals(wall, forces, 0.0)["equilibrium"]
    assert residual == pytest.approx(missing / min(40.0, 20.0), rel=1e-6)
    assert said(wall, forces=forces).accepted is False


def test_tension_is_relative_to_the_load_whatever_presses():
    wall = of_blocks([box("l", -1.0, 0.0, fixed=True), box("a", 0.0, 0.0), box("r", 1.0, 0.0, fixed=True)], 0.5, {})
    forces = np.zeros((wall.n_interfaces, 3))
    for p in range(wall.n_interfaces):
        forces[p, :2] = 10.0 if "g" in (wall.block_ids[wall.block_a[p]], wall.block_ids[wall.block_b[p]]) else 2.0**40
    own = np.flatnonzero(wall.fixed[wall.block_a] != wall.fixed[wall.block_b])
    assert said(wall, forces=forces).accepted
    bed = next(p for p in own if forces[p, 0] == 10.0)
    forces[bed, :2] = [20.0 + 1e-6, -1e-6]
    assert force_residuals(wall, forces, 0.0)["yield"] == pytest.approx(1e-6 / 20.0, rel=1e-6)


def test_sums_in_fractions_are_those_of_floating_point():
    wall = assembly({"type": "ring", "inner_radius": 1.0, "outer_radius": 1.2, "count": 7}, 0.5)
    forces = np.random.default_rng(2).normal(size=(wall.n_interfaces, 3))
    sums = block_sums(wall, forces) + wall.dead + 0.3 * wall.live
    for block in wall.free:
        np.testing.assert_allclose(exact_sum(wall, forces, 0.3, int(block)), sums[block], atol=1e-14)


def test_sums_in_fractions_keep_what_floating_point_loses():
    wall, forces = pressed(0.5, 2.0**80, 10.0)
    assert exact_sum(wall, forces, 0.0, 1).tolist() == [0.0, 0.0, 0.0]
    assert exact_sum(wall, forces + np.array([[2.0**30, 2.0**30, 0.0], [0.0] * 3]), 0.0, 1)[0] in (2.0**31, -(2.0**31))


def test_forces_count_up_to_the_loads_of_their_component_alone():
    wall = WALLS["heavy bystander"]()
    light = wall.block_ids.index("a")
    forces = np.full((wall.n_interfaces, 3), 1e9)
    measures = Measures.of(wall, forces, 0.0)
    assert measures.acting[light] == measures.loads[light] == 20.0
    assert measures.immense(wall).tolist() == [light]


def test_block_without_load_has_the_smallest_of_its_component():
    wall = of_blocks([box("a", 0.0, 0.0, weight=3.0), box("b", 0.0, 1.0, weight=0.0), box("c", 0.0, 2.0, weight=7.0)])
    measures = Measures.of(wall, np.zeros((wall.n_interfaces, 3)), 0.0)
    assert measures.own[wall.free].tolist() == [3.0, 3.0, 7.0]
    assert measures.loads[wall.free].tolist() == [10.0, 10.0, 10.0]


def test_light_block_under_a_heavy_one_is_held_to_its_own_load_but_for_rounding():
    wall = of_blocks([box("a", 0.0, 0.0, weight=1.0), box("b", 0.0, 1.0, weight=1e9)], 0.5, {})
    low = next(p for p in range(2) if wall.fixed[wall.block_a[p]] or wall.fixed[wall.block_b[p]])
    forces = np.full((2, 3), [5e8, 5e8, 0.0])
    forces[low, :2] += 0.5
    assert said(wall, forces=forces).accepted
    forces[low, :2] += 0.5e-5
    # It bears 1e9 times its load, and is held to a thousand times that.
    assert force_residuals(wall, forces, 0.0)["equilibrium"] == pytest.approx(1e-5 / 1e3, rel=0.05)
    assert said(wall, forces=forces).accepted is False


@pytest.mark.parametrize("slope", [1e-3, 1e-5, 3e-7])
def test_gain_of_a_fall_exceeds_what_immense_forces_do_on_its_closings(slope: float):
    """A wedge that sinks by 1 closes its joints by the slope: it stands by forces of 1 / (2 slope) of its weight."""
    wall = wedge(slope)
    sinking = np.zeros((3, 3))
    sinking[1, 1] = -1.0
    answer = Answer(Status.OK, Finding.FALLS, "", mechanism=sinking)
    judgement = judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), 1e-2)
    closed = 4.0 * slope / np.hypot(1.0, slope)
    assert judgement.residuals["closing_work"] == pytest.approx(IMMENSE * closed, rel=1e-2)
    assert judgement.accepted is False
    assert judge(between(None), result_of(answer, between(None), case="x", method="h", family="h"), 1e-2).accepted


def at_rest(wall: Assembly) -> DisplacedState:
    """The stack on its bed joints, where it is drawn."""
    above = np.array([[wall.weight[max(a, b) :].sum()] for a, b in zip(wall.block_a, wall.block_b, strict=True)])
    force = np.repeat(0.5 * above, 2, axis=0) * np.repeat(wall.normal, 2, axis=0)
    interface = np.repeat(np.arange(wall.n_interfaces), 2)
    point = np.stack([wall.end1, wall.end2], axis=1).reshape(-1, 2)
    normal = np.repeat(wall.normal, 2, axis=0)
    return DisplacedState(np.zeros((wall.n_blocks, 3)), interface, wall.block_b[interface], point, normal, force)


def moved(state: DisplacedState, block: int, by: list[float]) -> DisplacedState:
    places = state.places.copy()
    places[block] = by
    return replace(state, places=places)


SPOILED: dict[str, tuple[Callable[[DisplacedState], DisplacedState], str]] = {
    "support": (lambda state: moved(state, 0, [0.0, 1e-9, 0.0]), "supports"),
    "beside": (lambda state: replace(state, point=state.point + np.array([0.2, 0.0])), "does not touch"),
    "above": (lambda state: replace(state, point=state.point + np.array([0.0, 0.01])), "does not touch"),
    "within": (
        lambda state: replace(state, point=state.point * [0.5, 1.0] + np.array([0.075, 0.05])),
        "does not touch",
    ),
    "across": (lambda state: replace(state, normal=state.normal[:, ::-1]), "across a face"),
    "inwards": (lambda state: replace(state, normal=-state.normal), "across a face"),
    "long": (lambda state: replace(state, normal=1.2 * state.normal), "not a unit vector"),
    "no joint": (lambda state: replace(state, interface=state.interface - 1), "none of the 3 joints"),
    "other block": (lambda state: replace(state, onto=np.roll(state.onto, 2)), "does not belong to its joint"),
    "one less": (lambda state: replace(state, onto=state.onto[1:]), "one entry each"),
    "not finite": (lambda state: moved(state, 3, [np.nan, 0.0, 0.0]), "finite"),
}


@pytest.mark.parametrize("how", list(SPOILED))
def test_displaced_state_that_is_none_of_the_wall_is_rejected(how: str):
    wall = assembly(stack(3), 0.5, loads={})
    state = at_rest(wall)
    assert displaced_fault(wall, state) == ""
    assert said(wall, details=state.as_details()).accepted
    spoil, words = SPOILED[how]
    assert words in displaced_fault(wall, spoil(state))
    judgement = said(wall, details=spoil(state).as_details())
    assert judgement.accepted is False
    assert words in judgement.sentence


@pytest.mark.parametrize("angle", [-0.3, -0.01, 0.01, 0.3])
def test_block_that_has_turned_about_a_corner_touches_there_and_nowhere_else(angle: float):
    wall = assembly(stack(1), 0.5, loads={})
    corner = max(wall.end1[0], wall.end2[0], key=lambda point: -point[0] * np.sign(angle))
    arm = wall.centroid[1] - corner
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    places = np.array([[0.0, 0.0, 0.0], [*(corner + turn @ arm - wall.centroid[1]), angle]])
    normal = wall.normal[:1]
    state = DisplacedState(places, np.array([0]), wall.block_b[:1], corner[None], normal, normal)
    assert displaced_fault(wall, state) == ""
    other = np.array([[0.3 - corner[0], corner[1]]])
    assert "does not touch" in displaced_fault(wall, replace(state, point=other))


def test_displaced_state_is_relative_to_the_loads_of_its_component():
    wall = of_blocks([box("a", 0.0, 0.0), box("h", 4.0, 0.0, weight=2e11)], 0.5, {})
    state = at_rest(wall)
    force = np.repeat(0.5 * wall.weight[np.maximum(wall.block_a, wall.block_b)], 2)[:, None] * state.normal
    state = replace(state, force=force)
    assert displaced_residuals(wall, state, 0.0) == {"equilibrium": 0.0, "yield": 0.0}
    light = np.flatnonzero(abs(force).max(axis=1) < 100.0)
    lacking = force.copy()
    lacking[light] *= 0.5
    assert displaced_residuals(wall, replace(state, force=lacking), 0.0)["equilibrium"] == pytest.approx(0.5)
    sheared = force.copy()
    sheared[light] += 8.0 * np.array([1.0, 0.0])
    assert displaced_residuals(wall, replace(state, force=sheared), 0.0)["yield"] == pytest.approx(3.0 / 20.0)


def test_no_end_is_shown_from_the_dead_load_on_and_without_violations():
    """A block between rough supports falls, though a live load that presses it holds it at any multiplier from 2 on."""
    wall = WALLS["held by its live load"]()
    bear, names = 4.0, wall.block_ids
    press = next(p for p in range(2) if "r" in (names[wall.block_a[p]], names[wall.block_b[p]]))
    onto_a = 1.0 if names[wall.block_b[press]] == "a" else -1.0
    upwards = onto_a * wall.tangent[press, 1]
    ray, forces = np.zeros((2, 3)), np.zeros((2, 3))
    ray[press] = [10.0, 10.0, 0.0]
    # Moments about the middle of the block: the friction 20 on its face at .5 is balanced by the two compressions.
    low = int(wall.end1[press, 1] > wall.end2[press, 1])
    forces[press] = [0.0, 0.0, 20.0 * upwards]
    forces[press, low], forces[press, 1 - low] = (bear * 10.0 + d for d in (10.0, -10.0))
    if abs(force_residuals(wall, forces, bear)["equilibrium"]) > 1e-12:
        forces[press, [0, 1]] = forces[press, [1, 0]]
    assert max(force_residuals(wall, forces, bear).values()) < 1e-12
    answer = Answer(Status.OK, Finding.UNBOUNDED, "", forces=forces, forces_multiplier=bear)
    answer.details = {"live_forces": ray.tolist()}
    judgement = judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), 1e-9)
    assert judgement.accepted is None
    assert "under the dead load" in judgement.sentence
