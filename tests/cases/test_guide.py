"""docs/writing-a-wall.md tells the truth: its examples build, its errors are those that are raised."""

import json
import re
import tomllib
from pathlib import Path

import pytest

from harness.model.build import build
from harness.model.case import CaseFile, Reference
from harness.model.errors import InputError
from harness.model.pattern_fields import Panel, Ring, RunningBond, Stack
from harness.model.reading import parse_wall
from tests.walls import built_load_case

GUIDE = (Path(__file__).parents[2] / "docs" / "writing-a-wall.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```json\n(.*?)```", GUIDE, re.DOTALL)
ERRORS = re.findall(r"```json error\n(.*?)```\n\n```text\n(.*?)\n```", GUIDE, re.DOTALL)


@pytest.mark.parametrize("text", EXAMPLES, ids=lambda text: json.loads(text)["title"])
def test_example_builds_without_warning(text: str) -> None:
    wall = parse_wall(json.loads(text), "the guide")
    made = [built_load_case(wall, name) for name in wall.load_cases] or [build(wall)]
    assert [built.warnings for built in made] == [()] * len(made)


@pytest.mark.parametrize(("text", "message"), ERRORS, ids=lambda text: text[:30])
def test_error_is_the_one_that_is_raised(text: str, message: str) -> None:
    with pytest.raises(InputError) as raised:
        build(parse_wall(json.loads(text), ""))
    assert str(raised.value) == message


def test_every_block_of_the_guide_is_tested() -> None:
    assert len(EXAMPLES) >= 10
    assert len(ERRORS) >= 10
    assert GUIDE.count("```json error\n") == len(ERRORS)
    assert GUIDE.count("```json") == len(EXAMPLES) + len(ERRORS)


def test_every_pattern_has_an_example() -> None:
    used = set()
    for text in EXAMPLES:
        pattern = parse_wall(json.loads(text), "the guide").pattern
        used |= {type(item) for item in (pattern if isinstance(pattern, list) else [pattern]) if item}
    assert used == {RunningBond, Ring, Stack, Panel}


def test_friction_rules_of_the_guide_do_what_they_say() -> None:
    (text,) = [text for text in EXAMPLES if "greased" in text]
    assembly = build(parse_wall(json.loads(text), "the guide")).assembly
    heads = [mu for mu, joint in zip(assembly.friction, assembly.joint, strict=True) if joint == "head"]
    assert heads
    assert set(heads) == {0.0}
    assert sorted(set(assembly.friction.tolist())) == [0.0, 0.2, 0.6, 0.8]


def test_the_case_of_the_guide_shows_every_field() -> None:
    text = (Path(__file__).parents[2] / "docs" / "own-case.md").read_text(encoding="utf-8")
    (toml,) = re.findall(r"```toml [^\n]*\n(.*?)```", text, re.DOTALL)
    shown = tomllib.loads(toml)
    assert CaseFile.model_validate(shown).id == "my-wall"
    assert set(shown) == set(CaseFile.model_fields)
    assert set(shown["references"][0]) == set(Reference.model_fields)
