"""`drystone bench`: frozen sets, shares of all walls, profiles in which nothing unsolved counts, joined tables."""

from __future__ import annotations

import json
import math
from collections import Counter
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from click.testing import CliRunner

from drystone.bench import COLUMNS, Bench, Speed, WallSet, machine_speed, rows_of, wall_set
from drystone.bench_tables import check_table
from drystone.cli.bench import bench_
from drystone.comparing import compare
from drystone.walls import library_wall
from harness.model.errors import InputError
from tests import commands

ROW = {
    "set": "core", "version": 1, "blocks": 3, "interfaces": 3, "finding": "collapses", "status": "ok",
    "judge": "accepted", "lower": math.nan, "upper": math.nan, "wall_seconds": 1.0, "peak_memory_bytes": 1,
    "speed_seconds": 1.0, "speed_spread": 0.1, "processor": "p",
}  # fmt: skip


def row(wall: str, method: str, multiplier: float, cpu: float, *, correct: bool = True, exact: bool = True) -> dict:
    return ROW | {
        "wall": wall, "method": method, "multiplier": multiplier, "cpu_seconds": cpu, "answered": True,
        "correct": correct, "exact": exact, "proved": False, "judge": "accepted" if correct else "rejected",
    }  # fmt: skip


TABLE = pd.DataFrame(
    [
        row("a", "quick", 0.5, 1.0),
        row("a", "slow", 0.4, 4.0),
        row("b", "quick", 0.1, 1.0, correct=False),  # rejected: counts nowhere, its value bounds nothing
        row("b", "slow", 0.3, 3.0),
        row("c", "quick", 0.2, 1.0),
        row("c", "slow", 0.1, 2.0, exact=False),  # measured: no state of the joint law
    ]
)


def test_sets_are_frozen_in_number_and_names():
    core, standard = wall_set("core"), wall_set("standard")
    assert (len(core.walls), len(standard.walls)) == (30, 150)
    names = [wall.name for wall in standard.walls]
    assert max(Counter(names).values()) == 1
    assert {wall.name for wall in core.walls} <= set(names)
    assert max(wall.assembly.n_free for wall in core.walls) <= 61


def test_unknown_set_is_refused_with_those_there_are():
    with pytest.raises(InputError, match='Did you mean "core"'):
        wall_set("cores")


def test_least_known_is_of_correct_exact_states_only():
    table = Bench(TABLE).complete.set_index(["wall", "method"])
    assert table.loc[("a", "quick"), "above_least"] == pytest.approx(0.25)
    assert table.loc[("b", "slow"), "least_known"] == 0.3
    assert table.loc[("c", "quick"), "least_known"] == 0.2


def test_every_share_is_of_all_walls():
    summary = Bench(TABLE).summary().set_index("method")
    assert summary.loc["quick", "correct"] == pytest.approx(2 / 3)
    assert summary.loc["quick", "at_least_known"] == pytest.approx(1 / 3)
    assert summary.loc["slow", "correct"] == 1.0
    assert summary.loc["slow", "at_least_known"] == pytest.approx(2 / 3)
    assert summary.loc["quick", "cpu_seconds"] == 3.0  # the wrong answer cost time as well
    assert summary.loc["slow", "cpu_of_best"] == pytest.approx((4.0 * 1.0 * 2.0) ** (1 / 3))


def test_unsolved_wall_is_within_no_ratio_of_a_profile():
    profiles = Bench(TABLE).profile()
    assert profiles["quick"] == ([1.0, 1.0], pytest.approx([1 / 3, 2 / 3]))
    assert profiles["slow"] == ([1.0, 2.0, 4.0], pytest.approx([1 / 3, 2 / 3, 1.0]))


def test_joined_table_can_lower_what_is_known():
    theirs = pd.DataFrame([row("a", "theirs", 0.25, 9.0)])
    joined = Bench(TABLE).joined(theirs, "theirs.csv")
    table = joined.complete.set_index(["wall", "method"])
    assert table.loc[("a", "slow"), "above_least"] == pytest.approx(0.6)
    assert joined.summary().set_index("method").loc["slow", "at_least_known"] == pytest.approx(1 / 3)


def test_wall_that_a_table_leaves_out_counts_against_its_methods():
    joined = Bench(TABLE).joined(pd.DataFrame([row("a", "theirs", 0.4, 1.0)]), "theirs.csv")
    assert joined.summary().set_index("method").loc["theirs", "correct"] == pytest.approx(1 / 3)
    assert joined.profile()["theirs"] == ([1.0], pytest.approx([1 / 3]))


