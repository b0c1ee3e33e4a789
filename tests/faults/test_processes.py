"""Faults of processes and of the machine: what is killed, stopped or starved costs its row, never the comparison."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import psutil
import pytest

from harness.engine.store import open_store
from tests.commands import drystone
from tests.faults.test_store import filled, report, told_in_one_sentence
from tests.walls import running_bond, stack, wall_data

PINNED = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def environment(**changes: str | None) -> dict[str, str]:
    """The environment with changes; None takes a variable away."""
    given = {**os.environ, **PINNED, **changes}
    return {name: value for name, value in given.items() if value is not None}


@pytest.fixture
def wall(tmp_path: Path) -> Path:
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(wall_data(running_bond(3, 2))))
    return path


def start(*words: str | Path, cwd: Path) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "drystone.cli.main", *map(str, words)]
    return subprocess.Popen(
        command, cwd=cwd, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def busy_child(coordinator: int, seconds: float = 30.0, *, after: int = 0) -> psutil.Process:
    """The child that makes a run: the one that uses processor time and is neither server nor tracker, nor `after`."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        for child in psutil.Process(coordinator).children(recursive=True):
            try:
                leads = os.getpgid(child.pid) == child.pid and child.pid != after
                if leads and child.status() != psutil.STATUS_ZOMBIE:
                    return child
            except (psutil.NoSuchProcess, ProcessLookupError):
                continue
        time.sleep(0.02)
    raise AssertionError("no child came")


def rows_of(done: subprocess.CompletedProcess[str]) -> dict[str, Any]:
    (case,) = json.loads(done.stdout)["cases"]
    return {row["method"]: row for row in case["results"]}


def answer_of(done: subprocess.CompletedProcess[str]) -> dict[str, Any]:
    """What an answer says, without what it cost and when it was made."""
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    return {
        name: told[name] for name in ("multiplier", "finding", "sentence", "forces", "mechanism", "judge", "states")
    }


def run_la(wall: Path, **changes: Any) -> subprocess.CompletedProcess[str]:
    return drystone("run", "la", wall, "--json", "--fields", cwd=wall.parent, **changes)


def test_a_killed_coordinator_leaves_no_child_and_loses_no_finished_run(wall: Path):
    running = start(
        "compare", wall, "--methods", "la-associated,dummy", "--set", "dummy.does=hang", "--jobs", "1", cwd=wall.parent
    )
    store = wall.parent / "out" / "drystone.sqlite"
    try:
        assert running.stderr is not None
        line = running.stderr.readline()
        assert " la-associated: " in line, line
        child = busy_child(running.pid)
        left = [child, *psutil.Process(running.pid).children(recursive=True)]
    finally:
        running.kill()
        running.communicate(timeout=30)
    _, alive = psutil.wait_procs(left, timeout=30)
    assert [process for process in alive if process.is_running() and process.status() != psutil.STATUS_ZOMBIE] == []
    again = drystone("compare", wall, "--methods", "la-associated", "--store", store, cwd=wall.parent)
    assert "la-associated: " in again.stderr
    assert "(stored)" in again.stderr


@pytest.mark.parametrize(
    ("number", "times"), [(signal.SIGKILL, 2), pytest.param(signal.SIGSEGV, 1, marks=pytest.mark.slow)]
)
def test_a_killed_child_costs_its_row(wall: Path, number: signal.Signals, times: int):
    """Killed from outside (SIGKILL) a run is made once more, so it takes two blows; any other signal is its own."""
    words = ("--methods", "dummy,la-associated", "--set", "dummy.does=hang", "--seconds", "60", "--jobs", "1", "--json")
    running = start("compare", wall, *words, cwd=wall.parent)
    struck = 0
    for _ in range(times):
        child = busy_child(running.pid, after=struck)
        time.sleep(1.0)
        child.send_signal(number)
        struck = child.pid
    out, err = running.communicate(timeout=120)
    rows = rows_of(subprocess.CompletedProcess([], running.returncode, out, err))
    assert rows["dummy"]["status"] == "crashed"
    assert number.name in rows["dummy"]["sentence"]
    assert rows["la-associated"]["status"] == "ok", rows["la-associated"]["sentence"]


@pytest.mark.slow
def test_a_stopped_child_is_ended_at_its_limit(wall: Path):
    words = ("--methods", "la,la-associated", "--seconds", "15", "--jobs", "1", "--json")
    running = start("compare", wall, *words, cwd=wall.parent)
    child = busy_child(running.pid)
    child.send_signal(signal.SIGSTOP)
    out, err = running.communicate(timeout=180)
    rows = rows_of(subprocess.CompletedProcess([], running.returncode, out, err))
    assert not child.is_running()
    assert rows["la"]["status"] in ("timeout", "crashed"), rows["la"]["sentence"]
    assert rows["la-associated"]["status"] == "ok", rows["la-associated"]["sentence"]


