"""One run has one key: what a study, a comparison, a check or a single run made serves all the others."""

from __future__ import annotations

import importlib
import json
import re
import tomllib
from collections.abc import Callable
from dataclasses import fields, replace
from importlib.metadata import Distribution
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from harness.engine import pipeline
from harness.engine.executors import InProcess, LocalExecutor
from harness.engine.provenance import JUDGE, brought_with
from harness.engine.run import Limits, Run
from harness.engine.store import open_store
from harness.engine.sweep.expand import expand, sources_of
from harness.engine.sweep.running import sweep
from harness.engine.sweep.study import Study
from harness.model.bars import Bars
from harness.model.content import exact_hash_of
from harness.model.method import method_points
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


def other_than(name: str, value: Any, fixed: Any) -> Any:
    """Another value of a field of an assembly."""
    if isinstance(value, Bars):
        return replace(value, names=("a tie",))
    if isinstance(value, tuple):
        return (*value[:-1], value[-1] + 1.0 if name == "polygons" else "another")
    if name == "support_motion":
        return value + fixed[:, None]
    return ~value if value.dtype == bool else value + 1


def test_a_wall_that_is_made_of_another_has_a_key_of_all_that_it_holds():
    """What makes it may change from release to release without a word in any file of a wall."""
    wall = case(stack(2)).assembly
    same = {exact_hash_of(wall), exact_hash_of(wall.copied()), exact_hash_of(replace(wall, name="another"))}
    assert len(same) == 1
    names = [each.name for each in fields(wall) if each.name != "name"]
    other = {name: other_than(name, getattr(wall, name), wall.fixed) for name in names if name != "crushing"}
    hashes = {exact_hash_of(replace(wall, **{name: value})) for name, value in other.items()}
    assert len(hashes | same) == len(names)
    assert exact_hash_of(replace(wall, crushing=np.ones(wall.n_interfaces))) not in hashes | same


def test_versions_of_what_answers_are_part_of_the_key(tmp_path: Path):
    """All that an extra of a method brings, and what another distribution brings or requires."""
    own = tomllib.loads(Path("pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    tools = {"figures", "checkout", "drawings", "parquet", "cluster", "sensitivity", "umbridge", "docs", "dev"}
    assert {word for point in method_points() for word in point.name.split("-")} >= own.keys() - tools
    points = {point.name: point for point in method_points()}
    assert brought_with(points["la-paper"]).keys() == {"ipyopt"}
    assert brought_with(points["la-associated-cvxpy"]).keys() == {"cvxpy-base", "clarabel"}
    assert brought_with(points["la"]) == {}
    folder = tmp_path / "theirs-2.5.dist-info"
    folder.mkdir()
    about = "Metadata-Version: 2.1\nName: theirs\nVersion: 2.5\nRequires-Dist: numpy>=1.20 ; python_version>'3'\n"
    (folder / "METADATA").write_text(f"{about}Requires-Dist: not-there[extra]\n", encoding="utf-8")
    (folder / "entry_points.txt").write_text("[drystone.methods]\nmine = theirs.method:Mine\n", encoding="utf-8")
    (point,) = Distribution.at(folder).entry_points
    assert brought_with(point) == {"theirs": "2.5", "numpy": np.__version__}


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


def test_the_word_of_a_judge_of_one_question_counts_for_no_other(tmp_path: Path):
    """A study reads the word that is kept, without judging anew, where the judge is the same."""
    asked = case(stack(2, 0.4, 0.2), 0.6)
    own = Run(asked, "la-associated", {}, None, judge=lambda *_: Judgement(accepted=True, sentence="of its own"))
    with open_store(tmp_path / "s.sqlite") as store:
        (made,) = pipeline.execute([own], store, 1, executor=InProcess())
        assert made.judge.sentence == "of its own"
        usual = replace(own, judge=None)
        ((_, read, stored),) = pipeline.executed([usual], store, InProcess(), whole=False)
    assert stored
    assert read.judge.sentence != "of its own"
    assert read.judge.code


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
