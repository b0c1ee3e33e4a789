"""A command that was typed nearly right says what would be right."""

from __future__ import annotations

import json
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from drystone.cli.main import main
from tests.commands import drystone

WALL = {
    "$schema": "wall-1.schema.json",
    "comment": ["measured in May", "by two people"],
    "format": "wall/1",
    "unit_weight": 20.0,
    "friction": 0.4,
    "pattern": {"type": "stack", "width": 0.3, "height": 0.2, "count": 1},
    "loads": {"live": {"body": [{"per_weight": [1, 0]}]}},
}


@pytest.fixture
def wall(tmp_path: Path) -> Path:
    path = tmp_path / "wall.json"
    path.write_text(json.dumps(WALL))
    return path


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("cmpare", "wall.json"), 'Did you mean "compare"?'),
        (("run", "la", "wal.json"), 'wal.json: there is no such file. Did you mean "wall.json"?'),
        (("run", "la", "wall.json", "--set", "effort"), '"effort" gives no value. Give NAME=VALUE'),
        (("study", "frictoin"), 'Did you mean "friction"?'),
        (("sweep", "frictoin"), 'Did you mean "friction"?'),
        (("gateway", "wall.json", "--vary", "fricton"), '"fricton". Did you mean "friction"?'),
        (("gateway", "wall.json", "--vary", "pattern.cuont"), '"pattern.cuont". Did you mean "pattern.count"?'),
        (("sweep", "wall.json", "--vary", "proportoin=1,2"), '"proportoin". Did you mean "proportion"?'),
        (("sweep", "wall.json", "--vary", "pattern.count[0]=1,2"), 'wall. Did you mean "pattern.count"?'),
        (("sweep", "wall.json", "--vary", "settings.laa.starts=1,2", "--methods", "la"), 'Did you mean "la"?'),
        (("reaction", "wall.json", "--path", "--by", "fee"), 'Did you mean "fe"?'),
        (("bound", "wall.json", "-o", "c.json", "--effort", "quik"), 'Did you mean "quick"?'),
        (("list", "mehods"), 'Did you mean "methods"?'),
        (("run", "la", "wall.json", "--set", "effort=quik"), 'Did you mean "quick"?'),
        (("sweep", "wal.toml"), "wal.toml: there is no such file. Check the path"),
        (("baseline", "show", "--file", "wal.json"), 'wal.json: there is no such file. Did you mean "wall.json"?'),
        (("factor", "wall.json", "--share", "half"), "'half' is not a number."),
        (("export", "wall.json", "--method", "lla", "-o", "a.vtu"), '--method: no method is called "lla"'),
        (("new", "stack", "--count", "1.5"), "'1.5' is not a whole number."),
        (("run", "la", "wall.json", "--seconds", "x"), "'x' is not a number."),
        (("new", "ashlar", "--length", "-2"), "ashlar: length: it should be above 0 (given: -2.0)"),
        (("new", "ashlar", "--course-height", "0"), "ashlar: course_height: it should be above 0"),
        (("new", "two-leaf", "--through", "0"), "two-leaf: through: it should be above 0"),
        (("new", "stack", "--width", "1e300"), "stack: width: it should be less than or equal to 1000000000000000"),
        (("new", "metod", "x"), 'Did you mean "method"?'),
        (("methods", "ad", "x"), 'Did you mean "add"?'),
        (("run", "la", "wall.json", "--jsn"), "--json"),
        (("run", "wall.json", "la"), "The method comes first: la wall.json"),
        (("run", "la-asociated", "wall.json"), 'Did you mean "la-associated"?'),
        (("run", "la", "wal-21"), 'Did you mean "wall-21"?'),
        (("compare", "wall.json", "--methods", "la", "fe"), "--methods la,fe"),
        (("sweep", "wall.json", "--vary", "friction=0.5-0.8"), "FROM:TO:COUNT, for example 0.5:0.8:7"),
        (("sweep", "wall.json", "--vary", "friction=0.5 to 0.8"), "FROM:TO:COUNT"),
    ],
)
def test_what_was_meant_is_said(words: tuple[str, ...], said: str, wall: Path):
    done = drystone(*words, cwd=wall.parent)
    assert done.returncode == 2
    assert said in done.stderr


@pytest.mark.parametrize("words", [("--method", "la-associated", "--method", "fe")])
def test_figure_and_compare_name_methods_alike(words: tuple[str, ...], wall: Path):
    compared = drystone("compare", wall.name, *words, "--no-report", "--json", cwd=wall.parent)
    rows = json.loads(compared.stdout)["cases"][0]["results"]
    assert [row["method"] for row in rows] == ["la-associated", "fe"]
    drawn = drystone("figure", wall.name, *words, "--format", "svg", "-o", "drawn.svg", cwd=wall.parent)
    assert drawn.returncode == 0, drawn.stderr
    assert "la-associated" in (wall.parent / "drawn.svg").read_text()


