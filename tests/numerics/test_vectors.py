"""Vector helpers against numpy."""

from __future__ import annotations

import numpy as np
import pytest

from methods.numerics.vectors import combine, largest


@pytest.mark.parametrize("values", [[], [0.0], [-3.0, 2.0], [1e-320, -1e-321], [1.0, -np.inf], [-0.0, 5e-324]])
def test_largest_is_the_greatest_absolute_value(values: list[float]) -> None:
    """Also of nothing, of denormal and of infinite numbers."""
    assert largest(np.array(values)) == np.abs(values).max(initial=0.0)


@pytest.mark.parametrize("place", [0, 1, 2])
def test_largest_is_not_a_number_where_any_value_is_not(place: int) -> None:
    """Whatever stands before or behind it, infinity included."""
    values = np.array([1.0, -np.inf, 2.0])
    values[place] = -np.nan
    assert np.isnan(largest(values))


def test_combine_works_in_place() -> None:
    """x = a x + b y."""
    x, y = np.array([1.0, 2.0]), np.array([10.0, 20.0])
    combine(x, 2.0, -0.5, y)
    assert x.tolist() == [-3.0, -6.0]
