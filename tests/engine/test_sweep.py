"""Studies: what a file expands to, and what is refused before anything runs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from drystone.studies import changed, shipped_studies
from drystone.studies import sweep as drystone_sweep
from harness.engine.plan import Limits
from harness.engine.sweep.expand import sources_of
from harness.engine.sweep.paths import with_values
from harness.engine.sweep.quick import axis_of, quick_study
from harness.engine.sweep.study import read_study
from harness.model.build import build
from harness.model.errors import InputError
from harness.model.reading import parse_wall
from tests.commands import drystone
from tests.engine.studies import runs_of, study
from tests.walls import running_bond, stack, wall_data


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
