"""Runs in child processes: started from a fork server, watched, and killed as a group when one must end."""

from __future__ import annotations

import contextlib
import functools
import json
import multiprocessing
import os
import signal
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from datetime import UTC, datetime
from enum import Enum
from multiprocessing import forkserver
from multiprocessing.connection import wait
from multiprocessing.context import BaseContext
from pathlib import Path
from types import ModuleType
from typing import Any

from harness.engine import preload, worker
from harness.engine.processes import end_descendants, resource_use
from harness.engine.run import Limits, TimedResult, measured_result
from harness.engine.threads import pin
from harness.engine.worker import Task
from harness.model.answer_check import checked
from harness.model.errors import InputError, visible
from harness.model.json_text import LARGEST_FILE
from harness.model.method import Answer, Finding, Status

LOOK_SECONDS, LOOKS_AT_CHILDREN = 0.05, 10
"""How often memory and time of a run are looked at, and at which look those of what it started as well."""

_LOADING_SECONDS = 300.0
"""Wall time in which a method must be loaded, its kernels compiled if they never were; no run is charged for it."""

_LONG_SECONDS = 10.0
"""A child that made a run this long makes no other: starting one costs nothing beside it, and its memory is clean."""


_MOST_READ = 4096
"""Bytes that are read at the end of what a run printed."""


@functools.cache
def _fork_server() -> multiprocessing.context.ForkServerContext:
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([worker.__name__, preload.__name__])
    return context


_announced: set[str] = set()


def preload_methods(methods: Iterable[str]) -> None:
    """Name methods that are going to be run: the fork server loads once what was named before it starts."""
    _announced.update(preload.shipped(methods))


def start_context(methods: Iterable[str]) -> BaseContext:
    """Where children come from: a fork server that has loaded the methods once.

    The server starts with the first call and keeps what it loaded then; other methods are loaded by the children.
    """
    pin()
    preload_methods(methods)
    context = _fork_server()
    os.environ[preload.VARIABLE] = ",".join(sorted(_announced))
    try:
        with _script_left_out():
            forkserver.ensure_running()
    finally:  # for the server alone: every other process that is started here would load the methods too
        del os.environ[preload.VARIABLE]
    return context


@contextlib.contextmanager
def _script_left_out() -> Iterator[None]:
    """Let children that are started inside not import the user's script, of which they need nothing.

    A script that compares walls at its top level would start its comparison again in each of them.
    """
    script = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = script


def own_context(methods: Iterable[str]) -> BaseContext | None:
    """Children forked from this very process, after it has loaded the methods; None if it has threads.

    One run alone is cheapest so: a fork server would be a second interpreter.
    """
    preload.load(methods)
    try:
        threads = len(os.listdir("/proc/self/task"))
    except OSError:
        return None
    return multiprocessing.get_context("fork") if threads == 1 else None


def run_isolated(task: Task, case: str) -> TimedResult:
    """Run a task in a fresh child process. Whatever happens there becomes a result with a sentence.

    Args:
        task: method, assembly, settings and limits.
        case: id of the case, for the result.
    """
    context = start_context([task.method])
    child = Child(context)
    child.begin(task, case)
    child, measured = ended_run(child, context)
    if child.reusable:
        child.end()
    return measured


def ended_run(child: Child, context: BaseContext) -> tuple[Child, TimedResult]:
    """Wait for the run that a child has begun, and make it once more in a fresh child where it must be.

    Returns:
        the child that made it, if it may make another run (else it has ended), and the run.
    """
    try:
        while True:
            wait(child.waitables, timeout=LOOK_SECONDS)
            found = child.look()
            if isinstance(found, TimedResult):
                break
            if found is Retry.FRESH:
                task, case = child.task, child.case
                child.end()
                child = Child(context)
                child.begin(task, case, last=True)
    except BaseException:
        child.end()
        raise
    if not child.reusable:
        child.end()
    return child, found


class Retry(Enum):
    """What a child says of a run that another must make."""

    FRESH = "in a fresh process"


