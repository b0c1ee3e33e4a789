"""Processes: what they use, and those that a run has started and left, which its worker adopts and ends with the run.

A process that begins a session of its own, or whose parent has ended, is of no process group that the engine knows.
Where the worker adopts orphans (Linux), all of them stay its descendants; elsewhere those of its group are ended alone.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import resource
import signal
import time
from collections.abc import Collection, Iterable
from pathlib import Path

import psutil

_ADOPT_ORPHANS = 36
"""PR_SET_CHILD_SUBREAPER of prctl(2)."""
_MOST_SECONDS = 5.0
"""In which the engine ends what goes on starting processes; a run that outpaces it is more than a run can be."""


def adopt_orphans() -> None:
    """Make descendants of this process whose parent ends children of this process, not of the system's first one."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_ADOPT_ORPHANS, 1, 0, 0, 0)


def end_left_over(kept: Collection[int]) -> bool:
    """End the children of this process but those kept, and what these have left; whether there were any.

    They are waited for, so that their CPU time is part of the run that started them.
    """
    found = False
    while strays := _children() - set(kept):
        found = True
        for pid in strays:
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGKILL)
        for pid in strays:
            with contextlib.suppress(OSError):
                os.waitpid(pid, 0)
    return found


def _children() -> set[int]:
    """Children of this process (Linux; elsewhere none are seen)."""
    try:
        tasks = Path("/proc/self/task").iterdir()
        return {int(pid) for task in tasks for pid in (task / "children").read_text(encoding="ascii").split()}
    except OSError:
        return set()


def end_descendants(pid: int) -> None:
    """End all that a process has started, while that lives and adopts them."""
    until = time.monotonic() + _MOST_SECONDS
    with contextlib.suppress(psutil.Error):
        leader = psutil.Process(pid)
        while (members := [each for each in leader.children(recursive=True) if _runs(each)]) and (
            time.monotonic() < until
        ):
            for member in members:
                with contextlib.suppress(psutil.Error):
                    member.kill()


def _runs(process: psutil.Process) -> bool:
    with contextlib.suppress(psutil.Error):
        return bool(process.status() not in (psutil.STATUS_ZOMBIE, psutil.STATUS_DEAD))
    return False


def resource_use(pid: int, *, with_children: bool = False) -> tuple[int, float] | None:
    """Resident memory [bytes] and CPU time [s] of a process, and of those it started if asked; None if it has ended."""
    memory, cpu = 0, 0.0
    with contextlib.suppress(psutil.Error):
        leader = psutil.Process(pid)
        for member in [leader, *(leader.children(recursive=True) if with_children else ())]:
            with contextlib.suppress(psutil.Error):
                memory += member.memory_info().rss
                times = member.cpu_times()
                cpu += times.user + times.system
    return (memory, cpu) if memory else None


def cpu_seconds(kept: Iterable[int] = ()) -> float:
    """CPU time of this process, of those it started that have ended, and of some that it keeps [s]."""
    own = (resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN))
    used = [resource_use(pid) for pid in kept]
    return sum(usage.ru_utime + usage.ru_stime for usage in own) + sum(found[1] for found in used if found)
