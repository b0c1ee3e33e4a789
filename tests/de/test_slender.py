"""A sample of the study of thin arches and slender walls: distinct elements are right within 0.5 %, or undecided."""

from __future__ import annotations

from itertools import islice

import pytest

from benchmarks.slender import known_walls, verdict
from harness.engine.judge import answered
from harness.model.method_registry import load_method


@pytest.mark.parametrize(
    ("kind", "name", "blocks", "count"),
    [("arch", "de", 25, 2), ("wall", "de", 25, 2), ("arch", "de-soft", 25, 1), ("wall", "de-soft", 14, 2)],
)
def test_thin_arches_and_slender_walls_are_right_or_undecided(kind, name, blocks, count):
    method = load_method(name)
    small = (known for known in known_walls(kind, 30, seed=1, least=False) if known.case.assembly.n_free <= blocks)
    said = []
    for known in islice(small, count):
        settings = {"orders": 1} if name == "de" else {}
        result, judgement = answered(method, known.case.assembly, **settings)
        assert judgement.accepted is not False, judgement.sentence
        said.append(verdict(known, result, method.traits.accuracy))
    assert set(said) <= {"right", "undecided"}
    assert "right" in said
