"""Methods of commands that lie: what nothing shows is not accepted, and what cannot be read costs the answer alone."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drystone
from drystone.held_reactions import held_reactions
from drystone.reactions import least_known_reactions, reactions
from drystone.support_paths import reaction_paths
from harness.engine import executors
from harness.engine.pipeline import Runs
from harness.engine.store import open_store
from harness.engine.worker import Task, solved
from harness.model.errors import InputError
from harness.model.method import Answer, Method
from tests.la.test_reaction_command import DOWN, data
from tests.walls import stack, wall_data

SETTLING = drystone.build_wall(data(DOWN))
BLOCK = drystone.build_wall(wall_data(stack(1, 0.4, 2.0), 0.9))
Lie = Callable[[dict[str, Any]], None]


@pytest.fixture
def lying(monkeypatch: pytest.MonkeyPatch) -> Callable[[str, Lie], None]:
    """Let a method change the details of its answers."""

    def begin(name: str, lie: Lie) -> None:
        def changed(method: Method, task: Task, settings: Any) -> Answer:
            answer = solved(method, task, settings)
            if method.name == name:
                lie(answer.details)
            return answer

        monkeypatch.setattr(executors, "solved", changed)

    return begin


def test_a_collapse_is_followed_until_it_falls_and_not_said_to_fall_before(lying: Callable[[str, Lie], None]):
    def ends_early(details: dict[str, Any]) -> None:
        states = details["followed"]
        for name in ("displacement", "value", "places", "forces", "mechanisms"):
            states[name] = states[name][:10]

    lying("la-capacity", ends_early)
    found = drystone.capacity(BLOCK)
    assert not isinstance(found, str)
    assert not found.accepted
    assert "The last state lies" in found.sentence


def test_a_mechanism_on_which_the_load_does_no_work_is_rejected_with_a_number(lying: Callable[[str, Lie], None]):
    def backwards(details: dict[str, Any]) -> None:
        details["followed"]["mechanisms"] = (-np.array(details["followed"]["mechanisms"])).tolist()

    lying("la-capacity", backwards)
    found = drystone.capacity(BLOCK)
    assert not isinstance(found, str)
    assert not found.accepted
    assert found.judgements[0].residuals["virtual_work"] == 1.0


@pytest.mark.parametrize("asked", [reaction_paths, held_reactions, least_known_reactions])
def test_no_answer_lies_between_extremes_that_are_rejected(asked: Any, lying: Callable[[str, Lie], None]):
    def wider(details: dict[str, Any]) -> None:
        details["driven"]["reaction"] += 1.0

    lying("la-reaction", wider)
    found = reactions(SETTLING)
    assert not isinstance(found, str)
    assert not any(each.judgement.accepted for each in found)
    said = asked(SETTLING)
    assert isinstance(said, str)
    assert said.startswith("The judge rejects an extreme reaction with associated flow: ")


def test_numbers_that_are_not_of_the_wall_are_refused(lying: Callable[[str, Lie], None]):
    lying("la-reaction", lambda details: details["driven"].update(mechanism=[[0.0, 0.0, 0.0]]))
    with pytest.raises(InputError, match=r"details cannot be used: driven.mechanism: of shape \(1, 3\)"):
        reactions(SETTLING)


def test_numbers_in_a_store_that_are_not_of_the_wall_are_told(tmp_path: Path):
    path = tmp_path / "runs.sqlite"
    first = reactions(SETTLING, runs=Runs(store=path))
    assert not isinstance(first, str)
    with open_store(path) as store:
        for key, *_ in store.table():
            kept = store.get(key)
            assert kept is not None
            driven = kept[0].details["driven"] | {"tensions": [1.0]}
            store.put(key, kept[0].model_copy(update={"details": {"driven": driven}}), kept[1])
    with pytest.raises(InputError, match=r"the stored result of la-reaction on wall: .*details cannot be used") as told:
        reactions(SETTLING, runs=Runs(store=path))
    assert "Repeat the run with --fresh" in str(told.value)
    again = reactions(SETTLING, runs=Runs(store=path, fresh=True))
    assert not isinstance(again, str)
    assert [each.as_json() for each in again] == [each.as_json() for each in first]
