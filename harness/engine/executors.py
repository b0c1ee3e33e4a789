"""Where runs are made: one `map` from tasks to measured results, by the processes of this machine."""

from __future__ import annotations

import itertools
import time
from collections.abc import Collection, Generator, Iterable
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from multiprocessing.connection import wait
from multiprocessing.context import BaseContext
from typing import Protocol

from harness.engine import preload
from harness.engine.isolate import LOOK_SECONDS, Child, Retry, own_context, start_context
from harness.engine.processes import cpu_seconds
from harness.engine.run import TimedResult, measured_result
from harness.engine.worker import Task, loaded, solved
from harness.model.answer_check import checked
from harness.model.method import Method, allowing
from harness.model.method_registry import check_takes, prepared
from harness.model.reading import validate

_RUNS_A_CHILD = 500
"""Runs after which a child process is replaced, so that nothing grows without end."""

_WARM_BLOCKS = 200
"""Blocks of a wall above which every run has a process of its own: its cost is nothing beside such a run."""


@dataclass(frozen=True)
class Job:
    """A run to be made: its number in the plan, the id of its case, and its task."""

    number: int
    case: str
    task: Task


class Executor(Protocol):
    """A place where runs are made."""

    def map(self, jobs: Iterable[Job], methods: Collection[str]) -> Generator[tuple[int, TimedResult]]:
        """Numbers and results of jobs, in the order in which they end.

        Args:
            jobs: asked for one by one, as there is room for them.
            methods: names of all methods that may occur.

        Closing the generator stops what is under way.
        """
        ...


class LocalExecutor:
    """Child processes of this machine, so many at a time, each making many small runs or one large one."""

    def __init__(self, processes: int) -> None:
        self.processes = max(1, processes)

    def map(self, jobs: Iterable[Job], methods: Collection[str]) -> Generator[tuple[int, TimedResult]]:
        """See `Executor`."""
        coming = iter(jobs)
        first = list(itertools.islice(coming, 2))
        waiting, busy = itertools.chain(first, coming), dict[Child, Job]()
        slots = Slots((own_context(methods) if len(first) == 1 else None) or start_context(methods))

        def occupy() -> None:
            for job in itertools.islice(waiting, self.processes - len(busy)):
                busy[slots.begin(job.task, job.case)] = job

        try:
            occupy()
            while busy:
                wait([place for child in busy for place in child.waitables], timeout=LOOK_SECONDS)
                ended = [(child, job, found) for child, job in busy.items() if (found := child.look()) is not None]
                for child, job, found in ended:
                    del busy[child]
                    slots.give_back(child)
                    if found is Retry.FRESH:
                        busy[slots.begin(job.task, job.case, last=True)] = job
                occupy()  # before the caller is given results, so that the children work while it does
                for _, job, found in ended:
                    if isinstance(found, TimedResult):
                        yield job.number, found
        finally:
            for child in busy:
                child.end()
            slots.end()


class InProcess:
    """This process, one run after another and without limits; what a method raises is raised.

    Args:
        method: makes all runs; None: those that the tasks name.
    """

    def __init__(self, method: Method | None = None) -> None:
        self._method = method

    def map(self, jobs: Iterable[Job], methods: Collection[str]) -> Generator[tuple[int, TimedResult]]:
        """See `Executor`."""
        for job in jobs:
            yield job.number, self._measured(job)

    def _measured(self, job: Job) -> TimedResult:
        task = job.task
        method = prepared(self._method or loaded(task))
        settings = validate(method.Settings, task.settings, "settings")
        check_takes(method, task.assembly)
        own = replace(task, assembly=task.assembly.copied())  # what a method does to its wall is its own
        begun, clock, work = datetime.now(UTC), time.perf_counter(), cpu_seconds(method.processes_kept())
        with allowing(task.processes):
            answer = checked(solved(method, own, settings), task.assembly)
        record = {
            "answer": answer,
            "cpu_seconds": cpu_seconds(method.processes_kept()) - work,
            "wall_seconds": time.perf_counter() - clock,
            "peak_memory_bytes": None,
            "settings": settings.model_dump(mode="json"),
            "family": method.family,
            "version": method.version,
            "traits": method.traits.model_dump(),
            "tolerance": method.tolerance,
        }
        return measured_result(record, task, job.case, begun.isoformat(timespec="seconds"), {})


class Slots:
    """Child processes between runs: one that made a small run is kept for the next small run."""

    def __init__(self, context: BaseContext) -> None:
        self._context = context
        self._idle: list[Child] = []

    def begin(self, task: Task, case: str, *, last: bool = False) -> Child:
        """A child that has begun the task; with `last` a fresh one, see `Child.begin`."""
        owner = _owner(task)
        kept = next((child for child in self._idle if child.owner == owner), None)
        if kept is None or not _small(task) or last:
            kept = Child(self._context, owner)
        else:
            self._idle.remove(kept)
        kept.begin(task, case, last=last)
        return kept

    def give_back(self, child: Child) -> None:
        """Take a child that has ended its run: keep it, or end it where another must make the next."""
        if child.reusable and child.runs < _RUNS_A_CHILD:
            self._idle.append(child)
        else:
            child.end()

    def end(self) -> None:
        """End the children that are kept."""
        while self._idle:
            self._idle.pop().end()


def _owner(task: Task) -> str:
    """Whose runs a child may make: all of Drystone's own methods together, or those of one method of a user.

    What a method leaves in its process (changed modules, signal handlers, locales) reaches its own runs only.
    """
    return "" if preload.shipped([task.method]) else task.method


def _small(task: Task) -> bool:
    return task.assembly.n_blocks <= _WARM_BLOCKS
