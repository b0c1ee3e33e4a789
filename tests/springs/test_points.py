"""Where gap points may lie."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import ValidationError

from methods.fe.settings import GapSpringsSettings
from methods.springs.model.points import gap_points


def test_gauss_points_are_refused_because_they_leave_the_ends_out() -> None:
    with pytest.raises(ValidationError, match="none of them lies at an end"):
        GapSpringsSettings(rule="gauss")


def test_an_unknown_rule_names_the_rules_there_are() -> None:
    with pytest.raises(ValidationError, match="'uniform' and 'lobatto'"):
        GapSpringsSettings(rule="simpson")


@pytest.mark.parametrize("rule", ["uniform", "lobatto"])
@pytest.mark.parametrize("count", [2, 3, 4, 7])
def test_every_rule_contains_both_ends_and_integrates_a_line(rule: str, count: int) -> None:
    position, weight = gap_points(rule, count)
    assert (position[0], position[-1]) == (0.0, 1.0)
    assert weight.sum() == pytest.approx(1.0)
    assert weight @ position == pytest.approx(0.5)


def test_three_lobatto_points_weigh_one_four_one() -> None:
    np.testing.assert_allclose(gap_points("lobatto", 3)[1] * 6.0, [1.0, 4.0, 1.0])
