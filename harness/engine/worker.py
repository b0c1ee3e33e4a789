"""What happens inside the child process that makes runs: limits, the method, its answer sent to the engine.

A child may make several runs, one after another, each with limits and cost of its own. This module is preloaded in the
fork server, so it imports what every method needs and nothing that starts threads.
"""

from __future__ import annotations

import contextlib
import json
import math
import multiprocessing
import os
import resource
import shutil
import signal
import sys
import threading
import time
import traceback
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from multiprocessing import connection
from pathlib import Path
from typing import Any

import numpy as np

from harness.engine.processes import adopt_orphans, cpu_seconds, end_left_over
from harness.model.answer_check import AnswerFault, checked, encodable
from harness.model.assembly import Assembly, FloatArray
from harness.model.deadline import Deadline, OutOfTime, answering_by
from harness.model.details import MISSING_PACKAGE
from harness.model.errors import InputError, MissingPackage, visible
from harness.model.foreign.program_method import method_of, running_in
from harness.model.foreign.register import Program
from harness.model.method import Answer, Finding, Method, Settings, Status, Traits, allowing
from harness.model.method_registry import check_takes, load_method, prepared
from harness.model.orphans import end_with_parent
from harness.model.reading import validate

_LAST_WORDS = (0.05, 5.0)
"""Share of the time limit, and at most so many seconds, that are left to a method to say how far it came."""

_ALARM = 0.25
"""Share of that time after which a method that does not ask for its deadline is stopped wherever it is."""


@dataclass(frozen=True)
class Task:
    """One run: a method on an assembly.

    Attributes:
        method: its name.
        assembly: the wall.
        settings: those that differ from the method's defaults.
        seconds: wall-clock limit [s].
        memory_bytes: limit of resident memory [bytes].
        motions: (m, 3) motions of the joints in mechanisms that the method shall take up (`Method.solve_from`) in place
            of a search of its own; none: it answers by itself.
        processes: that the run may use side by side.
        program: that the method is; None: it is installed.
    """

    method: str
    assembly: Assembly
    settings: dict[str, Any]
    seconds: float
    memory_bytes: int
    motions: tuple[FloatArray, ...] = ()
    processes: int = 1
    program: Program | None = None

    def stopped(self, limit: Status) -> str:
        """The sentence of a run that reached its limit of time (TIMEOUT) or of memory (OUT_OF_MEMORY)."""
        reached = f"{self.seconds:g} s" if limit is Status.TIMEOUT else f"{self.memory_bytes / 2**20:.0f} MiB of memory"
        return f"It was stopped at the limit of {reached}."


LOADED, REPLACE = b"loaded", b"replace"
"""What a child says besides its records: the method is loaded and begins; another process must make this run."""

_MOST_SAID = 500
"""Characters of an error that are kept."""


def serve(engine: connection.Connection, folder: str) -> None:
    """Make the runs whose tasks the engine sends, until it closes the connection. For child processes only.

    Args:
        engine: tasks come in; out go lines: LOADED when a method begins and then the record of the run, as JSON.
        folder: working directory, with what the runs print in `output.txt`.
    """
    os.setsid()
    _die_with_engine()
    adopt_orphans()
    os.chdir(folder)  # what a library drops in the working directory goes with the run
    _send_output_to(Path(folder) / "output.txt")
    _give_away_descriptors(engine)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    used = False
    try:
        while True:
            task = engine.recv()
            method, failure = _load(task)
            if used and method is not None and method.fresh_process:
                _send(engine, REPLACE)
                continue
            _send(engine, LOADED)
            with running_in(folder):
                record = _record(task, method, failure)
            record["reusable"] = _cleared(Path(folder)) and record["reusable"]
            _send(engine, json.dumps(record, allow_nan=False, default=np.ndarray.tolist).encode())
            used = True
    except (EOFError, BrokenPipeError, ConnectionResetError):
        pass
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)


def _load(task: Task) -> tuple[Method | None, Answer | None]:
    """The method of a task, or the answer that tells why there is none."""
    try:
        return prepared(loaded(task)), None
    except (InputError, KeyError) as error:
        answer = _failure(Status.REFUSED, f"{error}.")
        answer.details = {MISSING_PACKAGE: True} if isinstance(error, MissingPackage) else {}
        return None, answer


def loaded(task: Task) -> Method:
    """The method of a task, in whatever folder its process is.

    Raises:
        KeyError, InputError: as of `load_method`.
    """
    return load_method(task.method) if task.program is None else method_of(task.program)


