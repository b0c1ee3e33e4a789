"""What the page on methods in other languages shows is so, and published schemas are those of the code."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from harness.engine.judge import judge
from harness.model.case import case_folders, read_case, shipped_cases
from harness.model.foreign.description import Description
from harness.model.foreign.register import programs
from harness.model.foreign.result_document import ResultDocument, answer_of
from harness.model.reading import validate
from harness.model.result import result_of
from tests.commands import drystone

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "method-in-another-language.md").read_text(encoding="utf-8")


def shown(language: str, word: str) -> str:
    blocks = re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)
    (found,) = [block for block in blocks if word in block]
    return str(found)


def test_the_result_that_is_shown_is_accepted_for_the_wall_that_slides():
    wall = read_case(case_folders([shipped_cases()])["slide"]).assembly
    answer = answer_of(json.loads(shown("json", "result/1")), wall, "the page")
    said = judge(wall, result_of(answer, wall, case="slide", method="page", family="page"), 1e-9)
    assert said.accepted, said.sentence


def test_the_description_and_the_entry_that_are_shown_are_valid(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    described = validate(Description, json.loads(shown("json", "describe/1")), "the page")
    assert described.all_traits.any_strength
    (tmp_path / "methods.toml").write_text(shown("toml", "methods.mine"))
    monkeypatch.chdir(tmp_path)
    assert programs()["mine"].command[1:] == ("{wall}", "{result}")


def test_every_field_of_a_result_is_explained():
    table = PAGE[PAGE.index("## The result") : PAGE.index("## A program that describes itself")]
    assert [name for name in ResultDocument.model_fields if f"`{name}`" not in table] == []


@pytest.mark.parametrize("name", ["wall", "result", "describe"])
def test_published_schemas_are_those_of_the_code(name: str, tmp_path: Path):
    done = drystone("schema", name, cwd=tmp_path)
    assert json.loads(done.stdout) == json.loads((ROOT / "docs" / f"{name}-1.schema.json").read_text())
