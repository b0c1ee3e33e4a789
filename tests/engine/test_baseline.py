"""The baseline tells better from worse, and is changed only with a reason."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from harness.engine.baseline import Baseline, Change, Entry, Value, change, read_baseline, value_of, write_baseline
from harness.model.errors import InputError
from harness.model.method import Finding, Status
from harness.model.result import Judgement, Result


def value(multiplier: float | None = None, **more) -> Value:
    finding = more.pop("finding", Finding.COLLAPSES)
    return Value(status=more.pop("status", Status.OK), finding=finding, multiplier=multiplier, **more)


@pytest.mark.parametrize(
    ("seeks_least", "old", "new", "expected"),
    [
        (True, 0.5, 0.49, Change.BETTER),
        (True, 0.5, 0.51, Change.WORSE),
        (True, 0.5, 0.5 + 1e-10, Change.SAME),
        (False, 0.5, 0.49, Change.WORSE),
        (False, 0.5, 0.51, Change.WORSE),
    ],
)
def test_lower_is_better_only_for_methods_that_seek_the_least(seeks_least, old, new, expected):
    assert change(value(old), value(new), seeks_least=seeks_least)[0] is expected


def test_brackets_must_meet():
    one, two, three = value(bracket=(0.4, 0.5)), value(bracket=(0.45, 0.55)), value(bracket=(0.51, 0.6))
    assert change(one, two, seeks_least=False)[0] is Change.SAME
    assert change(one, three, seeks_least=False)[0] is Change.WORSE


def test_answer_where_there_was_none_is_better_and_the_reverse_is_worse():
    failed = value(status=Status.TIMEOUT)
    assert change(failed, value(0.5), seeks_least=False)[0] is Change.BETTER
    assert change(value(0.5), failed, seeks_least=False)[0] is Change.WORSE
    assert change(None, value(0.5), seeks_least=False)[0] is Change.NEW


def test_file_keeps_values_and_history(tmp_path: Path):
    entry = Entry(date="2026-01-01", release="0.1", reason="a test")
    kept = Baseline(history=[entry], values={"b": {"la": value(0.5)}, "a": {"de": value(bracket=(0.1, 0.2))}})
    path = tmp_path / "baseline.json"
    write_baseline(path, kept)
    assert read_baseline(path) == kept
    assert read_baseline(tmp_path / "absent.json") == Baseline()
    path.write_text('{"values": 3}')
    with pytest.raises(InputError, match="values"):
        read_baseline(path)


@pytest.mark.parametrize(
    "changed",
    [{"multiplier": True}, {"multiplier": -0.1}, {"multiplier": "0.5"}, {"bracket": [False, 0.5]},
     {"bracket": [-0.1, 0.5]}, {"bracket": [0.5, 0.4]}, {"finding": "colapses"}],
)  # fmt: skip
def test_what_no_answer_can_be_is_refused_in_a_baseline_with_its_place(tmp_path: Path, changed):
    path = tmp_path / "baseline.json"
    held = {"status": "ok", "finding": "collapses", "multiplier": 0.5} | changed
    path.write_text(json.dumps({"values": {"wall": {"la": held}}}))
    with pytest.raises(InputError, match=r"values\.wall\.la") as refused:
        read_baseline(path)
    assert refused.value.source == str(path)


def test_no_number_of_an_answer_that_is_not_accepted_is_recorded():
    for status, accepted in ((Status.OK, False), (Status.OK, None), (Status.TIMEOUT, None)):
        result = Result(
            case="wall", method="la", family="la", status=status, finding=Finding.COLLAPSES, sentence="",
            multiplier=-0.2, bracket=(-0.3, -0.1), judge=Judgement(accepted=accepted), blocks=1, interfaces=1,
        )  # fmt: skip
        kept = value_of(result)
        assert (kept.multiplier, kept.bracket) == (None, None)
        assert kept.status is (Status.NOT_CONVERGED if status is Status.OK else status)
