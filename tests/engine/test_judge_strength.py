"""The judge on joints with cohesion and tensile strength: right states pass, and wrong strength is found out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from harness.engine.judge import answered, judge
from harness.engine.residuals import force_residuals
from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding, Status
from harness.model.method_registry import load_method
from harness.model.result import Judgement, Result, result_of
from tests.walls import assembly, stack

BOND = {"type": "running_bond", "block_length": 1.0, "block_height": 0.5, "count": 6, "bricks": 3}
WALLS: dict[str, Callable[[], Assembly]] = {
    "slides": lambda: assembly(stack(2, 1.0, 0.2), 0.5, cohesion=1.0),
    "topples": lambda: assembly(stack(2, 0.4, 1.0), 1.0, cohesion=8.0, tensile_strength=4.0),
    "bond": lambda: assembly(BOND, 0.65, unit_weight=1.0, cohesion=0.05, tensile_strength=0.025),
}
METHODS = ("la", "la-associated")


@cache
def state(name: str, method: str) -> tuple[Assembly, Result]:
    wall = WALLS[name]()
    result, judgement = answered(load_method(method), wall)
    assert judgement.accepted
    return wall, result


def strong(wall: Assembly, factor: float) -> Assembly:
    return replace(wall, constant=factor * wall.constant)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", WALLS)
@pytest.mark.parametrize("factor", [0.0, 0.999, 1.001, 2.0])
def test_a_state_of_other_strength_is_rejected(name: str, method: str, factor: float):
    """The state is right where the strength is that of the wall: left out, doubled or a little off it is none."""
    wall, result = state(name, method)
    assert judge(wall, result, 1e-9).accepted
    said = judge(strong(wall, factor), result, 1e-9)
    assert said.accepted is False
    assert max(said.residuals[key] for key in ("yield", "dilatancy", "sliding", "complementarity")) > 1e-6


@pytest.mark.parametrize("method", METHODS)
def test_an_answer_of_the_dry_wall_is_rejected(method: str):
    dry, result = state_of_dry(method)
    assert judge(dry, result, 1e-9).accepted
    assert judge(WALLS["bond"](), result, 1e-9).accepted is False


@cache
def state_of_dry(method: str) -> tuple[Assembly, Result]:
    wall = strong(WALLS["bond"](), 0.0)
    return wall, answered(load_method(method), wall)[0]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", WALLS)
def test_strength_at_the_wrong_joint_is_rejected(name: str, method: str):
    """All joints have the same strength but the one that moves most, where it is in another."""
    wall, result = state(name, method)
    strains = (wall.kinematic_matrix @ np.asarray(result.mechanism)[wall.free].ravel()).reshape(-1, 3)
    moving = int(abs(strains).max(axis=1).argmax())
    constant = wall.constant.copy()
    constant[moving - 1] += constant[moving]
    constant[moving] = 0.0
    assert judge(replace(wall, constant=constant), result, 1e-9).accepted is False


def test_yield_counts_tension_and_cohesion_to_their_limit_and_no_further():
    wall = assembly(stack(1, 1.0, 0.2), 0.5, cohesion=4.0, tensile_strength=2.0)
    weight, tension, cohesion = 4.0, 2.0, 4.0
    at = np.array([[-tension / 2.0, -tension / 2.0, cohesion - 0.5 * tension]])
    held = replace(wall, dead=np.where(wall.fixed[:, None], 0.0, [0.0, tension, 0.0]))
    assert force_residuals(held, at, 0.0)["yield"] == 0.0
    for wrong in ([-0.01, 0.0, 0.0], [0.0, -0.01, 0.0], [0.0, 0.0, 0.01], [0.0, 0.0, -2.0 * cohesion]):
        assert force_residuals(held, at + wrong, 0.0)["yield"] > 1e-3
    assert weight == pytest.approx(wall.weight[~wall.fixed].sum())


def said(wall: Assembly, answer: Answer) -> Judgement:
    return judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), 1e-9)


def test_a_fall_must_gain_more_than_the_strength_takes():
    """A block that hangs from a lintel: it falls if its weight is more than the tension its joint bears."""
    panel = {"type": "panel", "cell_length": 1.0, "cell_height": 0.2, "layout": ["L", "B"], "fixed": "L"}
    weight = 20.0 * 0.2
    for tension, falls in ((0.9 * weight, True), (1.1 * weight, False)):
        wall = assembly(panel, 0.5, cohesion=10.0, tensile_strength=tension, loads={})
        motion = np.where(wall.fixed[:, None], 0.0, [0.0, -1.0, 0.0])
        fall = Answer(Status.OK, Finding.FALLS, "it falls", mechanism=motion, flow="associated")
        assert said(wall, fall).accepted is falls
        stands = Answer(Status.OK, Finding.STANDS, "it stands", forces=np.array([[-weight / 2, -weight / 2, 0.0]]))
        assert said(wall, stands).accepted is not falls


def test_growing_forces_must_do_without_strength():
    """A load that only cohesion bears cannot grow for ever; one that friction bears can."""
    wall = assembly(stack(1, 1.0, 0.2), 0.5, cohesion=1000.0, loads={"live": {"body": [{"per_weight": [1, -1]}]}})
    weight = 4.0
    for friction, accepted in ((0.5, False), (1.0, True)):
        kept = replace(wall, friction=np.full(1, friction))
        arm = 0.1  # of the shear below the centroid
        tilt = weight * arm / 1.0
        normal = wall.normal[0, 1] > 0
        left = wall.end1[0, 0] < wall.end2[0, 0]
        shear = -weight * wall.tangent[0, 0] * (1.0 if normal else -1.0)
        ends = [weight / 2 - tilt, weight / 2 + tilt] if left else [weight / 2 + tilt, weight / 2 - tilt]
        answer = Answer(
            Status.OK,
            Finding.UNBOUNDED,
            "it bears any",
            forces=np.array([[weight / 2, weight / 2, 0.0]]),
            forces_multiplier=0.0,
            details={"live_forces": [[*ends, shear]]},
        )
        judged = said(kept, answer)
        assert judged.residuals["live_equilibrium"] < 1e-12
        assert judged.accepted is accepted


def test_a_joint_that_crushes_bears_no_live_load_without_end():
    """A weight of 4 on a joint that bears 20 collapses at 4 times more: no central compression grows for ever."""
    load = {"live": {"body": [{"per_weight": [0, -1]}]}}
    wall = assembly(stack(1, 1.0, 0.2), 0.5, cohesion=0.0, tensile_strength=0.0, compressive_strength=20.0, loads=load)
    assert answered(load_method("la-associated"), wall)[0].multiplier == pytest.approx(4.0, rel=1e-6)
    pressed = [[2.0, 2.0, 0.0]]
    answer = Answer(
        Status.OK,
        Finding.UNBOUNDED,
        "it bears any",
        forces=np.array(pressed),
        forces_multiplier=0.0,
        details={"live_forces": pressed},
    )
    judged = said(wall, answer)
    assert judged.accepted is False
    assert judged.residuals["live_yield"] > 0.1
    assert said(replace(wall, crushing=np.full(1, np.inf)), answer).accepted is True


def test_a_dry_wall_is_judged_to_the_bit_as_without_the_field():
    dry, result = state_of_dry("la")
    bare = replace(dry, constant=np.zeros((0, 4)))
    assert judge(dry, result, 1e-9).residuals == judge(bare, result, 1e-9).residuals


def test_a_wrong_answer_without_strength_rejects_the_whole_and_one_that_was_not_found_does_not():
    wall, result = state("slides", "la")
    residual = result.details["without_strength"]

    def with_residual(**change: object) -> Judgement:
        details = result.details | {"without_strength": residual | change}
        return judge(wall, result.model_copy(update={"details": details}), 1e-9)

    assert residual["multiplier"] == pytest.approx(0.5)  # the friction of its joints
    assert with_residual().accepted is True
    assert with_residual(multiplier=0.51).accepted is False
    lost = with_residual(status="not_converged", multiplier=None, forces=None, mechanism=None)
    assert lost.accepted is True
    assert "Without cohesion" not in lost.sentence
