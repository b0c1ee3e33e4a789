"""What is kept of walls that are followed as they move, read again: of this wall, whole, and of numbers that count."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from harness.model.answer_check import AnswerFault, checked
from harness.model.followed import DrivenWall, FollowedWall, InDetails, ShakenWall, SupportPath, check_followed
from harness.model.method import Answer, Finding, Status
from tests.walls import case, stack

WALL = case(stack(2)).assembly
N, M, K = WALL.n_blocks, WALL.n_interfaces, 3
KEPT: dict[str, InDetails] = {
    kept.NAME: kept
    for kept in (
        DrivenWall(1.0, np.ones((M, 3)), np.zeros(0), np.ones((N, 3))),
        FollowedWall(
            np.arange(3.0),
            np.ones(K),
            np.ones((K, N, 3)),
            np.ones((K, M, 3)),
            np.ones((K, N, 3)),
            np.ones((M, 2), dtype=bool),
            2.5,
            np.ones((N, 3)),
            np.ones((N, 3)),
            "",
        ),
        SupportPath(
            np.arange(3.0), np.ones(K), np.ones(K, int), np.ones(K, int), np.ones((M, 3)), np.ones((N, 3)), 1.0, ""
        ),
        ShakenWall(np.arange(3.0), np.ones((K, N, 3)), None, np.zeros(N, dtype=bool), True, "an engine", 0.9),
    )
}
FIELDS = [(name, field) for name, kept in KEPT.items() for field in vars(kept)]
NUMBERS: dict[str, Callable[[Any], Any]] = {
    "less": lambda rows: rows[:-1],
    "more": lambda rows: [*rows, *rows[-1:]] or [1.0],
    "ragged": lambda rows: [[1.0], [1.0, 2.0]],
    "text": lambda rows: "x",
    "texts": lambda rows: [["x"]],
    "nothing inside": lambda rows: [None],
    "a number": lambda rows: 1.0,
    "no end": lambda rows: np.full(np.shape(rows) or 1, np.inf).tolist(),
    "too large": lambda rows: np.full(np.shape(rows) or 1, 1e200).tolist(),
    "an integer beyond all types": lambda rows: [10**400],
}
"""What is wrong with an array, of its rows."""


@pytest.mark.parametrize("name", KEPT)
def test_what_is_kept_comes_back(name: str):
    details = KEPT[name].as_details()
    found = type(KEPT[name]).of(details, WALL)
    assert found is not None
    assert found.as_details() == details
    assert {key: getattr(value, "dtype", type(value)) for key, value in vars(found).items()} == {
        key: getattr(value, "dtype", type(value)) for key, value in vars(KEPT[name]).items()
    }
    assert type(KEPT[name]).of({}, WALL) is None


@pytest.mark.parametrize(("name", "field"), FIELDS)
def test_what_is_no_such_field_is_refused(name: str, field: str):
    whole = KEPT[name].as_details()[name]
    given = getattr(KEPT[name], field)
    if isinstance(given, np.ndarray):
        wrong = [value for change in NUMBERS.values() if (value := change(whole[field])) != whole[field]]
    else:
        wrong = [[1.0], {}, float("nan"), 10**400]
    for value in wrong:
        with pytest.raises(ValueError, match=f"^{name}"):
            check_followed({name: whole | {field: value}}, WALL)
    with pytest.raises(ValueError, match="does not have the fields"):
        check_followed({name: {key: value for key, value in whole.items() if key != field}}, WALL)


@pytest.mark.parametrize(
    ("name", "changes", "words"),
    [
        ("followed", {"falling": None}, "has to give falls, fallen, falling, or else a reason"),
        ("followed", {"reason": "It slides."}, "or else a reason"),
        ("followed", {"falls": None, "fallen": None, "falling": None}, "or else a reason"),
        ("followed", {"displacement": [0.0, 2.0, 1.0]}, "no states in ascending order"),
        ("support_path", {"constant_from": None}, "has to give mechanism, constant_from, or else a reason"),
        ("shaken", {"time": [], "places": []}, "no states in ascending order"),
        ("shaken", {"at_rest": None}, "at_rest: Input should be a valid boolean"),
    ],
)
def test_parts_belong_together(name: str, changes: dict[str, Any], words: str):
    with pytest.raises(ValueError, match=words):
        check_followed({name: KEPT[name].as_details()[name] | changes}, WALL)
    followed = KEPT["followed"].as_details()["followed"]
    open_end = {"falls": None, "fallen": None, "falling": None, "reason": "It slides."}
    check_followed({"followed": followed | open_end}, WALL)


def test_an_answer_that_keeps_other_things_is_none():
    details = {"shaken": KEPT["shaken"].as_details()["shaken"] | {"places": [[0.0, 0.0, 0.0]]}}
    with pytest.raises(AnswerFault, match=r"details cannot be used: shaken.places: of shape \(1, 3\)"):
        checked(Answer(Status.OK, Finding.STANDS, "It stands.", details=details), WALL)
