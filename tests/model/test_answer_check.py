"""What an answer may hold: each part at the ends of what may stand there, and the sentence for what is beyond."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from harness.model.answer_check import DEEPEST, AnswerFault, checked
from harness.model.method import Answer, Finding, Status
from tests.walls import assembly, stack

WALL = assembly(stack(2))
N, M = WALL.n_blocks, WALL.n_interfaces
PLAIN = Answer(Status.OK, Finding.COLLAPSES, "It slides.", 0.5)


def nested(depth: int) -> Any:
    value: Any = 1
    for _ in range(depth):
        value = [value]
    return value


def displaced(**changes: Any) -> dict[str, Any]:
    contact = {"interface": [0], "onto": [0], "point": [[0.0, 0.0]], "normal": [[0.0, 1.0]], "force": [[1.0, 2.0]]}
    return {"displaced_state": {"places": [[0.0, 0.0, 0.0]] * N} | contact | changes}


TAKEN: dict[str, tuple[dict[str, Any], str, Any]] = {
    "whole numbers": ({"multiplier": 1, "bracket": [0, 2]}, "bracket", (0.0, 2.0)),
    "a bracket without width": ({"bracket": (0.5, 0.5)}, "bracket", (0.5, 0.5)),
    "iterations as a float": ({"iterations": 7.0}, "iterations", 7),
    "no iteration": ({"iterations": 0}, "iterations", 0),
    "an array in details": ({"details": {"a": np.arange(2), "b": np.float64(3)}}, "details", {"a": [0, 1], "b": 3.0}),
    "infinity in details": ({"details": {"a": float("inf")}}, "details", {"a": None}),
    "another thing in details": ({"details": {"a": Finding.FALLS}}, "details", {"a": "falls"}),
    "deep details": ({"details": {"a": nested(DEEPEST - 1)}}, "details", {"a": nested(DEEPEST - 1)}),
    "a path": ({"path": {"a": np.array([1, 2]), "b": (3, 4)}}, "path", {"a": [1.0, 2.0], "b": [3.0, 4.0]}),
    "no column": ({"path": {}}, "path", {}),
    "columns of nothing": ({"path": {"a": []}}, "path", {"a": []}),
    "a displaced state": ({"details": displaced()}, "details", displaced()),
    "contacts at the last ones": (
        {"details": displaced(interface=[M - 1], onto=[N - 1])},
        "details",
        displaced(interface=[M - 1], onto=[N - 1]),
    ),
}


@pytest.mark.parametrize("name", TAKEN)
def test_what_an_answer_may_hold_becomes_plain_values(name: str):
    changes, part, value = TAKEN[name]
    assert getattr(checked(replace(PLAIN, **changes), WALL), part) == value


def test_zero_has_no_sign():
    assert str(checked(replace(PLAIN, multiplier=-0.0), WALL).multiplier) == "0.0"


def test_arrays_become_floats_of_the_same_values():
    forces, motion = np.arange(3 * M).reshape(M, 3), [[k, 0, 1] for k in range(N)]
    found = checked(replace(PLAIN, forces=forces, mechanism=motion, forces_multiplier=1), WALL)
    assert found.forces is not None
    assert found.mechanism is not None
    assert (found.forces.dtype, found.mechanism.dtype, found.forces_multiplier) == (float, float, 1.0)
    assert found.forces.tolist() == forces.tolist()
    assert found.mechanism.tolist() == motion


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "another status": ({"status": "fine"}, 'status is "fine"'),
    "another finding": ({"finding": 3}, 'finding is "int"'),
    "no sentence": ({"sentence": None}, "sentence is no text but NoneType"),
    "half a character": ({"sentence": "\ud800"}, "half a character"),
    "another flow": ({"flow": "plastic"}, 'flow rule "plastic"'),
    "no multiplier": ({"multiplier": None}, "a collapse without a multiplier"),
    "two multipliers": ({"multiplier": [0.5, 0.6]}, "of shape (2,) instead of ()"),
    "a multiplier in text": ({"multiplier": "0.5"}, "not of real numbers"),
    "truth": ({"multiplier": True}, "not of real numbers"),
    "a complex multiplier": ({"multiplier": 0.5 + 0j}, "not of real numbers"),
    "no number": ({"multiplier": float("nan")}, "not finite"),
    "a bracket upside down": ({"bracket": (0.5, 0.4)}, "begins at 0.5 and ends below, at 0.4"),
    "three ends": ({"bracket": (0.1, 0.2, 0.3)}, "of shape (3,) instead of (2,)"),
    "forces of other joints": ({"forces": np.zeros((M + 1, 3))}, "forces of shape"),
    "forces of blocks": ({"forces": np.zeros((M, 2))}, "forces of shape"),
    "no forces": ({"forces": np.zeros((0, 3))}, "forces of shape"),
    "a mechanism of other blocks": ({"mechanism": np.zeros((N - 1, 3))}, "a mechanism of shape"),
    "rows of two lengths": ({"mechanism": [[0.0], [0.0, 1.0]]}, "a mechanism that cannot be read"),
    "objects": ({"mechanism": np.full((N, 3), None)}, "of type object"),
    "a mechanism without end": ({"mechanism": np.full((N, 3), np.inf)}, "not finite"),
    "less than no iteration": ({"iterations": -1}, "a number of iterations of -1"),
    "half an iteration": ({"iterations": 0.5}, "a number of iterations of 0.5"),
    "no number of iterations": ({"iterations": None}, "a number of iterations of None"),
    "a column with a list in it": ({"path": {"a": [1.0, [2.0]]}}, "column 'a' of its path that cannot be read"),
    "a column that is one number": ({"path": {"a": np.array(1.0)}}, "column 'a' of its path of shape () instead"),
    "more iterations than tables hold": ({"iterations": 1e308}, "a number of iterations of 1e+308"),
    "more unknowns than tables hold": ({"details": {"unknowns": 10**30}}, 'no "unknowns" that can be used'),
    "less than no unknown": ({"details": {"unknowns": -1}}, 'no "unknowns" that can be used'),
    "a path in a list": ({"path": [1.0]}, "path is list"),
    "columns of two lengths": ({"path": {"a": [1.0], "b": [1.0, 2.0]}}, "different lengths"),
    "a column of text": ({"path": {"a": "12"}}, "column 'a' of its path"),
    "details in a list": ({"details": [1]}, "details are list"),
    "details too deep": ({"details": {"a": nested(DEEPEST)}}, f"more than {DEEPEST} deep"),
    "a huge number": ({"details": {"a": 10**400}}, "beyond those of 64 bits"),
    "unknowns in words": ({"details": {"unknowns": "many"}}, 'no "unknowns" that can be used'),
    "an interface that is not there": ({"details": displaced(interface=[M])}, "does not fit"),
    "an interface before the first": ({"details": displaced(interface=[-1])}, "does not fit"),
    "a block that is not there": ({"details": displaced(onto=[N])}, "does not fit"),
    "a block before the first": ({"details": displaced(onto=[-1])}, "does not fit"),
    "a place less": ({"details": displaced(places=[[0.0, 0.0, 0.0]] * (N - 1))}, "does not fit"),
    "a force less": ({"details": displaced(force=[])}, "does not fit"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_no_answer_may_hold_is_refused_with_what_the_method_did(name: str):
    changes, words = REFUSED[name]
    with pytest.raises(AnswerFault) as raised:
        checked(replace(PLAIN, **changes), WALL)
    assert words in str(raised.value)
    assert "method" in str(raised.value)


def test_what_is_no_answer_is_refused():
    with pytest.raises(AnswerFault, match="returned dict instead of an Answer"):
        checked({"multiplier": 0.5}, WALL)


def test_an_answer_without_multiplier_is_one_where_the_wall_stands_or_nothing_was_found():
    for status, finding in ((Status.OK, Finding.STANDS), (Status.NOT_CONVERGED, Finding.COLLAPSES)):
        assert checked(replace(PLAIN, status=status, finding=finding, multiplier=None), WALL).multiplier is None
