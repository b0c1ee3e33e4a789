"""Resident memory and CPU time of processes."""

from __future__ import annotations

import os
import subprocess
import sys
import time

import numpy as np
import pytest

from harness.engine.processes import resource_use

PROGRAM = "import subprocess, sys; subprocess.Popen([sys.executable, '-c', 'input()']); print(flush=True); input()"


def test_memory_and_time_of_this_process_are_those_that_it_has_used():
    room = np.ones(4_000_000)
    found = resource_use(os.getpid())
    assert found is not None
    assert found[0] > room.nbytes
    assert found[1] == pytest.approx(time.process_time(), abs=0.05)


def test_children_are_counted_when_asked_for_and_an_ended_process_uses_nothing():
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", PROGRAM], **pipes) as process:  # type: ignore[call-overload]
        process.stdout.readline()
        deadline = time.monotonic() + 30.0
        alone, both = resource_use(process.pid), resource_use(process.pid, with_children=True)
        while both[0] < 1.5 * alone[0] and time.monotonic() < deadline:
            both = resource_use(process.pid, with_children=True)
        assert both[0] > 1.5 * alone[0]
        process.stdin.close()
    assert resource_use(process.pid) is None
    assert resource_use(process.pid, with_children=True) is None
