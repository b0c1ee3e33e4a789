"""Whatever a method does in its process, it costs one row with a sentence and nothing else."""

from __future__ import annotations

import os
import time
from typing import Any

import psutil
import pytest

from harness.engine.isolate import run_isolated
from harness.engine.worker import Task
from harness.model.method import Finding, Status
from tests.walls import assembly, stack


def run(does: str, seconds: float = 60.0, memory: int = 400, **settings: Any):
    task = Task("dummy", assembly(stack(2)), {"does": does} | settings, seconds, memory * 2**20)
    return run_isolated(task, "made-up").result


def test_good_answer_comes_back_with_its_cost():
    result = run("answer")
    assert result.status is Status.OK
    assert result.multiplier == 1.0
    assert result.cpu_seconds is not None
    assert result.wall_seconds is not None
    assert result.peak_memory_bytes is not None
    assert result.peak_memory_bytes > 10 * 2**20
    assert result.settings == {"does": "answer"}
    assert "python" in result.versions
    assert result.machine["cores"] >= 1


@pytest.mark.parametrize(
    ("does", "status", "words"),
    [
        ("nan", Status.CRASHED, "not finite"),
        ("nan_forces", Status.CRASHED, "not finite"),
        ("bad_shape", Status.CRASHED, "shape (1, 2)"),
        ("raise", Status.CRASHED, "RuntimeError: as ordered"),
        ("refuse", Status.REFUSED, "it lacks a part. Install the part."),
        ("abort", Status.CRASHED, "SIGABRT"),
        ("exit", Status.CRASHED, "exit code 3"),
        ("eat", Status.OUT_OF_MEMORY, "memory"),
    ],
)
def test_misbehaviour_becomes_a_status_with_a_sentence(does: str, status: Status, words: str):
    result = run(does)
    assert result.status is status
    assert words in result.sentence
    assert result.finding is Finding.NONE
    assert result.multiplier is None


def test_settings_a_method_does_not_have_are_refused():
    result = run("answer", speed=3)
    assert result.status is Status.REFUSED
    assert "speed" in result.sentence


@pytest.mark.parametrize("does", ["hang", "spawn"])
def test_run_over_its_time_is_killed_with_everything_it_started(does: str):
    started = time.perf_counter()
    result = run(does, seconds=1.0)
    assert result.status is Status.TIMEOUT
    assert "1 s" in result.sentence
    assert time.perf_counter() - started < 30.0
    left = [
        process
        for process in psutil.Process(os.getpid()).children(recursive=True)
        if process.status() != psutil.STATUS_ZOMBIE and "sleep" in " ".join(process.cmdline())
    ]
    assert not left


def test_a_method_may_say_how_far_it_came_before_its_time_is_over():
    result = run("tell", seconds=2.0)
    assert result.status is Status.NOT_CONVERGED
    assert result.sentence == "It slept until its time was over."
    assert result.wall_seconds is not None
    assert result.wall_seconds < 2.0


def test_output_of_a_method_does_not_reach_ours(capfd: pytest.CaptureFixture[str]):
    assert run("print").status is Status.OK
    captured = capfd.readouterr()
    assert "noise" not in captured.out + captured.err
