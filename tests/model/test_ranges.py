"""How far multipliers lie from each other that are values or measured brackets."""

from __future__ import annotations

import math

import pytest

from harness.model.method import Answer, Finding, Status, Traits
from harness.model.ranges import differences, percent_text
from harness.model.result import bracket_is_wide


@pytest.mark.parametrize(
    ("ranges", "least", "most"),
    [
        ([(0.4, 0.4), (0.5, 0.5)], 0.25, 0.25),
        ([(0.4, 0.4), (0.44, 0.5)], 0.1, 0.25),
        ([(0.4, 0.6), (0.5, 0.5)], 0.0, 0.25),  # 0.6 over 0.5 is 0.2, 0.5 over 0.4 is more
        ([(0.4, 0.6)] * 2, 0.0, 0.5),
        ([(0.0, 0.0), (0.5, 0.5)], math.inf, math.inf),
        ([(0.0, 0.1), (0.2, 0.2)], 1.0, math.inf),
        ([(0.0, 0.0), (0.0, 0.0)], 0.0, 0.0),
        ([(0.4, 0.4), (0.42, 0.42), (0.5, 0.5)], 0.25, 0.25),
    ],
)
def test_least_and_greatest_difference(ranges: list[tuple[float, float]], least: float, most: float):
    assert differences(ranges) == pytest.approx((least, most))


def test_a_difference_in_words():
    assert percent_text(0.19, 0.36) == "19.0 to 36.0 %"
    assert percent_text(0.013, 0.013) == "1.3 %"
    assert percent_text(0.19, math.inf) == "at least 19.0 %"


@pytest.mark.parametrize(
    ("bracket", "traits", "wide"),
    [
        ((0.455, 0.775), Traits(accuracy=5e-3), True),
        ((0.498, 0.502), Traits(accuracy=5e-3), False),  # the middle is within .4 % of both ends
        ((0.4974, 0.5026), Traits(accuracy=5e-3), True),
        ((0.3, 0.305), Traits(accuracy=5e-3, resolution=5e-3), False),
        ((0.3, 0.306), Traits(accuracy=5e-3, resolution=5e-3), True),
    ],
)
def test_a_bracket_is_wide_beyond_the_accuracy_that_its_method_states(
    bracket: tuple[float, float], traits: Traits, wide: bool
):
    answer = Answer(Status.OK, Finding.COLLAPSES, "", sum(bracket) / 2.0, bracket, flow="approximate")
    assert bracket_is_wide(answer, traits) is wide