def _send(engine: connection.Connection, line: bytes) -> None:
    """Send one line; the engine reads it without waiting for a rest that may not come."""
    left = memoryview(line + b"\n")
    while left:
        left = left[os.write(engine.fileno(), left) :]


def _record(task: Task, method: Method | None, failure: Answer | None) -> dict[str, Any]:
    """Make one run under its limits: answer, settings in full, cost of this run alone."""
    _limit_address_space(task.memory_bytes)
    _limit(resource.RLIMIT_FSIZE, task.memory_bytes)  # what it writes is limited as what it holds
    kept = [] if method is None else method.processes_kept()
    most_before = _forget_peak_memory(kept)
    settings: dict[str, Any] = {}
    about = {"family": "", "traits": Traits().model_dump(), "tolerance": 0.0, "version": ""}
    threads, errors = threading.active_count(), np.geterr()
    started, before = time.perf_counter(), cpu_seconds(kept)
    try:
        if method is None:
            answer = failure or _failure(Status.CRASHED, "There is no method.")
        else:
            chosen = validate(method.Settings, task.settings, "settings")
            settings = chosen.model_dump(mode="json")
            about = _about(method)
            check_takes(method, task.assembly)
            started, before = time.perf_counter(), cpu_seconds(kept)
            with allowing(task.processes), _warned_of_the_limit(task.seconds, started):
                answer = solved(method, task, chosen)
            answer = checked(answer, task.assembly)
    except OutOfTime:
        answer = _failure(Status.TIMEOUT, task.stopped(Status.TIMEOUT))
    except AnswerFault as error:
        answer = _failure(Status.CRASHED, f"{error.problem}.")
    except InputError as error:
        answer = _failure(Status.REFUSED, f"{error}.")
        answer.details = {MISSING_PACKAGE: True} if isinstance(error, MissingPackage) else {}
    except MemoryError:
        answer = _failure(Status.OUT_OF_MEMORY, task.stopped(Status.OUT_OF_MEMORY))
    except BaseException as error:  # SystemExit and the like as well: a method ends its run, not ours
        with contextlib.suppress(OSError, ValueError):  # its output may be closed
            traceback.print_exc()
        answer = _failure(
            Status.CRASHED, f"The method raised {type(error).__name__}: {visible(str(error))[:_MOST_SAID]}"
        )
    kept = [] if method is None else method.processes_kept()
    left = end_left_over(kept)
    cpu, wall = cpu_seconds(kept) - before, time.perf_counter() - started
    np.seterr(**errors)
    _limit_address_space(None)
    _limit(resource.RLIMIT_FSIZE, None)
    peak = _peak_memory(kept, most_before)
    if peak > task.memory_bytes:  # between two looks of the engine
        answer = _failure(Status.OUT_OF_MEMORY, task.stopped(Status.OUT_OF_MEMORY))
    return {
        "answer": vars(answer),
        **about,
        "settings": settings,
        "cpu_seconds": cpu,
        "wall_seconds": wall,
        "peak_memory_bytes": peak,
        "reusable": not left and threading.active_count() <= threads,
    }


def _about(method: Method) -> dict[str, Any]:
    """What a method says of itself.

    Raises:
        AnswerFault: it says what nothing can be made of.
    """
    traits, tolerance, family = method.traits, method.tolerance, method.family
    if not isinstance(traits, Traits):
        raise AnswerFault(f"The method's traits are {type(traits).__name__} instead of Traits")
    if not isinstance(tolerance, int | float) or not 0.0 <= tolerance < math.inf:
        raise AnswerFault(f"The method's tolerance is {tolerance!r}, which is no finite positive number")
    if not isinstance(family, str):
        raise AnswerFault(f"The method's family is {type(family).__name__} instead of text")
    said = {"family": encodable(family, "family"), "version": encodable(method.version, "version")}
    return said | {"traits": traits.model_dump(), "tolerance": float(tolerance)}


def solved(method: Method, task: Task, settings: Settings) -> Answer:
    """What a method answers: by itself, or from the motions that it is given.

    Raises:
        InputError: it takes up no motions.
    """
    if not task.motions:
        return method.solve(task.assembly, settings)
    if not method.follows_motions:
        raise InputError(f"{method.name} uses no mechanisms of other walls", "Let it answer by itself", "method")
    return method.solve_from(task.assembly, settings, task.motions)


