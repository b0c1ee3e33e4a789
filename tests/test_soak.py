"""A share of the soak: random walls through the default methods in one process, whose memory stays flat."""

from __future__ import annotations

import time
from pathlib import Path

import psutil
import pytest

from harness.engine.run import Limits
from harness.engine.store import open_store
from harness.model.build import build
from harness.model.library import library
from tests.soak import FLAT, Record, leftovers, random_wall, soak_wall


def test_walls_of_the_soak_are_many_kinds_and_all_can_be_built():
    titles = set()
    for seed in range(60):
        wall = random_wall(seed)
        assert build(wall).assembly.n_free >= 1
        titles.add(wall.title.split(": ")[1])
    assert titles == {"bond", "ring", "stack", "stones", "panel"}


@pytest.mark.slow
def test_a_minute_of_walls_leaves_no_failure_no_zombie_and_flat_memory(tmp_path: Path):
    record, begun = Record(first_seed=0), time.monotonic()
    with open_store(tmp_path / "soak.sqlite") as store:
        while time.monotonic() - begun < 60.0:
            soak_wall(record, record.walls, list(library().methods.compare), Limits(20.0), store)
    assert record.failures == []
    assert leftovers() == []
    assert record.walls > 5
    # So few walls tell a leak of megabytes a wall only; the long run tells a smaller one.
    assert record.memory[-1] <= (1.0 + 2.0 * FLAT) * record.memory[len(record.memory) // 2]
    assert psutil.Process().memory_info().rss == pytest.approx(record.memory[-1], rel=0.2)
