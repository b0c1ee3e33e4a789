"""A live load given a million times larger has a multiplier a million times smaller, and is judged alike."""

from __future__ import annotations

from dataclasses import replace

import pytest

from harness.engine.judge import answered
from harness.model.method_registry import load_method
from tests.walls import assembly, running_bond

EXACT = 1e-9
BRACKET = 2e-3
"""Relative: distinct elements and the convex steps bisect down to 5e-4 and 1e-3."""
WITHIN = {"la": EXACT, "la-associated": EXACT, "la-tresca": EXACT, "fe": EXACT, "fe-qp": BRACKET, "de": BRACKET}


@pytest.mark.parametrize("times", [pytest.param(1e-6, marks=pytest.mark.slow), 1e6])
@pytest.mark.parametrize("name", list(WITHIN))
def test_multiplier_follows_the_size_of_the_live_load(name: str, times: float):
    wall = assembly(running_bond(6, 2))
    usual, _ = answered(load_method(name), wall)
    other, judgement = answered(load_method(name), replace(wall, live=times * wall.live))
    assert judgement.accepted is not False, judgement.sentence
    assert usual.multiplier is not None
    assert other.multiplier is not None, other.sentence
    assert other.multiplier * times == pytest.approx(usual.multiplier, rel=WITHIN[name])