def test_a_stopped_coordinator_goes_on_where_it_was(wall: Path):
    running = start("compare", wall, "--methods", "la,la-associated", "--json", cwd=wall.parent)
    time.sleep(0.7)
    running.send_signal(signal.SIGSTOP)
    time.sleep(1.0)
    running.send_signal(signal.SIGCONT)
    out, err = running.communicate(timeout=120)
    rows = rows_of(subprocess.CompletedProcess([], running.returncode, out, err))
    assert {row["status"] for row in rows.values()} == {"ok"}


def test_a_method_that_eats_memory_costs_its_row(wall: Path):
    done = drystone(
        "compare",
        wall,
        "--methods",
        "dummy,la-associated",
        "--set",
        "dummy.does=eat",
        "--memory",
        "600",
        "--json",
        cwd=wall.parent,
    )
    rows = rows_of(done)
    assert rows["dummy"]["status"] == "out_of_memory"
    assert "600 MiB" in rows["dummy"]["sentence"]
    assert rows["la-associated"]["status"] == "ok", rows["la-associated"]["sentence"]


@pytest.mark.parametrize("limit", [10, pytest.param(12, marks=pytest.mark.slow)])
def test_too_few_descriptors_are_told_with_the_remedy(wall: Path, limit: int):
    def few() -> None:
        resource.setrlimit(resource.RLIMIT_NOFILE, (limit, limit))

    done = drystone("compare", wall, "--methods", "la,fe", cwd=wall.parent, preexec_fn=few)
    told_in_one_sentence(done, "ulimit -n")


@pytest.mark.slow
def test_two_comparisons_share_a_store_at_once(wall: Path):
    words = ("compare", wall, "--methods", "la,la-associated,fe", "--json")
    running = [start(*words, "--report", f"r{k}.html", cwd=wall.parent) for k in range(2)]
    found = []
    for process in running:
        out, err = process.communicate(timeout=180)
        found.append(rows_of(subprocess.CompletedProcess([], process.returncode, out, err)))
        assert process.returncode == 0, err
    assert [row["multiplier"] for row in found[0].values()] == [row["multiplier"] for row in found[1].values()]
    with open_store(wall.parent / "out" / "drystone.sqlite", read_only=True) as store:
        assert store.get(found[0]["la"]["key"]) is not None


@pytest.mark.slow
def test_a_report_that_does_not_fit_leaves_the_earlier_one_whole_and_the_runs_stored(tmp_path: Path):
    store = filled(tmp_path / "s.sqlite")
    assert report(store).returncode == 0
    path = tmp_path / "report.html"
    before = path.read_bytes()

    def small() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))

    told_in_one_sentence(report(store, preexec_fn=small), "report", "ulimit -f")
    assert path.read_bytes() == before
    assert [item.name for item in tmp_path.glob("*.part")] == []


def test_a_full_disk_is_told_and_keeps_what_is_finished(wall: Path):
    done = in_own_mounts(
        f"mount -t tmpfs -o size=72k tmpfs '{wall.parent}/full' && cd '{wall.parent}/full' && "
        f"'{sys.executable}' -m drystone.cli.main compare '{wall}' --methods la,la-associated,fe,fe-qp,de; code=$?; "
        f"cp -r out '{wall.parent}/kept'; exit $code",
        wall.parent / "full",
    )
    assert done.returncode == 2, done.stderr
    assert "No space left" in done.stderr or "disk is full" in done.stderr
    assert "finished runs are kept" in done.stderr
    assert (wall.parent / "kept" / "drystone.sqlite").exists()
    again = drystone(
        "compare", wall, "--methods", "la", "--store", wall.parent / "kept" / "drystone.sqlite", cwd=wall.parent
    )
    assert again.returncode == 0, again.stderr


def in_own_mounts(script: str, *folders: Path, **more: Any) -> subprocess.CompletedProcess[str]:
    """Run a script where it may mount; skip the test where nobody may."""
    for folder in folders:
        folder.mkdir(exist_ok=True)
    probe = subprocess.run(["unshare", "-m", "true"], capture_output=True)
    if os.getuid() != 0 or probe.returncode != 0:
        pytest.skip("mounts are not allowed here")
    command = ["unshare", "-m", "sh", "-c", script]
    given = {"env": environment(PYTHONPATH=str(Path(__file__).parents[2])), "timeout": 300} | more
    return subprocess.run(command, capture_output=True, text=True, **given)


