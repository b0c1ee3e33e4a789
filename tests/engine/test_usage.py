"""What is told of processes and packages without the library that is slow to load says the same as that library."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from importlib import metadata

import numpy as np
import pytest

from harness.engine import provenance, usage

PROGRAM = "import subprocess, sys; subprocess.Popen([sys.executable, '-c', 'input()']); print(flush=True); input()"


def test_the_file_of_linux_tells_what_psutil_does():
    room = np.ones(4_000_000)
    found, expected = usage.usage(os.getpid()), usage._by_psutil(os.getpid(), False)
    assert found is not None
    assert expected is not None
    assert found[0] == pytest.approx(expected[0], rel=0.02)
    assert found[0] > room.nbytes
    assert found[1] == pytest.approx(expected[1], abs=0.05)
    assert found[1] == pytest.approx(time.process_time(), abs=0.05)


def test_children_are_counted_when_asked_for_and_an_ended_process_uses_nothing():
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", PROGRAM], **pipes) as process:  # type: ignore[call-overload]
        process.stdout.readline()
        deadline = time.monotonic() + 30.0
        alone, both = usage.usage(process.pid), usage.usage(process.pid, with_children=True)
        while both[0] < 1.5 * alone[0] and time.monotonic() < deadline:
            both = usage.usage(process.pid, with_children=True)
        assert both[0] > 1.5 * alone[0]
        process.stdin.close()
    assert usage.usage(process.pid) is None
    assert usage.usage(process.pid, with_children=True) is None


def test_folders_tell_the_versions_that_the_packages_do():
    named = {package: provenance._installed().get(package) for package in provenance.PACKAGES}
    assert named["numpy"]
    assert named["drystone"]
    assert {name: number for name, number in named.items() if number} == {
        name: metadata.version(name) for name, number in named.items() if number
    }