def _cleared(folder: Path) -> bool:
    """Empty the working directory and the file of what was printed, for the next run; whether that could be done."""
    try:
        sys.stdout.flush()
        sys.stderr.flush()
        os.chdir(folder)
        for entry in os.scandir(folder):
            if entry.name == "output.txt":
                os.truncate(entry.path, 0)
            elif entry.is_dir(follow_symlinks=False):
                shutil.rmtree(entry.path, ignore_errors=True)
            else:
                os.unlink(entry.path)
    except (OSError, ValueError):  # its output was closed, or its folder is gone
        return False
    return True


def _forget_peak_memory(kept: Sequence[int]) -> int:
    """Let the system count the peak of resident memory anew (Linux; elsewhere it is that of the process so far).

    Returns:
        the peak of processes that were started here and have ended [bytes].
    """
    for pid in ("self", *kept):
        with contextlib.suppress(OSError):
            Path(f"/proc/{pid}/clear_refs").write_text("5", encoding="ascii")
    return _memory_of_ended()


def _peak_memory(kept: Sequence[int], ended_before: int) -> int:
    """Peak of resident memory of this run [bytes]: of this process, one that it keeps, or one that ended in the run."""
    ended = _memory_of_ended()
    return max(_peak_of("self"), *map(_peak_of, kept), ended if ended > ended_before else 0)


def _peak_of(pid: int | str) -> int:
    try:
        for line in Path(f"/proc/{pid}/status").read_text(encoding="ascii", errors="replace").splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024
    except OSError:
        pass
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 if pid == "self" else 0


def _memory_of_ended() -> int:
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024


@contextlib.contextmanager
def _warned_of_the_limit(seconds: float, begun: float) -> Iterator[None]:
    """Give a run begun then a deadline shortly before its limit, and raise OutOfTime where it does not ask for it.

    The alarm rings in Python, or when a library call returns to it; a run that was stopped before does not hear it.
    """
    share, most = _LAST_WORDS
    last_words = min(share * seconds, most)
    deadline = Deadline(begun + seconds - last_words)
    signal.signal(signal.SIGALRM, lambda *_: deadline.stop())
    left = deadline.at + _ALARM * last_words - time.perf_counter()
    signal.setitimer(signal.ITIMER_REAL, max(left, 1e-6))
    try:
        with answering_by(deadline):
            yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def _die_with_engine() -> None:
    """End this process with the engine that started it, even one that was killed.

    The fork server cannot tell: it lives as long as any process that holds its pipe, and this one does. Should it be
    killed itself, the kernel ends this process (Linux; elsewhere the wall limit must do).
    """
    end_with_parent()
    engine = multiprocessing.parent_process()
    if engine is None:
        return

    def follow() -> None:
        connection.wait([engine.sentinel])
        os._exit(1)

    threading.Thread(target=follow, daemon=True).start()


def _send_output_to(path: Path) -> None:
    sink = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    os.dup2(sink, 1)
    os.dup2(sink, 2)
    os.close(sink)


def _give_away_descriptors(engine: connection.Connection) -> None:
    """Let every inherited descriptor lead nowhere, but the engine's: a method must not write into what is not its own.

    A child that was forked holds the store and the terminal of the command; one of the fork server holds the server's
    pipe, which ends the server when something is written to it. They are not closed, as their owners might close them
    once more when another file has the number.
    """
    parent = multiprocessing.parent_process()
    kept = {0, 1, 2, engine.fileno(), -1 if parent is None else parent.sentinel}
    nowhere = os.open(os.devnull, os.O_RDWR)
    for number in {int(name) for name in os.listdir("/dev/fd")} - kept - {nowhere}:
        with contextlib.suppress(OSError):  # that of the listing itself
            os.fstat(number)
            os.dup2(nowhere, number, inheritable=False)
    os.close(nowhere)


def _limit_address_space(memory_bytes: int | None) -> None:
    """Let an allocation beyond the limit fail inside the process; the parent watches resident memory besides."""
    with contextlib.suppress(OSError):
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
        _limit(resource.RLIMIT_AS, None if memory_bytes is None else pages * resource.getpagesize() + memory_bytes)


def _limit(what: int, most: int | None) -> None:
    """Set a limit of this process [bytes]; None: as high as it may be."""
    with contextlib.suppress(OSError, ValueError):
        hard = resource.getrlimit(what)[1]
        resource.setrlimit(what, (hard if most is None else most, hard))


def _failure(status: Status, sentence: str) -> Answer:
    return Answer(status=status, finding=Finding.NONE, sentence=sentence)
