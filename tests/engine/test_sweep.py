"""Studies: what a file expands to, what is run again and what is not, and the statistics against closed forms."""

from __future__ import annotations

import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from drystone.studies import changed, shipped_studies
from drystone.studies import sweep as drystone_sweep
from harness.engine.executors import LocalExecutor
from harness.engine.plan import Limits
from harness.engine.store import open_store
from harness.engine.sweep import statistics
from harness.engine.sweep.expand import SweepRun, expand, sources_of
from harness.engine.sweep.frame import tidy, write
from harness.engine.sweep.paths import with_values
from harness.engine.sweep.quick import axis_of, quick_study
from harness.engine.sweep.running import sweep
from harness.engine.sweep.study import Study, read_study
from harness.engine.sweep.summary import summarise
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.reading import parse_wall, validate
from tests.commands import drystone
from tests.walls import running_bond, stack, wall_data


def study(**more: Any) -> Study:
    data = {"name": "made-up", "title": "A study of a test", "methods": ["la-associated"], "wall": wall_data(stack(2))}
    return validate(Study, data | more, "test")


def runs_of(asked: Study) -> list[SweepRun]:
    return expand(asked, sources_of(asked))


def rows_of(asked: Study, store: Path, *, processes: int = 2, fresh: bool = False) -> tuple[pd.DataFrame, int]:
    with open_store(store) as opened:
        ended = list(sweep(runs_of(asked), opened, LocalExecutor(processes), fresh=fresh))
    varied = [*asked.vary, *(name for group in asked.together for name in group), *asked.draw]
    return tidy((row for _, row, _ in ended), varied), sum(stored for _, _, stored in ended)


def test_a_grid_is_every_value_with_every_other_and_methods_run_for_their_own_settings_alone():
    asked = study(
        methods=["la-associated", "de-uneven"],
        vary={"friction": {"from": 0.2, "to": 0.4, "count": 3}, "imperfection": [0.0, 0.1], "seed": {"seeds": 2}},
        together=[{"pattern.width": [0.3, 0.4], "pattern.count": [2, 3]}],
    )
    runs = runs_of(asked)
    uneven = [run for run in runs if run.method == "de-uneven"]
    assert len(uneven) == 3 * 2 * 2 * 2
    assert {(run.settings["size"], run.settings["seed"]) for run in uneven} == {(0.0, 0), (0.0, 1), (0.1, 0), (0.1, 1)}
    assert {tuple(run.variant.values.values()) for run in runs} == {
        (friction, width, count) for friction in (0.2, 0.3, 0.4) for width, count in ((0.3, 2), (0.4, 3))
    }
    plain = {run.key for run in runs if run.method == "la-associated"}
    assert len(plain) == 6, "the settings of another method make no other run"


def test_short_names_do_what_they_say():
    wall = wall_data(running_bond(3, 2), friction={"default": 0.5, "rules": [{"value": 0.1, "joint": "head"}]})
    changed = with_values(wall, {"friction": 0.7, "proportion": 3.0, "inset": 0.1, "direction": 90.0})
    assert changed["friction"] == {"default": 0.7, "rules": [{"value": 0.1, "joint": "head"}]}
    assert changed["pattern"]["block_length"] == pytest.approx(0.6)
    assembly = build(parse_wall(changed, "test")).assembly
    np.testing.assert_allclose(assembly.live[assembly.free, 0], 0.0, atol=1e-12)
    assert (assembly.live[assembly.free, 1] > 0.0).all(), "a push to the right turned by 90 degrees points up"
    np.testing.assert_allclose(
        np.linalg.norm(assembly.face2 - assembly.face1, axis=1),
        np.linalg.norm(assembly.end2 - assembly.end1, axis=1) / 0.8,
    )
    assert wall["friction"]["default"] == 0.5, "the wall itself stays as it is"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"vary": {"frction": [1.0]}}, "frction"),
        ({"vary": {"friction": [-1.0]}}, "friction = -1.0"),
        ({"vary": {"loads.live.body[3].per_weight": [[1, 0]]}}, "leads nowhere"),
        ({"vary": {"loads.live.body[0].per_weight[2]": [0.5]}}, "leads nowhere"),
        ({"vary": {"a b": [1]}}, "no path"),
        ({"vary": {"proportion": [2.0]}}, "running bond"),
        ({"vary": {"settings.la-associated.solver": ["magic"]}}, "solver"),
        ({"vary": {"settings.fe.points": [2]}}, "does not run"),
        ({"methods": ["magic"]}, "magic"),
        ({"vary": {"friction": {"from": 0.1, "to": 1.0, "count": 10**6}}, "methods": ["fe", "la"]}, "2,000,000"),
    ],
)
def test_a_study_that_cannot_be_is_refused_before_anything_runs(changes: dict[str, Any], words: str):
    with pytest.raises(InputError, match=words):
        runs_of(study(**changes))


