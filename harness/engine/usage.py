"""What processes use: resident memory and CPU time."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

TICKS, PAGE = os.sysconf("SC_CLK_TCK"), os.sysconf("SC_PAGE_SIZE")


def usage(pid: int, *, with_children: bool = False) -> tuple[int, float] | None:
    """Resident memory [bytes] and CPU time [s] of a process, and of those it started if asked; None if it has ended.

    Linux tells both in a file; psutil, which elsewhere finds them, takes as long to import as a small run.
    """
    if not with_children and Path("/proc/self/stat").exists():
        try:
            told = Path(f"/proc/{pid}/stat").read_text(encoding="ascii", errors="replace")
        except OSError:
            return None
        fields = told.rpartition(")")[2].split()  # behind the name, which may hold anything: from the state on
        return int(fields[21]) * PAGE, (int(fields[11]) + int(fields[12])) / TICKS
    return _by_psutil(pid, with_children)


def _by_psutil(pid: int, with_children: bool) -> tuple[int, float] | None:
    import psutil

    memory, cpu = 0, 0.0
    with contextlib.suppress(psutil.Error):
        leader = psutil.Process(pid)
        for member in [leader, *(leader.children(recursive=True) if with_children else ())]:
            with contextlib.suppress(psutil.Error):
                memory += member.memory_info().rss
                times = member.cpu_times()
                cpu += times.user + times.system
    return (memory, cpu) if memory else None
