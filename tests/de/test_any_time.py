"""Where the time is over what distinct elements have shown by then is the answer."""

from __future__ import annotations

from typing import Any

import pytest

from harness.engine.judge import judge
from harness.engine.pipeline import execute
from harness.engine.run import Limits, Run
from harness.model.assembly import Assembly
from harness.model.case import Case, CaseFile
from harness.model.components import analysed_apart
from harness.model.method import Answer, Finding, OutOfTime, Status
from harness.model.method_registry import load_method
from harness.model.result import result_of
from harness.model.wall import Wall
from methods.de import answers as de_answer
from methods.de.engines.sequential_impulses import SequentialImpulses
from methods.de.engines.soft_wall import SoftWall
from methods.de.holds.bracket_state import highest_shown
from tests.walls import assembly, running_bond, stack

WALL = assembly(running_bond(6, 3), 0.65)
"""Its head joints bear nothing at 13/23; `de` needs 24 holds an order."""


def stopped_after(calls: int, monkeypatch: pytest.MonkeyPatch, where: Any, name: str = "advance") -> None:
    """Let the time be over at a call of a method, and never again, as the alarm of a limit rings once."""
    whole, left = getattr(where, name), [calls]

    def advance(self: Any, *given: Any) -> Any:
        left[0] -= 1
        if left[0] == 0:
            raise OutOfTime
        return whole(self, *given)

    monkeypatch.setattr(where, name, advance)


def solved(name: str, wall: Assembly = WALL, **settings: Any) -> tuple[Answer, bool | None]:
    """The answer, and what the judge says of it."""
    method = load_method(name)
    answer = method.solve(wall, method.Settings.model_validate(settings))
    result = result_of(answer, wall, case="x", method=name, family="de")
    return answer, judge(wall, result, method.tolerance).accepted


@pytest.mark.parametrize("calls", [120, 180, 400])
def test_bracket_known_when_the_time_is_over_is_the_answer(calls: int, monkeypatch: pytest.MonkeyPatch):
    stopped_after(calls, monkeypatch, SequentialImpulses)
    answer, accepted = solved("de")
    assert (answer.status, answer.finding, accepted) == (Status.OK, Finding.COLLAPSES, True)
    assert "stopped by the time limit" in answer.sentence
    assert answer.details["stopped_by_limit"]
    low, high = answer.bracket
    assert answer.forces_multiplier >= low > 0.5
    # Orders differ by 0.2 %.
    assert 0.998 * low <= 13 / 23 <= 1.002 * high < 0.7
    assert answer.multiplier == pytest.approx(0.5 * (low + high))


def test_lower_end_that_was_shown_is_named_where_no_motion_was(monkeypatch: pytest.MonkeyPatch):
    stopped_after(40, monkeypatch, SequentialImpulses)
    answer, _ = solved("de")
    assert (answer.status, answer.finding, answer.multiplier) == (Status.NOT_CONVERGED, Finding.NONE, None)
    assert 0.1 < answer.forces_multiplier < 0.5
    assert f"stands at {answer.forces_multiplier:.6g}; no motion was shown" in answer.sentence


@pytest.mark.parametrize("name", ["de", "de-soft", "de-mujoco"])
def test_without_a_rest_nothing_is_said(name: str, monkeypatch: pytest.MonkeyPatch):
    if name == "de-mujoco":
        pytest.importorskip("mujoco")
        from methods.de.engines.mujoco_wall import MujocoWall as engine
    else:
        engine = {"de": SequentialImpulses, "de-soft": SoftWall}[name]
    stopped_after(1, monkeypatch, engine)
    answer, _ = solved(name, assembly(stack(2), 0.5))
    assert (answer.status, answer.finding) == (Status.NOT_CONVERGED, Finding.NONE)
    assert "not decided" in answer.sentence
    assert answer.forces is None


def test_orders_searched_to_the_end_are_counted(monkeypatch: pytest.MonkeyPatch):
    stopped_after(2, monkeypatch, de_answer.BracketState, "searched")
    answer, accepted = solved("de")
    alone, _ = solved("de", orders=1)
    assert accepted
    assert answer.bracket == alone.bracket
    assert "1 of 3 sweep orders" in answer.sentence


