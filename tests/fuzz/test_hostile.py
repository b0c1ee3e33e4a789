"""Hostile walls: each ends in a wall or in a sentence, within 5 s of CPU and 1 GB, read or looked over."""

from __future__ import annotations

import json
import os
import traceback
from pathlib import Path

import pytest

from drystone.cli.drawings import _looked_at
from harness.model.errors import InputError
from harness.model.reading import read_wall
from tests.fuzz.hostile import KINDS

SIZE = 5_000
"""Entries of a list: a cost that grows with their square, or with their product, takes more than the time allowed."""
LONGEST = 50_000
"""Characters of an error: a hundred lines, each with the fields that are known at its place."""


def outcome(path: Path) -> str:
    """The outcome of reading a wall and of looking it over."""
    try:
        read_wall(path)
        return "built"
    except InputError as error:
        said = str(error)
    try:
        return f"{said}\n{len(_looked_at(path).marks)} marks"
    except InputError as error:
        return f"{said}\n{error}"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the cost of one document is that of a child process")
@pytest.mark.parametrize("kind", KINDS)
def test_a_hostile_wall_ends_in_a_wall_or_a_sentence_at_little_cost(kind: str, tmp_path: Path):
    path = tmp_path / "hostile.json"
    path.write_text(json.dumps(KINDS[kind](SIZE)))
    child = os.fork()
    if child == 0:
        try:
            said = outcome(path)
        except BaseException:
            said = traceback.format_exc()
        (tmp_path / "said").write_text(said)
        os._exit(0)
    _, status, used = os.wait4(child, 0)
    said = (tmp_path / "said").read_text()
    assert status == 0
    assert "Traceback" not in said, said
    assert len(said) < 2 * LONGEST
    assert all(line.isprintable() for line in said.split("\n"))
    assert used.ru_utime + used.ru_stime < 5.0
    assert used.ru_maxrss < 2**20  # KiB
