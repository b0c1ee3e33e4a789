"""A file that is no JSON is told for what stands there, with what would mend it."""

from __future__ import annotations

from pathlib import Path

import pytest

from harness.model.errors import InputError
from harness.model.json_text import json_of, read_json

BROKEN = {
    "": "it is empty",
    " \n": "it is empty",
    '{"a": 1,}': 'line 1, column 9: a comma too many stands before "}". Take it out',
    '{"a": [1, 2,\n]}': 'line 2, column 1: a comma too many stands before "]". Take it out',
    '{"a": [1,, 2]}': "column 10",
    '{"a": }': 'a value is missing before "}"',
    "{'a': 1}": "single quotes stand round a text. Use double quotes",
    "{\"a\": 'b'}": "single quotes stand round a text. Use double quotes",
    '{"a": 1': "the file ends in the middle",
    '{"a": ': "the file ends in the middle",
    '{"a': "a text has no end in its line",
    '{"a": "b\n"}': "a text has no end in its line",
    '{"a": 1} {"b": 2}': "something stands after the end of the document",
    '{"a": True}': "True is a word of Python. Write true, false or null",
    '{"a": None}': "None is a word of Python",
    '{"a": 1 // one\n}': "a comment stands there, and JSON has none",
    "// one\n{}": "a comment stands there",
    '{"a": 1 "b": 2}': 'column 9: """ stands where a comma or a closing bracket is expected',
    '{"a" 1}': '"1" stands where a colon is expected',
    "{a: 1}": '"a:" stands where a name in double quotes is expected',
    '{"a": abc}': '"abc}" stands where a value is expected',
    "<html></html>": "it is XML or HTML, not JSON",
}


@pytest.mark.parametrize("text", BROKEN)
def test_broken_json_says_what_stands_there(text: str) -> None:
    with pytest.raises(InputError) as caught:
        json_of(text, "wall.json")
    assert BROKEN[text] in str(caught.value)
    assert "Expecting" not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "kind"),
    [(b"\x89PNG\r\n", "a PNG picture"), (b"\xff\xd8\xff\xe0", "a JPEG picture"), (b"GIF89a", "a GIF picture"),
     (b"%PDF-1.7", "a PDF"), (b"PK\x03\x04", "a ZIP archive"), (b"\x1f\x8b\x08", "compressed"),
     (b"{\0}\0", "line 1, column 2"), ('{"a": "é"}'.encode("latin-1"), "no UTF-8 text: byte 0xe9 in line 1"),
     ("{}".encode("utf-16"), "text in UTF-16")],
)  # fmt: skip
def test_what_is_no_text_is_told_by_its_kind(content: bytes, kind: str, tmp_path: Path) -> None:
    (tmp_path / "wall.json").write_bytes(content)
    with pytest.raises(InputError, match=kind):
        read_json(tmp_path / "wall.json")
