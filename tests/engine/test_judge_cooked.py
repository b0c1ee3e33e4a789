"""Cooked answers of many kinds about walls of which the truth is known: none is accepted, and no right one is lost.

`DRYSTONE_MUTANTS=20000` is the recorded run of docs/reliability.md.
"""

from __future__ import annotations

import itertools
import os
from collections import Counter

import pytest

from harness.engine.judge import judge
from harness.model.assembly import Assembly
from harness.model.method import Answer, Finding
from harness.model.result import Judgement, result_of
from tests.cooked import KINDS, cook
from tests.enumeration import least_by_enumeration
from tests.known_claims import SLACK, TOLERANCE
from tests.known_walls import WALLS, item

FALSE = int(os.environ.get("DRYSTONE_MUTANTS", "480"))
"""Answers that are cooked and false; some kinds have none of some walls, and some answers are true by chance."""
ENUMERATED = ("stack that slides", "stack that topples", "light upon heavy", "arch", "jammed", "three")


def said(wall: Assembly, answer: Answer) -> Judgement:
    return judge(wall, result_of(answer, wall, case="x", method="hand", family="hand"), TOLERANCE)


def test_no_cooked_answer_is_accepted():
    tried: Counter[str] = Counter()
    accepted: list[tuple[int, str, str, Finding]] = []
    for number in itertools.count():
        made = cook(number)
        if made is not None:
            name, kind, it, answer = made
            tried[kind] += 1
            if said(it.wall, answer).accepted:
                accepted.append((number, name, kind, answer.finding))
        if sum(tried.values()) == FALSE:
            break
        assert number < 3 * FALSE, tried
    print(f"{sum(tried.values())} false answers of {len(tried)} kinds: {dict(tried)}")
    assert accepted == []
    assert set(tried) == {kind.__name__ for kind in KINDS}


@pytest.mark.parametrize("name", list(WALLS))
def test_right_answers_about_these_walls_are_accepted(name: str):
    it = item(name)
    assert it.states
    for answer in it.states:
        # Springs move where a wall stands by forces of a million times its weight, which is no proof that it falls.
        assert said(it.wall, answer).accepted is (None if it.denies(answer, SLACK) else True)


@pytest.mark.parametrize("name", ENUMERATED)
def test_least_multipliers_by_hand_are_those_of_enumeration(name: str):
    it = item(name)
    assert least_by_enumeration(it.wall) == pytest.approx(it.least, rel=1e-7)
