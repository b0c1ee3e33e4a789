"""Names of walls in a comparison: files of one name keep two, and a file beside a case of the library is told."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from harness.engine.plan import find_cases
from harness.model.errors import InputError
from tests.commands import drystone
from tests.walls import stack, wall_data


def wall(path: Path, friction: float = 0.5) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(wall_data(stack(1), friction)))
    return path


def names(*paths: Path) -> list[str]:
    return [case.id for case in find_cases([str(path) for path in paths], None, ())]


def test_files_of_one_name_take_those_of_their_folders(tmp_path: Path):
    one, two = wall(tmp_path / "a" / "wall.json"), wall(tmp_path / "b" / "wall.json")
    assert names(one, two) == ["a-wall", "b-wall"]
    assert names(one) == ["wall"]
    assert names(one, one) == ["wall"]
    deep, other = wall(tmp_path / "x" / "a" / "wall.json"), wall(tmp_path / "y" / "a" / "wall.json")
    assert names(deep, other) == ["x-a-wall", "y-a-wall"]


def test_names_that_only_look_alike_are_numbered(tmp_path: Path):
    assert names(wall(tmp_path / "my wall.json"), wall(tmp_path / "my-wall.json"))[1].endswith("my-wall-2")


def test_two_walls_of_one_name_keep_two_rows_two_folders_and_two_names_in_the_csv(tmp_path: Path):
    one, two = wall(tmp_path / "a" / "wall.json", 0.2), wall(tmp_path / "b" / "wall.json", 0.3)
    done = drystone("compare", one, two, "--methods", "la-associated", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    compared = json.loads(done.stdout)
    found = {case["id"]: case["results"][0]["multiplier"] for case in compared["cases"]}
    assert found == {"a-wall": pytest.approx(0.2), "b-wall": pytest.approx(0.3)}
    folder = tmp_path / "out" / "report-data"
    rows = list(csv.DictReader((folder / "results.csv").read_text().splitlines()))
    assert {row["case"]: float(row["multiplier"]) for row in rows} == found
    for name, multiplier in found.items():
        assert json.loads((folder / name / "la-associated.json").read_text())["multiplier"] == pytest.approx(multiplier)
    again = drystone("report", cwd=tmp_path)
    assert again.returncode == 0
    assert {row["case"] for row in csv.DictReader((folder / "results.csv").read_text().splitlines())} == set(found)


def test_a_file_beside_a_case_of_the_library_is_told_with_the_way_to_name_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.chdir(tmp_path)
    assert find_cases(["portal"], None, ())[0].notes == ()
    wall(tmp_path / "portal.json")
    (library,) = find_cases(["portal"], None, ())
    assert len(library.wall.blocks) > 0
    assert "./portal.json" in library.notes[0]
    assert library.warnings[0] == library.notes[0]
    (own,) = find_cases(["./portal.json"], None, ())
    assert own.notes == ()
    assert own.origin == "portal.json"
    both = find_cases(["portal", "./portal.json"], None, ())
    assert len({case.id for case in both}) == 2


def test_near_words_are_asked_for(tmp_path: Path):
    with pytest.raises(InputError, match='Did you mean "portal"'):
        find_cases(["portall"], None, ())
    for words, meant in (
        (("run", "laa", "portal"), '"la"'),
        (("run", "la", "portal", "--set", "tolerence=1"), "is no setting"),
    ):
        done = drystone(*words, cwd=tmp_path)
        assert done.returncode == 2
        assert meant in done.stderr
