"""Outputs: whole or not at all, never in place of something that is no file; cells that no spreadsheet runs."""

from __future__ import annotations

import csv
import os
from pathlib import Path

import pytest

from harness.model.errors import InputError
from harness.model.reading import wall_json
from harness.model.wall import Wall
from harness.model.writing import cell, replacing, uncelled, write_whole
from tests.commands import drystone
from tests.walls import stack, wall_data


@pytest.mark.parametrize("kind", ["folder", "pipe", "device", "link to a device"])
def test_nothing_but_a_regular_file_is_replaced(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "out.json"
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "device":
        path = Path("/dev/full")
    else:
        path.symlink_to("/dev/null")
    before = path.stat()
    with pytest.raises(InputError, match="not a regular file"):
        write_whole(path, "text")
    assert (path.stat().st_mode, path.stat().st_ino) == (before.st_mode, before.st_ino)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("a" * 300 + ".json", "too long"),
        ("a/" * 2_100 + "x.json", "too long"),
        ("ring.json", "links in a ring"),
        ("ring.json/x.json", "links in a ring"),
        ("file/x.json", "is no folder"),
        ("file/below/x.json", "is no folder"),
    ],
    ids=lambda name: name[:9],
)
def test_a_name_that_no_file_can_have_is_refused_before_the_work_begins(name: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("old")
    (tmp_path / "ring.json").symlink_to("ring.json")
    (tmp_path / "wall.json").write_text(wall_json(Wall.model_validate(wall_data(stack(2)))))
    with pytest.raises(InputError, match=said):
        write_whole(tmp_path / name, "text")
    done = drystone("bound", "wall.json", "-o", name, cwd=tmp_path)
    assert (done.returncode, "Traceback" in done.stderr, said in done.stderr) == (2, False, True), done.stderr
    assert {path.name for path in tmp_path.iterdir()} == {"file", "ring.json", "wall.json"}
    assert (tmp_path / "file").read_text() == "old"


def test_a_link_to_a_file_stays_a_link_and_its_file_is_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("old")
    (tmp_path / "link").symlink_to(tmp_path / "file")
    write_whole(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "file").read_text() == "new"


def test_a_writer_that_fails_leaves_the_earlier_file_and_nothing_beside_it(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("old")

    def half() -> None:
        with replacing(tmp_path / "file") as draft:
            draft.write_text("ha")
            raise ValueError("half way")

    with pytest.raises(ValueError, match="half way"):
        half()
    assert (tmp_path / "file").read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize(
    "words",
    [
        ("import", "wall.csv", "-o", "TARGET"),
        ("expand", "wall.json", "-o", "TARGET"),
        ("repair", "wall.json", "--snap", "0.001", "-o", "TARGET"),
        ("show", "wall.json", "-o", "TARGET"),
        ("export", "wall.json", "-o", "TARGET"),
        ("figure", "wall.json", "-o", "TARGET"),
        ("animate", "wall.json", "-o", "TARGET"),
        ("bound", "wall.json", "-o", "TARGET"),
        ("learn", "-o", "TARGET"),
        ("new", "stack", "-o", "TARGET"),
        ("compare", "wall.json", "--report", "TARGET"),
        ("compare", "wall.json", "--junit", "TARGET"),
    ],
    ids=" ".join,
)
def test_commands_refuse_a_pipe_as_an_output_before_they_work(words: tuple[str, ...], tmp_path: Path) -> None:
    (tmp_path / "wall.csv").write_text("block,x,y\na,0,0\na,1,0\na,1,1\na,0,1\nb,0,1\nb,1,1\nb,1,2\nb,0,2\n")
    (tmp_path / "wall.json").write_text(wall_json(Wall.model_validate(wall_data(stack(2)))))
    for suffix in ("svg", "gif"):
        os.mkfifo(tmp_path / f"pipe.{suffix}")
    target = "pipe.gif" if words[0] == "animate" else "pipe.svg"
    done = drystone(*(target if word == "TARGET" else word for word in words), cwd=tmp_path)
    assert done.returncode == 2, done.stderr
    assert "not a regular file" in done.stderr
    assert (tmp_path / target).is_fifo()
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("text", ["=1+1", "+A1", "-A1", "@sum(1)", "\t=1", "\r=1", "=cmd|' /c calc'!A0"])
def test_a_text_that_a_spreadsheet_would_run_is_kept_from_it(text: str) -> None:
    assert cell(text) == f"'{text}"
    assert uncelled(cell(text)) == text


@pytest.mark.parametrize("value", [-1.5, 3, True, None, "", "a=b", "-1.5", "+2", "-1e-3", "'tis", "0=0"])
def test_numbers_and_other_texts_stay_as_they_are(value: object) -> None:
    assert cell(value) is value
    assert value == (uncelled(value) if isinstance(value, str) else value)


def test_exported_corners_are_safe_and_read_back_with_their_names(tmp_path: Path) -> None:
    blocks = [
        {"id": "=1+1", "polygon": [[-1, 0], [1, 0], [1, 1], [-1, 1]], "fixed": True, "material": "@stone"},
        {"id": "-x", "polygon": [[-1, 1], [1, 1], [1, 2], [-1, 2]]},
    ]
    wall = {"format": "wall/1", "blocks": blocks, "friction": 0.5, "unit_weight": 20}
    (tmp_path / "wall.json").write_text(wall_json(Wall.model_validate(wall)))
    assert drystone("export", "wall.json", "-o", "wall.csv", cwd=tmp_path).returncode == 0
    with (tmp_path / "wall.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert {row["block"] for row in rows} == {"'=1+1", "'-x"}
    assert {row["material"] for row in rows} == {"'@stone", "stone"}
    assert {float(row["x"]) for row in rows} == {-1.0, 1.0}
    from harness.formats.importing import import_drawing

    read = import_drawing(tmp_path / "wall.csv").wall
    assert [(block.id, block.material) for block in read.blocks] == [("=1+1", "@stone"), ("-x", "stone")]
