"""Folders of cases: what `case.toml` and the wall must say together."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from harness.model.case import id_of, read_case
from harness.model.errors import InputError
from tests.walls import stack, wall_data


def folder(path: Path, kind: str = "multiplier", name: str = "mine", **changes: Any) -> Path:
    """A case of a stack of two blocks."""
    place = path / "mine"
    place.mkdir(exist_ok=True)
    wall = {key: value for key, value in (wall_data(stack(2)) | changes).items() if value is not None}
    (place / "wall.json").write_text(json.dumps(wall))
    (place / "case.toml").write_text(f'id = "{name}"\ntitle = "A stack"\nsource = "a test"\nkind = "{kind}"\n')
    return place


def test_a_case_that_asks_for_a_multiplier_has_a_live_load_and_one_of_standing_needs_none(tmp_path: Path):
    assert read_case(folder(tmp_path)).assembly.has_live_load
    assert not read_case(folder(tmp_path, "stability", loads=None)).assembly.has_live_load
    with pytest.raises(InputError, match="there is no live load"):
        read_case(folder(tmp_path, loads=None))


def test_a_case_is_called_as_its_folder_is(tmp_path: Path):
    assert read_case(folder(tmp_path)).id == "mine"
    with pytest.raises(InputError, match='id is "other" in a folder called "mine"'):
        read_case(folder(tmp_path, name="other"))
    with pytest.raises(InputError, match=r"there is no case\.toml"):
        read_case(tmp_path)


def test_every_reference_of_a_case_has_an_id_of_its_own(tmp_path: Path):
    place = folder(tmp_path)
    reference = (
        '[[references]]\nid = "{}"\ntype = "exact"\nvalue = 0.5\ntolerance = 1e-9\ntolerance_reason = "."\n'
        'applies_to = ["la"]\nsource = "a test"\nrequirement = "It is half."\n'
    )
    alone = (place / "case.toml").read_text()
    (place / "case.toml").write_text(alone + reference.format("one") + reference.format("two"))
    assert [item.id for item in read_case(place).file.references] == ["one", "two"]
    (place / "case.toml").write_text(alone + reference.format("one") + reference.format("one"))
    with pytest.raises(InputError, match='two references are called "one"'):
        read_case(place)


@pytest.mark.parametrize(
    ("words", "expected"),
    [("A wall, 3rd", "a-wall--3rd"), ("Mauer \u00fc", "mauer"), ("--", "wall"), ("", "wall"), ("x9", "x9")],
)
def test_an_id_has_letters_and_digits_only(words: str, expected: str):
    assert id_of(words) == expected
