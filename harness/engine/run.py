"""One run: a method on a wall with its settings and limits, and the one key under which its result is kept."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from harness.engine.executors import Job
from harness.engine.provenance import code_version, run_key
from harness.engine.worker import Task
from harness.model.case import Case, Reference
from harness.model.reading import wall_json


@dataclass(frozen=True)
class Limits:
    """What one run may use: wall-clock time [s] and resident memory [bytes]."""

    seconds: float = 120.0
    memory_bytes: int = 4 * 2**30

    def as_dict(self) -> dict[str, float]:
        """The limits as JSON values."""
        return {"seconds": self.seconds, "memory_bytes": float(self.memory_bytes)}


@dataclass(frozen=True)
class Run:
    """One run to be made or found in the store. `references` are those it is held against.

    `processes` are those that it may use side by side; they change no answer.
    """

    case: Case
    method: str
    settings: dict[str, Any]
    limits: Limits
    references: tuple[Reference, ...] = field(default=())
    processes: int = 1

    @cached_property
    def key(self) -> str:
        """The content hash under which its result is stored."""
        return run_key(
            wall_json(self.case.built.wall),
            self.method,
            self.settings,
            self.limits.as_dict(),
            code_version(self.method),
        )

    def job(self, number: int) -> Job:
        """The run as an executor makes it, under its number in the plan."""
        return Job(number, self.case.id, self.task())

    def task(self) -> Task:
        """What the child process is given."""
        limits = self.limits
        return Task(
            self.method,
            self.case.assembly,
            self.settings,
            limits.seconds,
            limits.memory_bytes,
            processes=self.processes,
        )
