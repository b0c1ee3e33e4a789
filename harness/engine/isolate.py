"""One run in a process of its own: started from a fork server, watched, and killed as a group when it must end."""

from __future__ import annotations

import contextlib
import functools
import json
import multiprocessing
import os
import signal
import tempfile
import time
from dataclasses import dataclass
from datetime import UTC, datetime
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

import psutil

from harness.engine import worker
from harness.engine.provenance import machine, versions
from harness.engine.worker import Task
from harness.model.method import Answer, Finding, Status
from harness.model.result import Result, result_of

LOOK_SECONDS = 0.05
"""How often memory and time of a run are looked at."""

ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "NUMBA")}
"""Environment of every run: one thread, so that CPU time means the same for all methods."""


@dataclass(frozen=True)
class Measured:
    """A result with the tolerance its method asks the judge for."""

    result: Result
    tolerance: float


@functools.cache
def _context() -> multiprocessing.context.ForkServerContext:
    os.environ.update(ONE_THREAD)
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([worker.__name__])
    return context


def run_isolated(task: Task, case: str) -> Measured:
    """Run a task in a fresh child process. Whatever happens there becomes a result with a sentence.

    Args:
        task: method, assembly, settings and limits.
        case: id of the case, for the result.
    """
    begun = datetime.now(UTC).isoformat(timespec="seconds")
    with tempfile.TemporaryDirectory(prefix="drystone-") as folder:
        process = _context().Process(target=worker.run_task, args=(task, folder), daemon=False)
        clock = time.perf_counter()
        process.start()
        watched = _Watched(process, task)
        _running.add(watched)
        try:
            watched.until_end()
        finally:
            watched.kill()
            process.join()
            _running.discard(watched)
        elapsed = time.perf_counter() - clock
        record = _read_record(Path(folder))
        if record is None or watched.ending is not None:
            record = {
                "answer": watched.failure(process.exitcode, _last_words(Path(folder))),
                "cpu_seconds": watched.cpu_seconds,
                "wall_seconds": elapsed,
                "peak_memory_bytes": watched.peak_memory,
            }
        process.close()
    answer = record["answer"]
    result = result_of(
        answer,
        task.assembly,
        case=case,
        method=task.method,
        family=record.get("family") or task.method.split("-", maxsplit=1)[0],
    )
    measured = result.model_copy(
        update={
            "cpu_seconds": record["cpu_seconds"],
            "wall_seconds": record["wall_seconds"],
            "peak_memory_bytes": record["peak_memory_bytes"],
            "settings": record.get("settings") or task.settings,
            "limits": {"seconds": task.seconds, "memory_bytes": float(task.memory_bytes)},
            "versions": versions(),
            "machine": machine(),
            "started": begun,
        }
    )
    return Measured(measured, float(record.get("tolerance") or 0.0))


_running: set[_Watched] = set()


def stop_all() -> None:
    """End every run of this process that is under way, as when the user interrupts."""
    for watched in list(_running):
        watched.kill()


class _Watched:
    """A running child: its use of time and memory, and how it was ended if it had to be."""

    def __init__(self, process: Any, task: Task) -> None:
        self.process, self.task = process, task
        self.deadline = time.perf_counter() + task.seconds
        self.cpu_seconds: float | None = None
        self.peak_memory: int | None = None
        self.ending: Status | None = None

    def until_end(self) -> None:
        while not wait([self.process.sentinel], timeout=LOOK_SECONDS):
            self._look()
            if self.peak_memory is not None and self.peak_memory > self.task.memory_bytes:
                self.ending = Status.OUT_OF_MEMORY
                return
            if time.perf_counter() > self.deadline:
                self.ending = Status.TIMEOUT
                return

    def _look(self) -> None:
        memory, cpu = 0, 0.0
        with contextlib.suppress(psutil.Error):
            leader = psutil.Process(self.process.pid)
            for member in [leader, *leader.children(recursive=True)]:
                with contextlib.suppress(psutil.Error):
                    memory += member.memory_info().rss
                    times = member.cpu_times()
                    cpu += times.user + times.system
        if memory:
            self.peak_memory = max(self.peak_memory or 0, memory)
            self.cpu_seconds = max(self.cpu_seconds or 0.0, cpu)

    def kill(self) -> None:
        """End the whole process group; the child has made itself its leader."""
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self.process.pid, signal.SIGKILL)
        with contextlib.suppress(ProcessLookupError, ValueError):
            self.process.kill()

    def failure(self, exit_code: int | None, last_words: str) -> Answer:
        if self.ending is Status.TIMEOUT:
            sentence = f"It was stopped at the limit of {self.task.seconds:g} s."
        elif self.ending is Status.OUT_OF_MEMORY:
            sentence = f"It was stopped at the limit of {self.task.memory_bytes / 2**20:.0f} MiB of memory."
        elif exit_code is not None and exit_code < 0:
            sentence = f"Its process was ended by {signal.Signals(-exit_code).name}.{last_words}"
        else:
            sentence = f"Its process ended with exit code {exit_code} and left no answer.{last_words}"
        return Answer(status=self.ending or Status.CRASHED, finding=Finding.NONE, sentence=sentence)


def _read_record(folder: Path) -> dict[str, Any] | None:
    try:
        record: dict[str, Any] = json.loads((folder / "answer.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    answer = record["answer"]
    answer["status"] = Status(answer["status"])
    answer["finding"] = Finding(answer["finding"])
    answer["bracket"] = tuple(answer["bracket"]) if answer["bracket"] is not None else None
    record["answer"] = Answer(**answer)
    return record


def _last_words(folder: Path) -> str:
    try:
        lines = (folder / "output.txt").read_text(encoding="utf-8", errors="replace").strip().splitlines()
    except OSError:
        return ""
    return f" It last printed: {lines[-1][:200]}" if lines else ""
