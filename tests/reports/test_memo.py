"""What a report needs twice is made once while it is written, and never taken for that of another object."""

from __future__ import annotations

import os
from pathlib import Path

from reports.drawing.svg import body
from reports.drawing.wall_drawing import wall_drawing
from reports.memo import each_once, memo
from reports.page import build
from tests.reports import samples

made: list[str] = []


@memo
def told(items: list[int], *, twice: bool = False) -> str:
    made.append(str(items))
    return str(items * (2 if twice else 1))


def test_a_value_is_made_once_for_the_same_objects_and_again_for_equal_ones():
    made.clear()
    first, equal = [1, 2], [1, 2]
    with each_once():
        assert told(first) == told(first) == told(equal) == "[1, 2]"
        assert told(first, twice=True) == "[1, 2, 1, 2]"
        assert told(first, twice=True) == "[1, 2, 1, 2]"
        assert len(made) == 3
        first.append(3)
    assert told(first) == "[1, 2, 3]", "outside nothing is kept"
    assert len(made) == 4


def test_many_short_lived_objects_are_never_taken_for_each_other():
    with each_once():
        assert [told([k]) for k in range(500)] == [f"[{k}]" for k in range(500)]


def test_the_page_is_the_same_with_and_without_what_is_kept(tmp_path: Path):
    run = samples.typical()
    build.write_report(run, tmp_path / "r.html")
    assert (tmp_path / "r.html").read_text(encoding="utf-8") == build.render(run, data_folder="r-data")
    case = run.cases[0].case
    kept = (tmp_path / "r-data" / case.id / "wall.svg").read_text(encoding="utf-8")
    assert body(wall_drawing(case)) in kept


def test_files_that_would_be_written_as_they_are_stay_untouched(tmp_path: Path):
    run = samples.typical()
    build.write_report(run, tmp_path / "r.html")
    same, other = tmp_path / "r-data" / "results.csv", tmp_path / "r-data" / "index.json"
    before = same.read_bytes(), other.read_bytes()
    other.write_bytes(before[1].replace(b"results.csv", b"results.csx", 1))
    for file in (same, other):
        os.utime(file, (1.0, 1.0))
    build.write_report(run, tmp_path / "r.html")
    assert (same.read_bytes(), other.read_bytes()) == before
    assert same.stat().st_mtime == 1.0
    assert other.stat().st_mtime > 1.0, "of the same size, and yet written again"
