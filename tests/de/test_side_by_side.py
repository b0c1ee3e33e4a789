"""Body orders searched side by side: the same answer to the bit, stopped alike, and no other process left behind."""

from __future__ import annotations

import json
import os
import time
from dataclasses import asdict
from pathlib import Path

import numpy as np
import psutil
import pytest

from harness.engine.isolate import run_isolated
from harness.engine.worker import Task
from harness.model.assembly import Assembly
from harness.model.errors import InputError
from harness.model.method import Answer, Finding, Status, allowing
from harness.model.method_registry import load_method
from methods.de.engines.mass_scaling import MassScaling
from methods.numerics.forks import ForkLost, in_forks
from tests.commands import drystone
from tests.walls import assembly, running_bond, wall_data


def answered(wall: Assembly, processes: int, **settings: object) -> Answer:
    method = load_method("de")
    with allowing(processes):
        return method.solve(wall, method.Settings(**settings))


def same(one: Answer, two: Answer) -> bool:
    return all(np.array_equal(a, b) for a, b in zip(asdict(one).values(), asdict(two).values(), strict=True))


def test_two_processes_give_the_answer_of_one_to_the_bit():
    wall = assembly(running_bond(4, 2))
    assert same(answered(wall, 1), answered(wall, 2))
    assert same(answered(wall, 1, orders=5), answered(wall, 3, orders=5))


@pytest.mark.slow
def test_another_tuning_than_the_first_gives_the_same_answer_too(monkeypatch: pytest.MonkeyPatch):
    slow = MassScaling(0.4, 0.999999)  # hardly damped: it does not settle in the work there is
    monkeypatch.setattr("methods.de.answers.tunings", lambda *_: [slow, MassScaling(0.4, 0.95)])
    wall = assembly(running_bond(3, 2))
    one, two = (answered(wall, processes, work=300_000) for processes in (1, 2))
    assert one.details["damping"] == 0.95
    assert same(one, two)


def test_a_limit_leaves_what_the_orders_had_shown_and_no_process():
    wall = assembly(running_bond(24, 12))
    measured = run_isolated(Task("de", wall, {}, 3.0, 2**32, processes=2), "large")
    result = measured.result
    assert result.details["stopped_by_limit"], result.sentence
    assert result.wall_seconds is not None
    assert result.wall_seconds < 3.5
    assert result.status in (Status.OK, Status.NOT_CONVERGED)
    assert result.finding in (Finding.COLLAPSES, Finding.NONE)


def test_methods_that_make_a_run_in_one_process_are_refused_by_name(tmp_path: Path):
    (tmp_path / "wall.json").write_text(json.dumps(wall_data(running_bond(2, 2))))
    for method in ("la", "fe", "la-associated"):
        refused = drystone("run", method, "wall.json", "--jobs", "2", cwd=tmp_path)
        assert refused.returncode == 2
        assert method in refused.stderr
        assert "one process" in refused.stderr
    done = drystone("run", "de", "wall.json", "--jobs", "2", "--json", cwd=tmp_path)
    alone = drystone("run", "de", "wall.json", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["bracket"] == json.loads(alone.stdout)["bracket"]


def test_forks_give_results_as_they_end_raise_what_a_call_raises_and_tell_of_one_that_is_lost():
    started, before = time.monotonic(), {child.pid for child in psutil.Process().children()}
    calls = [lambda: (time.sleep(0.4), os.getpid())[1], os.getpid, os.getpid]
    ended = list(in_forks(calls, 2))
    assert [number for number, _ in ended] == [1, 2, 0], "the third begins when the second ends"
    assert len({os.getpid(), *(pid for _, pid in ended)}) == 4
    assert time.monotonic() - started < 5.0

    def refuses() -> int:
        raise InputError("no", "Do not")

    with pytest.raises(InputError, match="no"):
        list(in_forks([refuses], 2))
    with pytest.raises(ForkLost, match="status"):
        list(in_forks([lambda: os.kill(os.getpid(), 9)], 2))
    assert {child.pid for child in psutil.Process().children()} == before, "no process is left"
