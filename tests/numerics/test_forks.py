"""Forks do not outlive the process that they work for."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import psutil
import pytest

SLEEPERS = """
import os, time
from methods.numerics.forks import in_forks
def sleep():
    os.write(1, b".")
    time.sleep(60)
list(in_forks([sleep, sleep], 2))
"""


@pytest.mark.parametrize("sign", [signal.SIGTERM, signal.SIGKILL])
def test_forks_end_with_the_process_that_made_them(sign: signal.Signals) -> None:
    with subprocess.Popen([sys.executable, "-c", SLEEPERS], stdout=subprocess.PIPE, bufsize=0) as process:
        assert process.stdout is not None
        said = b""
        while len(said) < 2:
            said += os.read(process.stdout.fileno(), 2)
        forks = psutil.Process(process.pid).children()
        assert len(forks) == 2
        process.send_signal(sign)
        process.wait()
        _, alive = psutil.wait_procs(forks, timeout=10.0)  # those that are left would sleep for a minute
        for each in alive:
            each.kill()
    assert not alive
