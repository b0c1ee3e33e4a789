"""Runs on the workers of a Dask scheduler, which may be other machines. Only this process writes the store.

A worker makes each run in a child process of its own, as the local executor does, and says who it is first: other code
or other versions are refused. Runs of lost workers are made again by the scheduler, those of a lost scheduler by this
process, which waits for it to come back.
"""

from __future__ import annotations

import itertools
import multiprocessing
import sys
import time
from collections.abc import Collection, Generator, Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

from harness.engine.executors import Job, Slots
from harness.engine.isolate import LOOK_SECONDS, ended_run, start_context
from harness.engine.provenance import code_version, versions
from harness.engine.run import TimedResult
from harness.engine.worker import Task
from harness.model.errors import InputError

_AHEAD = 4
"""Runs that wait at the scheduler for each thread of a worker, so that none is idle."""
CONNECT_SECONDS = 15.0
"""How long a scheduler is waited for at first."""
_RETURN_SECONDS = 300.0
"""How long a scheduler that was lost is waited for."""
_LOST = (OSError, RuntimeError)
"""What closing a client raises where the scheduler is gone: a connection closed or silent, an event loop that ended."""
_MISSING = "it needs Dask: pip install 'drystone[cluster]'"

_CODE = "code of "
_Identity = dict[str, str]


def _identity(methods: Collection[str]) -> _Identity:
    """What must be the same on every machine: the code of the methods and the versions of what computes."""
    known = {name: number for name, number in versions().items() if name != "commit"}
    return known | {f"{_CODE}{method}": code_version(method) for method in sorted(methods)}


def _difference(ours: _Identity, theirs: _Identity) -> str:
    """What differs, as a sentence; empty if nothing does."""
    names = [name for name in ours if ours[name] != theirs.get(name)]
    return "; ".join(f"{name} is {theirs.get(name, 'missing')} there and {ours[name]} here" for name in names[:3])


class ClusterExecutor:
    """The workers of a Dask scheduler.

    Args:
        address: of the scheduler, e.g. "tcp://10.0.0.1:8786".

    Raises:
        InputError: Dask is not installed, or nobody answers at the address.
    """

    def __init__(self, address: str) -> None:
        try:
            import distributed
        except ImportError:
            raise InputError("a scheduler is named", _MISSING, "--scheduler") from None
        self._library: Any = distributed
        self._address = address
        self._connect(CONNECT_SECONDS).close()

    def map(self, jobs: Iterable[Job], methods: Collection[str]) -> Generator[tuple[int, TimedResult]]:
        """See `harness.engine.executors.Executor`."""
        ours = _identity(methods)
        coming, left = iter(jobs), dict[int, Job]()
        while True:
            client = self._connect(_RETURN_SECONDS)
            try:
                self._same_everywhere(client, ours, methods)
                yield from self._through(client, coming, left, ours)
                return
            except (OSError, TimeoutError, self._library.CancelledError, RuntimeError) as error:
                print(
                    f"drystone: the scheduler was lost ({type(error).__name__}): waiting", file=sys.stderr, flush=True
                )
            finally:
                with suppress(*_LOST):
                    client.close(timeout=5)

    def _through(
        self, client: Any, coming: Iterator[Job], left: dict[int, Job], ours: _Identity
    ) -> Generator[tuple[int, TimedResult]]:
        """Results through one client; `left` holds the jobs whose results have not been given."""
        under_way: dict[Any, int] = {}

        def submit(job: Job) -> None:
            left[job.number] = job
            future = client.submit(_make_run, job.task, job.case, ours, key=f"run-{job.number}-{job.case}", pure=False)
            under_way[future] = job.number
            ended.add(future)

        ended = self._library.as_completed(raise_errors=False)
        for job in list(left.values()):
            submit(job)
        room = _AHEAD * max(1, sum(client.nthreads().values()))
        for job in itertools.islice(coming, max(0, room - len(under_way))):
            submit(job)
        while under_way:
            future = self._next(client, ended)
            number = under_way.pop(future)
            if future.status != "finished":
                error = future.exception() if future.status == "error" else None
                if isinstance(error, InputError):
                    raise error
                if error is not None and type(error).__name__ == "KilledWorker":
                    raise InputError(
                        f"the run of {left[number].task.method} on {left[number].case} ended several workers",
                        "Look at the workers' logs",
                        "--scheduler",
                    )
                raise self._library.CancelledError(f"run {number}: {error}")
            measured = future.result()
            del left[number]
            for job in itertools.islice(coming, 1):
                submit(job)
            yield number, measured

    def _next(self, client: Any, ended: Any) -> Any:
        """The next future that ended; raises if the connection is lost meanwhile."""
        while True:
            if ended.has_ready():
                return next(ended)
            if client.status not in ("running",):
                raise OSError(f"the connection is {client.status}")
            time.sleep(LOOK_SECONDS)

    def _same_everywhere(self, client: Any, ours: _Identity, methods: Collection[str]) -> None:
        """Refuse workers of other code or versions before anything is run."""
        client.wait_for_workers(1, timeout=_RETURN_SECONDS)
        for worker, theirs in client.run(_identity, list(methods), on_error="return").items():
            if not isinstance(theirs, dict):
                raise InputError(f"the worker {worker} has no Drystone of this kind ({theirs})", _REMEDY, "--scheduler")
            differs = _difference(ours, theirs)
            if differs:
                raise InputError(f"the worker {worker} computes otherwise: {differs}", _REMEDY, "--scheduler")

    def _connect(self, seconds: float) -> Any:
        deadline = time.monotonic() + seconds
        while True:
            try:
                return self._library.Client(self._address, timeout=5, name="drystone")
            except (OSError, TimeoutError, ValueError) as error:
                if isinstance(error, ValueError) or time.monotonic() > deadline:
                    raise InputError(
                        f"no scheduler answers at {self._address}",
                        "Start one (`dask scheduler`) and give its address, tcp://HOST:PORT",
                        "--scheduler",
                    ) from None
                time.sleep(0.5)


_REMEDY = "Install the same release, with the same versions, on every machine"
_slots: dict[str, Slots] = {}


def _make_run(task: Task, case: str, theirs: _Identity) -> TimedResult:
    """Make one run in a child process of this worker.

    Args:
        task: the run.
        case: id of its case.
        theirs: identity of the coordinator; a worker that joined late may be another.

    Raises:
        InputError: this worker has other code or other versions.
    """
    differs = _difference(
        theirs, _identity([name.removeprefix("code of ") for name in theirs if name.startswith("code")])
    )
    if differs:
        raise InputError(f"a worker that joined computes otherwise: {differs}", _REMEDY, "--scheduler")
    with _with_children():
        context = start_context([task.method])
        slots = _slots.setdefault(task.method, Slots(context))
        child, measured = ended_run(slots.begin(task, case), context)
        if child.reusable:
            slots.give_back(child)
        return measured


@contextmanager
def _with_children() -> Iterator[None]:
    """Let this process start children although Dask's nanny made it a daemon: they end with it by themselves."""
    process = multiprocessing.current_process()
    before, process.daemon = process.daemon, False
    try:
        yield
    finally:
        process.daemon = before
