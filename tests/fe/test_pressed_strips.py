"""Joints that crush, without dilatancy: exact states of their stress blocks, and walls set in for them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import answered, judge
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.method import Answer, Finding, Status
from harness.model.method_registry import check_takes, load_method
from harness.model.result import Result, residual_of, result_of
from harness.model.wall import Wall
from methods.numerics.pressed_state import exact_state, moving_rates
from methods.numerics.stress_blocks import pressed_shares
from tests.bonded_walls import BOND
from tests.cooked import KINDS
from tests.known_claims import SLACK, TOLERANCE
from tests.known_walls import Item
from tests.pressed_walls import DIGITS, SEMICIRCLES, arch, at_ends, found, set_in
from tests.walls import assembly, running_bond, stack, wall_data

TAKE = ("fe", "la")
SHORT: dict[str, dict[str, Any]] = {"fe": {}, "la": {"effort": "quick"}}
"""Settings for walls of many joints: the short search of `la` reaches the known values too."""


@cache
def wall_of_bricks(strength: float) -> Assembly:
    return assembly(BOND, 0.65, unit_weight=1.0, compressive_strength=strength)


@pytest.mark.parametrize("name", TAKE)
@pytest.mark.parametrize(("height", "value"), [(2.0, 0.16), (4.0, 0.06), (8.0, 0.01)])
def test_pier_overturns_about_the_edge_of_its_pressed_strip(name: str, height: float, value: float):
    """b / H - gamma b / f_c; the highest presses .8 of its joint, more than half."""
    wall = assembly(stack(1, 0.4, height), 1.0, compressive_strength=200.0)
    assert found(name, wall).multiplier == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize("name", TAKE)
def test_pier_that_its_weight_crushes_falls_though_the_live_load_would_lift_it(name: str):
    """The weight presses its base by 80, more than 60; three tenths of it lifted, the pier would stand."""
    lift = {"live": {"body": [{"per_weight": [-0.02, 1.0]}]}}
    wall = assembly(stack(1, 0.4, 4.0), 1.0, compressive_strength=60.0, loads=lift)
    assert found(name, wall).finding is Finding.FALLS


@pytest.mark.parametrize("name", TAKE)
def test_tension_widens_the_pressed_strip(name: str):
    wall = assembly(stack(1, 0.4, 2.0), 1.0, cohesion=8.0, tensile_strength=4.0, compressive_strength=200.0)
    force = 16.0 + 1.6
    result = found(name, wall)
    assert result.multiplier == pytest.approx((force * 0.4 - force**2 / 204.0) / 32.0, rel=1e-12)
    residual = residual_of(result)
    assert residual is not None
    assert residual.multiplier == pytest.approx(0.16, rel=1e-12)


@pytest.mark.parametrize(("thickness", "strength", "value"), SEMICIRCLES)
def test_semicircle_that_does_not_slide_has_one_limit(thickness: float, strength: float | None, value: float):
    """Without slips the flow is associated, so that the values of the cone programme hold."""
    assert found("fe", arch(thickness, strength)).multiplier == pytest.approx(value, abs=DIGITS)


SEARCHED = [pytest.param(*row, marks=[] if row[1] == 5.0 else pytest.mark.slow) for row in SEMICIRCLES]
"""Each search of `la` takes two seconds."""


@pytest.mark.parametrize(("thickness", "strength", "value"), SEARCHED)
def test_least_known_state_of_a_semicircle_that_does_not_slide(thickness: float, strength: float | None, value: float):
    assert found("la", arch(thickness, strength), **SHORT["la"]).multiplier == pytest.approx(value, abs=DIGITS)


@pytest.mark.parametrize("name", TAKE)
@pytest.mark.parametrize(("thickness", "least"), [(0.15, 4.1981), (0.2, 2.6466)])
def test_semicircle_falls_below_the_least_strength_and_stands_above(name: str, thickness: float, least: float):
    for live in ({"loads": {}}, {}):
        assert found(name, arch(thickness, least - 1e-3, **live)).finding is Finding.FALLS
    assert found(name, arch(thickness, 1.03 * least, loads={})).finding is Finding.STANDS


@pytest.mark.parametrize("name", TAKE)
def test_wall_of_bricks_slides_and_crushes_below_the_associated_maximum(name: str):
    result = found(name, wall_of_bricks(100.0), **SHORT[name])
    assert result.flow == "non-associated"
    assert result.multiplier == pytest.approx(0.5515217391, abs=1e-9)
    assert result.multiplier < 0.571732


def test_random_walls_lie_below_the_associated_maximum():
    generator = np.random.default_rng(8)
    answers = 0
    for _ in range(12):
        friction, strength = float(generator.uniform(0.4, 0.9)), float(10.0 ** generator.uniform(2.0, 3.5))
        cohesion = float(generator.uniform(0.0, 3.0))
        tension = float(generator.uniform(0.0, 1.0) * cohesion / friction)
        law = {"default": friction, "dilatancy": float(generator.choice([0.0, generator.uniform(0.0, friction)]))}
        law |= {"cohesion": cohesion, "tensile_strength": tension, "compressive_strength": strength}
        wall = assembly(running_bond(*generator.integers(2, 5, 2).tolist()), law)
        greatest = found("la-associated", wall).multiplier
        result, judgement = answered(load_method("fe"), wall)
        if result.status is Status.OK:
            answers += 1
            assert judgement.accepted, judgement.sentence
            assert greatest is not None
            assert result.multiplier is not None
            assert result.multiplier <= greatest * (1.0 + 1e-6)
    assert answers == 12


def test_full_dilatancy_leads_to_the_associated_maximum():
    law = {"default": 0.65, "dilatancy": 0.65, "compressive_strength": 100.0}
    wall = assembly(BOND, law, unit_weight=1.0)
    for name in TAKE:
        assert found(name, wall, **SHORT[name]).multiplier == pytest.approx(0.571732, abs=5e-7)


def pressed_evenly() -> Assembly:
    """A block of weight 4 under a live load of 4 on a joint that crushes at 40."""
    loads = {"live": {"body": [{"per_weight": [0, -1]}]}}
    return assembly(stack(1, 1.0, 0.2), 0.5, compressive_strength=40.0, loads=loads)


@pytest.mark.parametrize("name", TAKE)
def test_load_that_presses_evenly_crushes_the_joint_below(name: str):
    assert found(name, pressed_evenly()).multiplier == pytest.approx(9.0, rel=1e-9)


@pytest.mark.parametrize("tension", [0.0, 20.0])
@pytest.mark.parametrize("block", ["v2", "v4"])
def test_wheel_beside_the_springing_crushes_the_arch(block: str, tension: float):
    """No load of it moves a ring of joints that do not crush, and statics alone gave a number."""
    ring = {"type": "ring", "inner_radius": 2.0, "outer_radius": 2.4, "count": 15}
    corner = build(Wall.model_validate(wall_data(ring, 0.6))).assembly
    top = corner.polygons[corner.block_ids.index(block)]
    at = top[np.argsort(np.hypot(*top.T))[-2:]].mean(axis=0)
    wheel = {"live": {"points": [{"block": block, "at": at.tolist(), "force": [0, -50]}]}}
    wall = assembly(
        ring, 0.6, loads=wheel, thickness=3.0, compressive_strength=2000.0, tensile_strength=tension, cohesion=50.0
    )
    greatest = found("la-associated", wall).multiplier
    for name in TAKE:
        assert found(name, wall).multiplier == pytest.approx(greatest, rel=1e-6)


def test_load_borne_by_joints_that_do_not_crush_has_no_end():
    loads = {"live": {"body": [{"per_weight": [0, -1]}]}}
    pattern = running_bond(2, 2)
    friction = {"default": 0.5, "rules": [{"joint": "head", "value": 0.5, "compressive_strength": 40.0}]}
    assert found("fe", assembly(pattern, friction, loads=loads)).finding is Finding.UNBOUNDED


def test_brittle_joints_that_crush_are_refused():
    wall = assembly(stack(1, 0.4, 2.0), 1.0, cohesion=8.0, compressive_strength=200.0, after="residual")
    with pytest.raises(
        InputError, match="fe takes brittle joints without compressive strength; that between"
    ) as refused:
        check_takes(load_method("fe"), wall)
    assert "(la, la-associated, la-associated-cvxpy)" in refused.value.remedy
    with pytest.raises(InputError, match="de takes joints that keep their strength") as refused:
        check_takes(load_method("de"), wall)
    assert "(la, la-associated, la-associated-cvxpy)" in refused.value.remedy, "fe would refuse it too"


def test_components_are_put_together_with_forces_within_their_stress_blocks():
    def pier(name: str, x: float, height: float) -> list[dict[str, Any]]:
        ground = [[x, -1], [x + 0.4, -1], [x + 0.4, 0], [x, 0]]
        box = [[x, 0], [x + 0.4, 0], [x + 0.4, height], [x, height]]
        return [{"id": f"g{name}", "polygon": ground, "fixed": True}, {"id": name, "polygon": box}]

    data = wall_data({}, 1.0, compressive_strength=200.0, blocks=pier("low", 0.0, 2.0) + pier("high", 3.0, 4.0))
    del data["pattern"]
    assert found("fe", build(Wall.model_validate(data)).assembly).multiplier == pytest.approx(0.06, rel=1e-9)


def test_tie_holds_a_pier_that_crushes():
    """lambda = b / H - gamma b / f_c + 2 T_y z / (W H): the tie pulls level, and does not press the joint."""
    data = wall_data(stack(1, 0.4, 2.0), 1.0, compressive_strength=200.0)
    post = {"id": "post", "polygon": [[-2, 1], [-1, 1], [-1, 2], [-2, 2]], "fixed": True}
    box = [[0, 0], [0.4, 0], [0.4, 2], [0, 2]]
    ground = [[-1, -1], [1, -1], [1, 0], [-1, 0]]
    del data["pattern"]
    data["blocks"] = [{"id": "g", "polygon": ground, "fixed": True}, {"id": "pier", "polygon": box}, post]
    data["ties"] = [
        {"from": {"block": "post", "at": [-1, 1.8]}, "to": {"block": "pier", "at": [0, 1.8]}, "yield_force": 2}
    ]
    built = build(Wall.model_validate(data)).assembly
    for name in TAKE:
        assert found(name, built).multiplier == pytest.approx(0.16 + 2 * 2 * 1.8 / (16 * 2), rel=1e-9)


def test_joint_set_in_has_the_limit_of_the_stress_block_by_hand():
    """F0 = 8 under N = 2 presses a quarter, so that the ends are set in by an eighth, and M <= N (1 - 1/4) L / 2."""
    wall = replace(assembly(stack(1, 1.0, 0.2), 0.5), crushing=np.array([8.0]))
    share = pressed_shares(wall, np.array([[1.5, 0.5, 0.0]]))
    assert share == pytest.approx([0.25])
    inner = set_in(wall, share)
    assert inner.length == pytest.approx(0.75 * wall.length)
    assert not inner.crushes
    assert at_ends(share, np.array([[0.0, 2.0, 0.3]])) == pytest.approx(np.array([[0.25, 1.75, 0.3]]))


def test_state_is_exact_at_once_where_the_joints_that_move_are_known():
    wall = arch(0.2, 5.0)
    rigid = replace(wall, crushing=np.full(wall.n_interfaces, np.inf))
    fe = load_method("fe")
    start = fe.solve(rigid, fe.Settings())
    assert start.forces is not None
    assert start.mechanism is not None
    state = exact_state(wall, start.forces, moving_rates(rigid, start.mechanism) > 0.0)
    if state is None:  # other voussoirs turn where joints crush: one step further they are those
        share = pressed_shares(wall, start.forces)
        start = fe.solve(set_in(wall, share), fe.Settings())
        assert start.forces is not None
        assert start.mechanism is not None
        state = exact_state(
            wall, at_ends(share, start.forces), moving_rates(set_in(wall, share), start.mechanism) > 0.0
        )
    assert state is not None
    assert state.multiplier == pytest.approx(0.1445606, abs=DIGITS)


CHANGES = ("forces", "multiplier", "mechanism", "weaker", "set in", "lifted", "more friction", "less")


@pytest.mark.parametrize("change", CHANGES)
def test_wrong_answers_are_rejected(change: str):
    wall = wall_of_bricks(100.0)
    result = found("fe", wall)
    assert result.multiplier is not None
    changed, judged = result, wall
    rigid = replace(wall, crushing=np.full(wall.n_interfaces, np.inf))
    if change == "forces":  # those without crushing, in equilibrium at their own multiplier
        other = found("fe", rigid)
        changed = result.model_copy(
            update={"forces": other.forces, "multiplier": other.multiplier, "forces_multiplier": other.multiplier}
        )
    elif change in ("multiplier", "less"):
        other_value = result.multiplier * (1.0 + (1e-5 if change == "multiplier" else -1e-5))
        changed = result.model_copy(update={"multiplier": other_value, "forces_multiplier": other_value})
    elif change == "mechanism":  # hinges at the ends of joints
        changed = result.model_copy(update={"mechanism": found("fe", rigid).mechanism})
    elif change == "set in":  # hinges in the middle of the pressed strips, where their forces act
        inner = set_in(wall, pressed_shares(wall, np.asarray(result.forces)))
        changed = result.model_copy(update={"mechanism": found("fe", inner).mechanism})
    elif change == "lifted":
        changed = result.model_copy(update={"flow": "associated"})
    elif change == "more friction":
        judged = replace(wall, friction=0.999 * wall.friction)
    else:
        judged = replace(wall, crushing=0.999 * wall.crushing)
    assert judge(judged, changed, 1e-8).accepted is False


@cache
def _crushing_item(name: str) -> Item:
    """A wall whose joints crush and of which the one multiplier is known, with the answers of methods."""
    wall, value = {
        "pier": (assembly(stack(1, 0.4, 2.0), 1.0, compressive_strength=200.0), 0.16),
        "arch": (arch(0.2, 20.0), 0.25304332818616),
    }[name]
    answers: list[Answer] = []
    for method in ("la", "la-associated", "fe"):
        chosen = load_method(method)
        answers.append(chosen.solve(wall, chosen.Settings(**SHORT.get(method, {}))))
    return Item(wall, False, value, value, 1.0, tuple(answers))


@pytest.mark.parametrize("name", ["pier", "arch"])
def test_no_cooked_answer_of_a_wall_whose_joints_crush_is_accepted(name: str):
    it, tried, accepted = _crushing_item(name), 0, list[tuple[int, str, Finding]]()
    for number in range(4 * len(KINDS)):
        kind = KINDS[number % len(KINDS)]
        answer = kind(np.random.default_rng(number), it)
        # What the judge grants joints that crush between forces and mechanism is its stated 1e-6, twice over here.
        if answer is not None and it.denies(answer, 10.0 * SLACK):
            tried += 1
            if judge(it.wall, _result(answer, it.wall), TOLERANCE).accepted:
                accepted.append((number, kind.__name__, answer.finding))
    assert accepted == []
    assert tried > len(KINDS)
    for answer in it.states:
        assert judge(it.wall, _result(answer, it.wall), 1e-8).accepted


def _result(answer: Answer, wall: Assembly) -> Result:
    return result_of(answer, wall, case="x", method="hand", family="hand")
