"""Import, export, the list and the docs have their formats from one table."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from harness.formats import register
from harness.formats.registry import FORMATS, Format, drawings, format_read, format_written
from harness.model import reading
from harness.model.errors import InputError, MissingPackage
from tests.commands import drystone

PAGE = Path(__file__).resolve().parents[2] / "docs" / "drawings.md"


@pytest.mark.parametrize("item", FORMATS, ids=lambda item: item.title)
def test_a_format_is_read_written_or_refused_as_its_row_says(item: Format):
    assert bool(item.reader or item.writer) != bool(item.refusal)
    assert bool(item.reader) == bool(item.stones)
    assert bool(item.writer) == bool(item.holds)
    for suffix in item.suffixes:
        path = Path(f"wall{suffix.upper()}")
        if item.reader:
            assert format_read(path) is item
            assert callable(item.read)
        else:
            with pytest.raises(InputError) as caught:
                format_read(path)
            assert not item.refusal or item.refusal[1:] in str(caught.value)
        if item.writer:
            assert format_written(path) is item
            assert callable(item.write)
        else:
            with pytest.raises(InputError, match="is not written"):
                format_written(path)


@pytest.mark.parametrize("item", [item for item in FORMATS if item.package], ids=lambda item: item.title)
def test_a_format_whose_package_is_missing_is_refused_with_its_extra_before_any_work(
    item: Format, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setitem(sys.modules, item.module or item.package, None)
    asked = [format_read] * bool(item.reader) + [format_written] * bool(item.writer and not item.written_without)
    for known in asked:
        with pytest.raises(MissingPackage, match=r"drystone\[drawings\]"):
            known(Path(f"wall{item.suffixes[0]}"))
    if item.written_without:
        assert format_written(Path(f"wall{item.suffixes[0]}")) is item


def test_no_ending_has_two_formats():
    suffixes = [suffix for item in FORMATS for suffix in item.suffixes]
    assert len(set(suffixes)) == len(suffixes)


def test_every_command_takes_the_drawings_of_the_table_and_a_json_for_a_wall():
    register()
    assert set(drawings()) == set(reading.DRAWINGS)
    assert ".json" not in drawings()
    assert {".dxf", ".csv", ".pdf"} <= set(drawings())


def test_the_list_and_the_docs_show_every_format():
    listed = json.loads(drystone("list", "formats", "--json").stdout)
    assert listed == [item.row() for item in FORMATS]
    page = PAGE.read_text(encoding="utf-8").splitlines()
    for item in FORMATS:
        endings = ", ".join(f"`{suffix}`" for suffix in item.suffixes)
        for shown in (
            item.stones and f"{item.stones} | {item.package}",
            item.holds and f"{item.holds} | {'' if item.written_without else item.package}",
        ):
            assert not shown or f"| {endings} | {shown} |" in page
        assert not item.refusal or f"| {endings} | {item.refusal} |" in page


def test_the_help_of_import_and_export_shows_what_they_take():
    for command, asked in (("import", "stones"), ("export", "holds")):
        told = drystone(command, "--help").stdout
        assert all(getattr(item, asked) in told for item in FORMATS)