@pytest.mark.parametrize(
    "changes",
    [
        {"cases": ["wall-21"]},
        {"vary": {"friction": [0.1]}, "draw": {"friction": {"distribution": "uniform", "low": 0.1, "high": 0.2}}},
        {"together": [{"friction": [0.1], "inset": [0.1, 0.2]}]},
        {"draw": {"friction": {"distribution": "normal", "mean": 0.5}}},
        {"vary": {"friction": {"from": 0.0, "to": 1.0, "count": 3, "log": True}}},
        {"vary": {"friction": {"from": 1.0, "to": 0.0, "count": 3, "log": True}}},
        {"draw": {"friction": {"distribution": "uniform", "low": 0.2, "high": 0.2}}},
        {"draw": {"friction": {"distribution": "normal", "mean": 0.5, "deviation": 0.1, "low": 0.6, "high": 0.4}}},
        {"draw": {"friction": {"distribution": "lognormal", "mean": 0.0, "deviation": 0.1}}},
    ],
)
def test_a_study_file_that_contradicts_itself_is_refused(changes: dict[str, Any]):
    with pytest.raises(InputError):
        study(**changes)


def test_draws_follow_their_distributions_and_their_seed():
    item = {"distribution": "normal", "mean": 0.5, "deviation": 0.05, "low": 0.4}
    other = {"distribution": "lognormal", "mean": 0.3, "deviation": 0.03}
    asked = study(draw={"friction": item, "pattern.width": other}, samples=400)
    values = pd.DataFrame([dict(run.variant.values) for run in runs_of(asked)])
    cut = stats.truncnorm((0.4 - 0.5) / 0.05, np.inf, loc=0.5, scale=0.05)
    assert stats.kstest(values["friction"], cut.cdf).pvalue > 0.5, "a Latin hypercube is evener than chance"
    assert values["friction"].min() >= 0.4
    assert values["pattern.width"].mean() == pytest.approx(0.3, rel=1e-3)
    assert values["pattern.width"].std() == pytest.approx(0.03, rel=0.02)
    again = pd.DataFrame([dict(run.variant.values) for run in runs_of(asked)])
    pd.testing.assert_frame_equal(values, again)
    other_seed = study(draw={"friction": item, "pattern.width": other}, samples=400, seed=1)
    assert runs_of(other_seed)[0].variant.values != runs_of(asked)[0].variant.values


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


def made_up(values: list[float | None], **columns: Any) -> pd.DataFrame:
    rows = [
        {
            "number": number,
            "case": "a",
            "method": "la",
            "status": "ok" if value is not None else "timeout",
            "finding": "collapses" if value is not None else "none",
            "multiplier": value,
            "judge_accepted": True,
        }
        for number, value in enumerate(values)
    ]
    return tidy(rows, []).assign(**columns)


def test_probability_of_failure_is_counted_with_wilsons_interval():
    table = made_up([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, None])
    found = statistics.failure_probability(table, ["case", "method"], [0.3]).iloc[0]
    assert (found["walls"], found["failed"], found["probability"]) == (10, 3, 0.3)
    z, n, p = 1.959963985, 10, 0.3
    centre, half = p + z * z / (2 * n), z * np.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    assert found["low"] == pytest.approx((centre - half) / (1 + z * z / n), abs=1e-8)
    assert found["high"] == pytest.approx((centre + half) / (1 + z * z / n), abs=1e-8)


def test_a_wall_that_falls_under_its_dead_load_has_failed_at_any_multiplier():
    table = made_up([0.5, 0.6])
    table.loc[0, ["finding", "multiplier"]] = ["falls", np.nan]
    assert statistics.failure_probability(table, ["case", "method"], [0.0])["probability"][0] == 0.5


def test_a_rejected_answer_counts_for_nothing():
    table = made_up([0.5, 0.6])
    table.loc[0, "judge_accepted"] = False
    assert statistics.quantiles(table, ["case", "method"])["answered"].tolist() == [1]


