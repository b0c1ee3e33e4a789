"""Where the time is over the least judged state known so far is the answer."""

from __future__ import annotations

from typing import Any

import pytest

from benchmarks.la_any_time import timed
from harness.engine.judge import judge
from harness.model.method import Finding, OutOfTime, Status
from harness.model.method_registry import load_method
from harness.model.result import result_of
from methods.la.sources import SOURCES
from methods.proof.search.window_search import WindowSearch
from tests.walls import assembly, running_bond


def out_of_time(*_: Any, **__: Any) -> Any:
    raise OutOfTime


STEPS = {
    "later": ("sources.paths.CentralPath.states", "central path"),
    "continuation": ("sources.friction_continuation.FrictionContinuation.states", "friction continuation"),
    "springs": ("sources.springs.LowPrestress.states", "springs with low prestress"),
    "proof": ("least.prove", "moving blocks joined"),
}


@pytest.mark.parametrize("step", STEPS)
def test_state_known_before_the_time_was_over_is_the_answer(step: str, monkeypatch: pytest.MonkeyPatch):
    wall, method = assembly(running_bond(6, 3), 0.65), load_method("la")
    settings = method.Settings()
    whole = method.solve(wall, settings)
    place, source = STEPS[step]
    monkeypatch.setattr(f"methods.la.{place}", out_of_time)
    answer = method.solve(wall, settings)
    assert (answer.status, answer.finding) == (Status.OK, Finding.COLLAPSES)
    assert "stopped by the time limit" in answer.sentence
    assert answer.details["stopped_by_limit"]
    assert answer.path["multiplier"][-1] == pytest.approx(answer.multiplier, rel=1e-9)
    assert source in answer.sentence
    assert judge(wall, result_of(answer, wall, case="x", method="la", family="la"), method.tolerance).accepted
    assert answer.multiplier is not None
    assert whole.multiplier is not None
    assert answer.multiplier >= whole.multiplier - 1e-9


@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.name)
def test_no_source_ends_a_search_without_what_is_known(source: Any, monkeypatch: pytest.MonkeyPatch):
    """Each may be the one that the limit meets; where it is not begun on this wall, the search comes to its end."""
    wall, method = assembly(running_bond(6, 3), 0.65), load_method("la")
    monkeypatch.setattr(type(source), "states", out_of_time)
    answer = method.solve(wall, method.Settings(effort="quick"))
    assert (answer.status, answer.finding) == (Status.OK, Finding.COLLAPSES)


def test_without_a_state_the_time_is_over(monkeypatch: pytest.MonkeyPatch):
    method = load_method("la")
    monkeypatch.setattr("methods.la.sources.search.solve_associated", out_of_time)
    with pytest.raises(OutOfTime):
        method.solve(assembly(running_bond(6, 3), 0.65), method.Settings())


def test_bound_of_a_search_that_was_stopped_is_the_answer_of_the_search(monkeypatch: pytest.MonkeyPatch):
    wall, method = assembly(running_bond(6, 3), 0.65), load_method("la-bound")
    monkeypatch.setattr("methods.la.sources.friction_continuation.FrictionContinuation.states", out_of_time)
    answer = method.solve(wall, method.Settings())
    assert answer.status is Status.OK
    assert answer.details["stopped_by_limit"]


@pytest.mark.parametrize("windows", [0, pytest.param(2, marks=pytest.mark.slow)])
def test_bracket_known_before_the_time_was_over_is_the_answer(windows: int, monkeypatch: pytest.MonkeyPatch):
    """Neither the state below which the bound was looked for nor the bound reached by then is lost."""
    wall, method = assembly(running_bond(3, 2), 0.75), load_method("la-bound")
    left = [True] * windows
    window = WindowSearch.window

    def stopped(search: WindowSearch) -> bool:
        if not left:
            raise OutOfTime
        left.pop()
        return window(search)

    monkeypatch.setattr(WindowSearch, "window", stopped)
    answer = method.solve(wall, method.Settings())
    assert (answer.status, answer.finding) == (Status.OK, Finding.COLLAPSES)
    assert answer.multiplier is not None
    assert (answer.details["lower_bound"] > 0.0) == (windows > 0)
    assert answer.details["lower_bound"] < answer.multiplier


def test_associated_state_is_the_answer_where_no_other_is_known(monkeypatch: pytest.MonkeyPatch):
    """It is told as what it is: an upper bound, which the gates do not take for the least known."""
    wall, method = assembly(running_bond(6, 3), 0.65), load_method("la")
    monkeypatch.setattr("methods.la.sources.paths.ReducedFriction.states", out_of_time)
    answer = method.solve(wall, method.Settings())
    assert answer.status is Status.OK
    assert "No collapse state without dilatancy is known yet" in answer.sentence
    assert (answer.flow, answer.bracket) == ("associated", (0.0, answer.multiplier))
    greatest = load_method("la-associated")
    assert answer.multiplier == pytest.approx(greatest.solve(wall, greatest.Settings()).multiplier, rel=1e-12)
    assert judge(wall, result_of(answer, wall, case="x", method="la", family="la"), method.tolerance).accepted


@pytest.mark.slow
def test_limits_are_kept_and_longer_ones_answer_more():
    """Isolated, as in a comparison; 210 bricks need half a second of a processor for a first state, 1,020 two."""
    runs = list(timed(((20, 10), (40, 25)), (3.0, 10.0)))
    assert not [f"{run.blocks} blocks, {run.limit:g} s: {run.said}" for run in runs if run.failed]
    assert all(run.result.multiplier is not None for run in runs if run.limit == 10.0)
