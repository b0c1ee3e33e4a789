"""`--live`, `--both-signs` and `--load-case` as a user types them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.commands import drystone

LEANING = {
    "format": "wall/1",
    "unit_weight": 20,
    "friction": 0.9,
    "blocks": [
        {"id": "g", "fixed": True, "polygon": [[-1, -1], [3, -1], [3, 0], [-1, 0]]},
        {"id": "a", "polygon": [[0, 0], [1, 0], [1, 2], [-0.2, 2]]},
    ],
    "loads": {"live": {"body": [{"per_weight": [1, 0]}]}},
}
RIGHT, LEFT = 0.5352941176, 0.4352941176


@pytest.fixture
def wall(tmp_path: Path) -> Path:
    path = tmp_path / "leaning.json"
    path.write_text(json.dumps(LEANING))
    return path


def test_run_takes_the_live_load_of_the_command_line(wall: Path):
    done = drystone("run", "la-associated", wall, "--live", "-2,0", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["multiplier"] == pytest.approx(LEFT / 2, rel=1e-9)
    assert "replaces that of the file" in done.stderr


def test_no_live_load_is_said_to_be_replaced_where_the_file_has_none(tmp_path: Path):
    path = tmp_path / "unloaded.json"
    path.write_text(json.dumps({key: value for key, value in LEANING.items() if key != "loads"}))
    done = drystone("run", "la-associated", path, "--live", "-2,0", "--json")
    assert done.returncode == 0, done.stderr
    assert "replaces" not in done.stderr


def test_run_answers_both_signs_and_says_which_governs(wall: Path):
    done = drystone("run", "la-associated", wall, "--both-signs")
    assert done.returncode == 0, done.stderr
    assert 'la-associated: load case "to the left" governs, 0.4352941 (upper bound).' in done.stdout
    found = json.loads(drystone("run", "la-associated", wall, "--both-signs", "--json").stdout)
    assert [row["multiplier"] for row in found["results"]] == pytest.approx([RIGHT, LEFT], rel=1e-9)
    assert found["governing"] == ["to the left"]


def test_compare_shows_the_envelope_of_both_signs(wall: Path, tmp_path: Path):
    words = ("compare", wall, "--methods", "la-associated", "--live", "1,0", "--both-signs", "--no-report")
    done = drystone(*words, "--store", tmp_path / "store.sqlite")
    assert done.returncode == 0, done.stderr
    assert 'la-associated: load case "to the left" governs, 0.4352941 (upper bound).' in done.stdout
    found = json.loads(drystone(*words, "--store", tmp_path / "store.sqlite", "--json").stdout)
    assert [case["id"] for case in found["cases"]] == ["leaning", "leaning-reversed"]
    assert [row["governing"] for row in found["envelopes"]] == [["to the left"]]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--live", "1"), '"1" is not two numbers'),
        (("--live", "nan,0"), '"nan,0" is not two numbers'),
        (("--live", "0,0"), "the live load 0,0 is none"),
        (("--live", "0,1", "--both-signs"), "its live load is not horizontal"),
    ],
)
def test_a_live_load_that_is_none_is_refused(wall: Path, words: tuple[str, ...], said: str):
    done = drystone("run", "la-associated", wall, *words)
    assert done.returncode == 2
    assert said in done.stderr


@pytest.fixture
def cases(tmp_path: Path) -> Path:
    heavy = {"dead": {"points": [{"block": "a", "at": [0.4, 2], "force": [0, -9]}]}}
    named = {"push": LEANING["loads"], "heavy": heavy | {"live": {"body": [{"per_weight": [2, 0]}]}}}
    path = tmp_path / "leaning.json"
    path.write_text(json.dumps(LEANING | {"loads": {}, "load_cases": named}))
    return path


def test_compare_answers_all_load_cases_and_remembers_them(cases: Path, tmp_path: Path):
    words = ("compare", cases, "--methods", "la-associated", "--store", tmp_path / "store.sqlite")
    done = drystone(*words, "--no-report")
    assert done.returncode == 0, done.stderr
    assert "Load cases of leaning:" in done.stdout
    assert 'la-associated: load case "heavy" governs' in done.stdout
    found = json.loads(drystone(*words, "--no-report", "--both-signs", "--json").stdout)
    assert found["envelopes"][0]["governing"] == ["heavy, to the left"]
    assert drystone(*words, "--report", tmp_path / "report.html").returncode == 0
    page = (tmp_path / "report.html").read_text()
    assert "Load case of leaning" in page
    assert page.count("<small>governs</small>") == 1
    again = drystone("report", "--store", tmp_path / "store.sqlite", "--report", tmp_path / "again.html")
    assert again.returncode == 0, again.stderr
    assert (tmp_path / "again.html").read_text().count("<small>governs</small>") == 1
    one = json.loads(drystone(*words, "--no-report", "--load-case", "push", "--json").stdout)
    assert [case["id"] for case in one["cases"]] == ["leaning-push"]
    assert one["envelopes"] == []


def test_run_asks_for_a_load_case_and_says_which_there_are(cases: Path):
    done = drystone("run", "la-associated", cases)
    assert done.returncode == 2
    assert "it has the load cases push, heavy. Choose one: --load-case NAME" in done.stderr
    done = drystone("run", "la-associated", cases, "--load-case", "heavi")
    assert done.returncode == 2
    assert 'no load case is called "heavi". Did you mean "heavy"?' in done.stderr
    done = drystone("run", "la-associated", cases, "--load-case", "push", "--json")
    assert json.loads(done.stdout)["multiplier"] == pytest.approx(RIGHT, rel=1e-9)


def test_expand_writes_one_load_case_for_commands_that_take_none(cases: Path, tmp_path: Path):
    assert drystone("expand", cases).returncode == 2
    assert drystone("expand", cases, "--load-case", "push", "-o", tmp_path / "push.json").returncode == 0
    done = drystone("run", "la-associated", tmp_path / "push.json", "--json")
    assert json.loads(done.stdout)["multiplier"] == pytest.approx(RIGHT, rel=1e-9)


def test_a_wall_without_load_cases_refuses_the_name_of_one(wall: Path):
    done = drystone("run", "la-associated", wall, "--load-case", "push")
    assert done.returncode == 2
    assert 'no load case is called "push". A wall gives them in "load_cases"' in done.stderr


def test_an_error_of_a_combination_names_the_file(tmp_path: Path):
    path = tmp_path / "leaning.json"
    path.write_text(json.dumps(LEANING | {"loads": {}, "load_cases": {}, "combinations": {"worst": {"wind": 1.5}}}))
    for command in (["run", "la-associated"], ["domain"]):
        done = drystone(*command, str(path))
        assert done.returncode == 2
        assert 'leaning.json: combinations.worst: no load case is called "wind"' in done.stderr