FORGED: list[tuple[dict[str, object], str]] = [
    ({"method": "slow"}, "slow on a has two rows"),
    ({"answered": False}, "theirs on a is correct and not answered"),
    ({"judge": "not judged"}, "theirs on a is correct and not answered, or the judge has not accepted it"),
    ({"status": "timeout"}, "theirs on a is answered with another status than ok"),
    ({"cpu_seconds": 0.0}, "theirs on a is answered in no CPU time"),
    ({"multiplier": math.nan}, "theirs on a is an exact state without a multiplier"),
    ({"proved": True, "exact": False}, "theirs on a is proved and no exact state"),
    ({"proved": True, "multiplier": 0.5}, "slow has a state of a at 0.4, below 0.5"),
    ({"proved": True, "correct": False, "judge": "rejected"}, "theirs on a is proved and not answered, or the judge"),
    ({"proved": True, "correct": False, "answered": False}, "theirs on a is proved and not answered, or the judge"),
    ({"finding": "none"}, "theirs on a is correct with a finding that is none"),
    ({"finding": math.nan}, "theirs on a is correct with a finding that is none"),
    ({"finding": "stands"}, "theirs on a is correct with a multiplier that its finding does not have"),
    (
        {"exact": False, "multiplier": math.nan},
        "theirs on a is correct with a multiplier .*, or without the one it has",
    ),
    ({"lower": 0.4}, "theirs on a has one end of a bracket"),
    ({"lower": 0.5, "upper": 0.4}, "theirs on a has a bracket whose lower end is the higher"),
    ({"lower": 0.1, "upper": 0.2}, "theirs on a is correct with a multiplier outside its bracket"),
    ({"blocks": 4}, "a has different numbers of blocks"),
]


@pytest.mark.parametrize(("change", "said"), FORGED)
def test_rows_that_contradict_themselves_or_others_are_not_joined(change: dict, said: str):
    theirs = pd.DataFrame([row("a", "theirs", 0.4, 1.0) | change])
    with pytest.raises(InputError, match=rf"theirs\.csv: {said}"):
        Bench(TABLE).joined(theirs, "theirs.csv")


def test_state_below_one_that_is_proved_is_not_joined():
    ours = Bench(TABLE.assign(proved=TABLE["correct"] & TABLE["exact"] & (TABLE["method"] == "slow")))
    with pytest.raises(InputError, match=r"theirs has a state of a at 0\.25, below 0\.4, which a row calls the proved"):
        ours.joined(pd.DataFrame([row("a", "theirs", 0.25, 9.0)]), "theirs.csv")


@pytest.mark.parametrize(
    ("change", "said"), [({"version": 2}, "its version is 2"), ({"set": "large"}, "its set is large")]
)
def test_table_of_another_set_is_not_joined(change: dict, said: str):
    with pytest.raises(InputError, match=said):
        Bench(TABLE).joined(TABLE.assign(**change), "other.csv")
    with pytest.raises(InputError, match="no column wall"):
        Bench(TABLE).joined(TABLE.drop(columns="wall"), "other.csv")


WRONG: dict[str, list[object]] = {
    "wall": ["zz", math.nan],
    "method": [math.nan],
    "answered": ["no", 0.5],
    "correct": ["False", math.nan],
    "exact": [2],
    "multiplier": ["much", -5.0, math.inf],
    "cpu_seconds": [-1.0, "fast"],
    "peak_memory_bytes": ["1 GB", 1e30, math.nan],
}


@pytest.mark.parametrize(("column", "cell"), [(column, cell) for column, cells in WRONG.items() for cell in cells])
def test_table_with_a_cell_that_cannot_be_in_its_column_is_not_joined(column: str, cell: object):
    table = TABLE.astype({column: object})
    table.loc[1, column] = cell
    with pytest.raises(InputError, match=rf"other\.csv: column {column} has a cell that cannot be in it"):
        Bench(TABLE).joined(table, "other.csv")


def test_two_tables_with_the_same_rows_are_refused_before_anything_is_run():
    with pytest.raises(InputError, match=r"second\.csv: quick on a has two rows"):
        check_table(TABLE, "second.csv", {"core"}, {1}, set("abc"), ("mine",), [TABLE])


def test_a_wrong_cell_is_told_with_its_method_and_wall():
    with pytest.raises(InputError, match=r"column cpu_seconds .*: -1.0 \(quick on a\)"):
        Bench(TABLE).joined(TABLE.assign(cpu_seconds=-1.0), "other.csv")