def test_what_the_judge_cannot_decide_counts_and_is_told():
    table = made_up([0.5, 0.6])
    table["judge_accepted"] = table["judge_accepted"].astype("boolean")
    table.loc[0, "judge_accepted"] = pd.NA
    assert statistics.quantiles(table, ["case", "method"])["answered"].tolist() == [2]
    study = Study.model_validate(
        {"name": "x", "title": "x", "cases": ["a"], "methods": ["la"], "vary": {"seed": {"seeds": 2}}}
    )
    assert [row for row in summarise(study, table).remarks if row.startswith("1 of 2 runs count although")]


def test_fragility_curve_of_a_lognormal_sample_is_that_lognormal_within_its_band():
    rng = np.random.default_rng(3)
    values = np.exp(np.log(0.5) + 0.2 * rng.standard_normal(300))
    curve = statistics.fragility(made_up(list(values)), ["case", "method"])
    # with 300 walls the deviations of median and dispersion are 0.2 / sqrt(300) = 0.012 and 0.008
    assert curve["median"][0] == pytest.approx(0.5, rel=0.04)
    assert curve["dispersion"][0] == pytest.approx(0.2, abs=0.025)
    true = stats.norm.cdf(np.log(curve["multiplier"] / 0.5) / 0.2)
    inside = (curve["lognormal_low"] <= true) & (true <= curve["lognormal_high"])
    assert inside.mean() > 0.8
    counted = curve["low"].notna() & curve["high"].notna()
    assert ((curve["low"] <= true) & (true <= curve["high"]))[counted].mean() > 0.8
    assert (curve["probability"].diff().dropna() > 0.0).all()


def test_sensitivity_names_the_quantity_that_matters():
    rng = np.random.default_rng(0)
    first, second = rng.random(200), rng.random(200)
    table = made_up(list(0.3 + first + 0.1 * second), first=first, second=second)
    found = statistics.sensitivity(table, ["first", "second"], ["case", "method"]).set_index("quantity")
    # variances 1 / 12 and 0.01 / 12: shares of 0.990 and 0.0099
    assert found["first_order"]["first"] == pytest.approx(0.99, abs=0.1)
    assert found["delta"]["first"] > 3.0 * found["delta"]["second"]


@pytest.mark.parametrize("name", sorted(shipped_studies()))
def test_every_shipped_study_expands(name: str):
    path = shipped_studies()[name]
    asked = read_study(path)
    assert asked.name == name
    assert asked.question.endswith(("?", "."))
    assert len(runs_of(asked)) > 20


def test_quick_forms_mean_what_they_say():
    assert axis_of("0.3:0.5:3", "", None) == {"from": 0.3, "to": 0.5, "count": 3, "log": False}
    assert axis_of("half,full", "", None) == ["half", "full"]
    from harness.engine.run import Limits

    asked = quick_study("walls/My Wall.json", None, {}, Limits(), [], imperfection="0.02:0.12", seeds=50)
    assert asked.name == "my-wall-imperfection-seed"
    assert asked.methods == ["de-uneven"]
    for bad in ("0.3:0.5", "a:b:3", "1:2:3:4"):
        with pytest.raises(InputError, match="no range"):
            axis_of(bad, "--vary friction", None)


def test_vectors_in_brackets_are_values():
    assert axis_of("[1,0],[0,-1]", "--vary load", None) == [[1, 0], [0, -1]]
    assert axis_of("[1,0]", "--vary load", None) == [[1, 0]]
    assert axis_of(".3,.4", "--vary friction", None) == [0.3, 0.4]
    assert axis_of("left,right", "--vary word", None) == ["left", "right"]


