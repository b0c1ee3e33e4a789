"""What processes use: resident memory and CPU time."""

from __future__ import annotations

import contextlib
import resource
from collections.abc import Iterable

import psutil


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
