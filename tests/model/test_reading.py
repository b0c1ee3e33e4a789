"""Reading: files that never end, text that is no text, and all faults of a file told at once."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import pytest
from pydantic import BaseModel, ValidationError

from harness.engine.sweep.study import Study
from harness.formats.importing import Mapping
from harness.model.case import CaseFile
from harness.model.errors import InputError, InputFaults, did_you_mean, visible
from harness.model.field_words import fields_at, words_of
from harness.model.foreign.program_method import Description
from harness.model.foreign.register import Program
from harness.model.foreign.result_document import ResultDocument
from harness.model.json_text import MOST_NESTED, json_of, read_bytes, read_json, read_text
from harness.model.reading import parse_wall
from harness.model.wall import Wall

MANY: dict[str, Any] = {
    "format": "wall/1",
    "unit_weight": 20,
    "blocks": [
        {"id": "ground", "polygon": [[-1, -1], [3, -1], [3, 0], [-1, 0]], "fixed": True},
        {"id": "a", "polygon": [[0, 0], [1, 0], [1, 1], [0, 1]], "wieght": 3},
        {"id": "b", "polygon": [[0, 1], [1, 1]]},
        {"id": "c", "polygon": [[1, 0], [2, 0], [2, 1], [1, 1]], "unit_weight": -3},
    ],
    "loads": {"live": {"points": [{"block": "a", "at": [0, 0], "force": 1}]}},
    "frction": 0.5,
}


def test_all_faults_are_told_at_once_in_the_order_of_the_file():
    with pytest.raises(InputFaults) as caught:
        parse_wall(MANY, "many.json")
    places = [fault.element for fault in caught.value.faults]
    assert places == [
        "friction",
        'blocks[1].wieght ("a")',
        'blocks[2].polygon ("b")',
        'blocks[3].unit_weight ("c")',
        "loads.live.points[0].force",
        "frction",
    ]
    lines = str(caught.value).splitlines()
    assert lines[0] == "many.json: 6 faults"
    assert len(lines) == 1 + len(places)
    assert all(fault.source == "many.json" for fault in caught.value.faults)


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        (
            {"pattern": {"type": "stack", "width": 1, "height": 1}},
            "pattern.count: it is missing. Give a whole number of at least 1",
        ),
        ({"pattern": [{"width": 1}]}, 'pattern[0]: it has no "type". Give "running_bond" or "ring" or "stack"'),
        ({"pattern": {"type": "ring", "colour": 1}}, "Known here: prefix, origin"),
        (
            {"blocks": [{"id": "a"}]},
            "Give a list of at least 3 entries, each a pair of numbers, as [0, 1]: vertices in order",
        ),
        ({"blocks": {}}, "it should be a list, in square brackets. Give a list of entries, each an object with"),
        ({"ties": [{"to": {"block": "a"}}]}, "ties[0].to.at: it is missing. Give a pair of numbers, as [0, 1]: (x, y)"),
        ({"ties": [{}]}, 'ties[0].from: it is missing. Give an object with "block", "at"'),
        ({"interfaces": [{}]}, 'interfaces[0].between: it is missing. Give a pair of names, as ["a", "b"]: ids of'),
        ({"loads": {"dead": {"fills": [{"passive": {}}]}}}, "Give a number above 0 and of at most 1, as 1: share m"),
        (
            {"load_cases": {"a": {"live": {"points": [{}]}}}},
            "load_cases.a.live.points[0].block: it is missing. Give text",
        ),
    ],
)
def test_a_fault_of_shape_says_what_the_field_takes(fields: dict[str, Any], said: str):
    with pytest.raises(InputError) as caught:
        parse_wall({"format": "wall/1", "friction": 0.5} | fields, "wall.json")
    assert said in str(caught.value)


@pytest.mark.parametrize("model", [Wall, CaseFile, Study, Mapping, Program, Description, ResultDocument])
def test_every_field_that_may_be_missing_has_a_remedy(model: type[BaseModel]):
    schema = model.model_json_schema()
    for part in (schema, *schema.get("$defs", {}).values()):
        for name in part.get("required", ()):
            (field,) = fields_at(model, (name,)) if part is schema else [part["properties"][name]]
            assert words_of(model, field), name


def test_the_same_fault_of_many_elements_is_one_line():
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    blocks = [{"id": f"b{k}", "vertices": square} for k in range(20)]
    with pytest.raises(InputFaults) as caught:
        parse_wall({"format": "wall/1", "friction": 0.5, "blocks": blocks}, "many.json")
    said = str(caught.value).splitlines()
    assert said[0] == "many.json: 40 faults"
    assert len(said) == 3
    assert (
        said[1]
        .strip()
        .startswith('blocks[0].polygon ("b0"), blocks[1].polygon ("b1"), blocks[2].polygon ("b2") and 17')
    )
    assert 'Did you mean "polygon"?' in said[2]


def test_one_fault_is_an_error_of_its_own():
    with pytest.raises(InputError) as caught:
        parse_wall({"format": "wall/1", "friction": -1}, "wall.json")
    assert not isinstance(caught.value, InputFaults)
    assert str(caught.value).startswith("wall.json: friction: ")


@pytest.mark.parametrize(("word", "meant"), [("frction", "friction"), ("Blocks", "blocks"), ("qqqq", "")])
def test_a_near_word_is_asked_for(word: str, meant: str):
    assert did_you_mean(word, ["friction", "blocks"]) == (f'Did you mean "{meant}"?' if meant else "")


@pytest.mark.parametrize("field", ["fracture_energy", "creep", "anchors", "crushing", "youngsModulus"])
def test_a_field_of_another_model_is_told_to_be_outside_with_the_way_to_the_scope(field: str):
    with pytest.raises(InputError, match=rf'"{field}" is outside the model.*docs/scope\.md'):
        parse_wall({"format": "wall/1", "friction": 0.5, field: 1.0}, "wall.json")


@pytest.mark.parametrize(
    "text", ["\x1b]0;x\x07\x1b[2J", "a\nb", "a\rb", "\u202eb", "\ud800", "\x00", "\u2028", "\x9b1m"]
)
def test_control_characters_are_shown_and_never_obeyed(text: str):
    shown = visible(text)
    assert shown.isprintable()
    assert "\\" in shown
    assert str(InputError("bad", element=f'block "{text}"')).isprintable()


def test_visible_text_stays_as_it_is():
    assert visible("Mauer μ = 0,5 石") == "Mauer μ = 0,5 石"


def test_devices_pipes_folders_and_large_files_are_refused_at_once(tmp_path: Path):
    pipe = tmp_path / "pipe.json"
    os.mkfifo(pipe)
    large = tmp_path / "large.json"
    with open(large, "wb") as file:
        file.truncate(2**30)  # sparse: a gigabyte that takes no room
    for path, reason in (
        (Path("/dev/zero"), "not a regular file"),
        (pipe, "not a regular file"),
        (tmp_path, "directory"),
        (large, "1,073,741,824 bytes"),
        (tmp_path / "none.json", "no such file"),
        (tmp_path / "a\0b.json", "cannot be read"),
    ):
        with pytest.raises(InputError, match=reason):
            read_json(path)


def test_a_file_of_exactly_the_limit_is_read(tmp_path: Path):
    path = tmp_path / "x"
    path.write_bytes(b"\xef\xbb\xbfabc")
    assert read_bytes(path, 6) == b"\xef\xbb\xbfabc"
    assert read_text(path, 6) == "abc"
    with pytest.raises(InputError, match="at most 5"):
        read_text(path, 5)


@pytest.mark.parametrize("opening", ["[", '{"a":'])
@pytest.mark.parametrize("depth", [MOST_NESTED + 1, 500, 200_000])
def test_what_is_nested_too_deeply_is_refused(opening: str, depth: int):
    closing = "]" if opening == "[" else "}"
    inner = "0" if opening != "[" else ""
    with pytest.raises(InputError, match="nested"):
        json_of(opening * depth + inner + closing * depth, "deep.json")


def test_half_a_character_is_refused_and_a_whole_one_read():
    with pytest.raises(InputError, match="half a character"):
        json_of('{"a": "\\ud83d"}', "half.json")
    assert json_of('{"a": "\\ud83d\\ude00"}', "whole.json") == {"a": "\U0001f600"}
    assert json.loads('"\\ud83d\\ude00"') == "\U0001f600"


def test_a_document_of_too_many_values_is_refused_before_it_is_read():
    with pytest.raises(InputError, match="more than 4,000,000 values"):
        json_of("[" + "{}," * 4_000_000 + "{}]", "wall.json")


@pytest.mark.parametrize(("name", "count"), [("blocks", 100_001), ("interfaces", 300_001)])
def test_a_wall_of_too_many_entries_is_refused_before_they_are_looked_at(name: str, count: int):
    with pytest.raises(InputError, match=f"{count:,} {name}"):
        parse_wall({"format": "wall/1", name: [{}] * count}, "wall.json")


def test_holes_of_too_many_vertices_are_refused_before_they_are_cut():
    corners = [[0.0, 0.0], [900.0, 0.0], [900.0, 1.0], [0.0, 1.0]]
    holes = [[[x + 0.1, 0.1], [x + 0.4, 0.1], [x + 0.4, 0.4]] for x in range(300)]
    block = {"id": "a", "polygon": corners, "holes": holes}
    with pytest.raises(InputError, match="too many to be cut"):
        parse_wall({"format": "wall/1", "friction": 0.5, "blocks": [block]}, "wall.json")


@pytest.mark.parametrize("model", [Wall, CaseFile, Study])
def test_no_field_takes_text_for_true_or_for_a_whole_number(model: type[BaseModel]):
    """A block with "fixed": "yes" was a support: pydantic takes several words and numbers for true."""
    seen: set[type[BaseModel]] = set()
    waiting, loose = [model], []
    while waiting:
        part = waiting.pop()
        if part in seen:
            continue
        seen.add(part)
        part.model_rebuild()
        for name, field in part.model_fields.items():
            kinds = set(all_types(field.annotation))
            waiting += [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)]
            for kind, text in ((bool, "yes"), (int, "6")):
                if field.annotation is kind and accepts(part, name, text):
                    loose.append(f"{part.__name__}.{name}")
    assert not loose


def all_types(annotation: Any) -> Iterator[Any]:
    """The types within an annotation."""
    yield annotation
    for part in get_args(annotation):
        yield from all_types(part)


def accepts(model: type[BaseModel], name: str, text: str) -> bool:
    """Whether a field of a model takes a text, whatever else is missing."""
    try:
        model.model_validate({name: text})
    except ValidationError as error:
        return not any(fault["loc"] and fault["loc"][0] == name for fault in error.errors())
    return True


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"friction": [None]}, "it should be"),
        ({"thickness": "1"}, 'thickness: it should be a number (given: "1")'),
        ({"unit_weight": math.nan}, "unit_weight: it should be a finite number (given: NaN)"),
        ({"friction": -math.inf}, "friction: it should be a finite number (given: -Infinity)"),
        ({"thickness": True}, "thickness: it should be a number (given: true)"),
        ({"title": 3}, "title: it should be text, in quotes (given: 3)"),
        ({"pattern": {"type": "stack", "width": 1, "height": 1, "count": 1.5}}, "it should be a whole number"),
        ({"pattern": {"type": "ladder"}}, 'its type is "ladder", and should be one of "running_bond", "ring"'),
        ({"units": {"length": "parsec"}}, 'it should be "m", "dm", "cm"'),
    ],
)
def test_what_was_given_is_told_as_the_file_writes_it(fields: dict[str, Any], said: str):
    """Words of Python, None, True and 'text', are no words of a wall file."""
    with pytest.raises(InputError) as caught:
        parse_wall({"format": "wall/1", "friction": 0.5, "blocks": []} | fields, "w.json")
    assert said in str(caught.value)
    assert not any(word in str(caught.value) for word in ("None", "True", "False", "nan", "'"))
