"""What the harness costs beside its methods: `python -m benchmarks overhead [--full]`.

Figures are CPU seconds of everything a command starts, so that a busy machine does not change them. `--full` also makes
the suite, the report of the library and 10,000 runs (about a quarter of an hour on two cores).
"""

from __future__ import annotations

import ctypes
import json
import os
import resource
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import closing, suppress
from pathlib import Path

import pandas as pd
import psutil

from cases.families import wall_21
from harness.engine.executors import LocalExecutor
from harness.engine.store import COLUMNS, TABLE, open_store
from harness.engine.sweep.expand import SweepRun, expand, sources_of
from harness.engine.sweep.running import sweep
from harness.engine.sweep.study import Study
from harness.engine.threads import pin
from harness.model.reading import wall_json

SUBREAPER = 36
"""prctl option that makes this process inherit orphans, so that what they used is counted (Linux)."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    full = "--full" in (sys.argv[1:] if arguments is None else arguments)
    pin()
    ctypes.CDLL(None).prctl(SUBREAPER, 1)
    print(f"{'what':<58} {'measured':>12} {'target':>8}")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _line("drystone --version, CPU s", command_cost(folder, "--version"), 0.15)
        _line(
            "drystone run la-associated single-block, CPU s",
            command_cost(folder, "run", "la-associated", "single-block"),
            0.5,
        )
        _line("drystone run fe wall-21, CPU s", command_cost(folder, "run", "fe", "wall-21"), 0.6)
        if full:
            _line("suite small, CPU s", command_cost(folder, "compare", "--suite", "small"), 22.0)
            command_cost(folder, "compare", "--suite", "all", "--no-report", repeats=1)
            _line("report of the whole library again, CPU s", command_cost(folder, "report", repeats=4), 2.0)
        overhead, idle, _ = _many(folder, 2000, ["la-associated"])
        _line("overhead of each of 2,000 runs of la-associated, CPU ms", 1e3 * overhead, 20.0)
        _line("two cores idle meanwhile (of a machine of its own), %", 100.0 * idle, 10.0)
        if full:
            _, _, spent = _many(folder, 5000, ["la-associated", "fe"])
            _line("10,000 runs of la-associated and fe, wall s", spent, 600.0)
            seconds, size = _expansion(folder)
            _line("50,000 blocks: expansion and contacts, CPU s", seconds, 10.0)
            _line("memory that takes, GB", size, 1.0)
        seconds, size = _store(folder)
        _line("store of 100,000 runs: open, filter, aggregate, s", seconds, 2.0)
        _line("size of each of them without fields, byte", size, 2000.0)
    return 0


def _line(what: str, measured: float, target: float) -> None:
    print(f"{what:<58} {measured:>12.3g} {target:>8g}", flush=True)


def command_cost(folder: Path, *words: str, repeats: int = 3) -> float:
    """CPU seconds of a command with all it starts: the least of a few, or of one that takes long."""
    ctypes.CDLL(None).prctl(SUBREAPER, 1)
    costs = []
    for _ in range(repeats):
        before = _children()
        program = "from drystone.__main__ import main; main()"
        command = [sys.executable, "-c", program, *words]
        environment = os.environ | {"PYTHONPATH": str(Path(__file__).resolve().parents[1])}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)  # with it every command compiles all that it imports again
        subprocess.run(command, cwd=folder, env=environment, capture_output=True, check=False)
        with suppress(ChildProcessError):
            while True:
                os.waitpid(-1, 0)
        costs.append(_children() - before)
        if costs[0] > 10.0:
            break
    return min(costs)


def _expansion(folder: Path, courses: int = 200, bricks: int = 250) -> tuple[float, float]:
    """CPU seconds of expanding a wall of so many blocks and finding its contacts, and GB of its process at most."""
    program = (
        "import resource; from benchmarks.walls import bond; "
        f"bond({courses}, {bricks}, 0.65); used = resource.getrusage(resource.RUSAGE_SELF); "
        "print(used.ru_utime + used.ru_stime, used.ru_maxrss)"
    )
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).resolve().parents[1])}
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=True)
    seconds, kilobytes = (float(word) for word in done.stdout.split())
    return seconds, kilobytes / 2**20


def _children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _many(folder: Path, walls: int, methods: list[str]) -> tuple[float, float, float]:
    """CPU overhead a run [s], idle share of two cores, and wall time [s] of so many walls of 21 bricks."""
    friction = {"from": 0.3, "to": 1.2, "count": walls}
    asked = Study.model_validate(
        {"name": "bench", "title": "bench", "methods": methods, "vary": {"friction": friction}, "wall": _wall()}
    )
    runs: list[SweepRun] = expand(asked, sources_of(asked))
    started = time.perf_counter(), _used()
    methods_cost = 0.0
    with open_store(folder / f"{walls}.sqlite") as store, closing(sweep(runs, store, LocalExecutor(2))) as ended:
        for number, (_, row, _) in enumerate(ended, start=1):
            methods_cost += float(row["cpu_seconds"] or 0.0)
            if number == 1:
                started, methods_cost = (time.perf_counter(), _used()), 0.0
            if number == len(runs) - 2:  # the last children end with the last runs, and are counted before
                spent, used = time.perf_counter() - started[0], _used() - started[1]
                count, cost = number - 1, methods_cost
    return (used - cost) / count, 1.0 - used / (2.0 * spent), spent


def _wall() -> dict[str, object]:
    wall: dict[str, object] = json.loads(wall_json(wall_21()))
    return wall


def _used() -> float:
    """CPU seconds of this process and of all that it started and that lives or was waited for."""
    own = psutil.Process()
    total = 0.0
    for process in [own, *own.children(recursive=True)]:
        with suppress(psutil.Error):
            times = process.cpu_times()
            total += times.user + times.system + times.children_user + times.children_system
    return total


def _store(folder: Path, count: int = 100_000) -> tuple[float, float]:
    """Seconds to open a store of so many runs, filter and aggregate them, and bytes a run without fields."""
    asked = Study.model_validate({"name": "one", "title": "one", "methods": ["la-associated"], "wall": _wall()})
    path = folder / "large.sqlite"
    with open_store(path) as store:
        list(sweep(expand(asked, sources_of(asked)), store, LocalExecutor(1)))
    columns = [name for name in COLUMNS["run"] if name not in ("key", "fields")]
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute(
            "WITH RECURSIVE number(n) AS (SELECT 2 UNION ALL SELECT n + 1 FROM number WHERE n < ?) "
            f"INSERT INTO run (key, {', '.join(columns)}) "
            f"SELECT printf('%032x', n), {', '.join(columns)} FROM number, (SELECT * FROM run LIMIT 1)",
            (count,),
        )
    started = time.perf_counter()
    with open_store(path, read_only=True) as store:
        table = pd.DataFrame(store.table(), columns=list(TABLE))
    chosen = table[(table["status"] == "ok") & (table["multiplier"] > 0.1)]
    counted = chosen.groupby("method")["multiplier"].describe()
    seconds = time.perf_counter() - started
    assert counted["count"].iloc[0] == count
    return seconds, path.stat().st_size / count


if __name__ == "__main__":
    sys.exit(main())
