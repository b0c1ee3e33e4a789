"""What processes use: resident memory and CPU time."""

from __future__ import annotations

import contextlib

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
