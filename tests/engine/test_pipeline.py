"""One run has one key: what a study, a comparison, a check or a single run made serves all the others."""

from __future__ import annotations

import importlib
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import drystone
from harness.engine import pipeline
from harness.engine.executors import InProcess, LocalExecutor
from harness.engine.provenance import JUDGE
from harness.engine.run import Limits, Run
from harness.engine.store import open_store
from harness.engine.sweep.expand import expand, sources_of
from harness.engine.sweep.running import sweep
from harness.engine.sweep.study import Study
from harness.model.reading import validate
from harness.model.result import Judgement
from tests.commands import drystone as command
from tests.walls import case, stack, wall_data

METHOD = "la-associated"


def by_sweep(store: Path) -> Any:
    wall = drystone.library_wall("single-block")  # its friction is 0.6
    return drystone.sweep(wall, {"friction": [0.6]}, [METHOD], store=store).rows[0]["key"]


def by_compare(store: Path) -> Any:
    return drystone.compare(drystone.library_wall("single-block"), [METHOD], store=store).results[0].key


def by_analyse(store: Path) -> Any:
    return drystone.analyse(drystone.library_wall("single-block"), METHOD, isolated=True, store=store).key


def by_command(store: Path) -> Any:
    done = command("run", METHOD, "single-block", "--json", "--store", str(store))
    return json.loads(done.stdout)["key"]


WAYS = (by_sweep, by_compare, by_analyse, by_command)


@pytest.mark.parametrize("first", WAYS)
def test_a_run_is_made_once_whoever_asks_first(first: Callable[[Path], Any], tmp_path: Path):
    store = tmp_path / "runs.sqlite"
    key = first(store)
    with open_store(store) as opened:
        ((_, _, _, started, *_),) = opened.table()
        made = opened.get(key)
        assert made is not None
    for way in WAYS:
        assert way(store) == key
    with open_store(store) as opened:
        ((_, _, _, again, *_),) = opened.table()
        assert again == started
        assert opened.get(key) == made, "nothing was made again"


def test_title_metadata_and_doubts_of_a_wall_make_no_other_run():
    wall = wall_data(stack(2))
    same = [wall, wall | {"title": "another"}, wall | {"metadata": {"source": "me"}}, wall | {"doubts": ["a guess"]}]
    runs = [Run(drystone.build_wall(data).case, METHOD, {}, Limits()) for data in same]
    assert len({run.key for run in runs}) == 1
    other = Run(drystone.build_wall(wall | {"friction": 0.123}).case, METHOD, {}, Limits())
    assert other.key != runs[0].key


def test_settings_limits_and_method_make_another_run():
    wall = case(stack(2))
    runs = [
        Run(wall, "la", {}, Limits()),
        Run(wall, METHOD, {}, Limits()),
        Run(wall, METHOD, {"solver": "own"}, Limits()),
        Run(wall, METHOD, {}, Limits(seconds=1.0)),
        Run(wall, METHOD, {}, None),
    ]
    assert len({run.key for run in runs}) == len(runs)


def test_another_judge_judges_what_is_kept_anew_and_makes_nothing_again(tmp_path: Path):
    asked = validate(Study, {"name": "one", "title": "one", "methods": [METHOD], "wall": wall_data(stack(2))}, "test")
    runs = expand(asked, sources_of(asked))
    with open_store(tmp_path / "runs.sqlite") as store:
        ((_, row, stored),) = sweep(runs, store, LocalExecutor(1))
        assert not stored
        kept = store.get(runs[0].key)
        assert kept is not None
        old = Judgement(accepted=False, sentence="An earlier judge.", code="another")
        store.put(runs[0].key, kept[0].model_copy(update={"judge": old}), kept[1])
        ((_, again, stored),) = sweep(runs, store, LocalExecutor(1))
        assert stored
        assert again == row, "judged by the judge of today"
        judged = store.get(runs[0].key)
        assert judged == kept, "its word is kept, so that the next look is quick"


def test_runs_in_this_process_are_kept_and_found(tmp_path: Path):
    run = Run(case(stack(2)), METHOD, {}, None)
    with open_store(tmp_path / "runs.sqlite") as store:
        ends = [list(pipeline.executed([run, run], store, InProcess())) for _ in range(2)]
    assert [[stored for _, _, stored in end] for end in ends] == [[False, False], [True, True]]
    assert ends[0][0][1].model_dump() == ends[1][0][1].model_dump()


def test_the_hash_of_the_judge_is_over_all_that_judges():
    for module in JUDGE:
        source = Path(str(importlib.import_module(module).__file__)).read_text(encoding="utf-8")
        assert set(re.findall(r"^from (harness\.engine\.\w+) import", source, re.MULTILINE)) <= set(JUDGE)
