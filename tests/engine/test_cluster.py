"""A real scheduler with workers on the loopback: the same bits, nothing lost, nothing doubled, strangers refused."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

pytest.importorskip("distributed")

from harness.engine.cluster import ClusterExecutor
from harness.engine.executors import LocalExecutor
from harness.engine.store import open_store
from harness.engine.sweep.frame import tidy
from harness.engine.sweep.running import sweep
from harness.model.errors import InputError
from tests.engine.studies import runs_of, study

ROOT = Path(__file__).resolve().parents[2]
COST = ["cpu_seconds", "wall_seconds", "peak_memory_bytes", "started"]
ASKED = study(vary={"friction": {"from": 0.1, "to": 0.9, "count": 60}}, methods=["la-associated", "fe"])


class Cluster:
    """A scheduler on a free port and the workers started for it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.processes: list[subprocess.Popen[bytes]] = []

    def start(self, *words: str, path: str = "") -> subprocess.Popen[bytes]:
        environment = os.environ | {"OMP_NUM_THREADS": "1", "PYTHONPATH": path or str(ROOT)}
        log = (self.folder / f"{len(self.processes)}.log").open("wb")
        process = subprocess.Popen(
            [sys.executable, "-m", *words, "--no-dashboard"],
            *(-1, None, subprocess.DEVNULL, log, log),
            cwd=self.folder,
            env=environment,
            start_new_session=True,
        )
        self.processes.append(process)
        return process

    def scheduler(self) -> subprocess.Popen[bytes]:
        words = ("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", str(self.port))
        process = self.start(*words)
        deadline = time.monotonic() + 60.0
        while time.monotonic() < deadline:
            with suppress(OSError), socket.create_connection(("127.0.0.1", self.port), timeout=1.0):
                return process
            time.sleep(0.2)
        raise AssertionError("the scheduler does not listen")

    def worker(self, path: str = "") -> subprocess.Popen[bytes]:
        words = ("distributed.cli.dask_worker", self.address, "--nthreads", "1", "--local-directory", str(self.folder))
        return self.start(*words, path=path)


def end(process: subprocess.Popen[bytes]) -> None:
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


@contextmanager
def cluster(folder: Path) -> Iterator[Cluster]:
    made = Cluster(folder)
    try:
        yield made
    finally:
        for process in made.processes:
            end(process)


def results(made: Cluster, store: Path, after: int = 0, happens: Callable[[], None] = lambda: None):
    rows = []
    with open_store(store) as opened:
        for _, row, _ in sweep(runs_of(ASKED), opened, ClusterExecutor(made.address)):
            rows.append(row)
            if len(rows) == after:
                happens()
        assert len(opened.table()) == len({row["key"] for row in rows})
    return tidy(rows, ["friction"])


@pytest.fixture(scope="module")
def local(tmp_path_factory: pytest.TempPathFactory):
    with open_store(tmp_path_factory.mktemp("local") / "s.sqlite") as opened:
        rows = [row for _, row, _ in sweep(runs_of(ASKED), opened, LocalExecutor(2))]
    return tidy(rows, ["friction"]).drop(columns=COST)


@pytest.mark.slow
def test_runs_of_a_killed_worker_are_made_again_with_the_same_bits(tmp_path: Path, local):
    with cluster(tmp_path) as made:
        made.scheduler()
        first, _ = made.worker(), made.worker()
        found = results(made, tmp_path / "s.sqlite", 25, lambda: end(first))
    assert found.drop(columns=COST).equals(local)


@pytest.mark.slow
def test_a_scheduler_that_is_lost_and_comes_back_costs_nothing(tmp_path: Path, local):
    with cluster(tmp_path) as made:
        started = [made.scheduler(), made.worker(), made.worker()]

        def restart() -> None:
            for process in started:
                end(process)
            made.scheduler()
            made.worker()
            made.worker()

        found = results(made, tmp_path / "s.sqlite", 25, restart)
    assert found.drop(columns=COST).equals(local)


@pytest.mark.slow
def test_a_worker_with_other_code_is_refused_with_a_sentence(tmp_path: Path):
    other = tmp_path / "other"
    for package in ("harness", "methods", "cases", "reports"):
        shutil.copytree(ROOT / package, other / package, ignore=shutil.ignore_patterns("__pycache__", "cases"))
    source = other / "methods" / "la" / "methods.py"
    source.write_text(source.read_text() + "\n# changed\n")
    with cluster(tmp_path) as made:
        made.scheduler()
        made.worker(path=str(other))
        with pytest.raises(InputError, match=r"code of la-associated is .* there and .* here"):
            results(made, tmp_path / "s.sqlite")


def test_nobody_at_the_address_is_told(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("harness.engine.cluster.CONNECT_SECONDS", 1.0)
    with pytest.raises(InputError, match="no scheduler answers"):
        ClusterExecutor("tcp://127.0.0.1:9")
