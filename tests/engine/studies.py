"""Studies of tests, their runs and their rows."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pandas as pd

from harness.engine.executors import LocalExecutor
from harness.engine.store import open_store
from harness.engine.sweep.expand import SweepRun, expand, sources_of
from harness.engine.sweep.frame import tidy
from harness.engine.sweep.running import sweep
from harness.engine.sweep.study import Study
from harness.model.reading import validate
from tests.walls import stack, wall_data


def study(**more: Any) -> Study:
    data = {"name": "made-up", "title": "A study of a test", "methods": ["la-associated"], "wall": wall_data(stack(2))}
    return validate(Study, data | more, "test")


def runs_of(asked: Study) -> list[SweepRun]:
    return expand(asked, sources_of(asked))


def rows_of(asked: Study, store: Path, *, processes: int = 2, fresh: bool = False) -> tuple[pd.DataFrame, int]:
    with open_store(store) as opened:
        ended = list(sweep(runs_of(asked), opened, LocalExecutor(processes), fresh=fresh))
    varied = [*asked.vary, *(name for group in asked.together for name in group), *asked.draw]
    return tidy((row for _, row, _ in ended), varied), sum(stored for _, _, stored in ended)