def test_a_store_on_a_read_only_disk_can_be_reported_from(tmp_path: Path):
    store = filled(tmp_path / "disk" / "s.sqlite")
    mount = f"mount --bind '{store.parent}' '{store.parent}' && mount -o remount,ro,bind '{store.parent}'"
    python = f"'{sys.executable}' -m drystone.cli.main"
    done = in_own_mounts(f"{mount} && {python} report --store '{store}' --report '{tmp_path}/r.html'")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "r.html").exists()
    refused = in_own_mounts(f"{mount} && cd '{tmp_path}' && {python} compare stack-2 --store '{store}'")
    told_in_one_sentence(refused, "s.sqlite", "Read-only file system")


@pytest.mark.slow
def test_no_home_and_a_read_only_installation_are_no_hindrance(wall: Path):
    root = Path(__file__).parents[2]
    mount = f"mount --bind '{root}' '{root}' && mount -o remount,ro,bind '{root}'"
    homeless = environment(HOME=None, XDG_CACHE_HOME=None, PYTHONPATH=str(root))
    homeless |= {"PYTHONDONTWRITEBYTECODE": "1"}
    for home in ({}, {"HOME": "/nonexistent"}, {"HOME": str(root)}):
        compare = f"'{sys.executable}' -m drystone.cli.main compare '{wall}' --methods la,de,fe --json"
        done = in_own_mounts(f"{mount} && cd '{wall.parent}' && {compare}", env=homeless | home)
        assert done.returncode == 0, done.stderr
        assert {row["status"] for row in rows_of(done).values()} == {"ok"}


def test_another_user_than_the_one_who_made_the_store_is_told_and_may_report(tmp_path: Path):
    """Root without its capabilities is a user like any other."""
    if os.getuid() != 0 or subprocess.run(["setpriv", "--version"], capture_output=True).returncode != 0:
        pytest.skip("needs root and setpriv")
    store = filled(tmp_path / "theirs" / "s.sqlite")
    for path in (store, store.parent):
        os.chown(path, 12345, 12345)
    powerless = ("setpriv", "--bounding-set=-all", "--inh-caps=-all", "--")
    refused = drystone("compare", "stack-2", "--store", store, prefix=powerless, cwd=tmp_path)
    told_in_one_sentence(refused, "s.sqlite", "Permission denied")
    done = drystone("report", "--store", store, "--report", tmp_path / "r.html", prefix=powerless)
    assert done.returncode == 0, done.stderr


def test_a_clock_that_was_set_back_does_not_change_which_comparison_is_the_last(tmp_path: Path):
    with open_store(tmp_path / "s.sqlite") as store:
        store.remember("2031-01-01T00:00:00+00:00", {"title": "first"})
        store.remember("2026-01-01T00:00:00+00:00", {"title": "second"})
        assert store.last_comparison() == {"title": "second"}


@pytest.mark.slow
def test_locale_hash_seed_threads_and_encoding_change_no_digit(wall: Path):
    plain = answer_of(run_la(wall, env=environment()))
    for changes in (
        {"LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"},
        {"LC_ALL": "C", "PYTHONUTF8": "0"},
        {"PYTHONHASHSEED": "1"},
        {"PYTHONHASHSEED": "4711"},
        {"OMP_NUM_THREADS": "2", "OPENBLAS_NUM_THREADS": "2", "NUMBA_NUM_THREADS": "2"},
        {"OMP_NUM_THREADS": None, "OPENBLAS_NUM_THREADS": None},
        {"TZ": "Pacific/Kiritimati"},
    ):
        assert answer_of(run_la(wall, env=environment(**changes))) == plain, changes


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["ascii", pytest.param("cp1252", marks=pytest.mark.slow)])
def test_a_terminal_that_cannot_show_every_letter_is_written_to_all_the_same(tmp_path: Path, encoding: str):
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(wall_data(stack(1)) | {"title": "Mauer μ 石 ✓"}))
    method = "la-associated"  # loads no kernels
    for words in (("run", method, path), ("compare", path, "--methods", method), ("run", method, path, "--json")):
        command = [sys.executable, "-m", "drystone.cli.main", *map(str, words)]
        given = environment(PYTHONIOENCODING=encoding)
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, timeout=120, env=given)
        assert done.returncode == 0, done.stderr.decode(encoding)
