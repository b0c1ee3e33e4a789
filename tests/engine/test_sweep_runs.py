"""What of a study is run again and what is not, how it is kept, and what stops it."""

from __future__ import annotations

import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from harness.engine.store import open_store
from harness.engine.sweep.frame import write
from harness.model.errors import InputError
from tests.commands import drystone
from tests.engine.studies import rows_of, runs_of, study
from tests.walls import stack, wall_data


def test_a_study_is_run_once_and_gives_the_closed_form(tmp_path: Path):
    asked = study(vary={"friction": [0.1, 0.2, 0.3, 2.0]}, methods=["la-associated", "fe"])
    table, stored = rows_of(asked, tmp_path / "s.sqlite")
    assert stored == 0
    # two blocks of 0.3 by 0.2 slide at the friction and topple at b / (n h) = 0.75
    expected = np.minimum(table["friction"].astype(float), 0.75)
    np.testing.assert_allclose(table["multiplier"], expected, rtol=1e-8)
    assert table["judge_accepted"].all()
    assert table.attrs["units"]["cpu_seconds"] == "s"
    again, stored = rows_of(asked, tmp_path / "s.sqlite", processes=1)
    assert stored == 8
    pd.testing.assert_frame_equal(again, table)
    fewer, stored = rows_of(study(vary={"friction": [0.2, 0.25]}), tmp_path / "s.sqlite")
    assert stored == 1, "another study finds the runs it shares"
    assert fewer["multiplier"].tolist() == pytest.approx([0.2, 0.25])


def test_the_number_of_workers_does_not_change_an_answer(tmp_path: Path):
    asked = study(vary={"friction": {"from": 0.1, "to": 0.9, "count": 4}}, methods=["la-associated", "fe", "la"])
    one, _ = rows_of(asked, tmp_path / "one.sqlite", processes=1)
    two, _ = rows_of(asked, tmp_path / "two.sqlite", processes=2)
    cost = ["cpu_seconds", "wall_seconds", "peak_memory_bytes", "started"]
    pd.testing.assert_frame_equal(one.drop(columns=cost), two.drop(columns=cost))


def test_a_wall_that_cannot_be_built_costs_its_row(tmp_path: Path):
    far = {"type": "stack", "width": 0.3, "height": 0.2, "count": 2, "offsets": [0.0, 0.0]}
    asked = study(wall=wall_data(far), vary={"pattern.offsets": [[0.0, 0.05], [0.0, 5.0], [0.0, 0.1]]})
    table, _ = rows_of(asked, tmp_path / "s.sqlite")
    assert table["status"].tolist() == ["ok", "refused", "ok"]
    assert "floating" in table["sentence"][1] or "touch" in table["sentence"][1]


def test_tables_are_written_with_their_units(tmp_path: Path):
    table, _ = rows_of(study(vary={"friction": [0.1, 0.2]}), tmp_path / "s.sqlite")
    names = {path.name for path in write(table, tmp_path / "out", "runs")}
    assert {"runs.csv", "runs.units.json"} <= names
    read = pd.read_csv(tmp_path / "out" / "runs.csv")
    assert read["multiplier"].tolist() == table["multiplier"].tolist(), "every digit"
    units = json.loads((tmp_path / "out" / "runs.units.json").read_text())
    assert set(units) == set(read.columns)


def test_tables_are_written_as_parquet_too(tmp_path: Path):
    pytest.importorskip("pyarrow", reason="it is large; `.ci/extras` runs this test")
    table, _ = rows_of(study(vary={"friction": [0.1, 0.2]}), tmp_path / "s.sqlite")
    write(table, tmp_path / "out", "runs")
    parquet = pd.read_parquet(tmp_path / "out" / "runs.parquet")
    assert parquet["multiplier"].tolist() == table["multiplier"].tolist()
    assert parquet.attrs["units"] == json.loads((tmp_path / "out" / "runs.units.json").read_text())