class Child:
    """A child process that makes runs one after another, and all that the engine knows of the present one.

    Args:
        context: where it comes from.
        owner: name of a method of a user whose runs alone it makes; empty: it makes those of Drystone's own.
    """

    def __init__(self, context: BaseContext, owner: str = "") -> None:
        self.owner = owner
        self._folder = tempfile.TemporaryDirectory(prefix="drystone-", ignore_cleanup_errors=True)
        self._connection, theirs = context.Pipe()
        self._process: Any = context.Process(  # type: ignore[attr-defined]
            target=worker.serve, args=(theirs, self._folder.name), daemon=False
        )
        with _script_left_out():
            self._process.start()
        theirs.close()
        self.runs = 0
        self.reusable = True
        self._came = bytearray()
        self._run: _RunningJob | None = None
        self._last = False

    @property
    def waitables(self) -> list[Any]:
        """What `multiprocessing.connection.wait` may wait for."""
        return [self._connection, self._process.sentinel]

    @property
    def pid(self) -> int:
        """Number of its process."""
        return int(self._process.pid)

    @property
    def task(self) -> Task:
        """The task under way."""
        return self._under_way.task

    @property
    def case(self) -> str:
        """Id of the case of the task under way."""
        return self._under_way.case

    @property
    def _under_way(self) -> _RunningJob:
        assert self._run is not None, "no run was begun"
        return self._run

    def begin(self, task: Task, case: str, *, last: bool = False) -> None:
        """Send a task. With `last` its row is made here whatever happens; it was begun elsewhere before."""
        self._run, self._last = _RunningJob(task, case, self._process.pid), last
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):  # its end is noticed by the next look
            self._connection.send(task)

    def look(self) -> TimedResult | Retry | None:
        """The measured run if it has ended; else None, after its use of time and memory was looked at.

        A run is made again where its method asks for a fresh process, and once where the process was killed from
        outside (SIGKILL): no method does that to itself, the system short of memory and people do.
        """
        run = self._under_way
        try:
            for line in self._lines():
                if line == worker.REPLACE and not run.begun_by_method and not self._last:
                    self.reusable = False
                    return Retry.FRESH
                if line == worker.LOADED and not run.begun_by_method:
                    run.loaded()
                else:
                    return self._measured(run, line)
        except (EOFError, ConnectionResetError):
            self._process.join(timeout=LOOK_SECONDS)
        if not self._process.is_alive():
            self.reusable = False
            killed = self._process.exitcode == -signal.SIGKILL and not self._last
            return Retry.FRESH if killed else self._failed(run)
        run.look()
        if run.ending is not None:
            self._kill()
            self._process.join()
            return self._failed(run)
        return None

    def _lines(self) -> Iterator[bytes]:
        """Whole lines that have come; the rest of one is not waited for, since a method may have written its begin."""
        while self._connection.poll():
            part = os.read(self._connection.fileno(), 2**20)
            if not part:
                raise EOFError
            self._came += part
            while b"\n" in part:
                line, _, rest = self._came.partition(b"\n")
                self._came, part = rest, bytes(rest)
                yield bytes(line)
            if len(self._came) > LARGEST_FILE:
                yield bytes(self._came)

    def _measured(self, run: _RunningJob, line: bytes) -> TimedResult:
        """The run whose record is a line. What a method has changed in its process may have written anything."""
        try:
            record = json.loads(line)
            reusable = record["reusable"] is True and record["wall_seconds"] < _LONG_SECONDS
            measured = run.measured(record | {"answer": checked(Answer(**record["answer"]), run.task.assembly)})
        except (InputError, ValueError, TypeError, KeyError, RecursionError):
            self._kill()
            self._process.join()
            begins = visible(line[:40].decode("utf-8", "replace"))
            run.wrong = f'It wrote into the engine\'s own channel, where "{begins}" is no record of a run.'
            return self._failed(run)
        self._run = None
        self.runs += 1
        self.reusable = self.reusable and reusable
        return measured

    def _failed(self, run: _RunningJob) -> TimedResult:
        self._run = None
        self.reusable = False
        answer = run.failure(self._process.exitcode, _last_words(Path(self._folder.name)))
        cost = {"cpu_seconds": run.cpu_seconds, "wall_seconds": run.elapsed(), "peak_memory_bytes": run.peak_memory}
        return run.measured({"answer": answer} | cost)

    def _kill(self) -> None:
        """End all that the child has started, and the whole process group; the child has made itself its leader."""
        end_descendants(self._process.pid)
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        with contextlib.suppress(ProcessLookupError, ValueError):
            self._process.kill()

    def end(self) -> None:
        """End the child and whatever it started."""
        self._kill()
        self._process.join()
        self._process.close()
        self._connection.close()
        self._folder.cleanup()


