"""Joints whose slips lift by a coefficient from zero to the friction: data alone, in `la`, its proof and the judge."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.engine.judge import judge
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.case import case_folders, read_case, shipped_cases
from harness.model.errors import InputError
from harness.model.joint_law import JointLaw
from harness.model.method import Answer, Finding
from harness.model.method_registry import check_takes, load_method, method_names
from harness.model.result import result_of
from harness.model.wall import Wall
from tests.walls import assembly, running_bond, wall_data

SAME = 1e-9
"""Relative difference of two multipliers that are each known to 1e-10."""


def answer_of(name: str, wall: Assembly, **settings: Any) -> Answer:
    method = load_method(name)
    return method.solve(wall, method.Settings(**settings))


def accepted(wall: Assembly, answer: Answer, name: str = "la") -> bool | None:
    return judge(
        wall, result_of(answer, wall, case="x", method=name, family="la"), load_method(name).tolerance
    ).accepted


def dilatant(wall: Assembly, share: float) -> Assembly:
    return replace(wall, dilatancy=share * wall.friction)


def test_rows_and_flow_vectors_are_transposed_where_flow_is_associated():
    law = JointLaw(np.array([0.4, 0.7]), np.array([0.0, 0.2]))
    forces, rates = (
        np.array([[2.0, 1.0, 0.5], [1.0, 0.0, -0.7]]),
        np.array([[1.0, 0.0, 2.0, 0.0], [0.0, 0.0, 0.0, 3.0]]),
    )
    slacks = np.einsum("pki,pi->pk", law.rows, forces)
    np.testing.assert_allclose(slacks, [[2.0, 1.0, 1.7, 0.7], [1.0, 0.0, 0.0, 1.4]], atol=1e-15)
    strains = np.einsum("pik,pk->pi", law.flow, rates)
    np.testing.assert_allclose(strains, [[1.0, 0.0, 2.0], [0.6, 0.6, -3.0]])
    np.testing.assert_array_equal(law.associated.flow, law.rows.transpose(0, 2, 1))


@pytest.mark.parametrize(("courses", "bricks", "friction"), [(3, 2, 0.65), (4, 2, 0.85), (2, 1, 0.3)])
def test_dilatancy_of_the_friction_gives_the_associated_maximum(courses: int, bricks: int, friction: float):
    wall = assembly(running_bond(courses, bricks), friction)
    greatest = answer_of("la-associated", wall).multiplier
    assert greatest is not None
    for share in (0.3, 0.8, 1.0):
        own = dilatant(wall, share)
        answer = answer_of("la", own, effort="quick")
        assert answer.finding is Finding.COLLAPSES
        assert accepted(own, answer)
        assert answer.multiplier is not None
        assert answer.multiplier <= greatest * (1.0 + SAME)
        if share == 1.0:
            assert answer.multiplier == pytest.approx(greatest, rel=SAME)


@pytest.mark.slow
def test_dilatancy_of_the_friction_gives_the_associated_maximum_of_every_library_wall():
    held = 0
    for folder in case_folders([shipped_cases()]).values():
        wall = read_case(folder).assembly
        if wall.n_interfaces > 300 or not wall.has_live_load or wall.breaks or wall.crushes:
            continue
        greatest = answer_of("la-associated", wall)
        if greatest.finding is Finding.COLLAPSES:
            assert greatest.multiplier is not None
            answer = answer_of("la", dilatant(wall, 1.0), effort="quick")
            assert answer.multiplier == pytest.approx(greatest.multiplier, rel=SAME, abs=SAME), folder.name
            held += 1
    assert held > 40


def test_proof_closes_where_statics_and_flow_are_dual():
    """Statics alone bounds from above, flow from below: with the dilatancy of the friction the two programmes meet."""
    answer = answer_of("la", dilatant(assembly(running_bond(3, 2), 0.65), 1.0))
    assert answer.details["proved_least"]


def test_judge_asks_for_the_dilatancy_of_the_wall():
    """The block on a slope that lifts: what is right for one dilatancy is no collapse state for another."""
    wall = assembly(running_bond(4, 2), 0.65)
    own = dilatant(wall, 0.5)
    answer = answer_of("la", own)
    assert accepted(own, answer)
    assert not accepted(wall, answer)
    assert not accepted(own, answer_of("la", wall))


def test_wall_gives_dilatancy_by_default_rule_and_interface():
    friction = {"default": 0.6, "dilatancy": 0.1, "rules": [{"joint": "head", "value": 0.3, "dilatancy": 0.3}]}
    built = build(Wall.model_validate(wall_data(running_bond(2, 2), friction)))
    law, heads = built.assembly.law, np.array([joint == "head" for joint in built.assembly.joint])
    assert heads.any()
    np.testing.assert_array_equal(law.dilatancy, np.where(heads, 0.3, 0.1))
    again = build(built.explicit()).assembly
    np.testing.assert_array_equal(again.law.dilatancy, law.dilatancy)
    np.testing.assert_array_equal(again.law.friction, law.friction)


@pytest.mark.parametrize(
    ("friction", "words"),
    [
        ({"default": 0.6, "dilatancy": 0.7}, "dilatancy 0.7 is above the friction 0.6"),
        ({"default": 0.6, "rules": [{"joint": "bed", "value": 0.2, "dilatancy": 0.3}]}, "above the friction 0.2"),
        ({"default": 0.6, "dilatancy": -0.1}, "greater than or equal to 0"),
    ],
)
def test_dilatancy_outside_zero_and_friction_is_refused(friction: dict[str, Any], words: str):
    with pytest.raises(ValueError, match=words):
        Wall.model_validate(wall_data(running_bond(2, 2), friction))


def test_methods_without_dilatancy_refuse_the_wall_by_name():
    wall = dilatant(assembly(running_bond(2, 2), 0.6), 0.5)
    takes = set()
    for name in method_names():
        method = load_method(name)
        if method.traits.any_dilatancy:
            takes.add(name)
            check_takes(method, wall)
            continue
        with pytest.raises(InputError, match=f"{name} takes no dilatancy"):
            check_takes(method, wall)
    assert takes == {"la", "la-associated", "la-associated-cvxpy", "fe", "fe-newton", "fe-qp", "de"}
    check_takes(load_method("de"), assembly(running_bond(2, 2), 0.6))