def test_the_command_leaves_tables_and_a_page_and_says_what_it_would_do(tmp_path: Path):
    (tmp_path / "wall.json").write_text(json.dumps(wall_data(stack(2))))
    words = ("sweep", "wall.json", "--vary", "friction=0.1:0.5:5", "--methods", "la-associated")
    plan = drystone(*words, "--dry-run", "--json", cwd=tmp_path)
    assert plan.returncode == 0, plan.stderr
    assert json.loads(plan.stdout)["to_run"] == {"la-associated": 5}
    assert not (tmp_path / "out").exists()
    done = drystone(*words, "--at", "0.2", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "5 runs: 5 ok" in done.stdout
    printed = [line.split() for line in done.stdout.splitlines()]
    assert ["friction", "la-associated", "(upper", "bound)"] in printed
    assert ["0.1", "0.1"] in printed  # stones of a stack slide at the coefficient of friction
    page = (tmp_path / "out" / "wall-friction.html").read_text()
    assert "wall over friction" in page
    assert "<svg" in page
    assert "http://" not in page.replace("http://www.w3.org", "")
    assert (tmp_path / "out" / "wall-friction" / "failure.csv").is_file()
    plan = drystone(*words, "--dry-run", "--json", cwd=tmp_path)
    assert json.loads(plan.stdout)["to_run"] == {}


def test_stores_are_merged_without_doubling(tmp_path: Path):
    first, second = study(vary={"friction": [0.1, 0.2]}), study(vary={"friction": [0.2, 0.3]})
    rows_of(first, tmp_path / "a.sqlite")
    rows_of(second, tmp_path / "b.sqlite")
    done = drystone("store", "merge", "a.sqlite", "b.sqlite", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "1 runs copied, 1 were there already" in done.stdout
    _, stored = rows_of(study(vary={"friction": [0.1, 0.2, 0.3]}), tmp_path / "a.sqlite")
    assert stored == 3
    with open_store(tmp_path / "a.sqlite") as store:
        result = store.get(next(run.key for run in runs_of(second) if run.variant.values["friction"] == 0.3))
        assert result is not None
        assert len(result[0].forces or ()) == 2
    assert drystone("store", "merge", "a.sqlite", "a.sqlite", cwd=tmp_path).returncode == 2
    assert drystone("store", "merge", "a.sqlite", "absent.sqlite", cwd=tmp_path).returncode == 2


def test_a_killed_coordinator_loses_no_run_that_ended_and_doubles_none(tmp_path: Path):
    (tmp_path / "wall.json").write_text(json.dumps(wall_data(stack(2))))
    words = ["sweep", "wall.json", "--vary", "friction=0.1:0.9:120", "--methods", "la-associated", "--no-report"]
    program = "from drystone.cli.main import main; main()"
    child = subprocess.Popen([sys.executable, "-c", program, *words], cwd=tmp_path, stderr=subprocess.DEVNULL)
    path = tmp_path / "out" / "drystone.sqlite"
    deadline = time.monotonic() + 60.0
    while time.monotonic() < deadline and (not path.exists() or kept(path) < 20):
        time.sleep(0.05)
    os.kill(child.pid, signal.SIGKILL)
    child.wait()
    before = kept(path)
    assert 20 <= before < 120
    done = drystone(*words, "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["runs"] == 120
    assert kept(path) == 120


def kept(path: Path) -> int:
    with open_store(path) as store:
        return len(store.table())


def test_two_coordinators_on_one_store_lose_and_double_nothing(tmp_path: Path):
    (tmp_path / "wall.json").write_text(json.dumps(wall_data(stack(2))))
    words = ["sweep", "wall.json", "--vary", "friction=0.1:0.9:24", "--methods", "la-associated", "--no-report"]
    program = "from drystone.cli.main import main; main()"
    both = [
        subprocess.Popen([sys.executable, "-c", program, *words, "-o", f"out/{name}"], cwd=tmp_path) for name in "ab"
    ]
    assert [child.wait(timeout=120) for child in both] == [0, 0]
    assert kept(tmp_path / "out" / "drystone.sqlite") == 24
    first, second = (pd.read_csv(tmp_path / "out" / name / "runs.csv") for name in "ab")
    assert first["multiplier"].tolist() == second["multiplier"].tolist()


def test_a_full_disk_is_told_and_loses_nothing_that_was_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    asked = study(vary={"friction": {"from": 0.1, "to": 0.9, "count": 60}})
    path = tmp_path / "s.sqlite"
    monkeypatch.setattr("harness.engine.store._connect", small_disk)
    with pytest.raises(InputError, match="disk is full"):
        rows_of(asked, path)
    monkeypatch.undo()
    before = kept(path)
    assert 0 < before < 60
    table, stored = rows_of(asked, path)
    assert stored == before
    assert kept(path) == len(table) == 60


def small_disk(path: Path, how: str = "") -> sqlite3.Connection:
    """A connection whose file may grow to 20 pages; the database says then what it says of a full disk."""
    connection = sqlite3.connect(path)
    connection.execute("PRAGMA max_page_count = 20")
    return connection
