"""Where the time is over the least judged state known so far is the answer."""

from __future__ import annotations

from typing import Any

import pytest

from harness.engine.judge import judge
from harness.model.method import Finding, OutOfTime, Status, load_method
from harness.model.result import result_of
from methods.la import least
from tests.walls import assembly, running_bond


def out_of_time(*_: Any, **__: Any) -> Any:
    raise OutOfTime


@pytest.mark.parametrize("step", ["Search.solve_associated", "climb", "gravity_of", "prove"])
def test_state_known_before_the_time_was_over_is_the_answer(step: str, monkeypatch: pytest.MonkeyPatch):
    wall, method = assembly(running_bond(6, 3), 0.65), load_method("la")
    settings = method.Settings()
    whole = method.solve(wall, settings)
    monkeypatch.setattr(f"methods.la.least.{step}", out_of_time)
    answer = method.solve(wall, settings)
    assert (answer.status, answer.finding) == (Status.OK, Finding.COLLAPSES)
    assert "stopped by the time limit" in answer.sentence
    assert answer.details["stopped_by_limit"]
    assert judge(wall, result_of(answer, wall, case="x", method="la", family="la"), method.tolerance).accepted
    assert answer.multiplier is not None
    assert whole.multiplier is not None
    assert answer.multiplier >= whole.multiplier - 1e-9


def test_state_of_a_large_wall_is_kept(monkeypatch: pytest.MonkeyPatch):
    wall, method = assembly(running_bond(6, 3), 0.65), load_method("la")
    monkeypatch.setattr(least, "SIMPLEX_SEARCH", 10)
    monkeypatch.setattr(least, "gravity_of", out_of_time)
    answer = method.solve(wall, method.Settings())
    assert answer.status is Status.OK
    assert answer.details["stopped_by_limit"]


def test_without_a_state_the_time_is_over(monkeypatch: pytest.MonkeyPatch):
    method = load_method("la")
    monkeypatch.setattr(least.Search, "interior", out_of_time)
    with pytest.raises(OutOfTime):
        method.solve(assembly(running_bond(6, 3), 0.65), method.Settings())


def test_bound_of_a_search_that_was_stopped_is_the_answer_of_the_search(monkeypatch: pytest.MonkeyPatch):
    wall, method = assembly(running_bond(6, 3), 0.65), load_method("la-bound")
    monkeypatch.setattr(least, "climb", out_of_time)
    answer = method.solve(wall, method.Settings())
    assert answer.status is Status.OK
    assert answer.details["stopped_by_limit"]


def test_associated_state_is_the_answer_where_no_other_is_known(monkeypatch: pytest.MonkeyPatch):
    """It is told as what it is: an upper bound, which the gates do not take for the least known."""
    wall, method = assembly(running_bond(6, 3), 0.65), load_method("la")
    monkeypatch.setattr(least, "SIMPLEX_SEARCH", 10)
    monkeypatch.setattr(least, "central_search", out_of_time)
    answer = method.solve(wall, method.Settings())
    assert answer.status is Status.OK
    assert "No collapse state without dilatancy is known yet" in answer.sentence
    assert (answer.flow, answer.bracket) == ("associated", (0.0, answer.multiplier))
    greatest = load_method("la-associated")
    assert answer.multiplier == pytest.approx(greatest.solve(wall, greatest.Settings()).multiplier, rel=1e-12)
    assert judge(wall, result_of(answer, wall, case="x", method="la", family="la"), method.tolerance).accepted
