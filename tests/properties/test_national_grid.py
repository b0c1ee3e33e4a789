"""A wall drawn in the coordinates of a national grid, millions of block sizes from the origin, answers alike."""

from __future__ import annotations

import numpy as np
import pytest

from harness.engine.judge import answered
from harness.model.assembly import Assembly
from harness.model.method_registry import load_method
from tests.walls import assembly, running_bond

GRID = (512_345.0, 4_512_345.0)
"""East and north in metres: a coordinate's last digit is 1e-9 m there."""
ROUNDED = 1e-7
"""Relative: that digit over the 0.2 m of a brick is 5e-9, and some hundred bricks add up."""
BRACKET = 2e-3
"""Relative: distinct elements and the convex steps bisect down to 5e-4 and 1e-3."""
WITHIN = {"la": ROUNDED, "la-associated": ROUNDED, "fe": ROUNDED, "fe-newton": ROUNDED, "fe-qp": BRACKET, "de": BRACKET}


def bond(origin: tuple[float, float]) -> Assembly:
    return assembly(running_bond(6, 2) | {"origin": origin})


def thin_arch(origin: tuple[float, float]) -> Assembly:
    ring = {"type": "ring", "inner_radius": 0.32, "outer_radius": 0.38, "count": 20, "origin": origin}
    return assembly(ring, friction=0.7)


@pytest.mark.parametrize("name", list(WITHIN))
def test_multiplier_in_the_coordinates_of_a_national_grid(name: str):
    here, _ = answered(load_method(name), bond((0.0, 0.0)))
    there, judgement = answered(load_method(name), bond(GRID))
    assert judgement.accepted is not False, judgement.sentence
    assert here.multiplier is not None
    assert there.multiplier == pytest.approx(here.multiplier, rel=WITHIN[name])


def test_distinct_elements_hold_a_thin_arch_in_the_coordinates_of_a_national_grid():
    here, _ = answered(load_method("de"), thin_arch((0.0, 0.0)))
    there, _ = answered(load_method("de"), thin_arch(GRID))
    assert there.multiplier == pytest.approx(here.multiplier, rel=BRACKET)


def test_weights_and_the_sense_of_polygons_keep_their_digits_in_a_national_grid():
    here, there, far = bond((0.0, 0.0)), bond(GRID), bond((5e8, 4.5e9))
    assert there.weight == pytest.approx(here.weight, rel=1e-8)
    assert far.weight == pytest.approx(here.weight, rel=1e-5)
    np.testing.assert_allclose(there.normal, here.normal, atol=1e-8)
    assert far.n_interfaces == here.n_interfaces
