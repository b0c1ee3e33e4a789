"""Hostile walls: each ends in a wall or in a sentence, within 5 s of CPU and 1 GB, read and looked over each."""

from __future__ import annotations

import json
import os
import time
import traceback
from pathlib import Path

import pytest

from drystone.cli.drawings import looked_at
from harness.model.errors import InputError
from harness.model.reading import read_wall
from tests.fuzz.hostile import KINDS

SIZE = 5_000
"""Entries of a list: a cost that grows with their square, or with their product, takes more than the time allowed."""
LONGEST = 50_000
"""Characters of an error: a hundred lines, each with the fields that are known at its place."""


def outcome(path: Path) -> tuple[str, float]:
    """The outcome of reading a wall and, if it is none, of looking it over; CPU seconds of the longer of both."""
    began = time.process_time()
    try:
        read_wall(path)
        return "built", time.process_time() - began
    except InputError as error:
        said = str(error)
    read = time.process_time()
    try:
        seen = f"{len(looked_at(str(path), ()).marks)} marks"
    except InputError as error:
        seen = str(error)
    return f"{said}\n{seen}", max(read - began, time.process_time() - read)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the cost of one document is that of a child process")
@pytest.mark.parametrize("kind", KINDS)
def test_a_hostile_wall_ends_in_a_wall_or_a_sentence_at_little_cost(kind: str, tmp_path: Path):
    path = tmp_path / "hostile.json"
    path.write_text(json.dumps(KINDS[kind](SIZE)))
    child = os.fork()
    if child == 0:
        try:
            said, seconds = outcome(path)
        except BaseException:
            said, seconds = traceback.format_exc(), 0.0
        (tmp_path / "said").write_text(said)
        (tmp_path / "seconds").write_text(str(seconds))
        os._exit(0)
    _, status, used = os.wait4(child, 0)
    said = (tmp_path / "said").read_text()
    assert status == 0
    assert "Traceback" not in said, said
    assert len(said) < 2 * LONGEST
    assert all(line.isprintable() for line in said.split("\n"))
    assert float((tmp_path / "seconds").read_text()) < 5.0
    assert used.ru_maxrss < 2**20  # KiB
