"""Reactions, capacity curves and shakings are runs: in a child process with limits, kept in the store, found again."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from drystone.held_reactions import held_reactions
from drystone.reactions import least_known_reactions, reactions
from drystone.settling import settled_until_collapse
from drystone.support_paths import reaction_paths
from drystone.toppling import least_shaking
from harness.engine.executors import InProcess
from harness.engine.pipeline import Runs
from harness.engine.run import Limits
from harness.engine.store import open_store
from harness.model.method import OF_COMMANDS, Finding, Listed, method_points
from harness.model.method_registry import load_method, method_names, prepared
from tests.commands import drystone as command
from tests.la.test_reaction_command import DOWN, data
from tests.walls import stack, wall_data

SETTLING = drystone.build_wall(data(DOWN))
BLOCK = drystone.build_wall(wall_data(stack(1, 0.4, 2.0), 0.9))
Asked = Callable[[Runs], Any]
ASKED: dict[str, Asked] = {
    "reactions": lambda runs: [each.as_json() for each in reactions(SETTLING, runs=runs)],
    "least known": lambda runs: [each.as_json() for each in least_known_reactions(SETTLING, runs=runs)],
    "held": lambda runs: [each.as_json() for each in held_reactions(SETTLING, runs=runs)],
    "paths": lambda runs: [each.as_json() for each in reaction_paths(SETTLING, runs=runs)],
    "settling": lambda runs: settled_until_collapse(SETTLING, runs=runs).as_json(),
    "capacity": lambda runs: drystone.capacity(BLOCK, runs=runs).as_json(),
    "shake": lambda runs: drystone.shake(BLOCK, "0.3:0.1", runs=runs).as_json(),
}
RUNS = {"reactions": 2, "least known": 4, "held": 5, "paths": 4, "settling": 1, "capacity": 1, "shake": 1}


@pytest.mark.parametrize("name", ASKED)
def test_what_is_asked_again_is_found_in_the_store(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    path = tmp_path / "runs.sqlite"
    first = ASKED[name](Runs(store=path))
    with open_store(path) as store:
        assert sum(1 for _ in store._open.execute("SELECT key FROM run")) == RUNS[name]

    def none_is_made(*_: Any) -> Any:
        raise AssertionError("a run is made")

    monkeypatch.setattr(InProcess, "_measured", none_is_made)
    assert ASKED[name](Runs(store=path)) == first
    with pytest.raises(AssertionError, match="a run is made"):
        ASKED[name](Runs(store=path, fresh=True))


@pytest.mark.parametrize("name", ASKED)
def test_a_child_process_answers_to_the_bit_as_this_one(name: str):
    assert ASKED[name](Runs(Limits(60.0))) == ASKED[name](Runs())


def test_a_command_outlives_a_run_that_is_cut_off(tmp_path: Path):
    path, why = tmp_path / "wall.json", "It was stopped at the limit of 1e-06 s."
    path.write_text(json.dumps(data(DOWN)), encoding="utf-8")
    done = command("reaction", path, "--until-collapse", "--seconds", 1e-6)
    assert (done.returncode, done.stdout) == (1, f"{why}\n"), done.stderr
    done = command("reaction", path, "--until-collapse", "--seconds", 1e-6, "--json")
    assert json.loads(done.stdout) == {"stands": None, "falls": None, "reason": why, "warnings": []}


@pytest.mark.parametrize("words", [("reaction",), ("reaction", "--held"), ("reaction", "--path")], ids=" ".join)
def test_limits_are_those_of_every_run(words: tuple[str, ...], tmp_path: Path):
    path, store = tmp_path / "wall.json", tmp_path / "runs.sqlite"
    path.write_text(json.dumps(data(DOWN)), encoding="utf-8")
    done = command(words[0], path, *words[1:], "--seconds", 1e-6, "--store", store)
    assert (done.returncode, done.stdout) == (1, "It was stopped at the limit of 1e-06 s.\n"), done.stderr
    with open_store(store) as opened:
        kept = opened._open.execute("SELECT method, status FROM run").fetchall()
    assert kept == [("la-reaction", "timeout")]


def test_shaking_that_is_cut_off_is_undecided():
    found = drystone.shake(BLOCK, "0.3:0.1", runs=Runs(Limits(1e-6)))
    assert (found.finding, found.accepted) == (Finding.NONE, False)
    assert found.sentence == "Whether the wall stands is undecided. It was stopped at the limit of 1e-06 s."
    assert json.dumps(found.as_json(), allow_nan=False)


def test_search_for_the_least_shaking_ends_with_the_first_run_that_is_cut_off():
    found = least_shaking(BLOCK, "0.3:0.1", runs=Runs(Limits(1e-6)))
    assert (found.accepted, found.lower, found.upper, len(found.tried)) == (False, 0.0, np.inf, 1)
    assert found.sentence.endswith("At 1 times the motion: It was stopped at the limit of 1e-06 s.")
    assert json.dumps(found.as_json(), allow_nan=False)


def test_users_name_no_method_of_a_command():
    names = {point.name for point in method_points() if point.group == OF_COMMANDS}
    assert names == {"la-reaction", "la-settling", "la-capacity", "fe-reaction", "de-reaction", "de-time"}
    assert not names & set(method_names())
    done = command("run", "la-reaction", "single-block")
    assert (done.returncode, done.stdout) == (2, "")
    assert 'no method is called "la-reaction"' in done.stderr
    for name in names:
        method = load_method(name)
        assert isinstance(method, Listed)
        assert method.name == name
        prepared(method)