def test_every_load_case_of_a_file_is_a_wall_of_the_study(tmp_path: Path):
    """Each run of such a file was refused, because it has several loads."""
    data = wall_data({"type": "stack", "width": 0.5, "height": 1.0, "count": 1}, 0.6)
    del data["loads"]
    pushes = {"wind": 1.0, "quake": -2.0}
    data["load_cases"] = {name: {"live": {"body": [{"per_weight": [x, 0.0]}]}} for name, x in pushes.items()}
    (tmp_path / "pier.json").write_text(json.dumps(data), encoding="utf-8")
    words = ("--vary", "friction=0.2,0.8", "--methods", "la", "--no-report", "-o", "t", "--store", "s.sqlite")
    done = drystone("sweep", "pier.json", *words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    table = pd.read_csv(tmp_path / "t" / "runs.csv")
    found = {tuple(row[:2]): row[2] for row in table[["case", "friction", "multiplier"]].to_numpy()}
    assert found == pytest.approx(
        {("pier-wind", 0.2): 0.2, ("pier-wind", 0.8): 0.5, ("pier-quake", 0.2): 0.1, ("pier-quake", 0.8): 0.25}
    )


def test_two_directions_of_the_load_are_run_and_told_apart(tmp_path: Path):
    """A block of friction .3 slides at .3 to either side, and at .15 under twice the load."""
    words = ("--vary", "loads.live.body[0].per_weight=[1,0],[-2,0]", "--methods", "la-associated", "--no-report")
    done = drystone("sweep", "slide", *words, "-o", tmp_path / "t", "--store", tmp_path / "s.sqlite", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    table = pd.read_csv(tmp_path / "t" / "runs.csv")
    found = dict(zip(table["loads.live.body[0].per_weight"], table["multiplier"], strict=True))
    assert {key: round(value, 9) for key, value in found.items()} == {"[1, 0]": 0.3, "[-2, 0]": 0.15}


@pytest.mark.parametrize("words", ["direction=left,right", "direction=[1,0]", "proportion=wide", "direction=true"])
def test_a_quantity_that_is_computed_with_takes_numbers_only(tmp_path: Path, words: str):
    case = "wall-21" if words.startswith("proportion") else "slide"
    done = drystone("sweep", case, "--vary", words, "--methods", "la-associated", cwd=tmp_path)
    assert done.returncode == 2
    assert f"vary.{words.partition('=')[0]}: " in done.stderr
    assert "is no number" in done.stderr


@pytest.mark.parametrize("place", ["file", "/dev/full", "ring", "file/t"])
def test_tables_that_can_stand_nowhere_are_refused_before_the_runs(tmp_path: Path, place: str):
    (tmp_path / "file").write_text("old")
    (tmp_path / "ring").symlink_to("ring")
    words = ("slide", "--vary", "friction=0.3", "--methods", "la-associated", "-o", place, "--store", "s.sqlite")
    done = drystone("sweep", *words, cwd=tmp_path)
    assert (done.returncode, "Traceback" in done.stderr) == (2, False), done.stderr
    assert "is no folder" in done.stderr or "links in a ring" in done.stderr
    assert {path.name for path in tmp_path.iterdir()} == {"file", "ring"}
    assert (tmp_path / "file").read_text() == "old"


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
    assert ["friction", "la-associated"] in printed
    assert ["0.1", "0.1"] in printed  # stones of a stack slide at the coefficient of friction
    page = (tmp_path / "out" / "wall-friction.html").read_text()
    assert "wall over friction" in page
    assert "<svg" in page
    assert "http://" not in page.replace("http://www.w3.org", "")
    assert (tmp_path / "out" / "wall-friction" / "failure.csv").is_file()
    plan = drystone(*words, "--dry-run", "--json", cwd=tmp_path)
    assert json.loads(plan.stdout)["to_run"] == {}


def test_defects_of_a_wall_scatter_its_multiplier(tmp_path: Path):
    (tmp_path / "wall.json").write_text(json.dumps(wall_data(stack(2))))
    words = ("sweep", "wall.json", "--imperfection", "0.02:0.1:2", "--seeds", "2", "--at", "0.1", "--no-report")
    done = drystone(*words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    means = pd.read_csv(tmp_path / "out" / "wall-imperfection-seed" / "quantiles.csv")
    assert means["answered"].tolist() == [2, 2]
    assert means["brackets"].tolist() == [2, 2]  # wider than .005, which the method states
    assert means["mean"].isna().all()
    assert ((means["mean_low"] > 0.0) & (means["mean_low"] < means["mean_high"])).all()
    assert (pd.read_csv(tmp_path / "out" / "wall-imperfection-seed" / "failure.csv")["walls"] == 2).all()
    assert "4 of 4 runs count although their answers are not judged" in " ".join(done.stdout.split())


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


def test_runs_are_numbered_in_order_whatever_walls_and_methods():
    runs = runs_of(study(methods=["la-associated", "fe"], vary={"friction": [0.1, 0.2], "inset": [0.0, 0.1]}))
    assert [run.number for run in runs] == list(range(8))


def test_a_turned_load_is_turned_at_points_too():
    loads = {"live": {"points": [{"block": "2", "at": [0.1, 0.4], "force": [3.0, 4.0]}]}}
    for turn, force in (
        (90.0, [-4.0, 3.0]),
        (180.0, [-3.0, -4.0]),
        (30.0, [3.0 * 0.75**0.5 - 2.0, 1.5 + 4.0 * 0.75**0.5]),
    ):
        changed = with_values(wall_data(stack(2)) | {"loads": loads}, {"direction": turn})
        assert changed["loads"]["live"]["points"][0]["force"] == pytest.approx(force)


def test_uniform_and_triangular_draws_lie_within_their_ends():
    flat = {"distribution": "uniform", "low": 0.4, "high": 0.6}
    peak = {"distribution": "triangular", "low": 0.2, "mode": 0.3, "high": 0.5}
    runs = runs_of(study(draw={"friction": flat, "pattern.width": peak}, samples=400))
    values = pd.DataFrame([dict(run.variant.values) for run in runs])
    assert stats.kstest(values["friction"], stats.uniform(0.4, 0.2).cdf).pvalue > 0.5
    assert stats.kstest(values["pattern.width"], stats.triang(1.0 / 3.0, 0.2, 0.3).cdf).pvalue > 0.5


def test_wall_files_of_a_study_are_looked_for_beside_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    folder = tmp_path / "studies"
    folder.mkdir()
    (folder / "mine.json").write_text(json.dumps(wall_data(stack(3))))
    monkeypatch.chdir(tmp_path)
    asked = study(wall=None, cases=["mine.json"])
    (source,) = sources_of(asked, place=folder)
    assert source.data["pattern"]["count"] == 3
    with pytest.raises(InputError, match="mine"):
        sources_of(asked)
    monkeypatch.chdir(folder)
    assert sources_of(asked) == [source]


def test_a_quick_study_keeps_the_limits_that_were_asked():
    limits = Limits(7.0, 3 * 2**30)
    asked = quick_study("wall-21", ["fe"], {}, limits, [], vary=["friction=0.1,0.2"])
    assert (asked.limits.seconds, asked.limits.memory) == (7.0, 3 * 1024)
    assert runs_of(asked)[0].limits == limits


def test_a_study_is_changed_where_something_is_given_and_else_not():
    own = study(settings={"la-associated": {"solver": "highs"}}, multipliers=[0.1], methods=["la-associated", "fe"])
    assert changed(own) == own
    more = changed(own, ["fe"], {"fe": {"points": 3}}, [0.2], neighbours=True)
    assert (more.methods, more.multipliers, more.neighbours) == (["fe"], [0.2], True)
    assert more.settings == {"la-associated": {"solver": "highs"}, "fe": {"points": 3}}
    with pytest.raises(InputError, match="magic"):
        drystone_sweep(own, settings={"la-associated": {"solver": "magic"}})


def test_lost_runs_are_counted_beside_the_mean_of_the_others():
    asked = study(methods=["la"], vary={"seed": {"seeds": 4}})
    assert summarise(asked, made_up([0.5, 0.6, None, None])).by_method() == [{"la": "0.55 ± 0.071 (2 of 4 lost)"}]
    assert summarise(asked, made_up([0.5, 0.6])).by_method() == [{"la": "0.55 ± 0.071"}]
    assert summarise(asked, made_up([None])).by_method() == [{"la": "no answer"}]


def test_walls_that_all_collapse_at_one_multiplier_have_no_lognormal_curve():
    curve = statistics.fragility(made_up([0.5] * 6), ["case", "method"])
    assert curve["probability"].tolist() == [1.0]
    assert curve[["lognormal", "lognormal_low", "lognormal_high", "median", "dispersion"]].isna().all(axis=None)


def test_the_band_of_a_lognormal_curve_is_as_wide_as_theory_says():
    # Of n walls the deviation of the fitted probability at the median is that of the mean: phi(0) / sqrt(n).
    rng = np.random.default_rng(5)
    curve = statistics.fragility(made_up(list(np.exp(0.3 * rng.standard_normal(300)))), ["case", "method"])
    middle = curve.iloc[(curve["lognormal"] - 0.5).abs().argmin()]
    half = 1.959964 * stats.norm.pdf(0.0) / np.sqrt(300)
    # ends from 400 samples scatter by a twentieth or so each
    assert 0.5 * (middle["lognormal_high"] - middle["lognormal_low"]) == pytest.approx(half, rel=0.1)


@pytest.mark.parametrize(("walls", "told"), [(19, False), pytest.param(20, True, marks=pytest.mark.slow)])
def test_ten_walls_a_quantity_tell_what_matters_and_fewer_do_not(walls: int, told: bool):
    rng = np.random.default_rng(1)
    first, second = rng.random(walls), rng.random(walls)
    found = statistics.sensitivity(
        made_up(list(0.3 + first), first=first, second=second), ["first", "second"], ["case"]
    )
    assert len(found) == (2 if told else 0)