def test_schema_and_comment_are_taken_kept_and_decide_no_answer(wall: Path):
    expanded = json.loads(drystone("expand", wall.name, cwd=wall.parent).stdout)
    assert (expanded["$schema"], expanded["comment"]) == (WALL["$schema"], WALL["comment"])
    run = ("run", "la-associated", wall.name, "--store", "s.sqlite", "--json")
    first = json.loads(drystone(*run, cwd=wall.parent).stdout)
    plain = {name: value for name, value in WALL.items() if name not in ("$schema", "comment")}
    wall.write_text(json.dumps(plain))
    assert json.loads(drystone(*run, cwd=wall.parent).stdout)["key"] == first["key"]


def test_a_method_for_tests_of_the_engine_stands_in_no_list_and_runs_by_name(wall: Path):
    assert "dummy" not in drystone("list", "methods", cwd=wall.parent).stdout
    assert "dummy" not in drystone("run", "dumy", wall.name, cwd=wall.parent).stderr
    done = drystone("run", "dummy", wall.name, "--json", cwd=wall.parent)
    assert json.loads(done.stdout)["status"] == "ok"


def make_wrong_files(folder: Path) -> None:
    """Files that are neither stores, certificates nor baselines."""
    (folder / "folder").mkdir()
    (folder / "empty.json").touch()
    (folder / "list.json").write_text("[1]")
    (folder / "other.json").write_text('{"a": 1}')
    (folder / "binary.json").write_bytes(bytes([0, 231, 255]) * 99)
    (folder / "later.json").write_text('{"format": "drystone-bound/9", "digest": ""}')
    made = sqlite3.connect(folder / "foreign.sqlite")
    made.execute("CREATE TABLE t (x)")
    made.close()


ON_WRONG_FILES = {
    ("verify-bound",): {
        "wall.json": 'format: it is not a certificate: its format is "wall/1". This release reads',
        "later.json": 'format: it is not a certificate: its format is "drystone-bound/9". This release reads',
        "other.json": "format: it is not a certificate: it has no format. This release reads",
        "list.json": 'a certificate is a JSON object. Begin with {"format": "drystone-bound/1", ...}',
        "empty.json": "it is empty. Give a JSON document",
        "binary.json": "it is no UTF-8 text",
        "foreign.sqlite": "it is an SQLite file, as a store of results is",
        "folder": "it cannot be read (Is a directory)",
        "wal.json": 'there is no such file. Did you mean "wall.json"?',
    },
    ("diff",): {
        "wall.json": 'it is not a baseline: its format is "wall/1". Give',
        "later.json": 'it is not a baseline: its format is "drystone-bound/9". Give',
        "other.json": 'it is not a baseline: it has no "values". Give one as `drystone baseline update` writes it',
        "list.json": 'it is not a baseline: it has no "values". Give one as `drystone baseline update` writes it',
        "empty.json": "it is empty. Give a result store (.sqlite) or a baseline (.json)",
        "binary.json": "it is no UTF-8 text",
        "foreign.sqlite": 'it is not a result store: its table "t" is another program\'s. Name a result store',
        "folder": "it is not a regular file. Give a result store (.sqlite) or a baseline (.json)",
        "wal.json": 'there is no such file. Did you mean "wall.json"?',
    },
    ("store", "merge", "into.sqlite"): {
        **dict.fromkeys(("wall.json", "other.json", "list.json", "binary.json"), "it is not a result store"),
        "empty.json": "it is empty. Name a result store",
        "foreign.sqlite": 'it is not a result store: its table "t" is another program\'s. Name a result store',
        "folder": "it is not a regular file. Name a result store",
        "wal.json": 'there is no such file. Did you mean "wall.json"?',
    },
}


@pytest.mark.parametrize("words", ON_WRONG_FILES, ids=" ".join)
def test_a_wrong_file_is_named_with_what_is_wrong_and_what_would_be_right_and_nothing_is_written(
    words: tuple[str, ...], wall: Path, monkeypatch: pytest.MonkeyPatch
):
    make_wrong_files(wall.parent)
    before = {each.name: each.stat().st_size for each in wall.parent.iterdir()}
    monkeypatch.chdir(wall.parent)
    for name, said in ON_WRONG_FILES[words].items():
        done = CliRunner().invoke(main, [*words, name])
        assert done.exit_code == 2, (name, done.output)
        assert f"drystone: {name}: {said}" in done.output
        assert {each.name: each.stat().st_size for each in wall.parent.iterdir()} == before


def test_a_reader_who_goes_before_the_end_of_a_table_is_no_failure(wall: Path):
    """`drystone compare WALL | head` ended with the exit code of a reference that is not met."""
    words = [sys.executable, "-m", "drystone.cli.main", "compare", str(wall), "--methods", "la-associated"]
    with subprocess.Popen(words, cwd=wall.parent, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.close()
        assert process.stderr is not None
        said = process.stderr.read().decode()
    assert process.returncode == 0, said
    assert "Traceback" not in said