class _RunningJob:
    """A run under way: its use of time and memory, and how it was ended if it had to be."""

    def __init__(self, task: Task, case: str, pid: int) -> None:
        self.task, self.case = task, case
        self.begun = datetime.now(UTC).isoformat(timespec="seconds")
        self._clock = time.perf_counter()
        self._deadline = self._clock + _LOADING_SECONDS
        self._pid = pid
        self._looks, self._next_look = 0, self._clock + LOOK_SECONDS
        self._cpu_before: float | None = None
        self.cpu_seconds: float | None = None
        self.peak_memory: int | None = None
        self.ending: Status | None = None
        self.begun_by_method = False
        self.wrong = ""

    def loaded(self) -> None:
        """The time of the method itself begins."""
        self.begun_by_method = True
        self._clock = time.perf_counter()
        self._deadline = self._clock + self.task.seconds

    def elapsed(self) -> float:
        """Wall time of the method so far [s]."""
        return time.perf_counter() - self._clock

    def look(self) -> None:
        """Take stock of memory and CPU time if it is time to, and see whether a limit is passed."""
        if (now := time.perf_counter()) < self._next_look:
            return
        self._next_look = now + LOOK_SECONDS
        self._looks += 1
        found = resource_use(self._pid, with_children=self._looks % LOOKS_AT_CHILDREN == 0)
        if found is not None:
            memory, cpu = found
            self._cpu_before = cpu if self._cpu_before is None else self._cpu_before
            self.peak_memory = max(self.peak_memory or 0, memory)
            self.cpu_seconds = max(self.cpu_seconds or 0.0, cpu - self._cpu_before)
        if self.peak_memory is not None and self.peak_memory > self.task.memory_bytes:
            self.ending = Status.OUT_OF_MEMORY
        elif now > self._deadline:
            self.ending = Status.TIMEOUT

    def failure(self, exit_code: int | None, last_words: str) -> Answer:
        """The answer of a run whose process left none."""
        if self.wrong:
            sentence = self.wrong
        elif self.ending in (Status.TIMEOUT, Status.OUT_OF_MEMORY):
            sentence = self.task.stopped(self.ending)
        elif exit_code is not None and exit_code < 0:
            sentence = f"Its process was ended by {signal.Signals(-exit_code).name}.{last_words}"
        else:
            sentence = f"Its process ended with exit code {exit_code} and left no answer.{last_words}"
        return Answer(status=self.ending or Status.CRASHED, finding=Finding.NONE, sentence=sentence)

    def measured(self, record: dict[str, Any]) -> TimedResult:
        """The result of a record, with where, when and under which limits it was made."""
        limits = Limits(self.task.seconds, self.task.memory_bytes).as_dict()
        return measured_result(record, self.task, self.case, self.begun, limits)


def _last_words(folder: Path) -> str:
    """The end of what a run printed; it may have printed more than memory holds."""
    try:
        with open(folder / "output.txt", "rb") as file:
            file.seek(max(0, os.fstat(file.fileno()).st_size - _MOST_READ))
            lines = file.read(_MOST_READ).decode("utf-8", "replace").strip().splitlines()
    except OSError:
        return ""
    return f" It last printed: {visible(lines[-1])[:200]}" if lines else ""
