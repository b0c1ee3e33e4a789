"""What the judge asks of a wall that is said to be at its limit, and that no multiplier below zero is accepted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.knife_edge import KINDS
from harness.engine.judge import judge
from harness.model.assembly import Assembly
from harness.model.build import build
from harness.model.foreign.result_document import answer_from_file
from harness.model.method import Answer, Finding, Status
from harness.model.method_registry import load_method
from harness.model.result import result_of
from harness.model.wall import Wall
from tests.walls import assembly, stack


def made(kind: str, share: float) -> Assembly:
    return build(Wall.model_validate(KINDS[kind](share)[0])).assembly


def answer_of(wall: Assembly, method: str = "la-associated") -> Answer:
    found = load_method(method)
    return found.solve(wall, found.Settings())


def outcome(wall: Assembly, answer: Answer, tolerance: float = 1e-9) -> str:
    return judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), tolerance).outcome


@pytest.fixture(scope="module")
def edge() -> tuple[Assembly, Answer]:
    wall = made("harmonic stack of 4", 0.0)
    return wall, answer_of(wall)


def test_forces_and_a_dilatant_mechanism_of_multiplier_zero_show_the_limit(edge):
    wall, answer = edge
    assert answer.finding is Finding.AT_LIMIT
    assert outcome(wall, answer) == "accepted"
    bare = replace(answer, details={})
    assert outcome(wall, bare) == "accepted"


@pytest.mark.parametrize("multiplier", [None, 1e-12, -1e-12, 0.3])
def test_the_multiplier_of_a_wall_at_its_limit_is_zero(edge, multiplier):
    wall, answer = edge
    assert outcome(wall, replace(answer, multiplier=multiplier)) == "rejected"


def test_without_forces_or_mechanism_nothing_is_shown(edge):
    wall, answer = edge
    for lacking in ({"forces": None}, {"mechanism": None}):
        assert outcome(wall, replace(answer, details={}, **lacking)) == "not_judged"


def test_shown_forces_and_mechanism_must_fit_the_wall(edge):
    wall, answer = edge
    for name in ("dead_forces", "dilatant_mechanism"):
        assert outcome(wall, replace(answer, details=answer.details | {name: [[0.0, 0.0, 0.0]]})) == "rejected"
        bad = np.array(answer.details[name]) * np.nan
        assert outcome(wall, replace(answer, details=answer.details | {name: bad.tolist()})) == "rejected"


@pytest.mark.parametrize("share", [-1e-2, -1e-4, -1e-5, 1e-5, 1e-4, 1e-2])
def test_a_wall_that_stands_or_falls_by_more_than_its_numbers_tell_is_not_at_its_limit(edge, share):
    _, answer = edge
    other = made("harmonic stack of 4", share)
    for tolerance in (1e-10, 1e-8, 1e-3):
        assert outcome(other, answer, tolerance) == "rejected"


def test_a_mechanism_of_a_higher_multiplier_shows_no_limit():
    wall = assembly(stack(3))
    collapse = answer_of(wall)
    claim = replace(collapse, finding=Finding.AT_LIMIT, multiplier=0.0, forces_multiplier=0.0)
    assert outcome(wall, claim) == "rejected"


def test_a_slip_without_lifting_shows_no_limit():
    """On an incline of more friction a block that slides without lifting gains work, and yet it stands."""
    at, above = made("incline of 20 degrees", 0.0), made("incline of 20 degrees", 1e-3)
    answer = answer_of(at)
    motion = np.zeros((2, 3))
    motion[1, :2] = [np.cos(np.radians(20.0)), -np.sin(np.radians(20.0))]
    claim = replace(answer, details={}, mechanism=motion, flow="non-associated")
    assert outcome(above, claim) == "rejected"


@pytest.mark.parametrize("multiplier", [-1e-16, -1e-9, -0.2])
def test_no_multiplier_below_zero_is_accepted(multiplier):
    wall = made("one block past an edge", 0.0)
    answer = answer_of(wall, "fe-newton")
    claim = replace(answer, finding=Finding.COLLAPSES, multiplier=multiplier, forces_multiplier=multiplier)
    assert outcome(wall, claim, 1e-8) == "rejected"
    assert outcome(wall, replace(claim, flow="approximate", bracket=(multiplier, 0.1)), 1e-8) == "rejected"


def test_a_file_may_hold_forces_and_mechanism_of_statics(edge):
    wall, answer = edge
    data = {"finding": "at its limit", "multiplier": 0.0, "flow": "approximate"} | {
        name: answer.details[name] for name in ("dead_forces", "dilatant_mechanism")
    }
    read = answer_from_file(data, wall, "x")
    assert read.status is Status.OK
    assert outcome(wall, read) == "accepted"
