"""The share of the fuzzing that every test run does, and what longer runs found, kept as documents of their own."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.fuzz.documents import Seeded
from tests.fuzz.run import target_of
from tests.fuzz.targets import TARGETS, outcome

SECONDS = 20.0
"""Time of the seeded share; the recorded run of 200,000 documents is told in docs/reliability.md."""


class Drawn:
    """Choices that hypothesis makes, and makes smaller where they fail."""

    def __init__(self, data: Any) -> None:
        self._data = data

    def integer(self, low: int, high: int) -> int:
        return int(self._data.draw(st.integers(low, high)))


def test_documents_end_in_an_answer_or_a_sentence(tmp_path: Path):
    """Another part of the documents every day would be no test: the first ones, as many as fit, are always the same."""
    begun, number = time.monotonic(), 0
    while time.monotonic() - begun < SECONDS and number < 3000:
        outcome(target_of(number), Seeded(number), tmp_path)
        number += 1
    assert number > 50


@pytest.mark.parametrize("number", [1259, 1489, 3439, 4099, 6757])
def test_what_a_run_found_stays_mended(number: int, tmp_path: Path):
    """Text in a store that is not UTF-8 (in rows, in the schema), and numbers of a result in quotes: "NaN"."""
    assert outcome(target_of(number), Seeded(number), tmp_path) in ("sentence", "answer")


@pytest.mark.parametrize("target", TARGETS)
@settings(max_examples=60, deadline=None, derandomize=True)
@given(data=st.data())
def test_documents_that_hypothesis_draws_end_in_an_answer_or_a_sentence(target: str, data: Any):
    with tempfile.TemporaryDirectory() as folder:
        outcome(target, Drawn(data), Path(folder))