def test_an_answer_below_zero_that_was_rejected_is_a_row_as_others():
    theirs = pd.DataFrame([row("a", "theirs", -728.6, 1.0, correct=False)])
    joined = Bench(TABLE).joined(theirs, "other.csv")
    assert joined.complete["above_least"].notna().sum() > 0
    assert joined.summary().set_index("method").loc["theirs", "correct"] == 0.0


def test_the_figure_of_a_table_shows_methods_that_are_not_installed_here_apart():
    left, right = Bench(TABLE).plot().axes
    assert len({line.get_color() for line in left.lines}) == 2
    assert [line.get_color() for line in left.lines] == [line.get_color() for line in right.lines]


def test_table_read_back_from_its_file_is_joined(tmp_path: Path):
    TABLE.to_csv(tmp_path / "t.csv", index=False)
    theirs = pd.read_csv(tmp_path / "t.csv").assign(method=lambda table: table["method"] + "-theirs")
    assert len(Bench(TABLE).joined(theirs, "t.csv").table) == 2 * len(TABLE)


def test_table_has_all_columns_that_are_promised_and_no_other():
    compared = compare([library_wall("single-block")], ["la-associated"])
    made = rows_of(WallSet("core", "", 1, (library_wall("single-block"),)), compared, Speed(1.0, 0.1))
    assert tuple(made.columns) == COLUMNS
    assert set(TABLE.columns) == set(COLUMNS)
    assert made["correct"].all()
    assert set(made.dropna(axis="columns", how="all").columns) == set(COLUMNS) - {"lower", "upper"}


def test_speed_of_a_machine_has_a_spread():
    speed = machine_speed(5)
    assert 0.0 < speed.seconds < 60.0
    assert 0.0 <= speed.spread < 60.0  # a busy machine has a wide one


def test_command_tells_below_its_table_why_methods_gave_no_answer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    tiny = {"title": "two", "version": 1, "library": ["slide", "topple"]}
    monkeypatch.setattr("drystone.bench._sets", lambda: {"tiny": tiny})
    words = ["--set", "tiny", "--methods", "la-associated", "--memory", "16", "--store", str(tmp_path / "s.sqlite")]
    done = CliRunner().invoke(bench_, words)
    assert done.exit_code == 0, done.output
    assert "la-associated: out_of_memory 2 times, on slide: " in done.output


@pytest.mark.slow
def test_command_runs_a_set_and_writes_its_table_and_figure(tmp_path: Path):
    words = ["bench", "--methods", "la-associated,fe", "--store", tmp_path / "s.sqlite"]
    done = commands.drystone(*words, "--json", "-o", tmp_path / "t.csv", "-o", tmp_path / "t.svg")
    assert done.returncode == 0, done.stderr
    told = {item["method"]: item for item in json.loads(done.stdout)["methods"]}
    assert told["fe"]["walls"] == 30
    assert told["fe"]["correct"] == told["la-associated"]["correct"] == 1.0
    table = pd.read_csv(tmp_path / "t.csv")
    assert len(table) == 60
    wide = table.pivot(index="wall", columns="method", values="multiplier")
    assert (
        wide["fe"] <= wide["la-associated"] * (1.0 + 1e-9)
    ).all()  # theory: no wall bears more than the associated maximum
    assert "<svg" in (tmp_path / "t.svg").read_text()
    twice = commands.drystone(*words, "--join", tmp_path / "t.csv")
    assert twice.returncode == 2
    assert "t.csv: it has rows of fe, and so has the other table" in twice.stderr
    table.assign(method=table["method"] + "-there").to_csv(tmp_path / "theirs.csv", index=False)
    again = commands.drystone(*words, "--join", tmp_path / "theirs.csv", "--json")
    told = {item["method"]: item for item in json.loads(again.stdout)["methods"]}
    assert told["fe-there"]["walls"] == 30
    assert np.isclose(told["fe-there"]["correct"], 1.0)


def test_command_refuses_what_is_no_table(tmp_path: Path):
    (tmp_path / "t.csv").write_text("")
    done = commands.drystone("bench", "--join", tmp_path / "t.csv")
    assert done.returncode == 2
    assert "no table of `drystone bench`" in done.stderr
    TABLE.assign(version=2).to_csv(tmp_path / "t.csv", index=False)
    done = commands.drystone("bench", "--join", tmp_path / "t.csv", "--store", tmp_path / "s.sqlite")
    assert done.returncode == 2
    assert "its version is 2" in done.stderr
    assert not (tmp_path / "s.sqlite").exists()  # refused before anything is run
    done = commands.drystone("bench", "--set", "cor")
    assert done.returncode == 2
    assert 'no set of walls is called "cor"' in done.stderr