def test_state_that_is_not_in_balance_shows_nothing(monkeypatch: pytest.MonkeyPatch):
    def worse(self: SequentialImpulses) -> Any:
        return whole(self) * (1.0 + 1e-4 * (self.multiplier > 0.3))

    whole = SequentialImpulses.contact_forces
    monkeypatch.setattr(SequentialImpulses, "contact_forces", worse)
    stopped_after(120, monkeypatch, SequentialImpulses)
    answer, _ = solved("de")
    assert 0.2 < answer.forces_multiplier <= 0.3
    assert answer.bracket[0] == answer.forces_multiplier
    assert highest_shown(WALL, [], 1e-6) is None


@pytest.mark.parametrize("looks", [60, 200])
def test_soft_joints_give_the_bracket_known(looks: int, monkeypatch: pytest.MonkeyPatch):
    whole, _ = solved("de-soft", assembly(stack(2), 0.9))
    stopped_after(looks, monkeypatch, SoftWall)
    answer, accepted = solved("de-soft", assembly(stack(2), 0.9))
    assert answer.details["stopped_by_limit"]
    assert "stopped by the time limit" in answer.sentence
    if answer.status is Status.OK:
        assert accepted
        assert answer.bracket[0] <= whole.bracket[1]
        assert whole.bracket[0] <= answer.bracket[1]
    else:
        assert 0.0 < answer.forces_multiplier <= whole.bracket[1]


TWO_STACKS = [
    {"id": f"{k}-{i}", "polygon": [[2 * k, i], [2 * k + 1, i], [2 * k + 1, i + 1], [2 * k, i + 1]], "fixed": i == 0}
    for k in range(2)
    for i in range(k + 2)
]
"""A column of one block and one of two, on supports of their own."""


def test_components_after_one_that_was_stopped_are_not_begun():
    begun = []

    def solve(part: Assembly) -> Answer:
        begun.append(part.n_free)
        return Answer(Status.OK, Finding.COLLAPSES, "x", multiplier=0.5, details={"stopped_by_limit": True})

    answer = analysed_apart(assembly(None, 0.5, blocks=TWO_STACKS), solve, lambda *_: None)
    assert begun == [1]
    assert answer.status is Status.NOT_CONVERGED
    assert "before the component" in answer.sentence


def test_what_one_component_gave_is_told_where_the_time_is_over_in_the_next():
    def solve(part: Assembly) -> Answer:
        if part.n_free > 1:
            raise OutOfTime
        return Answer(Status.OK, Finding.COLLAPSES, "x", multiplier=0.5)

    answer = analysed_apart(assembly(None, 0.5, blocks=TWO_STACKS), solve, lambda *_: None)
    assert answer.status is Status.NOT_CONVERGED
    assert "before the component of 1-1, 1-2 had an answer" in answer.sentence
    assert "That of 0-1 alone collapses at 0.5" in answer.sentence
    assert [part["multiplier"] for part in answer.details["components"]] == [0.5, None]


def test_without_an_answer_of_any_component_the_time_is_over():
    def solve(part: Assembly) -> Answer:
        raise OutOfTime

    with pytest.raises(OutOfTime):
        analysed_apart(assembly(None, 0.5, blocks=TWO_STACKS), solve, lambda *_: None)


@pytest.mark.parametrize(
    ("courses", "bricks", "seconds"), [(14, 14, 4.0), pytest.param(14, 28, 8.0, marks=pytest.mark.slow)]
)
def test_walls_of_hundreds_of_blocks_have_an_answer_at_a_few_seconds(courses: int, bricks: int, seconds: float):
    """How far it comes in that time is the machine's; that it is told, and proved, is not."""
    wall = {"format": "wall/1", "unit_weight": 20.0, "friction": 0.65, "pattern": running_bond(courses, bricks)}
    wall["loads"] = {"live": {"body": [{"per_weight": [1, 0]}]}}
    case = Case(CaseFile(id="x", title="x", source="tests"), Wall.model_validate(wall), "wall.json")
    (result,) = execute([Run(case, "de", {}, Limits(seconds))], None, 1)
    assert result.status in (Status.OK, Status.NOT_CONVERGED)
    assert result.details["stopped_by_limit"]
    assert result.judge.accepted or "stands at" in result.sentence or "not decided" in result.sentence
