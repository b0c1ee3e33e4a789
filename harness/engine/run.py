"""One run: a method on a wall with its settings and limits, and the one key under which its result is kept."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from harness.engine.provenance import code_version, machine, versions
from harness.engine.worker import Task
from harness.model.assembly import Assembly, FloatArray
from harness.model.case import Reference
from harness.model.foreign.register import program_named
from harness.model.method import Traits
from harness.model.result import Judgement, Result, relative_velocities, result_of

LONGEST = 1e9
"""Seconds that a run may be given: thirty years, which clocks and timers still count."""
MOST_MEMORY = 2**30
"""Mebibytes that a run may be given, which systems still count in bytes."""


@dataclass(frozen=True)
class Limits:
    """What one run may use: wall-clock time [s] and resident memory [bytes]."""

    seconds: float = 120.0
    memory_bytes: int = 4 * 2**30

    def as_dict(self) -> dict[str, float]:
        """The limits as JSON values."""
        return {"seconds": self.seconds, "memory_bytes": float(self.memory_bytes)}


class Analysed(Protocol):
    """A wall as a run sees it: a `Case`, or a wall of a study."""

    @property
    def id(self) -> str:
        """The name under which its results are listed."""
        ...

    @property
    def content(self) -> str:
        """Hash of what decides an answer (`harness.model.content.hash_of`)."""
        ...

    @property
    def assembly(self) -> Assembly:
        """Its numeric view; raises InputError where its data are no wall."""
        ...

    @property
    def warnings(self) -> Sequence[str]:
        """What a person should hear about it."""
        ...


@dataclass(frozen=True, eq=False)
class Motion:
    """How the joints move in the mechanism that a run found on a neighbouring wall, or under other loads.

    Attributes:
        found_by: key of the run that found it.
        joints: (m, 3) openings at both ends and slip.
    """

    found_by: str
    joints: FloatArray

    @classmethod
    def of(cls, found_by: str, assembly: Assembly, mechanism: Sequence[Sequence[float]]) -> Motion:
        """How the joints of a wall move in the mechanism (n, 3) that a run of this key found."""
        return cls(found_by, np.column_stack(relative_velocities(assembly, np.asarray(mechanism, dtype=float))))

    @cached_property
    def key(self) -> str:
        """Content hash of the motion."""
        return hashlib.sha256(np.ascontiguousarray(self.joints).tobytes()).hexdigest()[:16]


class Judge(Protocol):
    """What says whether an answer proves its claim: of a wall, a result, and the tolerance of its method."""

    def __call__(self, assembly: Assembly, result: Result, tolerance: float, /) -> Judgement:
        """See `harness.engine.judge.judge`."""
        ...


@dataclass(frozen=True)
class Run:
    """One run to be made or found in the store.

    Attributes:
        case: the wall.
        method, settings: what is asked; settings are those that differ from the defaults.
        limits: of the run; None: it has none, which only a run in this process can.
        references: it is compared with these.
        given: motions that other runs found, which it takes up in place of a search of its own.
        processes: that it may use side by side; they change no answer.
        kept: whether its result may be kept: not where the method is an object that is not installed.
        judge: of what is asked; None: `harness.engine.judge.judge`, the judge of multipliers. Stored results are judged
            anew, so that it is no part of the key.
    """

    case: Analysed
    method: str
    settings: Mapping[str, Any]
    limits: Limits | None
    references: tuple[Reference, ...] = ()
    given: tuple[Motion, ...] = ()
    processes: int = 1
    kept: bool = True
    judge: Judge | None = None

    @cached_property
    def key(self) -> str:
        """Content hash of wall, method, settings, limits, code and motions; empty for a result that is not kept."""
        if not self.kept:
            return ""
        limits = {} if self.limits is None else self.limits.as_dict()
        motions = [motion.key for motion in self.given]
        asked = [self.case.content, self.method, dict(self.settings), limits, code_version(self.method), *motions]
        text = json.dumps(asked, sort_keys=True, allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()[:32]

    def task(self, assembly: Assembly) -> Task:
        """What the process that makes it is given."""
        seconds, memory = (math.inf, 0) if self.limits is None else (self.limits.seconds, self.limits.memory_bytes)
        motions = tuple(motion.joints for motion in self.given)
        program = program_named(self.method)
        return Task(self.method, assembly, dict(self.settings), seconds, memory, motions, self.processes, program)


@dataclass(frozen=True)
class TimedResult:
    """A result with the tolerance its method asks the judge for."""

    result: Result
    tolerance: float


def measured_result(
    record: Mapping[str, Any], task: Task, case: str, begun: str, limits: Mapping[str, float]
) -> TimedResult:
    """The result of a run, with where, when and under which limits it was made.

    Args:
        record: answer, cost [s, bytes], and what the method says of itself: family, traits, tolerance, settings.
        task: the run.
        case: id of its wall.
        begun: ISO time [UTC].
        limits: it was made under; empty: none.
    """
    result = result_of(
        record["answer"],
        task.assembly,
        case=case,
        method=task.method,
        family=record.get("family") or task.method.split("-", maxsplit=1)[0],
        traits=Traits.model_validate(record.get("traits") or {}),
    )
    update = {
        "cpu_seconds": record["cpu_seconds"],
        "wall_seconds": record["wall_seconds"],
        "peak_memory_bytes": record["peak_memory_bytes"],
        "settings": record.get("settings") or task.settings,
        "limits": dict(limits),
        "versions": versions() | ({task.method: version} if (version := record.get("version")) else {}),
        "machine": machine(),
        "started": begun,
    }
    return TimedResult(result.model_copy(update=update), float(record.get("tolerance") or 0.0))
