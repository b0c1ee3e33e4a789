"""Many runs in few processes: the same answers as one process a run, limits and honesty for each run alone."""

from __future__ import annotations

import multiprocessing
import time
from contextlib import closing, suppress
from multiprocessing.connection import wait
from typing import Any

import psutil
import pytest

from harness.engine.executors import Job, LocalExecutor, Slots
from harness.engine.isolate import Child, Retry, run_isolated, start_context
from harness.engine.run import TimedResult
from harness.engine.worker import Task
from harness.model.method import Status
from methods.dummy import Dummy
from tests.walls import assembly, running_bond, stack

COST = {"cpu_seconds", "wall_seconds", "peak_memory_bytes", "started", "path", "details"}
"""What differs from run to run; path and details hold times as well as values."""


def task(method: str, seconds: float = 60.0, **settings: Any) -> Task:
    return Task(method, assembly(stack(2)), settings, seconds, 400 * 2**20)


def results(tasks: list[Task], processes: int) -> list[TimedResult]:
    jobs = [Job(number, "made-up", each) for number, each in enumerate(tasks)]
    with closing(LocalExecutor(processes).map(jobs, {each.method for each in tasks})) as ended:
        return [measured for _, measured in sorted(ended, key=lambda pair: pair[0])]


def looked(child: Child) -> TimedResult | Retry:
    while (found := child.look()) is None:
        wait(child.waitables, timeout=0.05)
    return found


@pytest.mark.slow
def test_a_process_that_made_other_runs_before_gives_the_same_bits_as_a_fresh_one():
    wall = assembly(running_bond(3, 2), 0.7)
    tasks = [Task(method, wall, {}, 60.0, 2**31) for method in ("fe", "la-associated", "la", "fe-newton", "de")]
    warm = results([*tasks, *reversed(tasks)], 1)
    for each, first, second in zip(tasks, warm[:5], reversed(warm[5:]), strict=True):
        alone = run_isolated(each, "made-up").result.model_dump(exclude=COST)
        assert first.result.model_dump(exclude=COST) == alone
        assert second.result.model_dump(exclude=COST) == alone
        assert first.result.path.get("multiplier") == second.result.path.get("multiplier")


def test_small_runs_share_a_process_and_each_is_charged_for_itself():
    slots = Slots(start_context(["la-associated"]))
    try:
        child = slots.begin(task("la-associated"), "made-up")
        costs = []
        for number in range(20):
            measured = looked(child)
            assert isinstance(measured, TimedResult)
            costs.append(measured.result.cpu_seconds)
            slots.give_back(child)
            again = slots.begin(task("la-associated"), f"case {number}")
            assert again is child
        assert child.runs == 20
        assert max(costs[1:]) < 0.5 < 20 * 0.5  # a sum over the runs before would pass half a second
    finally:
        child.end()
        slots.end()


@pytest.mark.parametrize(
    ("does", "status"),
    [("abort", Status.CRASHED), ("exit", Status.CRASHED), ("hang", Status.TIMEOUT), ("eat", Status.OUT_OF_MEMORY)],
)
def test_a_run_that_ends_badly_costs_its_row_and_the_next_runs_are_made(does: str, status: Status):
    seconds = 1.5 if does == "hang" else 60.0  # the others end by themselves, however busy the machine is
    tasks = [task("dummy", does="answer"), task("dummy", seconds, does=does), *[task("dummy", does="answer")] * 3]
    found = [measured.result.status for measured in results(tasks, 1)]
    assert found == [Status.OK, status, Status.OK, Status.OK, Status.OK]


def test_the_limit_of_memory_is_that_of_each_run():
    tasks = [task("dummy", does=does) for does in ("eat", "answer", "eat", "answer")]
    found = [measured.result for measured in results(tasks, 1)]
    assert [result.status for result in found] == [Status.OUT_OF_MEMORY, Status.OK] * 2
    assert found[1].peak_memory_bytes < 0.7 * found[0].peak_memory_bytes


def test_a_method_that_asks_for_a_fresh_process_gets_one(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(Dummy, "fresh_process", True, raising=False)
    child = Child(multiprocessing.get_context("fork"))
    try:
        for expected in (TimedResult, Retry):
            assert child.reusable
            child.begin(task("dummy"), "made-up")
            assert isinstance(looked(child), expected)
        assert not child.reusable
    finally:
        child.end()


def test_a_run_whose_process_is_killed_from_outside_is_made_once_more():
    """The second time it is a row: a run that ends its process each time must not be made for ever."""
    context = start_context(["dummy"])
    for last in (False, True):
        child = Child(context)
        try:
            child.begin(task("dummy", does="hang"), "made-up", last=last)
            time.sleep(0.3)
            psutil.Process(child.pid).kill()
            found = looked(child)
        finally:
            child.end()
        if last:
            assert isinstance(found, TimedResult)
            assert found.result.status is Status.CRASHED
            assert "SIGKILL" in found.result.sentence
        else:
            assert found is Retry.FRESH


def test_killing_children_under_way_loses_and_doubles_no_run():
    tasks = [task("la-associated") for _ in range(120)]
    jobs = [Job(number, "made-up", each) for number, each in enumerate(tasks)]
    numbers = []
    before = children()
    with closing(LocalExecutor(2).map(jobs, ["la-associated"])) as ended:
        for number, measured in ended:
            assert measured.result.status is Status.OK
            numbers.append(number)
            if len(numbers) in (20, 40, 60):
                for process in started_since(before):
                    with suppress(psutil.Error):
                        process.kill()
    assert sorted(numbers) == list(range(120))


def children() -> set[psutil.Process]:
    """Processes below this one: the browser or the command process of other tests among them."""
    return set(psutil.Process().children(recursive=True))


def started_since(before: set[psutil.Process]) -> list[psutil.Process]:
    """Processes that make runs, of those that were started since: the leaves but for the tracker of resources."""
    found = []
    for process in children() - before:
        with suppress(psutil.Error):
            if not process.children() and "resource_tracker" not in " ".join(process.cmdline()):
                found.append(process)
    return found


def test_closing_the_results_ends_every_process():
    before = children()
    jobs = [Job(0, "a", task("dummy")), Job(1, "b", task("dummy", does="hang"))]
    with closing(LocalExecutor(2).map(jobs, ["dummy"])) as ended:
        assert next(ended)[0] == 0
        started = started_since(before)
    assert started
    assert not psutil.wait_procs(started, timeout=10.0)[1]
